//! Every pass finds what it binds, and structs agree with the host.

use std::collections::BTreeSet;

use sliceflow::gpu::buffers::Usage;
use sliceflow::gpu::compose;
use sliceflow::gpu::device::Limits;
use sliceflow::gpu::{Shader, Variant};
use sliceflow::neighbors::STORAGES;
use sliceflow::physics::layout::SHARED;
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::model::SurfaceKernel;
use sliceflow::surface::layout::{Surface, SurfaceTotals};
use sliceflow::surface::{self, Shape};

use super::COMPOSED;
use crate::common;

#[test]
fn every_pass_of_every_variant_is_valid_and_finds_its_buffers() {
    let mut failures = Vec::new();
    for (plan, rows) in COMPOSED.passes() {
        for (row, resources) in rows {
            match resources {
                Ok(names) => {
                    for name in &names {
                        if !plan.buffers.iter().any(|b| b.name == *name) {
                            failures.push(format!("{}: no buffer `{name}`", row.pass.entry));
                        }
                    }
                }
                Err(error) => failures.push(error),
            }
        }
    }
    failures.sort();
    failures.dedup();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn every_planned_buffer_is_used_by_a_pass() {
    for (plan, rows) in COMPOSED.passes() {
        let used: BTreeSet<String> = rows
            .into_iter()
            .flat_map(|(_, resources)| resources.expect("a valid shader"))
            .collect();
        // Arguments of dispatches are used by being there.
        for buffer in plan.buffers.iter().filter(|b| b.usage != Usage::Indirect) {
            assert!(used.contains(&buffer.name), "no pass uses `{}`", buffer.name);
        }
    }
}

/// Shaders of surfaces: those that look at particles, whatever search they come from, and those that look at voxels.
#[test]
fn every_shader_of_surfaces_is_valid_and_shares_its_structs() {
    // What others import.
    const PARTS: [&str; 8] = [
        "implicit",
        "mirrors",
        "unit",
        "blend",
        "cells",
        "marks",
        "surface",
        "cube_table",
    ];
    let of_particles = [
        "find_shell",
        "list_shell",
        "evaluate_nodes",
        "find_normals",
        "blend_column",
        "color_mesh",
    ];
    let mut scenes = vec![
        common::fluid(3, &[]),
        common::fluid(3, &["domain.walls=planes", "neighbors.skin=0.1"]),
    ];
    scenes.extend(
        STORAGES
            .iter()
            .map(|row| common::scene(3, &[&format!("neighbors.storage={}", row.name)])),
    );
    let mut structs = Vec::new();
    let mut load = |file: &str, variant: &Variant| match Shader::load(&format!("surface/{file}"), variant) {
        Ok(shader) => structs.extend(shader.structs()),
        Err(error) => panic!("{error}"),
    };
    for scene in &scenes {
        let plan = Plan::new(scene, &Limits::PROMISED, &Wanted::default()).expect("a plan");
        let kernels = [SurfaceKernel::Anisotropic, SurfaceKernel::Isotropic];
        for (addressing, kernel) in surface::ADDRESSINGS
            .into_iter()
            .flat_map(|a| kernels.map(|k| (a, k)))
        {
            let shape = Shape {
                spacing: 1.0,
                reach: 2.5,
                width: 0.5,
                addressing,
                kernel,
                drops: None,
                sides: [[None; 2]; 3],
            };
            let [mut particles, voxels] = surface::variants(&plan.variant, &shape);
            particles
                .constant("COLUMN_WIDTH", 3)
                .role("column", "render/columns/speed");
            for path in compose::files() {
                match path.strip_prefix("surface/") {
                    Some(file) if of_particles.contains(&file) => load(file, &particles),
                    Some(file) if PARTS.contains(&file) || file.contains('/') => {}
                    None => {}
                    Some(file) => load(file, &voxels),
                }
            }
        }
    }
    for host in [Surface::LAYOUT, SurfaceTotals::LAYOUT] {
        let shader = structs
            .iter()
            .find(|known| known.name == host.name)
            .expect("a struct");
        let fields: Vec<_> = host
            .fields
            .iter()
            .map(|&(name, offset, size)| (name.to_owned(), offset as u32, size as u32))
            .collect();
        assert_eq!(
            (fields, host.size as u32),
            (shader.fields.clone(), shader.size),
            "{}",
            host.name
        );
    }
}

#[test]
fn shared_structs_agree_offset_by_offset() {
    let mut seen = BTreeSet::new();
    for shader in &COMPOSED.shaders {
        for layout in shader.as_ref().expect("a valid shader").structs() {
            let Some(host) = SHARED.iter().find(|s| s.name == layout.name) else {
                continue;
            };
            seen.insert(host.name);
            let fields: Vec<_> = host
                .fields
                .iter()
                .filter(|(name, ..)| !name.starts_with('_'))
                .map(|&(name, offset, size)| (name.to_owned(), offset as u32, size as u32))
                .collect();
            assert_eq!(fields, layout.fields, "struct {}", layout.name);
            assert_eq!(host.size as u32, layout.size, "size of {}", layout.name);
        }
    }
    let all: BTreeSet<_> = SHARED.iter().map(|s| s.name).collect();
    assert_eq!(seen, all, "structs that no shader has");
}
