//! Whether a fluid has a free surface.

use std::collections::HashMap;

use glam::{DVec3, IVec3, Vec3};

use super::frame::Frame;
use super::model::Wall;

/// Share of a lattice's neighbors that a particle has at least inside a fluid. Beside a flat surface it is 0.6.
const SURROUNDED: f64 = 0.7;

/// Whether a particle of the fluid, at its start, has nothing beside it: neither fluid nor a wall. `reach` is how far
/// particles see, metres.
pub fn there(fluid: &[Vec3], walls: &[Vec3], frame: &Frame, spacing: f64, reach: f64) -> bool {
    let period = DVec3::from([0, 1, 2].map(|axis: usize| match frame.sides[axis] {
        [Wall::Periodic, _] => frame.max[axis] - frame.min[axis],
        _ => 0.0,
    }));
    let cells = Cells::new(fluid, walls, period, reach);
    let enough = SURROUNDED * lattice_neighbors(frame.dimensions.count(), reach / spacing);
    fluid.iter().any(|&at| {
        let at = at.as_dvec3();
        // Planes are not made of particles.
        !frame.beside_planes(at, reach) && (cells.count(at) as f64) < enough
    })
}

/// Neighbors of a lattice's point nearer than `reach` spacings.
fn lattice_neighbors(dimensions: usize, reach: f64) -> f64 {
    let most = reach.ceil() as i32;
    let ticks = |axis: usize| if axis < dimensions { -most..=most } else { 0..=0 };
    let mut count = 0;
    for x in ticks(0) {
        for y in ticks(1) {
            for z in ticks(2) {
                let square = f64::from(x * x + y * y + z * z);
                count += i32::from(square > 0.0 && square < reach * reach);
            }
        }
    }
    f64::from(count)
}

/// Particles by cells that are as wide as they see, or a little wider where space repeats.
struct Cells {
    members: HashMap<IVec3, Vec<DVec3>>,
    side: DVec3,
    /// Cells along directions in which space repeats, else zero.
    count: IVec3,
    period: DVec3,
    reach: f64,
}

impl Cells {
    fn new(fluid: &[Vec3], walls: &[Vec3], period: DVec3, reach: f64) -> Self {
        let count = (period / reach).floor().as_ivec3();
        let side = |axis: usize| match count[axis] {
            0 if period[axis] > 0.0 => period[axis],
            0 => reach,
            n => period[axis] / f64::from(n),
        };
        let repeats = |axis: usize| {
            if period[axis] > 0.0 { count[axis].max(1) } else { 0 }
        };
        let mut cells = Self {
            members: HashMap::new(),
            side: DVec3::from([0, 1, 2].map(side)),
            count: IVec3::from([0, 1, 2].map(repeats)),
            period,
            reach,
        };
        for at in fluid.iter().chain(walls).map(|at| at.as_dvec3()) {
            let home = cells.wrapped((at / cells.side).floor().as_ivec3());
            cells.members.entry(home).or_default().push(at);
        }
        cells
    }

    fn wrapped(&self, cell: IVec3) -> IVec3 {
        IVec3::from([0, 1, 2].map(|axis| match self.count[axis] {
            0 => cell[axis],
            count => cell[axis].rem_euclid(count),
        }))
    }

    /// Others nearer than `reach`.
    fn count(&self, at: DVec3) -> usize {
        let home = (at / self.side).floor().as_ivec3();
        let around = |n: i32| self.wrapped(home + IVec3::new(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
        let mut cells: Vec<IVec3> = (0..27).map(around).collect();
        cells.sort_unstable_by_key(|cell| cell.to_array());
        cells.dedup();
        let others = cells.iter().filter_map(|cell| self.members.get(cell)).flatten();
        let near = others.filter(|&&other| {
            let apart = DVec3::from([0, 1, 2].map(|axis: usize| {
                let apart = other[axis] - at[axis];
                match self.period[axis] {
                    0.0 => apart,
                    period => apart - period * (apart / period).round(),
                }
            }));
            let square = apart.length_squared();
            square > 0.0 && square < self.reach * self.reach
        });
        near.count()
    }
}
