//! Points that keep their distance, in a hash grid (Teschner et al. 2003).

use std::collections::HashMap;

use glam::DVec3;

/// Indices of the points that stay when each one nearer than `distance` (less a millionth, for rounding) to an earlier
/// one that stays is dropped. `distance` is positive, in metres.
pub fn without_overlaps(points: &[DVec3], distance: f64) -> Vec<usize> {
    let mut spots = Spots::new(distance * (1.0 - 1e-6));
    (0..points.len())
        .filter(|&index| spots.put(points[index]))
        .collect()
}

/// Points no two of which are nearer than a distance.
pub(super) struct Spots {
    distance: f64,
    points: Vec<DVec3>,
    /// The last point of each cell; cells are as wide as the distance.
    last: HashMap<[i64; 3], u32>,
    /// The point before this one in the same cell.
    previous: Vec<Option<u32>>,
}

impl Spots {
    pub fn new(distance: f64) -> Self {
        Self {
            distance,
            points: Vec::new(),
            last: HashMap::new(),
            previous: Vec::new(),
        }
    }

    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    pub fn into_points(self) -> Vec<DVec3> {
        self.points
    }

    /// Takes the point if there is room for it.
    pub fn put(&mut self, point: DVec3) -> bool {
        let [x, y, z] = (point / self.distance).floor().to_array().map(|cell| cell as i64);
        for k in [z, z - 1, z + 1] {
            for j in [y, y - 1, y + 1] {
                for i in [x, x - 1, x + 1] {
                    let mut next = self.last.get(&[i, j, k]).copied();
                    while let Some(index) = next {
                        let other = self.points[index as usize];
                        if other.distance_squared(point) < self.distance * self.distance {
                            return false;
                        }
                        next = self.previous[index as usize];
                    }
                }
            }
        }
        let index = self.points.len() as u32;
        self.points.push(point);
        self.previous.push(self.last.insert([x, y, z], index));
        true
    }
}
