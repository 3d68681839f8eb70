//! How frames look, as scene files say it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Axis;

/// How frames look.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Render {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// What pictures show: the scene, the index pool or both.
    pub view: View,
    /// What the particles are drawn as.
    pub look: Look,
    /// What a particle looks like where `look` is `splats`.
    pub splat: Splat,
    /// What water looks like where `look` is `water`.
    pub water: Water,
    /// How a surface is made of particles, where `look` is `mesh` and where water's surface is one.
    pub mesh: MeshStyle,
    /// Drawn radius over the particle's radius.
    #[schemars(range(min = 0.01, max = 10.0))]
    pub splat_scale: f64,
    /// Colors of the particles, and their legend; `water`, `clay` and `sand` have colors of their own.
    pub color: Color,
    /// Where the eye is.
    pub camera: Camera,
    /// What lies behind the scene.
    pub background: Background,
    /// What else pictures show.
    pub show: Show,
    /// Extra images of each frame, for compositing. Lines, slices and water's refraction are in none but `color`, text in none.
    pub passes: Vec<ImagePass>,
    /// Files that extra images are written to.
    pub pass_files: PassFiles,
    /// Share of the time from one frame to the next during which the shutter is open, around the frame's own time: what moves
    /// is blurred. 0 is a moment. Each frame is drawn `subframes` times.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub shutter: f64,
    /// Pictures that a frame is the mean of, where `shutter` or `camera.aperture` blur.
    #[schemars(range(min = 2, max = 256))]
    pub subframes: u32,
    /// Samples along each side of a pixel.
    #[schemars(range(min = 1, max = 4))]
    pub antialias: u32,
    /// Direction towards the light; chosen to suit the camera when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light: Option<[f64; 3]>,
}

impl Default for Render {
    fn default() -> Self {
        Self {
            size: [1280, 720],
            view: View::default(),
            look: Look::default(),
            splat: Splat::default(),
            water: Water::default(),
            mesh: MeshStyle::default(),
            splat_scale: 1.0,
            color: Color::default(),
            camera: Camera::default(),
            background: Background::default(),
            show: Show::default(),
            passes: Vec::new(),
            pass_files: PassFiles::default(),
            shutter: 0.0,
            subframes: 16,
            antialias: 2,
            light: None,
        }
    }
}

impl Render {
    /// Whether each picture is drawn from particles where they stand, so that there are extra images and blur.
    pub fn follows_particles(&self) -> bool {
        match self.look {
            Look::Splats | Look::Spheres | Look::Clay | Look::Sand => true,
            Look::Water => self.water.surface == WaterSurface::Screen,
            Look::Mesh => false,
        }
    }

    /// Whether a frame is the mean of several pictures.
    pub fn is_blurred(&self) -> bool {
        self.shutter > 0.0 || self.camera.aperture > 0.0
    }
}

/// What pictures show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum View {
    /// The scene.
    #[default]
    Scene,
    /// The index pool as a heatmap (Harada 2007, Figure 7).
    Pool,
    /// The scene, and the pool beside it.
    Both,
}

/// What the particles are drawn as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Look {
    /// One sphere or disc per particle, as `splat` says, in the color of its value.
    #[default]
    Splats,
    /// One lit sphere per particle, whatever `splat` says, in the color of its value.
    Spheres,
    /// The smooth surface of a clear liquid, which reflects the sky and refracts what lies behind it. Fluids in 3D have it.
    Water,
    /// One closed surface around the particles, lit, in the color of their values: a mesh that the device makes of each
    /// frame. Fluids in 3D have it.
    Mesh,
    /// One matte lump of clay per particle, dented; each has its own shade of one color.
    Clay,
    /// One matte grain of sand per particle, with broken faces and specks; each has its own color of sand.
    Sand,
}

/// An extra image of a frame. All but `color` hold what the middle of each pixel sees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ImagePass {
    /// The picture without text, as linear light multiplied by its alpha.
    Color,
    /// Distance from the eye along the view's axis, metres.
    Depth,
    /// Unit normal in the scene's axes, on the eye's side.
    Normal,
    /// 1 + the particle's id; 4294967295 − the number of the obstacle; 0 elsewhere.
    Id,
    /// Velocity in the scene's axes, m/s.
    Velocity,
    /// Where what is seen will be in the next frame, pixels to the right and up from where it is now; with the camera's own motion.
    Motion,
}

/// Files that extra images are written to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PassFiles {
    /// One OpenEXR file per frame, with a layer for each image; exact values.
    #[default]
    Exr,
    /// One PNG per image and frame, 16 bits per channel; `run.json` says how numbers are written. It cannot hold `velocity`.
    Png,
}

/// How a surface is made of particles.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MeshStyle {
    /// What each particle adds to the function that the surface is the zero of.
    pub kernel: SurfaceKernel,
}

/// What each particle adds to the function that a surface is the zero of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SurfaceKernel {
    /// An ellipsoid as flat as what is around the particle: sheets stay thin (Yu and Turk 2013).
    Anisotropic,
    /// The same in all directions: the distance from the mean of the particles around (Zhu and Bridson 2005).
    #[default]
    Isotropic,
}

