//! Bounds against closed forms and differences of whole pictures.

use super::*;
use calibench_model::{Polygon, Scene};

const SIGMA: f64 = 0.02;

fn scene(polygons: &[&[(f64, f64)]]) -> Picture {
    let polygon = |vertices: &&[(f64, f64)]| Polygon {
        id: String::new(),
        grey: 0.1,
        vertices: vertices.iter().map(|&(x, y)| PixelPoint::new(x, y)).collect(),
    };
    Picture::from(&Scene { width: 41, height: 41, background: 0.9, polygons: polygons.iter().map(polygon).collect(), targets: Vec::new() })
}

fn bound(picture: &Picture, blur: f64, window: usize, unknowns: Unknowns) -> Option<Covariance> {
    let bounds = Bounds::new(&Optics { blur, ..Optics::default() }, 41, 41, window).unwrap();
    let window = bounds.window(&Outlined::of(picture), PixelPoint::new(20.2, 19.9)).unwrap();
    window.bounds(&[unknowns], Some, |_| Some(SIGMA * SIGMA), &mut Work::default())[0]
}

fn chess() -> Picture {
    scene(&[&[(-9.0, -9.0), (20.2, -9.0), (20.2, 19.9), (-9.0, 19.9)], &[(20.2, 19.9), (60.0, 19.9), (60.0, 60.0), (20.2, 60.0)]])
}

#[test]
fn an_upright_chess_corner_has_its_closed_form() {
    // Far from the centre a row crosses one edge: the information of x is the number of rows times the integral of the squared slope, except where the
    // other edge turns the contrast over. There it is (2 Phi - 1)^2.
    let (blur, window) = (1.5, 15);
    let found = bound(&chess(), blur, window, Unknowns::default()).unwrap();
    // By sums over the pixels of products of one-dimensional profiles.
    let phi = |s: f64| 0.5 * libm::erfc(-s * std::f64::consts::FRAC_1_SQRT_2);
    let once = |u: f64| u * phi(u / blur) + blur * (-0.5 * (u / blur).powi(2)).exp() / (2.0 * std::f64::consts::PI).sqrt();
    let profile = |u: f64| once(u + 0.5) - once(u - 0.5);
    let slope = |u: f64| phi((u + 0.5) / blur) - phi((u - 0.5) / blur);
    let information = |of_x: bool| -> f64 {
        let pixels = (13..=27).flat_map(|y| (13..=27).map(move |x| (f64::from(x) - 20.2, f64::from(y) - 19.9)));
        let slopes =
            pixels.map(|(x, y)| 0.8 * if of_x { slope(x) * (2.0 * profile(y) - 1.0) } else { slope(y) * (2.0 * profile(x) - 1.0) });
        slopes.map(|s| s * s).sum::<f64>() / (SIGMA * SIGMA)
    };
    assert!((found.sxx * information(true) - 1.0).abs() < 1e-6, "{found:?} {}", 1.0 / information(true));
    assert!((found.syy * information(false) - 1.0).abs() < 1e-6);
    assert!(found.sxy.abs() < 0.02 * found.sxx);
}

