//! The field against its covariance, its derivatives, and its inverse.

use super::*;

const SIZE: ImageSize = ImageSize { width: 120, height: 90 };
const KEY: Key<'_> = Key { seed: 20, of: "s", trial: 0, view: "", target: "" };
const DESIGN: LocalDesign = LocalDesign { sigma: 0.4, correlation: 15.0 };

fn field(design: LocalDesign, seed: u64) -> LocalDistortion {
    LocalDistortion::draw(design, SIZE, Key { seed, ..KEY }).unwrap()
}

/// A place of the frame, others with others of `index`, pixel by pixel and between.
fn place(index: u32) -> PixelPoint {
    let part = |shift: u32| f64::from(index.wrapping_mul(2_654_435_761).rotate_left(shift) >> 8) / f64::from(1 << 24);
    PixelPoint::new(-0.5 + 120.0 * part(0), -0.5 + 90.0 * part(11))
}

/// Means of products over draws: of a component with itself at a distance, with the other component, and of derivatives.
#[test]
fn sigma_and_correlation_are_those_that_were_asked_for() {
    const DRAWS: u64 = 4000;
    // The middle, a corner of the frame, and a place between nodes.
    for at in [PixelPoint::new(60.0, 45.0), PixelPoint::new(-0.5, 89.5), PixelPoint::new(13.7, 71.2)] {
        let lags = [[0.0, 0.0], [7.5, 0.0], [0.0, -15.0], [18.0, -24.0], [45.0, 0.0]];
        let (mut products, mut crossed, mut slopes) = ([[0.0; 2]; 5], 0.0, [[0.0; 2]; 2]);
        let inward = |lag: [f64; 2]| PixelPoint::new(at.x + lag[0], at.y + lag[1]);
        for seed in 0..DRAWS {
            let field = field(DESIGN, seed);
            let here = field.at(at);
            for (product, lag) in products.iter_mut().zip(lags) {
                let there = field.at(inward(lag));
                (0..2).for_each(|axis| product[axis] += here.by[axis] * there.by[axis]);
            }
            crossed += here.by[0] * here.by[1];
            (0..4).for_each(|i| slopes[i / 2][i % 2] += here.slope[i / 2][i % 2].powi(2));
        }
        // The mean of a product of two normal numbers of correlation r has the variance (1 + r^2) / n: five standard errors.
        let (n, variance) = (DRAWS as f64, DESIGN.sigma * DESIGN.sigma);
        for (product, [dx, dy]) in products.iter().zip(lags) {
            let expected = (-(dx * dx + dy * dy) / (2.0 * DESIGN.correlation.powi(2))).exp();
            let bound = 5.0 * ((1.0 + expected * expected) / n).sqrt();
            let found = product.map(|sum| sum / n / variance);
            assert!(found.iter().all(|found| (found - expected).abs() < bound), "({dx}, {dy}) at {at:?}: {found:?}, expected {expected}");
        }
        assert!((crossed / n / variance).abs() < 5.0 / n.sqrt(), "components are independent: {crossed}");
        let slope = (DESIGN.sigma / DESIGN.correlation).powi(2);
        for found in slopes.iter().flatten().map(|sum| sum / n / slope) {
            assert!((found - 1.0).abs() < 5.0 * (2.0 / n).sqrt(), "{found} at {at:?}");
        }
    }
}

/// The variance does not depend on where a place lies among the nodes: the sum of the squared Gaussians, which no draw blurs.
#[test]
fn the_variance_is_even() {
    let field = field(DESIGN, 1);
    let variance = |at: PixelPoint| {
        let (x, y) = (field.near::<false>(at.x, field.columns), field.near::<false>(at.y, field.rows));
        let sum = |near: &Near| near.values.iter().map(|value| value * value).sum::<f64>();
        sum(&x) * sum(&y) * STEP * STEP / std::f64::consts::FRAC_PI_2
    };
    let worst = (0..1000).map(|i| (variance(place(i)) - 1.0).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-4, "{worst:e}");
}

