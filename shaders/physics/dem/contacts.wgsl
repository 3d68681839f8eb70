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
    return pairing;
#end
}

// The contact of grain i with grain j, at this distance of their centers.
fn with_grain(sum: ContactSum, j: u32, normal: Vector, distance: f32, approach: Vector) -> ContactSum {
    let overlap = contact.diameter - distance;
#if measuring
    let touch = Touch(0.0, normal, overlap, 0.5 * distance, approach, Rotation(), Vector(0.0));
#else
    let other = angular_velocity[j];
    let rest = rest_of(position[j]);
    let touch = Touch(number_of(other), normal, overlap, 0.5 * distance, approach, unpack_rotation(other), rest);
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
            if within(separation, contact.reach) && j != i {
#else
            if within(separation, contact.diameter) && j != i {
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
                let overlap = contact.diameter - distance;
                sum = with_contact(sum, normal, overlap, unpack(velocity[j]) - v, contact.damping);
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
    var acceleration = sum.force * contact.inverse_mass + first(parameters.gravity);
#if global_damping
    acceleration -= contact.global_damping * v;
#end
    return acceleration;
}
