// kg/m³
var<storage, read> density: array<f32>;

fn column(i: u32) -> f32 {
    return density[i];
}
