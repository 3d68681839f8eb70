//! The passes that make a picture's water, behind those that draw the rest of the scene.

use super::picture::Picture;
use super::stages::{Maker, Placed, STRIP, TRIANGLES, Target, dispatch, draw_all};
use super::water::SMOOTHING_PASSES;
use crate::error::Result;
use crate::gpu::{Blend, Pass};

pub struct WaterStages {
    shadow: (wgpu::TextureView, [Placed; 1]),
    surface: (wgpu::TextureView, [Placed; 1]),
    /// Where the surface is a mesh.
    normal: Option<wgpu::TextureView>,
    thickness: (wgpu::TextureView, [Placed; 1]),
    find_surface: Pass,
    smooth: Vec<Pass>,
    paint_behind: Pass,
    resolve: Pass,
}

impl WaterStages {
    pub fn new(maker: &Maker, is_mesh: bool) -> Result<Self> {
        let splats =
            |label: &str, blend| -> Result<[Placed; 1]> { Ok([(maker.draw(label, STRIP, blend)?, 4, None)]) };
        let added = Some(Blend::Add);
        let mut smooth = Vec::new();
        let passes = if is_mesh { &[][..] } else { &SMOOTHING_PASSES };
        for (index, entry) in passes.iter().enumerate() {
            smooth.push(match index % 2 {
                0 => maker.compute(entry)?,
                _ => maker.flipped(entry)?,
            });
        }
        Ok(Self {
            shadow: (maker.view("water_shadow"), splats("place_water_shadow", added)?),
            surface: (
                maker.view("water_depth"),
                match is_mesh {
                    true => [(maker.mark("place_water_mesh", TRIANGLES)?, 0, Some(1))],
                    false => splats("place_water_surface", None)?,
                },
            ),
            normal: is_mesh.then(|| maker.view("water_normal")),
            thickness: (
                maker.view("water_thickness"),
                match is_mesh {
                    true => [(maker.draw("place_water_chord", TRIANGLES, added)?, 0, Some(1))],
                    false => splats("place_water_thickness", added)?,
                },
            ),
            find_surface: maker.compute("find_water_surface")?,
            smooth,
            paint_behind: maker.compute("paint_behind")?,
            resolve: maker.compute("resolve_water")?,
        })
    }

    /// What draws the surface, and what it encloses.
    pub fn of_surface(&mut self) -> [&mut Placed; 2] {
        [&mut self.surface.1[0], &mut self.thickness.1[0]]
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
        let target = match &self.normal {
            Some(normal) => Target::Both(normal, view),
            None => Target::Depth(view),
        };
        draw_all(encoder, "draw_water_surface", target, draws, picture.count);
        dispatch(encoder, &self.find_surface, samples);
        for pass in &self.smooth {
            dispatch(encoder, pass, samples);
        }
        dispatch(encoder, &self.paint_behind, pixels);
        dispatch(encoder, &self.resolve, pixels);
    }
}
