//! Steps whose length the device chooses: what limits them, and how far a segment has come.

use super::layout::{StepControl, StepControlLimits};
use crate::gpu::{BufferPlan, Variant};
use crate::scene::{Scene, StepLimits};

/// Flag of every variant with such steps.
pub const FLAG: &str = "adaptive_step";
/// Ticks of a segment: time is counted in whole ones, so that steps land on its end whatever their lengths are.
const SEGMENT_TICKS: u32 = 1 << 31;
/// By how much a step may be longer than wanted where that saves one.
const ROUNDING: f32 = 1e-4;
/// A run whose steps become shorter than this share of the expected one would never end.
const SHORTEST_SHARE: f64 = 1e-4;
/// Stands for no limit; safely finite when multiplied, seconds.
const ENDLESS: f64 = 1e15;

/// The buffers of an adaptive step.
pub fn plan(scene: &Scene, variant: &mut Variant) -> Vec<BufferPlan> {
    variant.flag(FLAG, scene.time.adaptive.is_some());
    variant.modules.insert("host/step_limits".into(), module());
    let Some(limits) = &scene.time.adaptive else {
        return Vec::new();
    };
    vec![
        BufferPlan::storage(
            "step_control",
            1,
            StepControl::LAYOUT.size as u64,
            "time, and lengths of steps",
        )
        .reported(),
        BufferPlan::constant(
            "step_limits",
            &device_limits(limits),
            "what limits the length of a step",
        ),
    ]
}

fn device_limits(limits: &StepLimits) -> StepControlLimits {
    StepControlLimits {
        constant: limits.constant.0.min(ENDLESS) as f32,
        courant_distance: limits.courant_distance as f32,
        fall: limits.fall as f32,
        sound_speed: limits.sound_speed as f32,
        expected_speed: limits.expected_speed as f32,
        shortest: (SHORTEST_SHARE * limits.expected) as f32,
    }
}

/// What a step can be limited by, in the order in which the device counts: names in shaders and in messages. The limit
/// that never changes has its name from the scene.
pub const LIMITS: [(&str, Option<&str>); 6] = [
    ("LIMIT_SOUND", Some("speed of sound")),
    ("LIMIT_STIFFNESS", Some("stiffness")),
    ("LIMIT_MOTION", Some("motion")),
    ("LIMIT_ACCELERATION", Some("acceleration")),
    ("LIMIT_CONSTANT", None),
    ("LIMIT_FRAME", Some("frame end")),
];

/// Names of [`LIMITS`] in messages.
pub fn names(limits: &StepLimits) -> [&'static str; LIMITS.len()] {
    LIMITS.map(|(_, name)| name.unwrap_or(limits.constant.1))
}

/// The shader module `host/step_limits`.
fn module() -> String {
    let numbered = LIMITS.iter().enumerate();
    let limits: String = numbered
        .map(|(number, (name, _))| format!("const {name}: u32 = {number}u;\n"))
        .collect();
    let count = LIMITS.len();
    format!(
        "{limits}const LIMITS: u32 = {count}u;\nconst SEGMENT_TICKS: u32 = {SEGMENT_TICKS}u;\n\
         const ROUNDING: f32 = {ROUNDING};\n"
    )
}

impl StepControl {
    /// Before the first step, for which nothing is known but the length that the scene expects and how fast particles
    /// are, m/s.
    pub fn new(limits: &StepLimits, fastest: f32) -> Self {
        let mut step_control = Self {
            wanted: limits.expected as f32,
            ..Default::default()
        };
        step_control.heed(limits, fastest);
        step_control
    }

    /// Lets the next step be no longer than particles of such a speed allow, m/s.
    pub fn heed(&mut self, limits: &StepLimits, fastest: f32) {
        let allowed = limits.courant_distance / (limits.sound_speed + f64::from(fastest));
        self.wanted = self.wanted.min(allowed as f32);
    }

    /// Sets out for the end of a segment of so many seconds.
    pub fn begin_segment(&mut self, seconds: f64, ends_frame: bool, obstacle_speed: f32) {
        self.left = SEGMENT_TICKS;
        self.tick = (seconds / f64::from(SEGMENT_TICKS)) as f32;
        self.ends_frame = ends_frame.into();
        self.obstacle_speed = obstacle_speed;
        self.aim();
    }

    /// Chooses the next step as the device does: what is left of the segment is cut into equal steps.
    fn aim(&mut self) {
        let steps = (self.left as f32 * self.tick / self.wanted - ROUNDING).ceil();
        self.next_ticks = if steps <= 1.0 {
            self.left
        } else {
            ((self.left as f32 / steps) as u32).max(1)
        };
        self.next_step = self.next_ticks as f32 * self.tick;
    }

    /// Forgets the steps of the frame before.
    pub fn begin_frame(&mut self) {
        (self.shortest, self.longest) = (0.0, 0.0);
        self.made = Default::default();
    }

    /// Steps until the segment ends, as far as one can tell by the next one.
    pub fn steps_left(&self) -> u64 {
        (f64::from(self.left) / f64::from(self.next_ticks.max(1))).ceil() as u64
    }

    /// Steps since the last frame.
    pub fn steps(&self) -> u32 {
        self.made.iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_is_cut_into_equal_steps() {
        let mut step_control = StepControl {
            wanted: 0.03,
            ..Default::default()
        };
        step_control.begin_segment(0.1, true, 0.0);
        assert_eq!(step_control.steps_left(), 4);
        assert!(
            (step_control.next_step - 0.025).abs() < 1e-9,
            "{}",
            step_control.next_step
        );
        // No sliver where rounding alone would ask for one more.
        step_control.wanted = 0.1 / 3.0 * (1.0 - 1e-6);
        step_control.begin_segment(0.1, true, 0.0);
        assert_eq!(step_control.steps_left(), 3);
        // The last step takes what is left, to the tick.
        step_control.left = 12_345;
        step_control.aim();
        assert_eq!((step_control.next_ticks, step_control.steps_left()), (12_345, 1));
    }
}
