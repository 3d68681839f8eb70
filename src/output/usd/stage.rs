//! The files themselves: one that is opened, with camera and obstacles, and one per frame.

use std::fmt::Write as _;

use glam::{DVec3, Vec3};

use super::layer::{Layer, MARK, identifier, line, numbers, vectors};
use crate::render::{Layout, Sight, linear, plane_in_box};
use crate::scene::model::View;
use crate::scene::{Collider, ColliderShape, Scene};

/// Of the camera, in the units of its aperture; only their ratio is seen.
const FOCAL_LENGTH: f64 = 50.0;
/// Units of an orthographic camera's aperture per metre.
const APERTURE_UNITS: f64 = 10.0;

/// A prim that changes from frame to frame.
pub struct Moving {
    pub name: &'static str,
    pub frames: Vec<u32>,
    /// Its attributes; with values where it has no clips.
    pub declared: Layer,
    /// Whether values come from files of single frames.
    pub clips: bool,
}

/// A file with one prim, whose values are clips of another's.
pub fn clip(name: &str, layer: &Layer) -> String {
    let mut text =
        format!("{MARK}(\n    defaultPrim = \"{name}\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n");
    line(&mut text, "", format_args!("def {} \"{name}\"\n{{", kind(name)));
    layer.write(&mut text, "    ");
    text + "}\n"
}

pub fn scene(scene: &Scene, last: u32, moving: &[Moving]) -> String {
    let fps = scene.time.fps;
    let mut text = format!(
        "{MARK}(\n    defaultPrim = \"World\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n    startTimeCode = 0\n    \
         endTimeCode = {last}\n    timeCodesPerSecond = {fps}\n    framesPerSecond = {fps}\n)\n\n\
         def Xform \"World\"\n{{\n"
    );
    // Everything else counts from here in single precision.
    let [x, y, z] = scene.origin.to_array();
    line(
        &mut text,
        "    ",
        format_args!("double3 xformOp:translate = ({x}, {y}, {z})"),
    );
    line(
        &mut text,
        "    ",
        format_args!("uniform token[] xformOpOrder = [\"xformOp:translate\"]"),
    );
    camera(&mut text, scene, last);
    if !scene.colliders.is_empty() {
        line(
            &mut text,
            "    ",
            format_args!("\n    def Xform \"obstacles\"\n    {{"),
        );
        for (index, collider) in scene.colliders.iter().enumerate() {
            obstacle(&mut text, scene, collider, index);
        }
        line(&mut text, "    ", format_args!("}}"));
    }
    for prim in moving {
        changing(&mut text, prim);
    }
    text + "}\n"
}

fn kind(name: &str) -> &'static str {
    if name == "surface" { "Mesh" } else { "Points" }
}

fn changing(text: &mut String, prim: &Moving) {
    let name = prim.name;
    line(
        text,
        "\n    ",
        format_args!(
            "def {} \"{name}\"{}",
            kind(name),
            if prim.clips { " (" } else { "" }
        ),
    );
    if prim.clips {
        let paths: Vec<_> = prim
            .frames
            .iter()
            .map(|frame| format!("@./{name}_{frame:06}.usda@"))
            .collect();
        let active: Vec<_> = prim
            .frames
            .iter()
            .enumerate()
            .map(|(index, frame)| format!("({frame}, {index})"))
            .collect();
        let times: Vec<_> = prim
            .frames
            .iter()
            .map(|frame| format!("({frame}, {frame})"))
            .collect();
        line(
            text,
            "        ",
            format_args!("clips = {{\n            dictionary default = {{"),
        );
        let indent = "                ";
        line(
            text,
            indent,
            format_args!("double2[] active = [{}]", active.join(", ")),
        );
        line(
            text,
            indent,
            format_args!("asset[] assetPaths = [{}]", paths.join(", ")),
        );
        line(
            text,
            indent,
            format_args!("asset manifestAssetPath = @./{name}_manifest.usda@"),
        );
        line(text, indent, format_args!("string primPath = \"/{name}\""));
        line(
            text,
            indent,
            format_args!("double2[] times = [{}]", times.join(", ")),
        );
        line(text, "        ", format_args!("    }}\n        }}\n    )"));
    }
    line(text, "    ", format_args!("{{"));
    if name == "surface" {
        line(
            text,
            "        ",
            format_args!("uniform token subdivisionScheme = \"none\""),
        );
    }
    prim.declared.write(text, "        ");
    line(text, "    ", format_args!("}}"));
}

