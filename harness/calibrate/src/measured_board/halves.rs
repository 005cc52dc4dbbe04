//! What halves of the photographs repeat of the deviations of a board.

use calibench_adjust::{Network, Options, adjust};
use nalgebra::{Point3, Vector3};

use super::Moved;
use super::printer::{Printer, Sums};
use crate::choice::HALF;
use crate::ended::ITERATIONS;
use crate::{Board, part_of};

/// By which bits of an image's place it goes into one half or the other: a split each.
const SPLITS: [usize; 4] = [1, 2, 3, 5];
/// Images of a half that must show a corner.
const LEAST: usize = 2;

/// What two halves have in common.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Part {
    /// Correlation of the deviations of one half with those of the other, -1 to 1: the share of their variance that is common.
    pub correlation: f64,
    /// Root mean square of what is common, object units: deviations without what photographs add by chance.
    pub common: f64,
    /// The share of the variance of the deviations of all photographs that is common, 0 to 1.
    ///
    /// Source: Spearman 1910; Brown 1910.
    pub of_whole: f64,
}

/// What halves of the photographs, adjusted alone, say of the corners.
#[derive(Clone, Debug, PartialEq)]
pub struct Repeats {
    /// How many splits into halves could be adjusted.
    pub splits: usize,
    /// In the plane of the board.
    pub in_plane: Part,
    /// Along its normal.
    pub across: Part,
    /// How many times as far halves are apart as the standard deviations say, a number.
    pub sigmas: f64,
    /// The part of whole rows and columns in what is common in the plane; `None` of a board that is no raster.
    pub printer: Option<Printer>,
}

/// Adjusts halves of the images of `network` alone, whose points start at their nominal places; `sigma` are the standard deviations from all images.
///
/// # Errors
/// In words: too few images, or halves that do not determine the board.
pub(crate) fn repeats(
    network: &Network,
    options: &Options,
    (board, nominal): (&Board, &[Point3<f64>]),
    sigma: Moved,
) -> Result<Repeats, String> {
    if network.images.len() < 2 * HALF {
        return Err(format!("{} photographs, and halves are of {HALF} at least", network.images.len()));
    }
    let (mut sums, mut of_printer, mut apart, mut count, mut splits, mut why) = ([[0.0; 3]; 3], Some(Sums::default()), 0.0, 0, 0, None);
    for mask in SPLITS {
        let side = |image: &usize| (image & mask).count_ones() % 2;
        let both = [0, 1].map(|half| deviations(network, options, (board, nominal), |image| side(&image) == half));
        let [first, second] = match both {
            [Ok(first), Ok(second)] => [first, second],
            [Err(error), _] | [_, Err(error)] => {
                why = Some(error);
                continue;
            }
        };
        splits += 1;
        for (a, b) in first.iter().zip(&second).filter_map(|(a, b)| Some(((*a)?, (*b)?))) {
            for k in 0..3 {
                sums[k][0] += a[k] * b[k];
                sums[k][1] += a[k] * a[k];
                sums[k][2] += b[k] * b[k];
            }
            apart += (a - b).norm_squared();
            count += 1;
        }
        of_printer = of_printer.and_then(|sums| sums.add(nominal, &first, &second));
    }
    if count == 0 {
        return Err(why.unwrap_or_else(|| "halves have no corner in common".into()));
    }
    let n = f64::from(count);
    let of = |axes: &[usize]| {
        let [common, first, second] = [0, 1, 2].map(|which| axes.iter().map(|&axis| sums[axis][which]).sum::<f64>());
        let correlation = if first * second > 0.0 { common / (first * second).sqrt() } else { 0.0 };
        let known = correlation.max(0.0);
        Part { correlation, common: (common.max(0.0) / n).sqrt(), of_whole: 2.0 * known / (1.0 + known) }
    };
    // Each half knows its corners sqrt 2 times as badly as all images do, and both are wrong.
    let expected = 4.0 * (sigma.in_plane.powi(2) + sigma.across.powi(2));
    Ok(Repeats {
        splits,
        in_plane: of(&[0, 1]),
        across: of(&[2]),
        sigmas: if expected > 0.0 { (apart / n / expected).sqrt() } else { 1.0 },
        printer: of_printer.and_then(Sums::printer),
    })
}

/// Deviations along the axes of the board, of corners that enough of some images show.
fn deviations(
    network: &Network,
    options: &Options,
    (board, nominal): (&Board, &[Point3<f64>]),
    takes: impl Fn(usize) -> bool,
) -> Result<Vec<Option<Vector3<f64>>>, String> {
    let (part, points) = part_of(network, &options.left_out, takes, LEAST);
    if part.images.len() < HALF {
        return Err(format!("a half of {} photographs", part.images.len()));
    }
    let of_part = Options { left_out: Vec::new(), most_iterations: ITERATIONS, ..options.clone() };
    let solution = adjust(&part, &of_part).map_err(|error| format!("half of the photographs: {error}"))?;
    let mut found = vec![None; nominal.len()];
    for (&point, at) in points.iter().zip(solution.points()) {
        let moved = at - nominal[point];
        found[point] = Some(Vector3::from(board.axes.map(|axis| moved.dot(&axis))));
    }
    Ok(found)
}
