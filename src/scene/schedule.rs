//! Events and emitters, unrolled into what happens at which time.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::changes;
use super::contact::Law;
use super::emission;
use super::fluid;
use super::frame::{Frame, Report};
use super::grain_materials;
use super::model::{Arrangement, Change, ContactLaw, Emitter, Event, SceneFile};
use super::motion::{self, Shift};
use super::shapes::{self, Region};
use super::sizes::{self, Draw, PACKED};
use super::text::{number, suggest};
use super::{Action, Collider, Contact, Dimensions, Matter, Particles, Scheduled};

/// An emitter's layers of grains stand this many radii apart when the scene does not say: a tenth more than touching. A
/// fluid's stand one spacing apart.
const DEFAULT_SPACING_RADII: f64 = 2.2;

/// Streams of random numbers of balls that drop; bodies and emitters have those below.
const OF_DROPS: u64 = 1 << 32;

/// What happens, before it is known what particles are at the start.
pub struct Schedule<'a> {
    /// By time, seconds.
    due: Vec<(f64, Due<'a>)>,
}

enum Due<'a> {
    Set {
        gravity: Vec3,
        /// Of grains, after the change.
        contact: Option<Contact>,
        change: &'a Change,
        /// The only one of several fluids that changes.
        material: Option<usize>,
    },
    Add(Particles),
}

impl Schedule<'_> {
    /// The contact law after each change.
    pub fn contacts(&self) -> impl Iterator<Item = Contact> {
        self.due.iter().filter_map(|(_, due)| match due {
            Due::Set { contact, .. } => contact.clone(),
            Due::Add(_) => None,
        })
    }

    /// Whether more particles come.
    pub fn adds(&self) -> bool {
        self.due.iter().any(|(_, due)| matches!(due, Due::Add(_)))
    }

    /// What happens to particles that begin as `matter`.
    pub fn actions(self, mut matter: Matter) -> Vec<Scheduled> {
        let mut act = |due: Due| match due {
            Due::Add(particles) => Action::Add(particles),
            Due::Set {
                gravity,
                contact,
                change,
                material,
            } => {
                matter.change(contact, change, material);
                let matter = matter.clone();
                Action::SetParameters { gravity, matter }
            }
        };
        let scheduled = self.due.into_iter().map(|(time, due)| Scheduled {
            time,
            action: act(due),
        });
        scheduled.collect()
    }
}

/// Everything that happens before `end`, in seconds; moves lengthen the colliders' paths.
pub fn schedule<'a>(
    file: &'a SceneFile,
    frame: &'a Frame,
    law: Option<Law>,
    mass: f64,
    end: f64,
    colliders: &mut [Collider],
    report: &mut Report,
) -> Schedule<'a> {
    let mut unroll = Unroll {
        file,
        frame,
        mass,
        law,
        gravity: report.vector("gravity", &file.gravity, frame.dimensions),
        due: Vec::new(),
        switches: vec![Vec::new(); file.emitters.len()],
        moves: vec![Vec::new(); colliders.len()],
    };
    let mut order: Vec<(usize, &'a Event)> = file.events.iter().enumerate().collect();
    order.sort_by(|(_, a), (_, b)| a.at.total_cmp(&b.at));
    for (i, event) in order {
        let path = format!("events[{i}]");
        if event.at >= end {
            report.notes.push(format!(
                "{path} happens at {} s, but the run ends at {} s: it has no effect",
                number(event.at),
                number(end)
            ));
        }
        unroll.event(&path, event, event.at < end, colliders, report);
    }
    for (i, emitter) in file.emitters.iter().enumerate() {
        unroll.emitter(i, emitter, end, report);
    }
    for (collider, moves) in colliders.iter_mut().zip(&unroll.moves) {
        motion::add(collider, moves);
    }
    unroll.due.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    Schedule { due: unroll.due }
}

struct Unroll<'a> {
    file: &'a SceneFile,
    frame: &'a Frame,
    mass: f64,
    law: Option<Law>,
    gravity: DVec3,
    due: Vec<(f64, Due<'a>)>,
    /// By emitter: when it is switched on or off.
    switches: Vec<Vec<(f64, bool)>>,
    /// By collider.
    moves: Vec<Vec<Shift>>,
}

