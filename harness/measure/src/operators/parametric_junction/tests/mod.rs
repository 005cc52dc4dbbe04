mod efficiency;
mod gradients;
mod refused;
mod speed;

use std::f64::consts::{PI, TAU};

use super::arms::{MOST, Model, Shape};
use super::*;
use crate::lanes::LANES;
use crate::photosite::Fidelity;
use crate::registry::Registry;
use crate::tests::junction_images::Junction;
use crate::tests::quadrature_images;

pub(super) const SIDE: usize = 31;

pub(super) fn operator(spec: &str) -> Box<dyn Operator> {
    Registry::builtin().parse(&format!("parametric_junction:{spec}")).unwrap().operator.unwrap()
}

/// A junction in the middle of an image of 31 px, its first arm in direction `turn`, its sectors so wide, degrees.
pub(super) fn junction(widths: &[f64], turn: f64, blur: f64, phase: [f64; 2]) -> Junction {
    let grey = [[0.2, 0.8, 0.0, 0.0], [0.2, 0.8, 0.5, 0.0], [0.2, 0.8, 0.35, 0.6]][widths.len() - 2];
    let mut directions = vec![turn];
    directions.extend(widths[..widths.len() - 1].iter().scan(turn, |at, width| {
        *at += width.to_radians();
        Some(*at)
    }));
    Junction {
        position: phase.map(|p| 15.0 + p),
        directions,
        grey: grey[..widths.len()].to_vec(),
        blur,
        gradient: [0.0; 2],
        light: [0.0; 2],
        each: Vec::new(),
        photosite: 1.0,
    }
}

/// Two arms of every kind of angle, a Y and a T, two edges.
pub(super) const KINDS: [&[f64]; 8] = [
    &[20.0, 340.0],
    &[60.0, 300.0],
    &[120.0, 240.0],
    &[160.0, 200.0],
    &[250.0, 110.0],
    &[100.0, 130.0, 130.0],
    &[70.0, 110.0, 180.0],
    &[50.0, 130.0, 50.0, 130.0],
];

fn shape_of(junction: &Junction) -> Shape {
    let mut directions = [0.0; MOST];
    directions[..junction.directions.len()].copy_from_slice(&junction.directions);
    Shape { directions, arms: junction.directions.len(), variance: junction.blur.powi(2), photosite: junction.photosite }
}

fn shares(shape: &Shape, fidelity: Fidelity, (x, y): (f64, f64), near: bool) -> [f64; MOST] {
    let model = Model::<f64>::new(shape, fidelity).unwrap();
    let (x, y) = ([x; LANES], [y; LANES]);
    if near { model.shares::<LANES, true>(&x, &y).map(|s| s[0]) } else { model.shares::<LANES, false>(&x, &y).map(|s| s[0]) }
}

#[test]
fn grey_values_are_exact() {
    // Blur, and how far off the mixture of Gaussians may be.
    for (blur, expected) in [(0.3, 2e-5), (0.4, 1e-5), (0.6, 5e-6), (0.72, 2e-5), (1.0, 4e-6), (2.0, 1e-6)] {
        let mut worst = 0.0_f64;
        for (index, widths) in KINDS.iter().enumerate() {
            let junction = junction(widths, 0.3 + 0.9 * index as f64, blur, [0.3, -0.2]);
            let shape = shape_of(&junction);
            for (i, exact) in junction.render(SIDE).into_iter().enumerate() {
                let at = ((i % SIDE) as f64 - junction.position[0], (i / SIDE) as f64 - junction.position[1]);
                let value: f64 = shares(&shape, Fidelity::Full, at, true).iter().zip(&junction.grey).map(|(s, g)| s * g).sum();
                worst = worst.max((value - exact).abs());
                let reach = 5.0 * shape.variance.sqrt() + 1.5;
                if at.0.hypot(at.1) > reach {
                    let far: f64 = shares(&shape, Fidelity::Full, at, false).iter().zip(&junction.grey).map(|(s, g)| s * g).sum();
                    assert!((far - value).abs() < 2e-6, "{widths:?}, blur {blur}, {at:?}: {far} {value}");
                }
            }
        }
        println!("blur {blur}: {worst:.1e}");
        assert!(worst < expected, "blur {blur}: {worst:e}");
    }
}

