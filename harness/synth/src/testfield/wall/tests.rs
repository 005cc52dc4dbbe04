use calibench_model::TargetKind;

use super::super::{Arrangement, Panels, Turn};
use super::*;

const KEY: Key<'_> = Key { seed: 8, of: "wall", trial: 0, view: "", target: "" };

const SHAPES: [Shape; 6] = [
    Shape::Cross { bar: 0.3 },
    Shape::Chess,
    Shape::Disc,
    Shape::Square,
    Shape::Triangle,
    Shape::Corner { angle: std::f64::consts::FRAC_PI_3 },
];

fn panels() -> Panels {
    Panels { rows: 2, columns: 3, size: [1.5, 1.2], gap: 0.1, relief: 0.3, tilt: 0.2, levels: Levels::default() }
}

fn wall(arrangement: Arrangement) -> Wall {
    let fill = Fill { shapes: SHAPES.to_vec(), size: 0.04, arrangement, turn: Turn::Random };
    Wall { sheets: panels().sheets(KEY).unwrap(), targets: Vec::new(), fill: Some(fill), survey_sigma: 0.0, background: 0.2 }
}

fn explicit() -> Wall {
    let sheet = Sheet {
        id: "front".into(),
        middle: Point3::new(0.0, 5.0, 2.0),
        u: Vector3::new(0.0, -2.0, 0.0),
        v: Vector3::z(),
        size: [4.0, 2.0],
        bend: None,
        levels: Levels::default(),
        shift: Vector3::new(0.002, 0.0, -0.001),
    };
    let target =
        WallTarget { id: "t1".into(), plate: "front".into(), shape: Shape::Disc, at: [1.0, 0.5], size: 0.1, turn: 0.0, surveyed: None };
    Wall { sheets: vec![sheet], targets: vec![target], fill: None, survey_sigma: 0.0, background: 0.2 }
}

#[test]
fn a_grid_fills_all_panels_with_all_shapes() {
    let field = wall(Arrangement::Grid { rows: 4, columns: 6 }).generate(KEY).unwrap();
    assert_eq!((field.plates.len(), field.targets.len()), (6, 144));
    assert_eq!(field.targets[25].id, "p1-2/2");
    for kind in [TargetKind::Cross, TargetKind::ChessCorner, TargetKind::Disc, TargetKind::Square, TargetKind::Triangle, TargetKind::Corner]
    {
        assert_eq!(field.targets.iter().filter(|t| t.kind == kind).count(), 24);
    }
    assert!(field.targets.iter().all(|t| (field.position(t) - t.surveyed).norm() < 1e-12));
    // Two squares for each chess target.
    assert_eq!(field.plates.iter().map(|plate| plate.areas.len()).sum::<usize>(), 168);
}

#[test]
fn random_targets_keep_their_distance_and_their_seed() {
    let wall = wall(Arrangement::Random { count: 60, distance: 0.13 });
    let field = wall.generate(KEY).unwrap();
    assert_eq!(field.targets.len(), 360);
    for (i, a) in field.targets.iter().enumerate() {
        for b in field.targets[..i].iter().filter(|b| b.plate == a.plate) {
            assert!((a.at[0] - b.at[0]).hypot(a.at[1] - b.at[1]) >= 0.13);
        }
    }
    assert_eq!(field, wall.generate(KEY).unwrap());
    assert_ne!(field, wall.generate(Key { trial: 1, ..KEY }).unwrap());
}

#[test]
fn a_hundred_thousand_targets_find_their_places() {
    let fill = Fill {
        shapes: vec![Shape::Disc, Shape::Square],
        size: 0.01,
        arrangement: Arrangement::Random { count: 100_000, distance: 0.015 },
        turn: Turn::Random,
    };
    let mut wall = explicit();
    wall.sheets[0].size = [10.0, 10.0];
    let field = Wall { targets: Vec::new(), fill: Some(fill), ..wall }.generate(KEY).unwrap();
    assert_eq!(field.targets.len(), 100_000);
}

#[test]
fn a_full_sheet_says_how_many_found_a_place() {
    match wall(Arrangement::Random { count: 1000, distance: 0.13 }).generate(KEY) {
        Err(FieldError::Crowded { placed, wanted: 1000, plate }) => assert!((60..130).contains(&placed) && plate == "p1-1", "{placed}"),
        other => panic!("{other:?}"),
    }
    let overlapping = wall(Arrangement::Random { count: 500, distance: 0.02 }).generate(KEY);
    assert!(matches!(overlapping, Err(FieldError::Overlap { .. })), "{overlapping:?}");
}

#[test]
fn strewn_targets_leave_room_for_the_given_ones() {
    let mut wall = wall(Arrangement::Random { count: 40, distance: 0.12 });
    wall.targets.push(WallTarget { plate: "p1-1".into(), at: [0.1, 0.0], size: 0.8, ..explicit().targets[0].clone() });
    let field = wall.generate(KEY).unwrap();
    assert_eq!((field.targets.len(), field.targets[0].id.as_str()), (241, "t1"));
}

