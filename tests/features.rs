//! Cargo features: what builds share is built once, and what a build lacks is refused.

/// What ./sliceflow has built first is not built again for what it builds later, nor for tests: each crate has the same
/// features there. Only Sliceflow itself, whose features are what is asked for, is built again.
#[cfg(feature = "rerun")]
#[test]
fn no_crate_is_built_twice() {
    use std::collections::BTreeSet;
    use std::process::Command;

    /// A line for each crate and set of features, as NAME vVERSION [FEATURES]. A crate that build scripts use with
    /// other features than the program has two lines, and is built twice in any build.
    fn crates(edges: &str, features: &[&str]) -> BTreeSet<String> {
        let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".into());
        let output = Command::new(cargo)
            .args(["tree", "--offline", "--locked", "--quiet", "--prefix", "none"])
            .args(["--format", "{p} [{f}]", "--edges", edges])
            .args(features)
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .expect("cargo runs");
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        let text = String::from_utf8(output.stdout).expect("text");
        let lines = text.lines().map(|line| line.trim_end_matches(" (*)"));
        let others = lines.filter(|line| line.contains(" v") && !line.starts_with("sliceflow v"));
        others.map(str::to_owned).collect()
    }

    let launcher = include_str!("../sliceflow");
    let listed = |name: &str| {
        let (_, after) = launcher
            .split_once(&format!("\n{name}=\""))
            .expect("a list of features");
        after.split_once('"').expect("its end").0
    };
    let lean = listed("lean");
    let mut again = BTreeSet::new();
    // What the program is linked from, then also what runs while it is built: a crate of the program must not hide behind
    // one of that name and with other features that a build script uses.
    for edges in ["normal,no-proc-macro", "normal,build"] {
        let build = |features: &str| {
            let crates = crates(edges, &["--no-default-features", "--features", features]);
            assert!(crates.len() > 100, "{features}: {crates:?}");
            crates
        };
        let first = build(lean);
        let tests = crates(&format!("{edges},dev"), &[]);
        for feature in listed("all").split(' ') {
            let then = build(&format!("{lean} {feature}"));
            again.extend(first.difference(&then).cloned());
            again.extend(then.difference(&tests).cloned());
        }
    }
    assert!(
        again.is_empty(),
        "{} crates would be built again; give them the features that they have later, in Cargo.toml: {again:#?}",
        again.len()
    );
}

/// As a user of a lean build meets what it lacks.
#[cfg(all(
    feature = "cli",
    not(any(feature = "rerun", feature = "study", feature = "surface"))
))]
#[test]
fn what_a_build_lacks_is_refused() {
    for (args, what) in [
        (&["surface", "out/run", "--cube-size", "1"][..], "surfaces"),
        (&["study", "accuracy", "--case", "collision"], "studies"),
        (&["bench", "--quick"], "benchmarks"),
        (&["run", "column_2d", "--rerun", "out/run.rrd"], "Rerun"),
    ] {
        let mut command = assert_cmd::cargo_bin_cmd!("sliceflow");
        let output = command.args(args).assert().code(2).get_output().clone();
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(text.contains(what), "{args:?}: {text}");
        assert!(
            text.contains("cargo build --release") && text.contains("./sliceflow"),
            "{text}"
        );
    }
}
