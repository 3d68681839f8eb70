//! A simulation's state between two frames: taken off the device, put back, and shown.
//!
//! The state is what the next step depends on and nothing else: the particles' buffers in the order of their slots
//! (which decides the order of sums, and so the bits), the clock and the overflow counter. The search is a function of
//! the positions, so it is made anew; gravity, contact law and obstacles are functions of the scene and the frame.

use glam::{DVec3, Vec3};

use super::segments::{happened, segments};
use super::{Frame, Simulation};
use crate::error::{Error, Result};
use crate::gpu::readback;
use crate::neighbors::layout::ListState;
use crate::neighbors::{Grid, lists};
use crate::physics::layout::{BodyState, Clock, Overflow, Packed, StepControl, packed};
use crate::scene::allowance::MOST_PARTICLES;
use crate::scene::field::{FIELDS, Field, Kind, Newcomers, contact_slots, contact_words};
use crate::scene::model::Axis;
use crate::scene::sizes::ROUNDED;
use crate::scene::{Action, Dimensions, Particles, Scene};

/// Frames and steps of any run; numbers stay far inside 32 bits.
const MOST_FRAMES: u32 = 1 << 21;
const MOST_STEPS: u32 = 1 << 31;

/// What the step after a frame depends on.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    pub frame: u32,
    /// Particles that exist.
    pub particles: u32,
    pub dimensions: Dimensions,
    /// Where local coordinates have their zero, in the scene's own coordinates, metres.
    pub origin: DVec3,
    /// Why neighbor lists had been left out, which changes the order of sums.
    pub lists_left_out: Option<String>,
    /// Name and bytes of device buffers, in a fixed order.
    pub buffers: Vec<(String, Vec<u8>)>,
}

impl State {
    /// The state of particles 0, 1, 2, … at `position` (the scene's coordinates, metres) with `velocity` (m/s), as a
    /// start for pictures and measures.
    pub fn of_particles(
        scene: &Scene,
        frame: u32,
        position: &[DVec3],
        velocity: &[Vec3],
        radius: Option<&[f32]>,
    ) -> Self {
        let local = position.iter().map(|&p| (p - scene.origin).as_vec3());
        let local: Vec<Vec3> = local.chain(scene.boundary.position.iter().copied()).collect();
        let velocity = [velocity, &scene.boundary.surface_velocity].concat();
        let walls = scene.first_boundary()..scene.capacity;
        let ids: Vec<u32> = (0..position.len() as u32).chain(walls).collect();
        let radius = radius.map(|radius| ("radius".to_owned(), bytemuck::cast_slice(radius).to_vec()));
        let always = [
            ("position".to_owned(), pack(&local)),
            ("velocity".to_owned(), pack(&velocity)),
            ("id".to_owned(), bytemuck::cast_slice(&ids).to_vec()),
        ];
        Self {
            frame,
            particles: ids.len() as u32,
            dimensions: scene.dimensions,
            origin: scene.origin,
            lists_left_out: None,
            buffers: always.into_iter().chain(radius).collect(),
        }
    }

