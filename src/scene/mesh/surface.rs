//! Where a closed mesh's inside is, and how far its surface, through a tree of bounding boxes.
//!
//! Inside is where the winding number is not zero. It is counted along lines parallel to x, in two steps. A plane
//! z = const cuts each edge in one point, the same bits whichever triangle asks, so that the cut is made of closed
//! polygons. A line y = const in that plane crosses a polygon's side if one of the side's ends is above it and the other
//! is not, so that it goes up through a closed polygon as often as down. Hence a line that meets faces, edges or
//! vertices exactly still leaves as often as it enters, whatever the rounding.

use glam::DVec3;

use super::Mesh;

/// Triangles in a leaf.
const LEAF: usize = 4;

/// A mesh's triangles in a tree of boxes.
pub struct Surface {
    /// The root first; of an inner node, the first child stands right behind it.
    nodes: Vec<Node>,
    /// Corners, in the order of the leaves.
    triangles: Vec<[DVec3; 3]>,
}

struct Node {
    min: DVec3,
    max: DVec3,
    link: Link,
}

enum Link {
    SecondChild(usize),
    Triangles(usize, usize),
}

impl Node {
    /// Zero inside the box.
    fn distance_squared(&self, point: DVec3) -> f64 {
        (point - point.clamp(self.min, self.max)).length_squared()
    }
}

impl Surface {
    pub fn new(mesh: &Mesh) -> Surface {
        let mut triangles: Vec<[DVec3; 3]> = mesh
            .triangles
            .iter()
            .map(|triangle| triangle.map(|index| mesh.vertices[index as usize]))
            .collect();
        let mut nodes = Vec::new();
        if !triangles.is_empty() {
            build(&mut nodes, &mut triangles, 0);
        }
        Surface { nodes, triangles }
    }

    /// Metres from `point` to the surface, or `limit` if it is farther than that.
    pub fn distance(&self, point: DVec3, limit: f64) -> f64 {
        self.nearest(point, limit)
            .map_or(limit, |foot| point.distance(foot).min(limit))
    }

    /// The point of the surface that is nearest to `point`, if it is nearer than `limit`, metres.
    pub fn nearest(&self, point: DVec3, limit: f64) -> Option<DVec3> {
        let mut found = None;
        let mut nearest = limit * limit;
        let mut open = Vec::new();
        if let Some(root) = self.nodes.first() {
            open.push((0, root.distance_squared(point)));
        }
        while let Some((index, away)) = open.pop() {
            if away >= nearest {
                continue;
            }
            match self.nodes[index].link {
                Link::Triangles(first, end) => {
                    for &triangle in &self.triangles[first..end] {
                        let foot = closest_point(triangle, point);
                        let away = (point - foot).length_squared();
                        if away < nearest {
                            (nearest, found) = (away, Some(foot));
                        }
                    }
                }
                Link::SecondChild(second) => {
                    let mut children =
                        [index + 1, second].map(|child| (child, self.nodes[child].distance_squared(point)));
                    // The nearer one last, so that it is popped first.
                    if children[0].1 < children[1].1 {
                        children.swap(0, 1);
                    }
                    open.extend(children.into_iter().filter(|child| child.1 < nearest));
                }
            }
        }
        found
    }

    /// The inside along the line through all points with this y and z.
    pub fn line(&self, y: f64, z: f64) -> Line {
        let mut crossings = Vec::new();
        let mut open = Vec::from_iter((!self.nodes.is_empty()).then_some(0));
        while let Some(index) = open.pop() {
            let Node { min, max, link } = &self.nodes[index];
            if y < min.y || y > max.y || z < min.z || z > max.z {
                continue;
            }
            match *link {
                Link::Triangles(first, end) => crossings.extend(
                    self.triangles[first..end]
                        .iter()
                        .filter_map(|&triangle| crossing(triangle, y, z)),
                ),
                Link::SecondChild(second) => open.extend([index + 1, second]),
            }
        }
        crossings.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut winding = 0;
        for (_, turn) in &mut crossings {
            winding += *turn;
            *turn = winding;
        }
        Line(crossings)
    }

    /// For one point; for many with the same y and z, ask their [`Surface::line`].
    pub fn contains(&self, point: DVec3) -> bool {
        self.line(point.y, point.z).contains(point.x)
    }
}

/// Where a line parallel to x meets the surface: x, and the winding number behind it; ascending.
pub struct Line(Vec<(f64, i32)>);

impl Line {
    pub fn contains(&self, x: f64) -> bool {
        let passed = self.0.partition_point(|crossing| crossing.0 <= x);
        passed > 0 && self.0[passed - 1].1 != 0
    }
}

/// Halves the triangles at the median of their centers along the longest side of the box around them.
fn build(nodes: &mut Vec<Node>, triangles: &mut [[DVec3; 3]], first: usize) {
    let corners = triangles.as_flattened();
    let min = corners.iter().copied().reduce(DVec3::min).unwrap();
    let max = corners.iter().copied().reduce(DVec3::max).unwrap();
    let index = nodes.len();
    nodes.push(Node {
        min,
        max,
        link: Link::Triangles(first, first + triangles.len()),
    });
    if triangles.len() <= LEAF {
        return;
    }
    let axis = (max - min).max_position();
    let middle = triangles.len() / 2;
    let center = |[a, b, c]: &[DVec3; 3]| a[axis] + b[axis] + c[axis];
    triangles.select_nth_unstable_by(middle, |a, b| center(a).total_cmp(&center(b)));
    let (low, high) = triangles.split_at_mut(middle);
    build(nodes, low, first);
    nodes[index].link = Link::SecondChild(nodes.len());
    build(nodes, high, first + middle);
}

/// Where the line parallel to x through (y, z) crosses a triangle: x, and +1 into the body or -1 out of it.
fn crossing([a, b, c]: [DVec3; 3], y: f64, z: f64) -> Option<(f64, i32)> {
    let mut from = None;
    let mut to = None;
    for (p, q) in [(a, b), (b, c), (c, a)] {
        match (p.z > z, q.z > z) {
            (false, true) => from = Some(cut(p, q, z)),
            (true, false) => to = Some(cut(q, p, z)),
            _ => {}
        }
    }
    let (from, to) = (from?, to?);
    if (from.y > y) == (to.y > y) {
        return None;
    }
    let share = (y - from.y) / (to.y - from.y);
    let x = from.x + share * (to.x - from.x);
    Some((x, if to.y > from.y { 1 } else { -1 }))
}

/// The point of the edge at height z, kept within the edge's own box whatever the rounding.
fn cut(low: DVec3, high: DVec3, z: f64) -> DVec3 {
    low.lerp(high, (z - low.z) / (high.z - low.z))
        .clamp(low.min(high), low.max(high))
}

/// Ericson 2005, Real-Time Collision Detection, 5.1.5: by the region of the triangle's plane that the point is over.
fn closest_point([a, b, c]: [DVec3; 3], p: DVec3) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(p - a), ac.dot(p - a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    a + (ab * vb + ac * vc) / (va + vb + vc)
}
