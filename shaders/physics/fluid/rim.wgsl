// Closed sides as planes. Pressure holds the fluid before them; what it cannot hold stops at their faces. Sides of boundary
// particles end where an open side begins. Beyond that rim they go on as smooth planes, so that what splashes higher than a
// tank falls back into it.
#import common/vector
#import physics/fluid/coefficients

struct Rim {
    lower: vec4f, // half a spacing inside of closed sides, where particles at rest begin, m; far away on others
    upper: vec4f,
    open_lower: vec4f, // open sides, m; far away where there is none
    open_upper: vec4f,
}

var<uniform> rim: Rim;

// Where particles are put that come to a face, and how far a weakly compressible fluid may come by itself, in spacings beyond
// `lower` and `upper`.
const BEFORE_FACE: f32 = 0.4;
const FACE: f32 = 0.5;

// What comes farther than `reach` spacings is put before the face, and goes along it.
fn stop_at_faces(reach: f32, x: ptr<function, Vector>, v: ptr<function, Vector>) {
#if rim
    if any(*x < first(rim.open_lower)) || any(*x > first(rim.open_upper)) {
        return;
    }
#end
    let limit = reach * fluid.spacing;
    let margin = BEFORE_FACE * fluid.spacing;
    let beyond = (*x < first(rim.lower) - limit) | (*x > first(rim.upper) + limit);
    let kept = select(*x, clamp(*x, first(rim.lower) - margin, first(rim.upper) + margin), beyond);
    *v = select(Vector(0.0), *v, kept == *x);
    *x = kept;
}

fn keep_within_rim(x: ptr<function, Vector>, v: ptr<function, Vector>) {
    let beyond = any(*x < first(rim.open_lower)) || any(*x > first(rim.open_upper));
    let kept = select(*x, clamp(*x, first(rim.lower), first(rim.upper)), beyond);
    *v = select(Vector(0.0), *v, kept == *x);
    *x = kept;
}
