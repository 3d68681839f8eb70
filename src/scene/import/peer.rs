//! A SPlisHSPlasH scene in its own terms (doc/file_format.md of that project), with its defaults.

use glam::{DQuat, DVec3};

use super::keys::Keys;
use crate::error::Problem;

/// Metres, kilograms, seconds.
pub struct Peer {
    pub dimensions: usize,
    /// Half the spacing of particles.
    pub radius: f64,
    pub gravity: DVec3,
    /// Where the run ends, and frames a second.
    pub stop_at: Option<f64>,
    pub fps: Option<f64>,
    pub time_step: TimeStep,
    pub camera: Option<[DVec3; 2]>,
    /// Whether its solver is anything but WCSPH.
    pub is_incompressible: bool,
    /// Whether it is another one that lets densities vary.
    pub is_compressible: bool,
    /// What its loops of density and of divergence stop at, percent.
    pub density_error: Option<f64>,
    pub divergence_error: Option<f64>,
    pub materials: Vec<Material>,
    pub bodies: Vec<RigidBody>,
    pub blocks: Vec<Block>,
    pub models: Vec<Model>,
    pub emitters: Vec<Emitter>,
}

/// Settings of the time step, seconds; each with its path.
#[derive(Default)]
pub struct TimeStep {
    pub size: Option<(String, f64)>,
    /// 0: steps do not follow the flow.
    pub method: Option<(String, f64)>,
    /// In units of 0.4 particle diameters that the fastest one may move.
    pub factor: Option<(String, f64)>,
    pub shortest: Option<(String, f64)>,
    pub longest: Option<(String, f64)>,
}

impl TimeStep {
    pub fn is_fixed(&self) -> bool {
        self.method.as_ref().is_some_and(|(_, method)| *method == 0.0)
    }

    /// Share of a particle's diameter that the fastest one may move in a step.
    pub fn courant_number(&self) -> f64 {
        0.4 * self.factor.as_ref().map_or(0.5, |(_, factor)| *factor)
    }

    /// The longest step, seconds.
    pub fn most(&self) -> Option<f64> {
        let given = if self.is_fixed() {
            &self.size
        } else {
            &self.longest
        };
        given.as_ref().map(|(_, step)| *step).filter(|&step| step > 0.0)
    }
}

impl Peer {
    /// What the first fluid is made of.
    pub fn material(&self) -> Option<&Material> {
        let first = self
            .blocks
            .first()
            .map(|b| &b.material)
            .or(self.models.first().map(|m| &m.material))
            .or(self.emitters.first().map(|e| &e.material))?;
        self.materials.iter().rfind(|material| material.id == *first)
    }
}

pub struct Material {
    pub path: String,
    pub id: String,
    pub density: f64,
    pub viscosity: Viscosity,
    pub color_field: Option<String>,
    pub color_map: Option<f64>,
    pub range: [Option<f64>; 2],
}

/// What the peer's methods make of viscosity.
#[derive(Clone, Copy, PartialEq)]
pub enum Viscosity {
    /// Nothing is said.
    Unknown,
    None,
    /// m²/s.
    Kinematic {
        fluid: f64,
        boundary: f64,
    },
    /// A number that has no unit.
    Without,
}

/// The peer's methods of viscosity by their numbers: 1 and so on. Whether their coefficient is a kinematic viscosity.
const VISCOSITY_METHODS: [(&str, bool); 6] = [
    ("Standard viscosity", true),
    ("Bender and Koschier 2017", false),
    ("Peer et al. 2015", false),
    ("Peer et al. 2016", false),
    ("Takahashi et al. 2015 (improved)", true),
    ("Weiler et al. 2018", true),
];
/// What it takes where a method has no coefficient, m²/s.
const USUAL_VISCOSITY: f64 = 0.01;

/// Scaled, then turned, then moved.
pub struct Transform {
    pub scale: DVec3,
    pub turn: DQuat,
    pub translation: DVec3,
}

impl Transform {
    pub fn apply(&self, point: DVec3) -> DVec3 {
        self.turn * (self.scale * point) + self.translation
    }
}

pub struct RigidBody {
    pub path: String,
    pub geometry: Option<String>,
    pub transform: Transform,
    pub is_dynamic: bool,
    pub is_wall: bool,
    /// Whether the inside is free.
    pub is_inverted: bool,
    pub color: Option<[f64; 3]>,
}

/// An axis-aligned box of fluid.
pub struct Block {
    pub path: String,
    pub material: String,
    pub min: DVec3,
    pub max: DVec3,
    /// 0 is the plain lattice.
    pub dense_mode: f64,
    pub velocity: DVec3,
}

/// Fluid from a file: of particles, or a mesh to fill.
pub struct Model {
    pub path: String,
    pub material: String,
    pub file: String,
    pub transform: Transform,
    pub velocity: DVec3,
}

/// Where fluid comes from.
pub struct Emitter {
    pub path: String,
    pub material: String,
    pub center: DVec3,
    pub velocity: DVec3,
    /// Metres, of a disc as large as the rectangle where it is none.
    pub radius: f64,
    pub is_round: bool,
    /// Seconds.
    pub from: f64,
    pub until: f64,
}

