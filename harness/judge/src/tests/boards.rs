//! The board's share of what is not predicted.

use calibench_model::BoardCorner;
use calibench_random::{Key, Purpose, stream};
use calibench_records::judgement::{BoardShare, Summary};
use nalgebra::Vector3;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

use super::super::{judge, with_board};
use super::{BOARD, Material, material_of, options};

const MODEL: &str = "opencv4";

/// Corners off by `size` in each coordinate, mm.
fn moves(size: f64, trial: u64) -> Vec<Vector3<f64>> {
    let mut rng = stream(Key { seed: 7, of: "corners of boards", trial, view: "", target: "" }, Purpose::Layout);
    let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
    (0..BOARD.corners()).map(|_| size * Vector3::new(normal(), normal(), normal())).collect()
}

fn of(trial: u64, views: usize, moved: &[Vector3<f64>]) -> Material {
    material_of(Key { seed: 7, of: "boards", trial, view: "", target: "" }, views, &[0.06, 0.09], &|k| moved[k])
}

fn share(material: &Material) -> (BoardShare, f64, bool) {
    let options = options(&[MODEL], 1);
    let rows = with_board(judge(material, &options).unwrap(), material, &options);
    let summary = Summary::new(&rows, options.seed);
    let trusted = summary.trusted().unwrap();
    let is_misfit = trusted.doubt().is_some_and(|why| why.contains("board file"));
    (trusted.board().unwrap(), trusted.cell.holdout.unwrap().value, is_misfit)
}

/// How many of `count` perfect boards are to be measured, by what is said first.
fn alarms(count: u64, views: usize) -> usize {
    let perfect = vec![Vector3::zeros(); BOARD.corners()];
    (0..count).into_par_iter().filter(|trial| share(&of(*trial, views, &perfect)).0.decides()).count()
}

/// In at most one of a hundred: one of 300 is an upper bound (95 %) of 1.6 %.
#[test]
fn perfect_boards_need_not_be_measured() {
    let alarms = alarms(300, 7);
    assert!(alarms <= 1, "{alarms} of 300");
}

#[test]
#[ignore = "minutes: the same three thousand times, with fewer and with more photographs"]
fn perfect_boards_need_not_be_measured_of_many() {
    for views in [6, 8, 16] {
        let alarms = alarms(3000, views);
        assert!(alarms <= 15, "{alarms} of 3000 with {views} photographs");
    }
}

/// Errors of 0.06 px in each coordinate are 0.085 px of a point; predicted ones are larger by what the poses are wrong.
#[test]
fn a_board_that_decides_is_told_with_the_size_of_its_errors() {
    for trial in 0..6 {
        let moved = moves(0.12, trial);
        let (share, holdout, _) = share(&of(trial, 13, &moved));
        assert!(share.decides() && share.freed.p_better < 1e-6, "{share:?}");
        let rest = share.freed.holdout.value;
        assert!((0.08..0.105).contains(&rest) && holdout > 1.5 * rest, "{share:?}");
        assert!((share.board_px.powi(2) + rest.powi(2) - holdout * holdout).abs() < 1e-12);
        let of_moved = share.moved.unwrap();
        // Two coordinates of the plane; the datum takes a few per cent of it.
        assert!((of_moved.in_plane / (0.12 * 2.0_f64.sqrt()) - 1.0).abs() < 0.2, "{of_moved:?}");
        assert!((of_moved.across / 0.12 - 1.0).abs() < 0.35, "{of_moved:?}");
    }
}

#[test]
fn measured_corners_are_taken_where_they_are_those_of_the_board() {
    let (moved, others) = (moves(0.12, 1), moves(0.12, 2));
    let corner = |(k, moved): (usize, &Vector3<f64>)| BoardCorner {
        target: BOARD.target(k),
        position: [(k % 9) as f64 * 25.0 + moved.x, -((k / 9) as f64 * 25.0) + moved.y, moved.z],
        sigmas: [0.01; 3],
        covariances: None,
        nominal: None,
        photographs: None,
    };
    let with = |moves: &[Vector3<f64>]| {
        let material = of(3, 10, &moved);
        let corners: Vec<BoardCorner> = moves.iter().enumerate().map(corner).collect();
        let field = material.field.clone().measured(&corners).unwrap();
        assert_eq!((field.count(), field.name(10), field.lines().len()), (54, "r2c2".into(), 0));
        share(&Material { field, ..material })
    };
    let (own, holdout, misfits) = with(&moved);
    assert!(own.file_decides(holdout) && !own.decides() && !misfits, "{own:?}");
    assert!(holdout < 0.11, "{holdout}");
    let (other, holdout, misfits) = with(&others);
    assert!(other.file_misfits() && misfits && !other.file_decides(holdout), "{other:?}");
}
