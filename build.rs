//! Shaders, scenes and meshes are embedded; cargo does not notice new files there by itself.
fn main() {
    for folder in ["shaders", "assets/scenes", "assets/meshes", "assets/fonts"] {
        println!("cargo:rerun-if-changed={folder}");
    }
}
