//! What sensors find in a run's particle files, on the host, as the device finds it while a run is made.

use std::path::Path;

use glam::{DMat2, DMat3, DVec2, DVec3, Vec3};

use super::{header, rows, tables};
use crate::error::{Error, Result};
use crate::output::folder::Folder;
use crate::output::read_back::{ReadBack, Snapshot};
use crate::physics::kernels;
use crate::physics::sensors::{LEAST_FILLING, flux_reach, least_spread, surface_filling, volume_and_density};
use crate::scene::fluid::Fluid;
use crate::scene::model::{FluidSolver, SensorField};
use crate::scene::sensors::{Kind, Sensor, layer};
use crate::scene::{Dimensions, Scene};
use crate::simulation::Sample;

/// Points of a line per spacing of particles, and halvings of the distance between them.
const POINTS_PER_SPACING: f64 = 4.0;
const BISECTIONS: u32 = 16;

/// Tables of what sensors found: name and text of each.
pub struct Found {
    pub tables: Vec<(String, String)>,
    /// Frames that had particles to look at.
    pub frames: usize,
    /// Names of the sensors that were left out, since no particle file holds forces.
    pub left_out: Vec<String>,
    scene: Scene,
}

impl Found {
    /// Writes the tables and their charts into a folder, which must not hold such tables yet unless they may be replaced.
    pub fn save(&self, path: &Path, replace: bool) -> Result<()> {
        std::fs::create_dir_all(path)
            .map_err(|reason| crate::output::disk::failed(path, "create", reason))?;
        let folder = Folder::existing(path)?;
        for (name, text) in &self.tables {
            let file = path.join(name);
            if file.exists() && !replace {
                return Err(Error::usage(
                    format!("{} is there already", file.display()),
                    "replace it with --force, or choose another folder with --out",
                ));
            }
            if file.exists() && !super::is_table(&file) {
                return Err(Error::usage(
                    format!(
                        "{} is no table of sensors that Sliceflow has written",
                        file.display()
                    ),
                    "move it to another place, or choose another folder with --out",
                ));
            }
            crate::output::write_file(&file, text.as_bytes())?;
        }
        super::draw(&self.scene, &folder)
    }
}

/// Has the sensors of `scene` look at all frames of a run that left their particles in its folder.
pub fn measure_files(run: &Path, scene: &Scene) -> Result<Found> {
    let mut scene = scene.clone();
    let list = std::mem::take(&mut scene.sensors.list);
    let (left_out, list): (Vec<Sensor>, Vec<Sensor>) = list.into_iter().partition(Sensor::needs_forces);
    scene.sensors.list = list;
    let left_out: Vec<String> = left_out.into_iter().map(|sensor| sensor.name).collect();
    if scene.sensors.list.is_empty() {
        let what = match left_out.is_empty() {
            true => "the run's scene has no sensors",
            false => "forces are in no particle file",
        };
        return Err(Error::usage(
            what,
            "give sensors of other kinds with --sensors FILE: a list as `sensors` in a scene",
        ));
    }
    let source = ReadBack::open(run)?;
    let mut texts: Vec<String> = tables(&scene).map(|profile| header(&scene, profile)).collect();
    let mut frames = 0;
    for frame in source.frames() {
        let Some(snapshot) = source.read(frame)?.filter(|s| s.column("position").is_some()) else {
            continue;
        };
        let cloud = Cloud::new(&scene, &snapshot, frame);
        let values = scene.sensors.list.iter().map(|sensor| cloud.values(sensor));
        let sample = Sample {
            time: f64::from(frame) / scene.time.fps,
            // Of steps whose lengths the device chose, nobody knows how many there were.
            step: scene
                .time
                .adaptive
                .is_none()
                .then(|| u64::from(frame) * u64::from(scene.time.steps_per_frame)),
            values: values.collect::<Result<_>>()?,
        };
        for (text, profile) in texts.iter_mut().zip(tables(&scene)) {
            text.push_str(&rows(&scene, profile, frame, std::slice::from_ref(&sample)));
        }
        frames += 1;
    }
    if frames == 0 {
        return Err(Error::usage(
            format!(
                "{} holds no particles: neither particle files with positions nor checkpoints",
                run.display()
            ),
            "run it again with --particles npy --columns position,velocity,density,pressure",
        ));
    }
    let names = tables(&scene).map(|profile| match profile {
        None => "sensors.csv".to_owned(),
        Some(number) => format!("sensor_{}.csv", scene.sensors.list[number].name),
    });
    Ok(Found {
        tables: names.zip(texts).collect(),
        frames,
        left_out,
        scene,
    })
}

/// The particles of one frame.
struct Cloud<'a> {
    scene: &'a Scene,
    snapshot: &'a Snapshot,
    frame: u32,
    /// Local, metres.
    position: Vec<DVec3>,
}

impl<'a> Cloud<'a> {
    fn new(scene: &'a Scene, snapshot: &'a Snapshot, frame: u32) -> Self {
        let mut cloud = Self {
            scene,
            snapshot,
            frame,
            position: Vec::new(),
        };
        cloud.position = cloud.vectors("position").unwrap_or_default();
        for position in &mut cloud.position {
            *position -= scene.origin;
        }
        cloud
    }

