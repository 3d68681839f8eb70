// Velocities after all forces but pressure (Bender and Koschier 2015, Algorithm 1), and the remainder that the pressure begins
// with.
#flag moves
#import common/thread
#import common/vector
#import common/parameters
#import physics/time_step
#import physics/fluid/boundary_particles
#import physics/dfsph/loop
#import physics/dfsph/own
#if implicit_viscosity
#import physics/dfsph/damping
#end

var<storage, read> position: array<Packed>; // w: the pressure's remainder in the step before, Pa
var<storage, read> velocity: array<Packed>; // w: pressure, Pa
#if boundary_particles
var<storage, read> id: array<u32>;
#end
#if implicit_viscosity
var<storage, read_write> damped: array<Packed>;
#else
var<storage, read_write> next_velocity: array<Packed>;
#end

// Share of the last step's remainder (remainder.wgsl) that a step begins with. What no neighbor sees decays.
const KEPT_REMAINDER: f32 = 0.95;

@compute @workgroup_size(GROUP_SIZE)
fn apply_forces(thread: Thread) {
    let i = item_index(thread);
    if i >= loop_count() || is_boundary(i) {
        return;
    }
    let v = unpack(velocity[i]);
    var acceleration = first(parameters.gravity);
#if drag
    acceleration += unpack(own[i].drag);
#end
    let forced = pack(v + time_step() * acceleration);
#if implicit_viscosity
    damped[section(DAMPED) + i] = forced;
    damped[section(DAMPED_AGAIN) + i] = forced;
    damped[section(FORCED) + i] = forced;
#else
    next_velocity[i] = forced;
#end
    own[i].impulse = KEPT_REMAINDER * time_step() * number_of(position[i]);
}
