//! Renders against closed forms and quadrature that share nothing with the renderer.

mod areas;
mod far;
mod fits;
mod shapes;

use calibench_model::Scene;

use super::{Picture, Piece, Renderer, orient};
use crate::optics::{Motion, Optics, Tail};
use shapes::{Spot, pixel_mean};

const SIZE: usize = 40;

fn polygon(vertices: &[(f64, f64)]) -> Vec<Piece> {
    let next = vertices.iter().cycle().skip(1);
    let mut pieces: Vec<Piece> = vertices.iter().zip(next).map(|(a, b)| Piece::straight([a.0, a.1], [b.0, b.1], 0.0)).collect();
    orient(&mut pieces, 0.7);
    pieces
}

fn disc(centre: (f64, f64), radius: f64) -> Vec<Piece> {
    let n = 32;
    let at = |i: i32| {
        let (sine, cosine) = (f64::from(i) * std::f64::consts::FRAC_PI_2 / f64::from(n)).sin_cos();
        [centre.0 + radius * cosine, centre.1 + radius * sine]
    };
    let piece = |i: i32| Piece { points: std::array::from_fn(|k| at(4 * i + k as i32)), contrast: 0.0 };
    let mut pieces: Vec<Piece> = (0..n).map(piece).collect();
    orient(&mut pieces, 0.7);
    pieces
}

/// The largest difference to `expected` (0 outside, 1 inside), as a fraction of contrast.
fn worst(optics: &Optics, pieces: Vec<Piece>, jitter: &[f64], expected: impl Fn(f64, f64) -> f64) -> f64 {
    worst_of_every(1, optics, pieces, jitter, expected)
}

/// [`worst`] over every `step`-th pixel of every row.
fn worst_of_every(step: usize, optics: &Optics, pieces: Vec<Piece>, jitter: &[f64], expected: impl Fn(f64, f64) -> f64) -> f64 {
    let picture = Picture { width: SIZE, height: SIZE, background: 0.2, pieces };
    let image = Renderer::new(optics, SIZE, SIZE).unwrap().render(&picture, jitter);
    let mut worst = 0.0_f64;
    for (y, x) in (0..SIZE).flat_map(|y| (y % step..SIZE).step_by(step).map(move |x| (y, x))) {
        let grey = (f64::from(image.at(x, y)) - 0.2) / 0.7;
        worst = worst.max((grey - expected(x as f64, y as f64)).abs());
    }
    worst
}

/// A half plane through (`x`, `y`) whose inside lies along (cos, sin) of `angle`, as a polygon that reaches far outside the image.
fn half_plane(x: f64, y: f64, angle: f64) -> Vec<Piece> {
    let (s, c) = angle.sin_cos();
    let far = 500.0;
    let corner = |along: f64, in_: f64| (x - s * along + c * in_, y + c * along + s * in_);
    polygon(&[corner(-far, 0.0), corner(far, 0.0), corner(far, far), corner(-far, far)])
}

#[test]
fn edges_at_any_angle_and_phase() {
    for blur in [0.02, 0.1, 0.3, 0.5, 0.7, 1.0, 2.0] {
        for (i, angle) in [0.0_f64, 0.1, 0.7, 1.2, std::f64::consts::FRAC_PI_2, 2.5, 4.0, 5.9].into_iter().enumerate() {
            let (x, y) = (19.3 + 0.137 * i as f64, 20.1 + 0.211 * i as f64);
            let aperture = if i % 2 == 0 { 1.0 } else { 0.8 };
            let optics = Optics { blur, aperture, ..Optics::default() };
            let (s, c) = angle.sin_cos();
            let expected = |u: f64, v: f64| shapes::edge(((u - x) * c + (v - y) * s) / blur, c * aperture / blur, s * aperture / blur);
            let error = worst(&optics, half_plane(x, y, angle), &[], expected);
            assert!(error < 5e-6, "blur {blur}, angle {angle}: {error:e}");
        }
    }
}

