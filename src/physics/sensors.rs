//! Sensors on the device: which probes they are made of, the passes that read these, and what the readings mean.
//!
//! A sensor is one probe, a profile one for each of its layers. Probes of single particles go over all particles, probes of
//! forces over all particles with their neighbors in walls, probes of points over the voxels around. Sums have a fixed order.

use std::f64::consts::PI;

use glam::Vec3;

use super::kernels;
use super::layout::{Probe, Reading};
use super::model;
use crate::gpu::compose::GROUP_SIZE;
use crate::gpu::{BufferPlan, Items, PassPlan, Variant};
use crate::scene::fluid::Fluid;
use crate::scene::model::{SensorField, Wall};
use crate::scene::sensors::{Kind, Sensor, Target, layer};
use crate::scene::{Dimensions, Scene};

/// What a probe looks for, by its number in shaders.
const KINDS: [(&str, ProbeKind); 6] = [
    ("PROBE_FLUX", ProbeKind::Flux),
    ("PROBE_MEAN", ProbeKind::Mean),
    ("PROBE_EXTREMES", ProbeKind::Extremes),
    ("PROBE_FORCE", ProbeKind::Force),
    ("PROBE_POINT", ProbeKind::Point),
    ("PROBE_HEIGHT", ProbeKind::Height),
];
const FIELDS: [(&str, SensorField); 5] = [
    ("FIELD_PRESSURE", SensorField::Pressure),
    ("FIELD_DENSITY", SensorField::Density),
    ("FIELD_VELOCITY", SensorField::Velocity),
    ("FIELD_SPEED", SensorField::Speed),
    ("FIELD_POSITION", SensorField::Position),
];
/// Targets from here on are sides of the domain; those below are obstacles.
const SIDE_TARGETS: u32 = 1 << 20;
/// Particles that a thread looks at for a probe, and most workgroups of a probe.
const PARTICLES_OF_THREAD: u32 = 4;
const MOST_PARTS: u32 = 256;
/// Particles count for a flux within so many of their distances at rest.
const FLUX_REACH: f64 = 2.0;
/// Filling at the surface, as a share of what the domain leaves of the kernel.
const SURFACE: f64 = 0.5;
/// Particles that spread less than this share of what they do inside of the fluid (as volumes) do not tell slopes. In the
/// corner of a box it is 0.06 with the usual kernel in 2D, 0.008 in 3D, and 0.0001 with that of `dfsph`.
const LEAST_SPREAD: f64 = 5e-5;
/// Share of the kernel that particles have to fill to tell slopes: less than in a corner, more than in spray.
pub const LEAST_FILLING: f64 = 0.08;

/// In the order in which probes stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ProbeKind {
    Flux,
    Mean,
    Extremes,
    Force,
    Point,
    Height,
}

impl ProbeKind {
    fn of(sensor: &Sensor) -> Self {
        match sensor.kind {
            Kind::Flux { .. } => Self::Flux,
            Kind::Profile { .. } => Self::Mean,
            Kind::Extremes { .. } => Self::Extremes,
            Kind::Force { .. } => Self::Force,
            Kind::Point { .. } => Self::Point,
            Kind::Height { .. } => Self::Height,
        }
    }

    fn is_of_particles(self) -> bool {
        matches!(self, Self::Flux | Self::Mean | Self::Extremes)
    }

    fn is_of_points(self) -> bool {
        matches!(self, Self::Point | Self::Height)
    }
}

/// The sensors of a scene and their probes, those of particles first, then those of forces, then those of points.
struct Layout<'a> {
    /// Each sensor with the number of its first probe.
    sensors: Vec<(&'a Sensor, u32)>,
    first_force: u32,
    first_point: u32,
    probes: u32,
}

fn layout(scene: &Scene) -> Layout<'_> {
    let list = &scene.sensors.list;
    let mut sensors: Vec<(&Sensor, u32)> = list.iter().map(|sensor| (sensor, 0)).collect();
    let mut next = 0;
    let mut number = |is_of: &dyn Fn(ProbeKind) -> bool| {
        let first = next;
        for (sensor, place) in sensors.iter_mut().filter(|(s, _)| is_of(ProbeKind::of(s))) {
            *place = next;
            next += sensor.layers().unwrap_or(1);
        }
        first
    };
    number(&ProbeKind::is_of_particles);
    let first_force = number(&|kind| kind == ProbeKind::Force);
    let first_point = number(&ProbeKind::is_of_points);
    Layout {
        sensors,
        first_force,
        first_point,
        probes: next,
    }
}

