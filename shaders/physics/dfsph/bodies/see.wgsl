// How fast the rigid bodies beside a particle of the fluid press it together, with the velocities that they have by now.
#flag moves
#import common/thread
#import common/parameters
#import physics/fluid/pairs
#import physics/dfsph/loop
#import physics/dfsph/own
#import physics/dfsph/walls
#import physics/dfsph/bodies/numbers

var<storage, read> next_velocity: array<Packed>;
var<storage, read_write> walls: array<Walls>;

// Rate at which velocities of boundary particles press the fluid together at particle i, 1/s; beside it, 1 where some of them
// are parts of rigid bodies.
fn approach_of(i: u32) -> vec2f {
    let x = unpack(position[i]);
    var approach = 0.0;
    var has_bodies = 0.0;
    let range = candidate_range(i, 1u);
    for (var slot = range.x; slot < range.y; slot += SLOT_STEP) {
        let j = candidate(slot);
        let s = toward(x, j);
        let slope = (dfsph.slope_volume * kernel_slope(length(s))) * s;
        if member_number(id[j]) < MEMBERS {
            has_bodies = 1.0;
            approach += dot(unpack(next_velocity[j]), slope);
        } else {
            approach += dot(unpack(velocity[j]), slope);
        }
    }
    return vec2f(approach, has_bodies);
}

// Once a step, before the pressure equation is made.
@compute @workgroup_size(GROUP_SIZE)
fn look_for_bodies(thread: Thread) {
    let i = item_index(thread);
    if i >= loop_count() || is_boundary(i) {
        return;
    }
    let found = approach_of(i);
    walls[i].pull.w = found.x;
    walls[i].lift.w = found.y;
}

// Whenever bodies have another velocity; the pressure equation takes it over.
@compute @workgroup_size(GROUP_SIZE)
fn see_bodies(thread: Thread) {
    let i = item_index(thread);
    if i >= loop_count() || is_boundary(i) || walls[i].lift.w == 0.0 {
        return;
    }
    let approach = approach_of(i).x;
    own[i].source += MIRRORED * (approach - walls[i].pull.w);
    walls[i].pull.w = approach;
}
