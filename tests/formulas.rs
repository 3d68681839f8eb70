//! A force is one shader file and one row of `src/physics/formulas.rs`.

mod common;

use std::fs;
use std::path::Path;

use sliceflow::gpu::{AdapterChoice, Gpu};
use sliceflow::physics::fluid;
use sliceflow::physics::formulas::{self, FORCES, Formula};
use sliceflow::plan::{Plan, Wanted};
use sliceflow::simulation::Simulation;

/// It acts on each pair, and at the end.
const UPDRAFT: &str = "
struct Updraft {
    neighbors: f32,
}

fn updraft_pair(own: Own, other: Neighbor, forces: ptr<function, Forces>) {
    forces.updraft.neighbors += 1.0;
}

fn updraft_end(own: Own, forces: ptr<function, Forces>) {
    let strength = select(0.0, 3.0, forces.updraft.neighbors > 0.0);
    forces.push -= (strength * own.density) * first(parameters.gravity);
}
";

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        let target = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copy(&entry.path(), &target);
        } else {
            fs::copy(entry.path(), target).unwrap();
        }
    }
}

/// Mean velocity upwards of a block of fluid after some steps in the air.
fn rising(forces: &[Formula]) -> f32 {
    let scene = common::fluid(
        2,
        &[
            "domain.walls=open",
            "colliders=[]",
            "bodies=[{\"shape\":{\"kind\":\"box\",\"min\":[0.3,0.2],\"max\":[0.6,0.4]}}]",
        ],
    );
    let gpu = Gpu::open(&AdapterChoice::Best, true).expect("tests need an adapter; software Vulkan will do");
    let mut plan = Plan::new(&scene, &gpu.limits, &Wanted::default()).unwrap();
    formulas::list("force", forces, &fluid::terms(&scene), &mut plan.variant);
    let mut simulation = Simulation::new(gpu, &scene, &plan).unwrap();
    for _ in 0..2 {
        simulation.next_frame().unwrap();
    }
    while simulation.finish_frame().unwrap().is_some() {}
    let velocity = simulation.particles().unwrap().velocity;
    velocity.iter().map(|v| v.y).sum::<f32>() / velocity.len() as f32
}

#[test]
fn a_force_added_by_one_file_and_one_row_acts() {
    let folder = std::env::temp_dir().join(format!("sliceflow_formulas_{}", std::process::id()));
    copy(&Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders"), &folder);
    fs::write(folder.join("physics/fluid/forces/updraft.wgsl"), UPDRAFT).unwrap();
    // SAFETY: this program has no other test, and nothing else runs yet that reads the environment.
    unsafe { std::env::set_var("SLICEFLOW_SHADERS", &folder) };
    let falling = rising(FORCES);
    let updraft = Formula {
        file: "physics/fluid/forces/updraft",
        acts: |_| true,
    };
    let rows: Vec<Formula> = FORCES.iter().copied().chain([updraft]).collect();
    let rising = rising(&rows);
    fs::remove_dir_all(&folder).unwrap();
    // Gravity is 1 m/s², a frame 1/20 s: −0.05 m/s without the force, twice that upwards with it.
    assert!((falling + 0.05).abs() < 1e-3, "{falling}");
    assert!((rising - 0.1).abs() < 2e-3, "{rising}");
}
