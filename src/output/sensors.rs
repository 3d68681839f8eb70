//! `sensors.csv`: a row for each sample of a scene's sensors; and a file with a row for each layer of each profile.

pub mod from_files;

use std::fmt::Write as _;
use std::fs::File;
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::folder::Folder;
use super::{Sink, disk};
use crate::error::Result;
use crate::files;
use crate::scene::Scene;
use crate::scene::sensors::{Kind, Output, Sensor, layer};
use crate::simulation::Sample;
use crate::simulation::frame::Frame;

/// What every table of sensors begins with. `frame` is the frame that brought the sample.
pub const FIRST_COLUMNS: &str = "time_s,step,frame";

/// Appends rows as soon as a frame brings them, and draws charts at the end.
pub struct SensorFiles {
    scene: Scene,
    folder: Arc<Folder>,
    tables: Vec<Table>,
}

struct Table {
    file: TableFile,
    /// Number of the profile; `None` for the table of all other sensors.
    profile: Option<usize>,
}

/// A table of sensors, or of bodies, to which frames append rows.
pub(super) struct TableFile {
    path: PathBuf,
    file: File,
}

impl SensorFiles {
    /// Goes on behind the rows that are there.
    pub fn open(folder: Arc<Folder>, scene: &Scene) -> Result<Self> {
        let tables = tables(scene).map(|profile| {
            let path = match profile {
                None => folder.sensors(),
                Some(number) => folder.sensor_profile(&scene.sensors.list[number].name),
            };
            let file = TableFile::open(path, &header(scene, profile))?;
            Ok(Table { file, profile })
        });
        Ok(Self {
            tables: tables.collect::<Result<_>>()?,
            scene: scene.clone(),
            folder,
        })
    }
}

impl TableFile {
    /// Goes on behind the rows that are there; begins with the header where there are none.
    pub(super) fn open(path: PathBuf, header: &str) -> Result<Self> {
        let failed = |reason| disk::failed(&path, "create", reason);
        let mut file = files::append(&path).map_err(failed)?;
        if file.metadata().map_err(failed)?.len() == 0 {
            file.write_all(header.as_bytes()).map_err(failed)?;
        }
        Ok(Self { path, file })
    }

    pub(super) fn append(&mut self, rows: &str) -> Result<()> {
        // An open file can be written although nobody can find it any more.
        if !self.path.exists() {
            return Err(disk::failed(&self.path, "find", ErrorKind::NotFound.into()));
        }
        self.file
            .write_all(rows.as_bytes())
            .map_err(|reason| disk::failed(&self.path, "write", reason))
    }

    /// Waits until all of it is safe from a power cut.
    pub(super) fn save(&self) -> Result<()> {
        let saved = self.file.sync_all();
        saved.map_err(|reason| disk::failed(&self.path, "save", reason))
    }
}

impl Sink for SensorFiles {
    fn frame(&mut self, frame: &Arc<Frame>) -> Result<()> {
        for table in &mut self.tables {
            let rows = rows(&self.scene, table.profile, frame.index, &frame.samples);
            table.file.append(&rows)?;
        }
        Ok(())
    }

    fn flush(&mut self) -> Result<()> {
        self.tables.iter().try_for_each(|table| table.file.save())
    }

    fn finish(&mut self) -> Result<()> {
        self.flush()?;
        draw(&self.scene, &self.folder)
    }
}

/// The tables of a scene: `None` for that of all sensors but profiles, where there are such, and the number of each profile.
pub fn tables(scene: &Scene) -> impl Iterator<Item = Option<usize>> {
    let list = &scene.sensors.list;
    let all = list.iter().any(|sensor| sensor.layers().is_none());
    let profiles = (0..list.len()).filter(|&number| list[number].layers().is_some());
    all.then_some(None).into_iter().chain(profiles.map(Some))
}

/// The first line of a table.
pub fn header(scene: &Scene, profile: Option<usize>) -> String {
    let mut line = FIRST_COLUMNS.to_owned();
    let mut add = |name: &str| {
        line.push(',');
        line.push_str(name);
    };
    match profile {
        Some(number) => {
            let sensor = &scene.sensors.list[number];
            add("layer");
            add(&format!("{}_m", axis_of(sensor)));
            for output in sensor.outputs(scene.dimensions) {
                add(&output.header(""));
            }
        }
        None => {
            for (_, sensor, output) in curves(scene) {
                add(&output.header(&sensor.name));
            }
        }
    }
    line.push('\n');
    line
}

