// A particle has a part in the implicit function where it stands, the same in all directions.
#import surface/surface

var<storage, read_write> surface_kernel: array<vec4f>; // KERNEL_VECTORS per particle

// Images of the particle's surroundings that its kernel follows from.
const IMAGES: u32 = 0u;

struct Moments {
    nothing: u32,
}

fn add_moment(moments: ptr<function, Moments>, y: vec3f) {
}

fn write_kernel(i: u32, x: vec3f, moments: Moments) {
    surface_kernel[i] = vec4f(x, 1.0);
}

fn write_no_kernel(i: u32) {
    surface_kernel[i] = vec4f(0.0);
}