/// What Sliceflow has not, each with what it does instead.
const LACKING: &[(&str, &str)] = &[
    (
        "AnimationFields",
        "nothing prescribes velocities in parts of the domain",
    ),
    ("scriptFile", "scripts do not run"),
];
const LACKING_OF_MATERIALS: &[(&str, &str)] = &[
    ("elasticityMethod", "it is elastic there, and a fluid here"),
    ("surfaceTensionMethod", "this fluid has no surface tension"),
    ("dragMethod", "air does not drag the fluid"),
    ("vorticityMethod", "no vorticity is added to the fluid's own"),
    (
        "emitterReuseParticles",
        "particles that leave stay gone, and emitters make new ones",
    ),
];

pub fn read(keys: &mut Keys) -> Result<Peer, Problem> {
    let mut peer = keys
        .object("Configuration", configuration)?
        .unwrap_or_else(|| Peer {
            dimensions: 3,
            radius: 0.025,
            gravity: DVec3::new(0.0, -9.81, 0.0),
            stop_at: None,
            fps: None,
            time_step: TimeStep::default(),
            camera: None,
            is_incompressible: true,
            is_compressible: false,
            density_error: None,
            divergence_error: None,
            materials: Vec::new(),
            bodies: Vec::new(),
            blocks: Vec::new(),
            models: Vec::new(),
            emitters: Vec::new(),
        });
    let (radius, dimensions) = (peer.radius, peer.dimensions);
    peer.emitters = keys.list("Emitters", |keys| emitter(keys, radius, dimensions))?;
    for (key, why) in LACKING {
        keys.lacking(key, why);
    }
    keys.lacking_all("Joints", "bodies are neither joined nor driven");
    peer.materials.extend(keys.list("Materials", material)?);
    peer.bodies = keys.list("RigidBodies", rigid_body)?;
    peer.blocks = keys.list("FluidBlocks", block)?;
    peer.models = keys.list("FluidModels", model)?;
    Ok(peer)
}

fn configuration(keys: &mut Keys) -> Result<Peer, Problem> {
    let mut with_path = |key: &str| Ok(keys.number(key)?.map(|value| (keys.at(key), value)));
    let time_step = TimeStep {
        size: with_path("timeStepSize")?,
        method: with_path("cflMethod")?,
        factor: with_path("cflFactor")?,
        shortest: with_path("cflMinTimeStepSize")?,
        longest: with_path("cflMaxTimeStepSize")?,
    };
    for (key, why) in LACKING {
        keys.lacking(key, why);
    }
    // 0 is WCSPH; DFSPH is what the peer takes where nothing is said, and all others keep the fluid incompressible too.
    let method = keys.number("simulationMethod")?;
    let errors = |keys: &mut Keys| Ok([keys.number("maxError")?, keys.number("maxErrorV")?]);
    let mut found = None;
    for (key, number) in [("PCISPH", 1.0), ("PBF", 2.0), ("IISPH", 3.0), ("DFSPH", 4.0)] {
        if method.unwrap_or(4.0) == number {
            found = keys.object(key, errors)?;
        }
    }
    let [density_error, divergence_error] = found.unwrap_or_default();
    let camera = (keys.vector("cameraPosition")?, keys.vector("cameraLookat")?);
    // Older scenes have one fluid, whose density stands here.
    let density = keys.number("density0")?;
    Ok(Peer {
        dimensions: if keys.flag("sim2D")? == Some(true) { 2 } else { 3 },
        radius: keys.number("particleRadius")?.unwrap_or(0.025),
        gravity: keys.vector("gravitation")?.unwrap_or(DVec3::new(0.0, -9.81, 0.0)),
        stop_at: keys.number("stopAt")?.filter(|&at| at > 0.0),
        fps: keys.number("dataExportFPS")?,
        time_step,
        is_incompressible: method != Some(0.0),
        // Projective fluids and ICSPH.
        is_compressible: method.is_some_and(|method| method > 4.0),
        density_error,
        divergence_error,
        camera: match camera {
            (Some(eye), target) => Some([eye, target.unwrap_or_default()]),
            (None, _) => None,
        },
        materials: density
            .map(|density| Material {
                path: keys.path.clone(),
                id: "Fluid".into(),
                density,
                viscosity: Viscosity::Unknown,
                color_field: None,
                color_map: None,
                range: [None; 2],
            })
            .into_iter()
            .collect(),
        bodies: Vec::new(),
        blocks: Vec::new(),
        models: Vec::new(),
        emitters: Vec::new(),
    })
}

