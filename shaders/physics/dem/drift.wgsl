// First half of a velocity Verlet step (see velocity_verlet.wgsl): positions move, velocities are predicted.
#import common/thread
#import common/parameters
#import physics/guard
#if clamp_walls
#import physics/clamp_walls
#end

var<storage, read> position: array<Packed>;
var<storage, read> velocity: array<Packed>;
var<storage, read> acceleration: array<Packed>;
var<storage, read> id: array<u32>;
var<storage, read_write> next_position: array<Packed>;
var<storage, read_write> next_velocity: array<Packed>;
var<storage, read_write> next_acceleration: array<Packed>;
var<storage, read_write> next_id: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn drift(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count {
        return;
    }
    let dt = parameters.time_step;
    let x = unpack(position[i]);
    let a = unpack(acceleration[i]);
    var v = unpack(velocity[i]) + dt * a;
    var moved = x + dt * (v - 0.5 * dt * a);
#if clamp_walls
    clamp_to_walls(&moved, &v);
#end
    watch(id[i], clock.step, x, &moved, &v);
    next_position[i] = pack(moved);
    next_velocity[i] = pack(v);
    next_acceleration[i] = acceleration[i];
    next_id[i] = id[i];
}
