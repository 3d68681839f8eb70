//! The folder that `--out` names.

use std::path::{Path, PathBuf};

use image::RgbaImage;

#[cfg(feature = "plots")]
use super::charts;
use super::{Found, json, tables};
use crate::cli::grid;
use crate::error::{Error, Result};
use crate::output::{encode_png, write_file};
use crate::scene::Scene;
use crate::scene::model::Addressing;

pub struct Files {
    folder: PathBuf,
}

const JSON: &str = "occupancy.json";
const TABLES: &str = "occupancy.md";
const PROFILE: &str = "slice_profile.png";
const SLICES: &str = "slices.png";
const OVER_TIME: &str = "over_time.png";

fn heatmap(grid: &str) -> String {
    format!("heatmap_{grid}.png")
}

impl Files {
    /// Refuses, before anything is computed, what would be overwritten.
    pub fn open(folder: &Path, grids: &[Scene], over_time: bool, force: bool) -> Result<Self> {
        let mut names = vec![JSON.to_owned(), TABLES.into(), PROFILE.into()];
        names.extend(grids.iter().map(|scene| heatmap(&grid::name(&scene.neighbors))));
        if grids
            .iter()
            .any(|scene| scene.neighbors.addressing == Addressing::Sliced)
        {
            names.push(SLICES.into());
        }
        if over_time {
            names.push(OVER_TIME.into());
        }
        let there: Vec<_> = names
            .into_iter()
            .filter(|name| folder.join(name).exists())
            .collect();
        if !there.is_empty() && !force {
            return Err(Error::usage(
                format!("{} already holds {}", folder.display(), there.join(", ")),
                "choose another folder with --out, or replace them with --force",
            ));
        }
        std::fs::create_dir_all(folder).map_err(|reason| {
            Error::file(
                folder,
                "create",
                reason,
                "choose a folder that you may write with --out",
            )
        })?;
        Ok(Self {
            folder: folder.to_owned(),
        })
    }

    pub fn write(&self, found: &Found) -> Result<()> {
        let at = |name: &str| self.folder.join(name);
        let json = format!("{:#}\n", json::report(found));
        write_file(&at(JSON), json.as_bytes())?;
        write_file(&at(TABLES), tables::report(found, true).to_markdown().as_bytes())?;
        #[cfg(feature = "plots")]
        {
            charts::slice_profile(found).save(&at(PROFILE))?;
            if !found.subject.over_time.is_empty() {
                charts::over_time(found).save(&at(OVER_TIME))?;
            }
        }
        let picture = |name: &str, image: &Option<RgbaImage>| match image {
            Some(image) => write_file(&at(name), &encode_png(image.clone(), &at(name))?),
            None => Ok(()),
        };
        for one in &found.grids {
            picture(&heatmap(&one.name), &one.heatmap)?;
        }
        let boxes = found.grids.iter().find(|one| one.boxes.is_some());
        boxes.map_or(Ok(()), |one| picture(SLICES, &one.boxes))
    }
}
