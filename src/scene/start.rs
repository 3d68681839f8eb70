//! Scenes to begin with: small, with comments, meant to be changed.

use super::Dimensions;

/// What the particles of a new scene are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Fluid,
    Grains,
}

/// The text of a scene to begin with.
pub fn text(kind: Kind, dimensions: Dimensions) -> &'static str {
    match (kind, dimensions) {
        (Kind::Fluid, Dimensions::Two) => include_str!("../../assets/start/fluid_2d.json"),
        (Kind::Fluid, Dimensions::Three) => include_str!("../../assets/start/fluid_3d.json"),
        (Kind::Grains, Dimensions::Two) => include_str!("../../assets/start/grains_2d.json"),
        (Kind::Grains, Dimensions::Three) => include_str!("../../assets/start/grains_3d.json"),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::scene::load;

    #[test]
    fn starts_are_small_scenes_without_notes() {
        for (kind, dimensions, most) in [
            (Kind::Fluid, Dimensions::Two, 2_000),
            (Kind::Fluid, Dimensions::Three, 5_000),
            (Kind::Grains, Dimensions::Two, 2_000),
            (Kind::Grains, Dimensions::Three, 6_000),
        ] {
            let text = text(kind, dimensions);
            let scene = load::parse(text, "start.json", Path::new("."), &[]).unwrap();
            assert_eq!(
                (scene.dimensions, scene.fluid().is_some()),
                (dimensions, kind == Kind::Fluid)
            );
            assert!(
                (1_000..most).contains(&scene.first_boundary()),
                "{}",
                scene.first_boundary()
            );
            assert_eq!(scene.notes, Vec::<String>::new());
            assert!(
                text.lines()
                    .filter(|line| line.trim_start().starts_with("//"))
                    .count()
                    > 5
            );
        }
    }
}
