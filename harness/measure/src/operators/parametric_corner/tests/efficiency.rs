//! Errors against the Cramér-Rao bound, and points lost.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{SIDE, chess, operator};
use crate::operator::Operator;
use crate::tests::bound::{Pool, bound, noisy};
use crate::tests::quadrature_images::{self, Chess};
use calibench_model::{Gradient, PixelPoint, Start};

pub(super) const BLURS: [f64; 5] = [0.3, 0.5, 0.8, 1.3, 2.0];
pub(super) const TILTS: [f64; 3] = [0.0, 30.0, 60.0];
/// Fractions of the contrast.
pub(super) const NOISES: [f64; 3] = [0.005, 0.02, 0.1];

/// The trace of the bound for noise of unit variance in the window of 15 px around the corner's pixel. Nuisances: directions, blur, grey values,
/// and the components of the gradient.
pub(super) fn bound_of(corner: &Chess, gradient: Gradient) -> f64 {
    let shift = corner.position.map(|p| p.round() - 7.0);
    let x = [
        corner.position[0] - shift[0],
        corner.position[1] - shift[1],
        corner.normals[0],
        corner.normals[1],
        corner.blur,
        corner.mean,
        corner.half,
    ];
    let there = |x: &[f64]| Chess { position: [x[0], x[1]], normals: [x[2], x[3]], blur: x[4], mean: x[5], half: x[6], ..*corner };
    let [added, light] = [corner.gradient, corner.light];
    let nine = |slope: [f64; 2]| -> [f64; 9] { std::array::from_fn(|i| x.get(i).copied().unwrap_or_else(|| slope[i - 7])) };
    match gradient {
        Gradient::None => bound(x, |x| there(x).render(15)),
        Gradient::Added => bound(nine(added), |x| Chess { gradient: [x[7], x[8]], ..there(x) }.render(15)),
        Gradient::Light => bound(nine(light), |x| Chess { light: [x[7], x[8]], ..there(x) }.render(15)),
        Gradient::Both => {
            let all: [f64; 11] = std::array::from_fn(|i| if i < 9 { nine(added)[i] } else { light[i - 9] });
            bound(all, |x| Chess { gradient: [x[7], x[8]], light: [x[9], x[10]], ..there(x) }.render(15))
        }
    }
}

pub(super) fn near(position: [f64; 2], radius: f64, rng: &mut ChaCha8Rng) -> Start {
    loop {
        let (x, y) = (rng.random_range(-radius..radius), rng.random_range(-radius..radius));
        if x * x + y * y <= radius * radius {
            return Start::at(PixelPoint::new(position[0] + x, position[1] + y));
        }
    }
}

#[test]
fn errors_are_those_of_the_bound() {
    let operator = operator("window=15");
    let (mut pooled, mut predicted, mut worst) = (Pool::default(), Pool::default(), 0.0_f64);
    let mut rng = ChaCha8Rng::seed_from_u64(51);
    println!("blur px, tilt deg: RMSE / bound at noise of 0.5, 2, 10 % of the contrast");
    for blur in BLURS {
        for tilt in TILTS {
            let mut cells = [Pool::default(); NOISES.len()];
            for _ in 0..4 {
                let phase = [rng.random_range(-0.5..0.5), rng.random_range(-0.5..0.5)];
                let corner = chess(tilt.to_radians(), rng.random_range(0.0..std::f64::consts::PI), blur, phase);
                let (grey, trace) = (corner.render(SIDE), bound_of(&corner, Gradient::None));
                for (cell, noise) in cells.iter_mut().zip(NOISES) {
                    let sigma = 2.0 * corner.half * noise;
                    for _ in 0..60 {
                        let image = quadrature_images::image(&noisy(&grey, sigma, &mut rng), SIDE);
                        let found = operator.measure(&image, &near(corner.position, 1.0, &mut rng)).unwrap();
                        let error = (found.position.x - corner.position[0]).powi(2) + (found.position.y - corner.position[1]).powi(2);
                        cell.add(error / (trace * sigma * sigma));
                        let covariance = found.covariance.unwrap();
                        predicted.add(error / (covariance.sxx + covariance.syy));
                    }
                }
            }
            println!("{blur:4} {tilt:4}: {}", cells.map(|cell| format!("{:.3} ", cell.ratio().0)).concat());
            for cell in &cells {
                pooled.join(cell);
                // That of 240 trials scatters by a twentieth.
                worst = worst.max(cell.ratio().1[0]);
            }
        }
    }
    let (ratio, interval) = pooled.ratio();
    let (own, of_own) = predicted.ratio();
    println!("pooled {ratio:.4}, 99 % {interval:.4?}, {} trials; empirical / predicted {own:.4} {of_own:.4?}", pooled.trials());
    assert!(pooled.trials() >= 2500 && interval[0] <= 1.03 && interval[1] >= 0.99, "{ratio} {interval:?}");
    assert!(worst <= 1.15, "{worst}");
    assert!(of_own[0] < 1.03 && of_own[1] > 0.97, "{own} {of_own:?}");
}

