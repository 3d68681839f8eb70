// Index into the scene's fluids.
var<storage, read> material: array<u32>;

fn column(i: u32) -> f32 {
    return f32(material[i]);
}
