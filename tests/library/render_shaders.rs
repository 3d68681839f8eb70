//! Every picture shader, composed and validated without a GPU; structs against the host's, offset by offset.

use std::collections::BTreeMap;

use sliceflow::gpu::{Shader, Variant, compose};
use sliceflow::neighbors::NO_VOXEL;
use sliceflow::physics::fields;
use sliceflow::render::blur::Subframe;
use sliceflow::render::passes::Passes;
use sliceflow::render::{Picture, PoolPanel, Water};
use sliceflow::scene::column::{COLUMNS, Column};
use sliceflow::scene::field::FIELDS;

/// What the role `<column>` is for a column.
fn file_of(column: &Column, modules: &BTreeMap<String, String>) -> String {
    let field = format!("fields/{}/color", column.name);
    match modules.contains_key(&field) {
        true => field,
        false => format!("render/columns/{}", column.name),
    }
}

fn variants() -> Vec<Variant> {
    let mut all = Vec::new();
    let on = [
        [true, false, false, false],
        [false; 4],
        [false, true, false, false],
        [false, true, true, false],
        [false, true, true, true],
    ];
    for [two, solid, water, transparent] in on {
        for column in COLUMNS.iter() {
            let mut variant = Variant::default();
            variant.modules.extend(fields::modules(FIELDS));
            variant
                .without(&["boundary_particles", "bounded", "regions", "separated", "sizes"])
                .constant("NO_VOXEL", NO_VOXEL)
                .constant("REGIONS_ALONG", 4)
                .flag("two_dimensional", two)
                .flag("shadows", solid)
                .flag("occlusion", solid)
                .flag("round_shadows", solid)
                .flag("has_floor", solid)
                .flag("matte", water)
                .role(
                    "own_surface",
                    match transparent {
                        true => "render/looks/sand",
                        false => "render/looks/clay",
                    },
                )
                .flag("water", water)
                .flag("water_mesh", transparent)
                .flag("transparent", transparent)
                .flag("solid_floor", solid && !transparent)
                .flag("has_obstacles", solid)
                .flag("floating_bodies", water)
                .flag("color_pass", transparent)
                .flag("blurred", water)
                .role(
                    "seen_particle",
                    match (two, water) {
                        (true, _) => "render/passes/seen_disc",
                        (_, true) => "render/passes/seen_water",
                        _ => "render/passes/seen_sphere",
                    },
                )
                .constant("SHADOW_TEXELS", 1024)
                .constant("OCCLUSION_BLOCK", 8)
                .role("column", file_of(column, &fields::modules(FIELDS)))
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
fn every_column_has_a_file_or_is_a_field() {
    let (files, modules) = (compose::files(), fields::modules(FIELDS));
    for column in COLUMNS.iter() {
        let path = file_of(column, &modules);
        assert!(
            files.contains(&path) || modules.contains_key(&path),
            "there is no shaders/{path}.wgsl"
        );
    }
}

#[test]
fn uniforms_have_one_layout_on_both_sides() {
    let variant = &variants()[0];
    for (path, layout) in [
        ("render/picture", Picture::LAYOUT),
        ("render/pool", PoolPanel::LAYOUT),
        ("render/passes/images", Passes::LAYOUT),
        ("render/subframe", Subframe::LAYOUT),
        ("render/water/water", Water::LAYOUT),
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
