//! Grains of several sizes: radii drawn from a distribution.
//!
//! A contact law has its coefficients for two grains of the largest radius; what others have follows from their masses and radii
//! (`shaders/common/sizes.wgsl`).

use std::f64::consts::{PI, TAU};

use rand::Rng;

use super::Dimensions;
use super::frame::{Frame, Report};
use super::model::{Arrangement, ContactLaw, Placement, SceneFile, Shape, Sieve, Sizes, Wall};
use super::text::number;

/// Largest over smallest radius: the search's voxels are as wide as the largest pair, and hold the cube of it small grains.
pub const MOST_RATIO: f64 = 4.0;
/// Share of a shape that they fill when the scene does not say.
pub const PACKED: f64 = 0.5;
/// Deviations, in ranges of radii, beyond which nearly all that is drawn would be cut off.
const WIDEST: f64 = 4.0;

/// Of grains that are not all of one size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Radius of the smallest, metres.
    pub smallest: f64,
    /// Whether contacts last as long for all sizes, so that springs are stiffer where more mass meets.
    pub springs_by_mass: bool,
}

impl Span {
    /// Of a scene's grains; `None` where they are of one size.
    pub fn of(file: &SceneFile) -> Option<Self> {
        let grains = file.grains.as_ref()?;
        Some(Self {
            smallest: grains.sizes.as_ref()?.smallest(),
            springs_by_mass: grains.contact_time.is_some(),
        })
    }
}

/// m³ of a ball, or m² of a disc.
pub fn content(radius: f64, dimensions: Dimensions) -> f64 {
    match dimensions {
        Dimensions::Two => PI * radius * radius,
        Dimensions::Three => 4.0 / 3.0 * PI * radius.powi(3),
    }
}

/// Draws radii.
pub struct Draw<'a> {
    sizes: &'a Sizes,
    largest: f64,
    dimensions: Dimensions,
    /// Of a sieve curve: share of the number of grains in each class and those below it.
    numbers: Vec<f64>,
}

impl<'a> Draw<'a> {
    /// Of a scene that [`check`] found nothing wrong with; `None` where its grains are of one size.
    pub fn new(file: &'a SceneFile, dimensions: Dimensions) -> Option<Self> {
        let sizes = file.sizes()?;
        let mut numbers = Vec::new();
        if let Sizes::Sieve { curve } = sizes {
            let mut sum = 0.0;
            for pair in curve.windows(2) {
                let [from, to] = [pair[0].radius, pair[1].radius];
                // Mass spreads evenly over the radii of a class, so its grains are as many as the mean of 1/r³ over it (1/r²).
                let mean = match dimensions {
                    Dimensions::Two => 1.0 / (from * to),
                    Dimensions::Three => (from + to) / (2.0 * from * from * to * to),
                };
                sum += (pair[1].passing - pair[0].passing) * mean;
                numbers.push(sum);
            }
            numbers.iter_mut().for_each(|below| *below /= sum);
        }
        Some(Self {
            sizes,
            largest: file.radius(),
            dimensions,
            numbers,
        })
    }

    /// A radius, metres.
    pub fn radius(&self, rng: &mut impl Rng) -> f64 {
        let (smallest, largest) = (self.sizes.smallest(), self.largest);
        match self.sizes {
            Sizes::Uniform { .. } => smallest + (largest - smallest) * rng.random::<f64>(),
            &Sizes::Normal { mean, deviation, .. } => self.cut_off(rng, |z| mean + deviation * z),
            &Sizes::LogNormal { mean, deviation, .. } => {
                let variance = (1.0 + (deviation / mean).powi(2)).ln();
                let center = mean.ln() - 0.5 * variance;
                self.cut_off(rng, |z| (center + variance.sqrt() * z).exp())
            }
            Sizes::Sieve { curve } => {
                let share = rng.random::<f64>();
                let class = self.numbers.partition_point(|&below| below <= share);
                let class = class.min(self.numbers.len() - 1);
                let power = 1 - self.dimensions.count() as i32;
                let [from, to] = [curve[class], curve[class + 1]].map(|row| row.radius.powi(power));
                // The number of grains falls with 1/r³ (1/r²), so that 1/r² (1/r) is evenly spread.
                let radius = (from + (to - from) * rng.random::<f64>()).powf(1.0 / f64::from(power));
                radius.clamp(smallest, largest)
            }
        }
    }

