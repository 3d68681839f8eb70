//! What other programs call the keys and words of scene files: Blender, Houdini, LAMMPS, SPlisHSPlasH and their like.

pub use super::text::nearest;
use super::text::suggest;

/// A key of another program.
struct Synonym {
    /// In lower case, without `_` and `-`.
    typed: &'static str,
    /// Keys that it may mean, the likeliest first, without the brackets of lists.
    keys: &'static [&'static str],
    /// How the value differs, where it does.
    note: &'static str,
}

const fn key(typed: &'static str, keys: &'static [&'static str]) -> Synonym {
    with_note(typed, keys, "")
}

const fn with_note(typed: &'static str, keys: &'static [&'static str], note: &'static str) -> Synonym {
    Synonym { typed, keys, note }
}

const CENTER: &[&str] = &[
    "bodies.shape.center",
    "bodies.shape.placement.translate",
    "colliders.path.offset",
    "render.camera.eye",
];
const SIZES: &[&str] = &["grains.sizes"];
const MIN: &[&str] = &["domain.min", "bodies.shape.from"];
const MAX: &[&str] = &["domain.max", "bodies.shape.to"];
const TIMES_FPS: &str = "It is in seconds: frames over `time.fps`, or use --frames";
const DIAMETER: &str = "It is the distance of particles, twice their radius";
const BY_DENSITY: &str = "A particle's mass follows from its size and the density";
const DYNAMIC: &str = "It is the dynamic one: the kinematic one times the density";
const VERTICAL: &str = "It is the vertical angle, in degrees";

const KEYS: &[Synonym] = &[
    // Places and shapes.
    key("position", CENTER),
    key("pos", CENTER),
    key("location", CENTER),
    key("origin", CENTER),
    key("centre", &["bodies.shape.center"]),
    key(
        "translation",
        &["bodies.shape.placement.translate", "colliders.path.offset"],
    ),
    key("move", &["bodies.shape.placement.translate"]),
    key("rotation", &["bodies.shape.placement.rotate", "colliders.spin"]),
    key("orientation", &["bodies.shape.placement.rotate"]),
    key("size", &["render.size", "bodies.shape.placement.scale"]),
    key("start", MIN),
    key("begin", MIN),
    key("lower", MIN),
    key("low", MIN),
    key("boxmin", MIN),
    key("end", MAX),
    key("upper", MAX),
    key("high", MAX),
    key("boxmax", MAX),
    key("r", &["bodies.shape.radius", "grains.radius"]),
    with_note(
        "diameter",
        &["bodies.shape.radius", "grains.radius", "fluid.spacing"],
        "A radius is half of it",
    ),
    key("sizedistribution", SIZES),
    key("psd", SIZES),
    key("polydispersity", SIZES),
    key("gradation", SIZES),
    key("radii", SIZES),
    key("type", &["bodies.shape.kind"]),
    key("primitive", &["bodies.shape"]),
    key("geometry", &["bodies.shape"]),
    key("filename", &["bodies.shape.file"]),
    key("path", &["bodies.shape.file"]),
    key("mesh", &["bodies.shape.file"]),
    key("geometryfile", &["bodies.shape.file"]),
    key("particlefile", &["bodies.shape.file"]),
    key("transform", &["bodies.shape.placement"]),
    // The whole scene.
    key("box", &["domain"]),
    key("bounds", &["domain"]),
    key("boundingbox", &["domain"]),
    key("container", &["domain"]),
    key("region", &["domain"]),
    key("simulationbox", &["domain"]),
    key("tank", &["domain"]),
    key("world", &["domain"]),
    key("boundary", &["domain.walls", "fluid.slip"]),
    key("boundarycondition", &["domain.walls", "fluid.slip"]),
    key("g", &["gravity"]),
    key("gravitation", &["gravity"]),
    key("dim", &["dimensions"]),
    key("ndim", &["dimensions"]),
    with_note("sim2d", &["dimensions"], "It is 2 or 3"),
    key("randomseed", &["seed"]),
    key("title", &["name"]),
    key("comment", &["description"]),
    key("notes", &["description"]),
    key("objects", &["bodies"]),
    key("blocks", &["bodies"]),
    key("fluidblocks", &["bodies"]),
    key("fluidmodels", &["bodies"]),
    key("obstacles", &["colliders"]),
    key("rigidbodies", &["colliders"]),
    key("boundaries", &["colliders"]),
    key("inlets", &["emitters"]),
    key("inflows", &["emitters"]),
    key("sources", &["emitters"]),
    key("actions", &["events"]),
    key("keyframes", &["colliders.path", "events"]),
    key("granular", &["grains"]),
    key("sand", &["grains"]),
    key("dem", &["grains"]),
    key("particles", &["grains", "fluid"]),
    key("liquid", &["fluid"]),
    key("water", &["fluid"]),
    key("sph", &["fluid"]),
    key("grid", &["neighbors"]),
    key("neighbours", &["neighbors"]),
    key("neighborsearch", &["neighbors"]),
    // Motion.
    key("initialvelocity", &["bodies.velocity"]),
    key("vel", &["bodies.velocity"]),
    key("v", &["bodies.velocity"]),
    key("speed", &["bodies.velocity"]),
    key("direction", &["emitters.velocity"]),
    key("animation", &["colliders.path"]),
    key("motion", &["colliders.path"]),
    key("trajectory", &["colliders.path"]),
    key("angularvelocity", &["colliders.spin"]),
    key("omega", &["colliders.spin"]),
    key("t", &["events.at"]),
    key("time", &["events.at"]),
    key("when", &["events.at"]),
    key("hidden", &["colliders.visible"]),
    key("enabled", &["emitters.on"]),
    // Time.
    key("dt", &["time.step"]),
    key("timestep", &["time.step"]),
    key("timestepsize", &["time.step"]),
    key("deltat", &["time.step"]),
    key("stepsize", &["time.step"]),
    key("stopat", &["time.duration"]),
    key("stoptime", &["time.duration"]),
    key("endtime", &["time.duration"]),
    key("tend", &["time.duration"]),
    key("tmax", &["time.duration"]),
    key("totaltime", &["time.duration"]),
    key("length", &["time.duration"]),
    with_note("frames", &["time.duration"], TIMES_FPS),
    with_note("frameend", &["time.duration"], TIMES_FPS),
    with_note("numframes", &["time.duration"], TIMES_FPS),
    key("framerate", &["time.fps"]),
    key("framespersecond", &["time.fps"]),
    key("dataexportfps", &["time.fps"]),
    key("cfl", &["time.adaptive"]),
    key("cflmethod", &["time.adaptive"]),
    key("adaptivetimestep", &["time.adaptive"]),
    // Fluids.
    with_note("particleradius", &["fluid.spacing", "grains.radius"], DIAMETER),
    key("particlespacing", &["fluid.spacing"]),
    key("particleseparation", &["fluid.spacing"]),
    key("dx", &["fluid.spacing"]),
    key("resolution", &["render.size", "fluid.spacing"]),
    key("density0", &["fluid.density"]),
    key("restdensity", &["fluid.density"]),
    key("rho", &["fluid.density"]),
    key("rho0", &["fluid.density"]),
    with_note("mass", &["fluid.density"], BY_DENSITY),
    key("mu", &["fluid.viscosity", "grains.friction"]),
    key("dynamicviscosity", &["fluid.viscosity"]),
    with_note("nu", &["fluid.viscosity"], DYNAMIC),
    with_note("kinematicviscosity", &["fluid.viscosity"], DYNAMIC),
    key("alpha", &["fluid.artificial_viscosity"]),
    key("c0", &["fluid.sound_speed"]),
    key("cs", &["fluid.sound_speed"]),
    key("speedofsound", &["fluid.sound_speed"]),
    key("vmax", &["fluid.max_speed"]),
    key("umax", &["fluid.max_speed"]),
    key("maxvelocity", &["fluid.max_speed"]),
    key("exponent", &["fluid.gamma"]),
    with_note(
        "supportradius",
        &["fluid.support"],
        "It is a multiple of the spacing, and where the kernel becomes zero",
    ),
    with_note(
        "smoothinglength",
        &["fluid.support"],
        "It is a multiple of the spacing, and where the kernel becomes zero: usually twice the smoothing length",
    ),
    with_note(
        "h",
        &["fluid.support"],
        "It is a multiple of the spacing, and where the kernel becomes zero",
    ),
    key("surfacetensioncoefficient", &["fluid.surface_tension"]),
    key("sigma", &["fluid.surface_tension"]),
    key("wettingangle", &["fluid.contact_angle"]),
    key("delta", &["fluid.density_diffusion"]),
    key("method", &["fluid.solver", "neighbors.addressing"]),
    key("simulationmethod", &["fluid.solver"]),
    key("phases", &["fluid.materials"]),
    // Grains.
    key("stiffness", &["grains.spring"]),
    key("springconstant", &["grains.spring"]),
    key("kn", &["grains.spring"]),
    key("kt", &["grains.tangential_stiffness"]),
    key("collisiontime", &["grains.contact_time"]),
    key("youngsmodulus", &["grains.young_modulus"]),
    key("elasticmodulus", &["grains.young_modulus"]),
    key("poissonsratio", &["grains.poisson_ratio"]),
    key("poisson", &["grains.poisson_ratio"]),
    key("xmu", &["grains.friction"]),
    key("slidingfriction", &["grains.friction"]),
    key("staticfriction", &["grains.friction"]),
    key("frictioncoefficient", &["grains.friction"]),
    key("coefficientfriction", &["grains.friction"]),
    key("coefficientrestitution", &["grains.restitution"]),
    key("coefficientrollingfriction", &["grains.rolling_friction"]),
    key("rollingresistance", &["grains.rolling_friction"]),
    key("muroll", &["grains.rolling_friction"]),
    key("contactmodel", &["grains.law"]),
    key("pairstyle", &["grains.law"]),
    key("eta", &["grains.damping"]),
    key("gamman", &["grains.damping"]),
    key("bounce", &["grains.restitution", "domain.restitution"]),
    key("coefficientofrestitution", &["grains.restitution"]),
    key("friction", &["grains.friction", "fluid.wall_friction"]),
    key("gammat", &["grains.shear"]),
    key("cohesion", &["grains.attraction"]),
    key("adhesion", &["grains.attraction"]),
    key("drag", &["grains.global_damping"]),
    // Neighbors.
    key("cellsize", &["neighbors.cell"]),
    key("neighborskin", &["neighbors.skin"]),
    // Pictures.
    key("camera", &["render.camera"]),
    key("view", &["render.view", "render.camera"]),
    key("lookat", &["render.camera.target"]),
    key("lookto", &["render.camera.target"]),
    key("cameralookat", &["render.camera.target"]),
    key("to", &["render.camera.target"]),
    key("aim", &["render.camera.target"]),
    key("focus", &["render.camera.target"]),
    key("cameraposition", &["render.camera.eye"]),
    key("from", &["render.camera.eye"]),
    with_note("fov", &["render.camera.field_of_view"], VERTICAL),
    with_note("angle", &["render.camera.field_of_view"], VERTICAL),
    with_note("angleofview", &["render.camera.field_of_view"], VERTICAL),
    with_note("lens", &["render.camera.field_of_view"], VERTICAL),
    with_note("focallength", &["render.camera.field_of_view"], VERTICAL),
    key("orthoscale", &["render.camera.height"]),
    key("zoom", &["render.camera.height"]),
    key("colour", &["render.color"]),
    key("colorfield", &["render.color.by"]),
    key("attribute", &["render.color.by"]),
    key("column", &["render.color.by"]),
    key("field", &["render.color.by"]),
    key("variable", &["render.color.by"]),
    key("colormap", &["render.color.map"]),
    key("colormaptype", &["render.color.map"]),
    key("palette", &["render.color.map"]),
    key("ramp", &["render.color.map"]),
    key("limits", &["render.color.range"]),
    key("colorbar", &["render.color.legend"]),
    key("width", &["render.size"]),
    key("height", &["render.size"]),
    key("imagesize", &["render.size"]),
    key("samples", &["render.antialias"]),
    key("aa", &["render.antialias"]),
    key("supersampling", &["render.antialias"]),
    key("pointsize", &["render.splat_scale"]),
    key("particlesize", &["render.splat_scale"]),
    key("marker", &["render.splat"]),
    key("style", &["render.look"]),
    key("shading", &["render.look"]),
    key("sun", &["render.light"]),
    key("ground", &["render.show.floor"]),
];

/// Words of other programs, in lower case without `_` and `-`, and ours.
const WORDS: &[(&str, &[&str])] = &[
    ("aabb", &["box"]),
    ("block", &["box"]),
    ("cube", &["box"]),
    ("cuboid", &["box"]),
    ("rectangle", &["box"]),
    ("square", &["box", "lattice"]),
    ("ball", &["sphere"]),
    ("circle", &["sphere"]),
    ("disk", &["disc", "sphere"]),
    ("disc", &["sphere"]),
    ("icosphere", &["sphere"]),
    ("uvsphere", &["sphere"]),
    ("particle", &["sphere", "particles"]),
    ("pipe", &["cylinder"]),
    ("rod", &["cylinder"]),
    ("tube", &["cylinder"]),
    ("annulus", &["ring"]),
    ("geometry", &["mesh"]),
    ("model", &["mesh"]),
    ("obj", &["mesh"]),
    ("stl", &["mesh"]),
    ("file", &["mesh", "particles"]),
    ("points", &["particles"]),
    ("pointcloud", &["particles"]),
    ("floor", &["plane"]),
    ("ground", &["plane"]),
    ("halfspace", &["plane"]),
    ("wall", &["plane", "contact"]),
    ("solid", &["contact"]),
    ("bounce", &["clamp"]),
    ("reflect", &["clamp"]),
    ("akinci", &["particles"]),
    ("adami", &["particles"]),
    ("none", &["open"]),
    ("outflow", &["open"]),
    ("outlet", &["open"]),
    ("cyclic", &["periodic"]),
    ("free", &["free_slip"]),
    ("stick", &["no_slip"]),
    ("grid", &["lattice", "uniform"]),
    ("cubic", &["lattice", "cubic_spline"]),
    ("regular", &["lattice"]),
    ("jittered", &["lattice"]),
    ("poisson", &["random"]),
    ("poissondisk", &["random"]),
    ("wendland", &["wendland_c2"]),
    ("quintic", &["quintic_spline"]),
    ("poly6", &["muller"]),
    ("spiky", &["muller"]),
    ("dfsph", &["wcsph"]),
    ("iisph", &["wcsph"]),
    ("pcisph", &["wcsph"]),
    ("pbf", &["wcsph"]),
    ("pbd", &["wcsph"]),
    ("euler", &["symplectic_euler"]),
    ("semiimpliciteuler", &["symplectic_euler"]),
    ("leapfrog", &["velocity_verlet"]),
    ("verlet", &["velocity_verlet"]),
    ("ortho", &["orthographic"]),
    ("parallel", &["orthographic"]),
    ("cells", &["uniform"]),
    ("linkedcells", &["uniform"]),
    ("zorder", &["morton"]),
    ("zsort", &["morton"]),
    ("hashgrid", &["hash"]),
    ("spatialhash", &["hash"]),
    ("atomics", &["pool", "counting"]),
    ("indexpool", &["pool"]),
    ("countingsort", &["counting"]),
    ("radixsort", &["radix"]),
    ("bitonicsort", &["bitonic"]),
    ("point", &["disc"]),
    ("points2d", &["disc"]),
    ("grey", &["studio"]),
    ("gray", &["studio"]),
    ("velocity", &["speed"]),
    ("vel", &["velocity", "speed"]),
    ("v", &["velocity", "speed"]),
    ("pos", &["position"]),
    ("velocitymagnitude", &["speed"]),
    ("height", &["y"]),
    ("rho", &["density"]),
    ("p", &["pressure"]),
    ("neighbors", &["contacts"]),
    ("omega", &["angular_velocity"]),
    ("hookehistory", &["linear"]),
    ("hooke", &["linear"]),
    ("hertzian", &["hertz"]),
    ("hertzmindlin", &["hertz"]),
    ("mindlin", &["hertz"]),
    ("hertzhistory", &["hertz"]),
    ("epsd", &["spring"]),
    ("cdt", &["constant_torque"]),
    ("particleid", &["id"]),
    ("vx", &["velocity_x"]),
    ("vy", &["velocity_y"]),
    ("vz", &["velocity_z"]),
    ("phase", &["material"]),
    ("jet", &["turbo"]),
    ("rainbow", &["turbo"]),
];

/// What a user most likely meant by an unknown key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Meant<'a> {
    /// A key of the same object.
    Here(&'a str),
    /// A key somewhere else, with its path.
    There(String),
}

impl Meant<'_> {
    /// The question to ask, with how the value differs where it does.
    pub fn question(&self, typed: &str) -> String {
        let (name, place) = match self {
            Self::Here(name) => (*name, ""),
            Self::There(path) if path.contains('.') => (path.as_str(), ""),
            Self::There(path) => (path.as_str(), ", which stands outside of this object"),
        };
        let row = synonym(typed).filter(|row| row.keys.iter().any(|key| last_part(key) == last_part(name)));
        let note = row.map_or("", |row| row.note);
        format!("did you mean `{name}`{place}? {note}")
            .trim_end()
            .to_owned()
    }
}

/// What `typed`, an unknown key of an object, most likely means. `known` are the object's keys; `all` are the paths of
/// all keys of scenes, without brackets, among which a key of another object is looked for where `elsewhere` is set.
pub fn meant<'a>(
    typed: &str,
    known: impl IntoIterator<Item = &'a str> + Clone,
    all: &[String],
    elsewhere: bool,
) -> Option<Meant<'a>> {
    let spelled = plain(typed);
    // `soundSpeed` is `sound_speed`.
    if let Some(same) = known.clone().into_iter().find(|key| plain(key) == spelled) {
        return Some(Meant::Here(same));
    }
    let row = synonym(typed);
    for key in row.into_iter().flat_map(|row| row.keys) {
        if let Some(here) = known.clone().into_iter().find(|known| *known == last_part(key)) {
            return Some(Meant::Here(here));
        }
    }
    if elsewhere {
        let exact = all
            .iter()
            .find(|path| plain(last_part(path)) == spelled && !in_list(path));
        let path = exact.map(String::as_str);
        if let Some(path) = path.or_else(|| row.and_then(|row| row.keys.first().copied())) {
            return Some(Meant::There(path.to_owned()));
        }
    }
    nearest(typed, known).map(Meant::Here)
}

