//! A field that is added by one row is sorted, saved, resumed, exported and drawn.

use sliceflow::gpu::{AdapterChoice, readback};
use sliceflow::output::{
    Checkpoints, Every, OnInstability, Outputs, PARTICLE_FORMATS, ParticleOutput, Settings, columns_named,
    progress, run,
};
use sliceflow::plan::Wanted;
use sliceflow::scene::Scene;
use sliceflow::scene::column::{Column, Source};
use sliceflow::scene::field::{Field, Kind, Travels};
use sliceflow::scene::model::View;
use sliceflow::simulation::{Frame, Values};

use crate::common::{self, frames};

/// The row: a number that each particle is given and keeps, twice its id.
const TAG: Field = Field {
    name: "tag",
    kind: Kind::Unsigned,
    unit: "",
    about: "a number that each particle keeps",
    column: Some(Source::Field),
    travels: Travels::Kept,
    saved: true,
    has: |_| true,
    start: Some(|new| {
        let tags: Vec<u32> = new.ids.iter().map(|id| 2 * id).collect();
        bytemuck::cast_slice(&tags).to_vec()
    }),
    beside: None,
    ends_in: None,
};

fn column() -> Column {
    TAG.column().expect("the row has one")
}

/// Falling grains, or a dam that breaks, with the row.
fn scenes() -> [Scene; 2] {
    let grains = common::scene(2, &["render.size=[64,48]"]);
    let fluid = common::fluid(2, &["render.size=[64,48]"]);
    [grains, fluid].map(|mut scene| {
        scene.more_fields.push(TAG);
        scene
    })
}

fn wanted() -> Wanted {
    Wanted {
        columns: vec![column()],
        ..Wanted::default()
    }
}

fn assert_tags(frame: &Frame) {
    let expected: Vec<u32> = (0..frame.particles).map(|id| 2 * id).collect();
    assert_eq!(
        frame.columns[0].values,
        Values::Unsigned(expected),
        "frame {}",
        frame.index
    );
}

#[test]
fn it_is_sorted_and_brought_to_the_host() {
    for scene in scenes() {
        let mut simulation = common::simulate(&scene, &wanted());
        for frame in frames(&mut simulation, 2) {
            assert_tags(&frame);
        }
        let read = |name: &str| -> Vec<u32> {
            let buffer = simulation.buffers().get(name, "(test)").expect("a buffer");
            let count = scene.capacity as usize;
            readback::read(simulation.gpu(), buffer, count).expect("numbers")
        };
        let (ids, tags) = (read("id"), read("tag"));
        assert!(
            ids.is_sorted_by(|a, b| a > b) || !ids.is_sorted(),
            "nothing was sorted"
        );
        assert!(ids.iter().zip(&tags).all(|(id, tag)| *tag == 2 * id));
    }
}

#[test]
fn it_is_saved_and_resumed() {
    for scene in scenes() {
        let mut first = common::simulate(&scene, &wanted());
        frames(&mut first, 1);
        let state = first.save_state().expect("a state");
        assert_eq!(
            state.buffer("tag").expect("tags").len(),
            4 * scene.capacity as usize
        );
        let mut second = common::simulate(&scene, &wanted());
        second.restore(&state).expect("restored");
        let later = frames(&mut second, 2);
        assert_eq!(later.len(), 1);
        assert_tags(&later[0]);
    }
}

#[test]
fn it_is_exported() {
    for scene in scenes() {
        let folder = tempfile::tempdir().expect("a folder");
        let format = PARTICLE_FORMATS
            .iter()
            .find(|format| format.name == "npy")
            .expect("npy");
        let settings = Settings {
            folder: folder.path().join("run"),
            force: false,
            outputs: Outputs {
                pictures: false,
                statistics: false,
                particles: Some(ParticleOutput::new(vec![format], vec![column()], 1)),
                video: None,
                rerun: None,
                checkpoints: Checkpoints {
                    every: Every::Never,
                    keep: 1,
                },
            },
            timings: false,
            adapter: AdapterChoice::Best,
            on_instability: OnInstability::Stop,
            max_disk: None,
            progress: progress::Style::None,
            command_line: Vec::new(),
        };
        let mut scene = scene;
        scene.time.frames = 2;
        run(&scene, &settings).expect("a run");
        let file = std::fs::read(settings.folder.join("particles_000001/tag.npy")).expect("a file");
        let expected: Vec<u32> = (0..scene.first_boundary()).map(|id| 2 * id).collect();
        assert!(
            file.ends_with(bytemuck::cast_slice(&expected)),
            "the array ends with other numbers"
        );
    }
}

/// A picture of the second frame, colored by a column.
fn picture(mut scene: Scene, column: Column, range: [f64; 2]) -> Vec<u8> {
    scene.color.column = column;
    scene.color.range = range;
    let wanted = Wanted {
        view: Some(View::Scene),
        ..Wanted::default()
    };
    let mut simulation = common::simulate(&scene, &wanted);
    let mut all = frames(&mut simulation, 1);
    all.remove(1).pixels.expect("a picture")
}

#[test]
fn it_is_drawn() {
    for scene in scenes() {
        let last = f64::from(scene.first_boundary() - 1);
        let id = columns_named(["id"]).expect("a column")[0];
        let by_tag = picture(scene.clone(), column(), [0.0, 2.0 * last]);
        let by_id = picture(scene.clone(), id, [0.0, last]);
        let by_half = picture(scene, column(), [0.0, last]);
        assert!(
            by_tag == by_id,
            "twice the numbers over twice the range are other colors"
        );
        assert!(by_tag != by_half, "the numbers do not color anything");
    }
}
