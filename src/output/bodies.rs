//! `bodies.csv`: where each rigid body of a scene is in each frame, and how it moves.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::Sink;
use super::sensors::{FIRST_COLUMNS, TableFile};
use crate::error::{Error, Result};
use crate::physics::bodies::BodyMotion;
use crate::scene::Dimensions;
use crate::simulation::frame::Frame;

/// The file's name.
pub const NAME: &str = "bodies.csv";

/// Appends a row for each body as soon as a frame is there.
pub struct BodyFile {
    file: TableFile,
    dimensions: Dimensions,
}

impl BodyFile {
    /// Goes on behind the rows that are there.
    pub fn open(path: PathBuf, dimensions: Dimensions) -> Result<Self> {
        let file = TableFile::open(path, &header(dimensions))?;
        Ok(Self { file, dimensions })
    }
}

impl Sink for BodyFile {
    fn frame(&mut self, frame: &Arc<Frame>) -> Result<()> {
        self.file.append(&rows(frame, self.dimensions))
    }

    fn flush(&mut self) -> Result<()> {
        self.file.save()
    }

    fn finish(&mut self) -> Result<()> {
        self.flush()
    }
}

/// The first line; units are in the names.
fn header(dimensions: Dimensions) -> String {
    let own = match dimensions {
        Dimensions::Two => {
            "x_m,y_m,angle_rad,velocity_x_m_per_s,velocity_y_m_per_s,angular_velocity_rad_per_s"
        }
        Dimensions::Three => {
            "x_m,y_m,z_m,orientation_w,orientation_x,orientation_y,orientation_z,velocity_x_m_per_s,velocity_y_m_per_s,\
             velocity_z_m_per_s,angular_velocity_x_rad_per_s,angular_velocity_y_rad_per_s,angular_velocity_z_rad_per_s"
        }
    };
    format!("{FIRST_COLUMNS},body,{own}\n")
}

/// How bodies moved in the frames of a run with this file, in the order of bodies; fewer where it lacks rows.
///
/// # Errors
///
/// Where the file cannot be read.
pub fn read(file: &Path, dimensions: Dimensions) -> Result<BTreeMap<u32, Vec<BodyMotion>>> {
    let text = std::fs::read_to_string(file).map_err(|error| {
        Error::usage(
            format!("{} cannot be read: {error}", file.display()),
            "it says where rigid bodies are; draw from checkpoints (--checkpoint-every 1), or run again",
        )
    })?;
    let numbers =
        |line: &str| -> Option<Vec<f64>> { line.split(',').map(|cell| cell.parse().ok()).collect() };
    let mut frames: BTreeMap<u32, Vec<BodyMotion>> = BTreeMap::new();
    for row in text.lines().skip(1).filter_map(numbers) {
        if let (Some(frame), Some(values)) = (row.get(2), row.get(4..))
            && let Some(motion) = motion(values, dimensions)
        {
            frames.entry(*frame as u32).or_default().push(motion);
        }
    }
    Ok(frames)
}

/// The reverse of [`values`].
fn motion(values: &[f64], dimensions: Dimensions) -> Option<BodyMotion> {
    Some(match (dimensions, values) {
        (Dimensions::Two, &[x, y, angle, vx, vy, turning]) => BodyMotion {
            center: DVec3::new(x, y, 0.0),
            orientation: DQuat::from_rotation_z(angle),
            velocity: DVec3::new(vx, vy, 0.0),
            angular_velocity: DVec3::Z * turning,
        },
        (Dimensions::Three, &[x, y, z, w, i, j, k, vx, vy, vz, wx, wy, wz]) => BodyMotion {
            center: DVec3::new(x, y, z),
            orientation: DQuat::from_xyzw(i, j, k, w).normalize(),
            velocity: DVec3::new(vx, vy, vz),
            angular_velocity: DVec3::new(wx, wy, wz),
        },
        _ => return None,
    })
}

/// A row for each body. Bodies are numbered from 1 on, as in the column `body` of particles.
fn rows(frame: &Frame, dimensions: Dimensions) -> String {
    let mut rows = String::new();
    for (number, body) in (1..).zip(&frame.bodies) {
        let _ = write!(rows, "{},{},{},{number}", frame.time, frame.steps, frame.index);
        for value in values(body, dimensions) {
            let _ = write!(rows, ",{value}");
        }
        rows.push('\n');
    }
    rows
}

/// About z, from −π to π, rad.
fn angle(orientation: DQuat) -> f64 {
    2.0 * (orientation.z * orientation.w.signum()).atan2(orientation.w.abs())
}

fn values(body: &BodyMotion, dimensions: Dimensions) -> Vec<f64> {
    let &BodyMotion {
        center,
        orientation,
        velocity,
        angular_velocity,
    } = body;
    match dimensions {
        Dimensions::Two => vec![
            center.x,
            center.y,
            angle(orientation),
            velocity.x,
            velocity.y,
            angular_velocity.z,
        ],
        Dimensions::Three => {
            let [x, y, z, w] = orientation.to_array();
            let mut all = center.to_array().to_vec();
            all.extend([w, x, y, z]);
            all.extend(velocity.to_array());
            all.extend(angular_velocity.to_array());
            all
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_body_has_a_row_in_each_frame() {
        let body = BodyMotion {
            center: DVec3::new(1.5, -2.0, 0.0),
            orientation: DQuat::from_rotation_z(0.5),
            velocity: DVec3::X,
            angular_velocity: DVec3::Z * 3.0,
        };
        let frame = Frame {
            index: 2,
            time: 0.25,
            steps: 10,
            bodies: vec![body, body],
            ..Default::default()
        };
        for (dimensions, row) in [
            (Dimensions::Two, "0.25,10,2,2,1.5,-2,0.5,1,0,3"),
            (
                Dimensions::Three,
                "0.25,10,2,2,1.5,-2,0,0.9689124217106447,0,0,0.24740395925452294,1,0,0,0,0,3",
            ),
        ] {
            let rows = rows(&frame, dimensions);
            assert_eq!(rows.lines().nth(1), Some(row));
            let again = motion(&values(&body, dimensions), dimensions).expect("a motion");
            assert!(again.orientation.abs_diff_eq(body.orientation, 1e-12) && again.center == body.center);
            let columns = |line: &str| line.trim_end().split(',').count();
            assert_eq!(columns(&header(dimensions)), columns(row));
        }
    }
}
