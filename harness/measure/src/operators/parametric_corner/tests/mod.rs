mod crowded;
mod efficiency;
mod gradients;
mod refused;

use super::model::{Fidelity, Model, Shape};
use super::*;
use crate::following::Laid;
use crate::lanes::{BLOCK, LANES};
use crate::marquardt::Problem;
use crate::registry::Registry;
use crate::tests::print_rate;
use crate::tests::quadrature_images::{self, Chess};

pub(super) fn operator(spec: &str) -> Box<dyn Operator> {
    Registry::builtin().parse(&format!("parametric_corner:{spec}")).unwrap().operator.unwrap()
}

/// A chess corner in the middle of a window of 31 px, tilted by `tilt` about an axis halfway between its edges, turned by `turn`, radians.
pub(super) fn chess(tilt: f64, turn: f64, blur: f64, phase: [f64; 2]) -> Chess {
    let half_angle = tilt.cos().atan();
    Chess {
        position: phase.map(|p| 15.0 + p),
        normals: [turn - half_angle, turn + half_angle],
        curvature: [0.0; 2],
        blur,
        mean: 0.5,
        half: 0.3,
        gradient: [0.0; 2],
        light: [0.0; 2],
        photosite: 1.0,
    }
}

pub(super) const SIDE: usize = 31;

#[test]
fn without_noise_the_bias_is_below_a_hundred_thousandth_of_a_pixel() {
    for blur in [0.3, 0.5, 0.71, 1.0, 1.5, 2.0] {
        let mut of_blur: f64 = 0.0;
        for (index, tilt) in [0.0_f64, 30.0, 45.0, 60.0].into_iter().enumerate() {
            for k in 0..6 {
                let k = f64::from(k) + 0.37 * index as f64;
                let corner = chess(tilt.to_radians(), 0.61 * k, blur, [0.07 * k - 0.2, 0.45 - 0.17 * k]);
                let image = quadrature_images::image(&corner.render(SIDE), SIDE);
                let found = operator("window=15").measure(&image, &Start::at(PixelPoint::new(16.0, 14.3))).unwrap();
                let error = (found.position.x - corner.position[0]).hypot(found.position.y - corner.position[1]);
                of_blur = of_blur.max(error);
            }
        }
        println!("blur {blur}: {of_blur:.1e} px");
        assert!(of_blur <= 1e-5, "blur {blur}: {of_blur:e}");
    }
}

#[test]
#[ignore = "prints speeds"]
fn speed() {
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};
    for spec in ["window=15", "window=15,search=0"] {
        for blur in [0.3, 0.5, 0.7, 1.0, 1.5, 2.0] {
            let corner = chess(0.5, 0.4, blur, [0.2, -0.3]);
            let grey = corner.render(SIDE);
            let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
            let normal = Normal::new(0.0, 0.02 * 0.6).unwrap();
            let images: Vec<Image<'static>> = (0..200)
                .map(|_| quadrature_images::image(&grey.iter().map(|g| g + normal.sample(&mut rng)).collect::<Vec<_>>(), SIDE))
                .collect();
            let operator = operator(spec);
            print_rate(&format!("{spec} blur {blur}"), &*operator, &images, corner.position);
        }
    }
}

/// Not with a gradient of the light: as it multiplies, what is added to all grey values changes the model.
#[test]
fn conforms() {
    for spec in
        ["window=15", "window=11", "window=21,gradient=1", "window=15,curvature=1,gradient=1", "window=15,search=0", "window=15,gradient=3"]
    {
        crate::conformance::check_on(&*operator(spec), crate::conformance::chess_corner, 1e-5);
    }
}

