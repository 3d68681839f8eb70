//! From the peer's terms to a scene file.

use glam::{DVec3, EulerRot};
use serde_json::{Value, json};

use super::peer::{Material, Peer, RigidBody, Transform};
use super::{Files, fluid, keys::Ignored};
use crate::error::{Error, Result};
use crate::scene::mesh::Mesh;
use crate::scene::model;

/// Room around everything where no box holds it, in particle radii.
const ROOM: f64 = 20.0;
/// Share of a box's size by which its vertices may miss its corners.
const CORNER: f64 = 1e-6;

pub fn convert(
    peer: &Peer,
    files: &Files,
    ignored: &mut Vec<Ignored>,
    notes: &mut Vec<String>,
) -> Result<Value> {
    let axes = peer.dimensions;
    let mut bodies = Vec::new();
    let mut bounds = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for block in &peer.blocks {
        bounds = (bounds.0.min(block.min), bounds.1.max(block.max));
        bodies.extend(fluid::block(peer, block, ignored));
    }
    for model in &peer.models {
        let (min, max) = fluid::bounds(peer, model, files)?;
        bounds = (bounds.0.min(min), bounds.1.max(max));
        bodies.extend(fluid::model(peer, model, files, ignored)?);
    }
    for emitter in &peer.emitters {
        let reach = DVec3::splat(emitter.radius);
        bounds = (
            bounds.0.min(emitter.center - reach),
            bounds.1.max(emitter.center + reach),
        );
    }
    if !bodies.is_empty() || !peer.emitters.is_empty() {
        notes.push(fluid::note(peer));
    }
    let Obstacles {
        colliders,
        container,
        bounds,
    } = obstacles(peer, files, bounds, ignored)?;
    let domain = match container {
        Some((min, max)) => json!({ "min": coordinates(min, axes), "max": coordinates(max, axes) }),
        None => {
            notes.push(
                "no box holds the fluid, so the domain is open on all sides and larger than what is in it"
                    .into(),
            );
            let room = DVec3::splat(ROOM * peer.radius);
            let (min, max) = (bounds.0 - room, bounds.1 + room);
            json!({ "min": coordinates(min, axes), "max": coordinates(max, axes), "walls": "open" })
        }
    };
    let mut scene = json!({
        "name": "",
        "description": "",
        "source": "",
        "dimensions": axes,
        "domain": domain,
        "gravity": coordinates(peer.gravity, axes),
        "fluid": fluid::substance(peer, ignored),
        "bodies": bodies,
        "colliders": colliders,
    });
    if let Some(duration) = peer.stop_at {
        scene["time"]["duration"] = duration.into();
    }
    if let (Some(step), "dfsph") = (
        peer.time_step.most(),
        scene["fluid"]["solver"].as_str().unwrap_or_default(),
    ) {
        scene["time"]["step"] = step.into();
    }
    let end = peer.stop_at.unwrap_or(model::Time::default().duration);
    let (emitters, events) = fluid::emitters(peer, end, ignored);
    for (key, list) in [("emitters", emitters), ("events", events)] {
        if !list.is_empty() {
            scene[key] = list.into();
        }
    }
    if let Some(fps) = peer.fps {
        scene["time"]["fps"] = fps.into();
    }
    if let Some([eye, target]) = peer.camera {
        scene["render"]["camera"] = json!({ "eye": eye.to_array(), "target": target.to_array() });
    }
    if let Some(material) = peer.material() {
        color(material, &mut scene, ignored);
    }
    Ok(scene)
}

struct Obstacles {
    colliders: Vec<Value>,
    /// Corners of the box that holds all fluid.
    container: Option<(DVec3, DVec3)>,
    /// Of fluid and obstacles.
    bounds: (DVec3, DVec3),
}

