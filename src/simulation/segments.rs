//! Cuts a frame's steps where something happens: events, corners of obstacles' paths, and samples of sensors.

use crate::scene::Scene;

/// Cuts that are nearer than this share of an adaptive step are one.
const NEAREST: f64 = 1e-3;

/// Some steps of a frame between which the host changes nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// Where steps are adaptive, about so many.
    pub steps: u32,
    pub ends_frame: bool,
    /// Whether sensors are sampled at its end.
    pub is_sampled: bool,
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
    let steps = f64::from(time.steps_per_frame);
    let begin = f64::from(interval) / time.fps;
    // When something that is due at `at` happens, in steps since the frame before: with the first step that starts then
    // or later, or exactly then; `None` outside the interval.
    let place_of = |at: f64| {
        let place = (at - begin) / time.step;
        let place = match time.adaptive {
            None => (place - 1e-6).ceil(),
            Some(_) if place < NEAREST => 0.0,
            Some(_) => place,
        };
        (place <= steps - NEAREST).then_some(place.max(0.0))
    };
    let corners = scene.colliders.iter().flat_map(|c| &c.path).map(|(at, _)| *at);
    let events = scene.schedule.iter().map(|scheduled| scheduled.time);
    // Sensors are sampled behind the step that reaches their time, or exactly then.
    let end = f64::from(interval + 1) / time.fps;
    let times = scene.sensors.times(begin, end).into_iter();
    let samples: Vec<f64> = times.map(|at| place_of(at).unwrap_or(steps)).collect();
    let mut cuts: Vec<f64> = corners.chain(events).filter_map(place_of).collect();
    cuts.extend(&samples);
    cuts.extend([0.0, steps]);
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|later, earlier| *later - *earlier < NEAREST);
    let due = |cut: f64| {
        let is_due = |at: f64| place_of(at).is_some_and(|place| place < cut + NEAREST);
        scene
            .schedule
            .iter()
            .take_while(|scheduled| is_due(scheduled.time))
            .count()
    };
    let segment = |from: f64, to: f64| Segment {
        steps: (to - from).ceil() as u32,
        ends_frame: to == steps,
        is_sampled: samples.iter().any(|at| (at - to).abs() < NEAREST),
        start_time: begin + from * time.step,
        end_time: begin + to * time.step,
        events_before: due(from),
    };
    cuts.windows(2).map(|pair| segment(pair[0], pair[1])).collect()
}