#[test]
fn the_survey_saw_the_wall_before_it_moved_and_errs() {
    let field = explicit().generate(KEY).unwrap();
    let target = &field.targets[0];
    assert!((target.surveyed - Point3::new(0.0, 4.0, 2.5)).norm() < 1e-12);
    assert!((field.position(target) - Point3::new(0.002, 4.0, 2.499)).norm() < 1e-12);
    assert!((field.plates[0].normal() + Vector3::x()).norm() < 1e-12, "u x v, whatever the length of u");

    let field = Wall { survey_sigma: 0.003, ..wall(Arrangement::Grid { rows: 8, columns: 10 }) }.generate(KEY).unwrap();
    let errors: Vec<f64> =
        field.targets.iter().flat_map(|t| (t.surveyed - field.position(t)).iter().copied().collect::<Vec<_>>()).collect();
    let n = errors.len() as f64;
    let variance = errors.iter().map(|e| e * e).sum::<f64>() / n / 9e-6;
    // Five standard errors, of a seed fixed beforehand.
    assert!((variance - 1.0).abs() < 5.0 * (2.0 / n).sqrt(), "{variance}");
}

#[test]
fn a_given_survey_is_taken_as_it_is() {
    let mut wall = Wall { survey_sigma: 1.0, ..explicit() };
    wall.targets[0].surveyed = Some(Point3::new(1.0, 2.0, 3.0));
    assert_eq!(wall.generate(KEY).unwrap().targets[0].surveyed, Point3::new(1.0, 2.0, 3.0));
}

fn changed(change: impl FnOnce(&mut Wall)) -> FieldError {
    let mut wall = explicit();
    change(&mut wall);
    wall.generate(KEY).unwrap_err()
}

#[test]
fn bad_numbers_are_named() {
    let with_fill =
        |arrangement, shape, size| move |w: &mut Wall| w.fill = Some(Fill { shapes: vec![shape], size, arrangement, turn: Turn::Random });
    let (grid, random) = (|rows, columns| Arrangement::Grid { rows, columns }, |count, distance| Arrangement::Random { count, distance });
    let bad = [
        ("width", changed(|w| w.sheets[0].size[0] = 0.0)),
        ("height", changed(|w| w.sheets[0].size[1] = f64::NAN)),
        ("middle", changed(|w| w.sheets[0].middle.x = f64::INFINITY)),
        ("shift", changed(|w| w.sheets[0].shift.x = f64::NAN)),
        ("bend", changed(|w| w.sheets[0].bend = Some(SheetBend { peak: 1.0, across: 0.0 }))),
        ("paper", changed(|w| w.sheets[0].levels.paper = 2.0)),
        ("size", changed(|w| w.targets[0].size = -1.0)),
        ("turn", changed(|w| w.targets[0].turn = f64::NAN)),
        ("at", changed(|w| w.targets[0].at[1] = f64::NAN)),
        ("surveyed", changed(|w| w.targets[0].surveyed = Some(Point3::new(f64::NAN, 0.0, 0.0)))),
        ("angle", changed(|w| w.targets[0].shape = Shape::Corner { angle: 0.1 })),
        ("bar", changed(|w| w.targets[0].shape = Shape::Cross { bar: 0.9 })),
        ("survey_sigma", changed(|w| w.survey_sigma = -1.0)),
        ("background", changed(|w| w.background = 3.0)),
        ("rows", changed(with_fill(grid(0, 3), Shape::Disc, 0.1))),
        ("columns", changed(with_fill(grid(3, 0), Shape::Disc, 0.1))),
        ("count", changed(with_fill(random(0, 0.1), Shape::Disc, 0.1))),
        ("distance", changed(with_fill(random(1, f64::NAN), Shape::Disc, 0.1))),
        ("size", changed(with_fill(grid(1, 1), Shape::Disc, 0.0))),
        ("angle", changed(with_fill(grid(1, 1), Shape::Corner { angle: 3.0 }, 0.1))),
        (
            "turn",
            changed(|w| {
                let arrangement = Arrangement::Grid { rows: 1, columns: 1 };
                w.fill = Some(Fill { shapes: vec![Shape::Disc], size: 0.1, arrangement, turn: Turn::Fixed(99.0) });
            }),
        ),
    ];
    for (name, error) in bad {
        assert!(matches!(&error, FieldError::Parameter { parameter, .. } if *parameter == name), "{name}: {error}");
    }
}

#[test]
fn what_does_not_fit_together_is_told() {
    assert_eq!(changed(|w| w.sheets.clear()), FieldError::Nothing("plates"));
    assert_eq!(changed(|w| w.targets.clear()), FieldError::Nothing("targets"));
    assert_eq!(changed(|w| w.sheets[0].u = Vector3::zeros()), FieldError::Axes("front".into()));
    assert_eq!(changed(|w| w.sheets[0].v = Vector3::new(0.0, 1.0, 1.0)), FieldError::Axes("front".into()));
    assert_eq!(changed(|w| w.sheets.push(w.sheets[0].clone())), FieldError::Twice { what: "plate", id: "front".into() });
    assert_eq!(changed(|w| w.targets.push(w.targets[0].clone())), FieldError::Twice { what: "target", id: "t1".into() });
    assert!(matches!(changed(|w| w.targets[0].plate = "back".into()), FieldError::UnknownPlate { .. }));
    assert!(matches!(changed(|w| w.targets[0].at = [1.97, 0.0]), FieldError::OffPlate { .. }));
}