    fn vectors(&self, name: &str) -> Option<Vec<DVec3>> {
        let column = self.snapshot.column(name)?;
        Some(
            column
                .values
                .chunks_exact(column.width)
                .map(DVec3::from_slice)
                .collect(),
        )
    }

    fn missing(&self, column: &str) -> Error {
        Error::usage(
            format!("the particles of frame {} have no {column}", self.frame),
            format!("run the scene again with --particles npy --columns position,velocity,{column}"),
        )
    }

    /// A field of all particles; what is no vector is in x.
    fn field(&self, field: SensorField) -> Result<Vec<DVec3>> {
        let scalars = |name: &str| {
            let column = self.snapshot.column(name).ok_or_else(|| self.missing(name))?;
            Ok(column.values.iter().map(|&value| DVec3::X * value).collect())
        };
        let velocities = || self.vectors("velocity").ok_or_else(|| self.missing("velocity"));
        match field {
            SensorField::Pressure => scalars("pressure"),
            SensorField::Density => scalars("density"),
            SensorField::Velocity => velocities(),
            SensorField::Speed => Ok(velocities()?.iter().map(|v| DVec3::X * v.length()).collect()),
            SensorField::Position => Ok(self.position.iter().map(|p| *p + self.scene.origin).collect()),
        }
    }

    /// What a sensor finds, in the order of its outputs.
    fn values(&self, sensor: &Sensor) -> Result<Vec<f64>> {
        let dimensions = self.scene.dimensions;
        match sensor.kind {
            Kind::Point { at, field } => self.at_point(at.as_dvec3(), field),
            Kind::Height { from, to } => Ok(vec![self.height(from, to)]),
            Kind::Flux { min, max, axis } => self.flux(min, max, axis),
            Kind::Profile {
                axis,
                layers,
                field,
                min,
                max,
            } => {
                let all = self.field(field)?;
                let mut values = Vec::new();
                for number in 0..layers {
                    let (low, high) = layer(min, max, axis, layers, number);
                    let inside = self.inside(low, high);
                    let sum: DVec3 = inside.iter().map(|&i| all[i]).sum();
                    let count = inside.len() as f64;
                    values.extend((0..field.components(dimensions)).map(|axis| sum[axis] / count));
                    values.push(count);
                }
                Ok(values)
            }
            Kind::Extremes { field, min, max } => {
                let all = self.field(field)?;
                let inside = self.inside(min, max);
                let components = 0..field.components(dimensions);
                let lowest = |axis: usize| inside.iter().map(|&i| all[i][axis]).fold(f64::NAN, f64::min);
                let highest = |axis: usize| inside.iter().map(|&i| all[i][axis]).fold(f64::NAN, f64::max);
                let both = components.clone().map(lowest).chain(components.map(highest));
                Ok(both.chain([inside.len() as f64]).collect())
            }
            Kind::Force { .. } => Err(Error::usage(
                "forces are in no particle file",
                "put the sensor into the scene, and run it again",
            )),
        }
    }

    /// The way to the nearest image of a point.
    fn nearest(&self, offset: DVec3) -> DVec3 {
        let period = self.scene.domain.period().as_dvec3();
        let along = |axis: usize| match period[axis] {
            0.0 => offset[axis],
            period => offset[axis] - period * (offset[axis] / period).round(),
        };
        DVec3::new(along(0), along(1), along(2))
    }

    /// Numbers of the particles in a box.
    fn inside(&self, low: Vec3, high: Vec3) -> Vec<usize> {
        let axes = self.scene.dimensions.count();
        let (low, high) = (low.as_dvec3(), high.as_dvec3());
        let middle = (low + high) * 0.5;
        let is_inside = |&i: &usize| {
            let seen = middle + self.nearest(self.position[i] - middle);
            (0..axes).all(|axis| seen[axis] >= low[axis] && seen[axis] < high[axis])
        };
        (0..self.position.len()).filter(is_inside).collect()
    }

    fn flux(&self, min: Vec3, max: Vec3, axis: usize) -> Result<Vec<f64>> {
        let velocity = self.field(SensorField::Velocity)?;
        let reach = flux_reach(self.scene);
        let (volume, density) = volume_and_density(self.scene);
        let (mut low, mut high) = (min, max);
        low[axis] -= reach as f32;
        high[axis] += reach as f32;
        let (mut volumes, mut masses) = (0.0, 0.0);
        let material = self.snapshot.column("material");
        let has_sizes = self.scene.has_field("radius");
        let radius = self.snapshot.column("radius").filter(|_| has_sizes);
        if has_sizes && radius.is_none() {
            return Err(self.missing("radius"));
        }
        for i in self.inside(low, high) {
            let away = self.nearest(self.position[i] - min.as_dvec3())[axis].abs();
            let hat = (1.0 - away / reach).max(0.0) / reach;
            let share = match radius {
                Some(column) => {
                    (column.values[i] / self.scene.radius()).powi(self.scene.dimensions.count() as i32)
                }
                None => 1.0,
            };
            let flow = hat * share * volume * velocity[i][axis];
            let materials = self.scene.fluid().map_or(&[][..], |fluid| &fluid.materials);
            let own = match material {
                Some(column) => materials.get(column.values[i] as usize).map(|m| m.density),
                None if materials.len() > 1 => return Err(self.missing("material")),
                None => None,
            };
            volumes += flow;
            masses += own.unwrap_or(density) * flow;
        }
        Ok(vec![volumes, masses])
    }

