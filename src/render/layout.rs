//! Where things stand in a frame: the scene, the index pool beside it, legends. The GPU and the overlays share it.

use crate::scene::Scene;
use crate::scene::model::View;

/// Pixels, from the upper left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rectangle {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
}

/// The heatmap's part of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PoolPlace {
    pub panel: Rectangle,
    /// Room for the heatmap: upper left corner and side.
    pub square: [u32; 3],
    /// Upper left corner of its legend.
    pub legend: [u32; 2],
}

/// Pixels of the scene's rectangle that the automatic camera leaves to overlays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Insets {
    pub left: f64,
    pub right: f64,
    pub top: f64,
    pub bottom: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layout {
    pub frame: [u32; 2],
    pub scene: Option<Rectangle>,
    pub pool: Option<PoolPlace>,
    /// Size of text and margins; 1 in a frame 720 pixels high.
    pub scale: f32,
    pub insets: Insets,
}

/// Room that the heatmap's legend takes, at scale 1.
const POOL_LEGEND: [f32; 2] = [212.0, 206.0];

impl Layout {
    pub fn new(scene: &Scene, view: View) -> Self {
        let [width, height] = scene.render.size;
        let scale = ((height as f32).min(width as f32 * 0.75) / 720.0).clamp(0.4, 4.0);
        let pixels = |points: f32| (points * scale).round() as u32;
        let whole = Rectangle {
            x: 0,
            y: 0,
            width,
            height,
        };
        let (scene_place, pool) = match view {
            View::Scene => (Some(whole), None),
            View::Pool => (None, Some(pool_alone(whole, &pixels))),
            View::Both => {
                let (scene, pool) = pool_beside(whole, &pixels);
                (Some(scene), Some(pool))
            }
        };
        let legend = scene.color.legend && scene_place.is_some();
        let insets = Insets {
            left: f64::from(pixels(28.0)),
            right: f64::from(pixels(if legend { 118.0 } else { 28.0 })),
            top: f64::from(pixels(28.0)),
            bottom: f64::from(pixels(if scene.render.show.caption { 48.0 } else { 28.0 })),
        };
        Self {
            frame: [width, height],
            scene: scene_place,
            pool,
            scale,
            insets,
        }
    }
}

fn centered(room: u32, what: u32) -> u32 {
    room.saturating_sub(what) / 2
}

fn pool_alone(panel: Rectangle, pixels: &impl Fn(f32) -> u32) -> PoolPlace {
    let margin = pixels(24.0);
    let legend = POOL_LEGEND.map(pixels);
    // The caption's line stays free.
    let height = panel.height.saturating_sub(margin);
    let beside = panel.width >= panel.height;
    let (across, down) = if beside {
        (3 * margin + legend[0], 2 * margin)
    } else {
        (2 * margin, 3 * margin + legend[1])
    };
    let side = panel
        .width
        .saturating_sub(across)
        .min(height.saturating_sub(down))
        .max(1);
    if beside {
        let x = centered(panel.width, side + margin + legend[0]);
        let y = centered(height, side);
        PoolPlace {
            panel,
            square: [x, y, side],
            legend: [x + side + margin, y],
        }
    } else {
        let x = centered(panel.width, side);
        let y = centered(height, side + margin + legend[1]);
        PoolPlace {
            panel,
            square: [x, y, side],
            legend: [x, y + side + margin],
        }
    }
}

fn pool_beside(whole: Rectangle, pixels: &impl Fn(f32) -> u32) -> (Rectangle, PoolPlace) {
    let margin = pixels(24.0);
    let legend = POOL_LEGEND.map(pixels);
    let Rectangle { width, height, .. } = whole;
    if width >= height {
        let side = height
            .saturating_sub(3 * margin + legend[1])
            .min(width * 42 / 100)
            .max(1);
        let panel_width = (side + 2 * margin).min(width - 1);
        let left = width - panel_width;
        let y = centered(height, side + margin + legend[1]);
        let pool = PoolPlace {
            panel: Rectangle {
                x: left,
                y: 0,
                width: panel_width,
                height,
            },
            square: [left + margin, y, side],
            legend: [left + margin, y + side + margin],
        };
        (Rectangle { width: left, ..whole }, pool)
    } else {
        let side = width
            .saturating_sub(3 * margin + legend[0])
            .min(height * 42 / 100)
            .max(1);
        let panel_height = (side.max(legend[1]) + 2 * margin).min(height - 1);
        let top = height - panel_height;
        let pool = PoolPlace {
            panel: Rectangle {
                x: 0,
                y: top,
                width,
                height: panel_height,
            },
            square: [margin, top + centered(panel_height, side), side],
            legend: [2 * margin + side, top + margin],
        };
        (Rectangle { height: top, ..whole }, pool)
    }
}
