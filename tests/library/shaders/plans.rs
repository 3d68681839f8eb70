//! Plans that together use every flag and role.

use sliceflow::gpu::device::Limits;
use sliceflow::neighbors::{ADDRESSINGS, STORAGES};
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::Scene;
use sliceflow::scene::column::find;

use super::{BLOCK, wanted};
use crate::common;

/// Plans that together use every flag and role.
pub fn plans() -> Vec<Plan> {
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
        let smallest = if dimensions == 2 { 0.008 } else { 0.02 };
        let sizes = format!(r#"grains.sizes={{"kind":"uniform","smallest":{smallest}}}"#);
        let sizes = [&*sizes, "bodies[0].jitter=0", "bodies[0].spacing=null"];
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
            &[&sizes[..], &["grains.rolling_friction=0.1"]].concat(),
            &[
                &sizes[..],
                &["grains.spring=null", "grains.contact_time=0.01", steel],
            ]
            .concat(),
            &[
                &sizes[..],
                &[
                    "grains.law=hertz",
                    "grains.spring=null",
                    "grains.young_modulus=1e6",
                ],
            ]
            .concat(),
            &[&sizes[..], &["grains.law=spring_dashpot"]].concat(),
        ] {
            if dimensions == 2 && (more.contains(&"grains.law=hertz") || more[0] == TUBE) {
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

/// Plans of what is off in the others.
pub fn bare_plans() -> Vec<Plan> {
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
