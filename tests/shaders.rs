//! Every shader of every variant, without a GPU.

mod common;

use std::collections::{BTreeSet, HashMap};
use std::sync::LazyLock;

use sliceflow::gpu::buffers::Usage;
use sliceflow::gpu::compose::{self, compose, known_flags};
use sliceflow::gpu::device::Limits;
use sliceflow::gpu::{Shader, Variant};
use sliceflow::neighbors::{ADDRESSINGS, STORAGES};
use sliceflow::physics::layout::SHARED;
use sliceflow::plan::{PassRow, Phase, Plan, Wanted};
use sliceflow::scene::Scene;
use sliceflow::scene::column::{COLUMNS, Source, find};
use sliceflow::surface::layout::{Surface, SurfaceTotals};
use sliceflow::surface::{self, Shape};

fn wanted() -> Wanted {
    let measured = COLUMNS.iter().copied().filter(|c| c.source == Source::Measured);
    Wanted {
        statistics: true,
        columns: measured.collect(),
        columns_every: 0,
        view: None,
        voxel_map: Some(64),
        ..Wanted::default()
    }
}

/// Plans of fluids that together use every flag and role.
fn fluid_plans() -> Vec<Plan> {
    let solvers: [&[&str]; 13] = [
        &["fluid.solver=sph", "fluid.viscosity=0.1"],
        &["time.adaptive=true"],
        &["time.adaptive=true", "time.integrator=velocity_verlet"],
        &[
            "fluid.density_from=summation",
            "fluid.pressure_force=monaghan",
            "fluid.kernel=cubic_spline",
        ],
        &[
            "time.integrator=velocity_verlet",
            "fluid.negative_pressure=control",
            "fluid.artificial_viscosity=0.1",
            "time.integrator=velocity_verlet",
        ],
        &["fluid.viscosity=0.1", "fluid.viscosity_form=stress"],
        &[
            "fluid.surface_tension=1",
            "domain.sides={\"y_min\":\"particles\",\"y_max\":\"open\"}",
        ],
        &[
            "fluid.viscosity=0.1",
            "fluid.slip=free_slip",
            "fluid.kernel=wendland_c4",
        ],
        &[
            "fluid.viscosity=0.1",
            "fluid.viscosity_form=laplacian",
            "fluid.gradient_correction=true",
        ],
        &[
            "fluid.shifting=1",
            "fluid.slip=free_slip",
            "fluid.wall_friction=0.01",
        ],
        &[
            "fluid.viscosity=0.1",
            "fluid.viscosity_form=stress",
            "fluid.slip=free_slip",
            "fluid.gradient_correction=true",
        ],
        &[
            "fluid.viscosity=0.1",
            "fluid.viscosity_form=stress",
            "fluid.gradient_correction=true",
            "fluid.pressure_force=difference",
            "fluid.shifting=1",
            "fluid.kernel=quintic_spline",
            "fluid.negative_pressure=keep",
        ],
        &[
            "fluid.viscosity=0.1",
            "fluid.materials=[{\"name\":\"water\",\"density\":1000},{\"name\":\"oil\",\"density\":900,\"viscosity\":1}]",
        ],
    ];
    let mut plans = Vec::new();
    for dimensions in [2, 3] {
        for solver in solvers {
            for walls in ["particles", "periodic", "planes"] {
                let walls = format!("domain.walls={walls}");
                let overrides = [solver, &[&walls]].concat();
                let scene = common::fluid(dimensions, &overrides);
                plans.push(Plan::new(&scene, &Limits::PROMISED, &wanted()).expect("a plan"));
            }
        }
    }
    for dimensions in [2, 3] {
        for walls in ["particles", "periodic", "open"] {
            for drag in [
                "fluid.viscosity=0",
                "fluid.viscosity=0.1",
                "fluid.artificial_viscosity=0.1",
                // So much that it is implicit.
                "fluid.viscosity=1e4",
            ] {
                let walls = format!("domain.walls={walls}");
                let scene = common::fluid(dimensions, &["fluid.solver=dfsph", drag, &walls]);
                plans.push(Plan::new(&scene, &Limits::PROMISED, &wanted()).expect("a plan"));
            }
        }
    }
    plans
}

