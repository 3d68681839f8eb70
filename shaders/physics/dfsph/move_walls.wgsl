// Boundary particles at the end of a step.
#flag moves
#import common/thread
#import common/parameters
#import physics/time_step
#import physics/fluid/walls
#import physics/fluid/wall_motion
#import cells/images

var<storage, read> position: array<Packed>;
var<storage, read> id: array<u32>;
var<storage, read_write> next_position: array<Packed>;
var<storage, read_write> next_velocity: array<Packed>;
var<storage, read_write> next_id: array<u32>;

@compute @workgroup_size(GROUP_SIZE)
fn move_walls(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count || !is_wall(i) {
        return;
    }
    let v = wall_velocity(i);
    next_position[i] = pack(wrapped(unpack(position[i]) + time_step() * v.motion));
    next_velocity[i] = pack(v.motion + v.surface);
    next_id[i] = id[i];
}
