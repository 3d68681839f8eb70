// Velocities after all forces but pressure (Bender and Koschier 2015, Algorithm 1).
#flag moves
#import common/thread
#import common/vector
#import common/parameters
#import physics/time_step
#import physics/fluid/boundary_particles
#import physics/dfsph/loop

var<storage, read> velocity: array<Packed>; // w: pressure, Pa
#if boundary_particles
var<storage, read> id: array<u32>;
#end
// Before, the acceleration by drag, m/s²; then velocity, m/s.
var<storage, read_write> next_velocity: array<Packed>;

@compute @workgroup_size(GROUP_SIZE)
fn apply_forces(thread: Thread) {
    let i = item_index(thread);
    if i >= loop_count() || is_boundary(i) {
        return;
    }
    let v = unpack(velocity[i]);
    var acceleration = first(parameters.gravity);
#if drag
    acceleration += unpack(next_velocity[i]);
#end
    next_velocity[i] = pack(v + time_step() * acceleration);
}
