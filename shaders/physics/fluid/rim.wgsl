// Sides of boundary particles end where an open side begins. Beyond that rim they go on as smooth planes, so that what
// splashes higher than a tank falls back into it.
#import common/vector

struct Rim {
    lower: vec4f, // where particles stay, m; far away on sides without boundary particles
    upper: vec4f,
    open_lower: vec4f, // open sides, m; far away where there is none
    open_upper: vec4f,
}

var<uniform> rim: Rim;

fn keep_within_rim(x: ptr<function, Vector>, v: ptr<function, Vector>) {
    let beyond = any(*x < first(rim.open_lower)) || any(*x > first(rim.open_upper));
    let kept = select(*x, clamp(*x, first(rim.lower), first(rim.upper)), beyond);
    *v = select(Vector(0.0), *v, kept == *x);
    *x = kept;
}