    /// Whether a run of `scene` can go on from here: what is wrong where it cannot. A state comes from a file, and a file
    /// may say anything.
    pub fn check(&self, scene: &Scene) -> std::result::Result<(), String> {
        let wrong = |what: &str| Err(format!("does not fit the scene: {what}"));
        if self.dimensions != scene.dimensions {
            return wrong("it has another number of dimensions");
        }
        if self.frame >= scene.time.frames.max(MOST_FRAMES) {
            return wrong("no run has so many frames");
        }
        if !self.origin.is_finite() {
            return wrong("its origin is nowhere");
        }
        let walls = scene.boundary.len() as u64;
        if !(walls..=MOST_PARTICLES).contains(&u64::from(self.particles)) {
            return wrong("it has too few particles, or too many");
        }
        let mut names: Vec<&str> = self.buffers.iter().map(|(name, _)| name.as_str()).collect();
        names.sort_unstable();
        if names.windows(2).any(|pair| pair[0] == pair[1]) {
            return wrong("it has two buffers of one name");
        }
        if self.particles > 0
            && ["position", "velocity", "id"]
                .iter()
                .any(|name| !names.contains(name))
        {
            return wrong("it has no positions, velocities or ids");
        }
        for (name, bytes) in &self.buffers {
            let each = match name.as_str() {
                "clock" => Some((Clock::LAYOUT.size, 1)),
                "step_control" => Some((StepControl::LAYOUT.size, 1)),
                "overflow" => Some((Overflow::LAYOUT.size, 1)),
                "grid" => Some((Grid::LAYOUT.size, 1)),
                "body_state" => Some((BodyState::LAYOUT.size, scene.rigid_bodies.len())),
                name => {
                    // The scene's own first: contacts that remember more have a field of the same name.
                    let mut fields = scene.fields().chain(FIELDS);
                    let field = fields.find(|field| field.name == name);
                    field.map(|field| (field.kind.bytes(scene) as usize, self.particles as usize))
                }
            };
            match each {
                Some((size, count)) if size * count == bytes.len() => {}
                Some(_) => return wrong(&format!("`{name}` has {} bytes", bytes.len())),
                None => return wrong(&format!("particles have no `{name}`")),
            }
        }
        let mut ids = self.ids();
        ids.sort_unstable();
        let last = ids.last().copied().unwrap_or_default();
        if ids.windows(2).any(|pair| pair[0] == pair[1]) || u64::from(last) >= MOST_PARTICLES {
            return wrong("two particles have one id, or an id is too large");
        }
        let of_fluids = scene.fluid().map(|fluid| fluid.materials.len());
        let of_grains = scene.friction().map(|friction| friction.materials);
        let materials = of_fluids.or(of_grains).unwrap_or(1);
        let of: Vec<u32> = bytemuck::pod_collect_to_vec(self.buffer("material").unwrap_or_default());
        if scene.has_field("material") && of.iter().any(|&material| material as usize >= materials) {
            return wrong("a particle is of no material");
        }
        self.check_radii(scene)?;
        self.check_bodies(scene)?;
        let clock: Clock = self
            .buffer("clock")
            .map_or(Clock::default(), bytemuck::pod_read_unaligned);
        if clock.step > MOST_STEPS || clock.step_in_segment > MOST_STEPS {
            return wrong("no run has so many steps");
        }
        let grid: Grid = self
            .buffer("grid")
            .map_or(Grid::default(), bytemuck::pod_read_unaligned);
        if grid.axis > 2 {
            return wrong("its grid has no such axis");
        }
        let control = self
            .buffer("step_control")
            .map(bytemuck::pod_read_unaligned::<StepControl>);
        let is_sound = |control: StepControl| {
            let lengths = [control.tick, control.step, control.next_step, control.wanted];
            lengths.iter().all(|length| length.is_finite() && *length >= 0.0)
                && (control.limit as usize) < control.made.len()
                && control.stalled == 0
        };
        if !control.is_none_or(is_sound) {
            return wrong("its steps have no length");
        }
        Ok(())
    }

    /// Whether the scene's rigid bodies are those of the state: particles of the same ids.
    fn check_bodies(&self, scene: &Scene) -> std::result::Result<(), String> {
        if !self.is_in_slot_order() || scene.rigid_bodies.is_empty() {
            return Ok(());
        }
        let others = || Err("does not fit the scene: its rigid bodies are others".into());
        if scene.fluid().is_some() {
            // They are made of boundary particles, which states hold as the scene has them.
            return match self.buffer("body_state") {
                Some(_) => Ok(()),
                None => others(),
            };
        }
        let numbers = &scene.particles.body;
        let of = |id: u32| numbers.get(id as usize).copied().unwrap_or(0);
        let bodies: Vec<u32> = bytemuck::pod_collect_to_vec(self.buffer("body").unwrap_or_default());
        let ids = self.ids();
        let members = bodies.iter().filter(|&&body| body != 0).count();
        let is_same = bodies.len() == ids.len()
            && ids.iter().zip(&bodies).all(|(&id, &body)| of(id) == body)
            && members == numbers.iter().filter(|&&body| body != 0).count();
        match is_same && self.buffer("body_state").is_some() {
            true => Ok(()),
            false => others(),
        }
    }

