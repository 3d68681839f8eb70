//! The key light and the box that its shadow map covers.

use glam::{DVec3, Mat4};

use super::camera::{Sight, bounds, corners};
use crate::scene::Scene;

/// Texels along the shadow map's side.
pub const SHADOW_TEXELS: u32 = 1024;

pub struct Light {
    /// Unit vector towards the light.
    pub toward: DVec3,
    /// World to the shadow map's clip space.
    pub projection: Mat4,
    /// Metres per texel.
    pub texel: f64,
}

impl Light {
    /// `first` is the camera at time 0: the light stays where it is while the camera turns.
    pub fn new(scene: &Scene, first: &Sight, floor_height: f64) -> Self {
        let toward = match scene.render.light {
            Some(light) => DVec3::from(light).normalize_or(DVec3::Y),
            // From above, over the viewer's left shoulder.
            None => (DVec3::Y - first.right * 0.80 - first.forward * 0.42).normalize(),
        };
        let (right, up) = toward.any_orthonormal_pair();
        let (low, high) = bounds(scene);
        let center = (low + high) * 0.5;
        let pad = 2.0 * scene.radius() * scene.render.splat_scale;
        let mut half = 0.0_f64;
        let mut reach = 0.0_f64;
        for corner in corners(low, high) {
            let p = corner - center;
            half = half.max(p.dot(right).abs()).max(p.dot(up).abs());
            reach = reach.max(p.dot(toward).abs());
        }
        let half = (half + pad) * 1.01;
        let near = -(reach + pad);
        // As far as the floor under the map's corners, where that is not out of sight.
        let mut far = reach + pad;
        for (a, b) in [(-half, -half), (-half, half), (half, -half), (half, half)] {
            let start = center + right * a + up * b;
            let fall = (start.y - floor_height) / toward.y.max(0.05);
            far = far.max(fall.min(20.0 * half) * 1.01);
        }
        let row = |axis: DVec3, scale: f64| (axis * scale).extend(-axis.dot(center) * scale);
        let x = row(right, 1.0 / half);
        let y = row(up, 1.0 / half);
        let mut z = row(-toward, 1.0 / (far - near));
        z.w -= near / (far - near);
        let rows = [x, y, z, glam::DVec4::W].map(|row| row.as_vec4().to_array());
        Self {
            toward,
            projection: Mat4::from_cols_array_2d(&rows).transpose(),
            texel: 2.0 * half / f64::from(SHADOW_TEXELS),
        }
    }
}