/// A fifth of a percent of the contrast a px, and a model that knows of it: compared with the bound with two unknowns more.
#[test]
fn a_gradient_costs_no_more_than_its_unknowns() {
    let (with, without) = (operator("window=15,gradient=1"), operator("window=15"));
    let (mut pooled, mut blind) = (Pool::default(), Pool::default());
    let mut rng = ChaCha8Rng::seed_from_u64(55);
    for blur in BLURS {
        for tilt in TILTS {
            let phase = [rng.random_range(-0.5..0.5), rng.random_range(-0.5..0.5)];
            let plain = chess(tilt.to_radians(), rng.random_range(0.0..std::f64::consts::PI), blur, phase);
            let (sin, cos) = rng.random_range(0.0..std::f64::consts::TAU).sin_cos();
            let slope = 0.002 * 2.0 * plain.half;
            let corner = Chess { gradient: [slope * cos, slope * sin], ..plain };
            let (grey, trace) = (corner.render(SIDE), bound_of(&corner, Gradient::Added));
            for noise in NOISES {
                let sigma = 2.0 * corner.half * noise;
                for _ in 0..70 {
                    let image = quadrature_images::image(&noisy(&grey, sigma, &mut rng), SIDE);
                    let start = near(corner.position, 1.0, &mut rng);
                    let error = |operator: &dyn Operator| {
                        let found = operator.measure(&image, &start).unwrap().position;
                        (found.x - corner.position[0]).powi(2) + (found.y - corner.position[1]).powi(2)
                    };
                    pooled.add(error(&*with) / (trace * sigma * sigma));
                    blind.add(error(&*without) / (trace * sigma * sigma));
                }
            }
        }
    }
    let (ratio, interval) = pooled.ratio();
    println!("gradient: pooled {ratio:.4} {interval:.4?}, {} trials; not estimated: {:.4?}", pooled.trials(), blind.ratio());
    assert!(pooled.trials() >= 2500 && interval[0] <= 1.05 && interval[1] >= 0.99, "{ratio} {interval:?}");
}

/// No point of 4000 may be lost: the upper 95 % limit of Clopper and Pearson is then `1 - 0.05^(1/4000)`, 0.075 %.
#[test]
fn no_point_is_lost() {
    let operator = operator("window=15");
    let mut rng = ChaCha8Rng::seed_from_u64(52);
    let (mut lost, mut trials) = (0, 0);
    for blur in BLURS {
        for tilt in TILTS {
            for _ in 0..4 {
                let phase = [rng.random_range(-0.5..0.5), rng.random_range(-0.5..0.5)];
                let corner = chess(tilt.to_radians(), rng.random_range(0.0..std::f64::consts::PI), blur, phase);
                let grey = corner.render(SIDE);
                for _ in 0..67 {
                    let image = quadrature_images::image(&noisy(&grey, 0.1 * 2.0 * corner.half, &mut rng), SIDE);
                    let found = operator.measure(&image, &near(corner.position, 4.0, &mut rng));
                    let truth = PixelPoint::new(corner.position[0], corner.position[1]);
                    trials += 1;
                    if !found.is_ok_and(|found| found.position.distance(truth) <= 1.0) {
                        println!("lost: blur {blur}, tilt {tilt}: {found:?} for {truth:?}");
                        lost += 1;
                    }
                }
            }
        }
    }
    println!("{lost} of {trials} lost");
    assert!(trials >= 4000 && lost == 0, "{lost} of {trials}");
}

/// Next to no blur, which the model does not quite follow: the iteration may fail to settle on a few in a thousand, but never settles elsewhere.
#[test]
fn the_sharpest_corners_are_found() {
    let operator = operator("window=15");
    let mut rng = ChaCha8Rng::seed_from_u64(57);
    let mut lost = [0; 3];
    for (blur, lost) in [0.05, 0.1, 0.2].into_iter().zip(&mut lost) {
        for trial in 0..100 {
            let phase = [rng.random_range(-0.5..0.5), rng.random_range(-0.5..0.5)];
            let corner = chess(rng.random_range(0.0..0.9), rng.random_range(0.0..std::f64::consts::PI), blur, phase);
            let (grey, truth) = (corner.render(SIDE), PixelPoint::new(corner.position[0], corner.position[1]));
            for noise in [0.002, 0.01, 0.03] {
                let image = quadrature_images::image(&noisy(&grey, noise * 2.0 * corner.half, &mut rng), SIDE);
                match operator.measure(&image, &near(corner.position, 1.0, &mut rng)) {
                    Ok(found) => assert!(found.position.distance(truth) < 0.1, "blur {blur}, trial {trial}: {found:?} for {truth:?}"),
                    Err(_) => *lost += 1,
                }
            }
        }
    }
    println!("lost of 300: {lost:?}");
    assert!(lost.iter().sum::<usize>() <= 4, "{lost:?}");
}
