//! Light that is not even, and photosites that are narrower than pixels.

use nalgebra::SVector;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::super::window::{Setting, Window};
use super::efficiency::{BLURS, NOISES, TILTS, bound_of, near};
use super::{SIDE, chess, operator};
use crate::gradient::{ADDED, EACH, EVEN, LIGHT};
use crate::marquardt::Problem;
use crate::operator::Operator;
use crate::tests::bound::{Pool, noisy};
use crate::tests::quadrature_images::{self, Chess};
use calibench_model::{Gradient, Image, PixelPoint, Start};

/// Black ink on white paper, lit by light that grows by `share` of the contrast a px.
fn lit(corner: &Chess, share: f64, direction: f64) -> Chess {
    let slope = share * 2.0 * corner.half / corner.mean;
    Chess { mean: 0.45, half: 0.43, light: [slope * direction.cos(), slope * direction.sin()], ..*corner }
}

/// Half the derivative of the squared residuals is `-J^T r`: by differences, for unknowns that are far from right.
fn check_right_hand_side<const P: usize, const GRADIENT: u8, const CURVED: bool>(image: &Image) {
    let setting = Setting { side: 15, photosite: 0.9, mean: 0.4, half: 0.35, warp: None };
    let mut window = Window::<P, GRADIENT, CURVED>::new(image, setting);
    window.greys.centre_on((15, 15));
    let start = [0.3, -0.2, 0.1, 1.5, 0.6, 0.1, 0.8];
    let rest = [0.03, -0.02, 0.015, 0.01, 0.012, -0.017];
    let x = SVector::<f64, P>::from_fn(|i, _| if i < 7 { start[i] } else { rest[i - 7] });
    let normal = window.normal(&x).unwrap();
    for unknown in 0..P {
        // What is multiplied by distances, squared for curvatures, takes smaller steps.
        let h = if unknown < 7 { 0.02 } else { 0.002 };
        let mut omega = |steps: f64| {
            let mut moved = x;
            moved[unknown] += steps * h;
            window.normal(&moved).unwrap().omega
        };
        let difference = (8.0 * (omega(1.0) - omega(-1.0)) - (omega(2.0) - omega(-2.0))) / (12.0 * h);
        let (analytic, scale) = (-2.0 * normal.b[unknown], normal.n[(unknown, unknown)].sqrt());
        assert!((difference - analytic).abs() < 3e-3 * (analytic.abs() + scale), "{GRADIENT} {unknown}: {difference} {analytic}");
    }
}

#[test]
fn right_hand_sides_are_those_of_differences() {
    let corner = lit(&chess(0.5, 0.2, 0.7, [0.1, 0.2]), 0.004, 0.7);
    let image = quadrature_images::image(&corner.render(SIDE), SIDE);
    check_right_hand_side::<7, EVEN, false>(&image);
    check_right_hand_side::<9, ADDED, false>(&image);
    check_right_hand_side::<9, LIGHT, false>(&image);
    check_right_hand_side::<11, EACH, false>(&image);
    check_right_hand_side::<9, EVEN, true>(&image);
    check_right_hand_side::<11, ADDED, true>(&image);
    check_right_hand_side::<11, LIGHT, true>(&image);
    check_right_hand_side::<13, EACH, true>(&image);
}

#[test]
fn a_gradient_of_the_light_leaves_no_bias() {
    let corner = lit(&chess(0.5, 0.4, 0.9, [0.2, -0.3]), 0.002, 2.2);
    let image = quadrature_images::image(&corner.render(SIDE), SIDE);
    let error = |gradient: u8| {
        let start = Start::at(PixelPoint::new(corner.position[0] + 1.0, corner.position[1] - 0.8));
        let found = operator(&format!("window=15,gradient={gradient}")).measure(&image, &start).unwrap();
        (found.position.x - corner.position[0]).hypot(found.position.y - corner.position[1])
    };
    let [none, added, light, both] = [EVEN, ADDED, LIGHT, EACH].map(error);
    println!("none {none:e}, added {added:e}, light {light:e}, both {both:e} px");
    assert!(light < 1e-5 && both < 1e-5 && added > 3.0 * light && none > 3.0 * light);
}