#[test]
fn a_window_that_is_laid_anew_reads_its_own_pixels() {
    let image = quadrature_images::image(&chess(0.5, 0.4, 0.7, [0.2, -0.3]).render(SIDE), SIDE);
    let x = SVector::from([0.2, -0.3, 0.4 - 0.7, 0.4 + 0.7, 0.5, 0.0, 1.0]);
    let normal = |pixels: &[(i64, i64)]| {
        let setting = Setting { side: 15, photosite: 1.0, mean: 0.5, half: 0.3, warp: None };
        let mut window = Window::<7, EVEN, false>::new(&image, setting);
        let laid = pixels.iter().map(|pixel| {
            window.centre_on(*pixel);
            window.normal(&x).unwrap().b
        });
        laid.last().unwrap()
    };
    assert_eq!(normal(&[(15, 15), (16, 14)]), normal(&[(16, 14)]));
    assert_ne!(normal(&[(15, 15)]), normal(&[(16, 14)]));
}

#[test]
fn residuals_elsewhere_leave_the_normal_equations_as_they_are() {
    let image = quadrature_images::image(&chess(0.5, 0.4, 0.7, [0.2, -0.3]).render(SIDE), SIDE);
    let x = SVector::from([0.2, -0.3, 0.4 - 0.7, 0.4 + 0.7, 0.5, 0.0, 1.0]);
    let setting = Setting { side: 15, photosite: 1.0, mean: 0.5, half: 0.3, warp: None };
    let mut window = Window::<7, EVEN, false>::new(&image, setting);
    window.centre_on((15, 15));
    let before = window.normal(&x).unwrap();
    let elsewhere = x + SVector::from([2.0, 3.0, 0.5, 0.4, 1.0, 0.0, 0.0]);
    window.structure(&elsewhere).unwrap();
    let after = window.normal(&x).unwrap();
    assert_eq!((before.n, before.b, before.omega), (after.n, after.b, after.omega));
}

#[test]
fn grey_values_are_exact() {
    // Blur, and how far off the mixture of Gaussians may be, in units of half the contrast.
    for (blur, expected) in [(0.3, 3e-5), (0.4, 2e-5), (0.6, 1e-5), (0.72, 3e-5), (1.0, 5e-6), (2.0, 2e-6)] {
        let corner = Chess { mean: 0.0, half: 1.0, ..chess(0.9, 0.3, blur, [0.3, -0.2]) };
        let model = Model::<f64>::new(&shape_of(&corner), Fidelity::Full).unwrap();
        for (i, exact) in corner.render(SIDE).into_iter().enumerate() {
            let (x, y) = ((i % SIDE) as f64 - corner.position[0], (i / SIDE) as f64 - corner.position[1]);
            let value = model.corner::<LANES, false>(&[x; LANES], &[y; LANES]).value[0];
            assert!((value - exact).abs() < expected, "blur {blur}, ({x}, {y}): {:e}", value - exact);
        }
    }
}

fn shape_of(corner: &Chess) -> Shape {
    Shape {
        position: corner.position,
        normals: corner.normals,
        variance: corner.blur * corner.blur,
        curvature: corner.curvature,
        photosite: 1.0,
    }
}

#[test]
fn derivatives_are_those_of_differences() {
    for (blur, fidelity) in [(0.3, Fidelity::Full), (0.5, Fidelity::Full), (1.2, Fidelity::Full), (0.7, Fidelity::Rough)] {
        let corner = Chess { curvature: [0.03, -0.02], ..chess(0.8, 0.7, blur, [0.1, 0.2]) };
        let field = |shape: &Shape, (x, y): (f64, f64), only: Option<usize>| {
            let model = Model::<f64>::new(shape, fidelity).unwrap();
            let (x, y) = ([x - shape.position[0]; LANES], [y - shape.position[1]; LANES]);
            only.map_or_else(|| model.corner::<LANES, true>(&x, &y), |which| model.edge::<LANES, true>(which, &[-1.0; LANES], &x, &y))
        };
        for (at, only) in
            [((14.2, 15.9), None), ((15.6, 15.1), None), ((16.9, 13.4), None), ((15.5, 14.8), Some(0)), ((14.9, 15.8), Some(1))]
        {
            let shape = shape_of(&corner);
            let f = field(&shape, at, only);
            let analytic = [f.position[0], f.position[1], f.normals[0], f.normals[1], f.variance, f.curvature[0], f.curvature[1]];
            for (unknown, analytic) in analytic.into_iter().enumerate() {
                let step = |h: f64| {
                    let mut shape = shape;
                    match unknown {
                        0 | 1 => shape.position[unknown] += h,
                        2 | 3 => shape.normals[unknown - 2] += h,
                        4 => shape.variance += h,
                        _ => shape.curvature[unknown - 5] += h,
                    }
                    field(&shape, at, only).value[0]
                };
                let difference = (8.0 * (step(1e-3) - step(-1e-3)) - (step(2e-3) - step(-2e-3))) / 12e-3;
                assert!((difference - analytic[0]).abs() < 1e-5, "{blur} {at:?} {only:?} {unknown}: {difference} {}", analytic[0]);
            }
        }
    }
}

