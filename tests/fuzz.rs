//! Changed inputs, at random but the same ones in every run: no entry panics, hangs or takes much memory, whatever it is
//! given. An hour of it, which tells how many inputs each entry got, how many in a second, and what the most patient one took:
//!
//! `cargo test --release --test fuzz -- --ignored --nocapture`; SLICEFLOW_FUZZ_SECONDS says how long, SLICEFLOW_FUZZ_FIRST
//! which inputs are the first, so that one hour does not repeat another one.

#![cfg(all(feature = "cli", feature = "surface"))]

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use serde_json::Value;
use sha2::{Digest as _, Sha256};
use sliceflow::gpu::device::Limits;
use sliceflow::output::compare::Comparison;
use sliceflow::output::{Checkpoint, Recorded, measure_files, npy};
use sliceflow::plan::{Plan, Wanted};
use sliceflow::scene::allowance::Allowance;
use sliceflow::scene::mesh::Mesh;
use sliceflow::scene::{Dimensions, Scene, import, library, load, particle_file};

/// An input may take so long, on any machine.
const PATIENCE: Duration = Duration::from_secs(60);
/// Resident memory of the whole test program, bytes.
const MOST_MEMORY: u64 = 2 << 30;

/// Something that reads what others wrote.
struct Entry {
    name: &'static str,
    /// Inputs of the short test.
    count: u32,
    /// Seconds of each round of the long one: most of its inputs are of the entries that read the quickest.
    seconds: u32,
    seeds: fn() -> Vec<Seed>,
    /// Takes a folder and the name of the file in it.
    read: fn(&Path, &str),
}

/// A file that is as it should be, or once was not.
struct Seed {
    name: String,
    bytes: Vec<u8>,
}

const ENTRIES: &[Entry] = &[
    Entry {
        name: "scenes and plans",
        count: 160,
        seconds: 3,
        seeds: scenes,
        read: |folder, name| {
            let text = fs::read_to_string(folder.join(name)).unwrap_or_default();
            let allowance = Allowance {
                particles: 20_000,
                memory: 30_000_000,
                folders: Some(Vec::new()),
            };
            if let Ok(scene) = load::parse_within(&text, name, folder, &[], &allowance) {
                let _ = Plan::new(&scene, &Limits::PROMISED, &Wanted::default());
            }
        },
    },
    Entry {
        name: "import",
        count: 80,
        seconds: 1,
        seeds: || vec![seed("dam.json", PEER.as_bytes())],
        read: |folder, name| {
            let allowance = Allowance {
                particles: 20_000,
                memory: 30_000_000,
                folders: Some(Vec::new()),
            };
            let _ = import::import_within(&folder.join(name), None, &[], &allowance);
        },
    },
    Entry {
        name: "particle files",
        count: 1_500,
        seconds: 8,
        seeds: particles,
        read: |folder, name| {
            let path = folder.join(name);
            for dimensions in [Dimensions::Two, Dimensions::Three] {
                let _ = particle_file::load(&path, dimensions);
            }
            let _ = particle_file::load_attributes(&path);
        },
    },
    Entry {
        name: "meshes",
        count: 800,
        seconds: 12,
        seeds: meshes,
        read: |folder, name| {
            let _ = Mesh::load(&folder.join(name));
        },
    },
    Entry {
        name: "checkpoints",
        count: 600,
        seconds: 2,
        seeds: || vec![seed("checkpoint_000002.bin", &checkpoint())],
        read: |folder, name| {
            let path = folder.join(name);
            let bytes = fs::read(&path).unwrap_or_default();
            // As it is, and with a checksum that is right.
            let content = &bytes[..bytes.len().saturating_sub(32)];
            for bytes in [bytes.clone(), [content, &Sha256::digest(content)].concat()] {
                fs::write(&path, bytes).expect("a file in a temporary folder");
                if let Ok(read) = Checkpoint::read(&path) {
                    let _ = read.state.check(&small_scene());
                }
            }
        },
    },
    Entry {
        name: "run folders",
        count: 200,
        seconds: 1,
        seeds: || {
            vec![
                seed("run.json", manifest().as_bytes()),
                seed("position.npy", &positions()),
                seed("id.npy", &positions()),
            ]
        },
        read: run_folder,
    },
];

