// What is known of densities before a step's are found.
#if continuity
var<storage, read> excess: array<f32>; // ρ/ρ₀ − 1

fn excess_before(i: u32) -> f32 {
    return excess[i];
}
#else
fn excess_before(i: u32) -> f32 {
    return 0.0;
}
#end