fn viscosity(keys: &mut Keys) -> Result<Viscosity, Problem> {
    // Older scenes have the coefficients in the material itself.
    let coefficients = |keys: &mut Keys| Ok((keys.number("viscosity")?, keys.number("viscosityBoundary")?));
    let own = coefficients(keys)?;
    let Some(method) = keys.number("viscosityMethod")? else {
        return Ok(Viscosity::Unknown);
    };
    let Some((name, is_kinematic)) = VISCOSITY_METHODS
        .get((method - 1.0) as usize)
        .filter(|_| method >= 1.0)
    else {
        return Ok(if method == 0.0 {
            Viscosity::None
        } else {
            Viscosity::Without
        });
    };
    if !is_kinematic {
        return Ok(Viscosity::Without);
    }
    let (fluid, boundary) = keys.object(name, coefficients)?.unwrap_or(own);
    Ok(Viscosity::Kinematic {
        fluid: fluid.unwrap_or(USUAL_VISCOSITY).max(0.0),
        boundary: boundary.unwrap_or(0.0),
    })
}

fn emitter(keys: &mut Keys, radius: f64, dimensions: usize) -> Result<Emitter, Problem> {
    let is_round = keys.number("type")? == Some(1.0);
    let [width, height] = [
        keys.number("width")?.unwrap_or(5.0),
        keys.number("height")?.unwrap_or(5.0),
    ];
    let transform = transform(keys)?;
    let direction = match dimensions {
        // There, all turns of a flat scene are about z.
        2 => DQuat::from_rotation_z(transform.turn.to_scaled_axis().length()) * DVec3::X,
        _ => transform.turn * DVec3::X,
    };
    Ok(Emitter {
        path: keys.path.clone(),
        material: keys.text("id")?.unwrap_or_else(|| "Fluid".into()),
        center: transform.translation,
        velocity: keys.number("velocity")?.unwrap_or(1.0) * direction,
        // In particles, `width` is a disc's diameter; of a rectangle, a flat scene sees the height.
        radius: radius
            * match (is_round, dimensions) {
                (true, _) => width,
                (false, 2) => height,
                (false, _) => (width * height * 4.0 / std::f64::consts::PI).sqrt(),
            },
        is_round: is_round || dimensions == 2,
        from: keys.number("emitStartTime")?.unwrap_or(0.0),
        until: keys.number("emitEndTime")?.unwrap_or(f64::INFINITY),
    })
}

fn material(keys: &mut Keys) -> Result<Material, Problem> {
    for (key, why) in LACKING_OF_MATERIALS {
        keys.lacking(key, why);
    }
    Ok(Material {
        path: keys.path.clone(),
        id: keys.text("id")?.unwrap_or_else(|| "Fluid".into()),
        density: keys.number("density0")?.unwrap_or(1000.0),
        viscosity: viscosity(keys)?,
        color_field: keys.text("colorField")?,
        color_map: keys.number("colorMapType")?,
        range: [keys.number("renderMinValue")?, keys.number("renderMaxValue")?],
    })
}

fn transform(keys: &mut Keys) -> Result<Transform, Problem> {
    let axis = keys.vector("rotationAxis")?.and_then(DVec3::try_normalize);
    let angle = keys.number("rotationAngle")?;
    Ok(Transform {
        scale: keys.scale("scale")?.unwrap_or(DVec3::ONE),
        turn: match (axis, angle) {
            (Some(axis), Some(angle)) => DQuat::from_axis_angle(axis, angle),
            _ => DQuat::IDENTITY,
        },
        translation: keys.vector("translation")?.unwrap_or_default(),
    })
}

fn rigid_body(keys: &mut Keys) -> Result<RigidBody, Problem> {
    keys.lacking("isAnimated", "obstacles rest where they start");
    Ok(RigidBody {
        path: keys.path.clone(),
        geometry: keys.text("geometryFile")?,
        transform: transform(keys)?,
        is_dynamic: keys.flag("isDynamic")?.unwrap_or(false),
        is_wall: keys.flag("isWall")?.unwrap_or(false),
        is_inverted: keys.flag("mapInvert")?.unwrap_or(false),
        color: keys.color("color")?,
    })
}

fn block(keys: &mut Keys) -> Result<Block, Problem> {
    let scale = keys.scale("scale")?.unwrap_or(DVec3::ONE);
    let translation = keys.vector("translation")?.unwrap_or_default();
    let mut corner = |key: &str| {
        let given = keys.vector(key)?;
        let missing = || {
            Problem::new(
                keys.at(key),
                "is missing",
                "give the block's corners, `start` and `end`",
            )
        };
        Ok(scale * given.ok_or_else(missing)? + translation)
    };
    let (min, max) = (corner("start")?, corner("end")?);
    Ok(Block {
        path: keys.path.clone(),
        material: keys.text("id")?.unwrap_or_else(|| "Fluid".into()),
        min,
        max,
        dense_mode: keys.number("denseMode")?.unwrap_or(0.0),
        velocity: keys.vector("initialVelocity")?.unwrap_or_default(),
    })
}

fn model(keys: &mut Keys) -> Result<Model, Problem> {
    let missing = Problem::new(
        keys.at("particleFile"),
        "is missing",
        "name the file of particles, or a mesh",
    );
    Ok(Model {
        path: keys.path.clone(),
        material: keys.text("id")?.unwrap_or_else(|| "Fluid".into()),
        file: keys.text("particleFile")?.ok_or(missing)?,
        transform: transform(keys)?,
        velocity: keys.vector("initialVelocity")?.unwrap_or_default(),
    })
}
