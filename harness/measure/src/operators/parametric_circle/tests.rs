use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::blurred_ellipse::{self, Exact, FINE, Picture};
use crate::ellipse::Ellipse;
use crate::registry::Registry;
use crate::tests::bound::{Pool, bound, noisy};
use crate::tests::quadrature_images;

/// A dark ellipse of semi-axes `radius` and `radius * squeeze` on light ground, in the middle of a window of [`SIDE`] px.
pub(crate) fn disc(radius: f64, squeeze: f64, turn: f64, blur: f64, phase: [f64; 2]) -> quadrature_images::Ellipse {
    let (sin, cos) = turn.sin_cos();
    let (p, q) = (radius, radius * squeeze);
    let shape = [p * cos * cos + q * sin * sin, (p - q) * sin * cos, p * sin * sin + q * cos * cos];
    quadrature_images::Ellipse { position: phase.map(|c| (SIDE / 2) as f64 + c), shape, blur, inside: 0.2, outside: 0.8 }
}

pub(crate) const SIDE: usize = 35;

pub(crate) fn operator(spec: &str) -> Box<dyn Operator> {
    Registry::builtin().parse(spec).unwrap().operator.unwrap()
}

pub(crate) fn bound_of(disc: &quadrature_images::Ellipse) -> f64 {
    let ([x, y], [a, b, c]) = (disc.position, disc.shape);
    bound([x, y, a, b, c, disc.blur, disc.outside, disc.inside], |x| {
        let there =
            quadrature_images::Ellipse { position: [x[0], x[1]], shape: [x[2], x[3], x[4]], blur: x[5], outside: x[6], inside: x[7] };
        there.render(SIDE)
    })
}

/// Pooled squared errors in units of the bound and of the operator's own variance, cell by cell printed.
pub(crate) fn pools(spec: &str, seed: u64) -> [Pool; 2] {
    let operator = operator(spec);
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut pools = [Pool::default(); 2];
    println!("{spec}: radius px, blur px: RMSE / bound at noise of 0.5, 2, 10 % of the contrast");
    for (radius, squeeze) in [(3.0, 0.8), (5.0, 1.0), (8.0, 0.5)] {
        for blur in [0.3, 0.7, 1.5] {
            let mut cells = [Pool::default(); 3];
            for _ in 0..2 {
                let phase = [rng.random_range(-0.5..0.5), rng.random_range(-0.5..0.5)];
                let disc = disc(radius, squeeze, rng.random_range(0.0..3.0), blur, phase);
                let (grey, trace) = (disc.render(SIDE), bound_of(&disc));
                for (cell, noise) in cells.iter_mut().zip([0.005, 0.02, 0.1]) {
                    let sigma = noise * (disc.outside - disc.inside);
                    for _ in 0..60 {
                        let image = quadrature_images::image(&noisy(&grey, sigma, &mut rng), SIDE);
                        let (dx, dy) = (rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0));
                        let start = Start::at(PixelPoint::new(disc.position[0] + dx, disc.position[1] + dy));
                        let found = operator.measure(&image, &start).unwrap();
                        let error = (found.position.x - disc.position[0]).powi(2) + (found.position.y - disc.position[1]).powi(2);
                        cell.add(error / (trace * sigma * sigma));
                        pools[1].add(found.covariance.map_or(f64::NAN, |covariance| error / (covariance.sxx + covariance.syy)));
                    }
                }
            }
            println!("{radius:4} {blur:4}: {}", cells.map(|cell| format!("{:.3} ", cell.ratio().0)).concat());
            cells.iter().for_each(|cell| pools[0].join(cell));
        }
    }
    let [(ratio, interval), (own, of_own)] = pools.map(|pool| pool.ratio());
    println!("pooled {ratio:.4} {interval:.4?}, {} trials; empirical / predicted {own:.4} {of_own:.4?}", pools[0].trials());
    pools
}

#[test]
fn errors_are_those_of_the_bound() {
    let [bound, own] = pools("parametric_circle", 53);
    let (_, interval) = bound.ratio();
    assert!(bound.trials() >= 2500 && interval[0] <= 1.05 && interval[1] >= 0.99, "{interval:?}");
    let (_, interval) = own.ratio();
    assert!(interval[0] < 1.03 && interval[1] > 0.97, "{interval:?}");
}

/// The largest error on noise-free discs of these radii and squeezes, px.
pub(crate) fn worst_without_noise(spec: &str, shapes: [(f64, f64); 3]) -> f64 {
    let mut worst = 0.0_f64;
    for (radius, squeeze) in shapes {
        for blur in [0.3, 0.6, 1.0, 1.5] {
            for k in 0..4 {
                let k = f64::from(k);
                let disc = disc(radius, squeeze, 0.7 * k, blur, [0.3 - 0.2 * k, 0.17 * k]);
                let image = quadrature_images::image(&disc.render(SIDE), SIDE);
                let start = Start::at(PixelPoint::new(disc.position[0] + 0.6, disc.position[1] - 0.4));
                let found = operator(spec).measure(&image, &start).unwrap().position;
                let error = (found.x - disc.position[0]).hypot(found.y - disc.position[1]);
                println!("radius {radius}, blur {blur}: {error:e}");
                assert!(error.is_finite(), "radius {radius}, blur {blur}");
                worst = worst.max(error);
            }
        }
    }
    worst
}