fn seed(name: &str, bytes: &[u8]) -> Seed {
    Seed {
        name: name.into(),
        bytes: bytes.to_vec(),
    }
}

/// Files of `tests/attack` with one of these endings.
fn attacks(endings: &[&str]) -> Vec<Seed> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/attack");
    let mut paths: Vec<PathBuf> = fs::read_dir(folder)
        .expect("the cases")
        .map(|entry| entry.expect("a case").path())
        .collect();
    paths.sort();
    let wanted = |path: &&PathBuf| {
        path.extension()
            .is_some_and(|ending| endings.iter().any(|wanted| ending == *wanted))
    };
    let read = |path: &PathBuf| {
        seed(
            &path.file_name().unwrap().to_string_lossy(),
            &fs::read(path).expect("a case"),
        )
    };
    paths.iter().filter(wanted).map(read).collect()
}

fn scenes() -> Vec<Seed> {
    // Those without meshes are quick to load.
    let mut seeds = attacks(&["json"]);
    seeds.retain(|seed| {
        !seed.name.starts_with("scene_of_") && seed.name != "bomb.json" && seed.name != "far_mesh.json"
    });
    for name in ["column_2d", "green_cube", "dam_break_2d", "taylor_couette"] {
        seeds.push(seed(
            &format!("{name}.json"),
            library::find(name).expect("a scene that ships").as_bytes(),
        ));
    }
    seeds
}

fn particles() -> Vec<Seed> {
    let mut seeds = attacks(&["npy", "vtp", "ply"]);
    seeds.push(seed("a.npy", &positions()));
    seeds.push(seed(
        "a.csv",
        b"x,y,z,vx,vy,vz,id\n0,0.5,1,0,0,0,3\n1,-2e-3,1,0,0,0,4\n",
    ));
    seeds.push(seed(
        "text.ply",
        b"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty double y\nproperty list uchar int a\nproperty \
          float z\nend_header\n0 1 2 5 6 0.5\n1 2 0 3\n",
    ));
    let mut binary = b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty \
                       float z\nproperty uint id\nend_header\n"
        .to_vec();
    binary.extend([0u8; 48]);
    seeds.push(seed("binary.ply", &binary));
    let mut bgeo = b"BgeoV".to_vec();
    for number in [5i32, 2, 0, 0, 0, 1, 0, 0, 0] {
        bgeo.extend(number.to_be_bytes());
    }
    bgeo.extend(b"\0\x01v\0\x03\0\0\0\x05");
    bgeo.extend([0u8; 12 + 2 * 28]);
    seeds.push(seed("a.bgeo", &bgeo));
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    std::io::Write::write_all(&mut packed, &bgeo).expect("memory");
    seeds.push(seed("packed.bgeo", &packed.finish().expect("memory")));
    let mut vtp = br#"<VTKFile type="PolyData" byte_order="LittleEndian" header_type="UInt64"><PolyData><Piece NumberOfPoints="2"><PointData><DataArray type="UInt32" Name="id" offset="56"/></PointData><Points><DataArray type="Float64" Name="Points" NumberOfComponents="3" offset="0"/></Points></Piece></PolyData><AppendedData encoding="raw">_"#.to_vec();
    vtp.extend([&48u64.to_le_bytes()[..], &[0; 48], &8u64.to_le_bytes(), &[0; 8]].concat());
    seeds.push(seed("whole.vtp", &vtp));
    seeds
}

