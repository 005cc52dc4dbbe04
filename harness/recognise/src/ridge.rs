//! Points on narrow dark lines.

use calibench_model::{Image, stop};

use crate::error::NotRecognised;
use crate::smooth::smooth;

/// The Gaussian that the second derivatives are taken under, px: lines are about a pixel wide.
const SIGMA: f64 = 0.9;
/// Curvature, in its own standard deviations of noise, that counts.
const ABOVE_NOISE: f32 = 2.0;
/// Curvature that counts, as a share of that of the sharpest fiftieth of the image, which is lines and edges.
const OF_SHARPEST: f32 = 0.2;
/// The largest thousandth of the curvature of an image that shows nothing, in standard deviations of its noise: of a normal distribution 3.1.
const BLANK: f32 = 4.0;
/// How far, px, the middle of a line may be from the pixel that it is found at.
const OFFSET: f32 = 0.6;
/// Points at most: the strongest.
const MOST: usize = 30_000;
/// The noise is taken from this quantile of the absolute values of a difference that sees no structure on paper, and what it is of a standard deviation.
const QUIET: f64 = 0.3;
const OF_SIGMA: f32 = 0.3853;

/// A point on a dark line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ridge {
    /// px.
    pub at: [f64; 2],
    /// Across the line, of length 1.
    pub normal: [f64; 2],
    /// The second derivative across, by which strength is counted, at most that of the sharpest.
    pub weight: f64,
}

/// The points of lines: curvature above a threshold that follows noise and sharpness, its middle within the pixel, no curvature along.
///
/// The middle is where the Taylor polynomial of second order across the line is stationary: at the edge of a target, where the Laplacian is as large as on a
/// line, it is farther away.
///
/// # Errors
/// [`NotRecognised::Blank`] when no curvature stands out of the noise.
///
/// Source: Laplace operator and threshold: Vosselman & Förstner 1988, section 3.1; middle of the line: Steger 1998.
pub(crate) fn ridges(image: &Image) -> Result<Vec<Ridge>, NotRecognised> {
    let smoothed = smooth(image, SIGMA);
    let laplace = laplacian(&smoothed);
    let threshold = threshold(&laplace, noise(image))?;
    let (width, height) = (smoothed.width(), smoothed.height());
    let mut points = Vec::new();
    for y in 1..height - 1 {
        stop::point();
        for x in 1..width - 1 {
            if laplace[y * width + x] > threshold.least {
                points.extend(ridge(&smoothed, x, y, &threshold));
            }
        }
    }
    if points.len() > MOST {
        points.sort_by(|a, b| b.weight.total_cmp(&a.weight));
        points.truncate(MOST);
    }
    Ok(points)
}

/// Bounds of the curvature.
struct Threshold {
    least: f32,
    sharpest: f32,
}

fn threshold(laplace: &[f32], noise: f32) -> Result<Threshold, NotRecognised> {
    // Of the Laplacian under a Gaussian of white noise of standard deviation 1.
    let noise = noise / ((2.0 * std::f64::consts::PI).sqrt() * SIGMA.powi(3)) as f32;
    let mut sorted = laplace.to_vec();
    let (most, sharpest) = (quantile(&mut sorted, 0.999), quantile(&mut sorted, 0.98));
    if most < BLANK * noise || most < 1e-4 {
        return Err(NotRecognised::Blank);
    }
    Ok(Threshold { least: (ABOVE_NOISE * noise).max(OF_SHARPEST * sharpest), sharpest: sharpest.max(noise) })
}

fn quantile(values: &mut [f32], share: f64) -> f32 {
    let index = ((values.len() - 1) as f64 * share) as usize;
    *values.select_nth_unstable_by(index, f32::total_cmp).1
}

/// The standard deviation of white noise, fraction of full scale, from a second difference along both axes.
///
/// Source: the mask is that of Immerkær 1996.
fn noise(image: &Image) -> f32 {
    let (width, height) = (image.width(), image.height());
    let mut differences = Vec::with_capacity((width - 2) * (height - 2));
    for y in 1..height - 1 {
        let (above, here, below) = (image.row(y - 1), image.row(y), image.row(y + 1));
        let across = |row: &[f32], x: usize| row[x - 1] - 2.0 * row[x] + row[x + 1];
        differences.extend((1..width - 1).map(|x| (across(above, x) - 2.0 * across(here, x) + across(below, x)).abs() / 6.0));
    }
    quantile(&mut differences, QUIET) / OF_SIGMA
}

/// Of the inner pixels; zero at the border.
fn laplacian(image: &Image) -> Vec<f32> {
    let (width, height) = (image.width(), image.height());
    let mut out = vec![0.0; width * height];
    for y in 1..height - 1 {
        let (above, here, below) = (image.row(y - 1), image.row(y), image.row(y + 1));
        for x in 1..width - 1 {
            out[y * width + x] = above[x] + below[x] + here[x - 1] + here[x + 1] - 4.0 * here[x];
        }
    }
    out
}

fn ridge(image: &Image, x: usize, y: usize, threshold: &Threshold) -> Option<Ridge> {
    let at = |dx: usize, dy: usize| image.at(x + dx - 1, y + dy - 1);
    let here = at(1, 1);
    let (gx, gy) = (0.5 * (at(2, 1) - at(0, 1)), 0.5 * (at(1, 2) - at(1, 0)));
    let (xx, yy) = (at(2, 1) + at(0, 1) - 2.0 * here, at(1, 2) + at(1, 0) - 2.0 * here);
    let xy = 0.25 * (at(2, 2) + at(0, 0) - at(2, 0) - at(0, 2));
    let half = 0.5 * (xx - yy);
    let root = half.hypot(xy);
    let (across, along) = (0.5 * (xx + yy) + root, 0.5 * (xx + yy) - root);
    if across < threshold.least || along.abs() > 0.5 * across {
        return None;
    }
    // The eigenvector of the larger eigenvalue.
    let [nx, ny] = if half > 0.0 { [half + root, xy] } else { [xy, root - half] };
    let length = nx.hypot(ny);
    let [nx, ny] = [nx / length, ny / length];
    let t = -(gx * nx + gy * ny) / across;
    let [dx, dy] = [t * nx, t * ny];
    let inside = dx.abs() <= OFFSET && dy.abs() <= OFFSET;
    inside.then(|| Ridge {
        at: [x as f64 + f64::from(dx), y as f64 + f64::from(dy)],
        normal: [f64::from(nx), f64::from(ny)],
        weight: f64::from((across / threshold.sharpest).min(1.0)),
    })
}
