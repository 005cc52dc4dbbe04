//! How a chess corner is turned, to begin with: from the image alone.

use calibench_model::Image;
use nalgebra::Complex;

/// The start: position (px, in the image), directions of the normals (rad), mean of the two grey values and half their difference.
pub(super) struct Guess {
    pub(super) position: [f64; 2],
    pub(super) normals: [f64; 2],
    pub(super) mean: f64,
    pub(super) half: f64,
}

/// Whether the grey values of the window of half-width `half` px around `position` correlate with those opposite it. Around a crossing of edges they do, by 1
/// less the noise; beside a straight edge by -1, around the corner of one area of 90 degrees by -1/3. The window is in the image.
pub(super) fn is_like_its_opposite(image: &Image, position: [f64; 2], half: i64) -> bool {
    let [x, y] = position.map(|p| p.round() as i64);
    let [twice_x, twice_y] = position.map(|p| (2.0 * p).round() as i64);
    // Columns and rows whose opposites are in the window as well.
    let both = |middle: i64, twice: i64| (middle - half).max(twice - middle - half)..=(middle + half).min(twice - middle + half);
    let (mut count, mut sum, mut products, mut squares) = (0.0, 0.0, 0.0, 0.0);
    let zero = f64::from(image.row(y as usize)[x as usize]);
    for row in both(y, twice_y) {
        let (here, there) = (image.row(row as usize), image.row((twice_y - row) as usize));
        for column in both(x, twice_x) {
            let a = f64::from(here[column as usize]) - zero;
            let b = f64::from(there[(twice_x - column) as usize]) - zero;
            count += 1.0;
            sum += a;
            squares += a * a;
            products += a * b;
        }
    }
    let square = sum * sum / count;
    // Of constant grey values nothing can be said.
    products - square > 0.0 || squares <= square
}

/// The two edges and grey values seen around `position`, in the disc of `half` px around it.
///
/// Around a chess corner the grey value jumps four times: of its Fourier coefficients by direction the second is `(2/pi) sin b` and the fourth `(1/pi) sin 2b`
/// in units of half the contrast, with b the width of a light sector, and their phases are two and four times the direction of its middle.
/// `None` when all grey values are the same to rounding.
pub(super) fn directions(image: &Image, position: [f64; 2], half: i64) -> Option<Guess> {
    let centre = position.map(|p| p.round() as i64);
    let (mut weights, mut mean) = (0.0, 0.0);
    let (mut waves, mut lattice) = ([Complex::new(0.0, 0.0); 2], [Complex::new(0.0, 0.0); 2]);
    for (row, grey) in image.rows_around(centre[0], centre[1], half)?.enumerate() {
        for (column, grey) in grey.iter().enumerate() {
            let at = [column, row].map(|index| index as i64 - half);
            let z = Complex::new((centre[0] + at[0]) as f64 - position[0], (centre[1] + at[1]) as f64 - position[1]);
            let r2 = z.norm_sqr() / (half * half) as f64;
            if r2 <= 1.0 {
                // Next to the corner blur hides the edges, and a disc without a sharp rim hides the lattice.
                let weight = r2 * (1.0 - r2);
                let double = if r2 > 0.0 { z.conj() * z.conj() / z.norm_sqr() } else { z };
                let terms = [double, double * double];
                for k in 0..2 {
                    waves[k] += terms[k] * (weight * f64::from(*grey));
                    lattice[k] += terms[k] * weight;
                }
                weights += weight;
                mean += weight * f64::from(*grey);
            }
        }
    }
    mean /= weights;
    let [second, fourth] = [0, 1].map(|k| (waves[k] - lattice[k] * mean) / weights);
    let size = second.norm();
    let middle = -0.5 * second.arg();
    let cosine = ((fourth * Complex::from_polar(1.0, 4.0 * middle)).re / size).clamp(-0.8, 0.8);
    let width = cosine.acos();
    let quarter = std::f64::consts::FRAC_PI_2;
    let normals = [middle + 0.5 * width - quarter, middle - 0.5 * width + quarter];
    let contrast = size * quarter / width.sin();
    // The light sectors cover width / 90 degrees of the mean.
    let mean = mean - contrast * (width / quarter - 1.0);
    // Grey values have 24 bits.
    (contrast.is_finite() && contrast > 1e-6 * mean.abs()).then_some(Guess { position, normals, mean, half: contrast })
}
