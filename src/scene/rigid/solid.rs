//! Volume, center of mass and inertia of solid shapes, of density one.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

use crate::scene::Dimensions;
use crate::scene::mesh::Mesh;
use crate::scene::shapes::Region;

/// Of density one. In 2D, of a plate one metre thick, whose inertia counts about z only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solid {
    /// m³, or m² in 2D.
    pub content: f64,
    /// Metres.
    pub center: DVec3,
    /// About the center.
    pub inertia: DMat3,
}

impl Solid {
    /// `None` for what holds nothing in two dimensions.
    pub fn of_region(region: &Region, dimensions: Dimensions) -> Option<Self> {
        let content = region.content(dimensions);
        let solid = match (region, dimensions) {
            (Region::Box { min, max }, _) => {
                let size = match dimensions {
                    Dimensions::Two => (*max - *min).with_z(0.0),
                    Dimensions::Three => *max - *min,
                };
                let squares = size * size / 12.0;
                let turned = DVec3::splat(squares.element_sum()) - squares;
                Self {
                    content,
                    center: 0.5 * (*min + *max),
                    inertia: DMat3::from_diagonal(content * turned),
                }
            }
            (Region::Sphere { center, radius }, _) => {
                let share = match dimensions {
                    Dimensions::Two => 0.5,
                    Dimensions::Three => 0.4,
                };
                Self {
                    content,
                    center: *center,
                    inertia: DMat3::from_diagonal(DVec3::splat(share * content * radius * radius)),
                }
            }
            (Region::Cylinder { from, to, radius }, Dimensions::Three) => {
                let along = (*to - *from).normalize();
                let (square, length) = (radius * radius, from.distance_squared(*to));
                let (own, across) = (0.5 * square, square / 4.0 + length / 12.0);
                let line = DMat3::from_cols(along * along.x, along * along.y, along * along.z);
                Self {
                    content,
                    center: 0.5 * (*from + *to),
                    inertia: content * (across * (DMat3::IDENTITY - line) + own * line),
                }
            }
            (Region::Mesh(mesh), Dimensions::Three) => Self::of_mesh(mesh),
            (Region::Cylinder { .. } | Region::Mesh(_), Dimensions::Two) => return None,
        };
        Some(match dimensions {
            Dimensions::Two => Self {
                center: solid.center.with_z(0.0),
                ..solid
            },
            Dimensions::Three => solid,
        })
    }

    /// What lies between two circles.
    pub fn ring(center: DVec3, inner: f64, outer: f64) -> Self {
        let content = PI * (outer - inner) * (outer + inner);
        let about_z = 0.5 * content * (inner * inner + outer * outer);
        Self {
            content,
            center: center.with_z(0.0),
            inertia: DMat3::from_diagonal(DVec3::splat(about_z)),
        }
    }

    /// Balls, or discs in 2D, of this radius; where they overlap both count.
    pub fn of_balls(centers: &[DVec3], radius: f64, dimensions: Dimensions) -> Self {
        let each = ball_content(radius, dimensions);
        let share = match dimensions {
            Dimensions::Two => 0.5,
            Dimensions::Three => 0.4,
        };
        let number = centers.len().max(1) as f64;
        let center = centers.iter().sum::<DVec3>() / number;
        let own = DMat3::from_diagonal(DVec3::splat(share * radius * radius));
        let inertia = centers.iter().map(|at| own + about_center(moments(*at - center)));
        Self {
            content: number * each,
            center,
            inertia: each * inertia.fold(DMat3::ZERO, |sum, one| sum + one),
        }
    }

    /// Of a closed mesh, as the sum of the tetrahedra between its triangles and one point (Tonon 2004).
    fn of_mesh(mesh: &Mesh) -> Self {
        let (low, high) = mesh.bounds();
        let origin = 0.5 * (low + high);
        let (mut content, mut first, mut second) = (0.0, DVec3::ZERO, DMat3::ZERO);
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|index| mesh.vertices[index as usize] - origin);
            let volume = a.dot(b.cross(c)) / 6.0;
            let sum = a + b + c;
            content += volume;
            first += volume / 4.0 * sum;
            second += volume / 20.0 * (moments(a) + moments(b) + moments(c) + moments(sum));
        }
        let center = first / content;
        Self {
            content,
            center: origin + center,
            inertia: about_center(second - content * moments(center)),
        }
    }
}

/// m³ of a ball, or m² of a disc in 2D.
pub fn ball_content(radius: f64, dimensions: Dimensions) -> f64 {
    match dimensions {
        Dimensions::Two => PI * radius * radius,
        Dimensions::Three => 4.0 / 3.0 * PI * radius.powi(3),
    }
}

/// x xᵀ.
fn moments(x: DVec3) -> DMat3 {
    DMat3::from_cols(x * x.x, x * x.y, x * x.z)
}

/// From ∫ x xᵀ to the inertia.
fn about_center(second: DMat3) -> DMat3 {
    let trace = second.x_axis.x + second.y_axis.y + second.z_axis.z;
    DMat3::from_diagonal(DVec3::splat(trace)) - second
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::mesh::samples;

    fn near(found: &Solid, known: &Solid) {
        assert!((found.content / known.content - 1.0).abs() < 1e-9, "{found:?}");
        assert!(found.center.distance(known.center) < 1e-9, "{found:?}");
        let scale = known.inertia.x_axis.length();
        let apart = found.inertia - known.inertia;
        assert!(
            apart.abs_diff_eq(DMat3::ZERO, 1e-9 * scale),
            "{found:?} {known:?}"
        );
    }

    #[test]
    fn a_mesh_of_a_box_weighs_what_the_box_does() {
        let (min, max) = (DVec3::new(1.0, -2.0, 0.5), DVec3::new(1.5, -1.0, 2.5));
        let known = Solid::of_region(&Region::Box { min, max }, Dimensions::Three).unwrap();
        near(&Solid::of_mesh(&samples::cube(min, max)), &known);
    }

    #[test]
    fn balls_on_a_fine_lattice_weigh_what_a_cylinder_does() {
        let (from, to, radius) = (DVec3::new(0.0, 1.0, 0.0), DVec3::new(0.6, 1.8, 0.0), 0.4);
        let known = Solid::of_region(&Region::Cylinder { from, to, radius }, Dimensions::Three).unwrap();
        let along = (to - from).normalize();
        let mut inside = Vec::new();
        let steps = 60;
        for index in 0..steps * steps * steps {
            let place = [index % steps, index / steps % steps, index / steps / steps];
            let point = DVec3::from(place.map(|at| (f64::from(at) + 0.5) / f64::from(steps) * 2.0 - 0.5))
                + DVec3::new(-0.2, 1.1, -0.5);
            let height = (point - from).dot(along);
            let aside = (point - from - along * height).length();
            if (0.0..=1.0).contains(&height) && aside <= radius {
                inside.push(point);
            }
        }
        let found = Solid::of_balls(&inside, 1e-3, Dimensions::Three);
        let found = found.inertia * (1.0 / found.content);
        let apart = found - known.inertia * (1.0 / known.content);
        assert!(apart.abs_diff_eq(DMat3::ZERO, 2e-3), "{apart:?}");
    }
}
