//! How blurred the lines of the grid are.

use calibench_model::{Image, upper_median};

use crate::grid::Grid;
use crate::normal::cubic;

/// Places across a line, from its middle in steps of [`STEP`], to either side.
const PLACES: usize = 9;
const STEP: f64 = 0.5;
/// A profile is taken every so many points of lines.
const EVERY: usize = 4;
/// Blurs that are compared: from the first in steps of a tenth, px.
const LEAST: f64 = 0.4;
const BLURS: usize = 26;

/// The standard deviation of the Gaussian, px, under which lines as wide as the design's (`line` squares) have the profile that the grid's lines have in the
/// median; `contrast` is from paper to ink.
///
/// It holds all that blurs: optics, photosites, the interpolation of the normal image.
pub(crate) fn blur(image: &Image, grid: &Grid, line: f64, contrast: f64) -> f64 {
    let mapping = &grid.adjusted.mapping;
    let mut profiles: Vec<Vec<f32>> = vec![Vec::new(); 2 * PLACES - 1];
    let mut width = Vec::new();
    for on in grid.adjusted.on.iter().step_by(EVERY) {
        let (number, along) = (on.number as f64, on.along);
        let node = if on.family == 0 { [number, along] } else { [along, number] };
        let (Some([x, y]), Some(by)) = (mapping.image(node), mapping.by_grid(node)) else { continue };
        let run = by.column(1 - on.family).normalize();
        let normal = [-run.y, run.x];
        // What a square is wide across the line.
        let across = by.column(on.family);
        width.push((across.x * normal[0] + across.y * normal[1]).abs() * line);
        for (place, values) in profiles.iter_mut().enumerate() {
            let off = (place as f64 - (PLACES as f64 - 1.0)) * STEP;
            values.push(cubic(image, [x + off * normal[0], y + off * normal[1]]));
        }
    }
    let Some(width) = upper_median(width.iter().copied()) else { return LEAST };
    let middle = |values: &mut Vec<f32>| f64::from(*values.clone().select_nth_unstable_by(values.len() / 2, f32::total_cmp).1);
    let grey: Vec<f64> = profiles.iter_mut().map(middle).collect();
    let paper = grey.iter().copied().fold(f64::MIN, f64::max);
    let dark: Vec<f64> = grey.iter().map(|grey| (paper - grey) / contrast).collect();
    let misfit = |sigma: f64| -> f64 {
        let of = |(place, dark): (usize, &f64)| (dark - profile((place as f64 - (PLACES as f64 - 1.0)) * STEP, width, sigma)).powi(2);
        dark.iter().enumerate().map(of).sum()
    };
    let sigmas = (0..BLURS).map(|step| LEAST + 0.1 * step as f64);
    sigmas.min_by(|a, b| misfit(*a).total_cmp(&misfit(*b))).unwrap_or(LEAST)
}

/// The darkness at a place across a line of this width, px, under a Gaussian.
fn profile(off: f64, width: f64, sigma: f64) -> f64 {
    let edge = |at: f64| 0.5 * libm::erf(at / (std::f64::consts::SQRT_2 * sigma));
    edge(off + 0.5 * width) - edge(off - 0.5 * width)
}
