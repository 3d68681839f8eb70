//! Grains of several sizes in a shape, without order and without overlaps.
//!
//! Random points are pushed apart: a move of each grain is the sum of half of its overlaps, with radii a little larger than they
//! are, until no two overlap with the radii that they have (the overlaps of Jodrey and Tory 1985, with sizes that stay).

use glam::DVec3;
use rand_chacha::ChaCha8Rng;

use super::{Interior, MISSED, Region};
use crate::scene::Dimensions;
use crate::scene::sizes::{Draw, content};

/// By which share radii are larger while grains are pushed apart.
const LARGER: f64 = 0.02;
/// How often all grains are pushed.
const SWEEPS: u32 = 400;
/// Share of the largest diameter that pairs are looked for beyond touching, and how far a grain may move until they are looked
/// for again.
const SKIN: f64 = 0.2;

/// A grain's center and radius, metres.
pub type Ball = (DVec3, f64);

/// Grains that lie wholly inside, as many as fill `fraction` of the region's volume (area in 2D), less those that were
/// pushed into others to the end.
pub fn pack(
    region: &Region,
    dimensions: Dimensions,
    draw: &Draw,
    largest: f64,
    fraction: f64,
    rng: &mut ChaCha8Rng,
) -> Vec<Ball> {
    let interior = Interior::new(region, dimensions, largest);
    let mut left = fraction * region.content(dimensions);
    let mut radii = Vec::new();
    loop {
        let radius = draw.radius(rng);
        left -= content(radius, dimensions);
        if left < 0.0 {
            break;
        }
        radii.push(radius);
    }
    let mut balls = Vec::with_capacity(radii.len());
    let mut missed = 0;
    for radius in radii {
        let own = interior.of(radius);
        while missed < MISSED {
            let point = own.draw(rng, own.min, own.max);
            if own.holds(point) {
                balls.push((point, radius));
                break;
            }
            missed += 1;
        }
    }
    push_apart(&mut balls, &interior, largest, dimensions);
    let goes = overlapping(&balls, largest);
    let all = balls.into_iter().zip(goes);
    all.filter_map(|(ball, goes)| (!goes).then_some(ball)).collect()
}

fn push_apart(balls: &mut [Ball], interior: &Interior, largest: f64, dimensions: Dimensions) {
    let skin = SKIN * 2.0 * largest;
    let mut listed: Vec<DVec3> = Vec::new();
    let mut pairs = Vec::new();
    let mut moves = vec![DVec3::ZERO; balls.len()];
    for _ in 0..SWEEPS {
        let far = listed
            .iter()
            .zip(balls.iter())
            .any(|(was, ball)| was.distance(ball.0) > skin / 2.0);
        if listed.is_empty() || far {
            listed = balls.iter().map(|ball| ball.0).collect();
            pairs = pairs_within(balls, largest, skin);
        }
        moves.fill(DVec3::ZERO);
        let mut overlap = false;
        for &(i, j) in &pairs {
            let (a, b) = (balls[i as usize], balls[j as usize]);
            let apart = b.0 - a.0;
            let sum = a.1 + b.1;
            let distance = apart.length();
            let deep = (1.0 + LARGER) * sum - distance;
            if deep <= 0.0 {
                continue;
            }
            overlap |= distance < sum;
            let mut normal = if distance > 0.0 {
                apart / distance
            } else {
                DVec3::X
            };
            if dimensions == Dimensions::Two {
                normal.z = 0.0;
            }
            // The smaller one moves more.
            moves[i as usize] -= normal * deep * (b.1 / sum);
            moves[j as usize] += normal * deep * (a.1 / sum);
        }
        if !overlap {
            return;
        }
        for (ball, by) in balls.iter_mut().zip(&moves) {
            ball.0 = interior.of(ball.1).moved(ball.0, *by);
        }
    }
}

/// Pairs that are nearer than `more` beyond touching, by ascending indices.
fn pairs_within(balls: &[Ball], largest: f64, more: f64) -> Vec<(u32, u32)> {
    let side = 2.0 * largest + more;
    let cell = |ball: &Ball| (ball.0 / side).floor().to_array().map(|cell| cell as i64);
    let mut order: Vec<([i64; 3], u32)> = balls
        .iter()
        .enumerate()
        .map(|(i, ball)| (cell(ball), i as u32))
        .collect();
    order.sort_unstable();
    let mut pairs = Vec::new();
    for (i, ball) in balls.iter().enumerate() {
        let [x, y, z] = cell(ball);
        for dx in -1..=1 {
            for dy in -1..=1 {
                // Cells along z follow each other.
                let first = order.partition_point(|(at, _)| *at < [x + dx, y + dy, z - 1]);
                let row = order[first..].iter();
                for &(_, j) in row.take_while(|(at, _)| *at <= [x + dx, y + dy, z + 1]) {
                    let other = balls[j as usize];
                    let reach = ball.1 + other.1 + more;
                    if i < j as usize && ball.0.distance_squared(other.0) < reach * reach {
                        pairs.push((i as u32, j));
                    }
                }
            }
        }
    }
    pairs
}

/// Which grains have to go so that no two overlap: of two that do, the later one.
fn overlapping(balls: &[Ball], largest: f64) -> Vec<bool> {
    let mut goes = vec![false; balls.len()];
    for (i, j) in pairs_within(balls, largest, 0.0) {
        goes[j as usize] |= !goes[i as usize];
    }
    goes
}

#[cfg(test)]
mod tests {
    use rand_chacha::rand_core::SeedableRng;
    use serde_json::json;

    use super::*;
    use crate::scene::model::SceneFile;

    #[test]
    fn packed_grains_fill_half_of_a_shape_and_do_not_overlap() {
        let file: SceneFile = serde_json::from_value(json!({
            "domain": { "min": [0, 0, 0], "max": [1, 1, 1] },
            "grains": { "radius": 0.06, "sizes": { "kind": "uniform", "smallest": 0.02 } }
        }))
        .unwrap();
        let shapes = [
            Region::Box {
                min: DVec3::ZERO,
                max: DVec3::new(1.0, 0.6, 0.5),
            },
            Region::Sphere {
                center: DVec3::ONE,
                radius: 0.4,
            },
            Region::Cylinder {
                from: DVec3::ZERO,
                to: DVec3::new(0.3, 0.7, 0.2),
                radius: 0.3,
            },
        ];
        for region in shapes {
            for dimensions in [Dimensions::Two, Dimensions::Three] {
                let all = region.content(dimensions);
                if all == 0.0 {
                    continue;
                }
                let draw = Draw::new(&file, dimensions).unwrap();
                let packed = |seed| {
                    let mut rng = ChaCha8Rng::seed_from_u64(seed);
                    pack(&region, dimensions, &draw, 0.06, 0.5, &mut rng)
                };
                let balls = packed(1);
                let filled = balls.iter().map(|ball| content(ball.1, dimensions)).sum::<f64>() / all;
                println!("{region:?}: {} grains, {filled:.3}", balls.len());
                assert!(filled > 0.45, "{region:?}: {filled}");
                assert!(overlapping(&balls, 0.06).iter().all(|overlaps| !overlaps));
                let interior = Interior::new(&region, dimensions, 0.06);
                assert!(balls.iter().all(|ball| interior.of(ball.1).holds(ball.0)));
                assert_eq!(balls, packed(1));
                assert_ne!(balls, packed(2));
            }
        }
    }
}
