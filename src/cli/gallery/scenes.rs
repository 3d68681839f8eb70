//! The scenes of the gallery: what is run, and which of its frames shows it best.

/// A picture of the gallery.
pub struct Entry {
    /// Of its files and for `--only`.
    pub name: &'static str,
    pub about: &'static str,
    /// A scene that ships.
    pub scene: &'static str,
    /// What is changed in it, as `--set` takes it.
    pub set: &'static [&'static str],
    pub frame: u32,
}

/// A pillar in the way of a dam that breaks.
const PILLAR: &str = r##"colliders=[{"name":"pillar","shape":{"kind":"box","min":[1.2,0,0.2],"max":[1.4,0.7,0.4]},"color":"#d9d2c4"}]"##;

pub const ENTRIES: [Entry; 8] = [
    Entry {
        name: "dam",
        about: "A dam breaks, and the wave meets a pillar.",
        scene: "harada_dam",
        set: &[PILLAR],
        frame: 42,
    },
    Entry {
        name: "droplet",
        about: "A ball of water falls into a tank.",
        scene: "harada_droplet",
        set: &[],
        frame: 23,
    },
    Entry {
        name: "crates",
        about: "The wave of a dam carries crates, a barrel and a ball away.",
        scene: "crates_in_wave",
        set: &[],
        frame: 60,
    },
    Entry {
        name: "honey",
        about: "A bunny of honey melts.",
        scene: "honey",
        set: &[],
        frame: 30,
    },
    Entry {
        name: "drum",
        about: "A drum turns half full of grains.",
        scene: "drum",
        set: &[],
        frame: 60,
    },
    Entry {
        name: "hopper",
        about: "Grains in colored layers flow out of a hopper.",
        scene: "hopper",
        set: &[
            "render.camera.eye=[0.2,0.42,1.2]",
            "render.camera.target=[0,0.32,0]",
        ],
        frame: 40,
    },
    Entry {
        name: "bunnies",
        about: "Bunnies, each a rigid body, tumble into a box.",
        scene: "bunny_box",
        set: &[
            "render.show.domain=false",
            "render.camera.eye=[0.46,0.4,0.7]",
            "render.camera.target=[0,0.12,0]",
        ],
        frame: 18,
    },
    Entry {
        name: "brick_wall",
        about: "A ball flies into a wall of bricks.",
        scene: "brick_wall",
        set: &[],
        frame: 18,
    },
];
