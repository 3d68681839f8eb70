//! Ranges of colors and color maps.

use sliceflow::scene::color_maps;

use super::{block, valid};

#[test]
fn color_ranges_come_from_the_scene() {
    let fall = (2.0f64 * 9.81 * 2.0).sqrt();
    let expected = [
        ("speed", [0.0, fall]),
        ("velocity_y", [-fall, fall]),
        ("x", [-1.0, 1.0]),
        ("id", [0.0, 63.0]),
        ("contacts", [0.0, 12.0]),
        ("density", [0.0, 1000.0]),
        ("pressure", [0.0, 1000.0 * 9.81 * 2.0]),
        ("slice", [0.0, 20.0]),
    ];
    for (column, [low, high]) in expected {
        let color = valid(&block(), &[&format!("render.color.by={column}")]).color;
        assert_eq!(color.column.name, column);
        assert!(
            (color.range[0] - low).abs() < 1e-9 && (color.range[1] - high).abs() < 1e-9,
            "{column}"
        );
    }
    assert_eq!(valid(&block(), &["gravity=[0,0,0]"]).color.range, [0.0, 1.0]);
}

#[test]
fn color_maps_have_distinct_names_and_the_papers_ends() {
    for (i, map) in color_maps::COLOR_MAPS.iter().enumerate() {
        assert!(
            color_maps::COLOR_MAPS[..i]
                .iter()
                .all(|other| other.name != map.name),
            "{}",
            map.name
        );
        assert_ne!((map.at)(0.0), (map.at)(0.5), "{}", map.name);
    }
    let ends = |name: &str| [0.0, 1.0].map(color_maps::find(name).unwrap().at);
    assert_eq!(ends("white_blue"), [[255, 255, 255], [0, 0, 255]]);
    assert_eq!(ends("rojas"), [[0, 0, 255], [255, 0, 0]]);
    assert_eq!(ends("viridis"), [[68, 1, 84], [253, 231, 37]]);
}

#[test]
fn hex_colors() {
    assert_eq!(color_maps::parse_hex("#8a8f98"), Some([0x8a, 0x8f, 0x98]));
    for wrong in ["8a8f98", "#8a8f9", "#8a8f981", "#8a8f9g", "#+a8f98", "#äää"] {
        assert_eq!(color_maps::parse_hex(wrong), None, "{wrong}");
    }
}
