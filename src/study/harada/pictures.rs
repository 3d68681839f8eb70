//! Figures 2 and 7: what the grid gives memory to, and the memory itself.

use std::rc::Rc;

use super::drops::{Drop, State};
use crate::error::Result;
use crate::output::text::count;
use crate::output::{encode_png, write_file};
use crate::scene::Scene;
use crate::scene::model::View;
use crate::study::bench::Bench;
use crate::study::page::Page;
use crate::study::scenes;

/// The paper's grid: the one that has slices to draw and a pool to look at.
const SLICED: &str = "sliced-pool";

fn picture(
    page: &mut Page,
    bench: &Bench,
    scene: &Scene,
    view: View,
    file: &str,
    caption: &str,
) -> Result<()> {
    let mut scene = scenes::with_grid(scene, SLICED)?;
    // It would tell the time since this state.
    scene.render.show.caption = false;
    match bench.picture(&scene, view, 0)? {
        Some(picture) => page.picture(file, caption, |path| {
            write_file(path, &encode_png(picture, path)?)
        }),
        None => unreachable!("a scene with a view has pictures"),
    }
}

pub fn figure_2(page: &mut Page, bench: &Bench, drop: &Drop) -> Result<()> {
    page.heading("Figure 2: the voxels that have memory");
    page.paragraph(
        "A uniform grid has memory for all within the red lines, the sliced grid for the green boxes. Seen along z; grains \
         by speed.",
    );
    bench.tell("harada: pictures");
    for (k, state) in [&drop.first, &drop.widest, &drop.last].into_iter().enumerate() {
        let caption = format!(
            "{} grains at {:.3} s.",
            count(drop.scene.capacity.into()),
            state.time
        );
        let file = format!("harada_figure_2_{}.png", ["first", "widest", "last"][k]);
        picture(page, bench, &drop.at(state), View::Scene, &file, &caption)?;
    }
    Ok(())
}

pub fn figure_7(page: &mut Page, bench: &Bench, drops: &[Rc<Drop>]) -> Result<()> {
    page.heading("Figure 7: the index pool");
    page.paragraph(
        "Two scenes, each beside its pool, one texel per voxel in the order of memory. Black voxels are empty; red, yellow \
         and white ones hold one, two and three grains, as in the paper; other colors are ours. The paper's scenes are \
         fluids; ours are the largest block, whose pool is nearly full, and one that has spread, with a surface \
         that leaves voxels empty.",
    );
    let dense: (&Drop, &State) = (&drops[3], &drops[3].widest);
    let spread: (&Drop, &State) = (&drops[1], &drops[1].widest);
    for (file, (drop, state)) in [("dense", dense), ("spread", spread)] {
        let mut scene = drop.at(state);
        scene.render.size = [1280, 720];
        let caption = format!(
            "{} grains at {:.3} s, and the pool.",
            count(drop.scene.capacity.into()),
            state.time
        );
        picture(
            page,
            bench,
            &scene,
            View::Both,
            &format!("harada_figure_7_{file}.png"),
            &caption,
        )?;
    }
    Ok(())
}