impl<'a> Unroll<'a> {
    fn event(
        &mut self,
        path: &str,
        event: &'a Event,
        happens: bool,
        colliders: &[Collider],
        report: &mut Report,
    ) {
        if event.set.is_none()
            && event.drop.is_none()
            && event.emitter.is_none()
            && event.move_collider.is_none()
        {
            report.problem(path, "does nothing", "add `set`, `drop`, `emitter` or `move`");
        }
        let time = event.at;
        if let Some(change) = &event.set {
            let place = format!("{path}.set");
            let material = changes::check(&place, change, self.file, report);
            let law = self.law.as_ref().map(|law| law.changed(&place, change, report));
            let gravity = match &change.gravity {
                Some(gravity) => report.vector(&format!("{place}.gravity"), gravity, self.frame.dimensions),
                None => self.gravity,
            };
            if happens {
                (self.law, self.gravity) = (law, gravity);
                let contact = self.law.as_ref().map(|law| law.contact(self.mass));
                let gravity = gravity.as_vec3();
                self.due.push((
                    time,
                    Due::Set {
                        gravity,
                        contact,
                        change,
                        material,
                    },
                ));
            }
        }
        if event.drop.is_some() {
            let ball = self.drop(&format!("{path}.drop"), event, report);
            if let (Some(ball), true) = (ball, happens) {
                self.due.push((time, Due::Add(ball)));
            }
        }
        if let Some(switch) = &event.emitter {
            let names = self.file.emitters.iter().map(|emitter| emitter.name.as_str());
            match names.clone().position(|name| name == switch.name) {
                Some(i) => self.switches[i].push((time, switch.on)),
                None => unknown(
                    &format!("{path}.emitter.name"),
                    "emitter",
                    &switch.name,
                    names,
                    report,
                ),
            }
        }
        if let Some(given) = &event.move_collider {
            let by = report
                .vector(&format!("{path}.move.by"), &given.by, self.frame.dimensions)
                .as_vec3();
            let (start, end) = (time, time + given.during);
            let place = format!("{path}.move.collider");
            let found = colliders
                .iter()
                .position(|collider| collider.name == given.collider);
            match found {
                Some(i) if happens => self.moves[i].push(Shift { start, end, by }),
                Some(_) => {}
                None => {
                    let names = self.file.colliders.iter().map(|collider| collider.name.as_str());
                    // A collider that is itself wrong has its own message.
                    if !names.clone().any(|name| name == given.collider) {
                        let named = names.filter(|name| !name.is_empty());
                        unknown(&place, "collider", &given.collider, named, report);
                    }
                }
            }
        }
    }

    /// A ball of grains on a lattice, or without order where they are of several sizes.
    fn drop(&self, path: &str, event: &Event, report: &mut Report) -> Option<Particles> {
        let drop = event.drop.as_ref()?;
        let center = report.vector(&format!("{path}.center"), &drop.center, self.frame.dimensions);
        let center = self.frame.local(center);
        let velocity = report.optional(
            &format!("{path}.velocity"),
            drop.velocity.as_ref(),
            self.frame.dimensions,
        );
        if !self.check_inside(path, "the ball", center, DVec3::splat(drop.radius), report) {
            return None;
        }
        let grain = self.file.radius();
        let largest = (drop.radius / grain).powi(self.frame.dimensions.count() as i32);
        let count =
            largest / Draw::new(self.file, self.frame.dimensions).map_or(1.0, |draw| draw.mean_share());
        let place = format!("{path}.radius");
        if !report.room_for(&place, "a ball of about", count, "particles", "make it smaller") {
            return None;
        }
        let region = Region::Sphere {
            center,
            radius: drop.radius,
        };
        let dimensions = self.frame.dimensions;
        let mut rng = ChaCha8Rng::seed_from_u64(self.file.seed);
        let (points, radii): (Vec<_>, Vec<_>) = match Draw::new(self.file, dimensions) {
            Some(draw) => {
                let own = self
                    .file
                    .events
                    .iter()
                    .position(|other| std::ptr::eq(other, event));
                rng.set_stream(OF_DROPS + own.unwrap_or_default() as u64);
                let balls = shapes::pack(&region, dimensions, &draw, grain, PACKED, &mut rng);
                balls.into_iter().unzip()
            }
            None => {
                let points = shapes::lattice(&region, dimensions, grain, 2.0 * grain, 0.0, &mut rng);
                (points, Vec::new())
            }
        };
        if points.is_empty() {
            let least = format!("give at least a particle's radius, {} m", number(grain));
            report.problem(format!("{path}.radius"), "not one particle fits", least);
            return None;
        }
        Some(self.batch(&points, &radii, velocity, 0))
    }

