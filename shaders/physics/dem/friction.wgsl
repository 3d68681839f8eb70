// Contacts of grains that rotate and rub. A contact lasts while grains overlap.
//
// Across the contact the law pushes, F = f(δ) − c(δ) v_n, to the very end: it may pull shortly before the contact ends, so that
// restitution is what was asked for. Along it a spring remembers how far the surfaces have slid, F = k_t ξ + c_t v_t, and
// is cut back to Coulomb's limit μ F_n where it would pull harder (Cundall and Strack 1979; Luding 2008). Forces and torques
// act where the surfaces meet, halfway between two centers (between those of unequal grains, in the ratio of their radii), so
// that angular momentum stays.
//
// Cohesion pulls with a constant force while grains overlap, and less with the distance of their surfaces, in a straight line to
// nothing at its range, so that no energy is lost by it. Coulomb's limit is of what pushes, so grains that stick rub too.
#import common/vector
#import physics/dem/rotation
#import physics/dem/frictional_contact
#import <contact_law>
#if sizes
#import common/sizes
#end
#if !measuring
#import physics/time_step
#import physics/dem/history
#import physics/dem/rest
#if rolling
#import <rolling_law>
#end
#end

// What the contacts of one grain add up to.
struct ContactSum {
    force: Vector, // N
#if mixed_grains
    material: u32, // number of the grain's
#end
#if sizes
    size: f32, // the grain's radius over that of the largest
#end
#if rigid_bodies
    body_mass: f32, // of the grain's rigid body, over that of a grain; 0 where it is loose
#end
#if measuring
    contacts: u32,
    normal_force: f32, // sum of magnitudes, N
    overlap: f32, // the largest, m
#else
    torque: Rotation, // N·m
    grain: u32,
    rotation: Rotation, // of that grain, rad/s
    rest: Vector, // of its position, m
    slots: u32, // contacts that are to be remembered
    cursor: u32, // of the search among those that are
#end
}

// What a grain touches, or nearly so.
struct Touch {
    key: f32, // physics/dem/history.wgsl
    normal: Vector, // from the grain to what it touches
    overlap: f32, // m
    arm: f32, // from the grain's center to the contact, m
#if sizes
    other_arm: f32, // from the other's center to the contact, m; 0 for walls
#end
    approach: Vector, // velocity of the other less that of the grain, m/s
    rotation: Rotation, // of the other, rad/s; none for walls
    rest: Vector, // of the other's position, m; none for walls
}

#if materials
// Of grains of two materials, then of a grain and a wall; a row for each material of grains.
var<uniform> pairings: array<Pairing, 2 * MATERIALS * MATERIALS>;
#end

#if rigid_bodies
// Of what moves when a grain is pushed, over that of a grain.
fn relative_mass(body_mass: f32) -> f32 {
    return select(1.0, body_mass, body_mass > 0.0);
}

// Dashpots are made for the mass of grains. Those of a mass that is larger by `share` give the same restitution where bodies
// meet at one point.
fn heavier(pairing: Pairing, share: f32) -> Pairing {
    var stronger = pairing;
    let factor = sqrt(share);
    stronger.damping *= factor;
    stronger.shear_damping *= factor;
    return stronger;
}
#end

#if sizes
// Coefficients are those of two of the largest, or of one at a wall. Those of others follow from their effective mass, their
// effective radius and their moment of inertia about the contact, as shares of the same of the largest.
fn sized(pairing: Pairing, mass: f32, radius: f32, inertia: f32) -> Pairing {
    var own = of_size(pairing, mass, radius);
    own.rolling_limit *= radius;
    own.rolling_stiffness *= radius * radius;
    own.rolling_damping *= sqrt(inertia);
    own.rolling_inertia *= inertia;
    return own;
}
#end

