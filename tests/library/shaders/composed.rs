//! Flags, phases and messages of composed shaders.

use sliceflow::gpu::compose::{self, compose, known_flags};
use sliceflow::gpu::device::Limits;
use sliceflow::gpu::{Shader, Variant};
use sliceflow::plan::{Phase, Plan, Wanted};

use super::plans::bare_plans;
use super::{COMPOSED, wanted};
use crate::common;

#[test]
fn every_flag_is_composed_both_on_and_off() {
    let mut seen = COMPOSED.flags.clone();
    let mut see = |path: &str, variant: &Variant| match compose(path, variant) {
        Ok(composed) => seen.extend(composed.flags),
        Err(error) => panic!("{error}"),
    };
    for plan in bare_plans() {
        for row in &plan.passes {
            see(&row.pass.shader, &plan.variant_of(row.phase));
        }
    }
    for dimensions in [2, 3] {
        let plan = Plan::new(&common::scene(dimensions, &[]), &Limits::PROMISED, &wanted()).expect("a plan");
        for solid in [false, true] {
            let mut variant = plan.variant.clone();
            let flags = [
                "shadows",
                "occlusion",
                "round_shadows",
                "has_floor",
                "water",
                "water_mesh",
                "transparent",
                "solid_floor",
                "has_obstacles",
                "color_pass",
                "blurred",
                "matte",
            ];
            for flag in flags {
                variant.flag(flag, solid);
            }
            variant
                .constant("SHADOW_TEXELS", 1024)
                .constant("OCCLUSION_BLOCK", 8)
                .role("seen_particle", "render/passes/seen_sphere")
                .role("own_surface", "render/looks/sand")
                .role("column", "fields/id/color");
            for path in compose::files().iter().filter(|path| path.starts_with("render/")) {
                see(path, &variant);
            }
        }
    }
    let both = |flag: &&String| {
        [true, false]
            .iter()
            .all(|&on| seen.contains(&((*flag).clone(), on)))
    };
    let missing: Vec<&String> = known_flags().iter().filter(|flag| !both(flag)).collect();
    assert!(missing.is_empty(), "never both on and off: {missing:?}");
}

#[test]
fn flags_that_nobody_knows_or_decides_about_are_errors() {
    let mut variant = Variant::default();
    variant.flag("two_dimensional", true);
    compose("common/vector", &variant).expect("composed");
    variant.flag("three_dimensional", false);
    let unknown = compose("common/vector", &variant)
        .expect_err("no shader knows it")
        .to_string();
    assert!(unknown.contains("`three_dimensional`"), "{unknown}");
    let undecided = compose("common/vector", &Variant::default())
        .expect_err("nobody decided")
        .to_string();
    assert!(
        undecided.contains("shaders/common/vector.wgsl:") && undecided.contains("`two_dimensional`"),
        "{undecided}"
    );
}

#[test]
fn one_file_may_be_composed_differently_from_phase_to_phase() {
    let plan = Plan::new(&common::scene(2, &[]), &Limits::PROMISED, &wanted()).expect("a plan");
    let text = |phase| {
        compose("physics/dem/contacts", &plan.variant_of(phase))
            .expect("composed")
            .text
    };
    assert!(
        text(Phase::Step) != text(Phase::Observe),
        "kernels would be mixed up by their file alone"
    );
}

#[test]
fn an_error_names_the_authors_file_and_line() {
    let mut variant = sliceflow::gpu::Variant::default();
    variant
        .flag("two_dimensional", true)
        .without(&["bounded", "periodic", "regions", "separated"])
        .role("addressing", "cells/nowhere")
        .constant("SLOTS", 4)
        .constant("REACH", 1);
    let error = Shader::load("storage/pool/query", &variant)
        .err()
        .expect("no such file")
        .to_string();
    assert!(error.contains("shaders/storage/pool/query.wgsl:2"), "{error}");
    assert!(error.contains("shaders/cells/nowhere.wgsl"), "{error}");
    // Without SLOTS the module parses up to the line that names it.
    variant.constants.remove("SLOTS");
    variant.role("addressing", "cells/uniform");
    let error = Shader::load("storage/pool/query", &variant)
        .err()
        .expect("no SLOTS")
        .to_string();
    assert!(
        error.contains("shaders/storage/pool/query.wgsl:") && error.contains("SLOTS"),
        "{error}"
    );
    // So does one about a list.
    let scene = common::fluid(2, &[]);
    let plan = Plan::new(&scene, &Limits::PROMISED, &Wanted::default()).expect("a plan");
    let mut variant = plan.variant.clone();
    variant.lists.clear();
    let error = Shader::load("physics/fluid/symplectic_euler", &variant)
        .err()
        .expect("no list")
        .to_string();
    assert!(
        error.contains("shaders/physics/fluid/forces.wgsl:") && error.contains("`force`"),
        "{error}"
    );
}