#[test]
fn an_upright_corner_is_the_product_of_two_edges() {
    for blur in [0.02, 0.1, 0.3, 0.7, 2.0] {
        for (x, y) in [(19.5, 20.0), (20.13, 19.77)] {
            let optics = Optics { blur, ..Optics::default() };
            let expected = |u: f64, v: f64| shapes::edge((u - x) / blur, 1.0 / blur, 0.0) * shapes::edge((v - y) / blur, 1.0 / blur, 0.0);
            let error = worst(&optics, polygon(&[(x, y), (x + 99.0, y), (x + 99.0, y + 99.0), (x, y + 99.0)]), &[], expected);
            assert!(error < 5e-6, "blur {blur} at ({x}, {y}): {error:e}");
        }
    }
}

#[test]
fn a_smaller_photosite_sees_a_sharp_edge_sharper() {
    let optics = Optics { aperture: 0.6, ..Optics::default() };
    let error = worst(&optics, half_plane(19.87, 20.0, 0.0), &[], |x, _| ((x - 19.87) / 0.6 + 0.5).clamp(0.0, 1.0));
    assert!(error < 2e-7, "{error:e}");
    let slanted = worst(&optics, half_plane(19.3, 20.2, 0.4), &[], |x, y| {
        let (s, c) = 0.4_f64.sin_cos();
        pixel_mean(x, y, 0.6, 200, |u, v| f64::from(u8::from((u - 19.3) * c + (v - 20.2) * s > 0.0)))
    });
    assert!(slanted < 2e-3, "the sum over 200 x 200 points is no better than that: {slanted:e}");
}

#[test]
fn discs_under_every_blur() {
    let (centre, radius) = ((19.6, 20.3), 7.3);
    for blur in [0.1, 0.3, 0.7, 2.0] {
        let optics = Optics { blur, aperture: 0.9, ..Optics::default() };
        let spot = Spot { centre, radius, sigma: blur };
        let error = worst_of_every(9, &optics, disc(centre, radius), &[], |x, y| pixel_mean(x, y, 0.9, 12, |u, v| spot.at(u, v)));
        assert!(error < 2e-5, "blur {blur}: {error:e}");
    }
}

#[test]
fn a_defocus_disc_is_the_mean_over_a_disc_of_shifts() {
    for (defocus, blur) in [(0.7, 0.3), (3.0, 0.3), (3.0, 0.1), (6.0, 0.8)] {
        let optics = Optics { blur, defocus, ..Optics::default() };
        let angle = 0.6_f64;
        let (s, c) = angle.sin_cos();
        // Across an edge the disc is a half-circle distribution of shifts.
        let expected = |u: f64, v: f64| {
            let d = (u - 19.3) * c + (v - 20.2) * s;
            shapes::half_circle(400, |t| shapes::edge((d - defocus * t) / blur, c / blur, s / blur))
        };
        let error = worst(&optics, half_plane(19.3, 20.2, angle), &[], expected);
        assert!(error < 2e-5, "defocus {defocus}, blur {blur}: {error:e}");
        // And at a corner, where a disc is not separable.
        let upright = |u: f64, v: f64| shapes::edge((u - 20.1) / blur, 1.0 / blur, 0.0) * shapes::edge((v - 19.8) / blur, 1.0 / blur, 0.0);
        let expected = |u: f64, v: f64| shapes::disc_mean(260, |dx, dy| upright(u - defocus * dx, v - defocus * dy));
        let pieces = polygon(&[(20.1, 19.8), (99.0, 19.8), (99.0, 99.0), (20.1, 99.0)]);
        let error = worst_of_every(13, &optics, pieces, &[], expected);
        assert!(error < 2e-5, "corner, defocus {defocus}, blur {blur}: {error:e}");
    }
}