fn meshes() -> Vec<Seed> {
    let mut seeds = attacks(&["obj", "ply"]);
    seeds.push(seed(
        "a.ply",
        b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n\
          property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n",
    ));
    seeds.push(seed("text.stl", b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"));
    seeds.push(seed(
        "binary.stl",
        &[[0u8; 80].as_slice(), &2u32.to_le_bytes(), &[1; 100]].concat(),
    ));
    seeds
}

/// A scene of the peer that is imported.
const PEER: &str = r#"{"Configuration":{"particleRadius":0.05,"gravitation":[0,-9.81,0],"stopAt":0.2},
"Materials":[{"id":"Fluid","density0":900,"viscosityMethod":1}],
"FluidBlocks":[{"start":[-0.5,0,-0.5],"end":[0.5,1,0.5],"translation":[-1.45,0.05,0],"scale":[1,1,1],"initialVelocity":[0.5,0,0]}]}"#;

fn small_text() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/attack/small3d.json"))
        .expect("a case")
}

fn small_scene() -> Scene {
    load::parse(&small_text(), "small3d.json", Path::new("."), &[]).expect("a sound scene")
}

/// Positions of five particles in space.
fn positions() -> Vec<u8> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("position.npy");
    npy::write(&path, 3, &[0.25f64; 15]).expect("a file in a temporary folder");
    fs::read(path).expect("what was written")
}

