//! OpenEXR files: one part, scan lines, compressed by ZIP in blocks of 16 lines, any channels. What is written is the part of
//! "OpenEXR File Layout" (openexr.com) that every reader knows.

use std::io::{self, Write as _};

use flate2::Compression;
use flate2::write::ZlibEncoder;

/// Lines of a block.
const LINES: usize = 16;
const ZIP: u8 = 3;

/// What a channel's numbers are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Unsigned = 0,
    Half = 1,
    Float = 2,
}

impl Kind {
    const fn bytes(self) -> usize {
        match self {
            Self::Half => 2,
            Self::Unsigned | Self::Float => 4,
        }
    }
}

/// A channel among the pixels of some image, row by row from the top.
#[derive(Debug, Clone, Copy)]
pub struct Channel<'a> {
    /// With its layer: `normal.X`.
    pub name: &'static str,
    pub kind: Kind,
    /// Little-endian.
    pub pixels: &'a [u8],
    /// Bytes from one pixel to the next, and of a pixel before the channel's number.
    pub stride: usize,
    pub offset: usize,
}

/// The bytes of a file of `width` × `height` pixels.
pub fn encode([width, height]: [u32; 2], mut channels: Vec<Channel>) -> io::Result<Vec<u8>> {
    channels.sort_by_key(|channel| channel.name);
    let mut file = header([width, height], &channels);
    let (width, height) = (width as usize, height as usize);
    let blocks = height.div_ceil(LINES);
    let table = file.len();
    file.resize(table + 8 * blocks, 0);
    for block in 0..blocks {
        let begins = (file.len() as u64).to_le_bytes();
        file[table + 8 * block..][..8].copy_from_slice(&begins);
        let lines = block * LINES..((block + 1) * LINES).min(height);
        let mut raw = Vec::new();
        for line in lines.clone() {
            for channel in &channels {
                for pixel in line * width..(line + 1) * width {
                    let at = pixel * channel.stride + channel.offset;
                    raw.extend_from_slice(&channel.pixels[at..at + channel.kind.bytes()]);
                }
            }
        }
        let compressed = compress(&raw)?;
        // A block that does not become smaller stands as it is.
        let bytes = if compressed.len() < raw.len() {
            &compressed
        } else {
            &raw
        };
        file.extend_from_slice(&(lines.start as i32).to_le_bytes());
        file.extend_from_slice(&(bytes.len() as i32).to_le_bytes());
        file.extend_from_slice(bytes);
    }
    Ok(file)
}

fn header([width, height]: [u32; 2], channels: &[Channel]) -> Vec<u8> {
    // Magic number; version 2, which allows names of 31 letters.
    let mut file = vec![0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
    let mut attribute = |name: &str, kind: &str, value: &[u8]| {
        for text in [name, kind] {
            file.extend_from_slice(text.as_bytes());
            file.push(0);
        }
        file.extend_from_slice(&(value.len() as i32).to_le_bytes());
        file.extend_from_slice(value);
    };
    let mut list = Vec::new();
    for channel in channels {
        list.extend_from_slice(channel.name.as_bytes());
        list.push(0);
        // Kind; no hint that it is perceived linearly, and three reserved bytes; every pixel of every line has one.
        for number in [channel.kind as i32, 0, 1, 1] {
            list.extend_from_slice(&number.to_le_bytes());
        }
    }
    list.push(0);
    let window: Vec<u8> = [0, 0, width as i32 - 1, height as i32 - 1]
        .iter()
        .flat_map(|number: &i32| number.to_le_bytes())
        .collect();
    attribute("channels", "chlist", &list);
    attribute("compression", "compression", &[ZIP]);
    attribute("dataWindow", "box2i", &window);
    attribute("displayWindow", "box2i", &window);
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("pixelAspectRatio", "float", &1.0_f32.to_le_bytes());
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &1.0_f32.to_le_bytes());
    attribute("software", "string", b"Sliceflow");
    file.push(0);
    file
}

/// Bytes at even places, then those at odd ones, each as the difference from the one before, then zlib.
fn compress(raw: &[u8]) -> io::Result<Vec<u8>> {
    let parted = raw.iter().step_by(2).chain(raw.iter().skip(1).step_by(2));
    let mut before = None;
    let differences: Vec<u8> = parted
        .map(|&byte| match before.replace(byte) {
            None => byte,
            Some(last) => byte.wrapping_sub(last).wrapping_add(128),
        })
        .collect();
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(&differences)?;
    encoder.finish()
}
