//! A hundred megapixels: as right in the last corner as in the first.

use super::*;

const WIDTH: usize = 12_288;
const HEIGHT: usize = 8192;

/// The far end of a long edge and a small disc beside the last pixel, spot-checked against closed forms.
#[test]
fn grey_values_far_from_the_origin_are_right() {
    let blur = 0.7;
    let optics = Optics { blur, ..Optics::default() };
    // Nearly upright, through the whole height: its inside is on the right.
    let angle = 0.01_f64;
    let (s, c) = angle.sin_cos();
    let (x, y) = (WIDTH as f64 - 60.37, HEIGHT as f64 - 40.81);
    let far = 30_000.0;
    let corner = |along: f64, inside: f64| (x - s * along + c * inside, y + c * along + s * inside);
    let spot = Spot { centre: (WIDTH as f64 - 90.7, HEIGHT as f64 - 20.2), radius: 7.3, sigma: blur };
    let mut pieces = polygon(&[corner(-far, 0.0), corner(far, 0.0), corner(far, far), corner(-far, far)]);
    pieces.extend(disc(spot.centre, spot.radius));
    let picture = Picture { width: WIDTH, height: HEIGHT, background: 0.2, pieces };
    let image = Renderer::new(&optics, WIDTH, HEIGHT).unwrap().render(&picture, &[]);
    let grey = |u: usize, v: usize| (f64::from(image.at(u, v)) - 0.2) / 0.7;
    let edge = |u: usize, v: usize| shapes::edge(((u as f64 - x) * c + (v as f64 - y) * s) / blur, c / blur, s / blur);
    let mut worst = 0.0_f64;
    // Along the edge, first to last row, a few pixels to each side.
    for v in (0..HEIGHT).step_by(13).chain([HEIGHT - 1]) {
        let crossing = x - (v as f64 - y) * s / c;
        for u in (crossing as usize - 5..crossing as usize + 6).filter(|u| *u < WIDTH) {
            if !near_disc(&spot, u, v) {
                worst = worst.max((grey(u, v) - edge(u, v)).abs());
            }
        }
    }
    for (u, v) in (0..20).flat_map(|j| (0..20).map(move |i| (i, j))).map(|(i, j)| (WIDTH - 101 + i, HEIGHT - 20 + j)) {
        let expected = pixel_mean(u as f64, v as f64, 1.0, 12, |u, v| spot.at(u, v)) + edge(u, v);
        worst = worst.max((grey(u, v) - expected).abs());
    }
    // Flat areas, in every strip above the disc.
    for v in (0..HEIGHT - 40).step_by(31) {
        let crossing = (x - (v as f64 - y) * s / c).min(WIDTH as f64);
        worst = worst.max(grey(0, v).abs()).max(grey(crossing as usize - 20, v).abs());
    }
    assert!(worst < 2e-5, "{worst:e}");
}

fn near_disc(spot: &Spot, u: usize, v: usize) -> bool {
    (u as f64 - spot.centre.0).hypot(v as f64 - spot.centre.1) < spot.radius + 8.0
}