/// The manifest of a run whose sensors can be made anew from its files.
fn manifest() -> String {
    let scene: Value = serde_json::from_str(&small_text()).expect("a case");
    let configuration = serde_json::json!({
        "run_id": "a", "scene_text": small_text(), "scene_file": "small3d.json", "scene_folder": ".",
        "overrides": [r#"sensors=[{"name":"a","kind":"extremes","field":"speed"}]"#], "inputs": [],
        "arguments": ["sliceflow", "run", "small3d.json"], "working_folder": ".", "first_frame": 0
    });
    serde_json::json!({
        "program": "sliceflow", "status": "running", "frames_done": 3, "frames": 3, "wall_s": 1.5, "first_frame": 0,
        "last_frame": 2, "files": [{ "name": "run.json" }], "scene": scene, "configuration": configuration
    })
    .to_string()
}

/// A checkpoint of two particles, as it stands on disk.
fn checkpoint() -> Vec<u8> {
    let floats = |count: usize| vec![0u8; 4 * count];
    let buffers = [
        ("position", floats(8)),
        ("velocity", floats(8)),
        ("id", [0u32, 1].map(u32::to_le_bytes).concat()),
        ("clock", vec![0; 8]),
    ];
    let sizes: Vec<_> = buffers.iter().map(|(name, bytes)| (name, bytes.len())).collect();
    let health: Value = serde_json::json!({ "overflow": 0, "overlap_told": false, "quarantine_told": false, "reallocations": 0 });
    let header = serde_json::json!({
        "about": { "run_id": "a", "version": "1", "adapter": "none", "particle_steps": 5, "health": health },
        "frame": 2, "particles": 2, "dimensions": 3, "origin": [0.0, 0.0, 0.0], "buffers": sizes
    })
    .to_string();
    let mut file = [
        b"sliceflow checkpoint 3\n".as_slice(),
        &(header.len() as u64).to_le_bytes(),
        header.as_bytes(),
    ]
    .concat();
    file.extend(buffers.iter().flat_map(|(_, bytes)| bytes.clone()));
    let checksum = Sha256::digest(&file);
    file.extend_from_slice(&checksum);
    file
}

/// A run's folder of which one file was changed.
fn run_folder(folder: &Path, name: &str) {
    let run = folder.join("run");
    let arrays = run.join("particles_000000");
    fs::create_dir_all(&arrays).expect("a folder in a temporary one");
    for (path, usual) in [
        (run.join("run.json"), manifest().into_bytes()),
        (arrays.join("position.npy"), positions()),
        (run.join("checkpoint_000002.bin"), checkpoint()),
    ] {
        fs::write(path, usual).expect("a file in a temporary folder");
    }
    let place = if name.ends_with(".npy") { &arrays } else { &run };
    fs::copy(folder.join(name), place.join(name)).expect("a file in a temporary folder");
    let _ = Comparison::of(&run, &run);
    let _ = sliceflow::output::surface::Sequence::open(&run);
    if let Ok(recorded) = Recorded::read(&run)
        && let Ok(configuration) = recorded.configuration()
        && let Ok(scene) = configuration.scene(&[])
        && scene.capacity < 100_000
    {
        let _ = measure_files(&run, &scene);
    }
    fs::remove_dir_all(run).expect("what was made");
}

/// Numbers that programs stumble over.
const NUMBERS: &[&str] = &[
    "0",
    "-1",
    "1",
    "2",
    "3",
    "1e-9",
    "1e-300",
    "5e-324",
    "0.1",
    "1e5",
    "1e6",
    "1e9",
    "1e19",
    "1e60",
    "1e308",
    "-1e308",
    "255",
    "256",
    "65536",
    "2147483647",
    "4294967295",
    "9223372036854775807",
    "18446744073709551616",
    "null",
    "\"\"",
    "[]",
    "{}",
    "true",
];

/// Changes a file at one to four places.
fn changed(seeds: &[Seed], random: &mut ChaCha8Rng) -> (String, Vec<u8>) {
    let seed = &seeds[random.random_range(0..seeds.len())];
    let mut bytes = seed.bytes.clone();
    for _ in 0..random.random_range(1..=4) {
        change(&mut bytes, seeds, random);
    }
    (seed.name.clone(), bytes)
}

fn change(bytes: &mut Vec<u8>, seeds: &[Seed], random: &mut ChaCha8Rng) {
    if bytes.is_empty() {
        bytes.push(random.random());
        return;
    }
    let at = random.random_range(0..bytes.len());
    let end = (at + random.random_range(1..=16)).min(bytes.len());
    match random.random_range(0..8) {
        // A number of a text becomes another, which is the change that finds most.
        0..=2 => {
            if let Some((begin, end)) = number_near(bytes, at) {
                let other = NUMBERS[random.random_range(0..NUMBERS.len())];
                bytes.splice(begin..end, other.bytes());
            }
        }
        3 => bytes[at] ^= 1 << random.random_range(0..8),
        4 => bytes[at] = random.random(),
        5 => {
            bytes.drain(at..end);
        }
        6 => {
            let copy = bytes[at..end].to_vec();
            let to = random.random_range(0..=bytes.len());
            bytes.splice(to..to, copy);
        }
        _ => {
            let other = &seeds[random.random_range(0..seeds.len())].bytes;
            let from = random.random_range(0..other.len());
            let until = (from + random.random_range(1..=40)).min(other.len());
            bytes.splice(at..end, other[from..until].iter().copied());
        }
    }
}

/// Where the next number behind a place stands in a text.
fn number_near(bytes: &[u8], at: usize) -> Option<(usize, usize)> {
    let begin = at + bytes[at..].iter().position(u8::is_ascii_digit)?;
    let part = |byte: &u8| byte.is_ascii_digit() || b".eE+-".contains(byte);
    Some((
        begin,
        begin + bytes[begin..].iter().take_while(|byte| part(byte)).count(),
    ))
}

/// Ends the program where an input takes too long, since nothing else could.
struct Watch {
    began: Arc<AtomicU64>,
    clock: Instant,
}

impl Watch {
    fn new() -> Self {
        let (began, clock) = (Arc::new(AtomicU64::new(u64::MAX)), Instant::now());
        let seen = began.clone();
        std::thread::spawn(move || {
            loop {
                std::thread::sleep(Duration::from_millis(500));
                let since = clock.elapsed().as_millis() as u64;
                if since.saturating_sub(seen.load(Ordering::Relaxed)) > PATIENCE.as_millis() as u64 {
                    eprintln!(
                        "an input takes longer than {PATIENCE:?}; it is in the newest folder fuzz-* of {}",
                        std::env::temp_dir().display()
                    );
                    std::process::abort();
                }
            }
        });
        Self { began, clock }
    }

    fn begin(&self) {
        self.began
            .store(self.clock.elapsed().as_millis() as u64, Ordering::Relaxed);
    }

    fn end(&self) {
        self.began.store(u64::MAX, Ordering::Relaxed);
    }
}

/// What reading changed inputs came to.
#[derive(Clone, Copy, Default)]
struct Read {
    inputs: u64,
    spent: Duration,
    longest: Duration,
}

/// Has an entry read changed inputs until `goes_on` says no.
fn fuzz(entry: &Entry, first: u64, watch: &Watch, goes_on: impl Fn(u64) -> bool) -> Read {
    let folder = tempfile::Builder::new()
        .prefix("fuzz-")
        .tempdir()
        .expect("a temporary folder");
    let seeds = (entry.seeds)();
    let mut sum = Read::default();
    while goes_on(sum.inputs) {
        let number = first + sum.inputs;
        let (name, bytes) = match seeds.get(number as usize) {
            // Each as it is, first.
            Some(seed) => (seed.name.clone(), seed.bytes.clone()),
            None => changed(&seeds, &mut ChaCha8Rng::seed_from_u64(number)),
        };
        fs::write(folder.path().join(&name), &bytes).expect("a file in a temporary folder");
        watch.begin();
        let begun = Instant::now();
        let read = catch_unwind(AssertUnwindSafe(|| (entry.read)(folder.path(), &name)));
        watch.end();
        let took = begun.elapsed();
        if read.is_err() {
            let kept = std::env::temp_dir().join(format!("sliceflow-fuzz-{number}-{name}"));
            fs::write(&kept, &bytes).expect("a file in the temporary folder");
            panic!("{}: input {number} panics; it is {}", entry.name, kept.display());
        }
        fs::remove_file(folder.path().join(&name)).expect("the input");
        sum.inputs += 1;
        sum.spent += took;
        sum.longest = sum.longest.max(took);
    }
    sum
}

/// The most that the program has taken so far, bytes, where the system says it.
fn peak_memory() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kibibytes = line.and_then(|line| line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok());
    1024 * kibibytes.unwrap_or_default()
}

