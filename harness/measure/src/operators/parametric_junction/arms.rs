//! The grey values of blurred sectors between arms that leave one point, averaged over a photosite, with their derivatives.

use crate::blurred_step::{DENSITY, step};
use crate::lanes::Real;
use crate::owen::Owen;
use crate::photosite::{Fidelity, Square};

/// Most arms, and sectors.
pub(super) const MOST: usize = 4;
/// Two arms are further apart than this, rad.
const NARROWEST: f64 = 0.09;

/// All unknowns but the grey values.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    /// Directions of the arms, rad, in the order in which they are met turning from x to y. Sector k lies between arm k and the next.
    pub(super) directions: [f64; MOST],
    /// How many arms there are.
    pub(super) arms: usize,
    /// Variance of the blur, px^2.
    pub(super) variance: f64,
    /// Side of the square that is sensitive to light in each pixel, px: not unknown.
    pub(super) photosite: f64,
}

/// One Gaussian of the photosite: offset from its centre (px) and weight.
#[derive(Clone, Copy)]
struct Node<T> {
    x: T,
    y: T,
    weight: T,
}

/// An arm: its direction's cosine and sine.
#[derive(Clone, Copy)]
pub(super) struct Arm<T> {
    pub(super) x: T,
    pub(super) y: T,
}

/// All that a chunk of pixels needs to know of a shape.
pub(super) struct Model<T> {
    arms: [Arm<T>; MOST],
    pub(super) count: usize,
    nodes: [Node<T>; 16],
    gaussians: usize,
    owen: Owen<T>,
    /// Variance of the blurred Gaussians of the photosite, px^2, and 1 / its root.
    variance: T,
    inverse: T,
    /// Distance from an arm, px, from which on it is not seen; and from the point where they meet.
    pub(super) reach: T,
}

/// Of `N` pixels how much of each sector is seen, and what arms do to that.
pub(super) struct Field<T, const N: usize> {
    /// Shares of the sectors: their sum is 1.
    pub(super) shares: [[T; N]; MOST],
    /// How much more of the sector after an arm, and less of that before it, is seen by moving the pixel across the arm, 1/px, ...
    pub(super) slopes: [[T; N]; MOST],
    /// ... and less by turning the arm, 1/rad.
    pub(super) turns: [[T; N]; MOST],
    /// Distance from an arm, px, positive in the sector after it.
    pub(super) across: [[T; N]; MOST],
}

/// Of `N` pixels, each of which sees one arm alone.
pub(super) struct OneArm<T, const N: usize> {
    /// How much of the sector after it is seen; the rest is of the one before.
    pub(super) after: [T; N],
    /// As in [`Field`].
    pub(super) slopes: [T; N],
    pub(super) turns: [T; N],
    pub(super) across: [T; N],
    /// The arm's direction.
    pub(super) cos: [T; N],
    pub(super) sin: [T; N],
}

impl<T: Real> Model<T> {
    /// `None` for arms that are not in order or nearly touch.
    pub(super) fn new(shape: &Shape, fidelity: Fidelity) -> Option<Self> {
        let directions = &shape.directions[..shape.arms];
        let turn = std::f64::consts::TAU;
        let gaps = (0..shape.arms).map(|k| if k + 1 < shape.arms { directions[k + 1] } else { directions[0] + turn } - directions[k]);
        let narrowest = gaps.fold(f64::INFINITY, |least, gap| if gap >= least { least } else { gap });
        if narrowest.is_nan() || narrowest < NARROWEST {
            return None;
        }
        let (width, area) = (shape.photosite, shape.photosite * shape.photosite);
        // The narrower a sector, the further an error of its grey values moves its point.
        let finer = (narrowest / std::f64::consts::FRAC_PI_2).min(1.0);
        let square = Square::for_blur(finer * shape.variance / area, fidelity);
        let zero = T::of(0.0);
        let (mut nodes, mut gaussians) = ([Node { x: zero, y: zero, weight: zero }; 16], 0);
        for [x, y, weight] in square.nodes() {
            nodes[gaussians] = Node { x: T::of(x * width), y: T::of(y * width), weight: T::of(weight) };
            gaussians += 1;
        }
        let mut arms = [Arm { x: zero, y: zero }; MOST];
        for (arm, direction) in arms.iter_mut().zip(directions) {
            let (sin, cos) = direction.sin_cos();
            *arm = Arm { x: T::of(cos), y: T::of(sin) };
        }
        let variance = shape.variance + square.variance * area;
        Some(Self {
            arms,
            count: shape.arms,
            nodes,
            gaussians,
            owen: Owen::new(),
            variance: T::of(variance),
            inverse: T::of(1.0 / variance.sqrt()),
            reach: T::of(square.reach(width, variance.sqrt())),
        })
    }

