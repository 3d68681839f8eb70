//! A scene's events as text, each once, when it has happened.

use serde::Serialize;

use crate::scene::Scene;
use crate::scene::model::Event;

/// Events in order of time.
pub struct Events {
    /// Seconds and what happens.
    texts: Vec<(f64, String)>,
    told: usize,
}

impl Events {
    pub fn new(scene: &Scene) -> Self {
        let mut texts: Vec<_> = scene
            .file
            .events
            .iter()
            .map(|event| (event.at, text(event)))
            .collect();
        texts.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self { texts, told: 0 }
    }

    /// What has happened by `time` seconds and was not told yet.
    pub fn until(&mut self, time: f64) -> &[(f64, String)] {
        let first = self.told;
        // A frame's time is a quotient; half a nanosecond is nothing to a step.
        let happened = |event: &&(f64, String)| event.0 <= time + 5e-10;
        self.told += self.texts[first..].iter().take_while(happened).count();
        &self.texts[first..self.told]
    }
}

fn text(event: &Event) -> String {
    fn part<T: Serialize>(verb: &str, what: &Option<T>) -> Option<String> {
        let what = serde_json::to_string(what.as_ref()?).unwrap_or_default();
        Some(format!("{verb} {what}"))
    }
    let parts = [
        part("sets", &event.set),
        part("drops a ball of grains", &event.drop),
        part("switches an emitter", &event.emitter),
        part("moves a collider", &event.move_collider),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::scene::load;

    #[test]
    fn events_are_told_once_and_in_order() {
        let text = r#"{
            "domain": { "min": [0, 0, 0], "max": [1, 1, 1] },
            "grains": { "radius": 0.05, "spring": 2000, "restitution": 0.5 },
            "events": [
                { "at": 0.5, "set": { "gravity": [0, -1.62, 0] } },
                { "at": 0.1, "drop": { "center": [0.5, 0.5, 0.5], "radius": 0.1 } }
            ]
        }"#;
        let scene = load::parse(text, "test.json", Path::new("."), &[]).unwrap();
        let mut events = Events::new(&scene);
        assert!(events.until(0.0).is_empty());
        let first = events.until(0.1);
        assert!(first.len() == 1 && first[0].1.contains("drops"), "{first:?}");
        let second = events.until(2.0);
        assert!(second.len() == 1 && second[0].1.contains("-1.62"), "{second:?}");
        assert!(events.until(9.0).is_empty());
    }
}