/// What the sensors of a scene add to its plan.
#[derive(Default)]
pub struct Planned {
    pub buffers: Vec<BufferPlan>,
    /// Whenever sensors are sampled.
    pub passes: Vec<PassPlan>,
}

/// Nothing where the scene has no sensors.
pub fn plan(scene: &Scene, variant: &mut Variant) -> Planned {
    let Layout {
        first_force,
        first_point,
        probes,
        ..
    } = layout(scene);
    if probes == 0 {
        return Planned::default();
    }
    let parts = parts(scene);
    let points = probes - first_point;
    for (number, (name, _)) in KINDS.iter().enumerate() {
        variant.constant(name, number as u32);
    }
    for (number, (name, _)) in FIELDS.iter().enumerate() {
        variant.constant(name, number as u32);
    }
    variant
        .constant("SIDE_TARGETS", SIDE_TARGETS)
        .constant("SENSOR_PARTS", parts)
        .constant("PROBES", probes)
        .constant("PARTICLE_PROBES", first_force)
        .constant("FIRST_FORCE_PROBE", first_force)
        .constant("FIRST_POINT_PROBE", first_point)
        .constant("POINT_PROBES", points)
        // Where nobody sets them.
        .without(&[
            "fluid",
            "boundary_particles",
            "separated",
            "several_materials",
            "periodic",
        ])
        .flag("swept_sensors", first_point > 0)
        .flag("point_sensors", points > 0);

    let reading = Reading::LAYOUT.size as u64;
    let mut planned = Planned::default();
    planned.buffers.extend([
        BufferPlan::table("probes", &self::probes(scene), "what sensors look at"),
        BufferPlan::storage(
            "sensor_samples",
            u64::from(rows(scene)) * u64::from(probes + 1),
            reading,
            "what sensors found since the last frame",
        ),
        BufferPlan::uniform("sample_row", 16, "which of the frame's samples is taken"),
    ]);
    if first_point > 0 {
        planned.buffers.push(BufferPlan::storage(
            "partial_readings",
            u64::from(first_point) * u64::from(parts),
            reading,
            "readings of parts of the particles, added in a fixed order",
        ));
    }
    if points > 0 {
        planned.buffers.push(BufferPlan::storage(
            "point_readings",
            points.into(),
            reading,
            "readings at points",
        ));
    }
    let groups = |groups: u32| Items::Fixed(groups * GROUP_SIZE);
    if first_force > 0 {
        planned.passes.push(PassPlan::new(
            "physics/sensors/particles",
            "sense_particles",
            groups(first_force * parts),
            "fluxes, means and extremes of sensors",
        ));
    }
    let (_, while_stepping) = model(&scene.matter).sense_walls;
    if !while_stepping {
        planned.passes.extend(force_pass(scene));
    }
    if points > 0 {
        planned.passes.push(PassPlan::new(
            "physics/sensors/points",
            "sense_points",
            groups(points),
            "fields at sensors' points, and heights of the surface",
        ));
    }
    planned.passes.push(PassPlan::new(
        "physics/sensors/record",
        "record_sample",
        groups(probes),
        "keeps what the sensors found for the frame",
    ));
    planned
}

/// The pass that finds what particles do to walls and obstacles, where there are sensors for that.
pub(super) fn force_pass(scene: &Scene) -> Option<PassPlan> {
    let Layout {
        first_force,
        first_point,
        ..
    } = layout(scene);
    let (shader, _) = model(&scene.matter).sense_walls;
    let groups = (first_point - first_force) * parts(scene);
    let why = "forces on walls and obstacles that have sensors";
    (groups > 0).then(|| PassPlan::new(shader, "sense_walls", Items::Fixed(groups * GROUP_SIZE), why))
}

/// Workgroups of a probe that goes over all particles.
fn parts(scene: &Scene) -> u32 {
    scene
        .capacity
        .div_ceil(PARTICLES_OF_THREAD * GROUP_SIZE)
        .clamp(1, MOST_PARTS)
}

/// Most samples of a frame.
fn rows(scene: &Scene) -> u32 {
    let Some(interval) = scene.sensors.interval else {
        return 1;
    };
    let samples = (1.0 / (scene.time.fps * interval)).ceil() + 1.0;
    match scene.time.adaptive {
        // Samples that would fall into one step are one.
        None => samples.min(f64::from(scene.time.steps_per_frame)) as u32,
        Some(_) => samples as u32,
    }
}

