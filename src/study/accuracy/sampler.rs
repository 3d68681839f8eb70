//! What particles say at points between them: kernel sums over their positions, in f64.

use std::collections::HashMap;
use std::f64::consts::PI;

use glam::{DVec3, IVec3};

use super::least_squares;

/// Radius of the kernel over the spacing of particles.
pub const REACH: f64 = 2.5;
/// Points along an axis that a kernel's share of a box is counted with.
const POINTS: i32 = 50;

/// Particles of equal volume, found by place, weighted by a Wendland C2 kernel.
pub struct Sampler<'a> {
    position: &'a [DVec3],
    dimensions: usize,
    /// m.
    spacing: f64,
    /// Lengths of a periodic box, m; zero along axes that are not periodic.
    period: DVec3,
    /// Widths of the cells, at least the kernel's radius.
    width: DVec3,
    /// Cells along periodic axes; zero along others.
    cells: IVec3,
    members: HashMap<IVec3, Vec<usize>>,
}

impl<'a> Sampler<'a> {
    /// `position` in metres, z = 0 in 2D; a particle stands for a volume of `spacing` to the power of `dimensions`.
    ///
    /// # Panics
    ///
    /// Where a periodic box is narrower than two kernels.
    pub fn new(position: &'a [DVec3], dimensions: usize, spacing: f64, period: Option<DVec3>) -> Self {
        assert!(dimensions == 2 || dimensions == 3);
        let radius = REACH * spacing;
        let period = period.unwrap_or(DVec3::ZERO);
        let mut width = DVec3::splat(radius);
        let mut cells = IVec3::ZERO;
        for axis in 0..3 {
            if period[axis] > 0.0 {
                assert!(period[axis] >= 2.0 * radius, "a periodic box holds two kernels");
                cells[axis] = (period[axis] / radius).floor() as i32;
                width[axis] = period[axis] / f64::from(cells[axis]);
            }
        }
        let mut sampler = Self {
            position,
            dimensions,
            spacing,
            period,
            width,
            cells,
            members: HashMap::new(),
        };
        for (index, &place) in position.iter().enumerate() {
            let cell = sampler.wrapped((place / width).floor().as_ivec3());
            sampler.members.entry(cell).or_default().push(index);
        }
        sampler
    }

    fn wrapped(&self, mut cell: IVec3) -> IVec3 {
        for axis in 0..3 {
            if self.cells[axis] > 0 {
                cell[axis] = cell[axis].rem_euclid(self.cells[axis]);
            }
        }
        cell
    }

    /// Each particle within the kernel's radius of `at`, with its volume times the kernel.
    fn weights(&self, at: DVec3) -> Vec<(usize, f64)> {
        let home = (at / self.width).floor().as_ivec3();
        let mut around = Vec::with_capacity(27);
        for x in -1..=1 {
            for y in -1..=1 {
                for z in -1..=1 {
                    around.push(self.wrapped(home + IVec3::new(x, y, z)));
                }
            }
        }
        // In a small periodic box a cell can lie on both sides.
        around.sort_unstable_by_key(|cell| cell.to_array());
        around.dedup();
        let found = around.iter().filter_map(|cell| self.members.get(cell)).flatten();
        found
            .map(|&index| (index, self.weight(self.position[index] - at)))
            .filter(|(_, weight)| *weight > 0.0)
            .collect()
    }

    /// The way to the nearest image.
    fn nearest(&self, mut away: DVec3) -> DVec3 {
        for axis in 0..3 {
            if self.period[axis] > 0.0 {
                away[axis] -= self.period[axis] * (away[axis] / self.period[axis]).round();
            }
        }
        away
    }

    fn weight(&self, away: DVec3) -> f64 {
        kernel(
            self.dimensions,
            self.nearest(away).length() / (REACH * self.spacing),
        )
    }

    /// Sum of volumes times kernel: about 1 inside the fluid, ½ on its surface, 0 outside.
    pub fn filling(&self, at: DVec3) -> f64 {
        self.weights(at).iter().map(|(_, weight)| weight).sum()
    }

    /// Interpolates one vector a particle: moving least squares (Lancaster and Salkauskas 1981) with a parabola, exact for
    /// fields of second order at walls too. None where too few particles are near.
    pub fn vector(&self, at: DVec3, value: &[DVec3]) -> Option<DVec3> {
        let samples = self.weights(at).into_iter().map(|(index, weight)| {
            let away = self.nearest(self.position[index] - at) / (REACH * self.spacing);
            (away, weight, value[index])
        });
        least_squares::parabola(samples, self.dimensions)
    }

