//! What a frame adds to a recording.

use ::rerun::components::{FillMode, ImageFormat};
use ::rerun::datatypes::ChannelDatatype;
use ::rerun::{
    BarChart, Boxes3D, Color, Points3D, RecordingStream, RecordingStreamResult, Scalars, SegmentationImage,
    SeriesLines, TextLog, TextLogLevel, Transform3D,
};
use glam::{DVec3, Vec3};

use super::budget::Share;
use super::camera::Camera;
use super::events::Events;
use super::sensors;
use super::series::{Order, PARTICLE_STEPS_PER_S, curves};
use super::statics::{NO_VOXEL, OVER_SLOTS, collider_path};
use crate::error::Result;
use crate::output::health::Health;
use crate::output::png::compose;
use crate::output::statistics;
use crate::physics;
use crate::physics::collider::offset_at;
use crate::render::Overlay;
use crate::scene::model::Storage;
use crate::scene::{Scene, color_maps};
use crate::simulation::frame::{ColumnData, Frame, Statistics, Values, Voxels};

/// Boxes of allocated voxels: green, as in Harada 2007, Figure 2.
const ALLOCATED: u32 = 0x30_b0_50_ff;

/// Logs the frames of one run.
pub struct Frames {
    scene: Scene,
    share: Share,
    /// Where local coordinates have their zero.
    origin: DVec3,
    /// Ids of the particles shown, ascending.
    ids: Vec<u32>,
    /// RGBA of 256 steps of the color map.
    colors: Vec<u32>,
    overlay: Overlay,
    camera: Option<Camera>,
    order: Order,
    events: Events,
    health: Health,
    /// Seconds of simulated time of the frame being logged.
    time: f64,
}

impl Frames {
    pub fn new(scene: &Scene, share: &Share, origin: DVec3) -> Result<Self> {
        let view = scene.render.view;
        let colors = color_maps::find(&scene.color.map).map_or_else(Vec::new, |map| {
            let color = |step: u32| {
                let [r, g, b] = (map.at)(f64::from(step) / 255.0);
                u32::from_be_bytes([r, g, b, 255])
            };
            (0..256).map(color).collect()
        });
        Ok(Self {
            ids: share.ids(),
            colors,
            overlay: Overlay::new(scene, view)?,
            camera: share
                .picture
                .and_then(|picture| Camera::new(scene, view, picture)),
            order: Order::default(),
            events: Events::new(scene),
            health: Health::default(),
            scene: scene.clone(),
            share: share.clone(),
            origin,
            time: 0.0,
        })
    }

    /// What frames have in common, and `notes` to the log, before the first of them.
    pub fn begin(&mut self, stream: &RecordingStream, notes: &[String]) -> RecordingStreamResult<()> {
        stream.set_time_sequence("frame", 0);
        stream.set_duration_secs("sim_time", 0.0);
        for note in notes {
            stream.log(
                "events",
                &TextLog::new(note.as_str()).with_level(TextLogLevel::INFO),
            )?;
        }
        // What is static hides what comes with frames, as radii of grains of several sizes do.
        if !self.scene.has_field("radius") {
            let radius = self.scene.radius() * self.scene.render.splat_scale;
            stream.log_static(
                "scene/particles",
                &Points3D::update_fields().with_radii([radius as f32]),
            )?;
        }
        if let Some(camera) = self.camera.as_ref().filter(|camera| !camera.turns) {
            let (pinhole, pose) = camera.place(&self.scene, 0.0, self.origin);
            stream.log_static("scene/camera", &pinhole)?;
            stream.log_static("scene/camera", &pose)?;
        }
        Ok(())
    }