    /// Whether all positions, velocities and accelerations are numbers, as in every state that a run has saved.
    pub fn is_finite(&self) -> bool {
        let vectors = ["position", "velocity", "acceleration"].map(|name| self.vectors(name));
        vectors
            .iter()
            .flatten()
            .flatten()
            .all(|vector| vector.is_finite())
    }

    /// Bytes of a buffer, if the state has it.
    pub fn buffer(&self, name: &str) -> Option<&[u8]> {
        let found = self.buffers.iter().find(|(known, _)| known == name);
        found.map(|(_, bytes)| bytes.as_slice())
    }

    /// Whether particles stand as a search left them, as in a run's own states, and not by id.
    fn is_in_slot_order(&self) -> bool {
        self.buffer("clock").is_some()
    }

    /// Steps since the run began.
    pub fn steps(&self) -> u64 {
        let clock = self.buffer("clock").map(bytemuck::pod_read_unaligned::<Clock>);
        clock.map_or(0, |clock| u64::from(clock.step))
    }

    /// A buffer of vectors, one a slot; z is 0 in 2D.
    pub fn vectors(&self, name: &str) -> Option<Vec<Vec3>> {
        let whole = self.buffer(name)?.chunks_exact(size_of::<Packed>());
        let stored: Vec<Packed> = whole.map(bytemuck::pod_read_unaligned).collect();
        Some(
            stored
                .into_iter()
                .map(|[x, y, z, _]| Vec3::new(x, y, z))
                .collect(),
        )
    }

    /// Each slot's particle.
    pub fn ids(&self) -> Vec<u32> {
        let whole = self.buffer("id").unwrap_or_default().chunks_exact(4);
        whole.map(bytemuck::pod_read_unaligned).collect()
    }

    /// The same state in coordinates that have their zero at `origin`.
    pub fn with_origin(mut self, origin: DVec3) -> Self {
        let moved = self.origin - origin;
        if let Some(positions) = self.vectors("position").filter(|_| moved != DVec3::ZERO) {
            let shifted: Vec<Vec3> = positions
                .iter()
                .map(|p| (p.as_dvec3() + moved).as_vec3())
                .collect();
            let position = self.buffers.iter_mut().find(|(name, _)| name == "position");
            position.expect("its vectors are there").1 = pack(&shifted);
        }
        let bodies = self.buffers.iter_mut().find(|(name, _)| name == "body_state");
        if let Some((_, bytes)) = bodies.filter(|_| moved != DVec3::ZERO) {
            let mut states: Vec<BodyState> = bytemuck::pod_collect_to_vec(bytes);
            for state in &mut states {
                let [x, y, z, mass] = state.center;
                let center = (Vec3::new(x, y, z).as_dvec3() + moved).as_vec3();
                state.center = center.extend(mass).into();
            }
            *bytes = bytemuck::cast_slice(&states).to_vec();
        }
        self.origin = origin;
        self
    }

    /// Particles that the device must have room for when a run of `scene` goes on from here.
    pub fn capacity(&self, scene: &Scene) -> u32 {
        let later = &scene.schedule[happened(scene, self.frame)..];
        let added: usize = later
            .iter()
            .map(|scheduled| match &scheduled.action {
                Action::Add(particles) => particles.len(),
                Action::SetParameters { .. } => 0,
            })
            .sum();
        self.particles + added as u32
    }
}

