//! The truth of rendered images as files.

use std::io;

use calibench_cameras::{FORMATS, camera_text};
use calibench_exchange::{POSE_COLUMNS, station_numbers, write_points};
use calibench_files::{NewFolder, write_table};
use calibench_model::camera::{Camera, ImageSize};
use calibench_model::{Affine, ControlDisc, ControlRow, NamedCamera, ObjectTarget, PixelPoint, Points, Pose, Scene, TargetKind};
use calibench_records::names::kept_image_name;
use calibench_scenario::ViewsSubject;
use calibench_synth::local::LocalDistortion;
use calibench_synth::sensor::Clipped;
use calibench_synth::stations::Station;
use calibench_synth::view::{Ellipse, TargetTruth, Visibility};
use rayon::prelude::*;

use crate::prepared::PreparedView;

/// Those of a point file, and what else is known: its reader knows these names, too.
const VIEW_COLUMNS: [&str; 21] = [
    "image",
    "target",
    "kind",
    "x",
    "y",
    "visibility",
    "axx",
    "axy",
    "ayx",
    "ayy",
    "ellipse_x",
    "ellipse_y",
    "semi_major",
    "semi_minor",
    "angle_deg",
    "X",
    "Y",
    "Z",
    "size_px",
    "room_px",
    "warning",
];

/// A station and what its image clipped.
pub struct StationRow {
    image: String,
    pose: Pose,
    clipped: Clipped,
}

impl StationRow {
    /// Of `station`, whose image is called `image`.
    pub fn new(station: &Station, image: &str, clipped: Clipped) -> Self {
        Self { image: image.to_owned(), pose: station.pose, clipped }
    }
}

fn table(folder: &NewFolder, name: &str, columns: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> io::Result<()> {
    folder.write(name, |file| write_table(file, columns, rows))
}

/// Where measuring starts, as `measure` reads it: image, target, position (px), kind, affine map.
///
/// # Errors
/// What the file system refuses.
pub fn write_starts(folder: &NewFolder, name: &str, starts: &Points) -> io::Result<()> {
    folder.write(name, |file| write_points(file, starts.rows()))
}

/// All targets of a flat scene, whose image is called `name`: name, kind, true position (px).
///
/// # Errors
/// What the file system refuses.
pub fn write_scene(folder: &NewFolder, name: &str, scene: &Scene) -> io::Result<()> {
    let row = |target: &calibench_model::SceneTarget| {
        vec![kept_image_name(name), target.id.clone(), target.kind.to_string(), target.at.x.to_string(), target.at.y.to_string()]
    };
    table(folder, &format!("{name}.csv"), &VIEW_COLUMNS[..5], scene.targets.iter().map(row))
}

/// Rows that are put into words before they are written: bounds the memory.
const ROWS: usize = 1 << 12;

/// All targets of a testfield in the image called `name`, with what is to be known of each.
///
/// # Errors
/// What the file system refuses.
pub fn write_view(folder: &NewFolder, name: &str, subject: &ViewsSubject, view: &PreparedView<'_>) -> io::Result<()> {
    let image = kept_image_name(name);
    let targets = subject.field.targets.chunks(ROWS).zip(view.truth.chunks(ROWS));
    let rows = targets.flat_map(|(targets, truth)| {
        let row = |(target, truth)| view_row(view.reach(), &image, target, truth);
        targets.par_iter().zip(truth).map(row).collect::<Vec<_>>()
    });
    table(folder, &format!("{name}.csv"), &VIEW_COLUMNS, rows)
}

fn view_row(reach: f64, image: &str, target: &ObjectTarget, truth: &TargetTruth) -> Vec<String> {
    let mut row = vec![image.to_owned(), target.id.clone(), target.kind.to_string()];
    let numbers = |row: &mut Vec<String>, values: Option<&[f64]>, count: usize| match values {
        Some(values) => row.extend(values.iter().map(f64::to_string)),
        None => row.extend(vec![String::new(); count]),
    };
    numbers(&mut row, truth.at.map(|PixelPoint { x, y }| [x, y]).as_ref().map(<[f64; 2]>::as_slice), 2);
    row.push(truth.visibility.name().to_owned());
    let affine = truth.affine.map(|Affine { axx, axy, ayx, ayy }| [axx, axy, ayx, ayy]);
    numbers(&mut row, affine.as_ref().map(<[f64; 4]>::as_slice), 4);
    let ellipse = truth.ellipse.map(|Ellipse { centre, axes, angle }| [centre.x, centre.y, axes[0], axes[1], angle.to_degrees()]);
    numbers(&mut row, ellipse.as_ref().map(<[f64; 5]>::as_slice), 5);
    row.extend(truth.object.iter().map(f64::to_string));
    for side in [size_px(truth), truth.room] {
        row.push(side.map_or_else(String::new, |side| side.to_string()));
    }
    row.push(warning(reach, truth).unwrap_or_default().to_owned());
    row
}

/// The side of a square as large as the picture of the square around a target, px.
fn size_px(truth: &TargetTruth) -> Option<f64> {
    truth.affine.map(|a| (a.axx * a.ayy - a.axy * a.ayx).abs().sqrt())
}

/// What makes a target doubtful in an image where the light of a point falls up to `reach` px from it.
fn warning(reach: f64, truth: &TargetTruth) -> Option<&'static str> {
    let size = size_px(truth).filter(|_| matches!(truth.visibility, Visibility::Visible | Visibility::Clipped))?;
    if size < 1.0 {
        Some("smaller than a pixel")
    } else if size < 2.0 * (reach - 1.0) / 3.0 {
        Some("blurred beyond its own size")
    } else {
        None
    }
}