#[test]
fn without_noise_the_bias_is_below_a_millionth_of_a_pixel() {
    let worst = worst_without_noise("parametric_circle", [(1.5, 1.0), (3.0, 0.6), (7.0, 0.5)]);
    assert!(worst < 1e-6, "{worst:e}");
}

#[test]
fn conforms() {
    for spec in ["parametric_circle", "parametric_circle:window=25"] {
        crate::conformance::check_on(&*operator(spec), crate::conformance::disc, 1e-5);
    }
}

#[test]
fn coverage_is_exact_and_derivatives_are_those_of_differences() {
    let disc = quadrature_images::Ellipse { inside: 1.0, outside: 0.0, ..disc(3.0, 0.6, 0.5, 0.4, [0.2, 0.1]) };
    let at = |x: [f64; 6]| {
        let mut planes = Exact::new(SIDE);
        planes.fill(&Ellipse { position: [x[0], x[1]], shape: [x[2], x[3], x[4]] }, x[5], FINE);
        let window = |plane: &Vec<f64>| plane.chunks(planes.stride).take(SIDE).flat_map(|row| row[..SIDE].to_vec()).collect::<Vec<_>>();
        planes.values.each_ref().map(window)
    };
    let ([x, y], [a, b, c]) = (disc.position, disc.shape);
    let x = [x, y, a, b, c, disc.blur * disc.blur];
    let planes = at(x);
    for (covered, exact) in planes[blurred_ellipse::COVERED].iter().zip(disc.render(SIDE)) {
        assert!((covered - exact).abs() < 1e-6, "{covered} {exact}");
    }
    let [cx, cy] = blurred_ellipse::CENTRE;
    let [axx, axy, ayy] = blurred_ellipse::SHAPE;
    for (unknown, plane) in [cx, cy, axx, axy, ayy, blurred_ellipse::VARIANCE].into_iter().enumerate() {
        let shifted = |h: f64| {
            let mut x = x;
            x[unknown] += h;
            at(x)[blurred_ellipse::COVERED].clone()
        };
        let (high, low) = (shifted(1e-3), shifted(-1e-3));
        for (i, analytic) in planes[plane].iter().enumerate() {
            let difference = (high[i] - low[i]) / 2e-3;
            assert!((difference - analytic).abs() < 2e-5, "{unknown} at {i}: {difference} {analytic}");
        }
    }
}

/// A disc of which something grey hides all that is more than so many px to the right of its centre.
fn hidden(disc: &quadrature_images::Ellipse, beyond: f64, noise: f64) -> Image<'static> {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let mut grey = noisy(&disc.render(SIDE), noise, &mut rng);
    for (index, grey) in grey.iter_mut().enumerate() {
        let covered = ((index % SIDE) as f64 + 0.5 - disc.position[0] - beyond).clamp(0.0, 1.0);
        *grey += covered * (0.55 - *grey);
    }
    quadrature_images::image(&grey, SIDE)
}

#[test]
fn a_disc_that_is_partly_hidden_is_rejected() {
    let disc = disc(7.0, 0.9, 0.4, 0.7, [0.2, -0.3]);
    let start = Start::at(PixelPoint::new(disc.position[0] - 1.0, disc.position[1]));
    for name in ["parametric_circle", "ellipse_edges"] {
        let measured = |spec: &str, beyond: f64| operator(spec).measure(&hidden(&disc, beyond, 0.006), &start);
        assert!(measured(name, 20.0).is_ok(), "{name}");
        for beyond in [1.0, 2.5, 4.0, 5.5] {
            assert_eq!(measured(name, beyond), Err(Rejection::Misfit), "{name} {beyond}");
            // Nothing else rejects it.
            let wrong = measured(&format!("{name}:misfit=2"), beyond).unwrap().position;
            assert!(wrong.x - disc.position[0] < -0.05, "{name} {beyond}: {wrong:?}");
        }
    }
}

#[test]
fn an_outline_that_leaves_the_window_is_pictured_as_in_a_larger_one() {
    // 31 px of 61, from pixel 15 on.
    const MARGIN: usize = 15;
    let fill = |side: usize, at: [f64; 2], radius: f64, fineness| {
        let mut planes = Exact::new(side);
        planes.fill(&Ellipse { position: at, shape: [radius, 0.2 * radius, 0.8 * radius] }, 0.4, fineness);
        planes
    };
    for at in [[15.0, 15.0], [-2.0, 12.0], [33.0, 3.0], [15.0, 31.5], [29.0, 31.0], [-9.0, -9.0]] {
        for radius in [2.0, 6.0, 11.0] {
            for fineness in [FINE, blurred_ellipse::ROUGH] {
                let small = fill(31, at, radius, fineness);
                let large = fill(31 + 2 * MARGIN, at.map(|c| c + MARGIN as f64), radius, fineness);
                for (small_plane, large_plane) in small.values.iter().zip(&large.values) {
                    for (row, column) in (0..31).flat_map(|row| (0..31).map(move |column| (row, column))) {
                        let there = large_plane[(row + MARGIN) * large.stride + column + MARGIN];
                        let here = small_plane[row * small.stride + column];
                        assert!((here - there).abs() < 1e-9, "{at:?} {radius}: {here} {there} at {column}, {row}");
                    }
                }
            }
        }
    }
}
