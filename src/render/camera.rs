//! Where the eye is. Auto framing puts the whole domain into the part of the picture that overlays leave free.

use glam::{DMat3, DVec2, DVec3, Mat4, Vec4};

use super::layout::{Insets, Layout};
use super::picture::{FLOOR_FADE, floor_height};
use crate::scene::model::{Axis, Camera, CameraPoint, Projection, View};
use crate::scene::motion::eased;
use crate::scene::{ColliderShape, Dimensions, Scene};

/// An eye, its axes and its lens; local coordinates, metres.
#[derive(Debug, Clone, Copy)]
pub struct Sight {
    pub eye: DVec3,
    pub right: DVec3,
    pub up: DVec3,
    pub forward: DVec3,
    pub perspective: bool,
    /// Half width and height of the view: at distance one in perspective, else metres.
    pub half: DVec2,
    /// Where the axis meets the picture, in NDC.
    pub shift: DVec2,
    pub near: f64,
    pub far: f64,
    /// Along the view's axis.
    pub target_distance: f64,
}

/// Corners of the box around the domain and every collider that is not a plane.
pub fn bounds(scene: &Scene) -> (DVec3, DVec3) {
    let mut low = scene.domain.min.as_dvec3();
    let mut high = scene.domain.max.as_dvec3();
    for collider in scene.colliders.iter().filter(|collider| collider.visible) {
        let (a, b) = match &collider.shape {
            ColliderShape::Plane { .. } => continue,
            ColliderShape::Box { min, max } => (min.as_dvec3(), max.as_dvec3()),
            ColliderShape::Sphere { center, radius, .. } => {
                ((center - radius).as_dvec3(), (center + radius).as_dvec3())
            }
            ColliderShape::Cylinder { from, to, radius, .. } => (
                (from.min(*to) - radius).as_dvec3(),
                (from.max(*to) + radius).as_dvec3(),
            ),
            ColliderShape::Mesh(mesh) => mesh
                .vertices
                .iter()
                .fold((low, high), |(a, b), &v| (a.min(v), b.max(v))),
        };
        let offsets = collider.path.iter().map(|(_, offset)| offset.as_dvec3());
        for offset in offsets.chain([DVec3::ZERO]) {
            low = low.min(a + offset);
            high = high.max(b + offset);
        }
    }
    (low, high)
}

/// The eight corners of a box.
pub fn corners(low: DVec3, high: DVec3) -> [DVec3; 8] {
    std::array::from_fn(|i| {
        let pick = |bit: usize, a: f64, b: f64| if i & bit == 0 { a } else { b };
        DVec3::new(
            pick(1, low.x, high.x),
            pick(2, low.y, high.y),
            pick(4, low.z, high.z),
        )
    })
}

/// The part of the picture that the domain is fitted into: middle and half size, in NDC.
fn inner(insets: Insets, size: DVec2) -> (DVec2, DVec2) {
    let middle = DVec2::new(insets.left - insets.right, insets.bottom - insets.top) / size;
    let half = DVec2::ONE - DVec2::new(insets.left + insets.right, insets.bottom + insets.top) / size;
    (middle, half.max(DVec2::splat(0.2)))
}

/// The camera as its path has it at `time` seconds.
fn at(scene: &Scene, time: f64) -> Camera {
    let mut camera = scene.render.camera.clone();
    let place = |of: fn(&CameraPoint) -> Option<[f64; 3]>| {
        let points = camera.path.iter();
        let points: Vec<(f64, DVec3)> = points
            .filter_map(|point| Some((point.at, of(point)?.into())))
            .collect();
        (!points.is_empty()).then(|| eased(&points, camera.easing, time).to_array())
    };
    let (eye, target) = (place(|point| point.eye), place(|point| point.target));
    camera.eye = eye.or(camera.eye);
    camera.target = target.or(camera.target);
    camera
}

