// What every pass over particles needs. Written by the host between submissions (simulation::parameters).

struct Parameters {
    gravity: vec4f, // m/s²
    particle_count: u32,
    time_step: f32, // s
    free_count: u32, // of particles that are no boundary particles
    first_boundary: u32, // ids from here on are boundary particles
}

var<uniform> parameters: Parameters;
