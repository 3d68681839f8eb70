//! The only user of wgpu: device, composed and reflected shaders, named buffers, passes, timing, readback.
//!
//! The host never writes a binding number, a bind group layout or a workgroup size: a [`Pass`] reads them from its
//! shader and binds each buffer by the name that it has everywhere.

pub mod binding;
pub mod buffers;
pub mod compose;
pub mod device;
pub mod draw;
pub mod driver;
mod fault;
mod kernels;
pub mod limits;
pub mod parts;
pub mod pass;
pub mod readback;
pub mod reflect;
pub mod shared;
pub mod timing;
pub mod work;

pub use buffers::Buffers;
pub use compose::Variant;
pub use device::{AdapterChoice, Gpu};
pub use draw::{Blend, Draw, DrawStyle};
pub use kernels::Kernels;
pub use limits::{Demand, Limits};
pub use parts::{BufferPlan, Contents, DISPATCHES, Items, Over, PassPlan, Repeat};
pub use pass::{Groups, Kernel, Pass};
pub use reflect::Shader;
pub use work::Work;