impl State {
    /// Radii are there where the scene's grains have some, and lie between the smallest and the largest.
    fn check_radii(&self, scene: &Scene) -> std::result::Result<(), String> {
        let wrong = |what: &str| Err(format!("does not fit the scene: {what}"));
        let sizes = scene.grains().filter(|grains| grains.sizes.is_some());
        match (self.buffer("radius"), sizes) {
            (None, None) => Ok(()),
            (Some(_), None) => wrong("its grains are of several sizes, and the scene has no grains.sizes"),
            (None, Some(_)) => match self.particles {
                0 => Ok(()),
                _ => wrong("its grains have no radii, and the scene's are of several sizes"),
            },
            (Some(bytes), Some(grains)) => {
                let radii: Vec<f32> = bytemuck::pod_collect_to_vec(bytes);
                let span = grains.smallest() * (1.0 - ROUNDED)..=grains.radius * (1.0 + ROUNDED);
                match radii.iter().all(|&radius| span.contains(&f64::from(radius))) {
                    true => Ok(()),
                    false => wrong("a grain is smaller or larger than grains.sizes allows"),
                }
            }
        }
    }
}

/// Bytes of a state with `particles` particles.
pub fn state_bytes(scene: &Scene, particles: u32) -> u64 {
    let each = saved(scene).map(|field| field.kind.bytes(scene));
    u64::from(particles) * each.sum::<u64>() + body_bytes(scene) as u64
}

/// Bytes of how rigid bodies move.
fn body_bytes(scene: &Scene) -> usize {
    BodyState::LAYOUT.size * scene.rigid_bodies.len()
}

/// Fields that a state holds.
fn saved(scene: &Scene) -> impl Iterator<Item = &Field> {
    scene.fields().filter(|field| field.saved)
}

/// What grains begin with of a field that the state of a scene without it lacks.
fn begun(field: &Field, state: &State) -> Option<Vec<u8>> {
    let free = Particles {
        position: state.vectors("position")?,
        velocity: state.vectors("velocity")?,
        ..Particles::default()
    };
    let newcomers = Newcomers {
        free: &free,
        boundary: &Particles::default(),
        ids: &state.ids(),
    };
    field.start.map(|start| start(&newcomers))
}

/// Vectors as `common/vector.wgsl` packs them.
fn pack(vectors: &[Vec3]) -> Vec<u8> {
    let stored: Vec<Packed> = vectors.iter().map(|&v| packed(v)).collect();
    bytemuck::cast_slice(&stored).to_vec()
}

/// Puts numbers beside stored vectors.
pub(super) fn put_beside(vectors: &mut [u8], numbers: &[u8]) {
    for (vector, number) in vectors.chunks_exact_mut(16).zip(numbers.chunks_exact(4)) {
        vector[12..].copy_from_slice(number);
    }
}

impl Simulation {
    /// The frame that [`Simulation::next_frame`] makes next.
    pub fn next_index(&self) -> u32 {
        self.next_frame
    }

    /// The state after the frame made last; waits for the device. Receive every frame under way first
    /// ([`Simulation::finish_frame`]), so that all of them are known to be sound.
    pub fn save_state(&self) -> Result<State> {
        let count = self.count as usize;
        let particles = saved(&self.scene).map(|field| {
            let bytes = field.kind.bytes(&self.scene) as usize;
            (field.name, bytes * count)
        });
        let counters = [
            ("clock", Clock::LAYOUT.size),
            ("step_control", StepControl::LAYOUT.size),
            ("overflow", Overflow::LAYOUT.size),
            ("grid", Grid::LAYOUT.size),
            ("body_state", body_bytes(&self.scene)),
        ];
        let mut buffers = Vec::new();
        for (name, bytes) in particles.chain(counters) {
            if self.buffers.contains(name) {
                let buffer = self.buffers.get(name, "(host)")?;
                let read = readback::read::<u8>(&self.gpu, buffer, bytes);
                let mut read = self.dated(self.next_frame.saturating_sub(1), read)?;
                self.clear_free_slots(name, &mut read);
                buffers.push((name.to_owned(), read));
            }
        }
        Ok(State {
            frame: self.next_frame.saturating_sub(1),
            particles: self.count,
            dimensions: self.scene.dimensions,
            origin: self.scene.origin,
            lists_left_out: self.plan.lists_left_out.clone(),
            buffers,
        })
    }