/// What nothing that pictures of a run show is farther away than, along the view's axis, metres.
pub fn depth_range(scene: &Scene) -> f64 {
    let layout = Layout::new(scene, View::Scene);
    let moments = if scene.render.camera.moves() { 240 } else { 1 };
    let far = (0..moments).map(|k| {
        let time = scene.file.time.duration * f64::from(k) / f64::from(moments);
        let sight = Sight::new(scene, layout.frame, layout.insets, time);
        sight.far.max(floor_depth(scene, &sight))
    });
    // Between these moments it may be a little farther.
    1.02 * far.fold(0.0, f64::max)
}

/// The greatest depth at which extra images show the floor: where half of its color is left.
fn floor_depth(scene: &Scene, sight: &Sight) -> f64 {
    let (low, high) = (scene.domain.min.as_dvec3(), scene.domain.max.as_dvec3());
    let center = ((low + high) * 0.5).with_y(floor_height(scene));
    let reach = 0.5 * (FLOOR_FADE[0] + FLOOR_FADE[1]) * (high - low).length();
    let sideways = sight.forward.with_y(0.0).length();
    sight.forward.dot(center - sight.eye) + reach * sideways
}

impl Sight {
    /// The scene's camera at `time` seconds, for a picture of `size` pixels.
    pub fn new(scene: &Scene, size: [u32; 2], insets: Insets, time: f64) -> Self {
        let camera = &at(scene, time);
        let size = DVec2::new(f64::from(size[0]), f64::from(size[1]));
        let (low, high) = (scene.domain.min.as_dvec3(), scene.domain.max.as_dvec3());
        let center = (low + high) * 0.5;
        let axis = match scene.dimensions {
            Dimensions::Two => Some(Axis::Z),
            Dimensions::Three => camera.axis,
        };
        let target = camera.target.map_or(center, DVec3::from);
        let eye = camera.eye.map(DVec3::from).filter(|&eye| eye != target);
        let forward = match (axis, eye) {
            (Some(Axis::X), _) => DVec3::NEG_X,
            (Some(Axis::Y), _) => DVec3::NEG_Y,
            (Some(Axis::Z), _) => DVec3::NEG_Z,
            (None, Some(eye)) => (target - eye).normalize(),
            // Three quarters from the front, a little from above.
            (None, None) => -DVec3::new(0.52, 0.40, 1.0).normalize(),
        };
        let vertical = if forward.y.abs() > 0.999 {
            DVec3::NEG_Z
        } else {
            DVec3::Y
        };
        let right = forward.cross(vertical).normalize();
        let up = right.cross(forward);
        let perspective = axis.is_none() && camera.projection == Projection::Perspective;
        let tangent = (camera.field_of_view.to_radians() * 0.5).tan();
        let aspect = DVec2::new(size.x / size.y, 1.0);
        let mut sight = Self {
            eye: eye.unwrap_or(target),
            right,
            up,
            forward,
            perspective,
            half: aspect * tangent,
            shift: DVec2::ZERO,
            near: 0.0,
            far: 1.0,
            target_distance: 1.0,
        };
        let (middle, share) = inner(insets, size);
        let points = corners(low, high);
        let turning = camera.orbit != 0.0 && scene.dimensions == Dimensions::Three;
        if perspective {
            if eye.is_none() {
                sight.shift = middle;
                sight.frame(&points, target, share, turning, camera.target.is_none());
            }
        } else {
            let fitted = sight.fit_height(&points, target, share, turning, aspect);
            let height = camera.height.map_or(fitted, |height| height * 0.5);
            sight.half = aspect * height;
            sight.shift = if camera.height.is_none() && camera.target.is_none() {
                middle
            } else {
                DVec2::ZERO
            };
            if axis.is_some() || eye.is_none() {
                sight.eye = target - forward * (high - low).length();
            }
        }
        if turning {
            sight.turn(target, (camera.orbit * time).to_radians());
        }
        sight.clip(scene);
        sight.target_distance = (target - sight.eye).dot(sight.forward).max(sight.near);
        sight
    }

