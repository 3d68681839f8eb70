//! What a run answers to the first Ctrl-C: that it stops, or what it waits for.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use super::interrupt::AGAIN;
use super::progress::Progress;
use super::text::seconds;

/// Where a run is, known to the thread that answers.
#[derive(Clone, Default)]
pub struct Stopping(Arc<Mutex<Now>>);

/// What stopping would wait for.
#[derive(Debug, Clone, Copy, Default)]
enum Now {
    /// For nothing worth a word.
    #[default]
    Nothing,
    /// For a frame: frames behind the last checkpoint would have to be made again if it were given up.
    Frame {
        index: u32,
        begun: Instant,
        /// Seconds that the frame before it took.
        usual_s: Option<f64>,
        /// The frame of the last checkpoint.
        checkpoint: Option<u32>,
    },
    /// For frames on their way to files.
    Files,
}

impl Stopping {
    /// Answers from now on.
    pub fn listen(&self, progress: &Progress) {
        let (now, tell) = (self.clone(), progress.teller());
        super::interrupt::listen(move || tell(&now.answer()));
    }

    /// A frame begins that may be given up.
    pub fn nothing(&self) {
        self.set(Now::Nothing);
    }

    /// A frame begins that has to be finished.
    pub fn frame(&self, index: u32, usual_s: Option<f64>, checkpoint: Option<u32>) {
        self.set(Now::Frame {
            index,
            begun: Instant::now(),
            usual_s,
            checkpoint,
        });
    }

    /// All frames are made.
    pub fn files(&self) {
        self.set(Now::Files);
    }

    fn set(&self, now: Now) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = now;
    }

    fn answer(&self) -> String {
        let now = *self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match now {
            Now::Nothing => format!("stopping; {AGAIN}"),
            Now::Files => format!("stopping when the frames on their way are written; {AGAIN}"),
            Now::Frame {
                index,
                begun,
                usual_s,
                checkpoint,
            } => {
                let left = usual_s.map(|usual| usual - begun.elapsed().as_secs_f64());
                let when = match left {
                    Some(left) if left > 0.5 => format!(", in about {}", seconds(left)),
                    _ => String::new(),
                };
                let cost = match checkpoint {
                    Some(frame) => format!("the frames since frame {frame}"),
                    None => "all frames".to_owned(),
                };
                format!(
                    "stopping when frame {index} is done{when}, so that its state can be saved; {AGAIN}, and `resume` \
                     makes {cost} again"
                )
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_answer_says_what_is_waited_for() {
        let stopping = Stopping::default();
        assert_eq!(stopping.answer(), "stopping; Ctrl-C again ends at once");
        stopping.frame(12, Some(9.6), Some(3));
        let told = stopping.answer();
        assert!(told.contains("frame 12 is done, in about 9"), "{told}");
        assert!(told.contains("since frame 3"), "{told}");
        stopping.frame(2, None, None);
        let told = stopping.answer();
        assert!(
            told.contains("frame 2 is done, so that") && told.contains("all frames"),
            "{told}"
        );
        stopping.files();
        assert!(stopping.answer().contains("written"));
    }
}