    /// The first radius of a normal draw that is not cut off. [`check`] sees to it that a fair share is not.
    fn cut_off(&self, rng: &mut impl Rng, of: impl Fn(f64) -> f64) -> f64 {
        let within = self.sizes.smallest()..=self.largest;
        loop {
            let radius = of(normal(rng));
            if within.contains(&radius) {
                return radius;
            }
        }
    }

    /// Content of a grain over that of the largest, in the mean, about.
    pub fn mean_share(&self) -> f64 {
        use rand_chacha::rand_core::SeedableRng;
        const DRAWN: u32 = 1000;
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(0);
        let share = |_| (self.radius(&mut rng) / self.largest).powi(self.dimensions.count() as i32);
        (0..DRAWN).map(share).sum::<f64>() / f64::from(DRAWN)
    }
}

/// Whether a particle file's radii suit the scene; those that it has no use for are taken out.
pub fn fit(path: &str, radii: &mut Vec<f64>, file: &SceneFile, placed: &Placement, report: &mut Report) {
    let Some(sizes) = file.sizes() else {
        if !radii.is_empty() {
            let what =
                "the file's radii are passed over, since all grains have grains.radius; add grains.sizes";
            report.notes.push(format!("{path}: {what}"));
            radii.clear();
        }
        return;
    };
    if radii.is_empty() {
        report.problem(
            path,
            "the file has no radii, and grains are of several sizes",
            "add a column `radius` (metres), or leave out grains.sizes",
        );
    } else if placed.stretch.is_some() {
        report.problem(
            format!("{path}.placement.stretch"),
            "balls that are stretched are no balls",
            "leave it out; `scale` changes radii too",
        );
    }
    let span = sizes.smallest() * (1.0 - ROUNDED)..=file.radius() * (1.0 + ROUNDED);
    if let Some(beyond) = radii.iter().find(|&&radius| !span.contains(&radius)) {
        report.problem(
            path,
            format!(
                "a grain's radius is {} m; grains.sizes and grains.radius allow {} to {} m",
                number(*beyond),
                number(sizes.smallest()),
                number(file.radius())
            ),
            "change it, or what they allow",
        );
    }
}

/// Share by which a radius may lie beyond the smallest and the largest: files hold f32.
pub const ROUNDED: f64 = 1e-6;

/// Of mean 0 and deviation 1 (Box and Muller 1958).
fn normal(rng: &mut impl Rng) -> f64 {
    let [a, b] = [rng.random::<f64>(), rng.random::<f64>()];
    (-2.0 * (1.0 - a).ln()).sqrt() * (TAU * b).cos()
}

/// Problems of sizes, and of what does not know them.
pub fn check(file: &SceneFile, frame: &Frame, report: &mut Report) {
    let (Some(grains), Some(sizes)) = (&file.grains, file.sizes()) else {
        return;
    };
    check_distribution(sizes, grains.radius, report);
    if let Some(first) = file.bodies.iter().position(|body| body.rigid.is_some()) {
        report.problem(
            format!("bodies[{first}].rigid"),
            "rigid bodies are made of particles of one size",
            "leave it out, or leave out grains.sizes",
        );
    }
    for (i, body) in file.bodies.iter().enumerate() {
        if matches!(body.shape, Shape::Ring { .. }) {
            report.problem(
                format!("bodies[{i}].shape"),
                "a ring's circles are of particles of one size",
                "use another shape, or leave out grains.sizes",
            );
        }
        // A file says itself where grains are.
        if matches!(body.shape, Shape::Particles { .. }) {
            continue;
        }
        if body.arrangement == Some(Arrangement::Lattice) || body.spacing.is_some() || body.jitter != 0.0 {
            report.problem(
                format!("bodies[{i}]"),
                "grains of several sizes stand on no lattice",
                "leave out `arrangement`, `spacing` and `jitter`: they are filled in at random",
            );
        }
    }
    for (i, emitter) in file.emitters.iter().enumerate() {
        if emitter.arrangement == Some(Arrangement::Lattice) {
            report.problem(
                format!("emitters[{i}].arrangement"),
                "grains of several sizes stand on no lattice",
                "leave it out: they come in disorder",
            );
        }
    }
    let sides = frame.sides[..frame.dimensions.count()].iter().flatten();
    if sides.clone().any(|&side| side == Wall::Clamp) {
        report.problem(
            "domain.walls",
            "walls that clamp know one radius",
            "choose `contact` walls, or leave out grains.sizes",
        );
    }
    if grains.law == ContactLaw::SpringDashpot {
        let of_events = file.events.iter().filter_map(|event| event.set.as_ref());
        if grains.damping.is_some() || of_events.into_iter().any(|set| set.damping.is_some()) {
            report.problem(
                "grains.damping",
                "one dashpot would give each two sizes another restitution",
                "give `restitution` in its place",
            );
        }
    }
}

