//! The uniforms of the picture passes, field for field as `shaders/render/picture.wgsl` and `pool.wgsl` have them.

use glam::DVec2;

use super::backdrop::{Backdrop, POOL_COLORS, Rgb, backdrop, linear, packed};
use super::camera::Sight;
use super::layout::{Layout, Rectangle};
use super::light::Light;
use super::style::Style;
use crate::scene::Scene;
use crate::shared_struct;

shared_struct! {
    /// See `shaders/render/picture.wgsl`.
    pub struct Picture {
        pub view_projection: [[f32; 4]; 4],
        pub light_projection: [[f32; 4]; 4],
        pub eye: [f32; 4],
        pub right: [f32; 4],
        pub up: [f32; 4],
        pub forward: [f32; 4],
        pub lens: [f32; 4],
        pub light: [f32; 4],
        pub domain_min: [f32; 4],
        pub domain_max: [f32; 4],
        pub floor_color: [f32; 4],
        pub backdrop_low: [f32; 4],
        pub backdrop_high: [f32; 4],
        pub rectangle: [u32; 4],
        pub radius: f32,
        pub color_low: f32,
        pub color_scale: f32,
        pub line_width: f32,
        pub floor_height: f32,
        pub floor_fade_begin: f32,
        pub floor_fade_end: f32,
        pub near: f32,
        pub far: f32,
        pub antialias: u32,
        pub frame_width: u32,
        pub count: u32,
    }
}

shared_struct! {
    /// See `shaders/render/pool.wgsl`.
    pub struct PoolPanel {
        pub rectangle: [u32; 4],
        pub square: [u32; 4],
        pub background: u32,
        pub frame_width: u32,
        pub empty: u32,
        pub one: u32,
        pub two: u32,
        pub three: u32,
        pub four: u32,
        pub overflow: u32,
    }
}

fn rectangle(r: Rectangle) -> [u32; 4] {
    [r.x, r.y, r.width, r.height]
}

fn four(v: glam::DVec3, w: f64) -> [f32; 4] {
    v.extend(w).as_vec4().to_array()
}

fn linear_color(color: Rgb, w: f32) -> [f32; 4] {
    let [r, g, b] = color.map(linear);
    [r, g, b, w]
}

/// From where on the floor fades, and where it ends, in diagonals of the domain.
pub const FLOOR_FADE: [f64; 2] = [0.45, 1.5];

/// Height of the floor: a hair under the domain, so that lines and planes on its lower side stay in front.
pub fn floor_height(scene: &Scene) -> f64 {
    let size = (scene.domain.max - scene.domain.min).length();
    f64::from(scene.domain.min.y) - 5e-4 * f64::from(size)
}

impl Picture {
    /// The picture of `count` particles at `time` seconds, through a place on the lens: metres from its middle.
    pub fn new(
        scene: &Scene,
        layout: &Layout,
        place: Rectangle,
        style: &Style,
        time: f64,
        lens: DVec2,
        count: u32,
    ) -> Self {
        let size = [place.width, place.height];
        let sight = Sight::new(scene, size, layout.insets, time).through(lens, scene);
        let first = Sight::new(scene, size, layout.insets, 0.0);
        let light = Light::new(scene, &first, floor_height(scene));
        let backdrop: Backdrop = backdrop(scene.render.background);
        let diagonal = f64::from((scene.domain.max - scene.domain.min).length());
        let [low, high] = scene.color.range;
        // Position columns are local on the device; the origin is taken off here, in f64.
        let local_low = match scene.color.column.name {
            "x" => low - scene.origin.x,
            "y" => low - scene.origin.y,
            "z" => low - scene.origin.z,
            _ => low,
        };
        let antialias = scene.render.antialias;
        Self {
            view_projection: sight.view_projection().to_cols_array_2d(),
            light_projection: light.projection.to_cols_array_2d(),
            eye: four(sight.eye, if sight.perspective { 1.0 } else { 0.0 }),
            right: four(sight.right, 0.0),
            up: four(sight.up, 0.0),
            forward: four(sight.forward, 0.0),
            lens: glam::DVec4::new(sight.half.x, sight.half.y, sight.shift.x, sight.shift.y)
                .as_vec4()
                .to_array(),
            light: four(light.toward, light.texel),
            domain_min: scene.domain.min.extend(0.0).to_array(),
            domain_max: scene.domain.max.extend(0.0).to_array(),
            floor_color: linear_color(backdrop.floor, f32::from(backdrop.shadow) / 100.0),
            backdrop_low: linear_color(backdrop.low, 1.0),
            backdrop_high: linear_color(backdrop.high, 1.0),
            rectangle: rectangle(place),
            radius: style.radius as f32,
            color_low: local_low as f32,
            color_scale: (1.0 / (high - low)) as f32,
            line_width: (1.7 * layout.scale).max(1.0) * antialias as f32,
            floor_height: floor_height(scene) as f32,
            floor_fade_begin: (FLOOR_FADE[0] * diagonal) as f32,
            floor_fade_end: (FLOOR_FADE[1] * diagonal) as f32,
            near: sight.near as f32,
            far: sight.far as f32,
            antialias,
            frame_width: layout.frame[0],
            count,
        }
    }
}

impl PoolPanel {
    pub fn new(scene: &Scene, layout: &Layout, place: &super::layout::PoolPlace) -> Self {
        let [empty, one, two, three, four, overflow] = POOL_COLORS.map(packed);
        let [x, y, side] = place.square;
        Self {
            rectangle: rectangle(place.panel),
            square: [x, y, side, 0],
            background: packed(backdrop(scene.render.background).panel),
            frame_width: layout.frame[0],
            empty,
            one,
            two,
            three,
            four,
            overflow,
        }
    }
}