    fn emitter(&mut self, index: usize, emitter: &Emitter, end: f64, report: &mut Report) {
        let path = format!("emitters[{index}]");
        if let Some(twin) = self.file.emitters[..index]
            .iter()
            .position(|other| other.name == emitter.name)
        {
            report.problem(
                format!("{path}.name"),
                format!("emitters[{twin}] has the same name"),
                "give each emitter its own",
            );
        }
        let center = report.vector(&format!("{path}.center"), &emitter.center, self.frame.dimensions);
        let center = self.frame.local(center);
        let place = format!("{path}.velocity");
        let velocity = report.vector(&place, &emitter.velocity, self.frame.dimensions);
        let Some(axis) = velocity.try_normalize() else {
            report.problem(
                place,
                "is zero: particles would never leave the emitter",
                "give it a speed",
            );
            return;
        };
        let grain = self.file.radius();
        let usual = match self.file.fluid {
            Some(_) => 2.0,
            None => DEFAULT_SPACING_RADII,
        };
        let spacing = emitter.spacing.unwrap_or(usual * grain);
        if spacing < 2.0 * grain * (1.0 - 1e-9) {
            report.problem(
                format!("{path}.spacing"),
                format!(
                    "{} m is less than twice a particle's radius: particles would overlap",
                    number(spacing)
                ),
                format!("give at least {} m, or leave it out", number(2.0 * grain)),
            );
            return;
        }
        let across = (DVec3::ONE - axis * axis).max(DVec3::ZERO);
        let extent = across.map(f64::sqrt) * (emitter.radius - grain).max(0.0) + grain;
        if !self.check_inside(&path, "its first layer", center, extent, report) {
            return;
        }
        let across = 2.0 * emitter.radius / spacing + 1.0;
        let in_layer = across.powi(self.frame.dimensions.count() as i32 - 1);
        let place = format!("{path}.radius");
        if !report.room_for(
            &place,
            "a layer of about",
            in_layer,
            "particles",
            "make it narrower",
        ) {
            return;
        }
        let points = match emission::layer(
            center,
            axis,
            emitter.radius - grain,
            spacing,
            self.frame.dimensions,
        ) {
            points if points.is_empty() => {
                let least = format!("give at least a particle's radius, {} m", number(grain));
                report.problem(format!("{path}.radius"), "not one particle fits", least);
                return;
            }
            points => points,
        };
        let (path_of_material, name) = (format!("{path}.material"), emitter.material.as_deref());
        let material = match self.file.fluid {
            Some(_) => fluid::material(&path_of_material, name, self.file, report),
            None => grain_materials::number(&path_of_material, name, self.file, report),
        };
        let every = spacing / velocity.length();
        let flows = emission::flows(emitter.on, &self.switches[index], end);
        let layers = |(from, to): &(f64, f64)| ((to - from) / every - 1e-9).ceil();
        let draw = Draw::new(self.file, self.frame.dimensions);
        let filled = emission::filled(spacing, usual * grain, self.frame.dimensions);
        // A layer takes room besides its particles.
        let each = match &draw {
            None => points.len() as f64,
            Some(draw) => {
                let disc = match self.frame.dimensions {
                    Dimensions::Two => 2.0 * emitter.radius * spacing,
                    Dimensions::Three => PI * emitter.radius.powi(2) * spacing,
                };
                let mean = draw.mean_share() * sizes::content(grain, self.frame.dimensions);
                (filled * disc / mean).ceil()
            }
        };
        let grains = flows.iter().map(layers).sum::<f64>() * each;
        let help = "make it slower or narrower, or the run shorter";
        let in_all = "particles until the run ends";
        if !report.room_for(&path, "lets in", grains, in_all, help)
            || !report.room_for(&path, "lets in", grains / each, "layers until the run ends", help)
        {
            return;
        }
        let rotate = self
            .file
            .grains
            .as_ref()
            .is_some_and(|grains| grains.law != ContactLaw::SpringDashpot);
        let usual = if rotate || draw.is_some() {
            Arrangement::Random
        } else {
            Arrangement::Lattice
        };
        let mut rng = ChaCha8Rng::seed_from_u64(self.file.seed);
        rng.set_stream(index as u64);
        for flow in &flows {
            for n in 0..layers(flow) as u32 {
                let time = flow.0 + f64::from(n) * every;
                let dimensions = self.frame.dimensions;
                let batch = match (emitter.arrangement.unwrap_or(usual), &draw) {
                    (Arrangement::Lattice, _) => self.batch(&points, &[], velocity, material),
                    (Arrangement::Random, None) => {
                        let reach = emitter.radius - grain;
                        let layer = emission::loose_layer(
                            center,
                            axis,
                            reach,
                            spacing,
                            2.0 * grain,
                            dimensions,
                            &mut rng,
                        );
                        self.batch(&layer, &[], velocity, material)
                    }
                    (Arrangement::Random, Some(draw)) => {
                        let sizes = [emitter.radius, spacing, grain];
                        let layer =
                            emission::packed_layer([center, axis], sizes, filled, draw, dimensions, &mut rng);
                        let (points, radii): (Vec<_>, Vec<_>) = layer.into_iter().unzip();
                        self.batch(&points, &radii, velocity, material)
                    }
                };
                if !batch.is_empty() {
                    self.due.push((time, Due::Add(batch)));
                }
            }
        }
    }

