//! Every picture shader, composed and validated without a GPU; structs against the host's, offset by offset.

use sliceflow::gpu::{Shader, Variant, compose};
use sliceflow::render::{Picture, PoolPanel};
use sliceflow::scene::column::COLUMNS;

fn variants() -> Vec<Variant> {
    let mut all = Vec::new();
    for (two, solid, floor) in [(true, false, false), (false, false, false), (false, true, true)] {
        for column in COLUMNS {
            let mut variant = Variant::default();
            variant
                .flag("two_dimensional", two)
                .flag("shadows", solid)
                .flag("occlusion", solid)
                .flag("round_shadows", solid)
                .flag("has_floor", floor)
                .constant("SHADOW_TEXELS", 1024)
                .constant("OCCLUSION_BLOCK", 8)
                .role("column", format!("render/columns/{}", column.name))
                .constant("DIMENSIONS", if two { 2 } else { 3 })
                .constant("SLOTS", 4)
                .constant("REACH", 1)
                .role("addressing", "cells/sliced")
                .role("storage", "storage/pool/query");
            all.push(variant);
        }
    }
    all
}

#[test]
fn every_picture_shader_is_valid() {
    let mut failures = Vec::new();
    for variant in variants() {
        for path in compose::files().iter().filter(|path| path.starts_with("render/")) {
            if let Err(error) = Shader::load(path, &variant) {
                failures.push(format!("{path} with {:?}: {error}", variant.flags));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn every_column_has_a_file() {
    let files = compose::files();
    for column in COLUMNS {
        let path = format!("render/columns/{}", column.name);
        assert!(files.contains(&path), "there is no shaders/{path}.wgsl");
    }
}

#[test]
fn uniforms_have_one_layout_on_both_sides() {
    let variant = &variants()[0];
    for (path, layout) in [
        ("render/picture", Picture::LAYOUT),
        ("render/pool", PoolPanel::LAYOUT),
    ] {
        let shader = Shader::load(path, variant).unwrap();
        let found = shader
            .structs()
            .into_iter()
            .find(|found| found.name == layout.name)
            .unwrap();
        assert_eq!(found.size as usize, layout.size, "{path}");
        let fields: Vec<(&str, usize, usize)> = found
            .fields
            .iter()
            .map(|(name, offset, size)| (name.as_str(), *offset as usize, *size as usize))
            .collect();
        assert_eq!(fields, layout.fields, "{path}");
    }
}