/// The rows that samples add to a table.
pub fn rows(scene: &Scene, profile: Option<usize>, frame: u32, samples: &[Sample]) -> String {
    let mut rows = String::new();
    for sample in samples {
        let step = sample.step.map(|step| step.to_string()).unwrap_or_default();
        let first = format!("{},{step},{frame}", number(sample.time));
        let mut row = |before: &str, values: &mut dyn Iterator<Item = f64>| {
            rows.push_str(&first);
            rows.push_str(before);
            for value in values {
                let _ = write!(rows, ",{}", number(value));
            }
            rows.push('\n');
        };
        match profile {
            None => {
                let list = scene.sensors.list.iter().zip(&sample.values);
                let mut values = list
                    .filter(|(sensor, _)| sensor.layers().is_none())
                    .flat_map(|(_, values)| values.iter().copied());
                row("", &mut values);
            }
            Some(place) => {
                let sensor = &scene.sensors.list[place];
                let width = sensor.outputs(scene.dimensions).len();
                for (layer, values) in sample.values[place].chunks_exact(width).enumerate() {
                    let middle = number(middle(scene, sensor, layer as u32));
                    row(&format!(",{layer},{middle}"), &mut values.iter().copied());
                }
            }
        }
    }
    rows
}

/// As short as it can be without loss; nothing for what is not a number.
fn number(value: f64) -> String {
    let single = value as f32;
    if value.is_nan() {
        String::new()
    } else if f64::from(single) == value {
        format!("{single}")
    } else {
        format!("{value}")
    }
}

/// Each column of `sensors.csv`, with the sensor that it belongs to and its number.
pub fn curves(scene: &Scene) -> Vec<(usize, &Sensor, Output)> {
    let sensors = scene.sensors.list.iter().enumerate();
    sensors
        .filter(|(_, sensor)| sensor.layers().is_none())
        .flat_map(|(number, sensor)| {
            let outputs = sensor.outputs(scene.dimensions).into_iter();
            outputs.map(move |output| (number, sensor, output))
        })
        .collect()
}

fn axis_of(sensor: &Sensor) -> &'static str {
    match sensor.kind {
        Kind::Profile { axis, .. } => ["x", "y", "z"][axis],
        _ => "",
    }
}

/// Where the middle of a profile's layer is, in the scene's coordinates, metres.
fn middle(scene: &Scene, sensor: &Sensor, number: u32) -> f64 {
    let Kind::Profile {
        axis,
        layers,
        min,
        max,
        ..
    } = sensor.kind
    else {
        return f64::NAN;
    };
    let (low, high) = layer(min, max, axis, layers, number);
    scene.origin[axis] + 0.5 * (f64::from(low[axis]) + f64::from(high[axis]))
}

/// Whether a file is a table of sensors.
pub fn is_table(path: &Path) -> bool {
    let begins = || -> std::io::Result<bool> {
        use std::io::Read as _;
        let mut head = vec![0; FIRST_COLUMNS.len()];
        files::open(path)?.read_exact(&mut head)?;
        Ok(head == FIRST_COLUMNS.as_bytes())
    };
    begins().unwrap_or(false)
}

/// Names of charts in which the columns of `sensors.csv` can be.
pub fn chart_names() -> impl Iterator<Item = String> {
    let quantities = [
        "pressure",
        "density",
        "velocity",
        "speed",
        "position",
        "height",
        "volume_flow",
        "mass_flow",
        "force",
        "torque",
        "particles",
    ];
    quantities.into_iter().map(chart_name)
}

fn chart_name(quantity: &str) -> String {
    format!("sensors_{quantity}.png")
}

#[cfg(not(feature = "plots"))]
fn draw(_scene: &Scene, _folder: &Folder) -> Result<()> {
    Ok(())
}