    /// Zeroes what stands behind the slots of contacts that are in use: it was left there by contacts that are no more.
    fn clear_free_slots(&self, field: &str, bytes: &mut [u8]) {
        let found = self.scene.fields().find(|known| known.name == field);
        let Some(Kind::Contacts { rolls }) = found.map(|field| field.kind) else {
            return;
        };
        let dimensions = self.scene.dimensions;
        let slot = 16 * contact_words(dimensions, rolls) as usize;
        for grain in bytes.chunks_exact_mut(slot * contact_slots(&self.scene) as usize) {
            let is_free = |slot: &[u8]| slot[12..16] == [0; 4];
            if let Some(used) = grain.chunks_exact(slot).position(is_free) {
                grain[slot * used..].fill(0);
            }
        }
    }

    /// Puts a state back: [`Simulation::next_frame`] then makes the frame after it. The scene may be another one
    /// than the state's, with the same number of dimensions and room for [`State::capacity`] particles.
    ///
    /// # Errors
    ///
    /// Where the state does not fit the scene or has more particles than there is room for.
    pub fn restore(&mut self, state: &State) -> Result<()> {
        let checked = state.check(&self.scene);
        let checked = checked.and_then(|()| match state.particles {
            needed if needed <= self.scene.capacity => Ok(()),
            needed => Err(format!(
                "needs room for {needed} particles, and the scene has {}",
                self.scene.capacity
            )),
        });
        checked.map_err(|what| {
            Error::usage(
                format!("the state of frame {} {what}", state.frame),
                "was it changed, or written by another run? start from another checkpoint, or begin a new run",
            )
        })?;
        self.next_frame = state.frame + 1;
        self.count = state.particles;
        self.happened = happened(&self.scene, state.frame);
        self.gravity = self.scene.gravity;
        self.matter = self.scene.matter.clone();
        for scheduled in &self.scene.schedule[..self.happened] {
            if let Action::SetParameters { gravity, matter } = &scheduled.action {
                self.gravity = *gravity;
                self.matter.clone_from(matter);
            }
        }
        let interval = state.frame.checked_sub(1);
        let last = interval.and_then(|interval| segments(&self.scene, interval).pop());
        if let Some(last) = &last {
            self.place_obstacles(last)?;
        }
        let steps = u64::from(state.frame) * u64::from(self.scene.time.steps_per_frame);
        let mut clock = Clock {
            step_in_segment: 0,
            step: steps as u32,
        };
        if let Some(bytes) = state.buffer("clock") {
            clock = bytemuck::pod_read_unaligned(bytes);
        }
        let counted = self.plan.obstacles.moving && self.scene.time.adaptive.is_none();
        if let (true, Some(last)) = (counted, last) {
            clock.step_in_segment = last.steps;
        }
        self.restored = (state.frame, clock.step);
        self.restore_step_control(state);
        self.submitted = u64::from(clock.step);
        self.last_look = clock.step;
        self.buffers.write(&self.gpu, "clock", 0, &[clock])?;
        if lists::wanted(&self.scene) {
            let lists = ListState {
                first_step: clock.step,
                last_step: clock.step,
                ..Default::default()
            };
            self.buffers.write(&self.gpu, "list_state", 0, &[lists])?;
        }
        // The search puts every particle where it stood, since it keeps the order inside a voxel.
        for field in self.scene.fields() {
            let stored = self.left_by_step(field, |name| Ok(state.buffer(name).map(<[u8]>::to_vec)))?;
            let begun = || self.scene.friction().and_then(|_| begun(field, state));
            self.put(&field.before_search(), stored.or_else(begun).as_deref())?;
        }
        if let (true, Some(why)) = (lists::can_be_left_out(&self.scene), &state.lists_left_out) {
            self.leave_lists_out(why.clone())?;
        }
        self.take_grid(state)?;
        if self.count > 0 {
            self.hold()?;
            self.search()?;
            self.settle()?;
        }
        // That the grid grew belongs to the frames before.
        self.reallocations = 0;
        // Accelerations belong to the velocities that the last step predicted, so the search cannot find them again. What
        // files hold by id, the search has put in its order already.
        if state.is_in_slot_order() {
            for field in saved(&self.scene) {
                self.put(field.name, state.buffer(field.name))?;
            }
        }
        self.restore_step_control(state);
        self.write_step_control()?;
        self.put("overflow", Some(bytemuck::bytes_of(&Overflow::default())))?;
        self.put("overflow", state.buffer("overflow"))?;
        self.put("body_state", state.buffer("body_state"))?;
        self.write_parameters(self.scene.time.step)
    }

