//! Harris's strength in many ways, the pixel that is detected, and the paraboloid's maximum.

use calibench_measure::paraboloid::Weights;

use crate::grid::{Grid, gaussian};

/// Detections are sought within this many px of the corner in both axes.
const SEEK: usize = 5;
/// A detection is the strongest pixel within this many px of itself; half the operator's window, too.
const RADIUS: usize = 3;
/// The widest integration Gaussian looks this far, px.
const REACH: usize = 8;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Derivative {
    Central,
    Prewitt,
    Sobel,
    /// (-2, -1, 0, 1, 2), as Schmid et al. 2000 give for Harris's own.
    Five,
    Gaussian(f64),
}

impl Derivative {
    pub const ALL: [Self; 8] = [
        Self::Central,
        Self::Prewitt,
        Self::Sobel,
        Self::Five,
        Self::Gaussian(0.5),
        Self::Gaussian(0.7),
        Self::Gaussian(1.0),
        Self::Gaussian(1.4),
    ];

    /// The derivative's kernel along its own axis and across it.
    fn kernels(self) -> (Vec<f64>, Vec<f64>) {
        let step = vec![-0.5, 0.0, 0.5];
        match self {
            Self::Central => (step, vec![1.0]),
            Self::Prewitt => (step, vec![1.0 / 3.0; 3]),
            Self::Sobel => (step, vec![0.25, 0.5, 0.25]),
            Self::Five => (vec![-0.2, -0.1, 0.0, 0.1, 0.2], vec![1.0]),
            Self::Gaussian(sigma) => {
                let smooth = gaussian(sigma);
                let radius = (smooth.len() / 2) as f64;
                let along = smooth.iter().enumerate().map(|(i, w)| w * (i as f64 - radius) / (sigma * sigma)).collect();
                (along, smooth)
            }
        }
    }
}

/// How products of gradients are added up around a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integration {
    /// Its deviation, px.
    Gaussian(f64),
    /// The same as far as one pixel on each side: windows of 3 x 3.
    Cut(f64),
    /// Its side, px.
    Box(usize),
}

impl Integration {
    pub const ALL: [Self; 10] = [
        Self::Gaussian(0.3),
        Self::Gaussian(0.5),
        Self::Gaussian(0.7),
        Self::Gaussian(1.0),
        Self::Gaussian(1.5),
        Self::Gaussian(2.0),
        Self::Cut(1.0),
        Self::Box(3),
        Self::Box(5),
        Self::Box(7),
    ];

    fn window(self) -> Vec<f64> {
        match self {
            Self::Gaussian(sigma) => gaussian(sigma),
            Self::Cut(sigma) => {
                let beside = (-0.5 / (sigma * sigma)).exp();
                [beside, 1.0, beside].map(|weight| weight / (1.0 + 2.0 * beside)).to_vec()
            }
            Self::Box(side) => vec![1.0 / side as f64; side],
        }
    }
}

/// Why a setting is discarded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Discarded {
    /// The operator rejects a point: no positive strength, or no maximum of the paraboloid within a pixel.
    Rejected,
    /// The strongest detection near a point is not the nearest.
    AnotherPoint,
}

/// The products of the gradients, as far around the corner as the widest integration needs.
pub struct Products([Grid; 3]);

impl Products {
    pub fn of(image: &Grid, derivative: Derivative) -> Self {
        let (along, across) = derivative.kernels();
        let side = strengths_side(image) + 2 * REACH;
        let (gx, gy) = (image.separable(&along, &across, side), image.separable(&across, &along, side));
        Self([gx.times(&gx), gx.times(&gy), gy.times(&gy)])
    }

    pub fn integrated(&self, integration: Integration) -> Moments {
        let window = integration.window();
        let side = self.0[0].side - 2 * REACH;
        Moments(self.0.each_ref().map(|grid| grid.separable(&window, &window, side)))
    }
}

/// Strengths are computed as far as a detection at the border of what is sought is compared.
fn strengths_side(image: &Grid) -> usize {
    2 * (SEEK + RADIUS) + if image.side % 2 == 1 { 1 } else { 2 }
}

/// The integrated products.
pub struct Moments([Grid; 3]);

impl Moments {
    /// The pixel that is detected, with the strengths det - alpha trace^2 around it.
    pub fn peak(&self, alpha: f64) -> Result<Peak, Discarded> {
        let [xx, xy, yy] = &self.0;
        let at = |i: usize| xx.values[i] * yy.values[i] - xy.values[i].powi(2) - alpha * (xx.values[i] + yy.values[i]).powi(2);
        peak(&Grid { side: xx.side, values: (0..xx.values.len()).map(at).collect() })
    }
}

/// The 3 x 3 strengths around the pixel that is detected, and its place from the corner.
#[derive(Clone, Copy)]
pub struct Peak([[f64; 3]; 3], f64, f64);

fn peak(strengths: &Grid) -> Result<Peak, Discarded> {
    let (side, middle) = (strengths.side, (strengths.side - 1) as f64 / 2.0);
    let at = |x: usize, y: usize| strengths.values[y * side + x];
    let far = |(x, y): (usize, usize)| (x as f64 - middle).hypot(y as f64 - middle);
    let is_detection = |(x, y): (usize, usize)| {
        let here = at(x, y);
        let around = (y - RADIUS..=y + RADIUS).flat_map(|v| (x - RADIUS..=x + RADIUS).map(move |u| (u, v)));
        here > 0.0 && around.into_iter().all(|(u, v)| if (v, u) < (y, x) { at(u, v) < here } else { at(u, v) <= here })
    };
    let pixels = (RADIUS..side - RADIUS).flat_map(|y| (RADIUS..side - RADIUS).map(move |x| (x, y)));
    let detections: Vec<(usize, usize)> = pixels.filter(|pixel| is_detection(*pixel)).collect();
    let nearest = detections.iter().min_by(|a, b| far(**a).total_cmp(&far(**b))).ok_or(Discarded::Rejected)?;
    let strongest = detections.iter().map(|(x, y)| at(*x, *y)).fold(0.0, f64::max);
    let (x, y) = *nearest;
    // Equal within rounding is a mirror image, not another point.
    if at(x, y) < strongest * (1.0 - 1e-9) {
        return Err(Discarded::AnotherPoint);
    }
    Ok(Peak([y - 1, y, y + 1].map(|y| [x - 1, x, x + 1].map(|x| at(x, y))), x as f64 - middle, y as f64 - middle))
}

impl Peak {
    /// How far the paraboloid's maximum is from the corner, px.
    pub fn distance(&self, weights: &Weights) -> Result<f64, Discarded> {
        let Self(strengths, x, y) = self;
        let maximum = weights.fit(strengths).maximum().filter(|(dx, dy)| dx.abs() <= 1.0 && dy.abs() <= 1.0);
        maximum.map(|(dx, dy)| (x + dx).hypot(y + dy)).ok_or(Discarded::Rejected)
    }
}
