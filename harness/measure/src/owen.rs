//! The mass of a Gaussian beside a ray, for numbers side by side.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use calibench_model::quadrature::gauss_legendre;

use crate::blurred_step::exp_minus;
use crate::lanes::Real;

/// Nodes: with a slope of at most 1 the integral is off by 8e-7.
const NODES: usize = 4;

static RULE: LazyLock<[(f64, f64); NODES]> = LazyLock::new(|| {
    let rule = gauss_legendre(NODES);
    std::array::from_fn(|i| rule[i])
});

/// The nodes of Owen's integral, in one precision.
#[derive(Clone, Copy)]
pub(crate) struct Owen<T> {
    /// Squares of the nodes, and weights over a whole turn.
    nodes: [(T, T); NODES],
}

impl<T: Real> Owen<T> {
    pub(crate) fn new() -> Self {
        Self { nodes: RULE.map(|(node, weight)| (T::of(node * node), T::of(weight / TAU))) }
    }

    /// The mass of the unit normal distribution between a ray and the continuation, beyond the ray's origin, of the line from the distribution's centre to that
    /// origin: `across` is the centre's distance from the ray's line, `along` how far along the ray it lies (negative: behind the origin), `edge_across` and
    /// `edge_along` are `2 Phi - 1` of the two.
    ///
    /// It is `Phi(-|a|) / 2 + T(|a|, b / |a|)`, with Owen's T (1956) by its symmetry always of a slope of at most 1.
    #[inline(always)]
    pub(crate) fn beside_ray<const N: usize>(&self, across: &[T; N], along: &[T; N], edge_across: &[T; N], edge_along: &[T; N]) -> [T; N] {
        let (one, half, quarter) = (T::of(1.0), T::of(0.5), T::of(0.25));
        let zero = [T::of(0.0); N];
        let (mut square, mut slope, mut steep) = (zero, zero, zero);
        for i in 0..N {
            let (a, b) = (across[i].magnitude(), along[i].magnitude());
            let (low, high) = if a < b { (a, b) } else { (b, a) };
            let high = if high > T::of(1e-12) { high } else { T::of(1e-12) };
            square[i] = half * high * high;
            slope[i] = low / high;
            steep[i] = slope[i] * slope[i];
        }
        let mut integral = zero;
        for (node, weight) in &self.nodes {
            let (mut exponent, mut share) = (zero, zero);
            for i in 0..N {
                let grown = one + steep[i] * *node;
                exponent[i] = square[i] * grown;
                share[i] = *weight / grown;
            }
            let bell = exp_minus(&exponent);
            for i in 0..N {
                integral[i] += bell[i] * share[i];
            }
        }
        let mut mass = zero;
        for i in 0..N {
            let gentle = integral[i] * slope[i];
            let both = (edge_across[i] * edge_along[i]).magnitude();
            let owen = if along[i].magnitude() > across[i].magnitude() { quarter * (one - both) - gentle } else { gentle };
            mass[i] = quarter * (one - edge_across[i].magnitude()) + owen.signed_as(along[i]);
        }
        mass
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blurred_step::step;
    use crate::lanes::LANES;

    /// By the area: rays through all directions between, each of which has `exp(-h^2 / 2)` beyond its distance.
    fn by_directions(across: f64, along: f64) -> f64 {
        // In the ray's frame the origin is (0, 0), the ray points along x, the centre is at (along, across).
        let outward = (-across).atan2(-along);
        let turn = -outward;
        let rule = gauss_legendre(40);
        let radial = |direction: f64| {
            // Mass density along a direction from the origin: integral of r exp(-|r e - c|^2 / 2) / 2 pi.
            let c = along * direction.cos() + across * direction.sin();
            let rest = along * along + across * across - c * c;
            let tail = 0.5 * libm::erfc(-c * std::f64::consts::FRAC_1_SQRT_2);
            ((-0.5 * c * c).exp() + (TAU).sqrt() * c * tail) * (-0.5 * rest).exp() / TAU
        };
        rule.iter().map(|(node, weight)| weight * turn.abs() * radial(outward + turn * node)).sum()
    }

    #[test]
    fn it_is_the_mass_between_two_rays() {
        let owen = Owen::<f64>::new();
        for across in [-4.0, -1.3, -0.2, 0.4, 0.9, 2.2] {
            for along in [-3.0, -0.9, -0.1, 0.3, 1.1, 2.0, 5.0] {
                let ([a, b], expected) = ([across, along].map(|v: f64| [v; LANES]), by_directions(across, along));
                let found = owen.beside_ray(&a, &b, &step(&a).0, &step(&b).0)[0];
                assert!((found - expected).abs() < 1e-6, "{across} {along}: {found} {expected}");
            }
        }
    }
}
