//! A point spread as a sum of separable parts.

use super::profile::Profile;
use super::spread::Spread;
use super::{Motion, Optics};
use calibench_model::quadrature::gauss_legendre;

/// One separable part: weight times (profile along x) times (profile along y), moved.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// Its share of the light.
    pub weight: f64,
    /// Where its centre lies, px.
    pub shift: [f64; 2],
    /// Its steps along a row.
    pub along: Spread,
    /// Its density down a column.
    pub down: Spread,
    /// What both are of: along a row and down a column.
    pub profiles: [Profile; 2],
}

/// The point spread of lens and photosite.
#[derive(Clone, Debug)]
pub(crate) enum Kernel {
    /// The photosite alone: a square of this width, px.
    Sharp(f64),
    /// With a Gaussian of standard deviation `sigma`, px.
    Smooth {
        /// px.
        sigma: f64,
        /// Its parts.
        parts: Vec<Part>,
    },
}

impl Kernel {
    /// The kernel of `optics` with a Gaussian blur of `sigma` px.
    pub fn new(optics: &Optics, sigma: f64) -> Self {
        if sigma == 0.0 {
            return Self::Sharp(optics.aperture);
        }
        let shifts = motion(optics.motion, sigma);
        let chords = disc(optics.defocus, sigma);
        let part = |&(share, [dx, dy]): &(f64, [f64; 2]), chord: &Chord, (weight, sigma): (f64, f64)| {
            let down = Profile { sigma, aperture: optics.aperture, chord: 0.0 };
            let along = Profile { chord: chord.width, ..down };
            let profiles = [along, down];
            let (along, down) = (Spread::steps(&along), Spread::density(&down));
            Part { weight: weight * share * chord.weight, shift: [dx, dy + chord.offset], along, down, profiles }
        };
        let tail = optics.tail.filter(|tail| tail.share > 0.0);
        let core = (1.0 - tail.map_or(0.0, |tail| tail.share), sigma);
        let gaussians: Vec<(f64, f64)> = std::iter::once(core).chain(tail.map(|tail| (tail.share, tail.blur.max(sigma)))).collect();
        let each = gaussians.iter().flat_map(|gaussian| shifts.iter().map(move |shift| (gaussian, shift)));
        let parts = each.flat_map(|(gaussian, shift)| chords.iter().map(move |chord| part(shift, chord, *gaussian))).collect();
        Self::Smooth { sigma, parts }
    }

    /// How far it reaches, px, along x and y.
    pub fn reach(&self) -> [f64; 2] {
        match self {
            Self::Sharp(aperture) => [aperture / 2.0 + 1.0; 2],
            Self::Smooth { parts, .. } => parts.iter().fold([0.0, 0.0], |reach: [f64; 2], part| {
                [reach[0].max(part.along.reach() + part.shift[0].abs()), reach[1].max(part.down.reach() + part.shift[1].abs())]
            }),
        }
    }
}

/// A chord of the defocus disc: its distance from the centre, its width and its share of the disc.
struct Chord {
    offset: f64,
    width: f64,
    weight: f64,
}

/// The disc as chords, by Gauss and Chebyshev's quadrature of the second kind: what a chord gives is a smooth function of its offset,
/// because a box's profile depends on the square of its width alone.
fn disc(radius: f64, sigma: f64) -> Vec<Chord> {
    if radius == 0.0 {
        return vec![Chord { offset: 0.0, width: 0.0, weight: 1.0 }];
    }
    let n = nodes(2.0 * radius, sigma) + 3;
    let chord = |i: usize| {
        let angle = std::f64::consts::PI * (i + 1) as f64 / (n + 1) as f64;
        let sine = angle.sin();
        Chord { offset: radius * angle.cos(), width: 2.0 * radius * sine, weight: 2.0 / (n + 1) as f64 * sine * sine }
    };
    (0..n).map(chord).collect()
}

/// The shifts of a motion and their shares.
fn motion(motion: Option<Motion>, sigma: f64) -> Vec<(f64, [f64; 2])> {
    let Some(Motion { length, direction }) = motion.filter(|motion| motion.length > 0.0) else {
        return vec![(1.0, [0.0, 0.0])];
    };
    let (sine, cosine) = direction.sin_cos();
    let place = |(t, weight): (f64, f64)| (weight, [(t - 0.5) * length * cosine, (t - 0.5) * length * sine]);
    gauss_legendre(nodes(length, sigma)).into_iter().map(place).collect()
}

/// How many nodes integrate over `length` px what is smooth on the scale of `sigma` px.
pub(crate) fn nodes(length: f64, sigma: f64) -> usize {
    (1.4 * length / sigma).ceil() as usize + 3
}
