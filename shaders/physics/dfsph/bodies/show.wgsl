// Velocities of the particles of rigid bodies, behind begin.wgsl.
#flag moves
#import common/thread
#import physics/dfsph/bodies/motion

var<storage, read> member: array<Member>;
var<storage, read_write> next_velocity: array<Packed>;

@compute @workgroup_size(GROUP_SIZE)
fn show_bodies(thread: Thread) {
    let number = item_index(thread);
    if number < MEMBERS {
        let mine = member[number];
        next_velocity[mine.slot] = pack(velocity_at(body_state[mine.body], mine.place.xyz));
    }
}
