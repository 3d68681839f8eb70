//! `sliceflow gallery`: what is there stays, and what is missing is made. Needs an adapter; software Vulkan will do.

#![cfg(unix)]

use std::fs;
use std::process::Command;

use crate::place::Place;

fn gallery(place: &Place, more: &[&str], status: i32) -> String {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sliceflow"));
    let args = ["gallery", "--out", "gallery", "--size", "160x90"];
    command.current_dir(place.path(".")).args(args).args(more);
    if !more.contains(&"--frame") {
        command.args(["--frame", "1"]);
    }
    place.told(&mut command, status)
}

#[test]
fn what_is_there_stays_and_what_is_missing_is_made() {
    let place = Place::new();
    let told = gallery(&place, &["--only", "hopper"], 0);
    assert!(told.contains("1 pictures"), "{told}");
    let picture = place.path("gallery/hopper_picture/frame_000001.png");
    assert_eq!(image::image_dimensions(&picture).unwrap(), (160, 90));
    let page = || fs::read_to_string(place.path("gallery/index.html")).unwrap();
    for part in [
        "sliceflow run hopper --frames 2",
        "hopper_picture/frame_000001.png",
        "3480",
        "Solver",
        "grains",
    ] {
        assert!(page().contains(part), "{part} is not in {}", page());
    }
    let made = |path: &str| fs::metadata(place.path(path)).unwrap().modified().unwrap();
    let before = [
        made("gallery/hopper/run.json"),
        fs::metadata(&picture).unwrap().modified().unwrap(),
    ];
    let told = gallery(&place, &["--only", "hopper"], 0);
    assert!(told.contains("hopper: is there"), "{told}");
    let after = [
        made("gallery/hopper/run.json"),
        fs::metadata(&picture).unwrap().modified().unwrap(),
    ];
    assert_eq!(before, after);
    gallery(&place, &["--only", "hopper", "--force"], 0);
    assert!(
        made("gallery/hopper/run.json") > before[0],
        "it is not made again"
    );
    let before = [made("gallery/hopper/run.json")];
    // The drawing alone is missing.
    fs::remove_dir_all(place.path("gallery/hopper_picture")).unwrap();
    gallery(&place, &["--only", "hopper"], 0);
    assert!(picture.exists());
    assert_eq!(made("gallery/hopper/run.json"), before[0]);
    // Another moment is another run, which is not replaced unasked.
    let told = gallery(&place, &["--only", "hopper", "--frame", "2"], 2);
    assert!(
        told.contains("other arguments") && told.contains("--force"),
        "{told}"
    );
    assert_eq!(made("gallery/hopper/run.json"), before[0]);
    // One that was stopped goes on.
    let record = place.path("gallery/hopper/run.json");
    let text = fs::read_to_string(&record).unwrap();
    fs::write(
        &record,
        text.replace("\"status\": \"finished\"", "\"status\": \"interrupted\""),
    )
    .unwrap();
    let told = gallery(&place, &["--only", "hopper"], 0);
    assert!(told.contains("sliceflow resume gallery/hopper"), "{told}");
    let wrong = gallery(&place, &["--only", "hoper"], 2);
    assert!(wrong.contains("hopper"), "{wrong}");
}