    /// The same view through another place of the lens, so many metres to the right and up from its middle: what is in focus
    /// stays where it is in the picture.
    pub fn through(mut self, lens: DVec2, scene: &Scene) -> Self {
        self.eye += self.right * lens.x + self.up * lens.y;
        let focus = scene.render.camera.focus.unwrap_or(self.target_distance);
        self.shift += lens / (self.half * focus);
        self
    }

    fn turn(&mut self, target: DVec3, angle: f64) {
        let turn = DMat3::from_rotation_y(angle);
        self.eye = target + turn * (self.eye - target);
        for axis in [&mut self.right, &mut self.up, &mut self.forward] {
            *axis = turn * *axis;
        }
    }

    /// Points seen along the view's axes, from `target`; for an orbit, from all around.
    fn seen(&self, points: &[DVec3], target: DVec3, turning: bool) -> Vec<DVec3> {
        let turns = if turning { 36 } else { 1 };
        let mut seen = Vec::new();
        for k in 0..turns {
            let turn = DMat3::from_rotation_y(f64::from(k) / f64::from(turns) * std::f64::consts::TAU);
            for &point in points {
                let p = turn * (point - target);
                seen.push(DVec3::new(p.dot(self.right), p.dot(self.up), p.dot(self.forward)));
            }
        }
        seen
    }

    /// Moves the eye back along the view until all points are inside, and sideways until they are in the middle.
    fn frame(&mut self, points: &[DVec3], target: DVec3, share: DVec2, turning: bool, center: bool) {
        let seen = self.seen(points, target, turning);
        let half = self.half * share;
        let mut aside = DVec2::ZERO;
        let mut distance = 0.0_f64;
        for _ in 0..20 {
            distance = 1e-9;
            for p in &seen {
                let room = (p.truncate() - aside).abs() / half;
                distance = distance.max(room.max_element() - p.z);
            }
            if !center {
                break;
            }
            let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
            for p in &seen {
                let place = (p.truncate() - aside) / (distance + p.z);
                low = low.min(place);
                high = high.max(place);
            }
            aside += (low + high) * 0.5 * distance * 0.8;
        }
        self.eye = target - self.forward * distance + self.right * aside.x + self.up * aside.y;
    }

    /// Half height of an orthographic view that holds all points.
    fn fit_height(&self, points: &[DVec3], target: DVec3, share: DVec2, turning: bool, aspect: DVec2) -> f64 {
        let seen = self.seen(points, target, turning);
        let fits = seen
            .iter()
            .map(|p| (p.truncate().abs() / (share * aspect)).max_element());
        fits.fold(1e-12, f64::max)
    }

    /// Near and far planes around everything that is drawn.
    fn clip(&mut self, scene: &Scene) {
        let (low, high) = bounds(scene);
        let drawn = scene.radius() * scene.render.splat_scale;
        let radius = (high - low).length() * 0.5 + 2.0 * drawn;
        let ahead = ((low + high) * 0.5 - self.eye).dot(self.forward);
        let nearest = if self.perspective {
            radius * 0.004
        } else {
            ahead - radius
        };
        self.near = (ahead - radius).max(nearest);
        self.far = (ahead + radius).max(self.near + radius * 0.01);
    }

    /// World to clip space, depth from 0 to 1.
    pub fn view_projection(&self) -> Mat4 {
        let row = |axis: DVec3, scale: f64| axis.extend(-axis.dot(self.eye)) * scale;
        let depth = row(self.forward, 1.0);
        let end = glam::DVec4::W;
        let (range, w) = (self.far - self.near, if self.perspective { depth } else { end });
        let x = row(self.right, 1.0 / self.half.x) + w * self.shift.x;
        let y = row(self.up, 1.0 / self.half.y) + w * self.shift.y;
        let scale = if self.perspective {
            self.far / range
        } else {
            1.0 / range
        };
        let z = (depth - end * self.near) * scale;
        let rows: [Vec4; 4] = [x, y, z, w].map(|row| row.as_vec4());
        Mat4::from_cols_array_2d(&rows.map(|row| row.to_array())).transpose()
    }
}
