//! Poses against those of boards, names, and the bend against its formula.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use calibench_model::Pose;
use calibench_model::camera::{Camera, CameraModel, ImageSize, Photogrammetric};
use calibench_model::testfield::Bend;
use calibench_random::Key;
use nalgebra::Point3;

use super::*;
use crate::stations::BoardViews;
use crate::testfield::{Coded, SheetBend};

const KEY: Key<'_> = Key { seed: 1988, of: "stand", trial: 0, view: "", target: "" };
const TURNS: [f64; 4] = [0.0, FRAC_PI_2, PI, 3.0 * FRAC_PI_2];

fn field() -> Testfield {
    Coded { bend: None, ..Coded::paper() }.generate(KEY).unwrap()
}

/// The paper's positions.
fn stand(bend: Option<StandBend>) -> Stand {
    Stand { phis: vec![0.0, PI / 6.0, FRAC_PI_4], turns: TURNS.to_vec(), rolls: TURNS.to_vec(), distance: 4440.0, bend }
}

fn stations(stand: &Stand, field: &Testfield) -> Result<Vec<Station>, StationError> {
    stand.generate(&Aim::of(field).unwrap(), field)
}

fn close(a: &Pose, b: &Pose) -> bool {
    (a.rotation - b.rotation).norm() < 1e-12 && (a.centre - b.centre).norm() < 1e-8
}

#[test]
fn the_papers_recordings_are_named_as_in_the_paper() {
    let stations = stations(&stand(None), &field()).unwrap();
    let names: Vec<&str> = stations.iter().map(|station| station.name.as_str()).collect();
    assert_eq!(names.len(), 36);
    assert_eq!(names[..6], ["1111", "1112", "1113", "1114", "1211", "1212"]);
    assert_eq!(names[4 + 16..][..5], ["1311", "1312", "1313", "1314", "1321"]);
    // The image of figure 7a: phi 30 degrees, both kappas zero.
    let [x, y, z] = stations[4].pose.centre.coords.into();
    let distance = 4440.0;
    assert!((x + distance * 0.5).abs() < 20.0 && y.abs() < 20.0 && (z - distance * 0.75_f64.sqrt()).abs() < 1e-6, "{x} {y} {z}");
}

/// What both can say: the field unturned, tilted about its upright axis.
#[test]
fn without_a_turn_it_is_a_board() {
    let field = field();
    let aim = Aim::of(&field).unwrap();
    let phis = [0.0, PI / 6.0, -FRAC_PI_4];
    let board = BoardViews { tilts: phis.map(|phi| [0.0, phi]).to_vec(), distances: vec![4440.0], rolls: TURNS.to_vec() };
    let stand = Stand { phis: phis.to_vec(), turns: vec![0.0], ..stand(None) };
    let (board, stand) = (board.generate(&aim).unwrap(), stations(&stand, &field).unwrap());
    assert_eq!(board.len(), stand.len());
    for (board, stand) in board.iter().zip(&stand) {
        assert_eq!(board.pose, stand.pose, "{}", stand.name);
        assert_eq!(stand.bend, None);
    }
}

/// A field that is turned by a quarter and tilted about the upright axis was tilted about its own other axis, and is rolled.
#[test]
fn a_quarter_turn_tilts_about_the_other_axis() {
    let field = field();
    let aim = Aim::of(&field).unwrap();
    let board = BoardViews { tilts: vec![[0.5, 0.0]], distances: vec![4440.0], rolls: vec![-FRAC_PI_2] }.generate(&aim).unwrap();
    let stand = Stand { phis: vec![0.5], turns: vec![-FRAC_PI_2], rolls: vec![0.0], ..stand(None) };
    let turned = &stations(&stand, &field).unwrap()[0];
    // -90 degrees: the field's right points down on the stand, its left upwards; the upright axis is the field's left.
    let expected = BoardViews { tilts: vec![[-0.5, 0.0]], ..BoardViews { tilts: vec![], distances: vec![4440.0], rolls: vec![FRAC_PI_2] } };
    let expected = expected.generate(&aim).unwrap();
    assert!(close(&turned.pose, &expected[0].pose), "{:?} {:?}", turned.pose, expected[0].pose);
    assert!(!close(&turned.pose, &board[0].pose));
}

