//! Materials of grains, obstacles and sides: their names, and what holds where two of them meet.

use super::frame::{Frame, Report};
use super::model::{ContactLaw, GrainMaterial, Grains, MaterialPair, SceneFile, Wall};
use super::text::suggest;

/// Stands for what the keys of `grains` say; its number is 0.
const OWN: &str = "grains";
/// What grains of so many materials need fits into the smallest uniform buffers.
const MOST: usize = 11;

/// Names by number.
fn names(grains: &Grains) -> impl Iterator<Item = &str> + Clone {
    std::iter::once(OWN).chain(grains.materials.iter().map(|material| material.name.as_str()))
}

/// The number of the material that a body, emitter, collider or side names.
pub fn number(path: &str, name: Option<&str>, file: &SceneFile, report: &mut Report) -> u32 {
    let (Some(name), Some(grains)) = (name, &file.grains) else {
        return 0;
    };
    match names(grains).position(|known| known == name) {
        Some(number) => number as u32,
        None => {
            let help = match &grains.materials[..] {
                [] => "leave it out, or describe it in grains.materials".to_owned(),
                _ => suggest(name, names(grains)),
            };
            report.problem(path, format!("no material is called \"{name}\""), help);
            0
        }
    }
}

/// Whether grains themselves are of several materials.
pub fn are_mixed(file: &SceneFile) -> bool {
    let bodies = file.bodies.iter().map(|body| &body.material);
    let emitters = file.emitters.iter().map(|emitter| &emitter.material);
    file.grains.is_some() && bodies.chain(emitters).any(|given| given.is_some())
}

/// Numbers of the materials of the domain's sides, `[axis][end]`.
pub fn of_sides(file: &SceneFile, frame: &Frame, report: &mut Report) -> [[u32; 2]; 3] {
    let given = file.domain.side_materials.all();
    [0, 1, 2].map(|axis: usize| {
        [0, 1].map(|end: usize| {
            let (side, name) = given[axis][end];
            let path = format!("domain.side_materials.{side}");
            if name.is_some() && (axis >= frame.dimensions.count() || frame.sides[axis][end] != Wall::Contact)
            {
                report.problem(
                    &path,
                    "no grain touches this side",
                    format!("leave it out, or set domain.sides.{side} to `contact`"),
                );
            }
            number(&path, name, file, report)
        })
    })
}

/// Problems of materials and pairs.
pub fn check(grains: &Grains, report: &mut Report) {
    if grains.materials.len() > MOST {
        report.problem(
            "grains.materials",
            format!("these are {} materials", grains.materials.len()),
            format!("describe at most {MOST}"),
        );
    }
    for (i, material) in grains.materials.iter().enumerate() {
        let path = format!("grains.materials[{i}]");
        if names(grains).take(i + 1).any(|other| other == material.name) {
            let text = match material.name == OWN {
                true => "`grains` stands for what the keys of `grains` say".to_owned(),
                false => format!("another material is called \"{}\" too", material.name),
            };
            report.problem(format!("{path}.name"), text, "choose another name");
        }
        let of_hertz = grains.law == ContactLaw::Hertz;
        for (key, given, known) in [
            ("spring", material.spring.is_some(), !of_hertz),
            ("young_modulus", material.young_modulus.is_some(), of_hertz),
            ("poisson_ratio", material.poisson_ratio.is_some(), of_hertz),
        ] {
            if given && !known {
                report.problem(
                    format!("{path}.{key}"),
                    "the scene's contact law does not know it",
                    "leave it out: `linear` has `spring`, and `hertz` has `young_modulus` and `poisson_ratio`",
                );
            }
        }
    }
    for (i, pair) in grains.pairs.iter().enumerate() {
        let path = format!("grains.pairs[{i}].between");
        for name in &pair.between {
            if names(grains).all(|known| known != name) {
                let help = suggest(name, names(grains));
                report.problem(&path, format!("no material is called \"{name}\""), help);
            }
        }
        let twin = |other: &MaterialPair| is_between(other, &pair.between[0], &pair.between[1]);
        if let Some(twin) = grains.pairs[..i].iter().position(twin) {
            report.problem(
                &path,
                format!("grains.pairs[{twin}] is of the same two materials"),
                "give all that holds between them in one place",
            );
        }
    }
}

fn is_between(pair: &MaterialPair, a: &str, b: &str) -> bool {
    let [one, other] = &pair.between;
    (one == a && other == b) || (one == b && other == a)
}

/// How two things rub, rebound and stick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rub {
    pub friction: f64,
    pub rolling_friction: f64,
    pub restitution: f64,
    /// N.
    pub cohesion: f64,
}

