//! Looks that are matte: each grain has a color of its own, by chance, and a surface of its own.

use crate::scene::model::Look;

#[derive(Debug, PartialEq)]
pub struct Matte {
    pub look: Look,
    /// What a grain's surface is like.
    pub shader: &'static str,
    /// Where the colors of grains stand, in order of the share of grains that come before them, 0 to 1; between them they blend.
    palette: &'static [(f64, [u8; 3])],
}

/// Every matte look there is.
const MATTE: &[Matte] = &[
    Matte {
        look: Look::Clay,
        shader: "render/looks/clay",
        palette: &[
            (0.0, [176, 116, 88]),
            (0.5, [200, 140, 108]),
            (1.0, [220, 164, 132]),
        ],
    },
    Matte {
        look: Look::Sand,
        shader: "render/looks/sand",
        palette: &[
            (0.0, [112, 84, 60]),
            (0.06, [150, 108, 70]),
            (0.2, [196, 150, 98]),
            (0.6, [222, 186, 134]),
            (0.9, [236, 210, 168]),
            (1.0, [242, 228, 204]),
        ],
    },
];

/// The row of a look, if it is matte.
pub fn find(look: Look) -> Option<&'static Matte> {
    MATTE.iter().find(|matte| matte.look == look)
}

impl Matte {
    /// sRGB of a grain at a share of them.
    pub fn color(&self, share: f64) -> [u8; 3] {
        let mut stops = self.palette.windows(2);
        let within = stops.find(|stop| share <= stop[1].0);
        let [(from, low), (to, high)] = *within.unwrap_or(&self.palette[self.palette.len() - 2..]) else {
            unreachable!("windows of two");
        };
        let at = (share - from) / (to - from);
        [0, 1, 2].map(|c| (f64::from(low[c]) + at * (f64::from(high[c]) - f64::from(low[c]))).round() as u8)
    }
}
