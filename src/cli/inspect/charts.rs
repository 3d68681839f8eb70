//! What was found, as charts.

use super::Found;
use crate::neighbors::ADDRESSINGS;
use crate::neighbors::occupancy::Slice;
use crate::output::plot::Plot;

/// Voxels and particles of each slice.
pub fn slice_profile(found: &Found) -> Plot {
    let census = &found.subject.census;
    let slices = census.slices();
    // From one below the first slice with particles to one above the last.
    let holds = |slice: &&Slice| slice.figures.particles > 0;
    let first = slices.iter().find(holds).map_or(0, |slice| slice.at - 1);
    let last = slices.iter().rfind(holds).map_or(0, |slice| slice.at + 1);
    let along = |of: &dyn Fn(&Slice) -> u64| {
        let shown = slices.iter().filter(|slice| (first..=last).contains(&slice.at));
        shown
            .map(|slice| (f64::from(slice.at), of(slice) as f64))
            .collect::<Vec<_>>()
    };
    let mut lines = Lines::default();
    for (index, name) in addressings(found) {
        let one = &found.grids[index];
        if one.slices.is_some() {
            let voxels = |slice: &Slice| one.in_slice(slice.at).unwrap_or(0);
            lines.add(format!("voxels of {name}"), along(&voxels));
        }
    }
    lines.add("occupied voxels", along(&|slice| slice.figures.occupied));
    lines.add("particles", along(&Slice::particles));
    if !found.subject.scene.boundary.is_empty() {
        lines.add("boundary particles", along(&|slice| slice.boundary));
    }
    let axis = ["x", "y", "z"][census.grid.axis as usize];
    lines.onto(Plot::new(
        format!("Slices of {}", title(found)),
        format!("slice along {axis}, counted from the domain's lower side"),
        "voxels with memory, particles",
    ))
}

/// Voxels over time, after Harada 2007, Figure 6.
pub fn over_time(found: &Found) -> Plot {
    let domain = found.subject.census.grid.domain_voxels() as f64;
    let samples = &found.subject.over_time;
    let share = |of: &dyn Fn(usize) -> u64| {
        let at = |i: usize| (samples[i].time, 100.0 * of(i) as f64 / domain);
        (0..samples.len()).map(at).collect::<Vec<_>>()
    };
    let mut lines = Lines::default();
    for (index, name) in addressings(found) {
        lines.add(name, share(&|i| samples[i].grids[index].0));
    }
    lines.add("octree, leaves and nodes", share(&|i| samples[i].octree.nodes()));
    lines.add(
        "occupied, the octree's leaves",
        share(&|i| samples[i].octree.leaves),
    );
    lines.onto(Plot::new(
        format!("Voxels with memory, {}", found.subject.scene.name),
        "time, s",
        "% of the domain's voxels",
    ))
}

/// Lines of a chart. Those that would hide each other are one line with both names.
#[derive(Default)]
struct Lines(Vec<(String, Vec<(f64, f64)>)>);

impl Lines {
    fn add(&mut self, name: impl Into<String>, points: Vec<(f64, f64)>) {
        let name = name.into();
        match self.0.iter_mut().find(|(_, known)| *known == points) {
            Some((names, _)) => *names += &format!(" = {name}"),
            None => self.0.push((name, points)),
        }
    }

    fn onto(self, plot: Plot) -> Plot {
        let add = |plot: Plot, (name, points)| plot.series(name, points);
        self.0.into_iter().fold(plot, add)
    }
}

fn title(found: &Found) -> String {
    let subject = &found.subject;
    match subject.simulated {
        true => format!("{}, t = {:.3} s", subject.scene.name, subject.time),
        false => subject.scene.name.clone(),
    }
}

/// The first grid of each addressing, and the addressing's name: storages do not change which voxels have memory.
fn addressings(found: &Found) -> impl Iterator<Item = (usize, &'static str)> {
    ADDRESSINGS.iter().filter_map(|row| {
        let index = found.grids.iter().position(|one| one.addressing == row.kind)?;
        Some((index, row.name))
    })
}
