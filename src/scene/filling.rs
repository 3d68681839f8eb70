//! Fluid that fills its boxes from wall to wall.
//!
//! Few boxes are a whole number of spacings long. A lattice of exactly the spacing would hold less than the box and leave a
//! gap at one of its walls, into which the fluid falls. So each axis takes the whole number that is nearest, its particles
//! stand evenly, and the spacing becomes the one whose particles hold together what the boxes do.

use glam::DVec3;

use super::frame::Report;
use super::model::{Arrangement, Body, Coordinates, SceneFile, Shape};
use super::text::number;

/// Share by which a spacing may change, or a body hold more or less than its box, before that is told.
const TOLD: f64 = 1e-3;
/// A lattice that misses a box by a smaller share fits it but for rounding: files may hold f32.
const ROUNDING: f64 = 1e-6;

/// The lattice that fills a box.
#[derive(Clone, Copy)]
pub struct Filling {
    /// Particles along x, y and z; 1 along z in 2D.
    pub counts: DVec3,
    /// How much they are farther apart than a spacing; 1 for what fits.
    pub stretch: DVec3,
}

/// Gives the fluid the spacing whose particles hold together what its boxes do, and tells what changed. Where something has
/// a spacing of its own, which must suit the fluid's, the fluid's stays as it is.
///
/// Returns how to fill each of the fluid's boxes; none for other bodies.
pub fn fit_spacing(file: &mut SceneFile, report: &mut Report) -> Vec<Option<Filling>> {
    let mut fillings = vec![None; file.bodies.len()];
    let Some(given) = file.fluid.as_ref().map(|fluid| fluid.spacing) else {
        return fillings;
    };
    let sized = |(i, body)| Some((i, size(body, file.dimensions)?));
    let sizes = file.bodies.iter().enumerate().filter_map(sized);
    let boxes: Vec<Block> = sizes.filter_map(|(i, size)| Block::new(i, size, given)).collect();
    let is_own = file.bodies.iter().any(|body| body.spacing.is_some())
        || file.emitters.iter().any(|emitter| emitter.spacing.is_some());
    let all = boxes.iter().map(Block::volume).sum::<f64>();
    let number_of_all = boxes.iter().map(Block::number).sum::<f64>();
    let mut spacing = given;
    if !is_own && number_of_all > 0.0 {
        spacing = (all / number_of_all).powf(1.0 / f64::from(file.dimensions));
    }
    if (spacing / given - 1.0).abs() < ROUNDING {
        spacing = given;
    }
    if let Some(fluid) = &mut file.fluid {
        fluid.spacing = spacing;
    }
    if (spacing / given - 1.0).abs() > TOLD {
        report.notes.push(format!(
            "fluid.spacing: {} m became {} m, with which particles fill the bodies' boxes from side to side",
            number(given),
            number(spacing)
        ));
    }
    for filled in boxes {
        fillings[filled.body] = Some(filled.filling(spacing));
        let held = filled.number() * spacing.powi(file.dimensions as i32) / filled.volume();
        if (held - 1.0).abs() > TOLD {
            report.notes.push(format!(
                "bodies[{}]: its sides are not whole numbers of spacings, and its particles hold {:.1} % {} than the box; sides \
                 of whole spacings ({} m) hold just as much",
                filled.body,
                100.0 * (held - 1.0).abs(),
                if held > 1.0 { "more" } else { "less" },
                number(given)
            ));
        }
    }
    fillings
}

/// A box with the particles that go into it.
struct Block {
    body: usize,
    /// Along x, y and, in 3D, z, metres.
    sides: Vec<f64>,
    /// Particles along each.
    counts: Vec<f64>,
}

impl Block {
    /// None for a box too thin for a particle.
    fn new(body: usize, sides: Vec<f64>, spacing: f64) -> Option<Self> {
        let counts: Vec<f64> = sides.iter().map(|side| (side / spacing).round()).collect();
        let has_room = counts.iter().all(|&count| count > 0.0);
        has_room.then_some(Self { body, sides, counts })
    }

    /// m³ (m² in 2D).
    fn volume(&self) -> f64 {
        self.sides.iter().product()
    }

    fn number(&self) -> f64 {
        self.counts.iter().product()
    }

    fn filling(&self, spacing: f64) -> Filling {
        let (mut counts, mut stretch) = (DVec3::ONE, DVec3::ONE);
        for (axis, (&side, &count)) in self.sides.iter().zip(&self.counts).enumerate() {
            let along = side / (count * spacing);
            counts[axis] = count;
            if (along - 1.0).abs() > ROUNDING {
                stretch[axis] = along;
            }
        }
        Filling { counts, stretch }
    }
}

/// Of a box that a lattice of the fluid's spacing fills. None for other bodies, and for boxes that are told as wrong
/// elsewhere.
fn size(body: &Body, dimensions: u32) -> Option<Vec<f64>> {
    let Shape::Box { min, max } = &body.shape else {
        return None;
    };
    if body.spacing.is_some() || body.arrangement == Some(Arrangement::Random) || body.rigid.is_some() {
        return None;
    }
    let at = |point: &Coordinates, axis: u32| point.0.get(axis as usize).copied();
    let side = |axis| Some(at(max, axis)? - at(min, axis)?).filter(|&side| side > 0.0);
    (0..dimensions).map(side).collect()
}