    /// Logs a frame; `rate` is how many particle steps per second the run has made so far.
    pub fn log(&mut self, stream: &RecordingStream, frame: &Frame, rate: Option<f64>) -> Result<()> {
        self.time = frame.time;
        let logged = self.figures(stream, frame, rate);
        logged.and_then(|()| self.texts(stream, frame)).map_err(defect)?;
        self.sensors(stream, frame).map_err(defect)?;
        self.moves(stream).map_err(defect)?;
        if frame.index.is_multiple_of(self.share.stride) {
            self.particles(stream, frame).map_err(defect)?;
            if let Some(voxels) = &frame.voxels {
                self.voxels(stream, voxels).map_err(defect)?;
            }
            self.picture(stream, frame)?;
        }
        Ok(())
    }

    fn figures(
        &mut self,
        stream: &RecordingStream,
        frame: &Frame,
        rate: Option<f64>,
    ) -> RecordingStreamResult<()> {
        stream.set_time_sequence("frame", i64::from(frame.index));
        stream.set_duration_secs("sim_time", frame.time);
        let mut figures = statistics::figures(frame);
        if let Some(rate) = rate {
            figures.insert(PARTICLE_STEPS_PER_S.into(), rate.into());
        }
        for curves in curves(&figures, physics::model(&self.scene.matter).figures) {
            let path = format!("statistics/{}", curves.group);
            let (values, names) = self.order.arrange(&curves);
            if let Some(names) = names {
                let names = names.iter().map(String::as_str);
                stream.log_static(path.as_str(), &SeriesLines::new().with_names(names))?;
            }
            stream.log(path, &Scalars::new(values))?;
        }
        match &frame.statistics {
            Some(statistics) => stream.log("occupancy", &occupancy(statistics)),
            None => Ok(()),
        }
    }

    /// Each sample of the sensors at its own time.
    fn sensors(&mut self, stream: &RecordingStream, frame: &Frame) -> RecordingStreamResult<()> {
        for sample in &frame.samples {
            stream.set_duration_secs("sim_time", sample.time);
            for curves in sensors::curves_of(&self.scene, sample) {
                let (values, names) = self.order.arrange(&curves);
                if let Some(names) = names {
                    let names = names.iter().map(String::as_str);
                    stream.log_static(curves.group.as_str(), &SeriesLines::new().with_names(names))?;
                }
                stream.log(curves.group, &Scalars::new(values))?;
            }
        }
        stream.set_duration_secs("sim_time", frame.time);
        Ok(())
    }

    fn texts(&mut self, stream: &RecordingStream, frame: &Frame) -> RecordingStreamResult<()> {
        for (time, text) in self.events.until(frame.time) {
            stream.set_duration_secs("sim_time", *time);
            let text = format!("{time} s: {text}");
            stream.log("events", &TextLog::new(text).with_level(TextLogLevel::INFO))?;
        }
        stream.set_duration_secs("sim_time", frame.time);
        for warning in self.health.check(frame, self.scene.sound_speed()) {
            stream.log("events", &TextLog::new(warning).with_level(TextLogLevel::WARN))?;
        }
        Ok(())
    }

    /// Where moving colliders are.
    fn moves(&self, stream: &RecordingStream) -> RecordingStreamResult<()> {
        for (number, collider) in self.scene.colliders.iter().enumerate() {
            if collider.visible && !collider.path.is_empty() {
                let offset = offset_at(&collider.path, self.time).to_array();
                stream.log(
                    collider_path(&self.scene, number),
                    &Transform3D::from_translation(offset),
                )?;
            }
        }
        Ok(())
    }

