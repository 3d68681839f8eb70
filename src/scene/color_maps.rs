//! Color maps by name (stub of the render branch).

pub struct ColorMap {
    pub name: &'static str,
    pub about: &'static str,
    /// sRGB bytes of a share from 0 to 1.
    pub at: fn(f64) -> [u8; 3],
}

pub const COLOR_MAPS: &[ColorMap] = &[ColorMap {
    name: "viridis",
    about: "dark violet to yellow",
    at: |t| colorous::VIRIDIS.eval_continuous(t).into_array(),
}];

pub fn find(name: &str) -> Option<&'static ColorMap> {
    COLOR_MAPS.iter().find(|map| map.name == name)
}
