//! `sliceflow plan`

use std::fmt;

use serde_json::{Value, json};

use super::device_args::DeviceArgs;
use super::plan_error::ErrorArgs;
use super::plan_measure::Estimate;
use super::run_args::RunArgs;
use super::table::Align::{Left, Right};
use super::table::Table;
use super::{grid, stdout};
use crate::error::Result;
use crate::gpu::device::{self, describe};
use crate::gpu::{AdapterChoice, Gpu, Limits};
use crate::output::text::{bytes, count};
use crate::output::{Checkpoints, Outputs, checkpoint_estimate, disk_bytes};
use crate::plan::{Phase, Plan};
use crate::scene::Scene;
use crate::scene::fluid::Fluid;
use crate::scene::model::FluidSolver;
use crate::scene::text::number;

/// Says what a run would do: buffers, passes, time step, memory, disk
///
/// Nothing is simulated, except a few seconds with --measure. On a machine without an adapter, the plan is made for what
/// WebGPU promises everywhere.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    run: RunArgs,
    #[command(flatten)]
    device: DeviceArgs,
    #[command(flatten)]
    error: ErrorArgs,
    /// Estimates the run's time from some seconds of it, without writing anything
    #[arg(long, conflicts_with = "error")]
    measure: bool,
    /// Prints JSON
    #[arg(long)]
    json: bool,
}

/// What a scene may take while it is only looked at, bytes, unless the user allows more: an answer comes within seconds.
pub const MEMORY: u64 = 500_000_000;

const EXAMPLES: &str = "\
Examples:
  sliceflow plan green_cube
  sliceflow plan harada_figure_2 --grid sliced-pool --view both
  sliceflow plan my_scene.json --measure
  sliceflow plan my_dam.json --error 2%
  sliceflow plan my_scene.json --json | jq '.plan.buffers[].name'";

pub fn main(args: &Args) -> Result<()> {
    let scene = args.run.load((!args.measure).then_some(MEMORY))?;
    if let Some(proposal) = args.error.proposal(&scene)? {
        return match args.json {
            true => stdout::print_json(&proposal.json()),
            false => stdout::print(&proposal.to_string()),
        };
    }
    let adapter = args.device.adapter();
    let outputs = args.run.outputs()?.of(&scene);
    let mut report = Report::new(&scene, &outputs, &adapter)?;
    if args.measure {
        report.estimate = Some(Estimate::new(&scene, &outputs, &adapter)?);
    }
    if args.json {
        stdout::print_json(&report.json())
    } else {
        stdout::print(&report.to_string())
    }
}

/// A plan with what it is made for.
pub struct Report<'a> {
    scene: &'a Scene,
    plan: Plan,
    /// `None`: the machine has none.
    adapter: Option<String>,
    limits: Limits,
    disk_bytes: u64,
    checkpoints: Checkpoints,
    /// How many stay at most, and the bytes of one.
    checkpoint_estimate: (u32, u64),
    /// Of the run's time, where it is asked for.
    estimate: Option<Estimate>,
}

impl<'a> Report<'a> {
    pub fn new(scene: &'a Scene, outputs: &Outputs, choice: &AdapterChoice) -> Result<Self> {
        let (adapter, limits) = if *choice == AdapterChoice::Best && device::adapters().is_empty() {
            (None, Limits::PROMISED.lowered_by_environment()?)
        } else {
            let gpu = Gpu::open(choice, false)?;
            (Some(describe(&gpu.adapter)), gpu.limits)
        };
        Ok(Self {
            scene,
            plan: Plan::new(scene, &limits, &outputs.wanted(scene))?,
            adapter,
            limits,
            disk_bytes: disk_bytes(scene, outputs),
            checkpoints: outputs.checkpoints,
            checkpoint_estimate: checkpoint_estimate(scene, outputs),
            estimate: None,
        })
    }

    fn steps(&self) -> u64 {
        let time = &self.scene.time;
        u64::from(time.frames.saturating_sub(1)) * u64::from(time.steps_per_frame)
    }

    fn largest_buffer(&self) -> u64 {
        self.plan
            .buffers
            .iter()
            .map(|buffer| buffer.bytes)
            .max()
            .unwrap_or(0)
    }

    fn json(&self) -> Value {
        let Self { scene, limits, .. } = self;
        json!({
            "scene": scene.name,
            "adapter": self.adapter,
            "limits": limits,
            "storage_buffers": self.plan.most_storage_buffers().1,
            "dimensions": scene.dimensions.count(),
            "particles_at_start": scene.particles.len(),
            "particles": scene.first_boundary(),
            "boundary_particles": scene.boundary.len(),
            "solver": scene.fluid().map(|fluid| fluid.solver),
            "solver_reason": scene.fluid().map(solver),
            "grid": grid::name(&scene.neighbors),
            "frames": scene.time.frames,
            "fps": scene.time.fps,
            "step_s": scene.time.step,
            "step_limited_by": scene.time.limited_by,
            "step_adaptive": scene.time.adaptive.is_some(),
            "contact_duration_s": scene.time.contact_duration,
            "steps_per_frame": scene.time.steps_per_frame,
            "steps": self.steps(),
            "memory_bytes": self.plan.bytes(),
            "disk_bytes_estimate": self.disk_bytes,
            "checkpoint_bytes": self.checkpoint_estimate.1,
            "checkpoints_kept": self.checkpoint_estimate.0,
            "measured": self.estimate.as_ref().map(|estimate| &estimate.measured),
            "notes": scene.notes,
            "plan": self.plan,
        })
    }
}

impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            scene, plan, limits, ..
        } = self;
        let time = &scene.time;
        let adapter = self
            .adapter
            .as_deref()
            .unwrap_or("none here; planned for what WebGPU promises everywhere");
        writeln!(f, "scene      {}, {}D", scene.name, scene.dimensions.count())?;
        let free = u64::from(scene.first_boundary());
        write!(f, "particles  {}", count(free))?;
        match scene.particles.len() as u64 {
            start if start == free => {}
            start => write!(f, " at the end, {} at the start", count(start))?,
        }
        match scene.boundary.len() as u64 {
            0 => writeln!(f)?,
            walls => writeln!(f, ", and {} boundary particles", count(walls))?,
        }
        let adaptive = time.adaptive.is_some();
        if let Some(fluid) = scene.fluid() {
            writeln!(f, "solver     {}", solver(fluid))?;
        }
        writeln!(f, "grid       {}", grid::name(&scene.neighbors))?;
        write!(
            f,
            "step       {}{:.4e} s, limited by the {}",
            if adaptive { "adaptive, about " } else { "" },
            time.step,
            time.limited_by
        )?;
        match time.contact_duration {
            Some(contact) => writeln!(f, "; the shortest contact lasts {contact:.4e} s")?,
            None => writeln!(f)?,
        }
        writeln!(
            f,
            "frames     {} at {} per simulated second, {}{} steps per frame, {} steps in all",
            count(time.frames.into()),
            time.fps,
            if adaptive { "about " } else { "" },
            count(time.steps_per_frame.into()),
            count(self.steps())
        )?;
        writeln!(f, "adapter    {adapter}")?;
        writeln!(
            f,
            "memory     {}; the largest buffer has {} of the {} that the adapter binds",
            bytes(plan.bytes()),
            bytes(self.largest_buffer()),
            bytes(limits.binding)
        )?;
        let (label, most) = plan.most_storage_buffers();
        writeln!(
            f,
            "bindings   at most {} storage buffers in a pass ({label}); the adapter allows {}",
            count(most.into()),
            count(limits.storage_buffers.into())
        )?;
        let (stay, each) = self.checkpoint_estimate;
        write!(f, "disk       about {}", bytes(self.disk_bytes))?;
        if stay > 0 {
            write!(
                f,
                ", with checkpoints of {} {} (the newest {} stay)",
                bytes(each),
                self.checkpoints.every,
                count(stay.into())
            )?;
        }
        writeln!(f)?;
        if let Some(estimate) = &self.estimate {
            write!(f, "{estimate}")?;
        }

        let mut buffers = Table::new([("buffer", Left), ("size", Right), ("why", Left)]);
        for buffer in &plan.buffers {
            buffers.row([buffer.name.clone(), bytes(buffer.bytes), buffer.why.clone()]);
        }
        let mut textures = Table::new([
            ("texture", Left),
            ("size", Right),
            ("pixels", Right),
            ("why", Left),
        ]);
        for texture in &plan.textures {
            let [width, height] = texture.size;
            let pixels = format!("{width}×{height}");
            textures.row([
                texture.name.clone(),
                bytes(texture.bytes),
                pixels,
                texture.why.clone(),
            ]);
        }
        let mut passes = Table::new([
            ("pass", Left),
            ("when", Left),
            ("items", Right),
            ("buffers", Right),
            ("shader", Left),
            ("why", Left),
        ]);
        for row in &plan.passes {
            let pass = &row.pass;
            passes.row([
                pass.entry.clone(),
                when(row.phase).to_owned(),
                count(plan.most_items(pass.items, plan.capacity).into()),
                row.demand.storage_buffers.to_string(),
                pass.shader.clone(),
                pass.why.clone(),
            ]);
        }
        let mut draws = Table::new([
            ("draw", Left),
            ("buffers", Right),
            ("shader", Left),
            ("why", Left),
        ]);
        for draw in &plan.draws {
            let buffers = draw.demand.storage_buffers.to_string();
            draws.row([draw.label.clone(), buffers, draw.shader.clone(), draw.why.clone()]);
        }
        for table in [buffers, textures, passes, draws] {
            if !table.is_empty() {
                write!(f, "\n{table}")?;
            }
        }
        let mut notes = scene.notes.iter().chain(plan.told()).peekable();
        if notes.peek().is_none() {
            return Ok(());
        }
        for note in notes {
            write!(f, "\nnote: {note}")?;
        }
        writeln!(f)
    }
}

/// Which solver a fluid gets, and why.
fn solver(fluid: &Fluid) -> String {
    let sound = || {
        format!(
            "steps follow sound of {} m/s; `dfsph`, the default, takes longer ones",
            number(fluid.sound_speed)
        )
    };
    match fluid.solver {
        FluidSolver::Dfsph => {
            let viscosity = match fluid.implicit_viscosity {
                true => ", and viscosity is implicit, so neither does it shorten steps",
                false => "",
            };
            format!("dfsph, the default: incompressible, so steps follow motion and not sound{viscosity}")
        }
        FluidSolver::Wcsph => format!(
            "wcsph, which the scene asks for: weakly compressible, and {}; sound goes {} smoothing lengths in a step, and particles \
             see {} spacings far",
            sound(),
            number(fluid.sound_share()),
            number(fluid.support / fluid.spacing)
        ),
        FluidSolver::Sph => format!(
            "sph, which the scene asks for: compressible (Müller 2003), and {}",
            sound()
        ),
    }
}

fn when(phase: Phase) -> &'static str {
    match phase {
        Phase::Start => "at the start",
        Phase::Step => "each step",
        Phase::Observe => "each frame",
        Phase::Sample => "each sample",
    }
}
