// Positions at the end of a step.
#flag moves
#import common/thread
#import common/parameters
#import physics/time_step
#import physics/guard
#import physics/fluid/boundary_particles
#import cells/images
#import physics/dfsph/loop
#import fields/position
// Before, how the particle goes, m/s; then its position. w: the pressure's remainder, Pa.
#import fields/next_position/write
#import fields/next_velocity/write
#import fields/velocity/pack
#import fields/next_correction/write
#import physics/dfsph/own
#if boundary_particles
#import fields/id
#end
#if faces
#import physics/fluid/rim
#end
#if adaptive_step
#import physics/extremes
#end

var<storage, read> convergence: Convergence; // of the loop of density

const EASY_ITERATIONS: u32 = 10u;

@compute @workgroup_size(GROUP_SIZE)
fn move_fluid(thread: Thread) {
    let i = item_index(thread);
    if i >= loop_count() || is_boundary(i) {
        return;
    }
    let x = unpack(position[i]);
    let pressure = number_of(next_velocity[i]);
    let remainder = number_of(next_position[i]);
    var v = unpack(next_velocity[i]);
    var moved = wrapped(x + time_step() * unpack(next_position[i]));
#if faces
    stop_at_faces(BEFORE_FACE, &moved, &v);
#if rim
    keep_within_rim(&moved, &v);
#end
#end
    watch(i, x, &moved, &v);
    next_position[i] = pack_with(moved, remainder);
    next_velocity[i] = pack_velocity(v, pressure);
    // A correction that was hard to find is of no use to the next step: in deep water it would grow.
    let is_easy = convergence.iteration <= EASY_ITERATIONS;
    next_correction[i] = select(0.0, own[i].impulse / time_step(), is_easy);
#if adaptive_step
    note_extremes(first(parameters.gravity), length(v), 0.0);
#end
}