    fn particles(&self, stream: &RecordingStream, frame: &Frame) -> RecordingStreamResult<()> {
        let column = |name: &str| frame.columns.iter().find(|column| column.name == name);
        let Some(Values::Double { columns, values }) = column("position").map(|position| &position.values)
        else {
            return Ok(());
        };
        let shown = self.ids.iter().take_while(|&&id| id < frame.particles);
        // Columns hold the scene's own coordinates.
        let shift = self.origin - self.scene.origin;
        let point = |&id: &u32| {
            let first = id as usize * columns;
            let mut point = DVec3::ZERO;
            for (axis, value) in values[first..first + columns].iter().enumerate() {
                point[axis] = *value;
            }
            (point + shift).as_vec3().to_array()
        };
        let mut points = Points3D::new(shown.clone().map(point));
        if let Some(Values::Float(radii)) = column("radius").map(|radius| &radius.values) {
            let scale = self.scene.render.splat_scale as f32;
            points = points.with_radii(shown.clone().map(|&id| scale * radii[id as usize]));
        }
        if let Some(colored) = column(self.scene.color.column.name) {
            points = points.with_colors(shown.map(|&id| self.color(colored, id)));
        }
        stream.log("scene/particles", &points)
    }

    fn color(&self, column: &ColumnData, id: u32) -> Color {
        let value = match &column.values {
            Values::Float(values) => f64::from(values[id as usize]),
            Values::Unsigned(values) => f64::from(values[id as usize]),
            Values::Vector { .. } | Values::Double { .. } => 0.0,
        };
        let [low, high] = self.scene.color.range;
        let step = ((value - low) / (high - low) * 255.0).clamp(0.0, 255.0).round();
        Color::from_u32(self.colors[step as usize])
    }

    fn voxels(&self, stream: &RecordingStream, voxels: &Voxels) -> RecordingStreamResult<()> {
        if self.share.boxes {
            let corner = |point: Vec3| (point.as_dvec3() + self.origin).as_vec3();
            let middle = voxels
                .boxes
                .iter()
                .map(|[low, high]| corner((*low + *high) * 0.5));
            let half = voxels
                .boxes
                .iter()
                .map(|[low, high]| ((*high - *low) * 0.5).to_array());
            stream.log(
                "scene/allocated",
                &Boxes3D::from_centers_and_half_sizes(middle.map(|m| m.to_array()), half)
                    .with_colors([ALLOCATED])
                    .with_fill_mode(FillMode::MajorWireframe),
            )?;
        }
        let Some(side) = self.share.map_side else {
            return Ok(());
        };
        let neighbors = &self.scene.neighbors;
        let bounded = neighbors.storage == Storage::Pool;
        let class = |count: &Option<u32>| match *count {
            None => NO_VOXEL,
            Some(count) if bounded && count > neighbors.slots => OVER_SLOTS,
            Some(count) => count.min(4) as u8,
        };
        let classes: Vec<u8> = voxels.map.iter().map(class).collect();
        let format = ImageFormat::segmentation([side, side], ChannelDatatype::U8);
        stream.log("index_pool", &SegmentationImage::new(classes, format))
    }

    fn picture(&self, stream: &RecordingStream, frame: &Frame) -> Result<()> {
        let Some(camera) = &self.camera else { return Ok(()) };
        if camera.turns {
            let (pinhole, pose) = camera.place(&self.scene, frame.time, self.origin);
            stream.log("scene/camera", &pinhole).map_err(defect)?;
            stream.log("scene/camera", &pose).map_err(defect)?;
        }
        let Some(picture) = compose(frame, &self.overlay)? else {
            return Ok(());
        };
        match camera.picture(&picture) {
            Some(picture) => stream.log("scene/camera", &picture).map_err(defect),
            None => Ok(()),
        }
    }
}

/// Voxels by how many particles they hold.
fn occupancy(statistics: &Statistics) -> BarChart {
    let [one, two, three, four] = statistics.voxels_with;
    let bars = [one, two, three, four, statistics.voxels_with_more];
    BarChart::new(&bars[..]).with_abscissa(&[1_u32, 2, 3, 4, 5][..])
}

/// Values of a known shape cannot fail to become Arrow columns.
pub fn defect(error: ::rerun::RecordingStreamError) -> crate::error::Error {
    crate::error::Error::usage(
        format!("Rerun does not take a frame: {error}"),
        "run without Rerun, and report this defect",
    )
}