/// The camera of the scene's pictures.
fn camera(text: &mut String, scene: &Scene, last: u32) {
    let layout = Layout::new(scene, View::Scene);
    let place = layout.scene.expect("this view shows the scene");
    let sight = |frame: u32| {
        Sight::new(
            scene,
            [place.width, place.height],
            layout.insets,
            f64::from(frame) / scene.time.fps,
        )
    };
    let still = sight(0);
    let (projection, aperture) = match still.perspective {
        true => ("perspective", still.half * 2.0 * FOCAL_LENGTH),
        false => ("orthographic", still.half * 2.0 * APERTURE_UNITS),
    };
    let offset = still.shift * aperture * -0.5;
    let indent = "        ";
    line(text, "\n    ", format_args!("def Camera \"camera\"\n    {{"));
    line(text, indent, format_args!("token projection = \"{projection}\""));
    line(text, indent, format_args!("float focalLength = {FOCAL_LENGTH}"));
    for (name, size, offset) in [
        ("horizontal", aperture.x, offset.x),
        ("vertical", aperture.y, offset.y),
    ] {
        line(text, indent, format_args!("float {name}Aperture = {size}"));
        line(
            text,
            indent,
            format_args!("float {name}ApertureOffset = {offset}"),
        );
    }
    line(
        text,
        indent,
        format_args!("float2 clippingRange = ({}, {})", still.near, still.far),
    );
    let pose = |sight: &Sight| {
        let row = |v: DVec3, w: f64| format!("({}, {}, {}, {w})", v.x, v.y, v.z);
        let rows = [
            row(sight.right, 0.0),
            row(sight.up, 0.0),
            row(-sight.forward, 0.0),
            row(sight.eye, 1.0),
        ];
        format!("({})", rows.join(", "))
    };
    if !scene.render.camera.moves() {
        line(
            text,
            indent,
            format_args!("matrix4d xformOp:transform = {}", pose(&still)),
        );
    } else {
        line(
            text,
            indent,
            format_args!("matrix4d xformOp:transform.timeSamples = {{"),
        );
        for frame in 0..=last {
            line(
                text,
                indent,
                format_args!("    {frame}: {},", pose(&sight(frame))),
            );
        }
        line(text, indent, format_args!("}}"));
    }
    line(
        text,
        indent,
        format_args!("uniform token[] xformOpOrder = [\"xformOp:transform\"]\n    }}"),
    );
}

