use nalgebra::{DMatrix, Matrix3};
use proptest::prelude::{prop_assert, proptest};

use super::*;
use crate::approximate::tests::Chance;

fn random(chance: &mut Chance) -> Homography {
    let m = Matrix3::from_fn(|i, j| if i == j { 1.0 } else { 0.2 * chance.normal() / if i == 2 { 3.0 } else { 1.0 } });
    Homography { matrix: m / m.norm() }
}

fn pairs(chance: &mut Chance, h: &Homography, count: usize, sigma: f64) -> Vec<([f64; 2], [f64; 2])> {
    let mut pairs = Vec::new();
    while pairs.len() < count {
        let at = [chance.between(-1.0, 1.0), chance.between(-1.0, 1.0)];
        if let Some([x, y]) = h.map(at).filter(|[x, y]| x.abs() < 5.0 && y.abs() < 5.0) {
            pairs.push((at, [x + sigma * chance.normal(), y + sigma * chance.normal()]));
        }
    }
    pairs
}

/// The textbook's way: the singular vector of 2n x 9.
fn by_singular_vector(pairs: &[([f64; 2], [f64; 2])]) -> Matrix3<f64> {
    let mut a = DMatrix::zeros(2 * pairs.len().max(5), 9);
    for (i, &([x, y], [u, v])) in pairs.iter().enumerate() {
        a.row_mut(2 * i).copy_from_slice(&[x, y, 1.0, 0.0, 0.0, 0.0, -u * x, -u * y, -u]);
        a.row_mut(2 * i + 1).copy_from_slice(&[0.0, 0.0, 0.0, x, y, 1.0, -v * x, -v * y, -v]);
    }
    let v = a.svd(false, true).v_t.unwrap();
    let m = Matrix3::from_row_slice(v.row(8).transpose().as_slice());
    m / m.norm()
}

fn difference(a: &Matrix3<f64>, b: &Matrix3<f64>) -> f64 {
    (a - b).norm().min((a + b).norm())
}

proptest! {
    #[test]
    fn exact_points_give_the_exact_map(seed in 0_u64..1_000_000, count in 8_usize..60) {
        let mut chance = Chance::new(seed);
        let truth = random(&mut chance);
        let pairs = pairs(&mut chance, &truth, count, 0.0);
        let found = homography(&pairs).unwrap();
        prop_assert!(difference(&found.matrix, &truth.matrix) < 1e-9, "{found:?} {truth:?}");
        prop_assert!(difference(&found.matrix, &by_singular_vector(&pairs)) < 1e-9);
        let (refined, squares) = refine_homography(&found, &pairs).unwrap();
        prop_assert!(squares < 1e-20 && difference(&refined.matrix, &truth.matrix) < 1e-9);
    }

    #[test]
    fn the_unit_and_the_origin_do_not_matter(seed in 0_u64..1_000_000, scale in 1e-3..1e4_f64, shift in -1e4..1e4_f64) {
        let mut chance = Chance::new(seed);
        let truth = random(&mut chance);
        let plain = pairs(&mut chance, &truth, 20, 1e-3);
        let moved: Vec<_> = plain.iter().map(|&(a, [u, v])| (a, [scale * u + shift, scale * v])).collect();
        let (found, other) = (homography(&plain).unwrap(), homography(&moved).unwrap());
        for (a, _) in plain {
            let ([u, v], [x, y]) = (found.map(a).unwrap(), other.map(a).unwrap());
            let tolerance = 1e-8 * (scale + shift.abs());
            prop_assert!((scale * u + shift - x).abs() < tolerance && (scale * v - y).abs() < tolerance);
        }
    }
}

#[test]
fn four_corners_of_a_square_are_enough() {
    let pairs = [([0.0, 0.0], [10.0, 20.0]), ([1.0, 0.0], [110.0, 30.0]), ([1.0, 1.0], [120.0, 150.0]), ([0.0, 1.0], [0.0, 110.0])];
    let found = homography(&pairs).unwrap();
    for (a, [u, v]) in pairs {
        let [x, y] = found.map(a).unwrap();
        assert!((x - u).abs() < 1e-10 && (y - v).abs() < 1e-10);
    }
}

#[test]
fn refining_lowers_the_residuals_to_a_flat_place() {
    let mut chance = Chance::new(5);
    let truth = random(&mut chance);
    let pairs = pairs(&mut chance, &truth, 30, 0.01);
    let squares = |h: &Homography| {
        let distance = |&(a, [u, v]): &([f64; 2], [f64; 2])| h.map(a).map(|[x, y]| (x - u).powi(2) + (y - v).powi(2));
        pairs.iter().map(|pair| distance(pair).unwrap()).sum::<f64>()
    };
    let start = homography(&pairs).unwrap();
    let (refined, least) = refine_homography(&start, &pairs).unwrap();
    assert!((squares(&refined) - least).abs() < 1e-12 && least < squares(&start));
    // Sixty residuals, eight unknowns.
    assert!(least < 2.0 * 52.0 * 1e-4 && least > 0.5 * 52.0 * 1e-4, "{least}");
    for i in 0..9 {
        for step in [-1e-5, 1e-5] {
            let mut h = refined;
            h.matrix[i] += step;
            assert!(squares(&h) > least - 1e-15);
        }
    }
}

#[test]
fn degenerate_points_are_named() {
    let on_line: Vec<_> = (0..9).map(|i| ([f64::from(i), 2.0 * f64::from(i)], [f64::from(i * i), f64::from(i)])).collect();
    assert_eq!(homography(&on_line), Err(ApproximateError::Collinear));
    let flattened: Vec<_> = (0..9).map(|i| ([f64::from(i % 3), f64::from(i / 3)], [f64::from(i), 2.0 * f64::from(i)])).collect();
    assert_eq!(homography(&flattened), Err(ApproximateError::ImageCollinear));
    let mut but_one = on_line.clone();
    but_one[3].0 = [0.0, 7.0];
    assert_eq!(homography(&but_one), Err(ApproximateError::Collinear));
    let same = [([1.0, 1.0], [2.0, 3.0]); 5];
    assert_eq!(homography(&same), Err(ApproximateError::Collinear));
    assert!(matches!(homography(&on_line[..3]), Err(ApproximateError::TooFew { needed: 4, found: 3, .. })));
    let mut broken = flattened;
    broken[2].1[0] = f64::NAN;
    assert_eq!(homography(&broken), Err(ApproximateError::NotFinite { index: 2 }));
}