/// The bound by differences of products of one-dimensional profiles, with all unknowns but the shape, for grey values of 0.1 and 0.9.
#[test]
fn gradients_take_what_they_take_of_closed_forms() {
    let phi = |s: f64| 0.5 * libm::erfc(-s * std::f64::consts::FRAC_1_SQRT_2);
    // Unknowns: x, y, blur, mean, half, an added slope (2), the light's slope (2).
    let grey = |u: &[f64], column: usize, row: usize| {
        let once = |d: f64| d * phi(d / u[2]) + u[2] * (-0.5 * (d / u[2]).powi(2)).exp() / (2.0 * std::f64::consts::PI).sqrt();
        let profile = |d: f64| 2.0 * (once(d + 0.5) - once(d - 0.5)) - 1.0;
        let (dx, dy) = (column as f64 - u[0], row as f64 - u[1]);
        let even = u[3] - u[4] * profile(dx) * profile(dy);
        even * (1.0 + u[7] * dx + u[8] * dy) + u[5] * dx + u[6] * dy
    };
    let at = [7.2, 6.9, 0.8, 0.5, 0.4, 0.0, 0.0, 0.0, 0.0];
    let column = |unknown: usize| -> Vec<f64> {
        let moved = |h: f64| {
            let mut u = at;
            u[unknown] += h;
            u
        };
        let (high, low) = (moved(1e-4), moved(-1e-4));
        (0..225).map(|i| (grey(&high, i % 15, i / 15) - grey(&low, i % 15, i / 15)) / 2e-4).collect()
    };
    let columns: Vec<Vec<f64>> = (0..9).map(column).collect();
    for (gradient, slopes) in
        [(Gradient::None, vec![]), (Gradient::Added, vec![5, 6]), (Gradient::Light, vec![7, 8]), (Gradient::Both, vec![5, 6, 7, 8])]
    {
        let unknowns: Vec<usize> = (0..5).chain(slopes).collect();
        let product = |i: usize, j: usize| columns[unknowns[i]].iter().zip(&columns[unknowns[j]]).map(|(a, b)| a * b).sum::<f64>();
        let inverse = DMatrix::from_fn(unknowns.len(), unknowns.len(), product).try_inverse().unwrap();
        let expected = (inverse[(0, 0)] + inverse[(1, 1)]) * SIGMA * SIGMA;
        let found = bound(&chess(), 0.8, 15, Unknowns { levels: Levels::Two, blur: true, gradient, ..Unknowns::default() }).unwrap();
        let ratio = (found.sxx + found.syy) / expected;
        assert!((ratio - 1.0).abs() < 1e-6, "{gradient:?}: {ratio}");
    }
}

/// Of two areas that meet in a point on paper: what three grey values take, by differences of whole pictures. Of one area they are the two levels.
#[test]
fn the_grey_value_of_each_area_takes_what_it_takes() {
    let tip = (20.2, 19.9);
    let (left, right) = ([tip, (-20.0, -20.0), (-20.0, 50.0), (5.0, 60.0)], [tip, (5.0, 60.0), (60.0, 50.0), (60.0, 10.0)]);
    let greys = [0.9, 0.3, 0.1];
    let picture = |[paper, a, b]: [f64; 3], moved: [f64; 2]| {
        let polygon = |vertices: &[(f64, f64)], grey: f64| Polygon {
            id: String::new(),
            grey,
            vertices: vertices.iter().map(|&(x, y)| PixelPoint::new(x + moved[0], y + moved[1])).collect(),
        };
        let polygons = vec![polygon(&left, a), polygon(&right, b)];
        Picture::from(&Scene { width: 41, height: 41, background: paper, polygons, targets: Vec::new() })
    };
    let renderer = Renderer::new(&Optics { blur: 0.8, ..Optics::default() }, 41, 41).unwrap();
    let square = Square { corner: [13, 13], side: 15 };
    let grey = |greys, moved| renderer.render_window(&picture(greys, moved), greys[0], |piece| *piece, square);
    let difference = |high: Vec<f64>, low: Vec<f64>, step: f64| -> Vec<f64> { high.iter().zip(low).map(|(h, l)| (h - l) / step).collect() };
    let by_grey = |k: usize| {
        let level = |h: f64| std::array::from_fn(|i| greys[i] + if i == k { h } else { 0.0 });
        difference(grey(level(0.01), [0.0; 2]), grey(level(-0.01), [0.0; 2]), 0.02)
    };
    let columns = [
        difference(grey(greys, [0.02, 0.0]), grey(greys, [-0.02, 0.0]), 0.04),
        difference(grey(greys, [0.0, 0.02]), grey(greys, [0.0, -0.02]), 0.04),
        by_grey(0),
        by_grey(1),
        by_grey(2),
    ];
    let product = |i: usize, j: usize| columns[i].iter().zip(&columns[j]).map(|(a, b)| a * b).sum::<f64>();
    let inverse = DMatrix::from_fn(5, 5, product).try_inverse().unwrap();
    let expected = (inverse[(0, 0)] + inverse[(1, 1)]) * SIGMA * SIGMA;
    let (two, each) = (Unknowns { levels: Levels::Two, ..Unknowns::default() }, Unknowns { levels: Levels::Areas, ..Unknowns::default() });
    let trace = |picture: &Picture, set| bound(picture, 0.8, 15, set).map(|c| c.sxx + c.syy).unwrap();
    let junction = picture(greys, [0.0; 2]);
    assert!((trace(&junction, each) / expected - 1.0).abs() < 5e-3, "{} {expected}", trace(&junction, each));
    assert!(trace(&junction, each) > 1.01 * trace(&junction, two), "{} {}", trace(&junction, each), trace(&junction, two));
    assert!((trace(&chess(), each) / trace(&chess(), two) - 1.0).abs() < 1e-6, "chess has no third");
}

