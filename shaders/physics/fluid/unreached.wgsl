// Once a search, the state of boundary particles out of reach: no fluid is beside them.
#flag writes_state
#import common/thread
#import common/vector
#import physics/fluid/boundary_particles
#import physics/fluid/beside
#import storage/lists/reach_word
#import fields/position
#if continuity
#import fields/velocity/write
#import fields/velocity/pack
#else
#import fields/velocity
#end

@compute @workgroup_size(GROUP_SIZE)
fn extend_to_unreached(thread: Thread) {
    let i = item_index(thread);
    if i >= parameters.particle_count || !is_boundary(i) || is_reached(i) {
        return;
    }
    let v = unpack(velocity[i]);
    extend(i, unpack(position[i]), v, Beside());
#if continuity
    // As a step would leave it.
    velocity[i] = pack_velocity(v, fluid_state[i].x);
#end
}
