//! A checkpoint: what a run needs to go on behind a frame, in one file with a checksum.
//!
//! The file is the line `sliceflow checkpoint 1`, the header's length (u64, little-endian), the header (JSON), the bytes
//! of the device buffers that the header lists, one after the other, and the SHA-256 of all before it.

use std::path::Path;

use glam::DVec3;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::disk;
use super::guards::Guards;
use super::health::Health;
use crate::error::Result;
use crate::files;
use crate::scene::Dimensions;
use crate::simulation::State;

const MAGIC: &[u8] = b"sliceflow checkpoint 3\n";
const CHECKSUM_BYTES: usize = 32;

#[derive(Debug, Clone, PartialEq)]
pub struct Checkpoint {
    pub about: About,
    pub state: State,
}

/// What a run has besides the device's state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct About {
    /// Of the run that wrote it; see [`super::configuration::Configuration`].
    pub run_id: String,
    /// Of the program.
    pub version: String,
    /// Adapter and driver.
    pub adapter: String,
    /// Particles times steps of the run so far.
    pub particle_steps: u64,
    pub health: Health,
    /// What guards remember.
    #[serde(default)]
    pub guards: Guards,
    /// How often its steps had been halved by then.
    #[serde(default)]
    pub halvings: u32,
}

#[derive(Serialize, Deserialize)]
struct Header {
    about: About,
    frame: u32,
    particles: u32,
    dimensions: u32,
    /// Metres.
    origin: [f64; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    lists_left_out: Option<String>,
    /// Name and bytes.
    buffers: Vec<(String, u64)>,
}

impl Checkpoint {
    /// Writes it so that it is whole or absent, even after a power cut.
    pub fn write(&self, path: &Path) -> Result<()> {
        let state = &self.state;
        let sizes = state
            .buffers
            .iter()
            .map(|(name, bytes)| (name.clone(), bytes.len() as u64));
        let header = Header {
            about: self.about.clone(),
            frame: state.frame,
            particles: state.particles,
            dimensions: state.dimensions.count() as u32,
            origin: state.origin.to_array(),
            lists_left_out: state.lists_left_out.clone(),
            buffers: sizes.collect(),
        };
        let header = serde_json::to_vec(&header).expect("keys are text");
        let mut file = [MAGIC, &(header.len() as u64).to_le_bytes(), &header].concat();
        for (_, bytes) in &state.buffers {
            file.extend_from_slice(bytes);
        }
        let checksum = Sha256::digest(&file);
        file.extend_from_slice(&checksum);
        disk::write_durably(path, &file)
    }

    /// Reads it back; an error says what is wrong with the file.
    pub fn read(path: &Path) -> std::result::Result<Self, String> {
        let file = files::read(path).map_err(|reason| format!("cannot be read: {reason}"))?;
        let end = file.len().checked_sub(CHECKSUM_BYTES).ok_or("is cut off")?;
        let (content, checksum) = file.split_at(end);
        if !content.starts_with(MAGIC) {
            return Err("is of another program or format".into());
        }
        if Sha256::digest(content)[..] != *checksum {
            return Err("is damaged: its checksum does not match".into());
        }
        Self::parse(&content[MAGIC.len()..]).ok_or_else(|| "is not as this version writes them".into())
    }

    fn parse(content: &[u8]) -> Option<Self> {
        let (length, rest) = content.split_at_checked(size_of::<u64>())?;
        let length = usize::try_from(u64::from_le_bytes(length.try_into().ok()?)).ok()?;
        let (header, mut rest) = rest.split_at_checked(length)?;
        let header: Header = serde_json::from_slice(header).ok()?;
        let mut buffers = Vec::new();
        for (name, bytes) in header.buffers {
            let (buffer, behind) = rest.split_at_checked(usize::try_from(bytes).ok()?)?;
            buffers.push((name, buffer.to_vec()));
            rest = behind;
        }
        let state = State {
            frame: header.frame,
            particles: header.particles,
            dimensions: match header.dimensions {
                2 => Dimensions::Two,
                3 => Dimensions::Three,
                _ => return None,
            },
            origin: DVec3::from_array(header.origin),
            lists_left_out: header.lists_left_out,
            buffers,
        };
        rest.is_empty().then_some(Self {
            about: header.about,
            state,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checkpoint() -> Checkpoint {
        Checkpoint {
            about: About {
                run_id: "abc".into(),
                version: "1".into(),
                adapter: "none".into(),
                particle_steps: 123_456_789_012,
                health: Health::default(),
                guards: Guards::default(),
                halvings: 2,
            },
            state: State {
                frame: 40,
                particles: 1,
                dimensions: Dimensions::Two,
                origin: DVec3::new(0.1, -1e6, 0.0),
                lists_left_out: Some("too long".into()),
                buffers: vec![("position".into(), vec![1, 2, 3]), ("id".into(), vec![])],
            },
        }
    }

    #[test]
    fn comes_back_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("checkpoint_000040.bin");
        checkpoint().write(&path).unwrap();
        assert_eq!(Checkpoint::read(&path).unwrap(), checkpoint());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn every_changed_byte_and_every_cut_is_found() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("checkpoint_000040.bin");
        checkpoint().write(&path).unwrap();
        let whole = std::fs::read(&path).unwrap();
        for place in 0..whole.len() {
            let mut damaged = whole.clone();
            damaged[place] ^= 4;
            std::fs::write(&path, &damaged).unwrap();
            assert!(Checkpoint::read(&path).is_err(), "byte {place}");
            std::fs::write(&path, &whole[..place]).unwrap();
            assert!(Checkpoint::read(&path).is_err(), "cut at {place}");
        }
    }
}