#[test]
fn no_entry_stumbles_over_changed_inputs() {
    let watch = Watch::new();
    for entry in ENTRIES {
        fuzz(entry, 0, &watch, |count| count < u64::from(entry.count));
        assert!(
            peak_memory() < MOST_MEMORY,
            "{} took {} bytes",
            entry.name,
            peak_memory()
        );
    }
}

#[test]
#[ignore = "takes an hour"]
fn an_hour_of_changed_inputs() {
    let number = |name: &str| -> Option<u64> { std::env::var(name).ok()?.parse().ok() };
    let seconds = number("SLICEFLOW_FUZZ_SECONDS");
    let end = Instant::now() + Duration::from_secs(seconds.unwrap_or(3600));
    let watch = Watch::new();
    let mut sums = vec![Read::default(); ENTRIES.len()];
    // Other numbers than those of the short test.
    let part = number("SLICEFLOW_FUZZ_FIRST").unwrap_or(1);
    let first = part << 32;
    while Instant::now() < end {
        for (entry, sum) in ENTRIES.iter().zip(&mut sums) {
            let slice = Instant::now() + Duration::from_secs(entry.seconds.into());
            let read = fuzz(entry, first + sum.inputs, &watch, |_| {
                Instant::now() < slice.min(end)
            });
            sum.inputs += read.inputs;
            sum.spent += read.spent;
            sum.longest = sum.longest.max(read.longest);
            assert!(
                peak_memory() < MOST_MEMORY,
                "{} took {} bytes",
                entry.name,
                peak_memory()
            );
        }
    }
    for (entry, sum) in ENTRIES.iter().zip(&sums) {
        println!(
            "{:>12} inputs, {:>9.1} a second, {:>7.3} s at most: {}",
            sum.inputs,
            sum.inputs as f64 / sum.spent.as_secs_f64(),
            sum.longest.as_secs_f64(),
            entry.name
        );
    }
    println!(
        "{:>12} in all, {} MiB at most",
        sums.iter().map(|sum| sum.inputs).sum::<u64>(),
        peak_memory() >> 20
    );
}
