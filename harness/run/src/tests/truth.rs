//! Truth as files, against a camera before a wall as one draws it on paper.

use std::collections::HashMap;
use std::io;
use std::path::Path;

use calibench_cameras::read_camera;
use calibench_exchange::{read_control, read_stations};
use calibench_files::{NewFolder, OutputFolder};
use calibench_model::TargetKind;
use calibench_model::camera::CameraModel;
use calibench_synth::sensor::Clipped;

use super::boards::board;
use super::{KEY, scenario, views};
use crate::prepared::Prepared;
use crate::truth::{self, StationRow};

pub(super) fn rows(path: &Path) -> Vec<HashMap<String, String>> {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let header = lines.next().unwrap();
    lines.map(|cells| header.iter().cloned().zip(cells).collect()).collect()
}

pub(super) fn number(row: &HashMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} of {row:?}"))
}

pub(super) fn fill(folder: &Path, write: impl FnOnce(&NewFolder) -> io::Result<()>) {
    OutputFolder::open(folder).unwrap().replace(write).unwrap();
}

/// From 6 m straight ahead 1 m is 10 mm / 5 um / 6 px; the centre of the frame is (499.5, 400), y of the image is down.
#[test]
fn a_view_s_table_is_the_drawing_on_paper() {
    let scenario = scenario(&[]);
    let subject = views(&scenario);
    let folder = tempfile::tempdir().unwrap();
    let prepared = Prepared::new(subject, KEY).unwrap();
    let path = folder.path().join("truth");
    fill(&path, |folder| truth::write_view(folder, "front", subject, &prepared.views[0]));
    let found = rows(&path.join("front.csv"));
    assert_eq!(found.len(), 12);
    for row in &found {
        assert_eq!((&*row["image"], &*row["kind"], &*row["visibility"], &*row["warning"]), ("front.png", "corner", "visible", ""));
        let (x, y) = (499.5 + number(row, "X") * 2000.0 / 6.0, 400.0 - number(row, "Y") * 2000.0 / 6.0);
        assert!((number(row, "x") - x).abs() < 1e-9 && (number(row, "y") - y).abs() < 1e-9, "{row:?}");
        assert!((number(row, "size_px") - 0.06 * 2000.0 / 6.0).abs() < 1e-6, "60 mm are 20 px: {}", row["size_px"]);
        assert_eq!((number(row, "Z"), &*row["ellipse_x"], &*row["room_px"]), (0.0, "", ""));
    }
    let xs: Vec<f64> = found.iter().map(|row| number(row, "x")).collect();
    assert!(xs.iter().any(|x| *x < 400.0) && xs.iter().any(|x| *x > 600.0), "the wall is not a point");
}

/// From 420 mm straight ahead 1 mm is 4 mm / 5 um / 420 px, and markers begin 4.5 mm beside a corner; rolled by 80 degrees the free square holds a smaller window.
#[test]
fn the_room_of_a_board_is_the_drawing_on_paper() {
    let straight = ("tilts = [[0, 0], [30, 0], [0, -35], [-25, 25]]", "tilts = [[0, 0]]");
    let scenario = board("charuco:8x6:30:21:DICT_4X4_50", "parametric_corner", &[straight]);
    let subject = views(&scenario);
    let folder = tempfile::tempdir().unwrap();
    let prepared = Prepared::new(subject, KEY).unwrap();
    let upright = 4.5 * 800.0 / 420.0;
    let (sine, cosine) = 80.0_f64.to_radians().sin_cos();
    let expected = [upright, upright / (sine + cosine)];
    for (view, expected) in prepared.views.iter().zip(expected) {
        let path = folder.path().join(&view.station.name);
        fill(&path, |folder| truth::write_view(folder, "seen", subject, view));
        let found = rows(&path.join("seen.csv"));
        assert_eq!(found.len(), 35);
        assert!(found.iter().all(|row| (number(row, "room_px") - expected).abs() < 1e-6), "{expected} {:?}", found[0]);
    }
    // All are in view, so that the middle one of both rolls is the larger.
    let told = crate::description::description(&scenario, &[]).study;
    let room = told.views().unwrap().room.unwrap();
    assert!((room.least - expected[1]).abs() < 1e-6 && (room.middle - expected[0]).abs() < 1e-6, "{room:?}");
}

