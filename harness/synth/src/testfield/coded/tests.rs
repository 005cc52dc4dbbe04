use std::collections::BTreeMap;

use calibench_model::TargetKind;

use super::super::sheet_layout;
use super::*;

const KEY: Key<'_> = Key { seed: 1988, of: "coded", trial: 0, view: "", target: "" };

fn all() -> Coded {
    Coded { measured: 8, ..Coded::paper() }
}

#[test]
fn sixteen_targets_in_each_of_64_squares_equally_divided() {
    let field = all().generate(KEY).unwrap();
    assert_eq!(field.targets.len(), 1024);
    // The lines, the squares, the targets.
    assert_eq!(field.plates[0].areas.len(), 1 + 64 + 1024);
    let mut counts: BTreeMap<(String, TargetKind, &str), usize> = BTreeMap::new();
    for target in &field.targets {
        let mut parts = target.id.split('-');
        *counts.entry((parts.next().unwrap().into(), target.kind, parts.next().unwrap())).or_default() += 1;
    }
    assert_eq!(counts.len(), 64 * 8);
    assert!(counts.values().all(|&count| count == 2));
    let measured = Coded::paper().generate(KEY).unwrap();
    assert_eq!(measured.targets.len(), 256);
    assert_eq!(measured.plates, field.plates, "what is measured changes nothing that is printed");
    assert!(measured.targets.iter().all(|target| target.at.iter().all(|x| x.abs() < 250.0)));
}

#[test]
fn every_square_has_a_code_of_its_own_which_turning_does_not_change() {
    let field = all().generate(KEY).unwrap();
    let mut seen = [false; 64];
    for square in field.targets.chunks(16) {
        let large = |kind: TargetKind| {
            let both: Vec<_> = square.iter().filter(|t| t.kind == kind && t.id.contains("large")).map(|t| t.at).collect();
            [both[0], both[1]]
        };
        let pairs = [TargetKind::Square, TargetKind::Triangle, TargetKind::Cross, TargetKind::Disc].map(large);
        let number = code(&pairs);
        assert!(!std::mem::replace(&mut seen[usize::from(number)], true), "{number} twice");
        let turned = pairs.map(|pair| [pair[1], pair[0]].map(|[u, v]| [-v, u]));
        assert_eq!(code(&turned), number);
    }
}

#[test]
fn equal_targets_are_told_apart_by_the_other_size() {
    let field = all().generate(KEY).unwrap();
    for square in field.targets.chunks(16) {
        for pair in 0..8 {
            let other = (pair + 4) % 8;
            let middle = [0, 1].map(|i| 0.5 * (square[2 * other].at[i] + square[2 * other + 1].at[i]));
            let off = [0, 1].map(|k| (square[2 * pair + k].at[0] - middle[0]).hypot(square[2 * pair + k].at[1] - middle[1]));
            assert!(off[0] + 0.15 * all().cell() <= off[1], "{} {off:?}", square[2 * pair].id);
        }
    }
}

#[test]
fn targets_are_apart_inside_their_squares_and_the_lines_are_two_millimetres_wide() {
    let field = all().generate(KEY).unwrap();
    let areas = &field.plates[0].areas;
    let squares: Vec<_> =
        areas.iter().filter(|area| area.ground == 0.05).map(|area| super::super::outline::bounds(&area.outline)).collect();
    assert_eq!(squares.len(), 64);
    assert!((squares[1][0][0] - squares[0][1][0] - 2.0).abs() < 1e-9 && (squares[0][0][1] - squares[8][1][1] - 2.0).abs() < 1e-9);
    for (targets, corners) in field.targets.chunks(16).zip(squares) {
        let outlined: Vec<_> = targets
            .iter()
            .map(|t| {
                let shape = SHAPES.into_iter().find(|shape| shape.kind() == t.kind).unwrap();
                (t.id.as_str(), shape.outlines(t.at, t.size, t.axes[0][1].atan2(t.axes[0][0])))
            })
            .collect();
        sheet_layout::check("field", corners, &outlined).unwrap();
    }
}

#[test]
fn size_groups_are_in_the_order_of_the_papers_table_3() {
    let field = all();
    let area =
        |shape: usize, size: f64| size * size * [1.0, 3.0_f64.sqrt() / 4.0, 2.0 / 3.0 - 1.0 / 9.0, std::f64::consts::PI / 4.0][shape];
    let group = |sizes: [f64; 4], shapes: [usize; 2]| shapes.map(|shape| area(shape, sizes[shape]));
    let groups = [group(field.small, [0, 1]), group(field.small, [2, 3]), group(field.large, [0, 1]), group(field.large, [2, 3])];
    for pair in groups.windows(2) {
        assert!(pair[0].iter().all(|below| pair[1].iter().all(|above| 1.15 * below < *above)), "{groups:?}");
    }
    let range = |sizes: [f64; 4]| (sizes.into_iter().fold(f64::MAX, f64::min), sizes.into_iter().fold(0.0, f64::max));
    assert_eq!((range(field.small), range(field.large)), ((9.0, 15.0), (17.0, 25.0)), "table 2");
}

#[test]
fn the_sheet_is_bent_by_eight_tenths_and_seeds_matter() {
    let field = Coded::paper().generate(KEY).unwrap();
    assert_eq!(field.plates[0].point([0.0, 300.0]).z, 0.8);
    assert!(field.targets.iter().all(|target| target.surveyed.z == 0.0));
    assert_eq!(field, Coded::paper().generate(KEY).unwrap());
    assert_ne!(field, Coded::paper().generate(Key { seed: 1, ..KEY }).unwrap());
    assert_eq!(Coded { squares: 1, measured: 1, ..Coded::paper() }.generate(KEY).unwrap().targets.len(), 16);
}

#[test]
fn bad_parameters_are_named() {
    let c = Coded::paper();
    let bad = [
        ("squares", Coded { squares: 9, ..c }),
        ("squares", Coded { squares: 0, ..c }),
        ("measured", Coded { measured: 10, ..c }),
        ("measured", Coded { measured: 3, ..c }),
        ("spacing", Coded { spacing: f64::NAN, ..c }),
        ("line", Coded { line: 0.0, ..c }),
        ("line", Coded { line: 40.0, ..c }),
        ("small", Coded { small: [9.0, -1.0, 9.0, 9.0], ..c }),
        ("large", Coded { large: [17.0, 40.0, 17.0, 17.0], ..c }),
        ("sheet", Coded { sheet: 1000.0, ..c }),
        ("bend", Coded { bend: Some(SheetBend { peak: 1e4, across: 0.0 }), ..c }),
        ("ink", Coded { levels: Levels { paper: 0.1, ink: f64::NAN }, ..c }),
        ("background", Coded { background: 2.0, ..c }),
    ];
    for (name, coded) in bad {
        match coded.generate(KEY) {
            Err(FieldError::Parameter { parameter, .. }) => assert_eq!(parameter, name),
            other => panic!("{name}: {other:?}"),
        }
    }
}
