// What the impulses against divergence do to velocities.
#flag moves
#import physics/time_step
#import physics/dfsph/push

#if boundary_particles
// Beyond a wall, pressure goes on to grow with depth (Adami 2012, Eq. 27): what that does, per time, m/s².
var<storage, read> wall_lift: array<Packed>;
#end
var<storage, read_write> next_velocity: array<Packed>; // w: pressure, Pa

@compute @workgroup_size(GROUP_SIZE)
fn correct_velocity(thread: Thread) {
    let i = item_index(thread);
    if i < loop_count() && !is_boundary(i) {
        var push = push_on(i);
        let pressure = impulse[i] / time_step();
#if boundary_particles
        let weight = fluid.density * length(first(parameters.gravity)) * fluid.spacing;
        push += time_step() * clamp(2.0 * pressure / max(weight, 1e-30), 0.0, 1.0) * unpack(wall_lift[i]);
#end
        next_velocity[i] = pack_with(unpack(next_velocity[i]) + push, pressure);
    }
}
