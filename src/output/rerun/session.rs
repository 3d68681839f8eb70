//! A recording on its way: frames go through a bounded queue to a thread of their own.

use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use super::Target;
use super::frames::Frames;
use super::server::Server;
use super::target::{Open, Trouble};
use crate::error::Result;
use crate::output::{Sink, Tally};
use crate::simulation::frame::Frame;

/// Frames that wait for the thread.
const QUEUE: usize = 4;
/// How long a viewer may keep the run waiting; a file may as long as it takes.
const PATIENCE: Duration = Duration::from_secs(10);
/// How long a viewer may take for the last frames.
const LAST_FRAMES: Duration = Duration::from_secs(30);

struct Job {
    frame: Arc<Frame>,
    /// Particle steps per second since the run began; none at its start.
    rate: Option<f64>,
}

type Outcome = std::result::Result<Option<Server>, Trouble>;

/// One target's recording.
pub struct Session {
    target: Target,
    /// `None` when finished or lost.
    jobs: Option<SyncSender<Job>>,
    outcome: Receiver<Outcome>,
    thread: Option<JoinHandle<()>>,
    tally: Tally,
    warnings: Vec<String>,
    server: Option<Server>,
}

impl Session {
    /// Records into a target that is open; blueprint and everything static are sent already.
    pub fn new(target: Target, open: Open, mut frames: Frames, frames_of_run: u32) -> Self {
        let (jobs, queue) = sync_channel::<Job>(QUEUE);
        let (tell, outcome) = sync_channel(1);
        let thread = thread::spawn(move || {
            let recorded = queue.iter().try_for_each(|job| {
                open.check()?;
                frames
                    .log(&open.stream, &job.frame, job.rate)
                    .map_err(Trouble::Failed)
            });
            let outcome = recorded.and_then(|()| open.finish());
            // A session that lost its patience listens no more.
            let _ = tell.send(outcome);
        });
        Self {
            target,
            jobs: Some(jobs),
            outcome,
            thread: Some(thread),
            tally: Tally::start(frames_of_run),
            warnings: Vec::new(),
            server: None,
        }
    }

    /// Passes a job on; `false` when the thread takes no more.
    fn offer(&mut self, mut job: Job) -> bool {
        let Some(jobs) = &self.jobs else { return true };
        if matches!(self.target, Target::File(_)) {
            return jobs.send(job).is_ok();
        }
        let begin = Instant::now();
        loop {
            job = match jobs.try_send(job) {
                Ok(()) => return true,
                Err(TrySendError::Disconnected(_)) => return false,
                Err(TrySendError::Full(job)) => job,
            };
            if begin.elapsed() > PATIENCE {
                self.lose("it takes no more frames");
                return true;
            }
            thread::sleep(Duration::from_millis(2));
        }
    }

    /// Goes on without the viewer. Its thread may hang in a call, so nobody waits for it.
    fn lose(&mut self, reason: &str) {
        self.jobs = None;
        self.thread = None;
        self.warnings.push(self.target.lost(reason));
    }

    /// Waits for the thread's last word.
    fn close(&mut self) -> Result<()> {
        self.jobs = None;
        let Some(thread) = self.thread.take() else {
            return Ok(());
        };
        let outcome = match &self.target {
            Target::File(_) => self.outcome.recv().map_err(|_| RecvTimeoutError::Disconnected),
            _ => self.outcome.recv_timeout(LAST_FRAMES),
        };
        match outcome {
            Ok(Ok(server)) => self.server = server,
            Ok(Err(Trouble::Failed(error))) => return Err(error),
            Ok(Err(Trouble::Lost(reason))) => self.lose(&reason),
            Err(RecvTimeoutError::Timeout) => self.lose("it does not take the last frames"),
            Err(RecvTimeoutError::Disconnected) => {
                if let Err(panic) = thread.join() {
                    resume_unwind(panic);
                }
            }
        }
        Ok(())
    }
}

impl Sink for Session {
    fn frame(&mut self, frame: &Arc<Frame>) -> Result<()> {
        self.tally.add(frame);
        let rate = (frame.steps > 0).then_some(self.tally.particle_steps_per_s);
        let frame = frame.clone();
        if self.offer(Job { frame, rate }) {
            Ok(())
        } else {
            self.close()
        }
    }

    fn finish(&mut self) -> Result<()> {
        self.close()
    }

    fn warnings(&mut self) -> Vec<String> {
        std::mem::take(&mut self.warnings)
    }

    fn serving(&self) -> Option<String> {
        self.server.as_ref().map(|_| Server::address())
    }
}