impl Rub {
    /// Of a material, where what it leaves out is as in `self`.
    fn of(self, material: &GrainMaterial) -> Self {
        Self {
            friction: material.friction.unwrap_or(self.friction),
            rolling_friction: material.rolling_friction.unwrap_or(self.rolling_friction),
            restitution: material.restitution.unwrap_or(self.restitution),
            cohesion: material.cohesion.unwrap_or(self.cohesion),
        }
    }

    /// Where a pair of materials is described.
    fn between(self, pair: &MaterialPair) -> Self {
        Self {
            friction: pair.friction.unwrap_or(self.friction),
            rolling_friction: pair.rolling_friction.unwrap_or(self.rolling_friction),
            restitution: pair.restitution.unwrap_or(self.restitution),
            cohesion: pair.cohesion.unwrap_or(self.cohesion),
        }
    }

    /// Geometric means.
    fn mean(self, other: Self) -> Self {
        let mean = |a: f64, b: f64| (a * b).sqrt();
        Self {
            friction: mean(self.friction, other.friction),
            rolling_friction: mean(self.rolling_friction, other.rolling_friction),
            restitution: mean(self.restitution, other.restitution),
            cohesion: mean(self.cohesion, other.cohesion),
        }
    }
}

/// Materials besides `grains`, and pairs.
#[derive(Debug, Clone, PartialEq)]
pub struct Materials {
    all: Vec<GrainMaterial>,
    pairs: Vec<MaterialPair>,
}

impl Materials {
    pub fn new(grains: &Grains) -> Self {
        Self {
            all: grains.materials.clone(),
            pairs: grains.pairs.clone(),
        }
    }

    /// `grains` included.
    pub fn count(&self) -> usize {
        1 + self.all.len()
    }

    /// The material of this number, unless it is that of `grains`.
    pub fn get(&self, number: usize) -> Option<&GrainMaterial> {
        self.all.get(number.checked_sub(1)?)
    }

    fn name(&self, number: usize) -> &str {
        self.get(number).map_or(OWN, |material| &material.name)
    }

    fn pair(&self, a: usize, b: usize) -> Option<&MaterialPair> {
        let (a, b) = (self.name(a), self.name(b));
        self.pairs.iter().find(|pair| is_between(pair, a, b))
    }

    /// Of two grains; `own` is that of `grains`.
    pub fn of_grains(&self, own: Rub, a: usize, b: usize) -> Rub {
        let [one, other] = [a, b].map(|number| self.get(number).map_or(own, |material| own.of(material)));
        let mean = if a == b { one } else { one.mean(other) };
        self.pair(a, b).map_or(mean, |pair| mean.between(pair))
    }

    /// Of a grain of material `a` and a wall of material `b`; `own` is that of grains of `grains` and their walls.
    pub fn at_wall(&self, own: Rub, a: usize, b: usize) -> Rub {
        let of_grain = self.get(a).map_or(own, |material| own.of(material));
        let of_wall = self.get(b).map_or(of_grain, |material| of_grain.of(material));
        self.pair(a, b).map_or(of_wall, |pair| of_wall.between(pair))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    const OWN_RUB: Rub = Rub {
        friction: 0.4,
        rolling_friction: 0.1,
        restitution: 0.5,
        cohesion: 0.0,
    };

    #[test]
    fn a_pair_holds_before_materials() {
        let grains: Grains = serde_json::from_value(json!({
            "radius": 1, "law": "linear",
            "materials": [{ "name": "ice", "friction": 0.1 }, { "name": "rubber", "friction": 0.9 }],
            "pairs": [{ "between": ["rubber", "ice"], "restitution": 0.2 }]
        }))
        .unwrap();
        let materials = Materials::new(&grains);
        assert_eq!(materials.of_grains(OWN_RUB, 0, 0), OWN_RUB);
        assert!((materials.of_grains(OWN_RUB, 0, 1).friction - 0.2).abs() < 1e-12);
        // A wall's material alone says how grains rub on it.
        assert_eq!(materials.at_wall(OWN_RUB, 0, 2).friction, 0.9);
        assert_eq!(materials.at_wall(OWN_RUB, 1, 0).friction, 0.1);
        for both in [
            materials.of_grains(OWN_RUB, 1, 2),
            materials.at_wall(OWN_RUB, 1, 2),
        ] {
            assert_eq!(both.restitution, 0.2);
        }
        assert!((materials.of_grains(OWN_RUB, 2, 1).friction - 0.3).abs() < 1e-12);
    }
}
