//! The mask: an ideal shape in its own plane, and the points along its border at which line integrals are added up.

use std::sync::LazyLock;

use calibench_model::{Affine, Curve, TargetKind};

/// Nodes of the longest rule.
const LONGEST: usize = 48;
/// Distance between the middle nodes of a rule, in standard deviations of the blur: coverages are then right to 2e-6 at a blur of 0.3 px, to 1e-6 from 0.5 px on.
const SPACING: f64 = 1.4;

/// Nodes and weights of the Gauss-Legendre rules of 1 to [`LONGEST`] points on [0, 1].
static RULES: LazyLock<Vec<Vec<(f64, f64)>>> = LazyLock::new(|| (1..=LONGEST).map(gauss_legendre).collect());

/// A mask.
#[derive(Clone, Debug)]
pub(super) struct Mask {
    /// What it pictures.
    pub(super) kind: TargetKind,
    curves: Vec<Curve>,
    /// Its area and the second moments about its reference point, of the area.
    pub(super) area: f64,
    /// Mean of u^2, which is that of v^2 for shapes with more than two-fold symmetry.
    pub(super) moment: f64,
}

/// A point of the border in the image, with the piece of border that it stands for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Where it is, px.
    pub(super) at: [f64; 2],
    /// The piece, px.
    pub(super) step: [f64; 2],
    /// Where it is on the mask.
    pub(super) mask: [f64; 2],
}