fn check_distribution(sizes: &Sizes, largest: f64, report: &mut Report) {
    let path = "grains.sizes";
    let smallest = sizes.smallest();
    if smallest >= largest {
        report.problem(
            path,
            format!(
                "the smallest radius, {} m, is not below grains.radius, {} m, which is that of the largest",
                number(smallest),
                number(largest)
            ),
            "lower it, or raise grains.radius",
        );
        return;
    }
    let ratio = largest / smallest;
    if ratio > MOST_RATIO * (1.0 + 1e-9) {
        report.problem(
            path,
            format!(
                "radii differ by a factor of {}, at most {MOST_RATIO} is allowed: the search's voxels are as wide as two of the \
                 largest grains, and each would hold hundreds of the smallest",
                number(ratio)
            ),
            format!(
                "raise the smallest radius to {} m or more: fines below it weigh little and cost most of the time",
                number(largest / MOST_RATIO)
            ),
        );
    }
    match sizes {
        Sizes::Uniform { .. } => {}
        &Sizes::Normal { mean, deviation, .. } | &Sizes::LogNormal { mean, deviation, .. } => {
            if !(smallest..=largest).contains(&mean) {
                report.problem(
                    format!("{path}.mean"),
                    "is not between the smallest and the largest radius",
                    format!("give {} to {} m", number(smallest), number(largest)),
                );
            }
            if deviation > WIDEST * (largest - smallest) {
                report.problem(
                    format!("{path}.deviation"),
                    "is so large that nearly all radii would be cut off",
                    "lower it, or choose the kind `uniform`",
                );
            }
        }
        Sizes::Sieve { curve } => check_curve(curve, largest, report),
    }
}

