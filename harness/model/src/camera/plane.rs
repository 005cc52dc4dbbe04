//! Maps of the plane that distort or correct, where they are one to one, and their inverses.

use super::NoCounterpart;
use super::newton::{self, ValueAndDerivatives, determinant};

/// Places between the origin and a point where a fold is looked for.
const PLACES: usize = 96;
/// Halvings that locate a fold, and steps that locate a minimum.
const HALVINGS: usize = 60;

/// A smooth map of the plane. Its branch: the points that a straight way joins to the origin without meeting a fold.
pub(super) trait PlaneMap {
    /// Value and derivatives; not numbers where the map has a pole or ends.
    fn map(&self, at: [f64; 2]) -> ValueAndDerivatives;

    /// Is the map certainly one to one within `radius` of the origin? A cheap answer that spares the search; `false` when in doubt.
    fn is_surely_one_to_one(&self, _radius: f64) -> bool {
        false
    }
}

/// Is `at` on the branch of `map`?
pub(super) fn is_on_branch(map: &impl PlaneMap, at: [f64; 2]) -> bool {
    if !(at[0].is_finite() && at[1].is_finite()) {
        return false;
    }
    map.is_surely_one_to_one(at[0].hypot(at[1])) || first_fold(|s| determinant(map.map([at[0] * s, at[1] * s]).1), 1.0, PLACES).is_none()
}

/// The point on the branch of `map` that it takes to `goal`.
pub(super) fn invert(map: &impl PlaneMap, goal: [f64; 2]) -> Result<[f64; 2], NoCounterpart> {
    if !(goal[0].is_finite() && goal[1].is_finite()) {
        return Err(NoCounterpart::NoSolution);
    }
    match newton::solve(goal, [0.0; 2], |at| map.map(at)) {
        Ok(found) if is_on_branch(map, found) => Ok(found),
        _ => {
            let found = follow(map, goal)?;
            if is_on_branch(map, found) { Ok(found) } else { Err(NoCounterpart::Fold) }
        }
    }
}

/// Follows the solution from the origin's image to `goal` in small steps, for maps where one leap of Newton ends on another branch.
fn follow(map: &impl PlaneMap, goal: [f64; 2]) -> Result<[f64; 2], NoCounterpart> {
    let (origin, _) = map.map([0.0; 2]);
    let (mut at, mut done, mut step) = ([0.0; 2], 0.0, 0.125);
    while done < 1.0 {
        let next: f64 = f64::min(done + step, 1.0);
        let towards = [origin[0] + next * (goal[0] - origin[0]), origin[1] + next * (goal[1] - origin[1])];
        match newton::solve(towards, at, |at| map.map(at)) {
            Ok(found) => (at, done) = (found, next),
            Err(_) if step > 1e-3 => step *= 0.25,
            Err(error) => return Err(error),
        }
    }
    Ok(at)
}

/// Where `determinant` first is not positive between 0 and `end`, from `places` samples; a dip between two samples is looked into.
pub(super) fn first_fold(determinant: impl Fn(f64) -> f64, end: f64, places: usize) -> Option<f64> {
    let at = |i: usize| end * i as f64 / places as f64;
    let positive = |value: f64| value > 0.0;
    let (mut before, mut here) = (f64::INFINITY, determinant(0.0));
    if !positive(here) {
        return Some(0.0);
    }
    for i in 1..=places {
        let next = determinant(at(i));
        if !positive(next) {
            return Some(halve(&determinant, at(i - 1), at(i)));
        }
        let dips = here < before && here < next && here < 0.25 * before.min(next).max(0.4);
        if dips && i >= 2 {
            let lowest = minimum(&determinant, at(i - 2), at(i));
            if !positive(determinant(lowest)) {
                return Some(halve(&determinant, at(i - 2), lowest));
            }
        }
        (before, here) = (here, next);
    }
    None
}

/// The end of the positive values between `inside`, where there is one, and `outside`.
fn halve(f: &impl Fn(f64) -> f64, mut inside: f64, mut outside: f64) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inside + outside);
        if f(middle) > 0.0 { inside = middle } else { outside = middle }
    }
    inside
}

/// Golden section.
fn minimum(f: &impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    const SECTION: f64 = 0.618_033_988_749_894_9;
    for _ in 0..HALVINGS {
        let (left, right) = (high - SECTION * (high - low), low + SECTION * (high - low));
        if f(left) < f(right) { high = right } else { low = left }
    }
    0.5 * (low + high)
}

/// Brown's polynomials stay one to one where the derivatives of their terms sum up to less than one: then the map differs from the identity by a
/// contraction. `radial` holds the coefficients of r^2, r^4, ...; `tangential` those of the decentring terms.
pub(super) fn is_contraction(radius: f64, radial: &[f64], tangential: &[f64], linear: f64) -> bool {
    let r2 = radius * radius;
    let (mut power, mut sum) = (1.0, linear);
    for (i, k) in radial.iter().enumerate() {
        power *= r2;
        sum += (2 * i + 3) as f64 * k.abs() * power;
    }
    // The derivatives of p1 (r^2 + 2 x^2) and 2 p1 x y are below 6 r and 2 r, whatever the direction: 8 r bounds their norm.
    sum += 8.0 * radius * tangential.iter().map(|p| p.abs()).sum::<f64>();
    sum < 1.0
}
