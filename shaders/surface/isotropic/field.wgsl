// The distance of a point from the weighted mean of the particles around it, less a radius (Zhu and Bridson 2005, Section 5).
//
// One thing is added: no point of the surface is farther than `farthest` from a particle, and less far where there are few.
// Between two drops the mean would else be a third one.
#import surface/surface
#import surface/mirrors
#import surface/unit

var<storage, read> surface_kernel: array<vec4f>; // place of a particle; w: 0 where it has no part in the surface

// What a point knows of the particles around it; places count from it.
struct Field {
    weight: f32, // sum
    mean: vec3f, // weighted sum, m
    nearest: f32, // m²
    outward: vec3f, // away from the mean by weights that fall off slowly, m: for normals
}

fn no_field() -> Field {
    return Field(0.0, vec3f(0.0), 1e36, vec3f(0.0));
}

fn add_particle(field: ptr<function, Field>, j: u32, image: Image) {
    let particle = surface_kernel[j];
    let y = image.direction * (particle.xyz - image.at);
    let distance = dot(y, y);
    let square = surface.reach * surface.reach;
    if distance >= square || particle.w == 0.0 {
        return;
    }
    let share = 1.0 - distance / square;
    let weight = share * share * share;
    (*field).weight += weight;
    (*field).mean += weight * y;
    (*field).outward -= share * y;
    (*field).nearest = min((*field).nearest, distance);
}

// Sums of weights around a drop and above a surface, and how far from a drop its surface may be, as a share.
const FEW: f32 = 1.0;
const MANY: f32 = 4.0;
const FARTHEST_ALONE: f32 = 0.67;

// 0 around a drop, 1 where there are as many particles as at a surface.
fn crowd(field: Field) -> f32 {
    return saturate((field.weight - FEW) / (MANY - FEW));
}

// Of the particles alone, m.
fn value_of(field: Field) -> f32 {
    if field.weight <= 0.0 {
        return surface.reach;
    }
    let farthest = surface.farthest * mix(FARTHEST_ALONE, 1.0, crowd(field));
    return max(length(field.mean / field.weight) - surface.radius, sqrt(field.nearest) - farthest);
}

// Away from a mean of the particles, which is smoother than the gradient. Farther particles would turn the normals of drops and
// strands.
fn outward_of(field: Field) -> vec3f {
    return mix(unit_of(-field.mean), unit_of(field.outward), crowd(field));
}
