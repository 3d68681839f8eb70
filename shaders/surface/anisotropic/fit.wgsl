// The kernel of a particle: stretched along where the particles around it are, and drawn toward their mean (Yu and Turk 2013,
// Eq. 6 to 16). Instead of by clamped singular values the stretch is found by inverses of matrices, so that it never jumps.
#import surface/surface
#import surface/anisotropic/kernel

// Two vectors per particle: center (m; w: 0 where it has no part in the surface); G as six half floats, and what the kernel has
// at its center.
var<storage, read_write> surface_kernel: array<vec4u>;

// Images of the particle's surroundings that its kernel follows from.
const IMAGES: u32 = 8u;

// Weighted sums over the particles around, whose places count from the particle, in reaches.
struct Moments {
    weight: f32,
    mean: vec3f,
    squares: Symmetric,
}

fn add_moment(moments: ptr<function, Moments>, y: vec3f) {
    let at = y / surface.reach;
    let distance = length(at);
    let weight = max(1.0 - distance * distance * distance, 0.0);
    (*moments).weight += weight;
    (*moments).mean += weight * at;
    (*moments).squares.diagonal += weight * at * at;
    (*moments).squares.beside += weight * at.yxx * at.zzy;
}

// Variance along each axis amid the fluid, in square reaches.
const USUAL_VARIANCE: f32 = 0.15;
// What keeps kernels from being flatter than a quarter, and longer than the reach.
const LEAST: f32 = 0.33;
const SATURATION: f32 = 0.3;
// Radius of a kernel amid the fluid, in reaches, and of a drop's, as a share of that.
const RADIUS: f32 = 0.9;
const ALONE: f32 = 0.33;
// Sums of weights of a drop, and of a particle in a sheet.
const FEW: f32 = 2.0;
const MANY: f32 = 6.0;
// How far the center is drawn toward the mean.
const DRAWN: f32 = 0.5;

fn write_kernel(i: u32, x: vec3f, moments: Moments) {
    let mean = moments.mean / moments.weight;
    let crowd = saturate((moments.weight - FEW) / (MANY - FEW));
    let scale = crowd / (moments.weight * USUAL_VARIANCE * (1.0 + LEAST));
    let least = mix(ALONE, LEAST / (1.0 + LEAST), crowd);
    // Radii over that amid the fluid.
    var radii = Symmetric(
        scale * (moments.squares.diagonal - moments.mean * mean) + least,
        scale * (moments.squares.beside - moments.mean.yxx * mean.zzy),
    );
    let inverse = minors(radii);
    let determinant = determinant_of(radii);
    let unit = surface.spacing / (RADIUS * surface.reach * (1.0 + SATURATION));
    let stretch = Symmetric(
        unit * (inverse.diagonal / determinant + SATURATION),
        unit * inverse.beside / determinant,
    );
    let center = x + surface.reach * DRAWN * crowd * mean;
    surface_kernel[2u * i] = vec4u(bitcast<vec3u>(center), 1u);
    surface_kernel[2u * i + 1u] = vec4u(
        pack2x16float(stretch.diagonal.xy),
        pack2x16float(vec2f(stretch.diagonal.z, stretch.beside.x)),
        pack2x16float(stretch.beside.yz),
        bitcast<u32>(BALL * determinant_of(stretch)),
    );
}

fn write_no_kernel(i: u32) {
    surface_kernel[2u * i] = vec4u(0u);
}
