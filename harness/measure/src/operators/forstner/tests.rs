use super::*;
use crate::conformance;
use crate::registry::Registry;
use crate::tests::closed_form_images::{Noise, Picture};
use calibench_model::{Affine, TargetKind};

/// A light quarter plane x >= 1, y >= 1: the pixel's edges, and so the corner, lie at (0.5, 0.5) from the pixel (`cx`, `cy`).
fn quarter_plane(side: usize, cx: usize, cy: usize) -> Image<'static> {
    Image::from_fn(side, side, |x, y| if x > cx && y > cy { 0.9 } else { 0.1 })
}

/// Closed form of Eq. 5 with Sobel gradients for that corner, from the corner itself, px.
///
/// With the vertical smoothing (1, 2, 1) a step gives `s = 1, 3, 4, 4, ...` in rows 0, 1, 2, ... (0 above), so `gx = s(y)` in the two columns
/// 0 and 1 beside the edge, and `gy = s(x)` in the rows 0 and 1. With `m` rows (columns) from 2 to the window's end:
/// `sum gx^2 = 2 (1 + 9 + 16 m)`, `sum gx gy = (1 + 3)^2 = 16`, and, from the corner, `sum (x gx^2 + y gx gy) = 0 + (1 + 3) (3 - 1) / 2 = 4`.
fn closed_form(window: i64, start: (i64, i64)) -> (f64, f64) {
    let beyond = |s: i64| (s + window / 2 - 1) as f64;
    let (rows, columns) = (beyond(start.1), beyond(start.0));
    let (gxx, gyy, gxy) = (20.0 + 32.0 * rows, 20.0 + 32.0 * columns, 16.0);
    let determinant = gxx * gyy - gxy * gxy;
    (4.0 * (gyy - gxy) / determinant, 4.0 * (gxx - gxy) / determinant)
}

#[test]
fn axis_aligned_corner_has_its_closed_form_bias() {
    let (cx, cy) = (20_i64, 22_i64);
    let image = quarter_plane(48, 20, 22);
    for window in (5..=31).step_by(2) {
        for start in [(0, 0), (1, 1), (1, 0), (2, 1), (-1, 1)] {
            let (dx, dy) = closed_form(window, start);
            let at = PixelPoint::new((cx + start.0) as f64, (cy + start.1) as f64);
            let found = Forstner::new(window as usize).measure(&image, &Start::at(at)).unwrap().position;
            let (ex, ey) = (found.x - (cx as f64 + 0.5) - dx, found.y - (cy as f64 + 0.5) - dy);
            // Grey values 0.1 and 0.9 in f32: 1e-8 relative.
            assert!(ex.abs() < 1e-8 && ey.abs() < 1e-8, "window {window}, start {start:?}: {ex:e} {ey:e}");
        }
    }
}

#[test]
fn nearest_start_gives_one_over_nine_plus_eight_m() {
    let (dx, dy) = closed_form(11, (1, 1));
    assert!((dx - 1.0 / 49.0).abs() < 1e-15 && (dy - 1.0 / 49.0).abs() < 1e-15);
}

#[test]
fn conforms_at_every_window() {
    for window in (3..=31).step_by(2) {
        conformance::check(&Forstner::new(window), 1e-6);
    }
}

#[test]
fn kernel_agrees_with_plain_sums() {
    let image = conformance::textured_corner(64);
    for window in (3..=31_usize).step_by(2) {
        let sums = kernel::sums(&image, 9, 11, window);
        let half = (window / 2) as f64;
        let g = |x: usize, y: usize| f64::from(image.at(9 + x, 11 + y));
        let (mut gxx, mut bx, mut c) = (0.0, 0.0, 0.0);
        for y in 0..window {
            for x in 0..window {
                let gx = g(x + 2, y) + 2.0 * g(x + 2, y + 1) + g(x + 2, y + 2) - g(x, y) - 2.0 * g(x, y + 1) - g(x, y + 2);
                let gy = g(x, y + 2) + 2.0 * g(x + 1, y + 2) + g(x + 2, y + 2) - g(x, y) - 2.0 * g(x + 1, y) - g(x + 2, y);
                let t = gx * (x as f64 - half) + gy * (y as f64 - half);
                gxx += gx * gx;
                bx += gx * t;
                c += t * t;
            }
        }
        assert!((sums.gxx - gxx).abs() < 1e-12 * gxx, "{window}");
        assert!((sums.bx - bx).abs() < 1e-12 * (gxx * c).sqrt(), "{window}");
        assert!((sums.c - c).abs() < 1e-12 * c, "{window}");
    }
}

