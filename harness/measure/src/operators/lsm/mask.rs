//! The mask: an ideal shape in its own plane, and the points along its border at which line integrals are added up.

use std::sync::LazyLock;

use calibench_model::quadrature::gauss_legendre;
use calibench_model::{Affine, Curve, TargetKind};

/// Nodes of the longest rule.
pub(super) const LONGEST: usize = 48;

/// How many nodes line integrals are added up over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rule {
    /// As many as for coverages that are right to 2e-6 at a blur of 0.3 px, to 1e-6 from 0.5 px on.
    Exact,
    /// Fewer, for coverages that are only compared.
    Coarse,
}

impl Rule {
    /// Distance between the middle nodes, in standard deviations of the blur, and how many nodes there are beside.
    fn spacing(self) -> (f64, f64) {
        match self {
            Self::Exact => (1.4, 3.0),
            Self::Coarse => (2.4, 1.5),
        }
    }
}

/// Nodes and weights of the Gauss-Legendre rules of 1 to [`LONGEST`] points on [0, 1].
static RULES: LazyLock<Vec<Vec<(f64, f64)>>> = LazyLock::new(|| (1..=LONGEST).map(gauss_legendre).collect());

/// A mask.
#[derive(Clone, Debug)]
pub(super) struct Mask {
    /// What it pictures.
    pub(super) kind: TargetKind,
    curves: Vec<Curve>,
    /// Mean of u^2, which is that of v^2 for shapes with more than two-fold symmetry.
    pub(super) moment: f64,
}

impl Mask {
    /// The mask of a kind of target; `None` if that has no one shape.
    pub(super) fn new(kind: TargetKind) -> Option<Self> {
        let curves: Vec<Curve> = kind.outlines().into_iter().flat_map(|outline| outline.0).collect();
        let moment = moment(&curves)?;
        Some(Self { kind, curves, moment })
    }

    /// How many times it looks the same in a full turn, a change of contrast allowed; 0 for a disc.
    pub(super) fn symmetry(&self) -> u32 {
        match self.kind {
            TargetKind::Disc => 0,
            TargetKind::Triangle => 3,
            TargetKind::Corner | TargetKind::Junction => 1,
            TargetKind::Square | TargetKind::Cross | TargetKind::ChessCorner => 4,
        }
    }

    /// Whether its edges go on past the window.
    pub(super) fn is_open(&self) -> bool {
        matches!(self.kind, TargetKind::Corner | TargetKind::ChessCorner)
    }

    /// The curves of its border.
    pub(super) fn curves(&self) -> &[Curve] {
        &self.curves
    }
}

/// The part of one curve over which one rule is added up: parameters from `begin` on, `share` long.
#[derive(Clone, Copy, Debug)]
pub(super) struct Panel {
    rule: &'static [(f64, f64)],
    begin: f64,
    share: f64,
}

/// Between which columns and rows points of the border are seen, px.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// First and last column.
    pub(super) columns: (f64, f64),
    /// First and last row.
    pub(super) rows: (f64, f64),
}

impl Panel {
    /// The panels of a curve of the mask at `at` for a blur of `sigma` px, where it runs within the bounds.
    #[inline(always)]
    pub(super) fn of(curve: &Curve, affine: &Affine, at: [f64; 2], sigma: f64, rule: Rule, bounds: &Bounds) -> impl Iterator<Item = Self> {
        let (t0, t1) = visible(curve, affine, at, bounds);
        let length = (t1 - t0) * extent(curve, affine);
        let (spacing, beside) = rule.spacing();
        let wanted = std::f64::consts::FRAC_PI_2 * length / (spacing * sigma) + beside;
        // Of a shape that the iteration blew up beyond all bounds only so much is looked at: it is rejected anyway.
        let count = if t1 > t0 { (wanted / LONGEST as f64).ceil().clamp(1.0, 16.0) } else { 0.0 };
        let nodes = ((wanted / count.max(1.0)).ceil() as usize).clamp(1, LONGEST);
        let share = (t1 - t0) / count.max(1.0);
        (0..count as usize).map(move |index| Self { rule: &RULES[nodes - 1], begin: t0 + index as f64 * share, share })
    }

    /// Parameters of the curve with their weights.
    #[inline(always)]
    pub(super) fn nodes(self) -> impl Iterator<Item = (f64, f64)> {
        self.rule.iter().map(move |&(node, weight)| (self.begin + node * self.share, weight * self.share))
    }
}

