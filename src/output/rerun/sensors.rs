//! What sensors find, as curves: one plot for each quantity.

use super::series::Curves;
use crate::output::sensors::{curve_name, curves};
use crate::scene::Scene;
use crate::simulation::Sample;

/// The quantities of a scene's sensors, profiles apart, each with its unit.
pub fn quantities(scene: &Scene) -> Vec<(&'static str, &'static str)> {
    let mut all: Vec<_> = curves(scene)
        .into_iter()
        .map(|(_, _, output)| (output.quantity, output.unit))
        .collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// The curves of one sample, by the entity of each quantity.
pub fn curves_of(scene: &Scene, sample: &Sample) -> Vec<Curves> {
    let columns = curves(scene);
    let mut values = Vec::new();
    for (place, (number, ..)) in columns.iter().enumerate() {
        let before = columns[..place].iter().filter(|(other, ..)| other == number);
        values.push(sample.values[*number][before.count()]);
    }
    let of = |(quantity, _): (&'static str, _)| {
        let found = columns
            .iter()
            .zip(&values)
            .filter(|((_, _, output), _)| output.quantity == quantity);
        Curves {
            group: format!("sensors/{quantity}"),
            values: found
                .map(|((_, sensor, output), value)| (curve_name(sensor, output), *value))
                .collect(),
        }
    };
    quantities(scene).into_iter().map(of).collect()
}
