use calibench_model::boards::Board;

use super::super::{BoardSheet, Levels};
use super::*;
use crate::overlap::overlap;
use crate::testfield::outline::polygon;

const KEY: Key<'_> = Key { seed: 3, of: "print", trial: 0, view: "", target: "" };

fn field() -> Testfield {
    let board: Board = "chessboard:7x5:20".parse().unwrap();
    BoardSheet { board, margin: 20.0, bend: None, print_noise: 0.0, levels: Levels::default(), background: 0.2 }.generate(KEY).unwrap()
}

fn print() -> Print {
    Print { ragged_length: 2.0, ..Print::default() }
}

/// Corners of a sheet that is bent both ways, tilted, and printed with errors.
fn measured() -> Vec<(String, Point3<f64>)> {
    let field = field();
    let corner = |(k, target): (usize, &calibench_model::ObjectTarget)| {
        let (x, y) = (target.surveyed.x, target.surveyed.y);
        let error = |k: usize| 0.05 * (((k * 7919) % 101) as f64 / 50.0 - 1.0);
        let (x, y) = (x + error(k), y + error(k + 37));
        let height = 0.1 + 2e-3 * x - 1e-3 * y + 3e-5 * x * x - 1e-5 * x * y + 2e-5 * y * y;
        (target.id.clone(), Point3::new(x, y, height))
    };
    field.targets.iter().enumerate().map(corner).collect()
}

#[test]
fn corners_are_printed_where_the_file_has_them() {
    let corners = measured();
    let made = Print { corners: corners.clone(), ..print() }.applied(field(), KEY).unwrap();
    for (name, at) in &corners {
        let target = made.targets.iter().find(|target| target.id == *name).unwrap();
        let found = made.position(target);
        // Slopes of thousandths and heights of tenths: the sheet is no graph over its plane to 1e-6 of its size.
        assert!((found - at).norm() < 2e-3, "{name}: {found} {at}");
        assert!((found.z - at.z).abs() < 2e-4, "{name}");
        let meeting = made.plates[0].areas.iter().flat_map(|area| &area.outline.0).filter(|curve| curve.at(0.0) == target.at).count();
        assert_eq!(meeting, 2, "{name}: both dark squares meet in it");
        assert_eq!(target.surveyed, field().targets.iter().find(|target| target.id == *name).unwrap().surveyed);
    }
}

#[test]
fn ink_spreads_outwards_by_its_width_and_squares_still_meet_in_points() {
    for spread in [0.4, -0.3] {
        let (before, after) = (field(), Print { ink_spread: spread, ..print() }.applied(field(), KEY).unwrap());
        let sum = |field: &Testfield| field.plates[0].areas.iter().map(|area| doubled(&area.outline).abs() / 2.0).sum::<f64>();
        let squares = before.plates[0].areas.len() as f64;
        let ramp = 2.0 * spread.abs();
        let expected = squares * 4.0 * spread * (20.0 - ramp);
        assert!(((sum(&after) - sum(&before)) / expected - 1.0).abs() < 1e-9, "{spread}");
        let polygons: Vec<_> = after.plates[0].areas.iter().map(|area| polygon(&area.outline)).collect();
        for (i, a) in polygons.iter().enumerate() {
            assert!(polygons[..i].iter().all(|b| overlap(a, b).is_none()));
        }
        assert!(before.targets.iter().zip(&after.targets).all(|(a, b)| a.at == b.at));
    }
}

fn doubled(outline: &Outline) -> f64 {
    outline.0.iter().map(|curve| (curve.at(0.0), curve.at(1.0))).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
}

#[test]
fn ragged_edges_scatter_as_they_are_asked_to_and_are_the_same_under_one_seed() {
    let ragged = Print { ragged: 0.1, ..print() };
    let (made, again) = (ragged.applied(field(), KEY).unwrap(), ragged.applied(field(), KEY).unwrap());
    assert_eq!(made, again);
    assert_ne!(made, ragged.applied(field(), Key { seed: 4, ..KEY }).unwrap());
    // Nodes aside of the square's sides, which are whole multiples of 20 in x or y.
    let aside = |value: f64| (value / 20.0 - (value / 20.0).round()) * 20.0;
    let nodes = made.plates[0].areas.iter().flat_map(|area| area.outline.0.iter().map(|curve| curve.at(0.0)));
    let offsets: Vec<f64> =
        nodes.map(|at| [aside(at[0]), aside(at[1])]).map(|[x, y]| if x.abs() < y.abs() { x } else { y }).filter(|d| *d != 0.0).collect();
    let rms = (offsets.iter().map(|d| d * d).sum::<f64>() / offsets.len() as f64).sqrt();
    assert!(offsets.len() > 800 && (rms / 0.1 - 1.0).abs() < 0.06, "{} {rms}", offsets.len());
}

#[test]
fn what_cannot_be_is_named() {
    let wrong = |print: Print| match print.applied(field(), KEY) {
        Err(FieldError::Parameter { parameter, expected, .. }) => format!("{parameter}: {expected}"),
        other => panic!("{other:?}"),
    };
    let mut strange = measured();
    strange[0].0 = "r9c9".into();
    assert!(wrong(Print { corners: strange, ..print() }).contains("`r9c9` is none"));
    assert!(wrong(Print { corners: measured()[..5].to_vec(), ..print() }).contains("6 corners"));
    let mut far = measured();
    far[3].1.x += 8.0;
    assert!(wrong(Print { corners: far, ..print() }).contains("r1c4"));
    assert!(wrong(Print { ink_spread: 3.0, ..print() }).starts_with("ink_spread"));
    assert!(wrong(Print { ragged: 1.0, ..print() }).starts_with("ragged"));
}
