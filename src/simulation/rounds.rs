//! Steps with neighbor lists. The host does not know when lists stop serving, and asking would stall the device; so it
//! records rounds of several steps and one search. The device leaves out what a round has too many of
//! (`shaders/storage/lists/decide.wgsl`), so how long rounds are changes no bit.

use super::Simulation;
use super::passes::Step;
use super::segments::Segment;
use crate::error::Result;
use crate::gpu::Items;
use crate::neighbors::layout::ListState;
use crate::neighbors::lists;

/// Steps from one search to the next, before anything is known.
pub(super) const USUAL_LIST_LIFETIME: f64 = 8.0;
/// Rounds have room for so many times the steps of a list's average lifetime: a step that is left out is cheaper than a
/// search that is.
const ROOM: f64 = 1.25;
/// Adaptive steps that are submitted before the host looks how long they are by then.
const MOST_AHEAD: u64 = 1024;

/// Where a field of [`ListState`] stands, in numbers of four bytes.
const LAST_STEP: usize = std::mem::offset_of!(ListState, last_step) / 4;

impl Simulation {
    /// Runs a segment to its end; where it is timed, the last two steps pass by pass. It stops where lists are left out
    /// on the way, behind the steps that were submitted.
    pub(super) fn run_listed_steps(&mut self, segment: &Segment, timed: bool) -> Result<()> {
        let before = self.searches[0];
        let (timed, first) = (if timed { 2 } else { 0 }, self.submitted);
        let fixed_end = self.submitted + u64::from(segment.steps);
        // Of adaptive steps nobody knows yet how many there will be.
        let left = |simulation: &Self| match simulation.scene.time.adaptive {
            Some(_) => simulation.step_control.steps_left().min(MOST_AHEAD),
            None => fixed_end - simulation.submitted,
        };
        while left(self) > timed {
            self.submit_steps(left(self) - timed)?;
            self.settle()?;
            if !lists::wanted(&self.scene) {
                return Ok(());
            }
        }
        let mut times = Vec::new();
        while left(self) > 0 {
            self.submitted += 1;
            self.begin_steps()?;
            let (step, search) = (self.time(&self.passes.step)?, self.time(&self.passes.start)?);
            self.settle()?;
            if !lists::wanted(&self.scene) {
                self.pass_ms = [step, search].concat();
                return Ok(());
            }
            times.push((step, search));
        }
        // The last step searches; the one before most likely does not, and then particles are taken back.
        if let (Some((kept, back)), Some((step, search))) = (times.first(), times.last()) {
            let steps = self.submitted - first;
            let share = f64::from(self.searches[0].wrapping_sub(before)) / steps as f64;
            let mixed = step
                .iter()
                .zip(kept)
                .map(|((label, ms), (_, kept_ms))| (label.clone(), share * ms + (1.0 - share) * kept_ms));
            let search = search
                .iter()
                .zip(back)
                .map(|((label, ms), (_, back_ms))| (label.clone(), share * ms.max(*back_ms)));
            self.pass_ms = mixed.chain(search).collect();
        }
        Ok(())
    }

    /// Learns how long lists lasted since the last time.
    pub(super) fn note_searches(&mut self, step: u32) -> Result<()> {
        let searches = self.read_one::<ListState>("list_state")?.searches;
        let more = searches.wrapping_sub(self.searches[0]);
        if more > 0 {
            let steps = step.wrapping_sub(self.last_look);
            self.list_lifetime = (f64::from(steps) / f64::from(more)).max(1.0);
            self.last_look = step;
        }
        self.searches[0] = searches;
        Ok(())
    }

    /// Rounds that most likely make so many steps.
    pub(super) fn submit_rounds(&mut self, steps: u64) -> Result<()> {
        if steps == 0 {
            return Ok(());
        }
        self.begin_steps()?;
        let mut left = steps as f64;
        while left > 0.0 {
            let most = self.most_steps().min(steps);
            let round = match lists::every_step(&self.scene) {
                true => 1,
                false => ((ROOM * self.list_lifetime).ceil() as u64).min(most),
            };
            let made = self.list_lifetime.min(round as f64);
            let rounds = ((left / made).ceil() as u64).min(most / round);
            left -= rounds as f64 * made;
            self.submit(&self.round(round).repeat(rounds as usize))?;
        }
        Ok(())
    }

    /// So many steps and a search.
    fn round(&self, steps: u64) -> Vec<&[Step]> {
        let mut round: Vec<&[Step]> = Vec::new();
        for step in 0..steps {
            round.push(if step % 2 == 0 {
                &self.passes.step
            } else {
                &self.passes.step_back
            });
        }
        round.push(&self.passes.start);
        round
    }

    /// Lets the device step until it has made all steps that were submitted.
    fn begin_steps(&self) -> Result<()> {
        let (gpu, buffers) = (&self.gpu, &self.buffers);
        buffers.write(gpu, "list_state", LAST_STEP, &[self.submitted as u32])?;
        let dispatch = self.plan.dispatch(self.count, self.free_particles(), &gpu.limits);
        for (moving, all) in [
            (Items::MovingParticles, Items::Particles),
            (Items::MovingFreeParticles, Items::FreeParticles),
            (Items::MovingReachedParticles, Items::ReachedParticles),
        ] {
            buffers.write(gpu, "dispatch", moving.entry(), &[dispatch[all.entry()]])?;
        }
        Ok(())
    }
}
