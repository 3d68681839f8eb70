// Pa
var<storage, read> pressure: array<f32>;

fn column(i: u32) -> f32 {
    return pressure[i];
}
