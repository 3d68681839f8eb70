//! What a user writes about grains of several sizes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How large grains are, where they are not all of one size: radii between a smallest one and `grains.radius`, which is at most
/// four times as large, drawn with the scene's `seed`. Shares are shares of the number of grains, but for `sieve`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Sizes {
    /// All radii are equally frequent.
    Uniform {
        /// Smallest radius, metres.
        #[schemars(range(min = 1e-9, max = 1e6))]
        smallest: f64,
    },
    /// Normal distribution, cut off at both ends.
    Normal {
        /// Smallest radius, metres.
        #[schemars(range(min = 1e-9, max = 1e6))]
        smallest: f64,
        /// Mean radius before it is cut off, metres.
        #[schemars(range(min = 1e-9, max = 1e6))]
        mean: f64,
        /// Standard deviation of the radius before it is cut off, metres.
        #[schemars(range(min = 1e-12, max = 1e6))]
        deviation: f64,
    },
    /// Log-normal distribution, cut off at both ends.
    LogNormal {
        /// Smallest radius, metres.
        #[schemars(range(min = 1e-9, max = 1e6))]
        smallest: f64,
        /// Mean radius before it is cut off, metres.
        #[schemars(range(min = 1e-9, max = 1e6))]
        mean: f64,
        /// Standard deviation of the radius (not of its logarithm) before it is cut off, metres.
        #[schemars(range(min = 1e-12, max = 1e6))]
        deviation: f64,
    },
    /// A sieve curve, by mass. Between two rows it is a straight line.
    Sieve {
        /// From the smallest radius, which nothing passes, to `grains.radius`, which all passes.
        #[schemars(length(min = 2, max = 100))]
        curve: Vec<Sieve>,
    },
}

/// A row of a sieve curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sieve {
    /// Of the largest grains that pass, half the width of the mesh, metres.
    #[schemars(range(min = 1e-9, max = 1e6))]
    pub radius: f64,
    /// Share of the mass that passes, 0 to 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub passing: f64,
}

impl Sizes {
    /// Metres.
    pub fn smallest(&self) -> f64 {
        match self {
            Self::Uniform { smallest } | Self::Normal { smallest, .. } | Self::LogNormal { smallest, .. } => {
                *smallest
            }
            Self::Sieve { curve } => curve.first().map_or(0.0, |row| row.radius),
        }
    }
}
