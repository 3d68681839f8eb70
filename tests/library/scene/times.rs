//! How long steps are.

use serde_json::json;

use super::{assert_near, ball_mass, block, message, valid};

#[test]
fn steps_resolve_the_contact_and_land_on_frames() {
    let time = valid(&block(), &[]).time;
    assert_eq!(time.frames, 21);
    assert_eq!(time.limited_by, "contact duration");
    assert_near(time.step * f64::from(time.steps_per_frame), 0.1);
    assert!(time.step <= time.contact_duration.unwrap() / 40.0);
    assert!(0.1 / f64::from(time.steps_per_frame - 1) > time.contact_duration.unwrap() / 40.0);
}

#[test]
fn an_event_that_stiffens_contacts_shortens_every_step() {
    let mut given = block();
    let soft = valid(&given, &[]).time.contact_duration.unwrap();
    given["events"] = json!([{ "at": 1, "set": { "spring": 4000 } }]);
    assert_near(valid(&given, &[]).time.contact_duration.unwrap(), soft / 2.0);
    given["events"] = json!([{ "at": 3, "set": { "spring": 4000 } }]);
    let late = valid(&given, &[]);
    assert_near(late.time.contact_duration.unwrap(), soft);
    assert_eq!(late.notes.len(), 1);
}

#[test]
fn the_scenes_step_is_kept_or_refused_with_one_that_fits() {
    let duration = valid(&block(), &[]).time.contact_duration.unwrap();
    let kept = valid(&block(), &[&format!("time.step={}", duration / 25.0)]).time;
    assert_eq!(kept.limited_by, "scene's step");
    assert_near(kept.step, 0.1 / (0.1 / (duration / 25.0)).ceil());
    let refused = message(&block(), &[&format!("time.step={}", duration / 19.0)]);
    let (_, after) = refused.split_once("at most ").unwrap();
    let fits = after.split(' ').next().unwrap();
    let relative: f64 = fits.parse::<f64>().unwrap() / (duration / 20.0);
    assert!((relative - 1.0).abs() < 1e-5);
}

#[test]
fn strong_damping_shortens_the_step() {
    let time = valid(&block(), &["grains.shear=1000"]).time;
    assert_eq!(time.limited_by, "damping");
    let contact = valid(&block(), &["grains.shear=1000"])
        .grains()
        .unwrap()
        .contact
        .clone();
    let share = (contact.damping + contact.shear) * time.step / (ball_mass() / 2.0);
    assert!(share <= 0.5 && share > 0.49, "{share}");
}