    /// What a sensor in a wall shows of one value per particle: its mean over the kernel's part inside the box, of which
    /// air counts as zero. `full` is the [`share`] of the same place.
    pub fn on_wall(&self, at: DVec3, value: &[f64], full: f64) -> f64 {
        let weights = self.weights(at);
        let all: f64 = weights.iter().map(|(_, weight)| weight).sum();
        let sum: f64 = weights.iter().map(|&(index, weight)| weight * value[index]).sum();
        sum / all.max(full)
    }

    /// Depth of the water on a line upwards (y) in 3D: the volume over an area, weighted by the kernel of two
    /// dimensions, of what is at most `most` above `floor`, m. What a wire shows that measures how much of it is wet;
    /// unlike [`Self::height`] it means something where water is broken up. Sides have to be out of the kernel's reach.
    pub fn depth(&self, floor: DVec3, most: f64) -> f64 {
        let near = |place: &&DVec3| place.y - floor.y <= most;
        let aside = |place: &DVec3| {
            self.nearest((*place - floor) * DVec3::new(1.0, 0.0, 1.0))
                .length()
        };
        let weight = |place: &DVec3| kernel(2, aside(place) / (REACH * self.spacing));
        self.position.iter().filter(near).map(weight).sum::<f64>() * self.spacing
    }