fn obstacles(
    peer: &Peer,
    files: &Files,
    fluid: (DVec3, DVec3),
    ignored: &mut Vec<Ignored>,
) -> Result<Obstacles> {
    let mut found = Obstacles {
        colliders: Vec::new(),
        container: None,
        bounds: fluid,
    };
    for body in &peer.bodies {
        let mut ignore = |why: &str| ignored.push(Ignored::physics(&body.path, why));
        let Some(file) = &body.geometry else {
            ignore("it names no geometryFile");
            continue;
        };
        let path = files.find(file);
        let mesh = Mesh::load(&path).map_err(|what| {
            Error::usage(format!("{}: {what}", body.path), "check that mesh, and its path")
        })?;
        let placed = Mesh {
            vertices: mesh.vertices.iter().map(|v| body.transform.apply(*v)).collect(),
            triangles: mesh.triangles,
        };
        let (min, max) = placed.bounds();
        let (is_box, is_closed) = (is_box(&placed), placed.open_edges() == 0);
        let mut axes = 0..peer.dimensions;
        let holds_fluid = axes.all(|axis| fluid.0[axis] >= min[axis] && fluid.1[axis] <= max[axis]);
        let is_container = is_box && (body.is_inverted || holds_fluid);
        match (is_container, &found.container) {
            (true, None) => {
                found.container = Some((min, max));
                continue;
            }
            (true, Some(_)) => {
                ignore("a scene has one box around everything, and another is it");
                continue;
            }
            _ if body.is_inverted => {
                ignore("it is free inside and no box along the axes; Sliceflow's meshes are solid inside");
                continue;
            }
            _ if !is_box && peer.dimensions == 2 => {
                ignore("a mesh that is no box along the axes has no place in a 2D scene");
                continue;
            }
            _ if !is_closed => {
                ignore("its mesh is not closed");
                continue;
            }
            _ => {}
        }
        if body.is_dynamic {
            ignored.push(Ignored::physics(
                format!("{}.isDynamic", body.path),
                "obstacles rest where they start",
            ));
        }
        found.bounds = (found.bounds.0.min(min), found.bounds.1.max(max));
        let shape = if is_box {
            let axes = peer.dimensions;
            json!({ "kind": "box", "min": coordinates(min, axes), "max": coordinates(max, axes) })
        } else {
            json!({
                "kind": "mesh",
                "file": files.name(file)?,
                "placement": placement(&body.transform, peer.dimensions),
            })
        };
        found.colliders.push(collider(body, shape));
    }
    Ok(found)
}

fn collider(body: &RigidBody, shape: Value) -> Value {
    let mut collider = json!({ "shape": shape });
    if let Some(color) = body.color {
        let [r, g, b] = color.map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round() as u8);
        collider["color"] = format!("#{r:02x}{g:02x}{b:02x}").into();
    }
    if body.is_wall {
        // As there: walls are not drawn.
        collider["visible"] = false.into();
    }
    collider
}

/// Whether a mesh is its own bounding box.
fn is_box(mesh: &Mesh) -> bool {
    let (low, high) = mesh.bounds();
    let slack = CORNER * (high - low).max_element();
    let at_corner = |v: &DVec3| (0..3).all(|axis| (v[axis] - low[axis]).min(high[axis] - v[axis]) <= slack);
    let size = high - low;
    let is_filled =
        (mesh.signed_volume().abs() - size.element_product()).abs() <= slack * size.length_squared();
    mesh.vertices.len() == 8 && mesh.vertices.iter().all(at_corner) && is_filled
}

fn color(material: &Material, scene: &mut Value, ignored: &mut Vec<Ignored>) {
    let mut ignore =
        |key: &str, why: &str| ignored.push(Ignored::new(format!("{}.{key}", material.path), why));
    let by = match material.color_field.as_deref() {
        None | Some("velocity") => "speed",
        Some("density") => "density",
        Some("pressure") => "pressure",
        Some(_) => {
            ignore("colorField", "colors show the speed");
            "speed"
        }
    };
    let mut color = json!({ "by": by });
    match material.color_map {
        None | Some(0.0) => {}
        Some(1.0) => color["map"] = "turbo".into(),
        Some(2.0) => color["map"] = "plasma".into(),
        Some(_) => ignore("colorMapType", "the color map is the default"),
    }
    if let [low, Some(high)] = material.range {
        let low = low.unwrap_or(0.0);
        if low < high {
            color["range"] = json!([low, high]);
        }
    }
    scene["render"]["color"] = color;
}

/// As many numbers as the scene has dimensions.
pub fn coordinates(vector: DVec3, axes: usize) -> Value {
    vector.to_array()[..axes].into()
}

/// `placement` of a mesh or particle file.
pub fn placement(transform: &Transform, axes: usize) -> Value {
    // Ours turns about x, then y, then z: Rz Ry Rx.
    let (z, y, x) = transform.turn.to_euler(EulerRot::ZYX);
    let mut placement = json!({
        "rotate": [x.to_degrees(), y.to_degrees(), z.to_degrees()],
        "translate": coordinates(transform.translation, axes),
    });
    let DVec3 { x, y, z } = transform.scale;
    if x == y && y == z {
        placement["scale"] = x.into();
    } else {
        placement["stretch"] = json!([x, y, z]);
    }
    placement
}
