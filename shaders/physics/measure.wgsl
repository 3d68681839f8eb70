// What measures are divided by.

struct Measure {
    mass: f32, // of a grain, kg
    surface: f32, // of a grain, m² (its rim times one metre in 2D)
    block_volume: f32, // of the voxels that a search visits, m³ (times one metre in 2D)
    reference: vec4f, // where the potential energy is zero, m
}

var<uniform> measure: Measure;
