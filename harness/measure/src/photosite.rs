//! The area of a photosite, over which light is averaged.

/// The area of a photosite as wide as the pixel as a mixture of Gaussians: `offsets` along each axis with `weights`, each of this `variance`, px^2. A narrower
/// one is the same on a smaller scale.
///
/// Up to which order the mixture's cumulants are the unit square's grows with the Gaussians of an axis. Of the contrast, an edge blurred by a Gaussian of
/// standard deviation s is off by 8e-6 with two at s = 0.71, 7e-6 with three at 0.4, 4e-6 with four at 0.3 and 5e-3 at 0.1, all px;
/// without any blur the grey values are 4e-2 off, but the model does not become singular.
pub(crate) struct Square {
    offsets: &'static [f64],
    weights: &'static [f64],
    pub(crate) variance: f64,
}

/// One Gaussian of the square's variance: quick, and near enough to begin with.
const ONE: Square = Square { offsets: &[0.0], weights: &[1.0], variance: 1.0 / 12.0 };
const TWO: Square =
    Square { offsets: &[-0.254_066_374_077_307_4, 0.254_066_374_077_307_4], weights: &[0.5, 0.5], variance: 0.018_783_610_896_543_05 };
const THREE: Square = Square {
    offsets: &[-0.345_831_998_689_224, 0.0, 0.345_831_998_689_224],
    weights: &[0.318_902_974_746_591_3, 0.362_194_050_506_817_4, 0.318_902_974_746_591_3],
    variance: 0.007_051_887_868_281_641,
};
const FOUR: Square = Square {
    offsets: &[-0.393_654_415_751_417_5, -0.142_049_084_498_668_68, 0.142_049_084_498_668_68, 0.393_654_415_751_417_5],
    weights: &[0.222_131_926_791_124_26, 0.277_868_073_208_875_7, 0.277_868_073_208_875_7, 0.222_131_926_791_124_26],
    variance: 0.003_274_906_849_960_283_4,
};

impl Square {
    /// As many Gaussians as the blur, of this variance in units of the square's side, needs.
    pub(crate) fn for_blur(variance: f64, fidelity: Fidelity) -> &'static Self {
        match variance {
            _ if fidelity == Fidelity::Rough => &ONE,
            v if v > 0.5 => &TWO,
            v if v > 0.16 => &THREE,
            _ => &FOUR,
        }
    }

    /// Offsets along x and y in units of the square's side, and weight, of every Gaussian.
    pub(crate) fn nodes(&self) -> impl Iterator<Item = [f64; 3]> {
        let axis = || self.offsets.iter().zip(self.weights);
        axis().flat_map(move |(y, wy)| axis().map(move |(x, wx)| [*x, *y, wx * wy]))
    }

    /// The square as a straight edge with this unit normal sees it: along the normal, in units of the square's side.
    ///
    /// As many Gaussians along the normal as there are along an axis, if these are two or three, have the same cumulants, up to the same order, as all of them together;
    /// the cumulant of order k of a unit square along (x, y) is that of its side times `x^k + y^k`, and those of orders 2, 4 and 6 are 1/12, -1/120 and 1/252. Oblique
    /// edges are off by 1.1e-5 of the contrast at a blur of 0.71 px and by 1.3e-5 at 0.41 px.
    pub(crate) fn across(&self, [x, y]: [f64; 2]) -> Across {
        let [fourth, sixth] = [-(x.powi(4) + y.powi(4)) / 120.0, (x.powi(6) + y.powi(6)) / 252.0];
        let mut across = Across { nodes: [(0.0, 0.0); 16], count: self.offsets.len(), variance: self.variance };
        match self.offsets.len() {
            2 => {
                let between = (-0.5 * fourth).sqrt();
                across.variance = 1.0 / 12.0 - between;
                across.set([(-between.sqrt(), 0.5), (between.sqrt(), 0.5)]);
            }
            3 => {
                let between = between_three(fourth, sixth);
                across.variance = 1.0 / 12.0 - between;
                let square = fourth / between + 3.0 * between;
                let (offset, weight) = (square.sqrt(), 0.5 * between / square);
                across.set([(-offset, weight), (0.0, 1.0 - 2.0 * weight), (offset, weight)]);
            }
            _ => {
                across.count = 0;
                for [u, v, weight] in self.nodes() {
                    across.nodes[across.count] = (x * u + y * v, weight);
                    across.count += 1;
                }
            }
        }
        across
    }

    /// Distance from an edge from which on it is not seen, px: the outermost Gaussian, and five standard deviations (6e-7 of half the contrast), of a square of
    /// side `width` and Gaussians of standard deviation `blur`.
    pub(crate) fn reach(&self, width: f64, blur: f64) -> f64 {
        let outermost = self.offsets.iter().fold(0.0, |most: f64, x| most.max(x * width));
        std::f64::consts::SQRT_2 * outermost + 5.0 * blur
    }
}