#[test]
fn stations_control_and_camera_are_read_again() {
    let scenario = scenario(&[]);
    let subject = views(&scenario);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("truth");
    let at = |name: &str| path.join(name);
    let stations: Vec<StationRow> =
        subject.stations.iter().map(|station| StationRow::new(station, &station.name, Clipped { low: 3, high: 70 })).collect();
    fill(&path, |folder| {
        truth::write_stations(folder, "stations.csv", &stations)?;
        truth::write_control(folder, "control.csv", subject)?;
        truth::write_camera(folder, "camera", &subject.camera)
    });
    let found = rows(&at("stations.csv"));
    // Straight down the Z axis without a roll: no angle; the second is rolled by a quarter.
    let angles = |row: usize| ["omega_deg", "phi_deg", "kappa_deg"].map(|column| number(&found[row], column));
    assert!(angles(0).iter().all(|angle| angle.abs() < 1e-9), "{:?}", angles(0));
    let phi = (3.5_f64 / (3.5_f64.powi(2) + 0.25_f64.powi(2) + 4.5_f64.powi(2)).sqrt()).asin().to_degrees();
    assert!((angles(1)[1].abs() - phi).abs() < 1e-9, "{:?} {phi}", angles(1));
    assert_eq!(["X0", "Y0", "Z0", "clipped_low", "clipped_high"].map(|c| number(&found[2], c)), [3.4, -0.2, 4.6, 3.0, 70.0]);
    let again = read_stations(&at("stations.csv")).unwrap();
    for (read, station) in again.iter().zip(&subject.stations) {
        assert!((read.pose.rotation - station.pose.rotation).amax() < 1e-12 && read.pose.centre == station.pose.centre);
    }

    let control = read_control(&at("control.csv")).unwrap();
    assert_eq!(control.len(), 12);
    for (row, target) in control.iter().zip(&subject.field.targets) {
        assert_eq!((row.position, row.sigmas), (target.surveyed.coords.into(), None));
        let disc = (target.kind == TargetKind::Disc).then_some((0.5 * target.size, Some([0.0, 0.0, 1.0])));
        assert_eq!(row.disc.as_ref().map(|disc| (disc.radius, disc.normal)), disc);
    }

    let camera = read_camera(&at("camera.toml")).unwrap().cameras.remove(0).camera;
    assert_eq!((camera.parameters(), camera.size()), (subject.camera.parameters(), subject.camera.size()));
}

#[test]
fn targets_that_the_image_cannot_show_are_warned_of() {
    // 1 mm at 6 m is a third of a pixel, 20 mm under a blur of 4 px are lost in it.
    for (size, blur, word) in [("0.001", "", "smaller than a pixel"), ("0.02", "\n[optics]\nblur = 4.0\n", "blurred beyond its own size")] {
        let changed = scenario(&[("size = 0.06", &format!("size = {size}")), ("\n[pointing]", &format!("{blur}\n[pointing]"))]);
        let prepared = Prepared::new(views(&changed), KEY).unwrap();
        assert_eq!(truth::warnings(&prepared.views[0], "front"), [format!("front: 12 of 12 targets: {word}")]);
    }
    let usual = scenario(&[]);
    let prepared = Prepared::new(views(&usual), KEY).unwrap();
    assert!(truth::warnings(&prepared.views[0], "front").is_empty());
}

#[test]
fn clipping_is_told_as_a_share_of_the_pixels() {
    let note = truth::clipping_note("front", Clipped { low: 5, high: 250 }, 1000);
    assert_eq!(note.as_deref(), Some("front: 0.500 % of the pixels clipped at black, 25.000 % at white"));
    assert!(truth::clipping_note("front", Clipped { low: 0, high: 1 }, 1000).is_some());
    assert_eq!(truth::clipping_note("front", Clipped { low: 0, high: 0 }, 1000), None);
}
