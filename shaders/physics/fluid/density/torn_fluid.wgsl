// Where pressures are never negative: how thin fluid gets that is torn apart, and drops.

// A particle has left the fluid where the divergence of positions (Lee 2008), which is DIMENSIONS inside, is below this:
// one neighbor or two at most.
const SEVERED: f32 = 0.15 * f32(DIMENSIONS);

struct TornFluid {
    surrounded: f32, // divergence of positions
}

fn torn_fluid_pair(own: Own, other: Neighbor, density: ptr<function, Density>) {
    density.torn_fluid.surrounded -= other.weight * dot(other.s, other.s);
}

// Torn fluid keeps close to rest density: it would have to be pressed together again before a wall could hold it. What has
// left the fluid is under the air's pressure: with the one that it left at, drops would hover on each other as a gas does.
fn torn_fluid_limit(own: Own, density: ptr<function, Density>) {
    let kept = max(density.deviation, fluid.lowest_deviation);
    density.deviation = select(kept, min(kept, 0.0), density.torn_fluid.surrounded < SEVERED);
}
