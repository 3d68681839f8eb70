//! How the viewer arranges a recording when it is opened.

use ::rerun::blueprint::components::PanelState;
use ::rerun::blueprint::{
    BarChartView, Blueprint, BlueprintActivation, BlueprintPanel, ContainerLike, Grid, Horizontal,
    SelectionPanel, Spatial2DView, Spatial3DView, Tabs, TextDocumentView, TextLogView, TimePanel,
    TimeSeriesView, Vertical,
};
use ::rerun::external::re_log_types::{BlueprintActivationCommand, LogMsg};
use ::rerun::external::re_sdk_types::blueprint::archetypes::EyeControls3D;
use ::rerun::external::re_sdk_types::blueprint::components::PlayState;
use ::rerun::{RecordingStream, RecordingStreamBuilder, RecordingStreamResult};
use glam::{DMat3, DVec3};

use super::sensors::quantities;
use super::series::{Group, groups};
use super::target::APPLICATION;
use crate::physics;
use crate::render::{Layout, Sight};
use crate::scene::model::Storage;
use crate::scene::{Dimensions, Scene};

/// Turn of the viewer's eye away from the scene's camera, degrees, so that the camera is in sight.
const TURN: f64 = 34.0;
/// Distance of the viewer's eye from the middle of the domain, as a multiple of the camera's.
const BACK: f64 = 1.4;
/// Groups of curves, the first ones, that have a plot of their own at once; the others share tabs.
const PLOTS: usize = 2;

/// What there is to be arranged.
pub struct Contents {
    pub camera: bool,
    pub voxel_map: bool,
    pub statistics: bool,
}

/// Sends the arrangement ahead of the data. `origin` is where local coordinates have their zero.
pub fn send(
    stream: &RecordingStream,
    scene: &Scene,
    contents: &Contents,
    origin: DVec3,
) -> RecordingStreamResult<()> {
    let flat = scene.dimensions == Dimensions::Two;
    let mut shown = vec!["+ /scene/**"];
    if flat {
        // Seen from the front, the picture would stand before the scene.
        shown.push("- /scene/camera/**");
    }
    let view: ContainerLike = Spatial3DView::new("scene")
        .with_origin("scene")
        .with_contents(shown)
        .into();
    let eye_path = format!("{}/EyeControls3D", entity(&view));
    let blueprint = Blueprint::new(arrange(view, scene, contents))
        .with_auto_views(false)
        .with_auto_layout(false)
        .with_blueprint_panel(BlueprintPanel::from_state(PanelState::Collapsed))
        .with_selection_panel(SelectionPanel::from_state(PanelState::Collapsed))
        .with_time_panel(
            TimePanel::new()
                .with_state(PanelState::Collapsed)
                .with_timeline("frame")
                .with_fps(scene.time.fps)
                .with_play_state(PlayState::Following),
        );
    let (mut messages, activation) = messages(&blueprint)?;
    // The blueprint's interface has no place for the eye, so its messages are added by hand.
    let id = activation.blueprint_id.clone();
    let (more, storage) = RecordingStreamBuilder::from_store_id(&id).blueprint().memory()?;
    more.set_time_sequence("blueprint", 0);
    more.log(eye_path, &eye(scene, origin))?;
    let is_data = |message: &LogMsg| matches!(message, LogMsg::ArrowMsg(..));
    messages.extend(storage.take().into_iter().filter(is_data));
    stream.send_blueprint(messages, activation);
    Ok(())
}

