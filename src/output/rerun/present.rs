//! From settings to sessions.

use glam::DVec3;

use super::blueprint::{self, Contents};
use super::budget::Share;
use super::frames::Frames;
use super::server::Server;
use super::session::Session;
use super::target::{Open, Trouble};
use super::{GRPC_PORT, LOCALHOST, Settings, Target, statics};
use crate::error::{Error, Result};
use crate::output::progress::Progress;
use crate::output::text::bytes;
use crate::output::{Sink, columns_named};
use crate::plan::{Plan, Wanted};
use crate::scene::model::View;
use crate::scene::{Scene, column};

impl Target {
    /// A viewer on this machine.
    pub fn local_viewer() -> Self {
        Self::Viewer(format!("{LOCALHOST}:{GRPC_PORT}"))
    }

    /// The warning that nobody looks any more.
    pub fn lost(&self, reason: &str) -> String {
        format!("{self} is lost ({reason}); the run goes on without it")
    }
}

impl Settings {
    fn share(&self, scene: &Scene, pictures: bool) -> Share {
        let drawn = pictures && scene.render.view != View::Pool;
        Share::new(scene, drawn, self.budget)
    }

    /// Refuses what cannot be, before anything runs: a file that may not be replaced, a budget for nothing, a port that
    /// is taken.
    pub fn check(&self, scene: &Scene, pictures: bool, force: bool) -> Result<()> {
        if self.share(scene, pictures).particles == 0 {
            let share = |megabytes: u64| {
                let budget = megabytes * 1_000_000;
                Self {
                    budget,
                    ..self.clone()
                }
                .share(scene, pictures)
            };
            let enough = (0..30).map(|k| 1 << k).find(|&mb| share(mb).particles > 0);
            return Err(Error::usage(
                format!("a recording of {} has no room for particles", bytes(self.budget)),
                match enough {
                    Some(megabytes) => format!("give --rerun-budget {megabytes}MB or more"),
                    None => "record fewer frames".into(),
                },
            ));
        }
        for target in &self.targets {
            match target {
                Target::File(path) if path.exists() && !force => {
                    return Err(Error::usage(
                        format!("{} is there already", path.display()),
                        "replace it with --force, or choose another name",
                    ));
                }
                Target::Serve => Server::check_ports()?,
                _ => {}
            }
        }
        Ok(())
    }

    /// Adds what recordings need from the device.
    pub fn want(&self, scene: &Scene, pictures: bool, wanted: &mut Wanted) {
        let share = self.share(scene, pictures);
        let position = columns_named(["position"]).unwrap_or_default();
        let radius = scene.has_field("radius").then(|| *column::RADIUS);
        for column in position.into_iter().chain(radius).chain([scene.color.column]) {
            if !wanted.columns.contains(&column) {
                wanted.columns.push(column);
            }
        }
        // Boxes come with the map; the smallest one costs nothing.
        wanted.voxel_map = share.map_side.or(share.boxes.then_some(64));
    }

    /// Bytes on disk, at most.
    pub fn disk_bytes(&self, scene: &Scene, pictures: bool) -> u64 {
        let files = self.targets.iter().filter(|t| matches!(t, Target::File(_)));
        files.count() as u64 * self.share(scene, pictures).planned
    }

    /// Opens every target and sends what does not change. A viewer that does not answer is warned of and left out.
    pub fn sinks(
        &self,
        scene: &Scene,
        plan: &Plan,
        pictures: bool,
        progress: &Progress,
    ) -> Result<Vec<Box<dyn Sink>>> {
        let share = self.share(scene, pictures);
        let told = share.told(pictures && scene.render.view != View::Pool);
        progress.note(&format!("Rerun gets {told}"));
        let origin = shown_origin(scene);
        let about = about(scene, &told, origin);
        let said = [format!("this recording has {told}")].into_iter();
        let notes: Vec<_> = said
            .chain(scene.notes.clone())
            .chain(plan.told().cloned())
            .collect();
        let mut sinks: Vec<Box<dyn Sink>> = Vec::new();
        for target in &self.targets {
            let open = match Open::new(target, &scene.name) {
                Ok(open) => open,
                Err(Trouble::Failed(error)) => return Err(error),
                Err(Trouble::Lost(reason)) => {
                    progress.warn(&target.lost(&reason));
                    continue;
                }
            };
            let mut frames = Frames::new(scene, &share, origin)?;
            let contents = Contents {
                camera: share.picture.is_some(),
                voxel_map: share.map_side.is_some(),
                statistics: plan.wanted.statistics,
            };
            blueprint::send(&open.stream, scene, &contents, origin)
                .and_then(|()| statics::log(&open.stream, scene, plan, origin, &about))
                .and_then(|()| frames.begin(&open.stream, &notes))
                .map_err(super::frames::defect)?;
            if *target == Target::Serve {
                progress.note(&format!("look at the run: {}", Server::address()));
            }
            sinks.push(Box::new(Session::new(
                target.clone(),
                open,
                frames,
                scene.time.frames,
            )));
        }
        Ok(sinks)
    }
}

/// Where local coordinates have their zero in the recording: the scene's own coordinates, unless single precision,
/// which is all that viewers have, would move particles by a thousandth of their radius.
fn shown_origin(scene: &Scene) -> DVec3 {
    let corners = [scene.domain.min, scene.domain.max].map(|corner| corner.as_dvec3() + scene.origin);
    let farthest = corners.iter().map(|c| c.abs().max_element()).fold(0.0, f64::max);
    if farthest * f64::from(f32::EPSILON) < 1e-3 * scene.radius() {
        scene.origin
    } else {
        DVec3::ZERO
    }
}

/// The document that says what the recording holds.
fn about(scene: &Scene, told: &str, origin: DVec3) -> String {
    let file = &scene.file;
    let color = &scene.color;
    let [low, high] = color.range;
    let unit = color.column.unit;
    let zero = (scene.origin - origin).to_array();
    let mut text = format!(
        "# {}\n\n{}\n\n{}\n\nThis recording has {told}.\n\nParticles are colored by {}, from {low:.4} to {high:.4} \
         {unit} ({}). Lengths are metres.\n",
        scene.name,
        file.description,
        file.source,
        color.column.name.replace('_', " "),
        color.map,
    );
    if zero != [0.0; 3] {
        let [x, y, z] = zero;
        text.push_str(&format!(
            "\nCoordinates are relative to ({x}, {y}, {z}) of the scene, for precision.\n"
        ));
    }
    for note in &scene.notes {
        text.push_str(&format!("\n{note}\n"));
    }
    text
}