/// A direction of the mask in the image, px.
#[inline(always)]
pub(super) fn map(a: &Affine, [u, v]: [f64; 2]) -> [f64; 2] {
    [a.axx * u + a.axy * v, a.ayx * u + a.ayy * v]
}

/// The part of a curve within the bounds, as parameters: of a line, where it is; an arc is taken whole. Empty if nothing is.
#[inline(always)]
fn visible(curve: &Curve, affine: &Affine, at: [f64; 2], bounds: &Bounds) -> (f64, f64) {
    let Curve::Line { from, to } = *curve else { return (0.0, 1.0) };
    let ([x0, y0], [x1, y1]) = (map(affine, from), map(affine, to));
    let (a, b) = between(at[1] + y0, at[1] + y1, bounds.rows);
    let (c, d) = between(at[0] + x0, at[0] + x1, bounds.columns);
    (a.max(c), b.min(d))
}

/// The places from and to which a line runs within the bounds' rows and to the right of all their columns; `None` if it does not.
#[inline(always)]
pub(super) fn beyond(curve: &Curve, affine: &Affine, at: [f64; 2], bounds: &Bounds) -> Option<[[f64; 2]; 2]> {
    let Curve::Line { from, to } = *curve else { return None };
    let ([x0, y0], [x1, y1]) = (map(affine, from), map(affine, to));
    let (c, d) = between(at[0] + x0, at[0] + x1, (bounds.columns.1, f64::INFINITY));
    let (a, b) = between(at[1] + y0, at[1] + y1, bounds.rows);
    let (begin, end) = (a.max(c), b.min(d));
    let place = |t: f64| [at[0] + x0 + t * (x1 - x0), at[1] + y0 + t * (y1 - y0)];
    (begin < end).then(|| [place(begin), place(end)])
}

/// Of a way from `from` to `to` the part between `low` and `high`, as fractions; empty if nothing is.
#[inline(always)]
fn between(from: f64, to: f64, (low, high): (f64, f64)) -> (f64, f64) {
    let (first, last) = (from.min(to), from.max(to));
    if last <= low || first >= high {
        return (0.0, 0.0);
    }
    if first >= low && last <= high {
        return (0.0, 1.0);
    }
    let fraction = |value: f64| ((value - from) / (to - from)).clamp(0.0, 1.0);
    let (a, b) = (fraction(low), fraction(high));
    (a.min(b), a.max(b))
}

/// How long a curve is in the image at most, px.
fn extent(curve: &Curve, affine: &Affine) -> f64 {
    match *curve {
        Curve::Line { from, to } => {
            let [x, y] = map(affine, [to[0] - from[0], to[1] - from[1]]);
            (x * x + y * y).sqrt()
        }
        Curve::Arc { radius, sweep, .. } => {
            let a = affine;
            radius * sweep.abs() * (a.axx * a.axx + a.axy * a.axy + a.ayx * a.ayx + a.ayy * a.ayy).sqrt()
        }
    }
}

/// Mean u^2 over what the curves enclose, by Green's theorem; `None` if that is nothing.
fn moment(curves: &[Curve]) -> Option<f64> {
    let (mut area, mut second) = (0.0, 0.0);
    for curve in curves {
        for &(t, weight) in &RULES[19] {
            let (u, dv) = match *curve {
                Curve::Line { from, to } => (from[0] + t * (to[0] - from[0]), to[1] - from[1]),
                Curve::Arc { centre, radius, start, sweep } => {
                    let cosine = (start + t * sweep).cos();
                    (centre[0] + radius * cosine, radius * sweep * cosine)
                }
            };
            area += u * dv * weight;
            second += u * u * u / 3.0 * dv * weight;
        }
    }
    (area > 0.0).then(|| second / area)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_those_of_the_shapes() {
        let expected = [
            (TargetKind::Disc, 1.0 / 16.0),
            (TargetKind::Square, 1.0 / 12.0),
            (TargetKind::Triangle, 1.0 / 24.0),
            (TargetKind::Cross, 29.0 / 540.0),
        ];
        for (kind, moment) in expected {
            let mask = Mask::new(kind).unwrap();
            assert!((mask.moment - moment).abs() < 1e-14, "{kind}: {}", mask.moment);
        }
        assert!(Mask::new(TargetKind::Junction).is_none());
    }
}