/// What an edge sees of the square: Gaussians of one variance, in units of the square's side.
pub(crate) struct Across {
    /// Offset and weight.
    nodes: [(f64, f64); 16],
    count: usize,
    pub(crate) variance: f64,
}

impl Across {
    fn set<const N: usize>(&mut self, nodes: [(f64, f64); N]) {
        self.nodes[..N].copy_from_slice(&nodes);
    }

    /// Offset and weight of each.
    pub(crate) fn nodes(&self) -> &[(f64, f64)] {
        &self.nodes[..self.count]
    }
}

/// The variance of the offsets of three Gaussians, one of them in the middle, of which the mixture has these cumulants of orders 4 and 6. With m that variance
/// and q the square of the outer offsets they are `m (q - 3 m)` and `m (q^2 - 15 q m + 30 m^2)`. From the whole variance on Newton's steps lead down to it.
fn between_three(fourth: f64, sixth: f64) -> f64 {
    let mut m: f64 = 1.0 / 12.0;
    for _ in 0..6 {
        let value = fourth * fourth - 9.0 * fourth * m * m - 6.0 * m.powi(4) - sixth * m;
        let slope = -18.0 * fourth * m - 24.0 * m.powi(3) - sixth;
        m -= value / slope;
    }
    m
}

/// How well the photosite's area is integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fidelity {
    /// Within a hundredth of the contrast.
    Rough,
    /// As far as anything can be seen of it.
    Full,
}

#[cfg(test)]
mod tests {
    use calibench_model::quadrature::gauss_legendre;
    use statrs::function::erf::erf;

    use super::*;

    /// A blurred step, averaged over the square by quadrature.
    fn averaged([nx, ny]: [f64; 2], blur: f64, distance: f64) -> f64 {
        let rule = gauss_legendre(12);
        let step = |x: f64, y: f64| erf((distance + nx * (x - 0.5) + ny * (y - 0.5)) / blur * std::f64::consts::FRAC_1_SQRT_2);
        rule.iter().map(|(x, u)| rule.iter().map(|(y, v)| u * v * step(*x, *y)).sum::<f64>()).sum()
    }

    #[test]
    fn along_its_normal_an_edge_sees_the_square() {
        // In units of half the contrast.
        for (blur, bound) in [(0.71, 2.5e-5), (0.41, 3e-5), (0.3, 1e-5), (1.5, 1e-6)] {
            let square = Square::for_blur(blur * blur, Fidelity::Full);
            for turn in (0..24).map(|i| f64::from(i) * 0.3) {
                let normal = [turn.cos(), turn.sin()];
                let across = square.across(normal);
                let sigma = (blur * blur + across.variance).sqrt();
                for distance in (-60..60).map(|i| f64::from(i) * 0.05) {
                    let step = |(offset, weight): &(f64, f64)| weight * erf((distance + offset) / sigma * std::f64::consts::FRAC_1_SQRT_2);
                    let off = across.nodes().iter().map(step).sum::<f64>() - averaged(normal, blur, distance);
                    assert!(off.abs() < bound, "{blur} px, {turn} rad, {distance} px: {off:.1e}");
                }
            }
        }
    }
}
