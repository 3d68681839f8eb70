//! What colors the particles, and the range of values that the map spans.

use super::frame::{Frame, Report};
use super::model::{Axis, Cell, Look, SceneFile};
use super::synonyms::suggest_word;
use super::text::{list, number};
use super::{Coloring, Dimensions, Particles, color_maps, column, grain_materials};

/// What default ranges are derived from.
pub struct Known<'a> {
    pub file: &'a SceneFile,
    pub frame: &'a Frame,
    pub particles: &'a Particles,
    pub capacity: u32,
    /// m/s².
    pub gravity: f64,
}

pub fn coloring(known: &Known, report: &mut Report) -> Option<Coloring> {
    let mut color = known.file.render.color.clone();
    let own_colors = match known.file.render.look {
        // What has few neighbors is spray.
        Look::Water => Some("contacts"),
        // Each grain has a color by chance.
        Look::Clay | Look::Sand => Some("id"),
        Look::Splats | Look::Spheres | Look::Mesh => None,
    };
    if let Some(by) = own_colors {
        color.by = by.into();
        color.range = None;
        color.legend = false;
    }
    color.legend &= known.file.render.show.overlay;
    if color_maps::find(&color.map).is_none() {
        let names = color_maps::COLOR_MAPS.iter().map(|map| map.name);
        report.problem(
            "render.color.map",
            format!("no color map is called \"{}\"", color.map),
            suggest_word(&color.map, names),
        );
    }
    if let Some(range) = color.range {
        check_range(range, report);
    }
    let flat = known.frame.dimensions == Dimensions::Two;
    let names = column::COLUMNS.iter().map(|column| column.name);
    let names = names.filter(|name| !flat || !["z", "velocity_z"].contains(name));
    let materials = materials(known.file);
    let names = names.filter(|name| materials > 1 || *name != "material");
    let bodies = known.particles.body.iter().max().copied().unwrap_or(0);
    let names = names.filter(|name| bodies > 0 || *name != "body");
    let Some(column) = column::find(&color.by).filter(|column| names.clone().any(|name| name == column.name))
    else {
        let (what, help) = match column::find(&color.by) {
            Some(_) if color.by == "material" => (
                "all particles are of one material".to_owned(),
                format!(
                    "describe several fluids in fluid.materials, name one of grains.materials in bodies, or take one of {}",
                    list(names)
                ),
            ),
            Some(_) if color.by == "body" => (
                "no particle is part of a rigid body".to_owned(),
                format!("make bodies `rigid`, or take one of {}", list(names)),
            ),
            Some(_) => (
                format!("a 2D scene has no \"{}\"", color.by),
                format!("one of {}", list(names)),
            ),
            None => (
                format!("no column is called \"{}\"", color.by),
                suggest_word(&color.by, names),
            ),
        };
        report.problem("render.color.by", what, help);
        return None;
    };
    Some(Coloring {
        column,
        map: color.map.clone(),
        range: color.range.unwrap_or_else(|| default_range(column.name, known)),
        legend: color.legend,
    })
}

/// Colors are computed in f32, so both ends and their difference must fit it.
/// How many materials the particles are of, at most.
fn materials(file: &SceneFile) -> usize {
    match (&file.fluid, &file.grains) {
        (Some(fluid), _) => fluid.materials.len(),
        (None, Some(grains)) if grain_materials::are_mixed(file) => 1 + grains.materials.len(),
        _ => 1,
    }
}

fn check_range([low, high]: [f64; 2], report: &mut Report) {
    const LARGEST: f64 = 1e38;
    let path = "render.color.range";
    if low >= high {
        let what = format!("{} is not below {}", number(low), number(high));
        report.problem(path, what, "give the lower value first, or leave the range out");
    } else if low.abs().max(high.abs()) > LARGEST {
        let help = format!("stay between -{0} and {0}", number(LARGEST));
        report.problem(path, "too large", help);
    }
}

/// A range that the scene's physics makes likely and that stays the same in every frame.
fn default_range(column: &str, known: &Known) -> [f64; 2] {
    let Known { file, frame, .. } = known;
    let height = frame.max.y - frame.min.y;
    let extent = |axis: usize| {
        [
            frame.origin[axis] + frame.min[axis],
            frame.origin[axis] + frame.max[axis],
        ]
    };
    let dimensions = frame.dimensions.count();
    match column {
        "speed" => [0.0, typical_speed(known, height)],
        "velocity_x" | "velocity_y" | "velocity_z" => {
            let speed = typical_speed(known, height);
            [-speed, speed]
        }
        "x" => extent(0),
        "y" => extent(1),
        "z" => extent(2),
        "id" => [0.0, f64::from(known.capacity.max(2) - 1)],
        "contacts" if file.fluid.is_some() => [0.0, if dimensions == 2 { 30.0 } else { 80.0 }],
        "material" => {
            let materials = materials(file);
            [0.0, materials.max(2) as f64 - 1.0]
        }
        "radius" if file.sizes().is_some() => [file.smallest_radius(), file.radius()],
        "body" => {
            let bodies = known.particles.body.iter().max().copied().unwrap_or(0);
            [0.0, f64::from(bodies.max(1))]
        }
        // Grains of one size touch at most six others in a plane, twelve in space.
        "contacts" => [0.0, if dimensions == 2 { 6.0 } else { 12.0 }],
        "density" if file.fluid.is_some() => [0.97 * file.density(), 1.03 * file.density()],
        "density" => [0.0, file.density()],
        // That at the bottom of a heap as high as the domain.
        "pressure" if known.gravity > 0.0 => [0.0, file.density() * known.gravity * height],
        "pressure" => [0.0, 1e3],
        "slice" => {
            let extent = frame.max - frame.min;
            let along = match file.neighbors.slicing_axis.fixed() {
                Some(Axis::X) => extent.x,
                Some(Axis::Y) => extent.y,
                Some(Axis::Z) => extent.z,
                None => extent.max_element(),
            };
            let voxel = match file.neighbors.cell {
                Cell::Radius => 2.0 * file.radius(),
                Cell::Half => file.radius(),
            };
            [0.0, (along / voxel - 1e-6).ceil().max(1.0)]
        }
        _ => [0.0, 1.0],
    }
}

/// That of a fall from top to bottom, √(2 g H); without gravity the fastest grain's at the start.
fn typical_speed(known: &Known, height: f64) -> f64 {
    let fall = (2.0 * known.gravity * height).sqrt();
    let fastest = known
        .particles
        .velocity
        .iter()
        .map(|v| v.length())
        .fold(0.0, f32::max);
    match (fall, f64::from(fastest)) {
        (fall, _) if fall > 0.0 => fall,
        (_, fastest) if fastest > 0.0 => fastest,
        _ => 1.0,
    }
}
