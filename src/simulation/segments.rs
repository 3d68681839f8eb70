//! Cuts a frame's steps where something happens: events, and corners of obstacles' paths.

use crate::scene::Scene;

/// Some steps of a frame between which the host changes nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    pub steps: u32,
    /// Steps of the frame done when the segment ends.
    pub end: u32,
    /// Seconds.
    pub start_time: f64,
    pub end_time: f64,
    /// Events of the schedule that are due before its first step, counted from the run's start.
    pub events_before: usize,
}

/// Events that have happened when a frame is made.
pub fn happened(scene: &Scene, frame: u32) -> usize {
    let Some(interval) = frame.checked_sub(1) else {
        return 0;
    };
    let last = segments(scene, interval).pop();
    last.map_or(0, |segment| segment.events_before)
}

/// The segments of the frame interval that begins at frame `interval`.
pub fn segments(scene: &Scene, interval: u32) -> Vec<Segment> {
    let time = scene.time;
    let begin = f64::from(interval) / time.fps;
    let time_of = |step: u32| begin + f64::from(step) * time.step;
    // The first step of this interval that starts at `at` or later; `None` outside the interval.
    let step_at = |at: f64| {
        let step = ((at - begin) / time.step - 1e-6).ceil();
        (step < f64::from(time.steps_per_frame)).then_some(step.max(0.0) as u32)
    };
    let corners = scene.colliders.iter().flat_map(|c| &c.path).map(|(at, _)| *at);
    let events = scene.schedule.iter().map(|scheduled| scheduled.time);
    let mut cuts: Vec<u32> = corners.chain(events).filter_map(step_at).collect();
    cuts.extend([0, time.steps_per_frame]);
    cuts.sort_unstable();
    cuts.dedup();
    let due = |step: u32| {
        let is_due = |at: f64| step_at(at).is_some_and(|s| s <= step);
        scene
            .schedule
            .iter()
            .take_while(|scheduled| is_due(scheduled.time))
            .count()
    };
    cuts.windows(2)
        .map(|pair| Segment {
            steps: pair[1] - pair[0],
            end: pair[1],
            start_time: time_of(pair[0]),
            end_time: time_of(pair[1]),
            events_before: due(pair[0]),
        })
        .collect()
}