#[test]
fn unknowns_widen_the_bound_and_never_narrow_it() {
    let trace = |unknowns| bound(&chess(), 0.7, 15, unknowns).map(|c| c.sxx + c.syy).unwrap();
    let alone = trace(Unknowns::default());
    let shape = trace(Unknowns { shape: true, ..Unknowns::default() });
    let all = Unknowns { shape: true, levels: Levels::Two, blur: true, gradient: Gradient::Both };
    assert!(alone <= shape && shape <= trace(all), "{alone} {shape} {}", trace(all));
    let even = trace(Unknowns { gradient: Gradient::None, ..all });
    for gradient in [Gradient::Added, Gradient::Light] {
        let part = trace(Unknowns { gradient, ..all });
        assert!(even <= part && part <= trace(all), "{even} {part} {gradient:?}");
    }
    assert!(even < 1.15 * alone, "nearly point-symmetric in its window, so little is lost: {even} {alone}");
    // A triangle is not: up to sqrt 2 wider.
    let triangle = scene(&[&[(20.2, 12.9), (26.26, 23.4), (14.14, 23.4)]]);
    let trace = |unknowns| bound(&triangle, 0.7, 21, unknowns).map(|c| c.sxx + c.syy).unwrap();
    let ratio = (trace(Unknowns { shape: true, levels: Levels::Two, ..Unknowns::default() }) / trace(Unknowns::default())).sqrt();
    assert!(ratio > 1.02 && ratio < 1.6, "{ratio}");
}

#[test]
fn the_rotation_of_a_disc_takes_nothing() {
    let vertex = |i: i32| {
        let (s, c) = (f64::from(i) * std::f64::consts::TAU / 512.0).sin_cos();
        (20.2 + 6.0 * c, 19.9 + 6.0 * s)
    };
    let vertices: Vec<_> = (0..512).map(vertex).collect();
    let disc = scene(&[&vertices]);
    let trace = |unknowns| bound(&disc, 0.7, 21, unknowns).map(|c| c.sxx + c.syy).unwrap();
    let ratio = trace(Unknowns { shape: true, levels: Levels::Two, blur: true, ..Unknowns::default() }) / trace(Unknowns::default());
    assert!((1.0..1.02).contains(&ratio), "{ratio}");
}

