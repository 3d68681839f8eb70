//! Charts hold what they were given, as PNG and as SVG.

use super::*;

fn lines() -> Plot {
    Plot::new("Construction of the grid", "particles", "construction, ms")
        .series(
            "GPU",
            [
                (16_386.0, 0.7),
                (65_536.0, 2.6),
                (262_144.0, 10.3),
                (589_824.0, 23.0),
            ],
        )
        .series(
            "CPU",
            [
                (16_386.0, 2.0),
                (65_536.0, 9.0),
                (262_144.0, f64::NAN),
                (589_824.0, 101.0),
            ],
        )
        .points(
            "paper",
            [
                (16_386.0, 1.48),
                (65_536.0, 3.91),
                (262_144.0, 13.9),
                (589_824.0, 31.7),
            ],
        )
        .log_x()
        .log_y()
        .mark_y(16.7, "60 frames a second")
        .mark_x(1e5, "100 k")
        .band(1.0, 4.0, "usual")
}

fn bars() -> Bars {
    Bars::new("Bytes of each grid", "MiB", ["full tank", "two\nblobs", "line"])
        .series("uniform", [32.0, 32.0, 32.0])
        .series("sliced", [30.0, 12.0, 0.5])
        .series("rows", [30.0, 3.0, f64::NAN])
        .mark_y(8.0, "octree")
}

/// Pixels of a color, within the smoothing's reach.
fn pixels(path: &Path, color: [u8; 3]) -> usize {
    let picture = image::open(path).unwrap().into_rgb8();
    picture
        .pixels()
        .filter(|p| p.0.iter().zip(color).all(|(a, b)| a.abs_diff(b) < 6))
        .count()
}

#[test]
fn a_chart_shows_every_series_and_every_word() {
    let folder = tempfile::tempdir().unwrap();
    let png = folder.path().join("lines.png");
    let svg = folder.path().join("lines.svg");
    lines().save(&png).unwrap();
    lines().save(&svg).unwrap();
    assert_eq!(image::image_dimensions(&png).unwrap(), (1000, 600));
    for index in 0..3 {
        assert!(pixels(&png, look(index).color) > 100, "series {index}");
    }
    let text = std::fs::read_to_string(&svg).unwrap();
    for word in [
        "Construction of the grid",
        "particles",
        "construction, ms",
        "GPU",
        "CPU",
        "60 frames a second",
        "usual",
        "500 k",
    ] {
        assert!(text.contains(word), "{word}");
    }
}

#[test]
fn bars_are_as_high_as_their_values() {
    let folder = tempfile::tempdir().unwrap();
    let png = folder.path().join("bars.png");
    bars().save(&png).unwrap();
    let area = |index| pixels(&png, look(index).color) as f64;
    let [uniform, sliced, rows] = [0, 1, 2].map(area);
    // The legend's samples are part of each.
    assert!(
        (uniform / sliced - 96.0 / 42.5).abs() < 0.15,
        "{uniform} {sliced}"
    );
    assert!((uniform / rows - 96.0 / 33.0).abs() < 0.2, "{uniform} {rows}");
}

#[test]
fn what_has_no_place_is_told() {
    let canvas = Plot::new("", "", "")
        .series("", [(1.0, 0.0), (2.0, 5.0), (3.0, 50.0)])
        .log_y()
        .draw();
    let folder = tempfile::tempdir().unwrap();
    let svg = folder.path().join("a.svg");
    canvas.save(&svg).unwrap();
    assert!(
        std::fs::read_to_string(&svg)
            .unwrap()
            .contains("1 values of zero or below")
    );
}

#[test]
fn points_have_labels_and_failures_crosses() {
    let folder = tempfile::tempdir().unwrap();
    let plain = Plot::new("", "", "")
        .series("a", [(1.0, 2.0), (10.0, 1.0)])
        .log_x()
        .log_y();
    let files = ["plain.png", "crossed.png", "crossed.svg"].map(|name| folder.path().join(name));
    plain.save(&files[0]).unwrap();
    let crossed = plain
        .clone()
        .labelled(["25²", "50²"])
        .crosses([((5.0, 1.5), "100²")]);
    crossed.save(&files[1]).unwrap();
    crossed.save(&files[2]).unwrap();
    let [before, after] = [0, 1].map(|file| pixels(&files[file], look(0).color));
    assert!(after > before + 20, "{before} {after}");
    let text = std::fs::read_to_string(&files[2]).unwrap();
    for label in ["25²", "50²", "100²"] {
        assert!(text.contains(label), "{label}");
    }
    // Of several dashed lines each has its name beside it and in the legend.
    let lines = plain.mark_y(1.0, "low").mark_y(2.0, "high");
    lines.save(&files[2]).unwrap();
    assert_eq!(
        std::fs::read_to_string(&files[2])
            .unwrap()
            .matches("high")
            .count(),
        2
    );
    // A cross beyond the other points is in sight.
    let far = Plot::new("", "", "")
        .series("a", [(1.0, 2.0)])
        .crosses([((500.0, 2.0), "far")]);
    far.save(&files[2]).unwrap();
    assert!(std::fs::read_to_string(&files[2]).unwrap().contains("far"));
}

#[test]
fn other_endings_are_refused() {
    let refused = lines().save(Path::new("/tmp/plot.pdf")).unwrap_err();
    assert_eq!(refused.exit_code(), 2);
    assert!(refused.to_string().contains(".svg"), "{refused}");
}
