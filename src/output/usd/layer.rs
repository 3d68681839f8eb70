//! Attributes of one prim, as the text of a USD layer (Pixar, "Usda File Format"; readers are tested in tests/readers.rs).

use std::collections::BTreeMap;
use std::fmt::Write as _;

/// How every file begins.
pub const MARK: &str = "#usda 1.0\n# Sliceflow\n";

/// Attributes whose values change from frame to frame.
#[derive(Default, Clone)]
pub struct Layer {
    /// By type and name, as they are declared: `point3f[] points`.
    attributes: BTreeMap<String, Attribute>,
}

#[derive(Default, Clone)]
struct Attribute {
    /// Between brackets: `interpolation = "vertex"`; or nothing.
    metadata: &'static str,
    /// At frames; none where it is declared only. In the one layer of a frame that has not been joined, it is at frame 0.
    samples: Vec<(u32, String)>,
}

impl Layer {
    pub fn put(&mut self, declaration: impl Into<String>, metadata: &'static str, value: String) {
        let samples = vec![(0, value)];
        self.attributes
            .insert(declaration.into(), Attribute { metadata, samples });
    }

    /// Layers of frames as one.
    pub fn joined(frames: Vec<(u32, Self)>) -> Self {
        let mut all = Self::default();
        for (frame, layer) in frames {
            for (declaration, attribute) in layer.attributes {
                let joined = all.attributes.entry(declaration).or_default();
                joined.metadata = attribute.metadata;
                joined
                    .samples
                    .extend(attribute.samples.into_iter().map(|(_, value)| (frame, value)));
            }
        }
        all
    }

    /// The same attributes without values.
    pub fn declared(&self) -> Self {
        let mut declared = self.clone();
        declared
            .attributes
            .values_mut()
            .for_each(|attribute| attribute.samples.clear());
        declared
    }

    /// What one of two layers declares.
    pub fn united(mut self, other: Self) -> Self {
        self.attributes.extend(other.attributes);
        self
    }

    pub fn write(&self, text: &mut String, indent: &str) {
        for (declaration, Attribute { metadata, samples }) in &self.attributes {
            let metadata = if metadata.is_empty() {
                String::new()
            } else {
                format!(" ({metadata})")
            };
            line(text, indent, format_args!("{declaration}{metadata}"));
            if !samples.is_empty() {
                line(text, indent, format_args!("{declaration}.timeSamples = {{"));
                for (frame, value) in samples {
                    line(text, indent, format_args!("    {frame}: {value},"));
                }
                line(text, indent, format_args!("}}"));
            }
        }
    }
}

/// One line.
pub fn line(text: &mut String, indent: &str, what: std::fmt::Arguments) {
    writeln!(text, "{indent}{what}").expect("text grows as needed");
}

/// A list of numbers.
pub fn numbers<T: std::fmt::Display>(values: impl IntoIterator<Item = T>) -> String {
    list(values.into_iter(), |text, value| write!(text, "{value}"))
}

/// A list of vectors.
pub fn vectors(values: impl IntoIterator<Item = [f32; 3]>) -> String {
    list(values.into_iter(), |text, [x, y, z]| {
        write!(text, "({x}, {y}, {z})")
    })
}

fn list<T>(values: impl Iterator<Item = T>, put: impl Fn(&mut String, T) -> std::fmt::Result) -> String {
    let mut text = String::from("[");
    for (index, value) in values.enumerate() {
        if index > 0 {
            text += ", ";
        }
        put(&mut text, value).expect("text grows as needed");
    }
    text + "]"
}

/// A column's name as USD allows it: letters, digits and underscores, no digit first.
pub fn identifier(name: &str) -> String {
    let mut clean: String = name
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
        .collect();
    if !clean.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
        clean.insert(0, '_');
    }
    clean
}
