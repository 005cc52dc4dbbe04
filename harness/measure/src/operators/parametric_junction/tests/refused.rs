//! What is no junction.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::efficiency::near;
use super::*;
use crate::tests::bound::noisy;
use crate::tests::no_corners::{WIDTH, accepted, texture};

/// Of 10,000 the upper 95 % limit of Clopper and Pearson is then 0.93 %.
const MOST_ACCEPTED: f64 = 0.0075;

fn refuses(spec: &str, windows: usize) {
    let counts = accepted(&*operator(spec), windows);
    // Of three or four arms so soft a texture is none in a window of 15 px.
    let held = if spec.ends_with('3') || spec.ends_with('4') { counts.len() - 1 } else { counts.len() };
    for (what, count) in &counts[..held] {
        assert!(*count as f64 <= MOST_ACCEPTED * windows as f64, "{spec}, {what}: {count} of {windows}");
    }
}

#[test]
fn bare_edges_noise_and_texture_are_refused() {
    refuses("window=15", 400);
}

/// A dark spot of 3 to 6 px: whatever is found there is not far from its rim.
#[test]
fn spots_are_no_far_tips_of_sectors() {
    let mut rng = ChaCha8Rng::seed_from_u64(72);
    let (mut far, mut accepted) = (0, 0);
    for _ in 0..200 {
        let (radius, softness) = (rng.random_range(1.5..3.0), rng.random_range(0.5..1.2));
        let [x0, y0] = [(); 2].map(|()| 20.0 + rng.random_range(-0.5..0.5));
        let dark = |i: usize| {
            let r = ((i % WIDTH) as f64 - x0).hypot((i / WIDTH) as f64 - y0);
            0.8 - 0.6 * 0.5 * libm::erfc((r - radius) / softness * std::f64::consts::FRAC_1_SQRT_2)
        };
        let image = quadrature_images::image(&noisy(&(0..WIDTH * WIDTH).map(dark).collect::<Vec<_>>(), 0.01, &mut rng), WIDTH);
        if let Ok(found) = operator("window=15").measure(&image, &near([20.0, 20.0], 2.0, &mut rng)) {
            accepted += 1;
            far += usize::from(found.position.distance(PixelPoint::new(x0, y0)) > radius + 1.0);
        }
    }
    println!("{accepted} of 200 spots accepted, {far} of them far off");
    assert!(accepted <= 5, "{accepted}, {far} of them far off");
}

/// On paper that is not even two edges are crossed as well, but only if that is asked for.
#[test]
fn a_larger_misfit_takes_what_is_uneven() {
    let mut rng = ChaCha8Rng::seed_from_u64(73);
    let junction = Junction { position: [20.2, 19.7], ..junction(&[80.0, 100.0, 80.0, 100.0], 0.4, 0.8, [0.0; 2]) };
    let uneven: Vec<f64> = junction.render(WIDTH).iter().zip(texture(1.5, &mut rng)).map(|(grey, uneven)| grey + 0.025 * uneven).collect();
    let image = quadrature_images::image(&uneven, WIDTH);
    let start = Start::at(PixelPoint::new(21.0, 19.0));
    assert_eq!(operator("window=15,arms=4").measure(&image, &start), Err(Rejection::Misfit));
    let found = operator("window=15,arms=4,misfit=0.4").measure(&image, &start).unwrap().position;
    assert!(found.distance(PixelPoint::new(20.2, 19.7)) < 0.2, "{found:?}");
}

#[test]
#[ignore = "takes minutes"]
fn of_ten_thousand_windows_fewer_than_one_percent_are_taken_for_junctions() {
    let windows = std::env::var("WINDOWS").map_or(10_000, |windows| windows.parse().unwrap());
    for arms in 0..=4 {
        if arms != 1 {
            refuses(&format!("window=15,arms={arms}"), windows);
        }
    }
}