// Coefficients of the contact with a wall or obstacle of this material.
fn wall_pairing(sum: ContactSum, material: u32) -> Pairing {
#if mixed_grains
    let pairing = pairings[(MATERIALS + sum.material) * MATERIALS + material];
#else
#if materials
    let pairing = pairings[MATERIALS * MATERIALS + material];
#else
    let pairing = contact.walls;
#end
#end
#if rigid_bodies
    return heavier(pairing, relative_mass(sum.body_mass));
#else
#if sizes
    return sized(pairing, mass_share(sum.size), sum.size, inertia_share(sum.size));
#else
    return pairing;
#end
#end
}

#if measuring
fn with_touch(before: ContactSum, touch: Touch, pairing: Pairing) -> ContactSum {
    var sum = before;
    if touch.overlap > 0.0 {
        let response = respond(pairing, touch.overlap, touch.overlap);
        sum.contacts += 1u;
        sum.normal_force += abs(response.force - response.damping * dot(touch.approach, touch.normal));
        sum.overlap = max(sum.overlap, touch.overlap);
    }
    return sum;
}
#else
const SMALLEST_WAY: f32 = 1e-30; // m

fn with_touch(before: ContactSum, touch: Touch, pairing: Pairing) -> ContactSum {
    var sum = before;
    let dt = time_step();
    let normal = touch.normal;
    let deep = touch.overlap + dot(sum.rest - touch.rest, normal);
    let normal_speed = dot(touch.approach, normal);
    // A force holds from half a step before to half a step later. A dashpot begins and ends with a jump, so what counts is the
    // share of that time in which grains overlap; then an error of the step's length is an error of its square.
    let way = max(abs(normal_speed) * dt, SMALLEST_WAY);
    let share = clamp(0.5 + deep / way, 0.0, 1.0);
#if cohesion
    sum.force += pairing.cohesion * clamp(1.0 + deep / contact.cohesion_range, 0.0, 1.0) * normal;
#end
    if share <= 0.0 {
        return sum;
    }
    let overlap = max(deep, 0.0);
    let response = respond(pairing, overlap, max(overlap, 0.5 * deep + 0.25 * way));
    let push = response.force - share * response.damping * normal_speed;
    let pressing = max(push, 0.0);

    let arm = touch.arm * normal;
#if sizes
    let turning = velocity_at(touch.arm * sum.rotation + touch.other_arm * touch.rotation, normal);
    let sliding = touch.approach - normal_speed * normal - turning;
#else
    let sliding = touch.approach - normal_speed * normal - velocity_at(sum.rotation + touch.rotation, arm);
#end
    var cursor = sum.cursor;
    var memory = recall(sum.grain, touch.key, &cursor);
    sum.cursor = cursor;
    // Into the plane of the contact as it is now, as long as before.
    let stretched = length(memory.slide);
    memory.slide -= dot(memory.slide, normal) * normal;
    memory.slide *= stretched / max(length(memory.slide), SMALLEST_WAY);
    let drag = share * response.shear_damping * sliding;
    let slide = memory.slide + 0.5 * dt * sliding;
    var pull = response.shear_stiffness * slide + drag;
    let size = length(pull);
    let limit = pairing.friction * pressing;
    if size > limit {
        pull *= limit / size;
        memory.slide = (pull - drag) / max(response.shear_stiffness, SMALLEST_WAY);
    } else {
        memory.slide = slide + 0.5 * dt * sliding;
    }
    sum.force += pull - push * normal;
    sum.torque += torque_at(arm, pull);
#if rolling
    let rate = rolling_part(touch.rotation - sum.rotation, normal);
    var roll = rolling_part(memory.roll, normal);
    sum.torque += resist_rolling(pairing, response, pressing, rate, &roll, dt);
    memory.roll = roll;
#end
    if deep > 0.0 {
#if moves
        if sum.slots < CONTACT_SLOTS {
            remember(sum.grain, sum.slots, touch.key, memory);
        }
#end
        sum.slots += 1u;
    }
    return sum;
}
#end