fn obstacle(text: &mut String, scene: &Scene, collider: &Collider, index: usize) {
    let (kind, place, size) = match &collider.shape {
        ColliderShape::Box { min, max } => ("Cube", (*min + *max) / 2.0, Some(*max - *min)),
        ColliderShape::Sphere { center, .. } => ("Sphere", *center, None),
        ColliderShape::Plane { .. } | ColliderShape::Cylinder { .. } | ColliderShape::Mesh(_) => {
            ("Mesh", Vec3::ZERO, None)
        }
    };
    // The number tells obstacles of the same or no name apart.
    let name = match collider.name.as_str() {
        "" => format!("obstacle_{index}"),
        name => format!("{}_{index}", identifier(name)),
    };
    let indent = "            ";
    line(
        text,
        "        ",
        format_args!("def {kind} \"{name}\"\n        {{"),
    );
    match &collider.shape {
        ColliderShape::Box { .. } => line(text, indent, format_args!("double size = 1")),
        ColliderShape::Sphere { radius, hollow, .. } => {
            line(text, indent, format_args!("double radius = {radius}"));
            if *hollow {
                line(
                    text,
                    indent,
                    format_args!("uniform token orientation = \"leftHanded\""),
                );
            }
        }
        ColliderShape::Plane { point, normal } => {
            let polygon = plane_in_box(*point, *normal, &scene.domain);
            let corners = 0..polygon.len();
            mesh(
                text,
                indent,
                polygon.iter().map(|v| v.to_array()),
                &[corners.len()],
                corners,
            );
        }
        ColliderShape::Cylinder {
            from,
            to,
            radius,
            hollow,
        } => {
            let (vertices, counts, corners) = cylinder([*from, *to], *radius, *hollow);
            let vertices = vertices.iter().map(|v| v.to_array());
            mesh(text, indent, vertices, &counts, corners.into_iter());
        }
        ColliderShape::Mesh(shape) => {
            let corners = shape.triangles.iter().flatten().map(|&index| index as usize);
            let vertices = shape.vertices.iter().map(|v| v.as_vec3().to_array());
            mesh(text, indent, vertices, &vec![3; shape.triangles.len()], corners);
        }
    }
    let color = collider
        .color
        .map(|channel| linear((channel * 255.0).round() as u8));
    line(
        text,
        indent,
        format_args!("color3f[] primvars:displayColor = {}", vectors([color])),
    );
    if !collider.visible {
        line(text, indent, format_args!("token visibility = \"invisible\""));
    }
    let at = |offset: Vec3| {
        format!(
            "({}, {}, {})",
            place.x + offset.x,
            place.y + offset.y,
            place.z + offset.z
        )
    };
    if collider.path.is_empty() {
        line(
            text,
            indent,
            format_args!("double3 xformOp:translate = {}", at(Vec3::ZERO)),
        );
    } else {
        line(
            text,
            indent,
            format_args!("double3 xformOp:translate.timeSamples = {{"),
        );
        for (time, offset) in &collider.path {
            line(
                text,
                indent,
                format_args!("    {}: {},", time * scene.time.fps, at(*offset)),
            );
        }
        line(text, indent, format_args!("}}"));
    }
    let mut order = String::from("\"xformOp:translate\"");
    if let Some(size) = size {
        line(
            text,
            indent,
            format_args!("float3 xformOp:scale = ({}, {}, {})", size.x, size.y, size.z),
        );
        write!(order, ", \"xformOp:scale\"").expect("text grows as needed");
    }
    line(
        text,
        indent,
        format_args!("uniform token[] xformOpOrder = [{order}]\n        }}"),
    );
}

/// Vertices, corners per face, and corners of a cylinder as a prism. One that is solid outside has no caps and shows its
/// inner side.
fn cylinder([from, to]: [Vec3; 2], radius: f32, hollow: bool) -> (Vec<Vec3>, Vec<usize>, Vec<usize>) {
    const SIDES: usize = 48;
    let axis = (to - from).normalize_or(Vec3::Z);
    let right = axis.any_orthonormal_vector();
    let up = axis.cross(right);
    let around = |k: usize| {
        let (sin, cos) = (k as f32 / SIDES as f32 * std::f32::consts::TAU).sin_cos();
        (right * cos + up * sin) * radius
    };
    let vertices = (0..SIDES)
        .flat_map(|k| [from + around(k), to + around(k)])
        .collect();
    let mut counts = vec![4; SIDES];
    let mut corners = Vec::new();
    for k in 0..SIDES {
        let next = (k + 1) % SIDES;
        let side = [2 * k, 2 * next, 2 * next + 1, 2 * k + 1];
        match hollow {
            true => corners.extend(side.iter().rev()),
            false => corners.extend(side),
        }
    }
    if !hollow {
        counts.extend([SIDES, SIDES]);
        corners.extend((0..SIDES).rev().map(|k| 2 * k));
        corners.extend((0..SIDES).map(|k| 2 * k + 1));
    }
    (vertices, counts, corners)
}

fn mesh(
    text: &mut String,
    indent: &str,
    vertices: impl Iterator<Item = [f32; 3]>,
    counts: &[usize],
    corners: impl Iterator<Item = usize>,
) {
    line(
        text,
        indent,
        format_args!("uniform token subdivisionScheme = \"none\""),
    );
    line(
        text,
        indent,
        format_args!("point3f[] points = {}", vectors(vertices)),
    );
    line(
        text,
        indent,
        format_args!("int[] faceVertexCounts = {}", numbers(counts)),
    );
    line(
        text,
        indent,
        format_args!("int[] faceVertexIndices = {}", numbers(corners)),
    );
}