/// Every kind of sensor that grains or a fluid can have.
fn sensors(dimensions: usize, is_fluid: bool) -> String {
    let at = |numbers: [f64; 3]| format!("{:?}", &numbers[..dimensions]);
    let mut all = vec![
        format!(
            r#"{{"name":"flux","kind":"flux","min":{},"max":{}}}"#,
            at([0.5, 0.1, 0.1]),
            at([0.5, 0.2, 0.2])
        ),
        r#"{"name":"side","kind":"force","side":"x_min"}"#.into(),
        r#"{"name":"profile","kind":"profile","axis":"x"}"#.into(),
        r#"{"name":"extremes","kind":"extremes","field":"position"}"#.into(),
    ];
    if is_fluid {
        all.extend([
            r#"{"name":"post","kind":"force","obstacle":"post"}"#.into(),
            format!(r#"{{"name":"point","kind":"point","at":{}}}"#, at([0.2; 3])),
            format!(r#"{{"name":"height","kind":"height","from":{}}}"#, at([0.2; 3])),
        ]);
    }
    format!("sensors=[{}]", all.join(","))
}

/// Plans of scenes with sensors.
fn plans_with_sensors() -> Vec<Plan> {
    let mut plans = Vec::new();
    let wanted = Wanted {
        sensors: true,
        // As when the cost of guards is measured.
        unguarded: true,
        ..Wanted::default()
    };
    let mut add = |scene| plans.push(Plan::new(&scene, &Limits::PROMISED, &wanted).expect("a plan"));
    for dimensions in [2, 3] {
        let of_fluids = sensors(dimensions, true);
        for more in [
            &["domain.walls=particles"][..],
            &["domain.walls=planes", "fluid.viscosity=0.1"],
            &["fluid.solver=dfsph", "fluid.viscosity=0.1"],
            &[
                "fluid.artificial_viscosity=0.1",
                "fluid.slip=free_slip",
                "neighbors.storage=pool",
            ],
            &[
                "domain.sides={\"y_min\":\"periodic\",\"y_max\":\"periodic\"}",
                "neighbors.cell=half",
            ],
            &["fluid.materials=[{\"name\":\"water\",\"density\":1000},{\"name\":\"oil\",\"density\":900}]"],
        ] {
            add(common::fluid(dimensions, &[&[&*of_fluids], more].concat()));
        }
        let alone = format!(
            r#"sensors=[{{"name":"point","kind":"point","at":{:?}}}]"#,
            &[0.2; 3][..dimensions]
        );
        add(common::fluid(dimensions, &[&*alone]));
        let of_grains = sensors(dimensions, false);
        for more in [
            "neighbors.storage=pool",
            "time.adaptive=true",
            "time.integrator=velocity_verlet",
        ] {
            add(common::scene(
                dimensions,
                &[&of_grains, more, "domain.walls=contact", "domain.sides={}"],
            ));
        }
    }
    plans
}

/// Plans of grains that rotate, which together use every flag and role.
fn friction_plans() -> Vec<Plan> {
    const TUBE: &str =
        r#"colliders=[{"shape":{"kind":"cylinder","from":[0,-1,0],"to":[0,1,0],"radius":2,"hollow":true}}]"#;
    let steel = r#"grains.materials=[{"name":"steel","friction":0.1}]"#;
    let mut plans = Vec::new();
    for dimensions in [2, 3] {
        let sensors = sensors(dimensions, false);
        let at = |numbers: [f64; 3]| format!("{:?}", &numbers[..dimensions]);
        let rigid = format!(
            r#"bodies=[{{"shape":{{"kind":"box","min":{},"max":{}}},"rigid":{{}}}}]"#,
            at([0.0, 0.1, 0.0]),
            at([0.3, 0.4, 0.3])
        );
        for more in [
            &["grains.global_damping=0.1"][..],
            &["grains.rolling_friction=0.1", &*rigid],
            &[&*rigid, "neighbors.storage=pool"],
            &["grains.rolling_friction=0.1", "time.adaptive=true"],
            &[
                "grains.rolling_friction=0.1",
                "grains.rolling_resistance=constant_torque",
                "neighbors.storage=pool",
            ],
            &[
                "grains.law=hertz",
                "grains.spring=null",
                "grains.young_modulus=1e6",
            ],
            &[
                steel,
                "grains.cohesion=0.01",
                "domain.side_materials={\"y_min\":\"steel\"}",
            ],
            &[steel, "bodies[0].material=steel", "colliders[0].spin=1"],
            &[TUBE],
        ] {
            if dimensions == 2 && (more[0] == "grains.law=hertz" || more[0] == TUBE) {
                continue;
            }
            let given = [
                "grains.law=linear",
                "domain.walls=contact",
                "domain.sides={}",
                &*sensors,
            ];
            let scene = common::scene(dimensions, &[&given[..], more].concat());
            for sensors in [false, true] {
                let wanted = Wanted { sensors, ..wanted() };
                plans.push(Plan::new(&scene, &Limits::PROMISED, &wanted).expect("a plan"));
            }
        }
    }
    plans
}

/// Rigid bodies in a fluid.
fn floating_plans() -> Vec<Plan> {
    let mut plans = Vec::new();
    for dimensions in [2, 3] {
        let z = |z: &str| {
            if dimensions == 3 {
                format!(",{z}")
            } else {
                String::new()
            }
        };
        let bodies = format!(
            r#"bodies=[{{"shape":{{"kind":"box","min":[0,0{}],"max":[0.3,0.4{}]}}}},
                {{"shape":{{"kind":"sphere","center":[0.15,0.2{}],"radius":0.1}},"rigid":{{}}}}]"#,
            z("0"),
            z("0.4"),
            z("0.2")
        );
        for more in [
            &["fluid.viscosity=0.1", "neighbors.storage=counting"][..],
            &[
                "fluid.viscosity=0.1",
                "fluid.slip=free_slip",
                "neighbors.storage=pool",
            ],
            &[
                "fluid.viscosity=0",
                "domain.walls=open",
                "neighbors.storage=radix",
            ],
        ] {
            let given = ["fluid.solver=dfsph", &*bodies];
            let scene = common::fluid(dimensions, &[&given[..], more].concat());
            plans.push(Plan::new(&scene, &Limits::PROMISED, &wanted()).expect("a plan"));
        }
    }
    plans
}

/// Plans that together use every flag and role.
fn plans() -> Vec<Plan> {
    let wanted = wanted();
    let mut plans = fluid_plans();
    plans.extend(plans_with_sensors());
    plans.extend(friction_plans());
    plans.extend(floating_plans());
    for dimensions in [2, 3] {
        for addressing in ADDRESSINGS.iter().map(|row| row.name) {
            for storage in STORAGES.iter().map(|row| row.name) {
                for (row, integrator) in ["symplectic_euler", "velocity_verlet"].into_iter().enumerate() {
                    let steps = [
                        (0.0, false, false),
                        (0.1, addressing == "sliced", false),
                        (0.1, false, true),
                    ];
                    for (column, (skin, regions, adaptive)) in steps.into_iter().enumerate() {
                        // Each law of contact meets both integrators and all kinds of steps.
                        let laws = [("full", "contact"), ("normal", "clamp")];
                        let (dashpot, walls) = laws[(row + column) % 2];
                        let scene = common::scene(
                            dimensions,
                            &[
                                &format!("neighbors.addressing={addressing}"),
                                &format!("neighbors.storage={storage}"),
                                &format!("neighbors.skin={skin}"),
                                &format!("neighbors.regions={regions}"),
                                &format!("time.adaptive={adaptive}"),
                                &format!("time.integrator={integrator}"),
                                &format!("grains.dashpot={dashpot}"),
                                &format!("domain.walls={walls}"),
                                "grains.shear=0.1",
                                "grains.attraction=0.1",
                                "grains.global_damping=0.1",
                            ],
                        );
                        plans.push(Plan::new(&scene, &Limits::PROMISED, &wanted).expect("a plan"));
                    }
                }
            }
        }
    }
    plans
}

/// Plans and the shaders of their passes. Most plans share most of them.
struct Composed {
    plans: Vec<Plan>,
    /// One for each composed text, which may have several entry points.
    shaders: Vec<Result<Shader, String>>,
    /// Of each plan, the places of its passes' shaders.
    places: Vec<Vec<usize>>,
    /// Flags that they depend on, and whether they were set.
    flags: BTreeSet<(String, bool)>,
}

static COMPOSED: LazyLock<Composed> = LazyLock::new(|| {
    let mut composed = Composed {
        plans: plans(),
        shaders: Vec::new(),
        places: Vec::new(),
        flags: BTreeSet::new(),
    };
    let mut by_text = HashMap::new();
    for plan in &composed.plans {
        // Passes of one file and phase are composed alike.
        let mut by_file = HashMap::new();
        let places = plan.passes.iter().map(|row| {
            let file = (row.pass.shader.as_str(), row.phase as u8);
            *by_file.entry(file).or_insert_with(|| {
                let found = compose(&row.pass.shader, &plan.variant_of(row.phase));
                let found = found.unwrap_or_else(|error| panic!("{error}"));
                composed.flags.extend(found.flags.iter().cloned());
                *by_text.entry(found.text.clone()).or_insert_with(|| {
                    let shader = Shader::from_composed(&found);
                    composed.shaders.push(shader.map_err(|error| error.to_string()));
                    composed.shaders.len() - 1
                })
            })
        });
        composed.places.push(places.collect());
    }
    composed
});

/// A pass and the names of its shader's resources.
type Bound<'a> = (&'a PassRow, Result<Vec<String>, String>);

