//! Threads that write files while the GPU goes on.

use std::panic::resume_unwind;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use crate::error::{Error, Result};

type Job = Box<dyn FnOnce() -> Result<()> + Send>;

/// A fixed number of threads behind a queue as long as they are many: memory stays bounded, and who submits waits.
pub struct Workers {
    /// `None` once finished.
    jobs: Option<SyncSender<Job>>,
    threads: Vec<JoinHandle<()>>,
    failure: Arc<Mutex<Option<Error>>>,
    submitted: u64,
    /// Jobs done, and who waits for them.
    done: Arc<(Mutex<u64>, Condvar)>,
}

/// Between two looks at whether a thread still lives.
const PATIENCE: Duration = Duration::from_millis(100);

impl Workers {
    pub fn new(count: usize) -> Self {
        let (jobs, queue) = sync_channel(count);
        let queue = Arc::new(Mutex::new(queue));
        let failure = Arc::new(Mutex::new(None));
        let done = Arc::new((Mutex::new(0), Condvar::new()));
        let thread = |_| {
            let (queue, failure, done) = (queue.clone(), failure.clone(), done.clone());
            thread::spawn(move || work(&queue, &failure, &done))
        };
        Self {
            jobs: Some(jobs),
            threads: (0..count).map(thread).collect(),
            failure,
            submitted: 0,
            done,
        }
    }

    /// Queues a job; waits while the queue is full. Returns the error of an earlier job as soon as there is one.
    pub fn submit(&mut self, job: impl FnOnce() -> Result<()> + Send + 'static) -> Result<()> {
        self.failed()?;
        match &self.jobs {
            Some(jobs) if jobs.send(Box::new(job)).is_ok() => {
                self.submitted += 1;
                Ok(())
            }
            // Nobody listens: every thread has panicked, and joining them passes the panic on.
            _ => self.finish(),
        }
    }

    /// Waits until every job so far is done; more may follow.
    pub fn wait(&mut self) -> Result<()> {
        let mut done = lock(&self.done.0);
        while *done < self.submitted && self.threads.iter().any(|thread| !thread.is_finished()) {
            // A thread that panicked reports nothing, so look at the threads from time to time.
            let (guard, _) = (self.done.1)
                .wait_timeout(done, PATIENCE)
                .unwrap_or_else(PoisonError::into_inner);
            done = guard;
        }
        drop(done);
        self.failed()
    }

    /// Waits for every job.
    pub fn finish(&mut self) -> Result<()> {
        self.jobs = None;
        for thread in self.threads.drain(..) {
            if let Err(panic) = thread.join() {
                resume_unwind(panic);
            }
        }
        self.failed()
    }

    fn failed(&self) -> Result<()> {
        lock(&self.failure).take().map_or(Ok(()), Err)
    }
}

/// Works until the queue is closed; after a failure only empties it.
fn work(queue: &Mutex<Receiver<Job>>, failure: &Mutex<Option<Error>>, done: &(Mutex<u64>, Condvar)) {
    let mut failed = false;
    loop {
        let job = lock(queue).recv();
        let Ok(job) = job else { return };
        if !failed && let Err(error) = job() {
            failed = true;
            lock(failure).get_or_insert(error);
        }
        *lock(&done.0) += 1;
        done.1.notify_all();
    }
}

/// A panic elsewhere leaves what these locks guard whole.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU32, Ordering};

    use super::*;

    #[test]
    fn every_job_runs_once() {
        let sum = Arc::new(AtomicU32::new(0));
        let mut workers = Workers::new(3);
        for i in 1..=100 {
            let sum = sum.clone();
            workers
                .submit(move || {
                    sum.fetch_add(i, Ordering::Relaxed);
                    Ok(())
                })
                .unwrap();
        }
        workers.finish().unwrap();
        assert_eq!(sum.load(Ordering::Relaxed), 5050);
    }

    #[test]
    fn waiting_ends_when_every_job_is_done_and_more_may_follow() {
        let sum = Arc::new(AtomicU32::new(0));
        let mut workers = Workers::new(2);
        for round in 1..=3 {
            for _ in 0..10 {
                let sum = sum.clone();
                workers
                    .submit(move || {
                        thread::sleep(Duration::from_millis(2));
                        sum.fetch_add(1, Ordering::Relaxed);
                        Ok(())
                    })
                    .unwrap();
            }
            workers.wait().unwrap();
            assert_eq!(sum.load(Ordering::Relaxed), 10 * round);
        }
        workers
            .submit(|| Err(Error::usage("disk full", "free space")))
            .unwrap();
        assert!(workers.wait().is_err());
    }

    #[test]
    fn a_failure_reaches_whoever_submits() {
        let mut workers = Workers::new(2);
        let first = workers.submit(|| Err(Error::usage("disk full", "free space")));
        let later = (0..1000).map(|_| workers.submit(|| Ok(()))).find(Result::is_err);
        let error = [Some(first), later, Some(workers.finish())]
            .into_iter()
            .flatten()
            .find_map(Result::err);
        assert!(error.unwrap().to_string().contains("disk full"));
    }
}