#[test]
fn a_gradient_and_bent_edges_are_found() {
    // A fifth of a percent of the contrast a px, and radii of 250 and 400 px in a window of 31.
    let plain = chess(0.5, 0.4, 0.9, [0.2, -0.3]);
    let sloped = Chess { gradient: [0.0012, -0.0008], ..plain };
    let bent = Chess { curvature: [0.004, -0.0025], position: [25.2, 24.7], ..plain };
    let error = |corner: &Chess, spec: &str, side: usize| {
        let start = Start::at(PixelPoint::new(corner.position[0] + 1.0, corner.position[1] - 0.8));
        let found = operator(spec).measure(&quadrature_images::image(&corner.render(side), side), &start).unwrap();
        (found.position.x - corner.position[0]).hypot(found.position.y - corner.position[1])
    };
    let (with, without) = (error(&sloped, "window=15,gradient=1", SIDE), error(&sloped, "window=15", SIDE));
    assert!(with < 1e-5 && without > 3.0 * with, "{with:e} {without:e}");
    let (with, without) = (error(&bent, "window=31,curvature=1", 51), error(&bent, "window=31", 51));
    println!("bent: {with:e} {without:e}");
    assert!(with < 2e-4 && without > 10.0 * with, "{with:e} {without:e}");
}

/// The warp of which the edges of a corner are the lines.
fn warp(corner: &Chess, mixed: [f64; 2]) -> Warp {
    // Of unit way along each edge, which turns away from its normal where the curvature is positive.
    let tangents = corner.normals.map(|normal| [-normal.sin(), normal.cos()]);
    let [first, second] = [0, 1].map(|edge| {
        let (sine, cosine) = corner.normals[edge].sin_cos();
        [-corner.curvature[edge] * cosine, -corner.curvature[edge] * sine]
    });
    Warp::of_derivatives(tangents, [first, mixed, second]).unwrap()
}

#[test]
fn edges_are_as_curved_as_the_start_tells() {
    for (curvature, tilt, spec) in [([0.004, -0.0025], 0.5, "window=15"), ([-0.006, -0.003], 0.9, "window=21,gradient=1")] {
        let bent = Chess { curvature, position: [25.2, 24.7], ..chess(tilt, 0.4, 0.9, [0.0; 2]) };
        let image = quadrature_images::image(&bent.render(51), 51);
        let error = |warp| {
            let start = Start { warp, ..Start::at(PixelPoint::new(26.0, 24.0)) };
            let found = operator(spec).measure(&image, &start).unwrap();
            (found.position.x - bent.position[0]).hypot(found.position.y - bent.position[1])
        };
        let (straight, told) = (error(None), error(Some(warp(&bent, [0.013, -0.021]))));
        println!("straight {straight:.1e}, told {told:.1e} px");
        assert!(told < 2e-4 && straight > 0.02, "{told:e} {straight:e}");
    }
}

#[test]
fn what_is_hardly_curved_is_measured_as_straight_to_the_bit() {
    let corner = chess(0.5, 0.4, 0.9, [0.2, -0.3]);
    let image = quadrature_images::image(&corner.render(SIDE), SIDE);
    let at = |curvature| {
        let start =
            Start { warp: Some(warp(&Chess { curvature: [curvature; 2], ..corner }, [0.0; 2])), ..Start::at(PixelPoint::new(15.0, 15.0)) };
        let found = operator("window=15").measure(&image, &start).unwrap();
        (found.position.x.to_bits(), found.position.y.to_bits())
    };
    // At half the window's side, 7 px, arcs are 0.98e-3 and 1.23e-3 px off their tangents.
    assert_eq!(at(4e-5), at(0.0));
    assert_ne!(at(5e-5), at(0.0));
}

