//! Bare points as a scene: a neighbor search without physics, for particles that Sliceflow did not make.

use glam::{DVec3, Vec3};
use serde_json::json;

use super::allowance::MOST_PARTICLES;
use super::model::{Dashpot, Integrator, Render, Wall};
use super::{
    Coloring, Contact, Dimensions, Domain, Grains, Matter, Neighbors, Particles, Scene, Time, column,
};
use crate::error::{Error, Result};

/// Search radii, in the points' unit: their squares stay far inside f32.
const SMALLEST_RADIUS: f64 = 1e-15;
const LARGEST_RADIUS: f64 = 1e15;
/// Coordinates are rounded to f32 around the center; a search notes it when that is more than this share of its radius, and
/// is refused when it is more than the other.
const TELLING_ROUNDING: f64 = 1e-6;
const MOST_ROUNDING: f64 = 1e-3;

impl Scene {
    /// Points at rest and the search for all pairs nearer than `search_radius`; ids are 0, 1, 2, … in their order.
    ///
    /// The points may have any unit and lie anywhere: the center of their bounding box, which is the domain, is
    /// subtracted in f64. z is not looked at in 2D. Grains have half the search radius, so that those that touch are
    /// neighbors; no force acts.
    ///
    /// Fails where there is no point or too many, where one is not finite (told with its place, counted from 0), and
    /// where the radius is not between 1e-15 and 1e15.
    pub fn of_points(
        points: &[DVec3],
        dimensions: Dimensions,
        search_radius: f64,
        neighbors: Neighbors,
    ) -> Result<Self> {
        check(points, dimensions, search_radius)?;
        let flat = |p: &DVec3| match dimensions {
            Dimensions::Two => p.with_z(0.0),
            Dimensions::Three => *p,
        };
        let low = points.iter().map(flat).fold(DVec3::INFINITY, DVec3::min);
        let high = points.iter().map(flat).fold(DVec3::NEG_INFINITY, DVec3::max);
        let origin = low / 2.0 + high / 2.0;
        let (min, max) = ((low - origin).as_vec3(), (high - origin).as_vec3());
        if !max.is_finite() {
            return Err(Error::usage(
                "the points lie too far apart for f32",
                "remove those that are far away, or scale all of them down",
            ));
        }

        let mut notes = Vec::new();
        // Nothing is lost of coordinates that f32 holds.
        let lost = |p: &DVec3| {
            let local = flat(p) - origin;
            (local - local.as_vec3().as_dvec3()).abs().max_element()
        };
        let rounding = points.iter().map(lost).fold(0.0, f64::max);
        // So wide, not even voxels could be told apart.
        let is_too_wide = f64::from(max.max_element() * f32::EPSILON) > search_radius;
        if rounding > MOST_ROUNDING * search_radius || is_too_wide {
            return Err(Error::usage(
                format!(
                    "the points lie too far apart for f32: it rounds coordinates so far from their center by up to {:.1e} of \
                     the search radius, and counts would be wrong",
                    f64::from(max.max_element() * f32::EPSILON / 2.0) / search_radius
                ),
                "search each cluster by itself, or take a larger radius",
            ));
        }
        if rounding > TELLING_ROUNDING * search_radius {
            notes.push(format!(
                "coordinates are rounded to f32 around the center of the points, here by up to {:.1e} of the search \
                 radius: pairs about as far apart as the radius may fall on either side of it",
                rounding / search_radius
            ));
        }
        let radius = search_radius / 2.0;
        let axes = dimensions.count();
        let file = json!({
            "name": "points",
            "dimensions": axes,
            "domain": { "min": &low.to_array()[..axes], "max": &high.to_array()[..axes], "walls": "open" },
            "gravity": &[0.0; 3][..axes],
            "grains": { "radius": radius, "spring": 0.0 },
            "neighbors": {
                "addressing": neighbors.addressing,
                "storage": neighbors.storage,
                "slicing_axis": neighbors.slicing_axis,
                "cell": neighbors.cell,
                "slots": neighbors.slots,
            },
        });
        Ok(Self {
            name: "points".into(),
            file: serde_json::from_value(file).expect("a scene file of points"),
            dimensions,
            origin,
            domain: Domain {
                min,
                max,
                sides: [[Wall::Open; 2]; 3],
                restitution: 0.0,
                materials: Default::default(),
            },
            gravity: Vec3::ZERO,
            matter: Matter::Grains(Grains {
                radius,
                mass: 1.0,
                sizes: None,
                contact: NO_CONTACT,
                mixed: false,
            }),
            particles: Particles {
                position: points.iter().map(|p| (flat(p) - origin).as_vec3()).collect(),
                velocity: vec![Vec3::ZERO; points.len()],
                ..Particles::default()
            },
            boundary: Default::default(),
            capacity: points.len() as u32,
            colliders: Vec::new(),
            rigid_bodies: Vec::new(),
            schedule: Vec::new(),
            more_fields: Vec::new(),
            sensors: Default::default(),
            // Nothing moves, so nothing has to be followed.
            neighbors: Neighbors {
                quarantine_distance: Some(0.0),
                skin: 0.0,
                ..neighbors
            },
            time: Time {
                frames: 1,
                fps: 1.0,
                step: 1.0,
                steps_per_frame: 1,
                integrator: Integrator::default(),
                contact_duration: None,
                limited_by: "nothing moves",
                adaptive: None,
            },
            render: Render::default(),
            color: Coloring {
                column: column::find("speed").expect("a column"),
                map: "viridis".into(),
                range: [0.0, 1.0],
                legend: false,
            },
            notes,
            written: Default::default(),
        })
    }
}

