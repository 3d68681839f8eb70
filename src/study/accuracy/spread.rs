//! How particles are spread: how near the nearest two are, and into how many pieces they fall.

use std::collections::HashMap;

use glam::DVec3;

/// Particles by cells of a side.
struct Cells<'a> {
    position: &'a [DVec3],
    side: f64,
    members: HashMap<[i64; 3], Vec<usize>>,
}

impl<'a> Cells<'a> {
    fn new(position: &'a [DVec3], side: f64) -> Self {
        let mut cells = Self {
            position,
            side,
            members: HashMap::new(),
        };
        for (i, &at) in position.iter().enumerate() {
            cells.members.entry(cells.home(at)).or_default().push(i);
        }
        cells
    }

    fn home(&self, at: DVec3) -> [i64; 3] {
        (at / self.side).floor().to_array().map(|c| c as i64)
    }

    /// Others that are nearer to a particle than the side, with their distances.
    fn around(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let home = self.home(self.position[i]);
        let cells = (0..27).map(move |n| [home[0] + n % 3 - 1, home[1] + n / 3 % 3 - 1, home[2] + n / 9 - 1]);
        let others = cells.filter_map(|cell| self.members.get(&cell)).flatten();
        let apart = move |&j: &usize| (j, self.position[i].distance(self.position[j]));
        others
            .map(apart)
            .filter(move |&(j, distance)| j != i && distance < self.side)
    }
}

/// Distance of the nearest two particles, m; `reach` where none are nearer.
pub fn closest(position: &[DVec3], reach: f64) -> f64 {
    let cells = Cells::new(position, reach);
    let each = (0..position.len()).flat_map(|i| cells.around(i));
    each.map(|(_, distance)| distance).fold(reach, f64::min)
}

/// How many particles are in each piece, the largest first; two within `reach` (m) are in one.
pub fn pieces(position: &[DVec3], reach: f64) -> Vec<usize> {
    let cells = Cells::new(position, reach);
    let mut seen = vec![false; position.len()];
    let mut sizes = Vec::new();
    for first in 0..position.len() {
        if seen[first] {
            continue;
        }
        seen[first] = true;
        let mut waiting = vec![first];
        let mut size = 0;
        while let Some(i) = waiting.pop() {
            size += 1;
            for (j, _) in cells.around(i) {
                if !seen[j] {
                    seen[j] = true;
                    waiting.push(j);
                }
            }
        }
        sizes.push(size);
    }
    sizes.sort_by(|a, b| b.cmp(a));
    sizes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_and_the_nearest_two_are_found() {
        let at = |x: f64| DVec3::new(x, -0.3, 0.0);
        let position = [at(-1.0), at(-0.2), at(0.5), at(3.0), at(3.4)];
        assert_eq!(pieces(&position, 1.0), [3, 2]);
        assert!((closest(&position, 1.0) - 0.4).abs() < 1e-12);
        assert_eq!(closest(&position[..2], 0.5), 0.5);
        assert_eq!(pieces(&[], 1.0), [0_usize; 0]);
    }
}