/// Scene and texts on the left; picture, pool and the curves that grains or fluids have on the right.
fn arrange(view: ContainerLike, scene: &Scene, contents: &Contents) -> ContainerLike {
    let document = |name: &str| TextDocumentView::new(name).with_origin(format!("documents/{name}"));
    let texts = Tabs::new([
        TextLogView::new("log").with_origin("events").into(),
        document("about").into(),
        document("scene").into(),
        document("plan").into(),
    ]);
    let left = Vertical::new([view, texts.into()]).with_row_shares(vec![2.6, 1.0]);

    let mut pictures: Vec<ContainerLike> = Vec::new();
    if contents.camera {
        pictures.push(Spatial2DView::new("picture").with_origin("scene/camera").into());
    }
    if contents.voxel_map {
        let name = match scene.neighbors.storage {
            Storage::Pool => "index pool",
            _ => "voxels in the order of memory",
        };
        pictures.push(Spatial2DView::new(name).with_origin("index_pool").into());
    }
    let curves = |group: &Group| -> ContainerLike {
        TimeSeriesView::new(group.title)
            .with_origin(format!("statistics/{}", group.name))
            .into()
    };
    let mut groups = groups(physics::model(&scene.matter).figures, contents.statistics);
    let mut plots: Vec<ContainerLike> = groups.by_ref().take(PLOTS).map(curves).collect();
    let sensors: Vec<ContainerLike> = quantities(scene)
        .into_iter()
        .map(|(quantity, unit)| {
            let title = format!("sensors: {}, {unit}", quantity.replace('_', " "));
            TimeSeriesView::new(title.trim_end_matches(", ").to_owned())
                .with_origin(format!("sensors/{quantity}"))
                .into()
        })
        .collect();
    if !sensors.is_empty() {
        plots.insert(0, Tabs::new(sensors).into());
    }
    if contents.statistics {
        plots.push(
            BarChartView::new("voxels by particles in them")
                .with_origin("occupancy")
                .into(),
        );
    }
    plots.push(Tabs::new(groups.map(curves)).into());
    let figures: ContainerLike = Grid::new(plots).with_grid_columns(2).into();
    let right = if pictures.is_empty() {
        figures
    } else {
        let across = Horizontal::new(pictures);
        Vertical::new([across.into(), figures])
            .with_row_shares(vec![1.0, 1.6])
            .into()
    };
    Horizontal::new([left.into(), right])
        .with_column_shares(vec![1.0, 1.0])
        .into()
}

/// The blueprint's messages and the command that makes it the active one.
fn messages(blueprint: &Blueprint) -> RecordingStreamResult<(Vec<LogMsg>, BlueprintActivationCommand)> {
    let (stream, storage) = RecordingStreamBuilder::new(APPLICATION).memory()?;
    blueprint.send(&stream, BlueprintActivation::default())?;
    let mut messages = storage.take();
    let mut command = None;
    messages.retain(|message| match message {
        LogMsg::BlueprintActivationCommand(found) => {
            command = Some(found.clone());
            false
        }
        _ => message.store_id().kind() == ::rerun::StoreKind::Blueprint,
    });
    let Some(command) = command else {
        unreachable!("sending a blueprint ends with its activation")
    };
    Ok((messages, command))
}

fn entity(view: &ContainerLike) -> String {
    match view {
        ContainerLike::View(view) => view.blueprint_path().to_string(),
        _ => unreachable!("a view becomes a view"),
    }
}

/// The eye looks at the middle of the domain, from beside the scene's camera.
fn eye(scene: &Scene, origin: DVec3) -> EyeControls3D {
    let layout = Layout::new(scene, scene.render.view);
    let size = layout
        .scene
        .map_or(scene.render.size, |place| [place.width, place.height]);
    let sight = Sight::new(scene, size, layout.insets, 0.0);
    let middle = (scene.domain.min + scene.domain.max).as_dvec3() * 0.5;
    let turn = match scene.dimensions {
        Dimensions::Two => DMat3::IDENTITY,
        Dimensions::Three => DMat3::from_rotation_y(TURN.to_radians()),
    };
    let eye = middle + turn * (sight.eye - middle) * BACK;
    EyeControls3D::new()
        .with_position((eye + origin).as_vec3().to_array())
        .with_look_target((middle + origin).as_vec3().to_array())
        .with_eye_up([0.0, 1.0, 0.0])
}