/// The warnings of a view, whose image is called `name`, each with the number of targets that it concerns.
pub fn warnings(view: &PreparedView<'_>, name: &str) -> Vec<String> {
    let mut counted: Vec<(&str, usize)> = Vec::new();
    for warning in view.truth.iter().filter_map(|truth| warning(view.reach(), truth)) {
        match counted.iter_mut().find(|(known, _)| *known == warning) {
            Some((_, count)) => *count += 1,
            None => counted.push((warning, 1)),
        }
    }
    counted.into_iter().map(|(warning, count)| format!("{name}: {count} of {} targets: {warning}", view.truth.len())).collect()
}

/// How much of an image was clipped, if any.
pub fn clipping_note(view: &str, clipped: Clipped, pixels: usize) -> Option<String> {
    let share = |count: u64| 100.0 * count as f64 / pixels as f64;
    let any = clipped.low + clipped.high > 0;
    any.then(|| format!("{view}: {:.3} % of the pixels clipped at black, {:.3} % at white", share(clipped.low), share(clipped.high)))
}

/// Poses, and what was clipped. Angles in degrees.
///
/// # Errors
/// What the file system refuses.
pub fn write_stations(folder: &NewFolder, name: &str, rows: &[StationRow]) -> io::Result<()> {
    let columns = [&["image"], &POSE_COLUMNS[..], &["clipped_low", "clipped_high"]].concat();
    let row = |row: &StationRow| {
        let mut cells = vec![row.image.clone()];
        cells.extend(station_numbers(&row.pose).iter().map(f64::to_string));
        cells.extend([row.clipped.low, row.clipped.high].iter().map(u64::to_string));
        cells
    };
    table(folder, name, &columns, rows.iter().map(row))
}

/// The targets as a user knows them: surveyed coordinates, object units, with their standard deviations where the testfield was surveyed with any error, and of
/// discs the radius and the plate's normal.
///
/// # Errors
/// What the file system refuses.
pub fn write_control(folder: &NewFolder, name: &str, subject: &ViewsSubject) -> io::Result<()> {
    let sigmas = subject.survey_sigma.map(|sigma| [sigma; 3]);
    let disc = |target: &ObjectTarget| {
        let normal = subject.field.plates[target.plate].normal();
        Box::new(ControlDisc { radius: 0.5 * target.size, normal: Some(normal.into()) })
    };
    let row = |target: &ObjectTarget| {
        let disc = (target.kind == TargetKind::Disc).then(|| disc(target));
        ControlRow { sigmas, disc, ..ControlRow::new(&target.id, target.surveyed.coords.into()) }
    };
    let rows: Vec<ControlRow> = subject.field.targets.iter().map(row).collect();
    folder.write(name, |file| calibench_exchange::write_control(file, &rows))
}

/// Most places of the local distortion's table along a side.
const MOST_PLACES: u32 = 128;

/// What the camera distorts locally, on a grid over the frame: a point that the camera alone would picture at (x, y) is pictured at (x + dx, y + dy), px.
///
/// The grid has a quarter of a length of correlation, or what makes 128 places along a side if that is more.
///
/// # Errors
/// What the file system refuses.
pub fn write_local(folder: &NewFolder, name: &str, local: &LocalDistortion, size: ImageSize) -> io::Result<()> {
    let side = size.width.max(size.height);
    let step = (0.25 * local.design().correlation).max(f64::from(side) / f64::from(MOST_PLACES));
    // From the frame's outer corner to the other: each side in equal steps.
    let along = |side: u32| {
        let count = (f64::from(side) / step).ceil().max(1.0);
        (0..=count as u32).map(move |i| f64::from(side) * f64::from(i) / count - 0.5)
    };
    let places = along(size.height).flat_map(|y| along(size.width).map(move |x| PixelPoint::new(x, y)));
    let row = |at: PixelPoint| {
        let [dx, dy] = local.at(at).by;
        [at.x, at.y, dx, dy].iter().map(f64::to_string).collect()
    };
    table(folder, name, &["x", "y", "dx", "dy"], places.map(row))
}

/// The camera as a file of the first format that holds it as it is; its ending is put to `stem`.
///
/// # Errors
/// A camera that no format holds, and what the file system refuses.
pub fn write_camera(folder: &NewFolder, stem: &str, camera: &Camera) -> io::Result<()> {
    let named = [NamedCamera::new("", *camera)];
    let mut last = None;
    for format in FORMATS.iter().filter(|format| format.is_written()) {
        match camera_text(format, &named) {
            Ok(text) => return folder.write(&format!("{stem}.{}", format.extension), |file| file.write_all(text.as_bytes())),
            Err(error) => last = Some(error),
        }
    }
    Err(io::Error::other(last.map_or_else(|| "no format of camera files".to_owned(), |error| error.to_string())))
}