/// Bytes of so many samples of a scene.
pub fn sample_bytes(scene: &Scene, samples: usize) -> u64 {
    samples as u64 * u64::from(layout(scene).probes + 1) * Reading::LAYOUT.size as u64
}

/// The probes, as the device has them.
pub fn probes(scene: &Scene) -> Vec<Probe> {
    let Layout { sensors, probes, .. } = layout(scene);
    let mut all = vec![Probe::default(); probes as usize];
    for (sensor, first) in sensors {
        for number in 0..sensor.layers().unwrap_or(1) {
            all[(first + number) as usize] = probe(scene, sensor, number);
        }
    }
    all
}

fn probe(scene: &Scene, sensor: &Sensor, number: u32) -> Probe {
    let packed = |v: Vec3| [v.x, v.y, v.z, 0.0];
    let kind = ProbeKind::of(sensor);
    let (volume, density) = volume_and_density(scene);
    let probe = Probe {
        kind: KINDS.iter().position(|(_, known)| *known == kind).unwrap_or(0) as u32,
        volume: volume as f32,
        density: density as f32,
        ..Default::default()
    };
    let field_number =
        |field: SensorField| FIELDS.iter().position(|(_, known)| *known == field).unwrap_or(0) as u32;
    match sensor.kind {
        Kind::Point { at, field } => Probe {
            field: field_number(field),
            threshold: scene
                .fluid()
                .map_or(0.0, |fluid| least_spread(fluid, scene.dimensions)) as f32,
            least_filling: LEAST_FILLING as f32,
            lower: packed(at),
            ..probe
        },
        Kind::Height { from, to } => Probe {
            threshold: scene
                .fluid()
                .map_or(0.0, |fluid| surface_filling(scene, fluid, from, to)) as f32,
            lower: packed(from),
            upper: packed(to),
            ..probe
        },
        Kind::Flux { min, max, axis } => {
            let reach = flux_reach(scene) as f32;
            let (mut low, mut high) = (min, max);
            low[axis] -= reach;
            high[axis] += reach;
            if scene.dimensions == Dimensions::Two {
                (low.z, high.z) = (-f32::MAX, f32::MAX);
            }
            let mut direction = [0.0; 4];
            direction[axis] = 1.0;
            direction[3] = min[axis];
            Probe {
                lower: packed(low),
                upper: packed(high),
                direction,
                reach,
                ..probe
            }
        }
        Kind::Force { on, about } => Probe {
            target_body: match on {
                Target::Obstacle(index) => index as u32,
                Target::Side(axis, end) => SIDE_TARGETS + (2 * axis + end) as u32,
            },
            lower: packed(scene.domain.min),
            upper: packed(scene.domain.max),
            direction: packed(about),
            ..probe
        },
        Kind::Profile {
            axis,
            layers,
            field,
            min,
            max,
        } => {
            let (low, high) = layer(min, max, axis, layers, number);
            Probe {
                field: field_number(field),
                lower: packed(low),
                upper: packed(high),
                ..probe
            }
        }
        Kind::Extremes { field, min, max } => Probe {
            field: field_number(field),
            lower: packed(min),
            upper: packed(max),
            ..probe
        },
    }
}

/// Of a particle at rest, the largest: m³ (m² in 2D) and kg/m³.
pub fn volume_and_density(scene: &Scene) -> (f64, f64) {
    let density = match scene.fluid() {
        Some(fluid) => fluid.materials[0].density,
        None => scene.file.density(),
    };
    ((model(&scene.matter).particle_mass)(scene) / density, density)
}

/// How far from its rectangle a flux sees particles, metres.
pub fn flux_reach(scene: &Scene) -> f64 {
    FLUX_REACH * 2.0 * scene.radius()
}

/// Determinant of the spread of particles around a point, in units of the support, below which a mean is not corrected.
pub fn least_spread(fluid: &Fluid, dimensions: Dimensions) -> f64 {
    const STEPS: i32 = 200;
    let axes = dimensions.count();
    let surface = if axes == 2 { 2.0 * PI } else { 4.0 * PI };
    let step = fluid.support / f64::from(STEPS);
    let radii = (0..STEPS).map(|k| (f64::from(k) + 0.5) * step);
    let square: f64 = radii
        .map(|r| {
            let shell = surface * r.powi(axes as i32 - 1) * step;
            kernels::value(fluid.kernel, axes, fluid.smoothing(), r) * shell * r * r
        })
        .sum();
    let along_axis = square / axes as f64 / (fluid.support * fluid.support);
    LEAST_SPREAD * along_axis.powi(axes as i32)
}

