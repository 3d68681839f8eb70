// Forces on walls and obstacles: the part of each particle's force that comes from one body, reversed. So the fluid's
// momentum changes by what gravity and the bodies give it.
#flag of_one_body
#import physics/fluid/sensed_walls
#import physics/fluid/forces
#import physics/sensors/sweep

@compute @workgroup_size(GROUP_SIZE)
fn sense_walls(thread: Thread) {
    let share = share_of(thread, FIRST_FORCE_PROBE);
    sensed = probes[min(share.probe, FIRST_POINT_PROBE - 1u)];
    var reading = no_reading(PROBE_FORCE);
    for (var i = share.first; i < parameters.particle_count; i += share.step) {
        if is_boundary(i) {
            continue;
        }
        let mass = material_of(i).density * fluid.volume;
        let found = pushed(-mass * forces_on(i).acceleration, unpack(position[i]));
        reading = add_readings(PROBE_FORCE, reading, found);
    }
    leave_reading(thread, share, FIRST_POINT_PROBE, PROBE_FORCE, reading);
}
