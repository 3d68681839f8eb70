//! Figure 5: construction on the device against construction by the processor's threads.

use std::rc::Rc;
use std::time::Instant;

use super::Scale;
use super::drops::Drop;
use super::times::AllTimes;
use crate::error::Result;
use crate::gpu::timing::median;
use crate::output::plot::Plot;
use crate::study::bench::Bench;
use crate::study::cpu_grid::{Addressing, CpuGrid, Storage};
use crate::study::page::{Cell, Page, Table};

const GRIDS: [(&str, Addressing, Storage); 4] = [
    ("uniform-pool", Addressing::Uniform, Storage::Pool(4)),
    ("sliced-pool", Addressing::Sliced, Storage::Pool(4)),
    ("uniform-counting", Addressing::Uniform, Storage::Counting),
    ("sliced-counting", Addressing::Sliced, Storage::Counting),
];

pub fn figure_5(
    page: &mut Page,
    bench: &Bench,
    scale: &Scale,
    drops: &[Rc<Drop>],
    times: &AllTimes,
) -> Result<()> {
    page.heading("Figure 5: construction on the device and on the processor");
    page.paragraph(format!(
        "The same states as in Table 2. The processor builds the same grids with all of its {} threads (rayon: \
         bounding boxes, counts, prefix sum, scatter, state into voxel order), buffers kept from build to build; \
         medians of {} builds. On a software adapter both sides run on the same processor.",
        rayon::current_num_threads(),
        scale.cpu_rounds
    ));
    bench.tell("harada: construction on the processor");
    let mut table = Table::new([
        "grid",
        "grains",
        "device, ms",
        "processor, ms",
        "processor / device",
    ]);
    let mut plot = Plot::new("Construction", "grains", "ms").log_x().log_y();
    for (name, addressing, storage) in GRIDS {
        let (mut device_points, mut cpu_points) = (Vec::new(), Vec::new());
        for (drop, times) in drops.iter().zip(times) {
            let particles = &drop.widest.particles;
            let mut grid = CpuGrid::new(&drop.scene, addressing, storage);
            grid.build(particles);
            let time = |_| {
                let start = Instant::now();
                grid.build(particles);
                start.elapsed().as_secs_f64() * 1e3
            };
            let cpu = median((0..scale.cpu_rounds).map(time).collect());
            let found = times.iter().find(|(grid, _)| grid == name);
            let device = found.and_then(|(_, o)| o.as_ref().ok()).map(|t| t.build_ms);
            let grains = f64::from(drop.scene.capacity);
            cpu_points.push((grains, cpu));
            device_points.extend(device.map(|ms| (grains, ms)));
            table.row([
                Cell::text(format!("`{name}`")),
                Cell::count(drop.scene.capacity.into()),
                Cell::maybe(device),
                Cell::number(cpu),
                Cell::maybe(device.map(|ms| cpu / ms)),
            ]);
        }
        plot = plot
            .series(format!("{name}, device"), device_points)
            .series(format!("{name}, processor"), cpu_points);
    }
    page.table("figure_5", &table);
    page.picture(
        "harada_figure_5.png",
        "Construction, device and processor.",
        |path| plot.save(path),
    )
}
