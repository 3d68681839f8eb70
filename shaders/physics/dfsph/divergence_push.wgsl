// What pressures do to velocities.
#flag moves
#import physics/time_step
#import physics/dfsph/push
#if boundary_particles
#import physics/dfsph/wall_lift
#end

var<storage, read> impulse: array<f32>; // Pa·s
var<storage, read_write> next_velocity: array<Packed>; // w: pressure, Pa

@compute @workgroup_size(GROUP_SIZE)
fn correct_velocity(thread: Thread) {
    let i = item_index(thread);
    if i < loop_count() && !is_boundary(i) {
        var push = push_on(i, MIRRORED);
        let pressure = number_of(next_velocity[i]);
#if boundary_particles
        push += time_step() * lifted(pressure) * unpack(walls[i].lift);
#end
        next_velocity[i] = pack_with(unpack(next_velocity[i]) + push, pressure);
    }
}