    /// Height of the water above `floor` (m): the highest point on the line upwards (y) from it where the filling is
    /// above one half, up to `most`; 0 where there is none. A particle that flies alone is no water.
    pub fn height(&self, floor: DVec3, most: f64) -> f64 {
        let wet = |height: f64| self.filling(floor + DVec3::Y * height) > 0.5;
        let step = 0.25 * self.spacing;
        let steps = (most / step).ceil() as u32;
        let Some(found) = (0..=steps).rev().map(|i| f64::from(i) * step).find(|&h| wet(h)) else {
            return 0.0;
        };
        // The surface lies between this point and the next one above.
        let (mut low, mut high) = (found, found + step);
        for _ in 0..20 {
            let middle = 0.5 * (low + high);
            if wet(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low.min(most)
    }
}

/// Share of a kernel around `at` that lies inside a box: 1 inside, ½ at a side, ¼ at an edge.
pub fn share(at: DVec3, dimensions: usize, spacing: f64, min: DVec3, max: DVec3) -> f64 {
    let step = 2.0 * REACH * spacing / f64::from(POINTS);
    let place = |k: i32| (f64::from(k) + 0.5 - 0.5 * f64::from(POINTS)) * step;
    let deep = if dimensions == 2 { 1 } else { POINTS };
    let mut sum = 0.0;
    for x in 0..POINTS {
        for y in 0..POINTS {
            for z in 0..deep {
                let depth = if deep == 1 { 0.0 } else { place(z) };
                let away = DVec3::new(place(x), place(y), depth);
                let point = at + away;
                if point == point.clamp(min, max) {
                    sum += kernel(dimensions, away.length() / (REACH * spacing));
                }
            }
        }
    }
    sum * (step / spacing).powi(dimensions as i32)
}

/// Wendland C2, integral one over a ball of radius `REACH`; `part` is the distance over the radius.
fn kernel(dimensions: usize, part: f64) -> f64 {
    if part >= 1.0 {
        return 0.0;
    }
    let at_zero = match dimensions {
        2 => 7.0 / (PI * REACH.powi(2)),
        _ => 21.0 / (2.0 * PI * REACH.powi(3)),
    };
    at_zero * (1.0 - part).powi(4) * (1.0 + 4.0 * part)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPACING: f64 = 0.05;

    /// Particles at the middles of the lattice's cells, displaced by up to `jitter` spacings.
    fn block(cells: [u32; 3], jitter: f64) -> Vec<DVec3> {
        let mut places = Vec::new();
        for x in 0..cells[0] {
            for y in 0..cells[1] {
                for z in 0..cells[2].max(1) {
                    let n = f64::from(x * 7919 + y * 104_729 + z * 1_299_709);
                    let off = DVec3::new(n.sin(), (1.3 * n).sin(), (1.7 * n).sin()) * jitter;
                    let depth = if cells[2] == 0 { 0.0 } else { 1.0 };
                    let flat = DVec3::new(1.0, 1.0, depth);
                    let middle = DVec3::new(x.into(), y.into(), z.into()) + 0.5;
                    places.push((middle + off) * flat * SPACING);
                }
            }
        }
        places
    }

    #[test]
    fn parabolas_are_exact_in_corners_too() {
        for cells in [[20, 20, 0], [20, 20, 20]] {
            let places = block(cells, 0.1);
            let dimensions = if cells[2] == 0 { 2 } else { 3 };
            let sampler = Sampler::new(&places, dimensions, SPACING, None);
            let field = |p: DVec3| {
                DVec3::new(
                    3.5,
                    2.0 * p.x - p.y + p.z,
                    p.x * p.x - 3.0 * p.x * p.y + p.z * p.y,
                )
            };
            let values: Vec<DVec3> = places.iter().map(|&p| field(p)).collect();
            let z = if dimensions == 2 { 0.0 } else { 0.5 };
            for (x, y) in [(0.5, 0.5), (0.33, 0.71), (0.02, 0.03)] {
                let at = DVec3::new(x, y, z);
                let found = sampler.vector(at, &values).unwrap();
                assert!((found - field(at)).length() < 1e-9, "{at}: {found}");
            }
            assert_eq!(sampler.vector(DVec3::splat(-1.0), &values), None);
        }
    }

    #[test]
    fn sensors_in_walls_see_air() {
        for cells in [[20, 10, 0], [20, 10, 20]] {
            let places = block(cells, 0.0);
            let dimensions = if cells[2] == 0 { 2 } else { 3 };
            let z = if dimensions == 2 { 0.0 } else { 0.5 };
            let max = DVec3::new(1.0, 1.0, if dimensions == 2 { 0.0 } else { 1.0 });
            let sampler = Sampler::new(&places, dimensions, SPACING, None);
            let pressure = vec![2.0; places.len()];
            let shown = |y: f64| {
                let at = DVec3::new(0.0, y, z);
                sampler.on_wall(at, &pressure, share(at, dimensions, SPACING, DVec3::ZERO, max))
            };
            assert!((sampler.filling(DVec3::new(0.5, 0.25, z)) - 1.0).abs() < 0.1);
            assert!((shown(0.25) - 2.0).abs() < 0.05, "{}", shown(0.25));
            assert!((shown(0.01) - 2.0).abs() < 0.1, "{}", shown(0.01));
            assert!((shown(0.5) - 1.0).abs() < 0.05, "{}", shown(0.5));
            assert_eq!(shown(0.9), 0.0);
        }
    }

    #[test]
    fn a_periodic_box_has_no_sides() {
        let places = block([20, 20, 0], 0.0);
        let wave = |x: f64| (2.0 * PI * x).sin();
        let values: Vec<DVec3> = places
            .iter()
            .map(|p| DVec3::new(wave(p.x), wave(p.y), 0.0))
            .collect();
        let sampler = Sampler::new(&places, 2, SPACING, Some(DVec3::new(1.0, 1.0, 0.0)));
        // Also where particles have left the box and come in on the other side.
        for shift in [0.0, 1.0, -3.0] {
            for x in [0.0, 0.01, 0.5, 0.99] {
                let at = DVec3::new(x + shift, 0.25, 0.0);
                assert!(
                    (sampler.filling(at) - 1.0).abs() < 0.02,
                    "{x}: {}",
                    sampler.filling(at)
                );
                let found = sampler.vector(at, &values).unwrap();
                assert!(
                    (found.x - wave(x)).abs() < 0.005 && (found.y - 1.0).abs() < 0.005,
                    "{x}: {found}"
                );
            }
        }
    }

    #[test]
    fn heights_end_at_the_surface() {
        for cells in [[20, 12, 0], [20, 12, 20]] {
            let mut places = block(cells, 0.0);
            let dimensions = if cells[2] == 0 { 2 } else { 3 };
            // A drop above the water.
            places.push(DVec3::new(0.5, 0.9, if dimensions == 2 { 0.0 } else { 0.5 }));
            let sampler = Sampler::new(&places, dimensions, SPACING, None);
            let floor = DVec3::new(0.5, 0.0, if dimensions == 2 { 0.0 } else { 0.5 });
            let height = sampler.height(floor, 1.0);
            assert!((height - 0.6).abs() < 0.1 * SPACING, "{height}");
            assert_eq!(sampler.height(floor + DVec3::X * 2.0, 1.0), 0.0);
            if dimensions == 3 {
                // The drop counts where the line is long enough.
                let (water, all) = (sampler.depth(floor, 0.8), sampler.depth(floor, 1.0));
                // Within the error of the kernel's sum over a lattice.
                assert!((water - 0.6).abs() < 0.2 * SPACING, "{water}");
                let drop = 7.0 / (PI * REACH.powi(2)) * SPACING;
                assert!((all - water - drop).abs() < 1e-9, "{all}");
                assert_eq!(sampler.depth(floor + DVec3::X * 2.0, 1.0), 0.0);
            }
        }
    }
}