/// Squares left of the window, wholly or in part, whose rows it shares: their light is the same in all of it, or none.
#[test]
fn what_is_far_left_of_the_window_takes_nothing() {
    let square = |x: f64, y: f64| vec![(x, y), (x + 2.0, y), (x + 2.0, y + 2.5), (x, y + 2.5)];
    let target = square(18.2, 18.4);
    let others: Vec<_> = (0..5).map(|i| square(-1.0 + f64::from(i % 2), 3.0 * f64::from(i) + 12.1)).collect();
    let unknowns = Unknowns { shape: true, levels: Levels::Two, blur: true, ..Unknowns::default() };
    let alone = bound(&scene(&[&target]), 0.6, 11, unknowns).unwrap();
    let crowd: Vec<&[(f64, f64)]> = others.iter().chain([&target]).map(Vec::as_slice).collect();
    let crowded = bound(&scene(&crowd), 0.6, 11, unknowns).unwrap();
    for (a, b) in [(alone.sxx, crowded.sxx), (alone.sxy, crowded.sxy), (alone.syy, crowded.syy)] {
        assert!((a - b).abs() < 1e-7 * (alone.sxx + alone.syy), "{alone:?} {crowded:?}");
    }
    // A wide bar from far left to behind the window does count.
    let bar = vec![(-5.0, 14.0), (30.0, 14.0), (30.0, 16.0), (-5.0, 16.0)];
    let barred = bound(&scene(&[&bar, &target]), 0.6, 11, unknowns).unwrap();
    assert!((barred.syy / alone.syy - 1.0).abs() > 1e-3, "{barred:?} {alone:?}");
}

/// A wall of its own grey value, all of it left of the window and higher than it: it adds nothing there, whose amount would be one more unknown.
#[test]
fn an_area_that_is_not_seen_is_no_unknown() {
    let wall = [(1.0, -30.0), (3.0, -30.0), (3.0, 70.0), (1.0, 70.0)];
    let square = [(18.2, 18.4), (20.2, 18.4), (20.2, 20.9), (18.2, 20.9)];
    let picture = |of: &[(&[(f64, f64)], f64)]| {
        let polygon = |(vertices, grey): &(&[(f64, f64)], f64)| {
            let vertices = vertices.iter().map(|&(x, y)| PixelPoint::new(x, y)).collect();
            Polygon { id: String::new(), grey: *grey, vertices }
        };
        Picture::from(&Scene { width: 41, height: 41, background: 0.9, polygons: of.iter().map(polygon).collect(), targets: Vec::new() })
    };
    let unknowns = Unknowns { shape: true, levels: Levels::Areas, blur: true, ..Unknowns::default() };
    let trace = |of: &[(&[(f64, f64)], f64)]| bound(&picture(of), 0.6, 11, unknowns).map(|c| c.sxx + c.syy).unwrap();
    for grey in [0.2, 0.1 + 1e-3, 1.0] {
        let (alone, beside) = (trace(&[(&square, 0.1)]), trace(&[(&wall, grey), (&square, 0.1)]));
        assert!((beside / alone - 1.0).abs() < 1e-9, "{grey}: {beside} {alone}");
    }
}

/// In a window within a disc there is no edge, but for what the blur leaves of it.
#[test]
fn what_leaves_a_position_anywhere_in_the_window_is_no_bound() {
    let disc = |radius: f64| {
        let vertex = |i: i32| {
            let (s, c) = (f64::from(i) * std::f64::consts::TAU / 512.0).sin_cos();
            (20.2 + radius * c, 19.9 + radius * s)
        };
        scene(&[&(0..512).map(vertex).collect::<Vec<_>>()])
    };
    let unknowns = Unknowns { shape: true, levels: Levels::Two, blur: true, ..Unknowns::default() };
    let trace = |radius: f64| bound(&disc(radius), 0.7, 15, unknowns).map(|c| (c.sxx + c.syy).sqrt());
    assert!(trace(6.0).unwrap() < 0.05);
    for radius in [10.5, 11.5, 12.5, 13.5, 16.0] {
        assert!(trace(radius).is_none_or(|bound| bound < 15.0), "{radius}: {:?}", trace(radius));
    }
    assert_eq!(trace(14.0), None);
}