impl Mask {
    /// The mask of a kind of target; `None` if that has no one shape.
    pub(super) fn new(kind: TargetKind) -> Option<Self> {
        let curves: Vec<Curve> = kind.outlines().into_iter().flat_map(|outline| outline.0).collect();
        let (area, moment) = moments(&curves)?;
        Some(Self { kind, curves, area, moment })
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

    /// Do its edges go on past the window?
    pub(super) fn is_open(&self) -> bool {
        matches!(self.kind, TargetKind::Corner | TargetKind::ChessCorner)
    }

    /// Calls `visit` with the nodes along the border, for a blur of `sigma` px, from pixel row `low` to `high`: the rest of an open mask is not seen.
    #[inline(always)]
    pub(super) fn nodes(&self, affine: &Affine, at: [f64; 2], sigma: f64, rows: (f64, f64), mut visit: impl FnMut(Node)) {
        for curve in &self.curves {
            let Some((t0, t1)) = visible(curve, affine, at[1], rows) else { continue };
            let length = (t1 - t0) * extent(curve, affine);
            let wanted = std::f64::consts::FRAC_PI_2 * length / (SPACING * sigma) + 3.0;
            let panels = (wanted / LONGEST as f64).ceil();
            // Of a shape that the iteration blew up beyond all bounds only the beginning is looked at: it is rejected anyway.
            let panels = panels.clamp(1.0, 16.0) as usize;
            let rule = &RULES[((wanted / panels as f64).ceil() as usize).clamp(1, LONGEST) - 1];
            let share = (t1 - t0) / panels as f64;
            for panel in 0..panels {
                let begin = t0 + panel as f64 * share;
                for &(node, weight) in rule {
                    visit(place(curve, affine, at, begin + node * share, weight * share));
                }
            }
        }
    }
}

#[inline(always)]
fn map(a: &Affine, [u, v]: [f64; 2]) -> [f64; 2] {
    [a.axx * u + a.axy * v, a.ayx * u + a.ayy * v]
}

#[inline(always)]
fn place(curve: &Curve, affine: &Affine, at: [f64; 2], t: f64, weight: f64) -> Node {
    let (mask, tangent) = match *curve {
        Curve::Line { from, to } => {
            let along = [to[0] - from[0], to[1] - from[1]];
            ([from[0] + t * along[0], from[1] + t * along[1]], along)
        }
        Curve::Arc { centre, radius, start, sweep } => {
            let (sine, cosine) = (start + t * sweep).sin_cos();
            ([centre[0] + radius * cosine, centre[1] + radius * sine], [-radius * sweep * sine, radius * sweep * cosine])
        }
    };
    let ([x, y], step) = (map(affine, mask), map(affine, tangent));
    Node { at: [at[0] + x, at[1] + y], step: step.map(|s| s * weight), mask }
}

/// The part of a curve between two rows, as parameters: of a line, where it is; an arc is taken whole. `None` if nothing is.
fn visible(curve: &Curve, affine: &Affine, y: f64, (low, high): (f64, f64)) -> Option<(f64, f64)> {
    let Curve::Line { from, to } = *curve else { return Some((0.0, 1.0)) };
    let (y0, y1) = (y + map(affine, from)[1], y + map(affine, to)[1]);
    if y0.max(y1) <= low || y0.min(y1) >= high {
        return None;
    }
    if y0.min(y1) >= low && y0.max(y1) <= high {
        return Some((0.0, 1.0));
    }
    let at = |row: f64| ((row - y0) / (y1 - y0)).clamp(0.0, 1.0);
    let (a, b) = (at(low), at(high));
    Some((a.min(b), a.max(b)))
}

/// How long a curve is in the image at most, px.
fn extent(curve: &Curve, affine: &Affine) -> f64 {
    match *curve {
        Curve::Line { from, to } => {
            let [x, y] = map(affine, [to[0] - from[0], to[1] - from[1]]);
            x.hypot(y)
        }
        Curve::Arc { radius, sweep, .. } => {
            let a = affine;
            radius * sweep.abs() * (a.axx * a.axx + a.axy * a.axy + a.ayx * a.ayx + a.ayy * a.ayy).sqrt()
        }
    }
}

/// Area and mean u^2 of what the curves enclose, by Green's theorem; `None` if that is nothing.
fn moments(curves: &[Curve]) -> Option<(f64, f64)> {
    let unit = Affine { axx: 1.0, axy: 0.0, ayx: 0.0, ayy: 1.0 };
    let (mut area, mut second) = (0.0, 0.0);
    for curve in curves {
        for &(t, weight) in &RULES[19] {
            let Node { mask: [u, _], step: [_, dv], .. } = place(curve, &unit, [0.0; 2], t, weight);
            area += u * dv;
            second += u * u * u / 3.0 * dv;
        }
    }
    (area > 0.0).then(|| (area, second / area))
}

/// Newton's method on Legendre's polynomial, whose values come from its recurrence.
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let node = |i: usize| {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..50 {
            let (mut before, mut value) = (0.0, 1.0);
            for k in 0..n {
                let k = k as f64;
                (before, value) = (value, ((2.0 * k + 1.0) * x * value - k * before) / (k + 1.0));
            }
            slope = n as f64 * (x * value - before) / (x * x - 1.0);
            let step = value / slope;
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        ((1.0 - x) / 2.0, 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_integrate_polynomials() {
        for (index, rule) in RULES.iter().enumerate() {
            for degree in [0, 1, index, 2 * index + 1] {
                let sum: f64 = rule.iter().map(|(x, w)| w * x.powi(degree as i32)).sum();
                assert!((sum * (degree + 1) as f64 - 1.0).abs() < 1e-12, "{} points, degree {degree}: {sum}", index + 1);
            }
        }
    }

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

    #[test]
    fn steps_close_the_border() {
        let affine = Affine { axx: 7.0, axy: 1.0, ayx: -2.0, ayy: 6.0 };
        for kind in TargetKind::ALL {
            let Some(mask) = Mask::new(kind) else { continue };
            let mut sum = [0.0; 2];
            mask.nodes(&affine, [3.0, 4.0], 0.7, (-100.0, 100.0), |node| sum = [sum[0] + node.step[0], sum[1] + node.step[1]]);
            assert!(sum[0].hypot(sum[1]) < 1e-11, "{kind}: {sum:?}");
        }
    }
}
