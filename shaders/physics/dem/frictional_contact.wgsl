// Coefficients of contacts of grains that rotate.
#import physics/dem/pairing

struct FrictionalContact {
    grains: Pairing,
    walls: Pairing,
    diameter: f32, // m
    reach: f32, // distance within which centers may come to touch during half a step, m
    inverse_mass: f32, // 1/kg
    inverse_inertia: f32, // 1/(kg·m²)
    inertia: f32, // kg·m²
    global_damping: f32, // 1/s
    farthest: f32, // more than any coordinate, m
    cohesion_range: f32, // distance of surfaces at which cohesion ends, m
}

var<uniform> contact: FrictionalContact;
