var<storage, read> contacts: array<u32>;

fn column(i: u32) -> f32 {
    return f32(contacts[i]);
}
