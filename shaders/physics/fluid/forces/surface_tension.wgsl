// Continuum surface force (Brackbill 1992). The curvature is how much normals turn along the surface, over what is seen of
// it (after Adami 2010, who counts the way across it too), as far as particles resolve it.
var<storage, read> surface_normal: array<Packed>;

struct SurfaceTension {
    normal: Vector, // gradient of the color, into the fluid, 1/m
    direction: Vector, // of it
    turned: f32, // of the normals around, 1/m
    seen: f32,
}

fn surface_tension_begin(own: Own, forces: ptr<function, Forces>) {
    let normal = unpack(surface_normal[own.index]);
    forces.surface_tension.normal = normal;
    forces.surface_tension.direction = normal / max(length(normal), 1e-30);
}

// Boundary particles have no normals.
fn surface_tension_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    let direction = forces.surface_tension.direction;
    let beside = unpack(surface_normal[other.index]);
    let steepness = length(beside);
    let on_surface = !other.beyond && steepness > 0.0 && same_material(own.index, other.index);
    let part = select(0.0, other.weight, on_surface);
    let along = other.s - dot(other.s, direction) * direction;
    forces.surface_tension.turned -= part * dot(beside / max(steepness, 1e-30) - direction, along);
    forces.surface_tension.seen -= part * dot(along, along);
}

// Half of the color's slope lies outside, so what lies inside counts twice.
fn surface_tension_end(own: Own, forces: ptr<function, Forces>) {
    let sums = forces.surface_tension;
    let sharpest = 0.5 * f32(DIMENSIONS - 1u) / fluid.spacing;
    let curvature = clamp(-f32(DIMENSIONS - 1u) * sums.turned / max(sums.seen, 1e-30), -sharpest, sharpest);
    forces.push += (2.0 * own.material.surface_tension * curvature) * sums.normal;
}
