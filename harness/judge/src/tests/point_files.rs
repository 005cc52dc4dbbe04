//! Point files in the place of operators.

use calibench_exchange::points::parse_points;
use calibench_model::{PointRef, PointRow, Start};

use super::*;
use crate::Expected;

/// What the operators of `material` measured, each as a point file.
fn files(material: &Material) -> Vec<(Arc<str>, calibench_exchange::PointFile)> {
    let all: Vec<usize> = (0..material.views.len()).collect();
    let file = |operator: usize| {
        let points = material.points(operator, &all);
        (material.operators[operator].method.clone(), calibench_exchange::PointFile { points, ..Default::default() })
    };
    (0..material.operators.len()).map(file).collect()
}

fn expected() -> Expected {
    Expected::new(Field::Board { board: BOARD, side: SIDE }, SIZE)
}

fn read(material: &Material) -> Material {
    let files = files(material);
    let named: Vec<_> = files.iter().map(|(name, file)| (name, file)).collect();
    Material::of_files(&named, &Expected::new(material.field.clone(), material.size))
}

#[test]
fn files_are_judged_as_the_operators_that_wrote_them() {
    let measured = material("files", 0, 6, &[0.05, 0.2]);
    let options = options(&["opencv4"], 1);
    let (rows, summary) = judged(&read(&measured), &options);
    assert!(rows == judge(&measured, &options).unwrap());
    assert_eq!(&*summary.trusted().unwrap().cell.method, "operator-1");
}

#[test]
fn a_file_is_held_against_the_corners_that_some_file_has() {
    // A third of the board is in no file: a detector that saw a part of it.
    let mut measured = material("files", 1, 6, &[0.1, 0.1]);
    for operator in &mut measured.operators {
        operator.at.iter_mut().for_each(|view| view[..18].fill(None));
    }
    measured.operators[1].at[0][20] = None;
    let read = read(&measured);
    assert_eq!(read.tried(), [36; 6]);
    let (_, summary) = judged(&read, &options(&["opencv4"], 1));
    assert_eq!((summary.methods[1].found, summary.methods[1].of, summary.common), (6 * 36 - 1, 6 * 36, 6 * 36 - 1));
    assert!(summary.is_compared("operator-1") && summary.trusted().is_some());
}

#[test]
fn what_a_file_says_of_lost_corners_is_kept() {
    let text = "image,target,x,y,method,status,reason\na,r1c1,1,2,m,measured,\na,r1c2,,,m,rejected,border\na,r1c3,,,m,unavailable,no\n\
                b,,,,m,rejected,no board\na,x,,,m,rejected,border\n";
    let file = parse_points("p.csv", text.as_bytes()).unwrap();
    let material = Material::of_files(&[(&"p".into(), &file)], &expected());
    assert_eq!(material.operators[0].rejected, [(0, 1, "border".into())]);
    assert_eq!(material.tried(), [2]);
    assert_eq!(material.missed, [("b".into(), "no board".to_owned())]);
}

#[test]
fn rows_name_a_corner_of_the_board_within_the_image() {
    let expected = expected();
    let checked = |target: &str, x: f64, y: f64| {
        let row = PointRow { image: "a".into(), target: target.into(), start: Start::at(PixelPoint::new(x, y)) };
        expected.check(&PointRef::from(&row))
    };
    for (x, y) in [(-0.5, -0.5), (639.5, 479.5)] {
        assert_eq!(checked("r6c9", x, y), Ok(()));
    }
    for (x, y, column, says) in [
        (-0.51, 5.0, "x", "-0.51 px is outside the image: expected -0.5 to 639.5 with --size 640x480"),
        (639.51, 481.0, "x", "639.51 px is outside"),
        (5.0, 479.51, "y", "expected -0.5 to 479.5 "),
    ] {
        let (found, problem) = checked("r1c1", x, y).unwrap_err();
        assert!(found == column && problem.contains(says), "{found}: {problem}");
    }
    for (target, says) in
        [("r1c10", "; is it `r1c1`?"), ("P0", "`P0` is no inner corner of a board of 9 x 6: expected `r1c1` (row 1, column 1) to `r6c9`")]
    {
        let (column, problem) = checked(target, 5.0, 5.0).unwrap_err();
        assert!(column == "target" && problem.contains(says), "{problem}");
    }
}
