//! Formulas of compressible fluids: what acts on a particle, a row and a shader file each.
//!
//! `shaders/physics/fluid/forces.wgsl` says what such a file holds. The formulas of a scene are called in the order of
//! these rows.

use crate::gpu::Variant;
use crate::scene::model::PressureForce;

/// What of a scene decides which formulas act.
#[derive(Debug, Clone, Copy, Default)]
pub struct Terms {
    /// Density follows the flow.
    pub continuity: bool,
    pub density_diffusion: bool,
    pub gradient_correction: bool,
    /// Negative pressures count as zero.
    pub clamped: bool,
    /// Negative pressures act through differences.
    pub controlled: bool,
    pub pressure_force: PressureForce,
    /// Müller's kernels.
    pub muller: bool,
    /// Forms of the viscous force.
    pub laplacian: bool,
    pub monaghan_gingold: bool,
    pub stress: bool,
    pub surface_tension: bool,
    /// Fluid slips along walls.
    pub slips: bool,
    pub artificial_viscosity: bool,
    pub wall_friction: bool,
    pub shifting: bool,
    /// Shifting acts along free surfaces only.
    pub along_surface: bool,
}

impl Terms {
    fn symmetric(&self) -> bool {
        self.pressure_force == PressureForce::Symmetric
    }

    fn sliding_walls(&self) -> bool {
        self.slips && (self.artificial_viscosity || self.wall_friction)
    }

    /// Walls along which fluid slips say nothing of the velocity's slope, which this needs.
    fn laplacian_correction(&self) -> bool {
        self.gradient_correction && self.laplacian && !self.muller && !self.slips
    }

    /// Whether a formula needs matrices.
    pub fn need_matrices(&self) -> bool {
        self.gradient_correction || self.stress || self.shifting || self.sliding_walls()
    }
}

/// A formula, and when it acts.
#[derive(Debug, Clone, Copy)]
pub struct Formula {
    /// File below `shaders/`, without its ending. Its last part is the formula's name.
    pub file: &'static str,
    pub acts: fn(&Terms) -> bool,
}

const fn row(file: &'static str, acts: fn(&Terms) -> bool) -> Formula {
    Formula { file, acts }
}

/// What changes a particle's velocity and place, besides gravity.
#[rustfmt::skip]
pub const FORCES: &[Formula] = &[
    row("physics/fluid/forces/surroundings", |t| t.controlled && t.symmetric() || t.along_surface),
    row("physics/fluid/forces/pressure_symmetric", Terms::symmetric),
    row("physics/fluid/forces/pressure_controlled", |t| t.symmetric() && t.controlled),
    row("physics/fluid/forces/pressure_monaghan", |t| t.pressure_force == PressureForce::Monaghan),
    row("physics/fluid/forces/pressure_difference", |t| t.pressure_force == PressureForce::Difference),
    row("physics/fluid/forces/laplacian_viscosity", |t| t.laplacian && !t.muller),
    row("physics/fluid/forces/muller_viscosity", |t| t.laplacian && t.muller),
    row("physics/fluid/forces/central_viscosity", |t| t.monaghan_gingold),
    row("physics/fluid/forces/stress_viscosity", |t| t.stress && !t.gradient_correction),
    row("physics/fluid/forces/stress_difference", |t| t.stress && t.gradient_correction),
    row("physics/fluid/forces/surface_tension", |t| t.surface_tension),
    row("physics/fluid/forces/walls_around", Terms::sliding_walls),
    row("physics/fluid/forces/artificial_viscosity", |t| t.artificial_viscosity),
    row("physics/fluid/forces/wall_damping", |t| t.artificial_viscosity && t.slips),
    row("physics/fluid/forces/wall_friction", |t| t.wall_friction),
    row("physics/fluid/forces/velocity_gradient", |t| t.shifting || t.laplacian_correction()),
    row("physics/fluid/forces/laplacian_correction", Terms::laplacian_correction),
    row("physics/fluid/forces/free_surface_shifting", |t| t.along_surface),
    row("physics/fluid/forces/shifting", |t| t.shifting),
];

/// What makes a particle's density.
#[rustfmt::skip]
pub const DENSITY: &[Formula] = &[
    row("physics/fluid/density/torn_fluid", |t| t.continuity && t.clamped),
    row("physics/fluid/density/gradient_correction", |t| t.gradient_correction),
    row("physics/fluid/density/summation", |t| !t.continuity),
    row("physics/fluid/density/continuity", |t| t.continuity && !t.gradient_correction),
    row("physics/fluid/density/corrected_continuity", |t| t.continuity && t.gradient_correction),
    row("physics/fluid/density/density_diffusion", |t| t.density_diffusion),
];

/// Gives the shaders a list: the files of those formulas that act.
pub fn list(name: &'static str, formulas: &[Formula], terms: &Terms, variant: &mut Variant) {
    let acting = formulas.iter().filter(|formula| (formula.acts)(terms));
    let files = acting.map(|formula| formula.file.to_owned()).collect();
    variant.list(name, files);
}
