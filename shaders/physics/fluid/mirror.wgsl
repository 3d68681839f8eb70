// How often a neighbor's velocity counts in the divergence.
#if mirrored_walls
// A wall mirrors what comes near: the velocity goes on along a straight line beyond it.
const MIRRORED: f32 = 2.0;
#else
const MIRRORED: f32 = 1.0;
#end

fn mirrored(other: Neighbor) -> f32 {
    return select(1.0, MIRRORED, other.wall);
}
