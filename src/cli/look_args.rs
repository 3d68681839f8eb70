//! Arguments that say how pictures look, for whatever draws some.

#[derive(clap::Args, Default)]
pub struct LookArgs {
    /// What the particles are drawn as: one splat each, one lit sphere each, the smooth surface of water,
    /// or a mesh around all of them (both for fluids in 3D)
    #[arg(long, value_parser = ["splats", "spheres", "water", "mesh"])]
    look: Option<String>,
    /// Leaves text and legends out of pictures
    #[arg(long)]
    no_overlay: bool,
}

impl LookArgs {
    /// Hands each key of the scene that they change to `put`, with its value where it has one.
    pub fn put(&self, put: &mut impl FnMut(&str, Option<String>)) {
        put("render.look", self.look.clone());
        put("render.show.overlay", self.no_overlay.then(|| "false".to_owned()));
    }

    pub fn is_given(&self) -> bool {
        self.look.is_some() || self.no_overlay
    }
}
