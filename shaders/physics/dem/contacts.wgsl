// All contacts of one grain: with grains, walls and obstacles. Knows nothing of the grid behind `<candidates>`.
#import common/vector
#import common/parameters
#import common/reach
#import physics/present
#if rotation
#import physics/dem/friction
#if !measuring
#import fields/angular_velocity
#end
#if mixed_grains
#import fields/material
#end
#if rigid_bodies
#import fields/body
#import fields/body_mass
#end
#else
#import physics/dem/law
#end
#import <candidates>
#if contact_walls
#import physics/dem/walls
#end
#if colliders
#import physics/dem/colliders
#end

#if rotation
// Coefficients of the contact with grain j.
fn pairing_with(sum: ContactSum, j: u32) -> Pairing {
#if mixed_grains
    let pairing = pairings[sum.material * MATERIALS + material[j]];
#else
    let pairing = contact.grains;
#end
#if rigid_bodies
    let mine = relative_mass(sum.body_mass);
    let other = relative_mass(body_mass_of(j));
    return heavier(pairing, 2.0 * mine * other / (mine + other));
#else
#if sizes
    let other = size_of(j);
    return sized(
        pairing,
        effective_share(mass_share(sum.size), mass_share(other)),
        effective_share(sum.size, other),
        effective_share(inertia_share(sum.size), inertia_share(other)),
    );
#else
    return pairing;
#end
#end
}

// The contact of grain i with grain j, at this distance of their centers.
fn with_grain(sum: ContactSum, j: u32, normal: Vector, distance: f32, approach: Vector) -> ContactSum {
#if measuring
    let key = 0.0;
    let rotation = Rotation();
    let rest = Vector(0.0);
#else
    let other = angular_velocity[j];
    let key = number_of(other);
    let rotation = unpack_rotation(other);
    let rest = rest_of(position[j]);
#end
#if sizes
    let own = LARGEST_RADIUS * sum.size;
    let both = own + radius[j];
    let arm = distance * own / both;
    let touch = Touch(key, normal, both - distance, arm, distance - arm, approach, rotation, rest);
#else
    let touch = Touch(key, normal, contact.diameter - distance, 0.5 * distance, approach, rotation, rest);
#end
    return with_touch(sum, touch, pairing_with(sum, j));
}
#end

fn sum_contacts(i: u32) -> ContactSum {
    var sum = ContactSum();
#if rotation
#if !measuring
    sum.grain = i;
    sum.rotation = unpack_rotation(angular_velocity[i]);
    sum.rest = rest_of(position[i]);
#end
#if mixed_grains
    sum.material = material[i];
#end
#end
#if sizes
    sum.size = size_of(i);
#end
#if rigid_bodies
    sum.body_mass = body_mass_of(i);
    let own_body = body[i];
#end
    let x = unpack(position[i]);
    let v = unpack(velocity[i]);
    let home = around(i, x);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
            let j = candidate(slot);
            let separation = unpack(position[j]) - x;
#if rotation
            let reach = contact.reach;
#else
            let reach = contact.diameter;
#end
#if sizes
            if within(separation, pair_reach(i, j, reach)) && j != i {
#else
            if within(separation, reach) && j != i {
#end
#if rigid_bodies
                if own_body != 0u && body[j] == own_body {
                    continue;
                }
#end
                let distance = length(separation);
                var normal = separation / distance;
                if distance == 0.0 {
                    // Coincident grains part along x, the one that stands first to the left.
                    normal = Vector(0.0);
                    normal.x = select(-1.0, 1.0, i < j);
                }
#if rotation
                sum = with_grain(sum, j, normal, distance, unpack(velocity[j]) - v);
#else
#if sizes
                let overlap = LARGEST_RADIUS * sum.size + radius[j] - distance;
                let mass = effective_share(mass_share(sum.size), mass_share(size_of(j)));
                let damping = damping_by_mass(contact.damping, mass);
#else
                let overlap = contact.diameter - distance;
                let damping = contact.damping;
#end
                sum = with_contact(sum, normal, overlap, unpack(velocity[j]) - v, damping);
#end
#if attraction
                sum.force += contact.attraction * separation;
#end
            }
        }
    }
#if contact_walls
    sum = with_walls(sum, x, v);
#end
#if colliders
    sum = with_colliders(sum, x, v);
#end
    return sum;
}

// m/s²
fn acceleration_of(sum: ContactSum, v: Vector) -> Vector {
#if sizes
    var acceleration = sum.force * (contact.inverse_mass / mass_share(sum.size)) + first(parameters.gravity);
#else
    var acceleration = sum.force * contact.inverse_mass + first(parameters.gravity);
#end
#if global_damping
    acceleration -= contact.global_damping * v;
#end
    return acceleration;
}
