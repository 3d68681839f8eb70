use crate::error::Result;
use crate::gpu::{Buffers, Gpu, Variant};
use crate::scene::{Scene, model::View};
use glam::Vec3;
pub struct Needs { pub buffers: Vec<(String, u64, String)>, pub textures: Vec<(String, u64, String, [u32;2])>, pub draws: Vec<(String, String, String)> }
pub fn needs(_scene: &Scene, _view: View) -> Needs { Needs{buffers: vec![], textures: vec![], draws: vec![]} }
pub struct Renderer;
impl Renderer {
  pub fn new(_gpu: &Gpu, _scene: &Scene, _variant: &Variant, _buffers: &mut Buffers, _view: View) -> Result<Self> { Ok(Self) }
  pub fn draw(&self, _gpu: &Gpu, _e: &mut wgpu::CommandEncoder, _count: u32, _time: f64, _offsets: &[Vec3]) -> Result<()> { Ok(()) }
}
