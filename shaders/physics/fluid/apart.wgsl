// Two particles in one place, or nearly so: the kernel has hardly a slope there that could part them, and no direction. They
// push each other as at a distance, in a direction that follows from where they stand in memory, which is the same in every run.
#import common/vector
#import common/shuffle
#import physics/fluid/coefficients

// Such pairs are nearer than this, in spacings, and count as so far apart.
const COINCIDENT: f32 = 0.01;
const COUNTED: f32 = 0.5;

// From particle i to particle j as forces see it, where it is s.
fn apart(s: Vector, i: u32, j: u32) -> Vector {
    let least = COINCIDENT * fluid.spacing;
    if dot(s, s) >= least * least {
        return s;
    }
    let bits = shuffled(shuffled(min(i, j)) ^ max(i, j));
    // No component is ever zero.
    let aside = vec3f(vec3u(bits, bits >> 10u, bits >> 20u) & vec3u(1023u)) - 511.5;
    let direction = normalize(first(vec4f(aside, 0.0)));
    return select(-1.0, 1.0, i < j) * COUNTED * fluid.spacing * direction;
}