#[test]
fn an_edge_is_no_corner() {
    for angle in [0.0_f64, 0.3, 1.1, 2.0] {
        let (sin, cos) = angle.sin_cos();
        let image = Image::from_fn(41, 41, |x, y| ((((x as f64 - 20.0) * cos + (y as f64 - 20.0) * sin) * 0.7).tanh()) as f32);
        let found = Forstner::new(11).measure(&image, &Start::at(PixelPoint::new(20.0, 20.0)));
        assert_eq!(found.unwrap_err(), Rejection::NoCorner, "{angle}");
    }
}

#[test]
fn covariance_is_the_scatter_of_the_edge_lines_about_the_point() {
    // sigma0^2 N^-1 with sigma0^2 = sum of (g . (p_i - p))^2 over the window, divided by m - 2: here added up as written.
    let image = conformance::textured_corner(64);
    let found = Forstner::new(9).measure(&image, &Start::at(PixelPoint::new(32.0, 32.0))).unwrap();
    let at = |x: i32, y: i32| f64::from(image.at((32 + x) as usize, (32 + y) as usize));
    let (mut omega, mut n) = (0.0, [0.0; 3]);
    for (x, y) in (-4..=4).flat_map(|y| (-4..=4).map(move |x| (x, y))) {
        let column = |x: i32| at(x, y - 1) + 2.0 * at(x, y) + at(x, y + 1);
        let row = |y: i32| at(x - 1, y) + 2.0 * at(x, y) + at(x + 1, y);
        let (gx, gy) = (column(x + 1) - column(x - 1), row(y + 1) - row(y - 1));
        let (dx, dy) = (32.0 + f64::from(x) - found.position.x, 32.0 + f64::from(y) - found.position.y);
        omega += (gx * dx + gy * dy).powi(2);
        n = [n[0] + gx * gx, n[1] + gx * gy, n[2] + gy * gy];
    }
    let scale = omega / 79.0 / (n[0] * n[2] - n[1] * n[1]);
    let covariance = found.covariance.unwrap();
    for (ours, expected) in [(covariance.sxx, scale * n[2]), (covariance.sxy, -scale * n[1]), (covariance.syy, scale * n[0])] {
        assert!((ours - expected).abs() < 1e-10 * scale * (n[0] + n[2]), "{covariance:?}");
    }
}

fn operator(spec: &str) -> Box<dyn Operator> {
    Registry::builtin().parse(spec).unwrap().operator.unwrap()
}

#[test]
fn conforms_with_every_option() {
    for spec in
        ["iterations=20", "gauss=3", "gauss=2.5,iterations=60", "covariance=1", "covariance=1,noise=0.01,gauss=4", "size=0.5,roundness=0.2"]
    {
        conformance::check(&*operator(&format!("forstner:{spec}")), 1e-6);
    }
}

#[test]
fn weighted_sums_with_equal_weights_are_the_kernels() {
    let image = conformance::textured_corner(64);
    let (plain, weighted) = (kernel::sums(&image, 25, 26, 11), Gradients::new(&image, (31, 32), 5, 0.0, (0.0, 0.0)).sums());
    for (a, b) in
        [(plain.gxx, weighted.gxx), (plain.gxy, weighted.gxy), (plain.bx, weighted.bx), (plain.by, weighted.by), (plain.c, weighted.c)]
    {
        assert!((a - b).abs() < 1e-12 * plain.c, "{a} {b}");
    }
}

/// A corner of one area: two edges of a large square.
fn corner(at: [f64; 2], turn: f64, sigma: f64) -> Picture {
    let (sin, cos) = turn.sin_cos();
    let affine = Affine { axx: 60.0 * cos, axy: -60.0 * sin, ayx: 60.0 * sin, ayy: 60.0 * cos };
    Picture { kind: TargetKind::Corner, at, affine, sigma, ground: 0.2, contrast: 0.6 }
}

