//! `sliceflow render RUN`: some of the frames, a video, and colors that the run's files hold.

#![cfg(all(unix, feature = "video"))]

use std::fs;

use image::AnimationDecoder as _;

use crate::place::Place;

/// Water under oil.
const FLUID: &str = r#"{
  "dimensions": 2,
  "domain": { "min": [0, 0], "max": [1, 0.6] },
  "fluid": {
    "solver": "wcsph",
    "spacing": 0.05, "viscosity": 0.05, "artificial_viscosity": 0.1,
    "materials": [ { "name": "water", "density": 1000 }, { "name": "oil", "density": 900 } ]
  },
  "bodies": [
    { "shape": { "kind": "box", "min": [0, 0], "max": [0.5, 0.2] }, "material": "water" },
    { "shape": { "kind": "box", "min": [0, 0.2], "max": [0.5, 0.4] }, "material": "oil" }
  ],
  "time": { "duration": 0.6, "fps": 10 },
  "render": { "splat": "disc", "size": [160, 120] }
}"#;

/// Frames 0, 2, 4 and 6 have particle files, frame 5 has none, and 1 and 3 nothing either.
fn run(place: &Place, out: &str, more: &[&str]) {
    fs::write(place.path("fluid.json"), FLUID).unwrap();
    let args = [
        "run",
        "fluid.json",
        "-o",
        out,
        "--particles",
        "npy",
        "--particles-every",
        "2",
    ];
    place.told(&mut place.sliceflow(&[&args, more].concat()), 0);
}

#[test]
fn colors_come_from_files_and_checkpoints() {
    let place = Place::new();
    let columns = ["--columns", "position,velocity,pressure,material,speed"];
    // The state behind frame 5 is in a checkpoint, and pressure is in both.
    let five = ["--checkpoint-every", "5", "--keep-checkpoints", "9"];
    run(&place, "run", &[&columns[..], &five].concat());
    for column in ["pressure", "material", "density"] {
        let color = format!("render.color.by={column}");
        run(&place, column, &["--set", &color]);
        let again = format!("{column}_again");
        let render = ["render", "run", "--set", &color, "-o", &again];
        if column == "density" {
            let told = place.told(&mut place.sliceflow(&render), 2);
            assert!(
                told.contains("frame 0") && told.contains("--columns velocity,density"),
                "{told}"
            );
            continue;
        }
        let told = place.told(&mut place.sliceflow(&render), 0);
        assert!(told.contains("drawing 5 frames"), "{told}");
        for frame in [0, 2, 4, 5, 6] {
            let name = format!("frame_{frame:06}.png");
            let [one, two] =
                [column, &again].map(|run| image::open(place.path(run).join(&name)).unwrap().to_rgba8());
            // A checkpoint keeps the order in which overlapping discs are drawn; particle files are in order of id.
            let allowed = if frame == 5 { 0 } else { 400 };
            let differing = one.pixels().zip(two.pixels()).filter(|(a, b)| a != b).count();
            assert!(
                differing <= allowed,
                "{column}: {name} differs in {differing} pixels"
            );
        }
    }
}

#[test]
fn a_range_of_frames_becomes_pictures_and_a_video() {
    let place = Place::new();
    run(&place, "run", &["--checkpoint-every", "0"]);
    let render = |more: &[&str]| place.sliceflow(&[&["render", "run"], more].concat());
    place.told(
        &mut render(&["--frames", "2..4", "-o", "some", "--video", "some.gif"]),
        0,
    );
    let mut names: Vec<_> = place.files("some").into_keys().collect();
    names.sort();
    assert_eq!(names, ["frame_000002.png", "frame_000004.png"]);
    let reader = std::io::BufReader::new(fs::File::open(place.path("some.gif")).unwrap());
    let gif = image::codecs::gif::GifDecoder::new(reader).unwrap();
    assert_eq!(gif.into_frames().count(), 2);

    place.told(
        &mut render(&["--video", "all.png", "--no-pictures", "-o", "none"]),
        0,
    );
    assert!(place.files("none").is_empty() && place.path("all.png").exists());
    for (more, expected) in [
        (&["--frames", "50..60"][..], "it has frames 0 to 6"),
        (&["--frames", "3"], "no particles to draw"),
        (&["--frames", "4..2"], "write 2..4"),
        (&["--video", "all.png", "-o", "x"], "--force"),
        (&["--video", "all.avi", "-o", "x"], ".webm"),
        (&["--no-pictures"], "--video"),
    ] {
        let told = place.told(&mut render(more), 2);
        assert!(told.contains(expected), "{more:?}: {told}");
        assert!(!place.path("x").exists(), "{more:?}");
    }
}
