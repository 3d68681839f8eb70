//! The passes that make a picture's water, behind those that draw the rest of the scene.

use super::picture::Picture;
use super::stages::{Maker, Placed, STRIP, Target, dispatch, draw_all};
use super::water::SMOOTHING_PASSES;
use crate::error::Result;
use crate::gpu::{Blend, Pass};

pub struct WaterStages {
    shadow: (wgpu::TextureView, [Placed; 1]),
    surface: (wgpu::TextureView, [Placed; 1]),
    thickness: (wgpu::TextureView, [Placed; 1]),
    find_surface: Pass,
    smooth: Vec<Pass>,
    paint_behind: Pass,
    resolve: Pass,
}

impl WaterStages {
    pub fn new(maker: &Maker) -> Result<Self> {
        let splats =
            |label: &str, blend| -> Result<[Placed; 1]> { Ok([(maker.draw(label, STRIP, blend)?, 4, None)]) };
        let added = Some(Blend::Add);
        let mut smooth = Vec::new();
        for (index, entry) in SMOOTHING_PASSES.iter().enumerate() {
            smooth.push(match index % 2 {
                0 => maker.compute(entry)?,
                _ => maker.flipped(entry)?,
            });
        }
        Ok(Self {
            shadow: (maker.view("water_shadow"), splats("place_water_shadow", added)?),
            surface: (maker.view("water_depth"), splats("place_water_surface", None)?),
            thickness: (
                maker.view("water_thickness"),
                splats("place_water_thickness", added)?,
            ),
            find_surface: maker.compute("find_water_surface")?,
            smooth,
            paint_behind: maker.compute("paint_behind")?,
            resolve: maker.compute("resolve_water")?,
        })
    }

    pub fn encode(&self, encoder: &mut wgpu::CommandEncoder, picture: &Picture) {
        let [_, _, width, height] = picture.rectangle;
        let pixels = width * height;
        let samples = pixels * picture.antialias * picture.antialias;
        for (label, (view, draws)) in [
            ("cast_water_shadow", &self.shadow),
            ("add_water_thickness", &self.thickness),
        ] {
            draw_all(encoder, label, Target::Color(view), draws, picture.count);
        }
        let (view, draws) = &self.surface;
        draw_all(
            encoder,
            "draw_water_surface",
            Target::Depth(view),
            draws,
            picture.count,
        );
        dispatch(encoder, &self.find_surface, samples);
        for pass in &self.smooth {
            dispatch(encoder, pass, samples);
        }
        dispatch(encoder, &self.paint_behind, pixels);
        dispatch(encoder, &self.resolve, pixels);
    }
}