/// What the surface of water is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WaterSurface {
    /// Spheres as the eye sees them, smoothed by a narrow-range filter (Truong and Yuksel 2018); the cost follows the picture's
    /// size.
    #[default]
    Screen,
    /// A mesh around the particles, made on the device; the cost follows their number. It has neither extra images nor blur.
    Mesh,
}

/// What water looks like.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Water {
    /// What is left of white light after `absorption_length` of water, as #rrggbb.
    pub color: String,
    /// Metres of water after which white light has the color `color`; a share of the domain's size when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub absorption_length: Option<f64>,
    /// Whether particles with few neighbors are white spray; otherwise they are clear drops.
    pub spray: bool,
    /// What the surface is made of.
    pub surface: WaterSurface,
}

impl Default for Water {
    fn default() -> Self {
        Self {
            color: "#4fa6c4".into(),
            absorption_length: None,
            spray: true,
            surface: WaterSurface::default(),
        }
    }
}

/// What a particle looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Splat {
    /// Lit spheres with true depth (Green 2012).
    #[default]
    Sphere,
    /// Flat discs (Rojas 2013).
    Disc,
}

/// Colors of the particles.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Color {
    /// The column that colors the particles: see `sliceflow scenes --columns`.
    pub by: String,
    /// Name of a color map: see `sliceflow scenes --color-maps`.
    pub map: String,
    /// Values at the two ends of the map; derived from the scene, then fixed, when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
    /// Whether a color bar with numbers and unit is drawn.
    pub legend: bool,
}

impl Default for Color {
    fn default() -> Self {
        Self {
            by: "speed".into(),
            map: "viridis".into(),
            range: None,
            legend: true,
        }
    }
}

/// Where the eye is; it frames the domain when `eye` and `target` are left out.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Camera {
    /// Whether what is far looks small.
    pub projection: Projection,
    /// Looks down this axis (an orthographic view as in Harada 2007, Figure 2).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axis: Option<Axis>,
    /// Where the eye is, metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eye: Option<[f64; 3]>,
    /// What the eye looks at, metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<[f64; 3]>,
    /// Vertical angle of view, degrees.
    #[schemars(range(min = 1.0, max = 150.0))]
    pub field_of_view: f64,
    /// Height of an orthographic view, metres; frames the domain when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-9, max = 1e9))]
    pub height: Option<f64>,
    /// Turn about the vertical axis through the target, degrees per simulated second.
    pub orbit: f64,
    /// Where the eye and what it looks at are at some moments, in order of time, in place of `eye` and `target`. Before the
    /// first and after the last moment the camera rests.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub path: Vec<CameraPoint>,
    /// How the camera moves between the points of its path.
    pub easing: Easing,
    /// Diameter of the lens, metres: what is not in `focus` is blurred. 0 is a pinhole, which sees everything sharp.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub aperture: f64,
    /// Distance along the view's axis that is sharp, metres; that of the target when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-9, max = 1e9))]
    pub focus: Option<f64>,
}

impl Camera {
    /// Whether it moves with time.
    pub fn moves(&self) -> bool {
        self.orbit != 0.0 || self.path.len() > 1
    }
}

/// Where the camera is at a moment. Each point of a path gives the same keys.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CameraPoint {
    /// When, seconds.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub at: f64,
    /// Where the eye is, metres; `camera.eye` when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eye: Option<[f64; 3]>,
    /// What the eye looks at, metres; `camera.target` when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<[f64; 3]>,
}

/// How a camera moves between the points of its path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Easing {
    /// Along straight lines, gently: it leaves each point from rest and comes to rest at the next.
    #[default]
    Smooth,
    /// Along straight lines at a constant speed.
    Linear,
    /// Along a cubic spline, past the points without a stop; it begins and ends at rest.
    Spline,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            projection: Projection::default(),
            axis: None,
            eye: None,
            target: None,
            field_of_view: 35.0,
            height: None,
            orbit: 0.0,
            path: Vec::new(),
            easing: Easing::default(),
            aperture: 0.0,
            focus: None,
        }
    }
}

/// How the scene becomes flat.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Projection {
    /// What is far looks small.
    #[default]
    Perspective,
    /// Size does not depend on distance.
    Orthographic,
}

/// What lies behind the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Background {
    /// A soft grey gradient.
    #[default]
    Studio,
    /// A dark grey.
    Dark,
    /// Plain white.
    White,
    /// Plain black.
    Black,
    /// Nothing: pictures have alpha, and the floor is the shadows that fall on it. Videos show them over white.
    Transparent,
}

/// What pictures show besides particles.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Show {
    /// The domain box, in red lines (Harada 2007, Figure 2).
    pub domain: bool,
    /// A floor that takes shadows, at the domain's lower side (3D).
    pub floor: bool,
    /// The slices that `sliced` allocated, as translucent green boxes (Harada 2007, Figure 2).
    pub slices: bool,
    /// Obstacles, those with `visible` set.
    pub colliders: bool,
    /// Name of the scene, time and particle count in a corner.
    pub caption: bool,
    /// Text and legends over pictures; without them there is neither caption nor color bar.
    pub overlay: bool,
}

impl Default for Show {
    fn default() -> Self {
        Self {
            domain: true,
            floor: true,
            slices: false,
            colliders: true,
            caption: true,
            overlay: true,
        }
    }
}
