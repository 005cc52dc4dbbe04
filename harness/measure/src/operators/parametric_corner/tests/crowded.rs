//! Windows that hold more than one corner, and windows that hold none.

use statrs::function::erf::erf;

use super::*;
use crate::tests::closed_form_images::Noise;

const BLUR: f64 = 0.7;

/// A blurred edge, -1 to 1.
fn edge(d: f64) -> f64 {
    erf(d / (BLUR * 2_f64.sqrt()))
}

/// Blurred stripes of width `side`, -1 and 1 in turn, with an edge at 0.
fn stripes(d: f64, side: f64) -> f64 {
    let nearest = (d / side).round();
    let sign = if (nearest as i64).rem_euclid(2) == 0 { 1.0 } else { -1.0 };
    let from = d - nearest * side;
    sign * (edge(from) - edge(from - side) - edge(from + side))
}

/// The photosite is a point: grey values are those of the blur alone.
fn measured(image: &Image, at: [f64; 2]) -> Result<Measurement, Rejection> {
    operator("window=15,photosite=0.1").measure(image, &Start::at(PixelPoint::new(at[0], at[1])))
}

/// Turned by `turn` about `at`.
fn turned(x: usize, y: usize, at: [f64; 2], turn: f64) -> [f64; 2] {
    let (sine, cosine) = turn.sin_cos();
    let (dx, dy) = (x as f64 - at[0], y as f64 - at[1]);
    [dx * cosine + dy * sine, dy * cosine - dx * sine]
}

/// A window of 15 px holds nine corners of such a board; the next one is as strong and within the search.
#[test]
fn corners_of_small_squares_are_measured_with_smaller_windows() {
    let mut noise = Noise(3);
    for side in [6.0, 7.0, 8.0, 10.0] {
        let (mut squares, count) = (0.0, 60);
        for k in 0..count {
            let k = f64::from(k);
            let (at, turn) = ([30.0 + (0.618 * k).fract() - 0.5, 30.0 + (0.755 * k).fract() - 0.5], 0.37 * k);
            let board = Image::from_fn(61, 61, |x, y| {
                let [u, v] = turned(x, y, at, turn);
                (0.5 + 0.3 * stripes(u, side) * stripes(v, side)) as f32
            });
            let found = measured(&noise.on(&board, 0.005), [30.4, 29.7]).unwrap();
            let off = found.position.distance(PixelPoint::new(at[0], at[1]));
            assert!(off < 0.2, "squares of {side} px, corner {k}: {off} px off");
            squares += off * off;
        }
        let rms = (squares / f64::from(count)).sqrt();
        println!("squares of {side} px: {rms:.4} px RMS");
        assert!(rms < 0.05, "squares of {side} px: {rms} px RMS");
    }
}

/// A corner and beside it, `away` px off, a dark bar of so many px.
fn beside_a_bar(k: f64, away: f64, wide: f64) -> ([f64; 2], Image<'static>) {
    let (at, turn) = ([30.0 + (0.618 * k).fract() - 0.5, 30.0 + (0.755 * k).fract() - 0.5], 0.37 * k);
    let image = Image::from_fn(61, 61, |x, y| {
        let ([u, v], [across, _]) = (turned(x, y, at, turn), turned(x, y, at, turn + 0.5));
        let bar = 0.5 * (edge(across - away) - edge(across - away - wide));
        let corner = 0.5 + 0.3 * edge(u) * edge(v);
        (corner * (1.0 - bar) + 0.2 * bar) as f32
    });
    (at, image)
}

/// Where the bar takes the outer part of the window alone, too little to reject the fit, a smaller window is the better one.
#[test]
fn a_bar_at_the_border_of_the_window_costs_no_more_than_a_smaller_window() {
    let mut noise = Noise(6);
    let (mut squares, count) = (0.0, 200);
    for k in 0..count {
        let (at, image) = beside_a_bar(f64::from(k), 6.0 + 0.5 * f64::from(k % 6), 10.0);
        let found = measured(&noise.on(&image, 0.005), [30.2, 29.9]).unwrap();
        let off = found.position.distance(PixelPoint::new(at[0], at[1]));
        assert!(off < 0.1, "corner {k}: {off} px");
        squares += off * off;
    }
    let rms = (squares / f64::from(count)).sqrt();
    println!("{rms:.4} px RMS");
    assert!(rms < 0.02, "{rms} px RMS");
}

/// A bar beside the corner, 2 px wide: without a word it would move it by tenths of a pixel.
#[test]
fn a_bar_beside_the_corner_does_not_pass_silently() {
    let mut noise = Noise(4);
    let (mut kept, mut far) = (0, 0);
    for k in 0..200 {
        let (at, image) = beside_a_bar(f64::from(k), 3.0 + f64::from(k % 4), 2.0);
        if let Ok(found) = measured(&noise.on(&image, 0.005), [30.2, 29.9]) {
            let off = found.position.distance(PixelPoint::new(at[0], at[1]));
            let sigma = found.covariance.map_or(0.0, |c| (c.sxx + c.syy).sqrt());
            kept += 1;
            far += i32::from(off > 0.1 && off > 4.0 * sigma);
        }
    }
    println!("{kept} of 200 are measured, {far} of them wrong without a word");
    assert!(far <= 4, "{far} of {kept}");
}
