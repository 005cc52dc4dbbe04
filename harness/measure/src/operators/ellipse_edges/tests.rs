use calibench_model::{PixelPoint, Start};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::parametric_circle::tests::{SIDE, bound_of, disc, operator, pools, worst_without_noise};
use crate::tests::bound::{Pool, noisy};
use crate::tests::quadrature_images;

/// Phases of the pixel grid in a cell, and trials at each.
const PHASES: usize = 10;
const TRIALS: usize = 200;
const NOISE: [f64; 3] = [0.005, 0.02, 0.1];
/// Standard errors that one of 54 limits exceeds by chance once in 100 times.
const ALL_CELLS: f64 = 3.6;

/// Errors in units of the bound and of the operator's own variance, and what was lost.
#[derive(Clone, Copy, Default)]
struct Cell {
    bound: Pool,
    own: Pool,
    lost: usize,
}

/// The cells of one disc size and tilt at one blur: one for each noise.
fn cells(radius: f64, squeeze: f64, blur: f64, seed: u64) -> [Cell; 3] {
    let operator = operator("ellipse_edges");
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut cells = [Cell::default(); 3];
    for _ in 0..PHASES {
        let phase = [rng.random_range(-0.5..0.5), rng.random_range(-0.5..0.5)];
        let disc = disc(radius, squeeze, rng.random_range(0.0..3.1), blur, phase);
        let (grey, trace) = (disc.render(SIDE), bound_of(&disc));
        for (cell, noise) in cells.iter_mut().zip(NOISE) {
            let sigma = noise * (disc.outside - disc.inside);
            for _ in 0..TRIALS {
                let image = quadrature_images::image(&noisy(&grey, sigma, &mut rng), SIDE);
                let (dx, dy) = (rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0));
                let start = Start::at(PixelPoint::new(disc.position[0] + dx, disc.position[1] + dy));
                let Ok(found) = operator.measure(&image, &start) else {
                    cell.lost += 1;
                    continue;
                };
                let error = (found.position.x - disc.position[0]).powi(2) + (found.position.y - disc.position[1]).powi(2);
                cell.bound.add(error / (trace * sigma * sigma));
                cell.own.add(found.covariance.map_or(f64::NAN, |covariance| error / (covariance.sxx + covariance.syy)));
            }
        }
    }
    cells
}

#[test]
fn errors_are_those_of_the_bound_and_of_the_covariance_in_every_cell() {
    println!("radius px, squeeze, blur px, noise: RMSE / bound, empirical / predicted variance, lost");
    let (mut bad, mut all) = (Vec::new(), Pool::default());
    let mut seed = 1000;
    // Semi-axes of 4 and 8 px, tilts of 0, 40 and 60 degrees.
    for (radius, squeeze) in [4.0, 8.0].into_iter().flat_map(|radius| [1.0, 0.766, 0.5].map(|squeeze| (radius, squeeze))) {
        let blurs = [0.3, 0.7, 2.0];
        let found = std::thread::scope(|scope| {
            let running = blurs.map(|blur| {
                seed += 1;
                scope.spawn(move || cells(radius, squeeze, blur, seed))
            });
            running.map(|thread| thread.join().unwrap())
        });
        for (blur, (cell, noise)) in blurs.iter().zip(&found).flat_map(|(blur, cells)| cells.iter().zip(NOISE).map(move |c| (blur, c))) {
            let ((ratio, [_, upper]), (own, own_limits)) = (cell.bound.within(ALL_CELLS), cell.own.ratio());
            let [own, low, high] = [own, own_limits[0], own_limits[1]].map(|ratio| ratio * ratio);
            let line =
                format!("{radius} {squeeze} {blur} {noise}: {ratio:.3} (to {upper:.3}), {own:.3} ({low:.3} to {high:.3}), {}", cell.lost);
            println!("{line}");
            all.join(&cell.own);
            if upper > 1.35 || low > 1.1 || high < 0.9 || cell.lost > 0 {
                bad.push(line);
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
    let (own, interval) = all.ratio();
    println!("all cells: empirical / predicted standard deviation {own:.4} {interval:.4?}");
    assert!((0.98..1.02).contains(&own), "{own}");
}

#[test]
fn pooled_errors_are_within_a_third_of_the_bound() {
    let [bound, own] = pools("ellipse_edges", 54);
    let (_, interval) = bound.ratio();
    assert!(bound.trials() >= 2500 && interval[1] <= 1.35 && interval[1] >= 1.0, "{interval:?}");
    let (_, interval) = own.ratio();
    assert!(interval[0] < 1.03 && interval[1] > 0.97, "{interval:?}");
}

#[test]
fn without_noise_there_is_no_error_of_interpolation() {
    let worst = worst_without_noise("ellipse_edges", [(2.5, 1.0), (4.0, 0.6), (8.0, 0.5)]);
    assert!(worst < 1e-5, "{worst:e}");
}

#[test]
fn conforms() {
    crate::conformance::check_on(&*operator("ellipse_edges"), crate::conformance::disc, 1e-4);
}