    /// The arms.
    #[inline(always)]
    pub(super) fn arms(&self) -> &[Arm<T>] {
        &self.arms[..self.count]
    }

    /// Variance of the blurred Gaussians of the photosite, px^2.
    #[inline(always)]
    pub(super) fn variance(&self) -> T {
        self.variance
    }

    /// How much of each sector is seen from pixels at (`x`, `y`) from the point where arms meet, px; `NEAR` if that point itself may be seen.
    #[inline(always)]
    pub(super) fn shares<const N: usize, const NEAR: bool>(&self, x: &[T; N], y: &[T; N]) -> [[T; N]; MOST] {
        self.shares_of::<N, NEAR>(self.count, x, y)
    }

    /// The same of so many arms: all that there are.
    #[inline(always)]
    pub(super) fn shares_of<const N: usize, const NEAR: bool>(&self, count: usize, x: &[T; N], y: &[T; N]) -> [[T; N]; MOST] {
        let mut sum = [[T::of(0.0); N]; MOST];
        for node in &self.nodes[..self.gaussians] {
            let moved = |place: &[T; N], by: T| {
                let mut moved = *place;
                moved.iter_mut().for_each(|place| *place += by);
                moved
            };
            let shares = self.field_of::<N, NEAR>(count, &moved(x, node.x), &moved(y, node.y)).shares;
            for (sum, share) in sum[..count].iter_mut().zip(&shares) {
                for i in 0..N {
                    sum[i] += node.weight * share[i];
                }
            }
        }
        sum
    }