/// Inside, at the edges of the lattice, and beyond: as the sum over every node within the cut says it.
#[test]
fn the_field_is_the_sum_over_its_nodes() {
    let field = field(DESIGN, 5);
    let at_node = |node: usize| (node as f64 * STEP - CUT) * DESIGN.correlation - 0.5;
    let gaussian = |x: f64, node: usize| {
        let t = (x - at_node(node)) / DESIGN.correlation;
        if t.abs() <= CUT { (-t * t).exp() } else { 0.0 }
    };
    let wide = |at: PixelPoint| PixelPoint::new(2.5 * at.x - 90.0, 3.0 * at.y - 90.0);
    for at in (0..500).map(place).chain((0..500).map(place).map(wide)) {
        let mut sums = [0.0; 2];
        for (i, weight) in field.weights.iter().enumerate() {
            let factor = gaussian(at.x, i % field.columns) * gaussian(at.y, i / field.columns);
            (0..2).for_each(|axis| sums[axis] += factor * weight[axis]);
        }
        let found = field.displaced(at);
        assert!((found.x - at.x - sums[0]).hypot(found.y - at.y - sums[1]) < 1e-13, "{at:?}: {found:?}, by all nodes {sums:?}");
        let [dx, dy] = field.at(at).by;
        assert_eq!(PixelPoint::new(at.x + dx, at.y + dy), found);
    }
}

#[test]
fn derivatives_are_differences() {
    let field = field(DESIGN, 2);
    let h = 1e-3;
    for at in (0..200).map(place) {
        let slope = field.at(at).slope;
        let along = |dx: f64, dy: f64| {
            let (high, low) = (field.at(PixelPoint::new(at.x + dx, at.y + dy)).by, field.at(PixelPoint::new(at.x - dx, at.y - dy)).by);
            [0, 1].map(|axis| (high[axis] - low[axis]) / (2.0 * h))
        };
        let (by_x, by_y) = (along(h, 0.0), along(0.0, h));
        for axis in 0..2 {
            assert!((slope[axis][0] - by_x[axis]).abs() < 1e-8, "{at:?}: {slope:?} {by_x:?}");
            assert!((slope[axis][1] - by_y[axis]).abs() < 1e-8, "{at:?}: {slope:?} {by_y:?}");
        }
    }
}

/// At the steepest that is allowed: no fold anywhere, and every place found again.
#[test]
fn the_steepest_field_is_one_to_one() {
    let design = LocalDesign { sigma: 0.8, correlation: 8.0 };
    for seed in 0..20 {
        let field = field(design, seed);
        for at in (0..2000).map(place) {
            let [[xx, xy], [yx, yy]] = field.at(at).slope;
            assert!((1.0 + xx) * (1.0 + yy) - xy * yx > 0.1, "{at:?}");
            assert!(field.undisplaced(field.displaced(at)).distance(at) < 1e-10, "{at:?}");
            assert!(field.displaced(at).distance(at) < field.reach());
        }
    }
}

#[test]
fn seed_and_trial_make_it_and_nothing_else() {
    let of = |key| LocalDistortion::draw(DESIGN, SIZE, key).unwrap();
    let one = of(KEY);
    assert_eq!(one, of(Key { of: "another", view: "1211", target: "t", ..KEY }));
    assert_ne!(one, of(Key { seed: 21, ..KEY }));
    assert_ne!(one, of(Key { trial: 1, ..KEY }));
}

#[test]
fn far_away_there_is_nothing() {
    let field = field(DESIGN, 3);
    for (x, y) in [(-1e9, 0.0), (60.0, 1e12), (1e5, -1e5), (f64::INFINITY, 0.0)] {
        assert_eq!(field.at(PixelPoint::new(x, y)), Shift::default());
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let refused = |sigma, correlation| LocalDesign { sigma, correlation }.check(SIZE).unwrap_err();
    assert_eq!(refused(0.0, 15.0), LocalError::Number { parameter: "sigma", value: 0.0 });
    assert_eq!(refused(0.1, f64::INFINITY), LocalError::Number { parameter: "correlation", value: f64::INFINITY });
    assert_eq!(refused(1.6, 15.0), LocalError::Fold { sigma: 1.6, correlation: 15.0 });
    assert!(LocalDesign { sigma: 1.5, correlation: 15.0 }.check(SIZE).is_ok());
    let large = ImageSize { width: 20_000, height: 20_000 };
    let fine = LocalDesign { sigma: 0.03, correlation: 3.0 }.check(large).unwrap_err();
    let LocalError::Fine { least, .. } = fine else { panic!("{fine}") };
    assert!(least > 15.0 && LocalDesign { sigma: 0.03, correlation: least }.check(large).is_ok(), "{least}");
}
