// Walls that move a grain back inside and reverse its normal speed, times a restitution factor (Green 2012).
#import common/vector

struct ClampWalls {
    lower: vec4f, // bounds of the grains' centers, m; far away on sides that do not clamp
    upper: vec4f,
    restitution: f32,
}

var<uniform> clamp_walls: ClampWalls;

fn clamp_to_walls(x: ptr<function, Vector>, v: ptr<function, Vector>) {
    let inside = clamp(*x, first(clamp_walls.lower), first(clamp_walls.upper));
    let outwards = (*x - inside) * *v;
    *v = select(*v, -clamp_walls.restitution * *v, outwards > Vector(0.0));
    *x = inside;
}
