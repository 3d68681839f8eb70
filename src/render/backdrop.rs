//! Frames that nobody tuned: backdrops, text colors, the heatmap's colors.

use crate::scene::model::Background;

/// sRGB bytes.
pub type Rgb = [u8; 3];

/// What stands behind the scene and how text reads on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Backdrop {
    /// At the bottom and at the top of the picture.
    pub low: Rgb,
    pub high: Rgb,
    pub floor: Rgb,
    /// Percent of the floor's light that a shadow takes away.
    pub shadow: u8,
    pub text: Rgb,
    /// Around the heatmap; differs from an empty voxel's black.
    pub panel: Rgb,
}

pub fn backdrop(background: Background) -> Backdrop {
    match background {
        // Where pictures are clear, these colors are what water reflects.
        Background::Studio | Background::Transparent => Backdrop {
            low: [226, 229, 233],
            high: [186, 194, 204],
            floor: [232, 234, 237],
            shadow: 62,
            text: [38, 42, 48],
            panel: [214, 218, 224],
        },
        Background::Dark => Backdrop {
            low: [38, 42, 49],
            high: [20, 23, 28],
            floor: [62, 67, 75],
            shadow: 72,
            text: [226, 229, 233],
            panel: [44, 48, 56],
        },
        Background::White => Backdrop {
            low: [255, 255, 255],
            high: [255, 255, 255],
            floor: [255, 255, 255],
            shadow: 50,
            text: [24, 26, 30],
            panel: [226, 229, 233],
        },
        Background::Black => Backdrop {
            low: [0, 0, 0],
            high: [0, 0, 0],
            floor: [34, 36, 40],
            shadow: 85,
            text: [226, 229, 233],
            panel: [40, 42, 46],
        },
    }
}

/// Colors of voxels by the number of their indices (Harada 2007, Figure 7): none, one, two, three; then our own for
/// four and more, and for indices that found no slot.
pub const POOL_COLORS: [Rgb; 6] = [
    [0, 0, 0],
    [255, 0, 0],
    [255, 255, 0],
    [255, 255, 255],
    [0, 140, 255],
    [255, 0, 255],
];

/// Linear light of an sRGB byte (IEC 61966-2-1).
pub fn linear(byte: u8) -> f32 {
    let c = f32::from(byte) / 255.0;
    if c <= 0.04045 {
        c / 12.92
    } else {
        ((c + 0.055) / 1.055).powf(2.4)
    }
}

/// Bytes in the order in which a shader packs them, alpha 255.
pub fn packed([r, g, b]: Rgb) -> u32 {
    u32::from_le_bytes([r, g, b, 255])
}
