// The density of the particles, each spread over a kernel of its own (Yu and Turk 2013, Eq. 4 and 5): flat where the particles
// around it lie flat, so that surfaces are smooth and sheets stay thin.
//
// One thing is added: no point of the surface is farther than `farthest` from a kernel's center.
#import surface/surface
#import surface/mirrors
#import surface/unit
#import surface/anisotropic/kernel

// Two vectors per particle (anisotropic/fit.wgsl).
var<storage, read> surface_kernel: array<vec4u>;

struct Field {
    density: f32, // over that of the fluid
    gradient: vec3f, // 1 / spacing
    nearest: f32, // m²
}

fn no_field() -> Field {
    return Field(0.0, vec3f(0.0), 1e36);
}

fn add_particle(field: ptr<function, Field>, j: u32, image: Image) {
    let center = surface_kernel[2u * j];
    let y = bitcast<vec3f>(center.xyz) - image.at;
    let distance = dot(y, y);
    if distance >= surface.reach * surface.reach || center.w == 0u {
        return;
    }
    (*field).nearest = min((*field).nearest, distance);
    let shape = surface_kernel[2u * j + 1u];
    let xx_yy = unpack2x16float(shape.x);
    let zz_yz = unpack2x16float(shape.y);
    let xz_xy = unpack2x16float(shape.z);
    let stretch = Symmetric(vec3f(xx_yy, zz_yz.x), vec3f(zz_yz.y, xz_xy));
    let g = applied(stretch, y / surface.spacing);
    let share = max(1.0 - dot(g, g), 0.0);
    let weight = bitcast<f32>(shape.w) * share * share;
    (*field).density += weight * share;
    (*field).gradient += image.direction * (6.0 * weight * applied(stretch, g));
}

// Density on the surface. That it is below a half makes up for centers that are drawn inward: a flat surface is half a spacing
// above the topmost particles.
const ON_SURFACE: f32 = 0.28;

// Of the particles alone, m.
fn value_of(field: Field) -> f32 {
    return max(surface.spacing * (ON_SURFACE - field.density), sqrt(field.nearest) - surface.farthest);
}

fn outward_of(field: Field) -> vec3f {
    return unit_of(-field.gradient);
}