#[test]
fn without_a_tilt_turning_the_field_is_rolling_the_camera_back() {
    let field = field();
    let pose = |turn: f64, roll: f64| {
        let stand = Stand { phis: vec![0.0], turns: vec![turn], rolls: vec![roll], ..stand(None) };
        stations(&stand, &field).unwrap().remove(0).pose
    };
    for roll in TURNS {
        assert!(close(&pose(FRAC_PI_2, roll + FRAC_PI_2), &pose(0.0, roll)));
        assert!(!close(&pose(FRAC_PI_2, roll - FRAC_PI_2), &pose(0.0, roll)));
    }
    let camera: Camera = Photogrammetric {
        size: ImageSize { width: 240, height: 240 },
        pitch_um: 27.0,
        c: 57.5,
        x0: 0.0,
        y0: 0.0,
        k: [0.0; 3],
        p: [0.0; 2],
        b: [0.0; 2],
    }
    .into();
    let image = |pose: &Pose, x: f64, y: f64| camera.project(pose.ray(&Point3::new(x, y, 0.0))).unwrap();
    // A positive turn is anticlockwise for the camera: the field's right points upwards.
    let [middle, right] = [0.0, 100.0].map(|x| image(&pose(FRAC_PI_2, 0.0), x, 0.0));
    assert!((right.x - middle.x).abs() < 1e-9 && right.y < middle.y - 40.0, "{middle:?} {right:?}");
    // 60 px for the 125 mm between two lines, as Table 2 has it.
    let px = 1.25 * (middle.y - right.y);
    assert!((px - 60.0).abs() < 0.05, "{px}");
}

/// The height over the field's plane of a place of the field, for the field turned by a multiple of a quarter.
#[test]
fn the_bend_stays_on_the_stand() {
    let field = field();
    let middle = Aim::of(&field).unwrap().middle;
    for across in [0.0, FRAC_PI_2, 0.4] {
        let bend = StandBend { peak: 0.8, reach: 250.0, across };
        for station in stations(&stand(Some(bend)), &field).unwrap() {
            let turn = station.name.as_bytes()[2] - b'1';
            let bent = station.field(&field);
            for target in bent.targets.iter().step_by(7) {
                let (x, y) = (target.surveyed.x - middle.x, target.surveyed.y - middle.y);
                // Where a place of the field is on the stand: to its right and upwards.
                let (right, up) = match turn {
                    0 => (x, y),
                    1 => (-y, x),
                    2 => (-x, -y),
                    _ => (y, -x),
                };
                let s = (right * across.cos() + up * across.sin()) / 250.0;
                let at = bent.position(target);
                assert!((at.z - 0.8 * (1.0 - s * s)).abs() < 1e-12, "{} {}: {at:?}", station.name, target.id);
                assert!((at.xy() - target.surveyed.xy()).norm() < 1e-12);
            }
            assert_eq!(field.plates[0].bend, None, "the field itself is as it was");
        }
    }
}

/// Of the measured 500 mm, 0.8 mm; and then of the whole sheet 4.6 mm, as it must be for that.
#[test]
fn the_bend_is_that_of_the_measured_part() {
    let field = field();
    let stand = stand(Some(StandBend { peak: 0.8, reach: 250.0, across: 0.0 }));
    let station = &stations(&stand, &field).unwrap()[0];
    let [x, y] = station.bend.unwrap().middle;
    let height = |u: f64| station.field(&field).plates[0].point([x + u, y]).z;
    assert!((height(0.0) - height(250.0) - 0.8).abs() < 1e-12 && (height(-250.0) - height(250.0)).abs() < 1e-12);
    assert!((height(0.0) - height(600.0) - 4.608).abs() < 1e-9, "{}", height(600.0));
}

