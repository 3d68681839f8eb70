//! `particles.pvd`: ParaView's list of a run's .vtp files and their times.

use std::path::Path;

use crate::error::Result;
use crate::output::disk;
use crate::output::folder::{Folder, numbered};

/// Lists what is in the folder.
pub fn write(folder: &Path, fps: f64) -> Result<()> {
    let of_frame = |(name, _): &(String, _)| numbered(name, "particles_", ".vtp");
    let mut frames: Vec<u32> = disk::list(folder)?.iter().filter_map(of_frame).collect();
    frames.sort_unstable();
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n\
         <Collection>\n",
    );
    for frame in frames {
        let time = f64::from(frame) / fps;
        text += &format!("<DataSet timestep=\"{time}\" part=\"0\" file=\"particles_{frame:06}.vtp\"/>\n");
    }
    text += "</Collection>\n</VTKFile>\n";
    disk::write(&Folder::index_of_particles(folder), text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_listed_in_order_with_their_times() {
        let folder = tempfile::tempdir().unwrap();
        for name in [
            "particles_000010.vtp",
            "particles_000000.vtp",
            "particles_000005.vtp.part",
        ] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        write(folder.path(), 20.0).unwrap();
        let text = std::fs::read_to_string(folder.path().join("particles.pvd")).unwrap();
        let sets: Vec<_> = text.lines().filter(|line| line.starts_with("<DataSet")).collect();
        assert_eq!(
            sets,
            [
                r#"<DataSet timestep="0" part="0" file="particles_000000.vtp"/>"#,
                r#"<DataSet timestep="0.5" part="0" file="particles_000010.vtp"/>"#,
            ]
        );
    }
}