    fn fluid(&self) -> &Fluid {
        self.scene
            .fluid()
            .expect("points and heights are refused for grains")
    }

    /// Volume of a particle times the kernel.
    fn weight(&self, distance: f64) -> f64 {
        let (fluid, axes) = (self.fluid(), self.scene.dimensions.count());
        let scale = match fluid.solver {
            // A lattice at rest has exactly rest density.
            FluidSolver::Dfsph => {
                1.0 / kernels::lattice_density(fluid.kernel, axes, fluid.smoothing(), fluid.spacing)
            }
            _ => 1.0,
        };
        let volume = fluid.volume(self.scene.dimensions);
        scale * volume * kernels::value(fluid.kernel, axes, fluid.smoothing(), distance)
    }

    /// The kernel's mean, corrected so that it is exact for fields that are linear in space.
    fn at_point(&self, at: DVec3, field: SensorField) -> Result<Vec<f64>> {
        let all = self.field(field)?;
        let (fluid, dimensions) = (self.fluid(), self.scene.dimensions);
        let mut weights = 0.0;
        let mut offsets = DVec3::ZERO;
        let mut spread = DMat3::ZERO;
        let mut values = DVec3::ZERO;
        let mut value_ways = [DVec3::ZERO; 3];
        for (position, value) in self.position.iter().zip(&all) {
            let offset = self.nearest(*position - at);
            if offset.length() >= fluid.support {
                continue;
            }
            let weight = self.weight(offset.length());
            let offset = offset / fluid.support;
            weights += weight;
            offsets += weight * offset;
            spread += DMat3::from_cols(offset * offset.x, offset * offset.y, offset * offset.z) * weight;
            values += weight * *value;
            for (axis, sum) in value_ways.iter_mut().enumerate() {
                *sum += weight * value[axis] * offset;
            }
        }
        let components = 0..field.components(dimensions);
        if weights <= 0.0 {
            let nothing = match field {
                SensorField::Pressure => 0.0,
                _ => f64::NAN,
            };
            return Ok(components.map(|_| nothing).collect());
        }
        let mean = values / weights;
        let middle = offsets / weights;
        let outer = DMat3::from_cols(middle * middle.x, middle * middle.y, middle * middle.z);
        let around = spread * (1.0 / weights) - outer;
        let spread_enough = least_spread(fluid, dimensions);
        let corrected = |axis: usize| {
            let slope = value_ways[axis] / weights - mean[axis] * middle;
            let slope = match dimensions {
                Dimensions::Two => {
                    let around = DMat2::from_cols(around.x_axis.truncate(), around.y_axis.truncate());
                    let flat: DVec2 = slope.truncate();
                    (around.determinant() > spread_enough).then(|| (around.inverse() * flat).extend(0.0))
                }
                Dimensions::Three => (around.determinant() > spread_enough).then(|| around.inverse() * slope),
            };
            let slope = slope.filter(|_| weights > LEAST_FILLING);
            mean[axis] - slope.map_or(0.0, |slope| slope.dot(middle))
        };
        Ok(components.map(corrected).collect())
    }

    /// The way from the line's beginning to the farthest point inside of the fluid, metres.
    fn height(&self, from: Vec3, to: Vec3) -> f64 {
        let fluid = self.fluid();
        let least = surface_filling(self.scene, fluid, from, to);
        let (from, offset) = (from.as_dvec3(), (to - from).as_dvec3());
        let middle = from + 0.5 * offset;
        let direction = offset.normalize();
        let near: Vec<DVec3> = self
            .position
            .iter()
            .map(|position| self.nearest(*position - middle))
            .filter(|p| (*p - direction * p.dot(direction)).length() < fluid.support)
            .collect();
        let is_wet = |height: f64| {
            let point = direction * (height - 0.5 * offset.length());
            let weights = near.iter().map(|p| self.nearest(*p - point).length());
            let weights = weights.filter(|&distance| distance < fluid.support);
            weights.map(|distance| self.weight(distance)).sum::<f64>() > least
        };
        let points = (offset.length() / fluid.spacing * POINTS_PER_SPACING)
            .ceil()
            .max(1.0);
        let step = offset.length() / points;
        let Some(found) = (0..=points as u32).rev().find(|&k| is_wet(f64::from(k) * step)) else {
            return 0.0;
        };
        let mut height = f64::from(found) * step;
        if f64::from(found) < points {
            for bisection in 1..=BISECTIONS {
                let higher = height + step * (-f64::from(bisection)).exp2();
                if is_wet(higher) {
                    height = higher;
                }
            }
        }
        height
    }
}
