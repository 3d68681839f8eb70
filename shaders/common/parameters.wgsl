// What every pass over particles needs. Written by the host between submissions (simulation::parameters).

struct Parameters {
    gravity: vec4f, // m/s²
    particle_count: u32,
    time_step: f32, // s
}

var<uniform> parameters: Parameters;
