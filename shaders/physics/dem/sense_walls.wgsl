// Forces on walls and obstacles: the contacts of each grain with one of them, reversed.
#import common/thread
#import physics/present
#if rotation
#import physics/dem/friction
#import fields/angular_velocity
#if mixed_grains
#import fields/material
#end
#if rigid_bodies
#import fields/body_mass
#end
#else
#import physics/dem/law
#end
#import physics/sensors/target
#import physics/sensors/sweep
#if contact_walls
#import physics/dem/walls
#end
#if colliders
#import physics/dem/colliders
#end

fn force_on(i: u32) -> Vector {
    let x = unpack(position[i]);
    let v = unpack(velocity[i]);
    var sum = ContactSum();
#if rotation
    sum.grain = i;
    sum.rotation = unpack_rotation(angular_velocity[i]);
    sum.rest = rest_of(position[i]);
#if mixed_grains
    sum.material = material[i];
#end
#end
#if sizes
    sum.size = size_of(i);
    let own = LARGEST_RADIUS * sum.size;
#else
    let own = 0.5 * contact.diameter;
#end
#if rigid_bodies
    sum.body_mass = body_mass_of(i);
#end
    if sensed.target_body >= SIDE_TARGETS {
#if contact_walls
        let side = sensed.target_body - SIDE_TARGETS;
        let axis = side / 2u;
        let away = select(first(contact_walls.upper) - x, x - first(contact_walls.lower), side % 2u == 0u);
        var outwards = Vector(0.0);
        outwards[axis] = select(1.0, -1.0, side % 2u == 0u);
        sum = with_side(sum, outwards, own - away[axis], v);
#end
    } else {
#if colliders
        sum = with_collider(sum, sensed.target_body, x, v);
#end
    }
    return sum.force;
}

@compute @workgroup_size(GROUP_SIZE)
fn sense_walls(thread: Thread) {
    let share = share_of(thread, FIRST_FORCE_PROBE);
    sensed = probes[min(share.probe, FIRST_POINT_PROBE - 1u)];
    var reading = no_reading(PROBE_FORCE);
    for (var i = share.first; i < parameters.particle_count; i += share.step) {
        reading = add_readings(PROBE_FORCE, reading, pushed(-force_on(i), unpack(position[i])));
    }
    leave_reading(thread, share, FIRST_POINT_PROBE, PROBE_FORCE, reading);
}
