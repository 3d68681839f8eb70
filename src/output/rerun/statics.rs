//! What does not change during a run: axes, domain, obstacles, names and documents.

use std::fmt::Write as _;

use ::rerun::archetypes::ViewCoordinates;
use ::rerun::components::{Color, FillMode};
use ::rerun::{
    AnnotationContext, AnnotationInfo, Boxes3D, Ellipsoids3D, EntityPath, EntityPathPart, Mesh3D,
    RecordingStream, RecordingStreamResult, Rgba32, TextDocument,
};
use glam::{DVec3, Vec3};

use crate::output::text::{bytes, count};
use crate::plan::Plan;
use crate::render::{POOL_COLORS, collider_vertices};
use crate::scene::model::Storage;
use crate::scene::{Collider, ColliderShape, Dimensions, Scene};

/// The domain in red lines, as in Harada 2007, Figure 2.
const DOMAIN: u32 = 0xd0_30_30_ff;

/// Logs everything static but the blueprint. `about` says what the recording holds.
pub fn log(
    stream: &RecordingStream,
    scene: &Scene,
    plan: &Plan,
    origin: DVec3,
    about: &str,
) -> RecordingStreamResult<()> {
    stream.log_static("scene", &ViewCoordinates::RIGHT_HAND_Y_UP())?;
    let global = |point: Vec3| (point.as_dvec3() + origin).as_vec3();
    let (low, high) = (global(scene.domain.min), global(scene.domain.max));
    stream.log_static(
        "scene/domain",
        &solid_box(low, high)
            .with_colors([DOMAIN])
            .with_fill_mode(FillMode::MajorWireframe),
    )?;
    for (number, collider) in scene.colliders.iter().enumerate().filter(|(_, c)| c.visible) {
        log_collider(stream, scene, number, collider, origin)?;
    }
    stream.log_static("index_pool", &pool_classes(scene))?;
    stream.log_static("documents/about", &TextDocument::from_markdown(about))?;
    let text = serde_json::to_string_pretty(&scene.file).unwrap_or_default();
    stream.log_static(
        "documents/scene",
        &TextDocument::from_markdown(format!("```json\n{text}\n```\n")),
    )?;
    stream.log_static("documents/plan", &TextDocument::from_markdown(plan_text(plan)))
}

/// Corners to Rerun's center and half size.
pub fn solid_box(low: Vec3, high: Vec3) -> Boxes3D {
    let (center, half) = ((low + high) * 0.5, (high - low) * 0.5);
    Boxes3D::from_centers_and_half_sizes([center.to_array()], [half.to_array()])
}

/// Entity of a collider: by its name, or by its place in the scene file.
pub fn collider_path(scene: &Scene, number: usize) -> EntityPath {
    let name = &scene.colliders[number].name;
    let same = |other: &&Collider| other.name == *name;
    let unique = !name.is_empty() && scene.colliders.iter().filter(same).count() == 1;
    let part = if unique { name.clone() } else { number.to_string() };
    EntityPath::from(vec![
        EntityPathPart::new("scene"),
        EntityPathPart::new("colliders"),
        EntityPathPart::new(part),
    ])
}

fn log_collider(
    stream: &RecordingStream,
    scene: &Scene,
    number: usize,
    collider: &Collider,
    origin: DVec3,
) -> RecordingStreamResult<()> {
    let path = collider_path(scene, number);
    let [r, g, b] = collider.color.map(|share| (share * 255.0).round() as u8);
    let color = Color::from_rgb(r, g, b);
    let global = |point: Vec3| (point.as_dvec3() + origin).as_vec3();
    match &collider.shape {
        ColliderShape::Box { min, max } if scene.dimensions == Dimensions::Three => stream.log_static(
            path,
            &solid_box(global(*min), global(*max))
                .with_colors([color])
                .with_fill_mode(FillMode::Solid),
        ),
        ColliderShape::Sphere { center, radius, .. } if scene.dimensions == Dimensions::Three => stream
            .log_static(
                path,
                &Ellipsoids3D::from_centers_and_radii([global(*center).to_array()], [*radius])
                    .with_colors([color])
                    .with_fill_mode(FillMode::Solid),
            ),
        _ => {
            let mine = |vertex: &&[[f32; 4]]| vertex[0][3] == number as f32;
            let vertices = collider_vertices(scene);
            let corners = vertices.chunks_exact(2).filter(mine);
            let (positions, normals): (Vec<_>, Vec<_>) = corners
                .map(|pair| {
                    let [[x, y, z, _], [u, v, w, _]] = [pair[0], pair[1]];
                    (global(Vec3::new(x, y, z)).to_array(), [u, v, w])
                })
                .unzip();
            let mesh = Mesh3D::new(positions).with_vertex_normals(normals);
            stream.log_static(path, &mesh.with_albedo_factor(Rgba32::from_rgb(r, g, b)))
        }
    }
}

/// Class of a voxel's map texel: its count up to four, and this one for more than a pool has slots for.
pub const OVER_SLOTS: u8 = 5;
/// Class of a texel that stands for no voxel.
pub const NO_VOXEL: u8 = 6;

/// Colors and names of the map's classes; the same colors as in pictures of the pool.
fn pool_classes(scene: &Scene) -> AnnotationContext {
    let slots = scene.neighbors.slots;
    let names = [
        "empty".to_owned(),
        "1 particle".to_owned(),
        "2 particles".to_owned(),
        "3 particles".to_owned(),
        if scene.neighbors.storage == Storage::Pool && slots == 4 {
            "4 particles".to_owned()
        } else {
            "4 or more particles".to_owned()
        },
        format!("more than {slots}: no slot left"),
    ];
    let color = |[r, g, b]: [u8; 3]| Rgba32::from_rgb(r, g, b);
    let classes = (0..).zip(names).zip(POOL_COLORS);
    let mut infos: Vec<(u16, String, Rgba32)> = classes
        .map(|((class, name), rgb)| (class, name, color(rgb)))
        .collect();
    infos.push((
        u16::from(NO_VOXEL),
        "no voxel".into(),
        Rgba32::from_unmultiplied_rgba(0, 0, 0, 0),
    ));
    AnnotationContext::new(infos.into_iter().map(|(id, label, color)| AnnotationInfo {
        id,
        label: Some(label.into()),
        color: Some(color),
    }))
}

/// The plan as tables.
fn plan_text(plan: &Plan) -> String {
    let mut text = format!(
        "{} particles{}, {} steps of {:.3e} s in each frame (limited by the {}), {} on the device\n\n",
        count(plan.particles.into()),
        match plan.boundary_particles {
            0 => String::new(),
            walls => format!(" and {} boundary particles", count(walls.into())),
        },
        count(plan.steps_per_frame.into()),
        plan.time_step_s,
        plan.time_step_limited_by,
        bytes(plan.bytes())
    );
    text.push_str("| buffer | size | why |\n|---|---|---|\n");
    for buffer in &plan.buffers {
        let _ = writeln!(
            text,
            "| {} | {} | {} |",
            buffer.name,
            bytes(buffer.bytes),
            buffer.why
        );
    }
    text.push_str("\n| pass | shader | why |\n|---|---|---|\n");
    for row in &plan.passes {
        let pass = &row.pass;
        let _ = writeln!(text, "| {} | {} | {} |", pass.entry, pass.shader, pass.why);
    }
    for note in plan.told() {
        let _ = writeln!(text, "\n{note}");
    }
    text
}