/// The word among `known` that `typed` most likely means.
pub fn meant_word<'a>(typed: &str, known: impl IntoIterator<Item = &'a str> + Clone) -> Option<&'a str> {
    let spelled = plain(typed);
    let find = |word: &str| known.clone().into_iter().find(|known| *known == word);
    let same = known.clone().into_iter().find(|known| plain(known) == spelled);
    let row = WORDS.iter().find(|(word, _)| *word == spelled);
    same.or_else(|| row.and_then(|(_, ours)| ours.iter().find_map(|word| find(word))))
        .or_else(|| nearest(typed, known))
}

/// "did you mean `speed`?", or the list of what there is.
pub fn suggest_word<'a>(typed: &str, known: impl IntoIterator<Item = &'a str> + Clone) -> String {
    match meant_word(typed, known.clone()) {
        Some(word) => format!("did you mean `{word}`?"),
        None => suggest(typed, known),
    }
}

/// Paths of the keys that a key of another program may mean, without brackets.
pub fn keys_for(typed: &str) -> &'static [&'static str] {
    synonym(typed).map_or(&[], |row| row.keys)
}

/// Words of scenes that a word of another program may mean.
pub fn words_for(typed: &str) -> &'static [&'static str] {
    let spelled = plain(typed);
    let row = WORDS.iter().find(|(word, _)| *word == spelled);
    row.map_or(&[], |(_, ours)| ours)
}

