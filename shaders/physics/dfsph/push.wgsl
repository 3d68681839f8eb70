// The second pass of an iteration: what impulses do to a velocity.
#import common/thread
#import physics/fluid/coefficients
#import physics/fluid/walls
#import common/vector
#import common/parameters
#import <kernel>
#import <candidates>
#import cells/images
#import physics/dfsph/loop

var<storage, read> id: array<u32>;
var<storage, read> pressure_point: array<Packed>;

// Change of velocity by the impulses beside the points, m/s. Walls have none of their own
// (Akinci 2012): so what impulses do is the exact counterpart of the rate that they act against (solve.wgsl), and no energy
// comes from nowhere. The pressure of the row along a wall then carries for both.
fn push_on(i: u32) -> Vector {
    let mine = pressure_point[i];
    let x = unpack(mine);
    var push = Vector(0.0);
    let home = around(i, x);
    for (var k = 0u; k < RANGES; k++) {
        let range = candidate_range(home, k);
        for (var slot = range.x; slot < range.y; slot++) {
            let j = candidate(slot);
            let other = pressure_point[j];
            let s = nearest_image(unpack(other) - x);
            let impulse = mine.w + select(other.w, 0.0, is_wall(j));
            push += (impulse * kernel_slope(length(s))) * s;
        }
    }
    return (fluid.volume / fluid.density) * push;
}
