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
    /// Drawn radius over the particle's radius.
    #[schemars(range(min = 0.01, max = 10.0))]
    pub splat_scale: f64,
    /// Colors of the particles, and their legend; water has a color of its own.
    pub color: Color,
    /// Where the eye is.
    pub camera: Camera,
    /// What lies behind the scene.
    pub background: Background,
    /// What else pictures show.
    pub show: Show,
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
            splat_scale: 1.0,
            color: Color::default(),
            camera: Camera::default(),
            background: Background::default(),
            show: Show::default(),
            antialias: 2,
            light: None,
        }
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
    /// The smooth surface of a clear liquid, which reflects the sky and refracts what lies behind it: screen-space fluid
    /// with a narrow-range filter (Truong and Yuksel 2018). Fluids in 3D have it.
    Water,
    /// One closed surface around the particles, lit, in the color of their values: a mesh that the device makes of each
    /// frame (Zhu and Bridson 2005). Fluids in 3D have it.
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
}

impl Default for Water {
    fn default() -> Self {
        Self {
            color: "#4fa6c4".into(),
            absorption_length: None,
            spray: true,
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