/// Black ink on white paper, the light growing by a fifth of a percent of the contrast a px: each model against the bound with its own unknowns.
#[test]
fn light_costs_no_more_than_its_unknowns() {
    let tried = [(0, Gradient::None), (1, Gradient::Added), (2, Gradient::Light), (3, Gradient::Both)];
    let operators = tried.map(|(gradient, _)| operator(&format!("window=15,gradient={gradient}")));
    let mut pools = [Pool::default(); 4];
    let mut wider = [0.0; 4];
    let mut rng = ChaCha8Rng::seed_from_u64(58);
    for blur in BLURS {
        for tilt in TILTS {
            let phase = [rng.random_range(-0.5..0.5), rng.random_range(-0.5..0.5)];
            let plain = chess(tilt.to_radians(), rng.random_range(0.0..std::f64::consts::PI), blur, phase);
            let corner = lit(&plain, 0.002, rng.random_range(0.0..std::f64::consts::TAU));
            let grey = corner.render(SIDE);
            let traces = tried.map(|(_, gradient)| bound_of(&corner, gradient));
            wider.iter_mut().zip(traces).for_each(|(wider, trace)| *wider += (trace / traces[0]).sqrt() / 15.0);
            for noise in NOISES {
                let sigma = 2.0 * corner.half * noise;
                for _ in 0..70 {
                    let image = quadrature_images::image(&noisy(&grey, sigma, &mut rng), SIDE);
                    let start = near(corner.position, 1.0, &mut rng);
                    for ((operator, pool), trace) in operators.iter().zip(&mut pools).zip(traces) {
                        let found = operator.measure(&image, &start).unwrap().position;
                        let error = (found.x - corner.position[0]).powi(2) + (found.y - corner.position[1]).powi(2);
                        pool.add(error / (trace * sigma * sigma));
                    }
                }
            }
        }
    }
    for ((pool, (_, gradient)), wider) in pools.iter().zip(tried).zip(wider) {
        println!("{gradient:?}: RMSE / own bound {:.4?}, {} trials; own bound / that of none {wider:.4}", pool.ratio(), pool.trials());
    }
    for pool in &pools[2..] {
        let (ratio, interval) = pool.ratio();
        assert!(pool.trials() >= 2500 && interval[0] <= 1.05 && ratio <= 1.05 && interval[1] >= 0.99, "{ratio} {interval:?}");
    }
}

/// Without noise, the corners of photosites of 0.8 px; and with the smallest noise of the atlas, against the bound.
#[test]
fn narrow_photosites_are_modelled() {
    let (own, full) = (operator("window=15,photosite=0.8"), operator("window=15"));
    let (mut pooled, mut blind) = (Pool::default(), Pool::default());
    let mut rng = ChaCha8Rng::seed_from_u64(59);
    for blur in [0.3, 0.7, 1.3] {
        for tilt in TILTS {
            for _ in 0..2 {
                let phase = [rng.random_range(-0.5..0.5), rng.random_range(-0.5..0.5)];
                let plain = chess(tilt.to_radians(), rng.random_range(0.0..std::f64::consts::PI), blur, phase);
                let corner = Chess { photosite: 0.8, ..plain };
                let (grey, trace) = (corner.render(SIDE), bound_of(&corner, Gradient::None));
                let error = |operator: &dyn Operator, image: &Image, start: &Start| {
                    let found = operator.measure(image, start).unwrap().position;
                    (found.x - corner.position[0]).powi(2) + (found.y - corner.position[1]).powi(2)
                };
                let bias = error(&*own, &quadrature_images::image(&grey, SIDE), &near(corner.position, 1.0, &mut rng)).sqrt();
                assert!(bias <= 1e-5, "blur {blur}, tilt {tilt}: {bias:e} px");
                let sigma = 2.0 * corner.half * 0.005;
                for _ in 0..140 {
                    let image = quadrature_images::image(&noisy(&grey, sigma, &mut rng), SIDE);
                    let start = near(corner.position, 1.0, &mut rng);
                    pooled.add(error(&*own, &image, &start) / (trace * sigma * sigma));
                    blind.add(error(&*full, &image, &start) / (trace * sigma * sigma));
                }
            }
        }
    }
    let (ratio, interval) = pooled.ratio();
    println!("photosites of 0.8 px: {ratio:.4} {interval:.4?}, {} trials; taken for 1 px: {:.4?}", pooled.trials(), blind.ratio());
    assert!(pooled.trials() >= 2500 && interval[0] <= 1.03 && interval[1] >= 0.99, "{ratio} {interval:?}");
}
