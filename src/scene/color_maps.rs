//! Color maps: from a share between 0 and 1 to sRGB. Registered once, in [`COLOR_MAPS`].

use colorous::Gradient;

pub struct ColorMap {
    /// Name in scene files and on the command line.
    pub name: &'static str,
    pub about: &'static str,
    /// sRGB at a share of the range; the caller keeps the share between 0 and 1.
    pub at: fn(f64) -> [u8; 3],
}

macro_rules! from_colorous {
    ($name:literal, $gradient:ident, $about:literal) => {
        ColorMap {
            name: $name,
            about: $about,
            at: |share| sample(colorous::$gradient, share),
        }
    };
}

/// Every color map there is.
pub const COLOR_MAPS: &[ColorMap] = &[
    from_colorous!(
        "viridis",
        VIRIDIS,
        "dark blue, green, yellow; even in lightness (matplotlib)"
    ),
    from_colorous!(
        "plasma",
        PLASMA,
        "blue, pink, yellow; even in lightness (matplotlib)"
    ),
    from_colorous!(
        "inferno",
        INFERNO,
        "black, red, pale yellow; even in lightness (matplotlib)"
    ),
    from_colorous!(
        "magma",
        MAGMA,
        "black, purple, pale pink; even in lightness (matplotlib)"
    ),
    from_colorous!(
        "cividis",
        CIVIDIS,
        "blue to yellow; the same to color-blind eyes (Nuñez 2018)"
    ),
    from_colorous!(
        "turbo",
        TURBO,
        "blue, green, red; rich in detail (Mikhailov 2019)"
    ),
    from_colorous!("blues", BLUES, "white to dark blue (ColorBrewer)"),
    from_colorous!("cool", COOL, "violet to green (Niccoli)"),
    from_colorous!("warm", WARM, "violet to yellow-green through red (Niccoli)"),
    from_colorous!(
        "cubehelix",
        CUBEHELIX,
        "black to white in a spiral of hues (Green 2011)"
    ),
    from_colorous!("rainbow", RAINBOW, "all hues, cyclic; softer than a HSV rainbow"),
    from_colorous!("sinebow", SINEBOW, "all hues, cyclic; sine waves"),
    ColorMap {
        name: "white_blue",
        about: "white to pure blue, linear in sRGB (Harada 2007, Figure 7)",
        at: |share| blend([255, 255, 255], [0, 0, 255], share),
    },
    ColorMap {
        name: "sand",
        about: "wet to dry sand, linear in sRGB",
        at: |share| blend([150, 108, 60], [240, 214, 160], share),
    },
    ColorMap {
        name: "rojas",
        about: "blue to red, linear in RGB (Rojas 2013)",
        at: |share| blend([0, 0, 255], [255, 0, 0], share),
    },
];

/// The color map with this name.
pub fn find(name: &str) -> Option<&'static ColorMap> {
    COLOR_MAPS.iter().find(|map| map.name == name)
}

/// sRGB of `#rrggbb`.
pub fn parse_hex(text: &str) -> Option<[u8; 3]> {
    let digits = text.strip_prefix('#')?;
    if digits.len() != 6 || !digits.bytes().all(|b| b.is_ascii_hexdigit()) {
        return None;
    }
    let channel = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).ok();
    Some([channel(0)?, channel(2)?, channel(4)?])
}

fn sample(gradient: Gradient, share: f64) -> [u8; 3] {
    gradient.eval_continuous(share).into_array()
}

fn blend(low: [u8; 3], high: [u8; 3], share: f64) -> [u8; 3] {
    let mix = |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * share).round() as u8;
    [mix(low[0], high[0]), mix(low[1], high[1]), mix(low[2], high[2])]
}