#[test]
fn a_motion_is_the_mean_over_a_line_of_shifts() {
    let (blur, length, direction) = (0.4, 5.0, 0.3_f64);
    let optics = Optics { blur, motion: Some(Motion { length, direction }), ..Optics::default() };
    let (s, c) = 1.1_f64.sin_cos();
    let along = length * (direction.cos() * c + direction.sin() * s);
    let expected = |u: f64, v: f64| {
        let d = (u - 19.3) * c + (v - 20.2) * s;
        (0..2000).map(|i| shapes::edge((d - along * ((f64::from(i) + 0.5) / 2000.0 - 0.5)) / blur, c / blur, s / blur)).sum::<f64>()
            / 2000.0
    };
    let error = worst(&optics, half_plane(19.3, 20.2, 1.1), &[], expected);
    assert!(error < 1e-5, "{error:e}");
}

#[test]
fn a_tail_is_the_sum_of_two_gaussians_by_their_shares() {
    let motion = Some(Motion { length: 2.5, direction: 0.6 });
    for (plain, jitter) in [
        (Optics { blur: 0.6, ..Optics::default() }, vec![]),
        (Optics { blur: 0.6, motion, aperture: 0.8, ..Optics::default() }, vec![]),
        (Optics { blur: 0.6, ..Optics::default() }, (0..SIZE).map(|row| 0.1 * row as f64 - 2.0).collect()),
    ] {
        let tail = Tail { share: 0.3, blur: 3.0 };
        let pieces = || [disc((17.3, 21.9), 8.4), polygon(&[(30.2, -4.0), (60.0, 3.0), (36.0, 52.0)])].concat();
        let grey = |optics: &Optics| {
            let picture = Picture { width: SIZE, height: SIZE, background: 0.2, pieces: pieces() };
            Renderer::new(optics, SIZE, SIZE).unwrap().render(&picture, &jitter).into_grey()
        };
        let (both, core, wide) = (grey(&Optics { tail: Some(tail), ..plain }), grey(&plain), grey(&Optics { blur: 3.0, ..plain }));
        let sum = core.iter().zip(&wide).map(|(core, wide)| 0.7 * core + 0.3 * wide);
        let error = both.iter().zip(sum).map(|(both, sum)| (both - sum).abs()).fold(0.0, f32::max);
        assert!(error < 3e-6, "{plain:?}: {error:e}");
    }
}

#[test]
fn a_blur_that_grows_is_each_pixels_own() {
    let (low, high) = (0.5_f64, 1.6_f64);
    let optics = Optics { blur: low, corner_blur: Some(high), ..Optics::default() };
    let (s, c) = 0.35_f64.sin_cos();
    let middle = (SIZE as f64 - 1.0) / 2.0;
    let expected = |u: f64, v: f64| {
        let r2 = ((u - middle).powi(2) + (v - middle).powi(2)) / (2.0 * middle * middle);
        let blur = (low * low + (high * high - low * low) * r2).sqrt();
        shapes::edge(((u - 12.2) * c + (v - 9.1) * s) / blur, c / blur, s / blur)
    };
    let error = worst(&optics, half_plane(12.2, 9.1, 0.35), &[], expected);
    assert!(error < 1e-5, "{error:e}");
}

#[test]
fn jitter_moves_rows_and_nothing_else() {
    let jitter: Vec<f64> = (0..SIZE).map(|y| 0.3 * (y as f64 * 1.7).sin()).collect();
    let (s, c) = 0.5_f64.sin_cos();
    for blur in [0.0, 0.6] {
        let optics = Optics { blur, ..Optics::default() };
        let expected = |u: f64, v: f64| {
            let d = (u - jitter[v as usize] - 19.3) * c + (v - 20.2) * s;
            if blur == 0.0 { shapes::sharp_edge(d, c, s) } else { shapes::edge(d / blur, c / blur, s / blur) }
        };
        let error = worst(&optics, half_plane(19.3, 20.2, 0.5), &jitter, expected);
        assert!(error < 5e-6, "blur {blur}: {error:e}");
    }
}