#[test]
fn an_edge_or_nothing_has_no_bound() {
    let edge = scene(&[&[(-9.0, -9.0), (20.2, -9.0), (20.2, 60.0), (-9.0, 60.0)]]);
    assert_eq!(bound(&edge, 0.7, 15, Unknowns::default()), None);
    assert_eq!(bound(&scene(&[]), 0.7, 15, Unknowns::default()), None);
    let bounds = Bounds::new(&Optics::default(), 41, 41, 15).unwrap();
    let picture = chess();
    assert!(bounds.window(&Outlined::of(&picture), PixelPoint::new(3.0, 20.0)).is_none(), "the window leaves the image");
    let window = bounds.window(&Outlined::of(&picture), PixelPoint::new(20.2, 19.9)).unwrap();
    assert_eq!(window.bounds(&[Unknowns::default()], Some, |_| None, &mut Work::default()), [None], "a chain without a variance");
    assert!(
        window.bounds(&[Unknowns { blur: true, ..Unknowns::default() }], Some, |_| Some(1e-4), &mut Work::default())[0].is_some(),
        "no blur to be estimated"
    );
}

/// A square window holds longer parts of the edges of a corner that is turned by 45 degrees, by 10 degrees hardly. Along its edges an upright corner is deformed without
/// a trace, and that is to take nothing, however soft it is.
#[test]
fn a_corner_has_about_one_bound_at_any_roll() {
    let all = Unknowns { shape: true, levels: Levels::Two, blur: true, ..Unknowns::default() };
    for blur in [0.7, 1.5, 3.0] {
        let sigma = |roll: f64| {
            let (sin, cos) = roll.to_radians().sin_cos();
            let turned = |(x, y): (f64, f64)| (20.2 + 70.0 * (cos * x - sin * y), 19.9 + 70.0 * (sin * x + cos * y));
            let quarters = [1.0, -1.0].map(|s| [(0.0, 0.0), (s, 0.0), (s, s), (0.0, s)].map(turned));
            let found = bound(&scene(&[&quarters[0], &quarters[1]]), blur, 15, all).unwrap();
            (found.sxx + found.syy).sqrt()
        };
        let upright = sigma(0.0);
        for roll in [0.5, 3.0, 10.0] {
            let ratio = sigma(roll) / upright;
            println!("blur {blur}, roll {roll}: {ratio:.4} of {upright:.5} px");
            assert!((0.97..1.03).contains(&ratio), "blur {blur}, roll {roll}: {ratio}");
        }
    }
}

#[test]
fn normal_equations_are_the_product_of_matrices() {
    for side in [1, 7, 8, 9, 15, 21] {
        let value = |j: usize, y: usize, x: usize| ((7 * x + 3 * j + 5 * y) as f64).sin() + j as f64;
        let weight = |y: usize, x: usize| 1.0 + 0.5 * ((x + y) as f64).cos();
        let mut sums = Sums::new(5, side);
        // Whatever stands in the margins.
        sums.rows.fill(3.0);
        for y in 0..side {
            (0..5).for_each(|j| fill(&mut sums.rows[j * stride(side)..], side, |x| value(j, y, x)));
            fill(&mut sums.weights, side, |x| weight(y, x));
            sums.add();
        }
        let design = DMatrix::from_fn(side * side, 5, |i, j| value(j, i / side, i % side));
        let weights = DMatrix::from_fn(side * side, side * side, |i, j| if i == j { weight(i / side, i % side) } else { 0.0 });
        let expected = design.transpose() * weights * &design;
        assert!((sums.normal() - &expected).amax() < 1e-12 * expected.amax(), "{side}: {expected}");
    }
}

