//! Reads what OpenEXR files of one part hold that are compressed by ZIP, as "OpenEXR File Layout" says it, so that tests need
//! no library. `tests/readers.rs` opens the same files with OpenEXR itself.

use std::collections::BTreeMap;
use std::io::Read as _;

use half::f16;

/// Width, height and the values of each channel, row by row from the top.
pub struct Image {
    pub width: usize,
    pub height: usize,
    pub channels: BTreeMap<String, Vec<f64>>,
}

struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize) -> &'a [u8] {
        let (taken, rest) = self.0.split_at(count);
        self.0 = rest;
        taken
    }

    fn int(&mut self) -> i32 {
        i32::from_le_bytes(self.take(4).try_into().unwrap())
    }

    fn text(&mut self) -> String {
        let end = self.0.iter().position(|&byte| byte == 0).unwrap();
        let text = String::from_utf8(self.take(end).to_vec()).unwrap();
        self.take(1);
        text
    }
}

pub fn read(file: &[u8]) -> Image {
    let mut head = Bytes(file);
    assert_eq!([head.int(), head.int()], [20_000_630, 2]);
    let mut names = Vec::new();
    let mut window = [0; 4];
    loop {
        let name = head.text();
        if name.is_empty() {
            break;
        }
        let _kind = head.text();
        let size = head.int() as usize;
        let mut value = Bytes(head.take(size));
        match name.as_str() {
            "channels" => loop {
                let channel = value.text();
                if channel.is_empty() {
                    break;
                }
                let [kind, ..] = [value.int(), value.int(), value.int(), value.int()];
                names.push((channel, kind));
            },
            "compression" => assert_eq!(value.0, [3]),
            "dataWindow" => window = [value.int(), value.int(), value.int(), value.int()],
            _ => {}
        }
    }
    let (width, height) = ((window[2] + 1) as usize, (window[3] + 1) as usize);
    let mut channels: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for block in 0..height.div_ceil(16) {
        let begins = u64::from_le_bytes(head.take(8).try_into().unwrap());
        let mut stored = Bytes(&file[begins as usize..]);
        assert_eq!(stored.int() as usize, 16 * block);
        let lines = 16.min(height - 16 * block);
        let bytes_per_pixel: usize = names.iter().map(|(_, kind)| if *kind == 1 { 2 } else { 4 }).sum();
        let raw = decompress(&mut stored, lines * width * bytes_per_pixel);
        let mut raw = Bytes(&raw);
        for _ in 0..lines {
            for (name, kind) in &names {
                let values = channels.entry(name.clone()).or_default();
                for _ in 0..width {
                    values.push(match kind {
                        0 => f64::from(u32::from_le_bytes(raw.take(4).try_into().unwrap())),
                        1 => f16::from_le_bytes(raw.take(2).try_into().unwrap()).to_f64(),
                        _ => f64::from(f32::from_le_bytes(raw.take(4).try_into().unwrap())),
                    });
                }
            }
        }
    }
    Image {
        width,
        height,
        channels,
    }
}

fn decompress(stored: &mut Bytes, size: usize) -> Vec<u8> {
    let count = stored.int() as usize;
    let bytes = stored.take(count);
    if bytes.len() == size {
        return bytes.to_vec();
    }
    let mut parted = Vec::new();
    flate2::read::ZlibDecoder::new(bytes)
        .read_to_end(&mut parted)
        .unwrap();
    assert_eq!(parted.len(), size);
    for k in 1..size {
        parted[k] = parted[k].wrapping_add(parted[k - 1]).wrapping_sub(128);
    }
    let odd = size.div_ceil(2);
    (0..size)
        .map(|k| parted[k / 2 + if k % 2 == 1 { odd } else { 0 }])
        .collect()
}