impl Composed {
    /// Each plan with its passes.
    fn passes(&self) -> impl Iterator<Item = (&Plan, Vec<Bound<'_>>)> {
        self.plans.iter().zip(&self.places).map(|(plan, places)| {
            let rows = plan.passes.iter().zip(places).map(|(row, &place)| {
                let resources = self.shaders[place]
                    .as_ref()
                    .map_err(Clone::clone)
                    .and_then(|shader| {
                        let resources = shader
                            .resources(&row.pass.entry)
                            .map_err(|error| error.to_string())?;
                        Ok(resources.into_iter().map(|resource| resource.name).collect())
                    });
                (row, resources)
            });
            (plan, rows.collect())
        })
    }
}

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
        for addressing in surface::ADDRESSINGS {
            let shape = Shape {
                spacing: 1.0,
                reach: 2.5,
                width: 0.5,
                addressing,
                sides: [[None; 2]; 3],
            };
            let [mut particles, voxels] = surface::variants(&plan.variant, &shape);
            particles
                .constant("COLUMN_WIDTH", 3)
                .role("column", "render/columns/speed");
            for path in compose::files() {
                match path.strip_prefix("surface/") {
                    Some(file) if of_particles.contains(&file) => load(file, &particles),
                    Some("implicit" | "cells" | "marks" | "surface" | "cube_table") | None => {}
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

/// Plans of what is off in the others.
fn bare_plans() -> Vec<Plan> {
    let bare = Wanted::default();
    let mut scenes = vec![
        common::scene(2, &["colliders=[]"]),
        common::scene(
            3,
            &["neighbors.deterministic=false", "neighbors.storage=counting"],
        ),
        common::scene(
            2,
            &[BLOCK, "neighbors.addressing=uniform", "neighbors.storage=bitonic"],
        ),
        common::fluid(2, &["colliders=[]"]),
        common::fluid(2, &["colliders=[]", "domain.walls=periodic", "gravity=[0,0]"]),
        common::fluid(3, &["fluid.density_diffusion=0", "fluid.slip=free_slip"]),
        common::fluid(2, &["fluid.artificial_viscosity=0.1", "fluid.slip=free_slip"]),
        common::fluid(2, &["fluid.solver=dfsph", "colliders=[]", "domain.walls=open"]),
    ];
    // So many that indices need more than 16 bits.
    let mut many = common::scene(2, &["neighbors.storage=bitonic"]);
    many.capacity = 100_000;
    scenes.push(many);
    let plan = |scene: &Scene, wanted: &Wanted| Plan::new(scene, &Limits::PROMISED, wanted).expect("a plan");
    let mut plans: Vec<Plan> = scenes.iter().map(|scene| plan(scene, &bare)).collect();
    let some = |statistics, columns| Wanted {
        statistics,
        columns,
        ..Wanted::default()
    };
    let contacts = find("contacts").expect("a column");
    for wanted in [some(true, Vec::new()), some(false, vec![contacts])] {
        for scene in [&scenes[0], &scenes[3]] {
            plans.push(plan(scene, &wanted));
        }
    }
    plans
}

/// An obstacle that rests.
const BLOCK: &str = "colliders=[{\"shape\":{\"kind\":\"sphere\",\"center\":[0.5,0.1],\"radius\":0.05}}]";

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
                "transparent",
                "solid_floor",
                "has_obstacles",
                "color_pass",
                "blurred",
            ];
            for flag in flags {
                variant.flag(flag, solid);
            }
            variant
                .constant("SHADOW_TEXELS", 1024)
                .constant("OCCLUSION_BLOCK", 8)
                .role("seen_particle", "render/passes/seen_sphere")
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
