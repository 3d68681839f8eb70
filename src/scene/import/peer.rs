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
    /// Path and value of each setting of the time step.
    pub time_step: Vec<(String, f64)>,
    pub camera: Option<[DVec3; 2]>,
    /// Whether its solver keeps densities constant, by loops.
    pub is_incompressible: bool,
    /// What its loops of density and of divergence stop at, percent.
    pub density_error: Option<f64>,
    pub divergence_error: Option<f64>,
    pub materials: Vec<Material>,
    pub bodies: Vec<RigidBody>,
    pub blocks: Vec<Block>,
    pub models: Vec<Model>,
}

impl Peer {
    /// What the first fluid is made of.
    pub fn material(&self) -> Option<&Material> {
        let first = self
            .blocks
            .first()
            .map(|b| &b.material)
            .or(self.models.first().map(|m| &m.material))?;
        self.materials.iter().rfind(|material| material.id == *first)
    }
}

pub struct Material {
    pub path: String,
    pub id: String,
    pub density: f64,
    pub color_field: Option<String>,
    pub color_map: Option<f64>,
    pub range: [Option<f64>; 2],
}

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

pub fn read(keys: &mut Keys) -> Result<Peer, Problem> {
    let mut peer = keys
        .object("Configuration", configuration)?
        .unwrap_or_else(|| Peer {
            dimensions: 3,
            radius: 0.025,
            gravity: DVec3::new(0.0, -9.81, 0.0),
            stop_at: None,
            fps: None,
            time_step: Vec::new(),
            camera: None,
            is_incompressible: true,
            density_error: None,
            divergence_error: None,
            materials: Vec::new(),
            bodies: Vec::new(),
            blocks: Vec::new(),
            models: Vec::new(),
        });
    peer.materials.extend(keys.list("Materials", material)?);
    peer.bodies = keys.list("RigidBodies", rigid_body)?;
    peer.blocks = keys.list("FluidBlocks", block)?;
    peer.models = keys.list("FluidModels", model)?;
    Ok(peer)
}

fn configuration(keys: &mut Keys) -> Result<Peer, Problem> {
    let mut time_step = Vec::new();
    for key in [
        "timeStepSize",
        "cflMethod",
        "cflFactor",
        "cflMinTimeStepSize",
        "cflMaxTimeStepSize",
    ] {
        time_step.extend(keys.number(key)?.map(|value| (keys.at(key), value)));
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
                color_field: None,
                color_map: None,
                range: [None; 2],
            })
            .into_iter()
            .collect(),
        bodies: Vec::new(),
        blocks: Vec::new(),
        models: Vec::new(),
    })
}

fn material(keys: &mut Keys) -> Result<Material, Problem> {
    Ok(Material {
        path: keys.path.clone(),
        id: keys.text("id")?.unwrap_or_else(|| "Fluid".into()),
        density: keys.number("density0")?.unwrap_or(1000.0),
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