#[test]
fn derivatives_are_those_of_differences() {
    for (index, widths) in KINDS.iter().enumerate() {
        let junction = junction(widths, 0.3 + 0.9 * index as f64, 0.8, [0.0; 2]);
        let shape = shape_of(&junction);
        for at in [(0.3, 0.4), (-0.9, 0.2), (1.4, -1.1), (0.2, -2.3)] {
            let model = Model::<f64>::new(&shape, Fidelity::Rough).unwrap();
            let field = model.field_of::<LANES, true>(shape.arms, &[at.0; LANES], &[at.1; LANES]);
            let value = |shape: &Shape, at: (f64, f64)| -> f64 {
                shares(shape, Fidelity::Rough, at, true).iter().zip(&junction.grey).map(|(s, g)| s * g).sum()
            };
            let slope = |f: &dyn Fn(f64) -> f64| (8.0 * (f(1e-3) - f(-1e-3)) - (f(2e-3) - f(-2e-3))) / 12e-3;
            let (mut by_x, mut by_y, mut by_variance) = (0.0, 0.0, 0.0);
            let arms = shape.arms;
            for k in 0..arms {
                let (sin, cos) = shape.directions[k].sin_cos();
                let jump = junction.grey[k] - junction.grey[(k + arms - 1) % arms];
                by_x -= jump * field.slopes[k][0] * sin;
                by_y += jump * field.slopes[k][0] * cos;
                by_variance -= 0.5 * jump * field.slopes[k][0] * field.across[k][0] / model.variance();
                let turned = slope(&|h| {
                    let mut shape = shape;
                    shape.directions[k] += h;
                    value(&shape, at)
                });
                let turn = -jump * field.turns[k][0];
                assert!((turned - turn).abs() < 4e-6, "{widths:?} {at:?} arm {k}: {turned} {turn}");
            }
            let by_blur = slope(&|h| {
                let mut shape = shape;
                shape.variance += h;
                value(&shape, at)
            });
            for (by, difference) in [
                (by_x, slope(&|h| value(&shape, (at.0 + h, at.1)))),
                (by_y, slope(&|h| value(&shape, (at.0, at.1 + h)))),
                (by_variance, by_blur),
            ] {
                assert!((by - difference).abs() < 4e-6, "{widths:?} {at:?}: {by} {difference}");
            }
        }
    }
}

#[test]
fn one_arm_alone_is_seen_as_all_are() {
    for (index, widths) in KINDS.iter().enumerate() {
        let shape = shape_of(&junction(widths, 0.3 + 0.9 * index as f64, 0.4, [0.0; 2]));
        let (rough, full) = (Model::<f64>::new(&shape, Fidelity::Rough).unwrap(), Model::<f64>::new(&shape, Fidelity::Full).unwrap());
        for k in 0..shape.arms {
            let (sin, cos) = shape.directions[k].sin_cos();
            for across in [-1.1, -0.2, 0.0, 0.7] {
                let (x, y) = ([11.0 * cos - across * sin; LANES], [11.0 * sin + across * cos; LANES]);
                let one = rough.one_arm(shape.arms, &[k as f64; LANES], &x, &y);
                let field = rough.field_of::<LANES, true>(shape.arms, &x, &y);
                let exact = full.shares::<LANES, true>(&x, &y);
                let found = [
                    (one.after[0], field.shares[k][0]),
                    (one.slopes[0], field.slopes[k][0]),
                    (one.turns[0], field.turns[k][0]),
                    (one.across[0], field.across[k][0]),
                    (full.after_one(&one.across, &one.cos, &one.sin)[0], exact[k][0]),
                ];
                assert!(found.iter().all(|(one, of_all)| (one - of_all).abs() < 2e-6), "{widths:?}, arm {k}, {across}: {found:?}");
            }
        }
    }
}

#[test]
fn without_noise_the_bias_is_below_a_hundred_thousandth_of_a_pixel() {
    let mut failed = Vec::new();
    for blur in [0.3, 0.5, 0.71, 1.0, 1.5, 2.0] {
        for (index, widths) in KINDS.iter().enumerate() {
            let mut of_kind: f64 = 0.0;
            for k in 0..6 {
                let k = f64::from(k) + 0.37 * index as f64;
                let junction = junction(widths, 0.61 * k, blur, [0.07 * k - 0.2, 0.45 - 0.17 * k]);
                let image = quadrature_images::image(&junction.render(SIDE), SIDE);
                let start = Start::at(PixelPoint::new(16.0, 14.3));
                match operator(&format!("window=15,arms={}", widths.len())).measure(&image, &start) {
                    Ok(found) => {
                        of_kind = of_kind.max((found.position.x - junction.position[0]).hypot(found.position.y - junction.position[1]));
                    }
                    Err(why) => failed.push(format!("blur {blur} {widths:?} {k}: {why}")),
                }
            }
            println!("blur {blur} {widths:?}: {of_kind:.1e} px");
            if of_kind > 1e-5 {
                failed.push(format!("blur {blur} {widths:?}: {of_kind:e}"));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn conforms() {
    for spec in ["window=15,arms=2", "window=15"] {
        crate::conformance::check(&*operator(spec), 1e-5);
    }
    crate::conformance::check_on(&*operator("window=15,arms=4"), crate::conformance::chess_corner, 1e-5);
}

#[test]
fn directions_are_in_a_turn() {
    assert!(KINDS.iter().all(|widths| (widths.iter().sum::<f64>() - 360.0).abs() < 1e-9));
    assert!(
        Model::<f64>::new(&Shape { directions: [0.0, PI, 0.0, 0.0], arms: 2, variance: 1.0, photosite: 1.0 }, Fidelity::Rough).is_some()
    );
    for second in [-0.1, 0.01, TAU, TAU - 0.01, f64::NAN] {
        let shape = Shape { directions: [0.0, second, 0.0, 0.0], arms: 2, variance: 1.0, photosite: 1.0 };
        assert!(Model::<f64>::new(&shape, Fidelity::Rough).is_none(), "{second}");
    }
}