fn synonym(typed: &str) -> Option<&'static Synonym> {
    let spelled = plain(typed);
    KEYS.iter().find(|row| row.typed == spelled)
}

/// In lower case, letters and digits alone.
fn plain(word: &str) -> String {
    word.chars()
        .filter(|c| c.is_alphanumeric())
        .flat_map(char::to_lowercase)
        .collect()
}

fn last_part(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}

/// Whether a key belongs to the elements of a list, so that its path alone does not say where.
fn in_list(path: &str) -> bool {
    [
        "bodies.",
        "colliders.",
        "emitters.",
        "events.",
        "fluid.materials.",
    ]
    .iter()
    .any(|list| path.starts_with(list))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::color_maps::COLOR_MAPS;
    use crate::scene::column::{COLUMNS, VECTORS};
    use crate::scene::keys;
    use crate::scene::load::schema;

    #[test]
    fn every_key_that_is_suggested_exists() {
        let paths: Vec<_> = keys::all(&schema()).iter().map(|key| key.plain_path()).collect();
        for row in KEYS {
            assert_eq!(row.typed, plain(row.typed));
            for key in row.keys {
                assert!(paths.iter().any(|path| path == key), "{}: {key}", row.typed);
            }
            let twice = KEYS.iter().filter(|other| other.typed == row.typed).count();
            assert_eq!(twice, 1, "{}", row.typed);
        }
    }

    #[test]
    fn every_word_that_is_suggested_exists() {
        let keys = keys::all(&schema());
        let mut words: Vec<&str> = keys
            .iter()
            .flat_map(|key| key.choices.iter().map(|(word, _)| word.as_str()))
            .collect();
        words.extend(COLUMNS.iter().chain(VECTORS.iter()).map(|column| column.name));
        words.extend(COLOR_MAPS.iter().map(|map| map.name));
        for (typed, ours) in WORDS {
            assert_eq!(*typed, plain(typed));
            for word in *ours {
                assert!(words.contains(word), "{typed}: {word}");
            }
            assert_eq!(
                WORDS.iter().filter(|(other, _)| other == typed).count(),
                1,
                "{typed}"
            );
        }
    }

    #[test]
    fn other_programs_words_are_understood() {
        let all: Vec<_> = keys::all(&schema()).iter().map(|key| key.plain_path()).collect();
        let sphere = ["kind", "center", "radius"];
        let camera = [
            "projection",
            "axis",
            "eye",
            "target",
            "field_of_view",
            "height",
            "orbit",
        ];
        let top = ["domain", "gravity", "fluid", "time", "render"];
        for (typed, known, expected) in [
            ("position", &sphere[..], Meant::Here("center")),
            ("position", &camera, Meant::Here("eye")),
            ("lookAt", &camera, Meant::Here("target")),
            ("look_at", &camera, Meant::Here("target")),
            ("fov", &camera, Meant::Here("field_of_view")),
            ("fieldOfView", &camera, Meant::Here("field_of_view")),
            ("fps", &top, Meant::There("time.fps".into())),
            ("dt", &top, Meant::There("time.step".into())),
            ("size", &top, Meant::There("render.size".into())),
            ("gravty", &top, Meant::Here("gravity")),
        ] {
            assert_eq!(
                meant(typed, known.iter().copied(), &all, true),
                Some(expected),
                "{typed}"
            );
        }
        let domain = meant("gravity", ["min", "max"], &all, true)
            .unwrap()
            .question("gravity");
        assert_eq!(
            domain,
            "did you mean `gravity`, which stands outside of this object?"
        );
        let time = ["duration", "fps", "step"];
        let frames = meant("frames", time, &all, true).unwrap().question("frames");
        assert!(
            frames.starts_with("did you mean `duration`?") && frames.contains("--frames"),
            "{frames}"
        );
        assert_eq!(meant_word("cube", ["box", "sphere"]), Some("box"));
        assert_eq!(meant_word("Sphere", ["box", "sphere"]), Some("sphere"));
        assert_eq!(meant_word("shpere", ["box", "sphere"]), Some("sphere"));
    }
}