/// A sheet anywhere in space, with axes of its own.
#[test]
fn the_bend_is_that_of_the_stand_whatever_the_sheets_axes() {
    let mut field = field();
    let (right, up) = (Vector3::new(0.6, 0.0, -0.8), Vector3::y());
    let normal = right.cross(&up);
    // The sheet's own u is the field's up, its v the field's left.
    (field.plates[0].u, field.plates[0].v) = (up, -right);
    let origin = field.plates[0].origin + Vector3::new(10.0, 20.0, 30.0);
    field.plates[0].origin = origin;
    for target in &mut field.targets {
        target.surveyed = origin + up * target.at[0] - right * target.at[1];
    }
    let aim = Aim::new(Aim::of(&field).unwrap().middle, normal, up).unwrap();
    let stand =
        Stand { phis: vec![0.3], turns: vec![0.0], rolls: vec![0.0], ..stand(Some(StandBend { peak: 2.0, reach: 300.0, across: 0.7 })) };
    let station = &stand.generate(&aim, &field).unwrap()[0];
    let bent = station.field(&field);
    for target in &bent.targets {
        let from = target.surveyed - aim.middle;
        let s = (from.dot(&right) * 0.7_f64.cos() + from.dot(&up) * 0.7_f64.sin()) / 300.0;
        let height = (bent.position(target) - target.surveyed).dot(&normal);
        assert!((height - 2.0 * (1.0 - s * s)).abs() < 1e-12, "{}", target.id);
    }
}

#[test]
fn what_a_stand_cannot_hold_is_named() {
    let field = field();
    let bend = StandBend { peak: 0.8, reach: 250.0, across: 0.0 };
    let refused = |stand: Stand| stations(&stand, &field).unwrap_err();
    let good = || stand(Some(bend));
    assert_eq!(refused(Stand { phis: vec![], ..good() }), StationError::Empty("phis"));
    assert_eq!(refused(Stand { turns: vec![], ..good() }), StationError::Empty("turns"));
    assert_eq!(refused(Stand { rolls: vec![], ..good() }), StationError::Empty("rolls"));
    for (parameter, stand) in [
        ("phis", Stand { phis: vec![0.1; 10], ..good() }),
        ("turns", Stand { turns: vec![0.1; 10], ..good() }),
        ("rolls", Stand { rolls: vec![0.1; 10], ..good() }),
    ] {
        assert_eq!(refused(stand), StationError::Many { parameter, found: 10, most: 9 });
    }
    assert_eq!(stations(&Stand { phis: vec![0.1; 9], ..good() }, &field).unwrap().last().unwrap().name, "1944");
    for (name, stand) in [
        ("phis", Stand { phis: vec![1.5], ..good() }),
        ("turns", Stand { turns: vec![f64::NAN], ..good() }),
        ("distance", Stand { distance: 0.0, ..good() }),
        ("bend", stand(Some(StandBend { peak: 60.0, ..bend }))),
        ("bend_reach", stand(Some(StandBend { reach: 0.0, ..bend }))),
        ("bend_across", stand(Some(StandBend { across: 7.0, ..bend }))),
    ] {
        let StationError::Parameter { parameter, .. } = refused(stand) else { panic!("{name}") };
        assert_eq!(parameter, name);
    }
    // 5.76 times the peak over half of the sheet, at most a quarter of its side.
    let most = 300.0 / 5.76;
    let peak = |peak| stations(&stand(Some(StandBend { peak, ..bend })), &field);
    assert!(peak(most * 0.97).is_ok() && peak(most * 1.05).is_err() && peak(-most * 1.05).is_err());
    let mut two = field.clone();
    two.plates.push(two.plates[0].clone());
    assert_eq!(stations(&stand(Some(bend)), &two), Err(StationError::Plates(2)));
    assert_eq!(stations(&stand(None), &two), stations(&stand(None), &field), "without a bend the field may have any form");
    let bent = Coded { bend: Some(SheetBend { peak: 0.8, across: 0.0 }), ..Coded::paper() }.generate(KEY).unwrap();
    assert_eq!(stations(&good(), &bent), Err(StationError::BentTwice("field".into())));
    // A stand that bends nothing holds a sheet that is bent itself, which then turns with the field.
    let own: Vec<Option<Bend>> = stations(&stand(None), &bent).unwrap().iter().map(|station| station.bend).collect();
    assert_eq!(own, [None; 36]);
}