#[test]
fn the_window_follows_and_forgets_its_start() {
    let picture = corner([20.2, 19.7], 0.4, 0.7);
    let image = picture.image(41);
    let truth = PixelPoint::new(20.2, 19.7);
    // The corner itself is missed by the bias of Eq. 5 on a blurred corner of one area, 0.17 px with this window and 0.21 px with these weights.
    for spec in ["forstner:iterations=20", "forstner:iterations=50,gauss=2"] {
        let found = [(0.0, 0.0), (3.0, 2.0), (-2.0, 1.0)]
            .map(|(dx, dy)| operator(spec).measure(&image, &Start::at(PixelPoint::new(truth.x + dx, truth.y + dy))).unwrap().position);
        assert!(found.iter().all(|p| p.distance(found[0]) < 5e-3 && p.distance(truth) < 0.25), "{spec}: {found:?}");
    }
    assert_eq!(
        operator("forstner:iterations=2,gauss=2").measure(&image, &Start::at(PixelPoint::new(23.0, 22.0))),
        Err(Rejection::NotConverged)
    );
}

/// Predicted over empirical standard deviation.
fn predicted_over_empirical(spec: &str, sigma: f64) -> f64 {
    let (operator, picture, mut noise) = (operator(spec), corner([20.2, 19.7], 0.4, 0.7), Noise(1987));
    let image = picture.image(41);
    let start = Start::at(PixelPoint::new(20.0, 20.0));
    let found: Vec<Measurement> = (0..2000).map(|_| operator.measure(&noise.on(&image, sigma), &start).unwrap()).collect();
    let n = found.len() as f64;
    let (mx, my) = (found.iter().map(|m| m.position.x).sum::<f64>() / n, found.iter().map(|m| m.position.y).sum::<f64>() / n);
    let empirical = found.iter().map(|m| (m.position.x - mx).powi(2) + (m.position.y - my).powi(2)).sum::<f64>() / n;
    let predicted = found.iter().map(|m| m.covariance.unwrap()).map(|c| c.sxx + c.syy).sum::<f64>() / n;
    (predicted / empirical).sqrt()
}

#[test]
fn noise_carried_through_is_the_scatter_that_noise_causes() {
    for sigma in [0.005, 0.01, 0.03] {
        let known = predicted_over_empirical(&format!("forstner:covariance=1,noise={sigma}"), sigma);
        let estimated = predicted_over_empirical("forstner:covariance=1", sigma);
        let weighted = predicted_over_empirical(&format!("forstner:covariance=1,noise={sigma},gauss=3"), sigma);
        let scatter = predicted_over_empirical("forstner", sigma);
        eprintln!("noise {sigma}: known {known:.3}, estimated {estimated:.3}, weighted {weighted:.3}, scatter {scatter:.3}");
        assert!((known - 1.0).abs() < 0.15 && (weighted - 1.0).abs() < 0.15, "{sigma}: {known} {weighted}");
        assert!(estimated > 0.8 && estimated < 2.0 && scatter > known, "{sigma}: {estimated} {scatter}");
    }
}

#[test]
fn error_ellipses_too_flat_or_too_large_are_rejected() {
    let image = corner([20.2, 19.7], 0.4, 0.7).image(41);
    let start = Start::at(PixelPoint::new(20.0, 20.0));
    let found = operator("forstner").measure(&image, &start).unwrap();
    let axis = longest(&found.covariance.unwrap());
    assert_eq!(operator(&format!("forstner:size={}", axis * 0.99)).measure(&image, &start), Err(Rejection::ErrorEllipse));
    assert_eq!(operator(&format!("forstner:size={}", axis * 1.01)).measure(&image, &start), Ok(found));
    // A right angle in the middle of the window is round.
    assert!(operator("forstner:roundness=0.9").measure(&image, &start).is_ok());
    let steep = Picture { affine: Affine { axx: 60.0, axy: 50.0, ayx: 0.0, ayy: 15.0 }, ..corner([20.2, 19.7], 0.0, 0.7) };
    assert_eq!(operator("forstner:roundness=0.9").measure(&steep.image(41), &start), Err(Rejection::ErrorEllipse));
}
