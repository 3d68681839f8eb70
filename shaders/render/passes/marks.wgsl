// What a pixel's mark says: 0 where there is nothing, 1 + the slot of a particle, or the bit below and a triangle of an
// obstacle.
const OBSTACLE: u32 = 0x80000000u;

struct Mark {
    @location(0) mark: u32,
    @builtin(frag_depth) depth: f32,
}
