// What is known of densities before a step's are found.
#if continuity
var<storage, read> density_deviation: array<f32>; // ρ/ρ₀ − 1

fn deviation_before(i: u32) -> f32 {
    return density_deviation[i];
}
#else
fn deviation_before(i: u32) -> f32 {
    return 0.0;
}
#end