const NO_CONTACT: Contact = Contact {
    spring: 0.0,
    damping: 0.0,
    wall_damping: 0.0,
    dashpot: Dashpot::Normal,
    shear: 0.0,
    attraction: 0.0,
    global_damping: 0.0,
    friction: None,
    smallest: None,
};

fn check(points: &[DVec3], dimensions: Dimensions, search_radius: f64) -> Result<()> {
    if !(SMALLEST_RADIUS..=LARGEST_RADIUS).contains(&search_radius) {
        return Err(Error::usage(
            format!("the search radius is {search_radius}"),
            format!(
                "give a number between {SMALLEST_RADIUS:e} and {LARGEST_RADIUS:e}, in the unit of the points"
            ),
        ));
    }
    if points.is_empty() || points.len() as u64 > MOST_PARTICLES {
        return Err(Error::usage(
            format!("there are {} points", points.len()),
            format!("give 1 to {MOST_PARTICLES}"),
        ));
    }
    for (row, point) in points.iter().enumerate() {
        for (name, value) in ["x", "y", "z"]
            .into_iter()
            .zip(point.to_array())
            .take(dimensions.count())
        {
            if !value.is_finite() {
                return Err(Error::usage(
                    format!("point {row}: {name} is {value}"),
                    "give a finite number, or leave the point out",
                ));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(points: &[DVec3], dimensions: Dimensions, radius: f64) -> Result<Scene> {
        Scene::of_points(points, dimensions, radius, Neighbors::default())
    }

    #[test]
    fn a_cloud_far_from_zero_gives_the_same_local_points() {
        // Multiples of 2⁻¹⁰, which f64 holds around a million too; f32 would not.
        let near = [[0.0, 0.0, 0.0], [1.0, 2.0, 0.5], [0.25, 1.0 / 1024.0, 0.125]].map(DVec3::from);
        let far = near.map(|p| p + DVec3::new(1e6, -1e6, 1e6));
        let (near, far) = (
            of(&near, Dimensions::Three, 0.5).unwrap(),
            of(&far, Dimensions::Three, 0.5).unwrap(),
        );
        assert_eq!(near.particles, far.particles);
        assert_eq!(far.origin, DVec3::new(1e6 + 0.5, -1e6 + 1.0, 1e6 + 0.25));
        assert_eq!(far.domain.max, Vec3::new(0.5, 1.0, 0.25));
        assert_eq!(far.radius(), 0.25);
        assert!(far.notes.is_empty());
    }

    #[test]
    fn a_flat_cloud_is_seen_from_above() {
        let points = [[0.0, 0.0, 3.0], [1.0, 1.0, f64::NAN]].map(DVec3::from);
        let scene = of(&points, Dimensions::Two, 1.0).unwrap();
        assert!(scene.particles.position.iter().all(|p| p.z == 0.0));
        assert_eq!((scene.origin.z, scene.domain.max.z), (0.0, 0.0));
    }

    #[test]
    fn rounding_that_matters_is_noted() {
        let notes = |x: f64| {
            let points = [DVec3::ZERO, DVec3::new(0.3, 0.0, 0.0), DVec3::X * x];
            of(&points, Dimensions::Three, 1.0).map(|scene| scene.notes.len())
        };
        assert_eq!(notes(0.5).unwrap(), 0);
        assert_eq!(notes(1e4).unwrap(), 1);
        for far in [1e6, 1e8] {
            let told = notes(far).unwrap_err().to_string();
            assert!(
                told.contains("too far apart") && told.contains("by itself"),
                "{told}"
            );
        }
        // f32 holds these, and loses nothing.
        let whole = [DVec3::ZERO, DVec3::X * 1e5];
        assert!(of(&whole, Dimensions::Three, 1.0).unwrap().notes.is_empty());
    }

    #[test]
    fn what_cannot_be_searched_is_told_with_its_place() {
        let point = [DVec3::ZERO];
        for (radius, expected) in [
            (0.0, "radius is 0"),
            (f64::NAN, "radius is NaN"),
            (-1.0, "radius is -1"),
        ] {
            let message = of(&point, Dimensions::Three, radius).unwrap_err().to_string();
            assert!(message.contains(expected), "{message}");
        }
        let broken = [DVec3::ZERO, DVec3::new(0.0, f64::INFINITY, 0.0)];
        let far = [DVec3::X * -1e300, DVec3::X * 1e300];
        for (points, expected) in [
            (&broken[..], "point 1: y is inf"),
            (&[], "there are 0 points"),
            (&far, "too far apart"),
        ] {
            let message = of(points, Dimensions::Three, 1.0).unwrap_err().to_string();
            assert!(message.contains(expected), "{message}");
        }
    }
}
