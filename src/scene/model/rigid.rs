//! What a user writes about rigid bodies.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Coordinates;

/// A rigid body made of its particles, which keep their places in it (Harada 2007, GPU Gems 3, chapter 29). They cover it from
/// within, one layer deep. Mass and inertia are those of the solid shape, or of all its particles where these come from a file.
/// In a fluid they are boundary particles, as deep as the kernel reaches (Akinci et al. 2012): the body floats, sinks, and
/// pushes the fluid back with what it gets.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rigid {
    /// Mass over the volume of the shape, kg/m³ (a 2D body is one metre thick); `grains.density` or `fluid.density` when
    /// left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub density: Option<f64>,
    /// Angular velocity at the start, rad/s: about x, y and z, or in 2D one number, counter-clockwise; zero when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 3))]
    pub angular_velocity: Option<Vec<f64>>,
    /// Several bodies of this shape, on a lattice; one when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub copies: Option<Copies>,
    /// How a body in a fluid is drawn, as six hexadecimal digits; wood when left out. Grains are drawn one by one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<String>,
}

/// Bodies of one shape, on a lattice. The first stands where the shape does.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Copies {
    /// How many along each axis.
    #[schemars(length(min = 2, max = 3))]
    pub counts: Vec<u32>,
    /// Way from one to the next along each axis, metres.
    pub step: Coordinates,
    /// Whether each is turned at random about its center, by the scene's `seed`.
    #[serde(default)]
    pub random_rotation: bool,
}