#[test]
fn outlines_beyond_every_side_leave_no_trace_and_no_seam() {
    for blur in [0.0, 0.8] {
        let optics = Optics { blur, ..Optics::default() };
        for (dx, dy) in [(-300.0, 3.3), (300.0, 3.3), (5.1, -300.0), (5.1, 300.0), (-300.0, -300.0), (-52.0, 0.0), (52.0, 0.2)] {
            let away = polygon(&[(dx, dy), (dx + 21.0, dy + 0.4), (dx + 20.0, dy + 21.0)]);
            assert!(worst(&optics, away, &[], |_, _| 0.0) < 1e-7, "blur {blur}: ({dx}, {dy})");
        }
        let around = polygon(&[(-80.0, -70.0), (120.0, -60.0), (110.0, 130.0), (-90.0, 100.0)]);
        assert!(worst(&optics, around, &[], |_, _| 1.0) < 1e-7);
    }
}

#[test]
fn threads_change_no_byte() {
    let scene = Scene { width: 300, height: 270, background: 0.1, polygons: Vec::new(), targets: Vec::new() };
    let mut picture = Picture::from(&scene);
    for i in 0..50 {
        let (x, y) = (f64::from(i % 10) * 29.7, f64::from(i / 10) * 51.3);
        picture.pieces.extend(disc((x, y), 11.7));
    }
    let renderer = Renderer::new(&Optics { blur: 0.7, ..Optics::default() }, 300, 270).unwrap();
    let with = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| renderer.render(&picture, &[]));
    assert_eq!(with(1), with(3));
}

#[test]
fn optics_out_of_range_are_named() {
    let wrong = |optics: Optics| optics.check().unwrap_err().to_string();
    let fine = Optics::default();
    assert!(wrong(Optics { blur: 0.001, ..fine }).contains("the blur is 0.001: expected 0 or 0.02 to 100 px"));
    assert!(wrong(Optics { blur: f64::NAN, ..fine }).contains("the blur"));
    assert!(wrong(Optics { aperture: 1.2, ..fine }).contains("photosite"));
    assert!(wrong(Optics { blur: 1.0, corner_blur: Some(0.5), ..fine }).contains("corners"));
    assert!(wrong(Optics { defocus: 2.0, ..fine }).contains("defocus disc needs a Gaussian blur of at least 0.1 px"));
    let tail = |share, blur| Some(Tail { share, blur });
    assert!(wrong(Optics { blur: 1.0, tail: tail(0.6, 2.0), ..fine }).contains("the tail's share is 0.6"));
    assert!(wrong(Optics { blur: 1.0, tail: tail(0.1, 0.8), ..fine }).contains("the tail's blur is 0.8"));
    assert!(wrong(Optics { tail: tail(0.1, 2.0), ..fine }).contains("the tail's blur"), "beside no blur at all");
}

/// Levels of blur are blended where a piece reaches; a piece without contrast that reaches everywhere changes nothing.
#[test]
fn a_blur_that_grows_is_blended_wherever_a_piece_reaches() {
    let optics = Optics { blur: 0.6, corner_blur: Some(2.0), ..Optics::default() };
    let square = polygon(&[(11.3, 9.2), (30.1, 9.2), (30.1, 22.8), (11.3, 22.8)]);
    let jitter: Vec<f64> = (0..SIZE).map(|row| 6.0 * (row as f64 * 1.7).sin()).collect();
    for jitter in [&[][..], &jitter] {
        let render = |pieces: Vec<Piece>| {
            let picture = Picture { width: SIZE, height: SIZE, background: 0.2, pieces };
            Renderer::new(&optics, SIZE, SIZE).unwrap().render(&picture, jitter)
        };
        let frame = [(-9.0, -9.0), (50.0, -9.0), (50.0, 50.0), (-9.0, 50.0)];
        let nothing = polygon(&frame).into_iter().map(|piece| Piece { contrast: 0.0, ..piece });
        let (part, whole) = (render(square.clone()), render(square.iter().copied().chain(nothing).collect()));
        let worst = part.grey().iter().zip(whole.grey()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 1e-6, "{worst}");
    }
}