    /// The same with its derivatives, of a Gaussian at the pixel itself and of so many arms: all that there are.
    ///
    /// Sector k's share is the mass of the Gaussian in it. From where the pixel lies each arm takes the mass beside it, which [`Owen`] tells, from
    /// one of its sides to the other: no angle is too wide or too narrow for that.
    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "many arrays side by side")]
    pub(super) fn field_of<const N: usize, const NEAR: bool>(&self, count: usize, x: &[T; N], y: &[T; N]) -> Field<T, N> {
        let zero = [[T::of(0.0); N]; MOST];
        let mut field = Field { shares: zero, slopes: zero, turns: zero, across: zero };
        let (across, along) = self.places(count, x, y);
        field.across = across;
        let own = nearest_arm(count, &across, &along);
        for k in 0..count {
            for i in 0..N {
                field.shares[k][i] = if own[i] == T::of(k as f64) { T::of(1.0) } else { T::of(0.0) };
            }
        }
        for k in 0..count {
            self.add_arm::<N, NEAR>((k, count), &along[k], &mut field);
        }
        field
    }

    /// The sector in which each pixel lies.
    #[inline(always)]
    pub(super) fn own_sector<const N: usize>(&self, x: &[T; N], y: &[T; N]) -> [T; N] {
        let (across, along) = self.places(self.count, x, y);
        nearest_arm(self.count, &across, &along)
    }

    /// Where pixels lie across and along each arm.
    #[inline(always)]
    fn places<const N: usize>(&self, count: usize, x: &[T; N], y: &[T; N]) -> ([[T; N]; MOST], [[T; N]; MOST]) {
        let zero = [[T::of(0.0); N]; MOST];
        let (mut across, mut along) = (zero, zero);
        for k in 0..count {
            let arm = self.arms[k];
            for i in 0..N {
                across[k][i] = arm.x * y[i] - arm.y * x[i];
                along[k][i] = arm.x * x[i] + arm.y * y[i];
            }
        }
        (across, along)
    }

    /// Of pixels that see one arm alone, and not its end: by the number of this arm.
    #[inline(always)]
    pub(super) fn one_arm<const N: usize>(&self, count: usize, which: &[T; N], x: &[T; N], y: &[T; N]) -> OneArm<T, N> {
        let zero = [T::of(0.0); N];
        let (mut cos, mut sin, mut a, mut b, mut across) = (zero, zero, zero, zero, zero);
        for k in 0..count {
            let arm = self.arms[k];
            for i in 0..N {
                let its = which[i] == T::of(k as f64);
                cos[i] = if its { arm.x } else { cos[i] };
                sin[i] = if its { arm.y } else { sin[i] };
            }
        }
        for i in 0..N {
            across[i] = cos[i] * y[i] - sin[i] * x[i];
            a[i] = across[i] * self.inverse;
            b[i] = (cos[i] * x[i] + sin[i] * y[i]) * self.inverse;
        }
        let (edge, bell) = step(&a);
        let (mut after, mut slopes, mut turns) = (zero, zero, zero);
        for i in 0..N {
            let dense = T::of(DENSITY) * bell[i];
            after[i] = T::of(0.5) + T::of(0.5) * edge[i];
            slopes[i] = dense * self.inverse;
            turns[i] = dense * b[i];
        }
        OneArm { after, slopes, turns, across, cos, sin }
    }

    /// How much of the sector after their one arm is seen from pixels so far across it, at an arm of this direction; averaged over the photosite.
    #[inline(always)]
    pub(super) fn after_one<const N: usize>(&self, across: &[T; N], cos: &[T; N], sin: &[T; N]) -> [T; N] {
        let mut sum = [T::of(0.0); N];
        for node in &self.nodes[..self.gaussians] {
            let mut a = *across;
            for i in 0..N {
                a[i] = (a[i] + cos[i] * node.y - sin[i] * node.x) * self.inverse;
            }
            let (edge, _) = step(&a);
            for i in 0..N {
                sum[i] += node.weight * (T::of(0.5) + T::of(0.5) * edge[i]);
            }
        }
        sum
    }

    #[inline(always)]
    fn add_arm<const N: usize, const NEAR: bool>(&self, (k, count): (usize, usize), along: &[T; N], field: &mut Field<T, N>) {
        let (zero, half) = (T::of(0.0), T::of(0.5));
        let before = if k == 0 { count - 1 } else { k - 1 };
        let (mut a, mut b) = ([zero; N], [zero; N]);
        for i in 0..N {
            a[i] = field.across[k][i] * self.inverse;
            b[i] = along[i] * self.inverse;
        }
        let (edge, bell) = step(&a);
        let (mut mass, mut behind, mut fade) = ([zero; N], [zero; N], [zero; N]);
        if NEAR {
            let (far, bell) = step(&b);
            mass = self.owen.beside_ray(&a, &b, &edge, &far);
            for i in 0..N {
                behind[i] = half + half * far[i];
                fade[i] = T::of(DENSITY) * bell[i];
            }
        } else {
            for i in 0..N {
                behind[i] = if b[i] > zero { T::of(1.0) } else { zero };
                mass[i] = behind[i] * half * (T::of(1.0) - edge[i].magnitude());
            }
        }
        let slope = T::of(DENSITY) * self.inverse;
        let (mut moved, mut slopes, mut turns) = ([zero; N], [zero; N], [zero; N]);
        for i in 0..N {
            moved[i] = if a[i] < zero { mass[i] } else { -mass[i] };
            slopes[i] = slope * bell[i] * behind[i];
            turns[i] = T::of(DENSITY) * bell[i] * (b[i] * behind[i] + fade[i]);
        }
        (field.slopes[k], field.turns[k]) = (slopes, turns);
        plus(&mut field.shares[k], &moved);
        moved.iter_mut().for_each(|moved| *moved = -*moved);
        plus(&mut field.shares[before], &moved);
    }
}

/// The arm from which the least turn leads to each pixel.
#[inline(always)]
fn nearest_arm<T: Real, const N: usize>(count: usize, across: &[[T; N]; MOST], along: &[[T; N]; MOST]) -> [T; N] {
    let mut least = [T::of(5.0); N];
    let mut own = [T::of(0.0); N];
    for k in 0..count {
        for i in 0..N {
            let (a, b) = (across[k][i], along[k][i]);
            // Grows with the angle, from 0 to 4.
            let cosine = b / (a.magnitude() + b.magnitude() + T::of(1e-30));
            let turn = if a < T::of(0.0) { T::of(3.0) + cosine } else { T::of(1.0) - cosine };
            let nearer = turn < least[i];
            least[i] = if nearer { turn } else { least[i] };
            own[i] = if nearer { T::of(k as f64) } else { own[i] };
        }
    }
    own
}

#[inline(always)]
fn plus<T: Real, const N: usize>(sum: &mut [T; N], more: &[T; N]) {
    for (sum, more) in sum.iter_mut().zip(more) {
        *sum += *more;
    }
}