/// Half the light over a black level, with half the noise, tells as much.
#[test]
fn what_the_sensor_makes_of_light_counts() {
    let bounds = Bounds::new(&Optics { blur: 0.8, ..Optics::default() }, 41, 41, 15).unwrap();
    let picture = chess();
    let window = bounds.window(&Outlined::of(&picture), PixelPoint::new(20.2, 19.9)).unwrap();
    let all = Unknowns { shape: true, levels: Levels::Areas, blur: true, gradient: Gradient::Added };
    let trace = |dark: f64, gain: f64, sigma: f64| {
        let found = window.bounds(&[all], |light| Some(dark + gain * light), |_| Some(sigma * sigma), &mut Work::default())[0].unwrap();
        found.sxx + found.syy
    };
    let [plain, half] = [trace(0.0, 1.0, SIGMA), trace(0.1, 0.5, 0.5 * SIGMA)];
    assert!((half / plain - 1.0).abs() < 1e-9, "{half} {plain}");
    assert!((trace(0.0, 0.5, SIGMA) / plain - 4.0).abs() < 1e-9);
}

/// Without a blur derivatives are differences; with the least that there is, integrals along the outlines.
#[test]
fn without_a_blur_the_bound_is_nearly_that_of_a_small_one() {
    let triangle = scene(&[&[(20.2, 12.9), (27.3, 23.1), (14.1, 25.6)]]);
    for shape in [false, true] {
        let trace =
            |blur| bound(&triangle, blur, 21, Unknowns { shape, levels: Levels::Areas, ..Unknowns::default() }).map(|c| c.sxx + c.syy);
        let [none, small] = [0.0, 0.02].map(|blur| trace(blur).unwrap());
        println!("shape {shape}: {}", none / small);
        assert!((none / small - 1.0).abs() < 0.01, "shape {shape}: {none} {small}");
    }
}

/// Outlines on all sides of a window, touching it or not, one of them around it: what is passed over tells nothing.
#[test]
fn what_is_passed_over_does_not_matter() {
    let mut state = 5_u64;
    let mut draw = |from: f64, to: f64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        from + (to - from) * (state >> 33) as f64 / f64::from(1_u32 << 31)
    };
    let all = Unknowns { shape: true, levels: Levels::Two, blur: true, gradient: Gradient::Added };
    let mut left_out = 0;
    for round in 0..60 {
        let mut triangle = |size: f64| {
            let (x, y) = (draw(-15.0, 56.0), draw(-15.0, 56.0));
            [0, 1, 2].map(|_| (x + draw(-size, size), y + draw(-size, size)))
        };
        let triangles: Vec<_> = [4.0, 4.0, 4.0, 4.0, 9.0, 9.0, 30.0].map(&mut triangle).to_vec();
        let mut areas: Vec<&[(f64, f64)]> = triangles.iter().map(|vertices| &vertices[..]).collect();
        areas.push(&[(-60.0, -60.0), (90.0, -60.0), (90.0, 90.0), (-60.0, 90.0)]);
        let picture = scene(&areas);
        let bounds = Bounds::new(&Optics { blur: [0.0, 0.7, 1.5][round % 3], ..Optics::default() }, 41, 41, 11).unwrap();
        let window = bounds.window(&Outlined::of(&picture), PixelPoint::new(20.2, 19.9)).unwrap();
        let whole = Window { near: picture.clone(), ..bounds.window(&Outlined::of(&picture), window.at).unwrap() };
        let [some, every] = [&window, &whole].map(|window| {
            let normal = window.normal(&[all], Some, |_| Some(SIGMA * SIGMA), &mut Work::default());
            normal.expect("a variance").1
        });
        // What a closed outline on the left adds up to is zero but for the kernel's table, which is interpolated to 4e-8.
        for (i, j) in (0..every.nrows()).flat_map(|i| (0..=i).map(move |j| (i, j))) {
            let off = (some[(i, j)] - every[(i, j)]).abs() / (every[(i, i)] * every[(j, j)]).sqrt().max(1e-3);
            assert!(off < 1e-6, "round {round}, {i} and {j}: {} {}", some[(i, j)], every[(i, j)]);
        }
        left_out += picture.pieces.len() - window.near.pieces.len();
    }
    assert!(left_out > 60 * 8, "{left_out}");
}