    /// Takes the length of the last adaptive step; one that begins anew where the state has none.
    fn restore_step_control(&mut self, state: &State) {
        if let Some(limits) = &self.scene.time.adaptive {
            let speeds = state.vectors("velocity").unwrap_or_default();
            let fastest = speeds.iter().map(|v| v.length()).fold(0.0, f32::max);
            self.step_control = match state.buffer("step_control") {
                Some(bytes) => bytemuck::pod_read_unaligned(bytes),
                None => StepControl::new(limits, fastest),
            };
        }
    }

    /// Takes the room and the direction of the grid that the state was made with, so that it grows when that would
    /// have grown; a scene whose voxels are others keeps its own.
    fn take_grid(&mut self, state: &State) -> Result<()> {
        let Some(grid) = state.buffer("grid").map(bytemuck::pod_read_unaligned::<Grid>) else {
            return Ok(());
        };
        let axis = [Axis::X, Axis::Y, Axis::Z][grid.axis as usize];
        if grid == self.plan.grid || Grid::new(&self.scene, axis).with_room(grid.room()) != grid {
            return Ok(());
        }
        match self.plan.with_grid(&self.scene, &self.gpu.limits, grid) {
            Ok(plan) => self.rebuild(plan),
            // The state was made on an adapter that has more room.
            Err(Error::Limit { .. }) => Ok(()),
            Err(error) => Err(error),
        }
    }

    /// Has the present state observed and drawn once more, as frame `index`, and sends it on its way. Returns an older
    /// frame when enough are under way.
    pub fn show(&mut self, index: u32) -> Result<Option<Frame>> {
        let sent = self.send_frame(index);
        self.dated(index, sent)
    }

    /// What colors particles from now on, by id, where the scene's colors are [`crate::scene::column::Source::Given`].
    pub fn give_column(&self, values: &[f32]) -> Result<()> {
        self.put("given_column", Some(bytemuck::cast_slice(values)))
    }

    /// What the last step left of a field for a search, made from what buffers hold, which `read` gets by name. `None` where
    /// a buffer is not there.
    pub(super) fn left_by_step(
        &self,
        field: &Field,
        read: impl Fn(&str) -> Result<Option<Vec<u8>>>,
    ) -> Result<Option<Vec<u8>>> {
        if let Some((other, place)) = field.ends_in {
            let stored = read(other)?;
            return Ok(stored.map(|bytes| self.number_of(other, place, &bytes)));
        }
        let mut stored = read(field.name)?;
        let ends = self.scene.beside(field).and_then(|beside| beside.ends_in);
        if let (Some(vectors), Some((other, place))) = (&mut stored, ends)
            && let Some(bytes) = read(other)?
        {
            put_beside(vectors, &self.number_of(other, place, &bytes));
        }
        Ok(stored)
    }

    /// One number of a field's values, of all particles.
    fn number_of(&self, field: &str, place: usize, bytes: &[u8]) -> Vec<u8> {
        let found = self.scene.fields().find(|known| known.name == field);
        let found = found.expect("fields end in fields of the same scene");
        let width = found.kind.bytes(&self.scene) as usize;
        let each = bytes.chunks_exact(width).map(|value| &value[4 * place..][..4]);
        each.flatten().copied().collect()
    }

    /// Writes bytes to the beginning of a buffer, where both are there.
    fn put(&self, name: &str, bytes: Option<&[u8]>) -> Result<()> {
        match bytes {
            Some(bytes) if self.buffers.contains(name) => self.buffers.write(&self.gpu, name, 0, bytes),
            _ => Ok(()),
        }
    }
}
