//! Two runs of one method, point by point: what is not as it was.

use super::TOLERANCE;
use super::point_entry::{Entry, Found, Place};
use super::table::MethodTable;

/// A point with what was blessed and what is now.
pub(super) type Pair<'a> = (&'a Place, &'a Entry, &'a Entry);

/// What changed between two runs of a method, over the points of both.
pub(super) struct Changes<'a> {
    /// The points whose status or reason is another.
    pub statuses: Vec<Pair<'a>>,
    /// The points found in both whose coordinates differ by more than [`TOLERANCE`].
    pub moved: Vec<Pair<'a>>,
    /// The points found in both whose reported standard deviation differs by more than [`TOLERANCE`].
    pub sigmas: Vec<Pair<'a>>,
}

impl<'a> Changes<'a> {
    /// Compares the points that both have.
    pub fn of(base: &'a MethodTable, now: &'a MethodTable) -> Self {
        let mut changes = Self { statuses: Vec::new(), moved: Vec::new(), sigmas: Vec::new() };
        for (place, old) in &base.points {
            let Some(new) = now.points.get(place) else { continue };
            let pair = (place, old, new);
            if old.describe() != new.describe() {
                changes.statuses.push(pair);
            }
            let (Some(a), Some(b)) = (old.found(), new.found()) else { continue };
            if !(0..2).all(|axis| agree(a.at[axis], b.at[axis])) {
                changes.moved.push(pair);
            }
            if !same_sigma(a, b) {
                changes.sigmas.push(pair);
            }
        }
        changes
    }

    /// Whether nothing changed.
    pub fn is_empty(&self) -> bool {
        self.statuses.is_empty() && self.moved.is_empty() && self.sigmas.is_empty()
    }

    /// The largest move, px; infinite where a coordinate became a number or ceased to be one.
    pub fn farthest(&self) -> f64 {
        self.moved.iter().map(distance).fold(0.0, f64::max)
    }
}

/// How far a point moved, px.
pub(super) fn distance((_, old, new): &Pair<'_>) -> f64 {
    let (Some([a, b]), Some([c, d])) = (old.coordinates(), new.coordinates()) else { return 0.0 };
    let distance = (c - a).hypot(d - b);
    if distance.is_nan() { f64::INFINITY } else { distance }
}

/// Whether two coordinates are the same but for last bits.
pub(super) fn agree(a: f64, b: f64) -> bool {
    (a - b).abs() <= TOLERANCE || (a.is_nan() && b.is_nan())
}

fn same_sigma(old: &Found, new: &Found) -> bool {
    match (old.sigma, new.sigma) {
        (Some(a), Some(b)) => agree(a, b) || a == b,
        (None, None) => true,
        _ => false,
    }
}
