//! What others published of the same cases: error and time.

/// One program's runs of a case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Published {
    pub method: &'static str,
    /// Where the figures are from.
    pub source: &'static str,
    pub points: &'static [Point],
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// As the case counts it.
    pub resolution: u32,
    /// In the unit of the case's figure.
    pub error: f64,
    /// Wall seconds per simulated second, where they are known.
    pub wall_per_simulated: Option<f64>,
}

const fn point(resolution: u32, error: f64) -> Point {
    Point {
        resolution,
        error,
        wall_per_simulated: None,
    }
}

const fn timed(resolution: u32, error: f64, wall_per_simulated: f64) -> Point {
    Point {
        resolution,
        error,
        wall_per_simulated: Some(wall_per_simulated),
    }
}

const PYSPH: &str =
    "PySPH 1.0b2 in double precision on one core of a two-core machine, measured for Sliceflow";

/// Taylor–Green in 2D, Re 100, to t = 2: L1 of speed in percent.
pub const TAYLOR_GREEN: &[Published] = &[
    Published {
        method: "PySPH, EDAC (f64, one core)",
        source: PYSPH,
        points: &[
            timed(25, 2.75, 6.0),
            timed(50, 1.93, 29.0),
            timed(100, 1.38, 209.5),
        ],
    },
    Published {
        method: "PySPH, transport velocity (f64, one core)",
        source: PYSPH,
        points: &[timed(25, 17.0, 5.0), timed(50, 9.0, 24.5), timed(100, 5.0, 205.0)],
    },
    Published {
        method: "PySPH, plain WCSPH (f64)",
        source: PYSPH,
        points: &[point(25, 59.0), point(50, 52.0)],
    },
];

/// Still water with Adami's walls, 45 spacings deep (4,500 particles), at t = 2 s: L1 of pressure over the floor's, in
/// percent; the best of several variants, which gave up to 0.67.
pub const STILL_WATER: &[Published] = &[Published {
    method: "PySPH, Adami's walls (f64, one core)",
    source: PYSPH,
    points: &[timed(45, 0.29, 48.5)],
}];

/// Start of Poiseuille and Couette flow: root mean square of the velocity error over the largest velocity, in percent.
pub const CHANNEL: &[Published] = &[Published {
    method: "Project Chrono, SPH",
    source: "root mean square of 5e-3 at 20 particles across, read in Project Chrono",
    points: &[point(20, 0.5)],
}];

const LIGGGHTS: &str = "LIGGGHTS-FLOWLAB, audit of its physics";

/// Head-on collisions with a linear spring and dashpot: the worst error of e (`assets/reference/dem_restitution_error_vs_dt.csv`).
pub const COLLISION: &[Published] = &[Published {
    method: "LIGGGHTS (f64)",
    source: LIGGGHTS,
    points: &[point(50, 4.5e-3), point(200, 1.4e-3), point(1000, 4.1e-4)],
}];

/// Elastic gas of 64 spheres, 300 to 700 collisions: |relative drift of the energy|
/// (`assets/reference/dem_energy_drift_vs_dt.csv`).
pub const ELASTIC_GAS: &[Published] = &[Published {
    method: "LIGGGHTS (f64)",
    source: LIGGGHTS,
    points: &[
        point(20, 1e-3),
        point(50, 7.3e-5),
        point(100, 2.4e-5),
        point(200, 6.6e-6),
    ],
}];

impl Published {
    /// The error at a resolution.
    pub fn error_at(&self, resolution: u32) -> Option<f64> {
        let found = self.points.iter().find(|point| point.resolution == resolution);
        found.map(|point| point.error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::accuracy::reference::Table;

    #[test]
    fn figures_of_grains_are_those_of_the_tables() {
        for (published, table, column) in [
            (COLLISION, "dem_restitution_error_vs_dt", "worst_abs_e_error"),
            (ELASTIC_GAS, "dem_energy_drift_vs_dt", "hooke_drift"),
        ] {
            let table = Table::shipped(table).unwrap();
            let points = table.points("steps_per_contact", column).unwrap();
            assert_eq!(points.len(), published[0].points.len());
            for (steps, error) in points {
                assert_eq!(
                    published[0].error_at(steps as u32),
                    Some(error.abs()),
                    "{column} at {steps}"
                );
            }
        }
    }
}
