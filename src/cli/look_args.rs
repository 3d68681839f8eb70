//! Arguments that say how pictures look, for whatever draws some.

#[derive(clap::Args, Default)]
pub struct LookArgs {
    /// What the particles are drawn as: one splat each, one lit sphere each, the smooth surface of water,
    /// a mesh around all of them (both for fluids in 3D), or matte grains of clay or sand
    #[arg(long, value_parser = ["splats", "spheres", "water", "mesh", "clay", "sand"])]
    look: Option<String>,
    /// Writes extra images of each frame, for compositing: color, depth, normal, id, velocity, motion
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    #[arg(value_parser = ["color", "depth", "normal", "id", "velocity", "motion"])]
    passes: Vec<String>,
    /// Files of extra images: one OpenEXR file per frame, or 16-bit PNGs [default: exr]
    #[arg(long, value_name = "FORMAT", value_parser = ["exr", "png"])]
    pass_files: Option<String>,
    /// Blurs what moves: share of the time between frames during which the shutter is open, 0.5 as in films; each frame is then
    /// drawn 16 times, or as render.subframes says
    #[arg(long, value_name = "SHARE")]
    shutter: Option<f64>,
    /// Leaves text and legends out of pictures
    #[arg(long)]
    no_overlay: bool,
}

impl LookArgs {
    /// Hands each key of the scene that they change to `put`, with its value where it has one.
    pub fn put(&self, put: &mut impl FnMut(&str, Option<String>)) {
        put("render.look", self.look.clone());
        let passes = (!self.passes.is_empty()).then(|| format!("{:?}", self.passes));
        put("render.passes", passes);
        put("render.pass_files", self.pass_files.clone());
        put("render.shutter", self.shutter.map(|shutter| shutter.to_string()));
        put("render.show.overlay", self.no_overlay.then(|| "false".to_owned()));
    }

    pub fn is_given(&self) -> bool {
        self.look.is_some()
            || self.no_overlay
            || self.shutter.is_some()
            || !self.passes.is_empty()
            || self.pass_files.is_some()
    }
}