/// Filling at the surface on a line: half of what the domain leaves of the kernel around the line's middle.
pub fn surface_filling(scene: &Scene, fluid: &Fluid, from: Vec3, to: Vec3) -> f64 {
    const POINTS: i32 = 40;
    let axes = scene.dimensions.count();
    let step = 2.0 * fluid.support / f64::from(POINTS);
    let place = |k: i32| (f64::from(k) + 0.5 - 0.5 * f64::from(POINTS)) * step;
    let middle = (from.as_dvec3() + to.as_dvec3()) * 0.5;
    let (min, max) = (scene.domain.min.as_dvec3(), scene.domain.max.as_dvec3());
    let mut sums = [0.0; 2]; // inside of the domain, and all
    let deep = if axes == 2 { 1 } else { POINTS };
    for x in 0..POINTS {
        for y in 0..POINTS {
            for z in 0..deep {
                let away = glam::DVec3::new(place(x), place(y), if axes == 2 { 0.0 } else { place(z) });
                let weight = kernels::value(fluid.kernel, axes, fluid.smoothing(), away.length());
                let point = middle + away;
                let inside = (0..axes).all(|axis| {
                    let periodic = scene.domain.sides[axis][0] == Wall::Periodic;
                    periodic || (min[axis]..=max[axis]).contains(&point[axis])
                });
                sums[1] += weight;
                sums[0] += if inside { weight } else { 0.0 };
            }
        }
    }
    SURFACE * sums[0] / sums[1]
}

/// What one sample found: the step that it was taken behind, and the values of each sensor in the order of its outputs, for
/// a profile layer by layer. Values that nothing says anything of are NaN.
pub fn values(scene: &Scene, row: &[Reading]) -> (u64, Vec<Vec<f64>>) {
    let Layout { sensors, .. } = layout(scene);
    let [low, high] = [0, 1].map(|half| row[0].a[half] as u64);
    let step = low | (high << 16);
    let of = |(sensor, first): (&Sensor, u32)| {
        let first = 1 + first as usize;
        let probes = &row[first..first + sensor.layers().unwrap_or(1) as usize];
        probes
            .iter()
            .flat_map(|reading| meaning(scene, sensor, reading))
            .collect()
    };
    (step, sensors.into_iter().map(of).collect())
}

/// The values of one reading.
fn meaning(scene: &Scene, sensor: &Sensor, reading: &Reading) -> Vec<f64> {
    let axes = scene.dimensions.count();
    let a = reading.a.map(f64::from);
    let b = reading.b.map(f64::from);
    let origin = scene.origin.to_array();
    let zero = |field: SensorField, axis: usize| match field {
        SensorField::Position => origin[axis],
        _ => 0.0,
    };
    match sensor.kind {
        Kind::Point { field, .. } => {
            let value = |axis: usize| match field {
                _ if a[3] > 0.0 => a[axis],
                // Of the air around.
                SensorField::Pressure => 0.0,
                _ => f64::NAN,
            };
            (0..field.components(scene.dimensions)).map(value).collect()
        }
        Kind::Height { .. } => vec![a[0]],
        Kind::Flux { .. } => vec![a[0], a[1]],
        Kind::Force { .. } if axes == 2 => vec![a[0], a[1], b[2]],
        Kind::Force { .. } => vec![a[0], a[1], a[2], b[0], b[1], b[2]],
        Kind::Profile { field, .. } => {
            let means =
                (0..field.components(scene.dimensions)).map(|axis| a[axis] / a[3] + zero(field, axis));
            means.chain([a[3]]).collect()
        }
        Kind::Extremes { field, .. } => {
            let components = field.components(scene.dimensions);
            let found = |value: f64, axis: usize| match a[3] > 0.0 {
                true => value + zero(field, axis),
                false => f64::NAN,
            };
            let lowest = (0..components).map(|axis| found(a[axis], axis));
            let highest = (0..components).map(|axis| found(b[axis], axis));
            lowest.chain(highest).chain([a[3]]).collect()
        }
    }
}
