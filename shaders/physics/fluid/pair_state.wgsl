// What the forces of a pair are made of, side by side: two loads of 16 bytes bring a neighbor. The passes that find density
// and what boundary particles take on leave it for those that sum forces.
#import common/vector

struct PairState {
    place: vec4f, // position, m; w: ρ/ρ₀ − 1
    motion: vec4f, // velocity, m/s; w: pressure, Pa
}

fn pair_state_of(x: Vector, v: Vector, state: vec2f) -> PairState {
    return PairState(pack_with(x, state.x), pack_with(v, state.y));
}

#if writes_state
var<storage, read_write> pair_state: array<PairState>;
#else
#if of_one_body
// Between two steps, when velocities may be others than those that density was found with.
#import physics/present
#import physics/fluid/state

fn pair_state_at(i: u32) -> PairState {
    return pair_state_of(unpack(position[i]), unpack(velocity[i]), fluid_state[i]);
}
#else
var<storage, read> pair_state: array<PairState>;

fn pair_state_at(i: u32) -> PairState {
    return pair_state[i];
}
#end
#end