fn check_curve(curve: &[Sieve], largest: f64, report: &mut Report) {
    let path = "grains.sizes.curve";
    for (i, pair) in curve.windows(2).enumerate() {
        if pair[0].radius >= pair[1].radius || pair[0].passing > pair[1].passing {
            report.problem(
                format!("{path}[{}]", i + 1),
                "is not above the row before",
                "put rows in order of radius; of larger grains more passes",
            );
        }
    }
    let (Some(first), Some(last)) = (curve.first(), curve.last()) else {
        return;
    };
    if first.passing != 0.0 || last.passing != 1.0 || (last.radius / largest - 1.0).abs() > 1e-9 {
        report.problem(
            path,
            "does not reach from nothing to everything",
            format!(
                "begin with a radius that nothing passes (`passing` 0), and end with grains.radius, {} m, that all passes \
                 (`passing` 1)",
                number(largest)
            ),
        );
    }
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use serde_json::{Value, json};

    use super::*;

    const DRAWN: usize = 10_000;

    fn drawn(sizes: Value, dimensions: Dimensions, count: usize) -> Vec<f64> {
        let file: SceneFile = serde_json::from_value(json!({
            "dimensions": dimensions.count(),
            "domain": { "min": [0, 0, 0], "max": [1, 1, 1] },
            "grains": { "radius": 0.01, "sizes": sizes }
        }))
        .unwrap();
        let draw = Draw::new(&file, dimensions).unwrap();
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        (0..count).map(|_| draw.radius(&mut rng)).collect()
    }

    fn mean_and_deviation(all: &[f64]) -> (f64, f64) {
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        let square = all.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
        (mean, (square / all.len() as f64).sqrt())
    }

    /// Moments of a density between the bounds, by the midpoint rule.
    fn cut_off(density: impl Fn(f64) -> f64, smallest: f64) -> (f64, f64) {
        const STEPS: u32 = 20_000;
        let at = |k: u32| smallest + (0.01 - smallest) * (f64::from(k) + 0.5) / f64::from(STEPS);
        let moment = |power: i32| {
            (0..STEPS)
                .map(|k| density(at(k)) * at(k).powi(power))
                .sum::<f64>()
        };
        let mean = moment(1) / moment(0);
        (mean, (moment(2) / moment(0) - mean * mean).sqrt())
    }

    #[test]
    fn drawn_radii_have_the_mean_and_deviation_that_were_asked_for() {
        let (mean, deviation): (f64, f64) = (0.006, 0.0015);
        let variance = (1.0 + (deviation / mean).powi(2)).ln();
        let log_normal = move |r: f64| {
            let off = (r / mean).ln() + 0.5 * variance;
            (-off * off / (2.0 * variance)).exp() / r
        };
        type Density = Box<dyn Fn(f64) -> f64>;
        let cases: [(&str, Value, Density); 3] = [
            (
                "uniform",
                json!({ "kind": "uniform", "smallest": 0.003 }),
                Box::new(|_| 1.0),
            ),
            (
                "normal",
                json!({ "kind": "normal", "smallest": 0.003, "mean": mean, "deviation": deviation }),
                Box::new(move |r| (-((r - mean) / deviation).powi(2) / 2.0).exp()),
            ),
            (
                "log_normal",
                json!({ "kind": "log_normal", "smallest": 0.003, "mean": mean, "deviation": deviation }),
                Box::new(log_normal),
            ),
        ];
        for (name, sizes, density) in cases {
            let radii = drawn(sizes, Dimensions::Three, DRAWN);
            assert!(radii.iter().all(|r| (0.003..=0.01).contains(r)), "{name}");
            let (found, asked) = (mean_and_deviation(&radii), cut_off(density, 0.003));
            // Three deviations of the mean of so many, and as much of their deviation.
            let tolerance = 3.0 * asked.1 / (DRAWN as f64).sqrt();
            println!("{name}: {found:?} for {asked:?}, within {tolerance:.1e}");
            assert!(
                (found.0 - asked.0).abs() < tolerance,
                "{name}: mean {} for {}",
                found.0,
                asked.0
            );
            assert!(
                (found.1 - asked.1).abs() < tolerance,
                "{name}: deviation {} for {}",
                found.1,
                asked.1
            );
        }
    }

    #[test]
    fn sieves_let_pass_the_masses_of_the_curve() {
        // Three of a hundred grains are coarse and weigh as much as a third: of 100,000 that is off by 0.004, as a deviation.
        let curve = [
            (0.0025, 0.0),
            (0.004, 0.2),
            (0.005, 0.7),
            (0.008, 0.7),
            (0.01, 1.0),
        ];
        let rows: Vec<Value> = curve
            .iter()
            .map(|(radius, passing)| json!({ "radius": radius, "passing": passing }))
            .collect();
        for (dimensions, power) in [(Dimensions::Two, 2), (Dimensions::Three, 3)] {
            let radii = drawn(json!({ "kind": "sieve", "curve": rows }), dimensions, 10 * DRAWN);
            let mass = |below: f64| {
                radii
                    .iter()
                    .filter(|&&r| r <= below)
                    .map(|r| r.powi(power))
                    .sum::<f64>()
            };
            for (radius, passing) in curve.iter().copied().chain([(0.0045, 0.45)]) {
                let found = mass(radius) / mass(0.01);
                println!("{dimensions:?}: {found:.4} passes {radius} m, {passing} was asked for");
                assert!(
                    (found - passing).abs() < 0.02,
                    "{dimensions:?}: {found} passes {radius} m for {passing}"
                );
            }
        }
    }
}