#[test]
fn what_is_no_chess_corner_is_rejected() {
    let operator = operator("window=15");
    let start = Start::at(PixelPoint::new(15.0, 15.0));
    for angle in [0.0_f64, 0.3, 1.1, 2.0] {
        let (sin, cos) = angle.sin_cos();
        let image = Image::from_fn(SIDE, SIDE, |x, y| ((((x as f64 - 15.2) * cos + (y as f64 - 14.9) * sin) * 0.7).tanh()) as f32);
        assert!(operator.measure(&image, &start).is_err(), "an edge at {angle} rad");
    }
}

#[test]
fn the_corner_of_one_area_is_rejected_before_it_is_fitted() {
    let operator = operator("window=15");
    for angle in [0.0_f64, 0.4, 0.8, 1.9, 3.0, 4.4] {
        let edge = |x: f64, y: f64, a: f64| 0.5 + 0.5 * ((x * a.cos() + y * a.sin()) * 1.2).tanh();
        let quarter = |x: f64, y: f64| edge(x, y, angle) * edge(x, y, angle + std::f64::consts::FRAC_PI_2);
        let image = Image::from_fn(SIDE, SIDE, |x, y| (0.2 + 0.6 * quarter(x as f64 - 15.2, y as f64 - 14.9)) as f32);
        let found = operator.measure(&image, &Start::at(PixelPoint::new(15.0, 15.0)));
        assert_eq!(found.err(), Some(Rejection::NoCorner), "{angle} rad");
    }
}

#[test]
fn single_precision_gives_the_same_grey_values() {
    for (blur, fidelity) in [(0.3, Fidelity::Full), (0.5, Fidelity::Full), (1.2, Fidelity::Full), (0.7, Fidelity::Rough)] {
        let shape = shape_of(&Chess { curvature: [0.03, -0.02], ..chess(0.8, 0.7, blur, [0.1, 0.2]) });
        let (model, double) = (Model::<f32>::new(&shape, fidelity).unwrap(), Model::<f64>::new(&shape, fidelity).unwrap());
        for (x, y) in (-70..70).map(|i| (f64::from(i) * 0.07, f64::from(i * 37 % 61 - 30) * 0.1)) {
            let (there, seen) = (([x; LANES], [y; LANES]), model.seen(&[x as f32; BLOCK], &[y as f32; BLOCK]));
            let off =
                |single: f32, double: f64| assert!((f64::from(single) - double).abs() < 2e-6, "{blur}, ({x}, {y}): {single} {double}");
            let full = double.corner::<LANES, true>(&there.0, &there.1);
            off(model.corner_value::<true>(&seen)[3], full.value[3]);
            off(model.corner_value::<false>(&seen)[15], double.corner::<LANES, false>(&there.0, &there.1).value[0]);
            let single = model.corner::<BLOCK, true>(&[x as f32; BLOCK], &[y as f32; BLOCK]);
            off(single.value[3], full.value[3]);
            // Those by direction and curvature grow with the distance and its square.
            let far = 1.0 + x * x + y * y;
            let near = |single: f32, double: f64| assert!((f64::from(single) - double).abs() < 1e-5 * far, "{single} {double}");
            for i in [0, 1] {
                near(single.position[i][0], full.position[i][0]);
                near(single.normals[i][0], full.normals[i][0]);
                near(single.curvature[i][0], full.curvature[i][0]);
            }
            near(single.variance[0], full.variance[0]);
            for which in [0, 1] {
                let edge = double.edge::<LANES, true>(which, &[1.0; LANES], &there.0, &there.1);
                off(model.edge_value::<true>(which, &seen)[0], edge.value[0]);
            }
        }
    }
}