/// Charts of the tables in a run's folder: one for each quantity, and one for each profile.
#[cfg(feature = "plots")]
fn draw(scene: &Scene, folder: &Folder) -> Result<()> {
    use super::plot::Plot;

    for profile in tables(scene) {
        let path = match profile {
            None => folder.sensors(),
            Some(number) => folder.sensor_profile(&scene.sensors.list[number].name),
        };
        let table = read_table(&path)?;
        if table.is_empty() {
            continue;
        }
        match profile {
            None => {
                let curves = curves(scene);
                let mut quantities: Vec<(&str, &str)> =
                    curves.iter().map(|(_, _, o)| (o.quantity, o.unit)).collect();
                quantities.dedup();
                for (place, &(quantity, unit)) in quantities.iter().enumerate() {
                    if quantities[..place].iter().any(|(known, _)| *known == quantity) {
                        continue;
                    }
                    let label = with_unit(&quantity.replace('_', " "), unit);
                    let mut plot =
                        Plot::new(format!("Sensors of {}", scene.name), "time, s", label).from_lowest();
                    for (column, (_, sensor, output)) in curves.iter().enumerate() {
                        if output.quantity == quantity {
                            let points = table.iter().map(|row| (row[0], row[3 + column]));
                            plot = plot.series(curve_name(sensor, output), points);
                        }
                    }
                    plot.save(&folder.path().join(chart_name(quantity)))?;
                }
            }
            Some(number) => {
                let sensor = &scene.sensors.list[number];
                let outputs = sensor.outputs(scene.dimensions);
                let label = with_unit(outputs[0].quantity, outputs[0].unit);
                let x_label = with_unit(axis_of(sensor), "m");
                let title = format!("Profile {} of {}", sensor.name, scene.name);
                let mut plot = Plot::new(title, x_label, label).from_lowest();
                let samples: Vec<&[Vec<f64>]> = table.chunk_by(|a, b| a[0] == b[0]).collect();
                let components = outputs.len() - 1;
                for rows in shown(&samples) {
                    for (component, output) in outputs[..components].iter().enumerate() {
                        let name = match components {
                            1 => format!("{:.4} s", rows[0][0]),
                            _ => format!("{} at {:.4} s", axis_name(output), rows[0][0]),
                        };
                        plot = plot.series(name, rows.iter().map(|row| (row[4], row[5 + component])));
                    }
                }
                plot.save(&path.with_extension("png"))?;
            }
        }
    }
    Ok(())
}

/// Some of the samples, the first and the last among them.
#[cfg(feature = "plots")]
fn shown<T>(samples: &[T]) -> impl Iterator<Item = &T> {
    const MOST: usize = 3;
    let last = samples.len() - 1;
    let shown = MOST.min(samples.len());
    (0..shown).map(move |k| &samples[k * last / (shown - 1).max(1)])
}

/// The name of a column in a chart: `P1`, `gate x`.
#[cfg(any(feature = "plots", feature = "rerun"))]
pub fn curve_name(sensor: &Sensor, output: &Output) -> String {
    match output.name.strip_suffix(output.quantity) {
        Some("") => sensor.name.clone(),
        Some(prefix) => format!("{} {}", sensor.name, prefix.trim_end_matches('_')),
        None => format!("{} {}", sensor.name, axis_name(output)),
    }
}

/// `velocity_x` is x, and `lowest_velocity_x` is lowest x.
#[cfg(any(feature = "plots", feature = "rerun"))]
fn axis_name(output: &Output) -> String {
    output
        .name
        .replace(output.quantity, "")
        .replace('_', " ")
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
}

#[cfg(feature = "plots")]
fn with_unit(name: &str, unit: &str) -> String {
    match unit {
        "" => name.to_owned(),
        unit => format!("{name}, {unit}"),
    }
}

/// The numbers of a table, row by row; NaN for empty cells.
#[cfg(feature = "plots")]
fn read_table(path: &Path) -> Result<Vec<Vec<f64>>> {
    let text = files::read_text(path).map_err(|reason| disk::failed(path, "read", reason))?;
    let row = |line: &str| {
        line.split(',')
            .map(|cell| cell.parse().unwrap_or(f64::NAN))
            .collect()
    };
    Ok(text.lines().skip(1).map(row).collect())
}