    /// `radii` are of grains of several sizes, and otherwise empty.
    fn batch(&self, points: &[DVec3], radii: &[f64], velocity: DVec3, material: u32) -> Particles {
        let (fluid, several) = match &self.file.fluid {
            Some(fluid) => (true, !fluid.materials.is_empty()),
            None => (false, grain_materials::are_mixed(self.file)),
        };
        let of_fluid = if fluid { points.len() } else { 0 };
        Particles {
            position: points.iter().map(|point| point.as_vec3()).collect(),
            velocity: vec![velocity.as_vec3(); points.len()],
            density_deviation: vec![0.0; of_fluid],
            start_pressure: vec![0.0; of_fluid],
            radius: radii.iter().map(|&radius| radius as f32).collect(),
            material: if several {
                vec![material; points.len()]
            } else {
                Vec::new()
            },
            ..Particles::default()
        }
    }

    /// Whether something lies inside of the domain; a problem where not.
    fn check_inside(
        &self,
        path: &str,
        thing: &str,
        center: DVec3,
        extent: DVec3,
        report: &mut Report,
    ) -> bool {
        let sound = report.problems.len();
        for (axis, name) in self.frame.axes() {
            let below = self.frame.min[axis] - (center - extent)[axis];
            let above = (center + extent)[axis] - self.frame.max[axis];
            let beyond = below.max(above);
            if beyond > self.file.radius() * 1e-3 {
                report.problem(
                    path,
                    format!(
                        "{thing} reaches out of the domain along {name}, by {} m",
                        number(beyond)
                    ),
                    "move or shrink it",
                );
            }
        }
        report.problems.len() == sound
    }
}

/// A problem that names the nearest name.
fn unknown<'a>(
    path: &str,
    thing: &str,
    name: &str,
    known: impl Iterator<Item = &'a str> + Clone,
    report: &mut Report,
) {
    let help = match known.clone().next() {
        Some(_) => suggest(name, known),
        None => format!("no {thing} has a name; give it one"),
    };
    report.problem(path, format!("no {thing} is called \"{name}\""), help);
}
