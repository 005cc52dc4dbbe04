//! Maps of the plane that distort or correct, where they are one to one, and their inverses.

use super::NoCounterpart;
use super::newton::{self, ValueAndDerivatives, determinant};

/// Places between the origin and a point where a fold is looked for.
const PLACES: usize = 96;
/// Newton's steps to a start.
const RADIAL_STEPS: usize = 2;
/// Halvings that locate a fold, and steps that locate a minimum.
const HALVINGS: usize = 60;

/// Highest degree of a polynomial in the squared radius.
const HIGHEST: usize = 6;
/// Halvings of an interval on which a polynomial is asked to be positive.
const HALVED: usize = 12;

/// A smooth map of the plane. Its branch: the points that a straight way joins to the origin without meeting a fold.
pub(super) trait PlaneMap {
    /// Value and derivatives; not numbers where the map has a pole or ends.
    fn map(&self, at: [f64; 2]) -> ValueAndDerivatives;

    /// A place near the one that the map takes to `goal`, where there is a better one than `goal` itself.
    fn start(&self, _goal: [f64; 2]) -> Option<[f64; 2]> {
        None
    }

    /// Whether the map is certainly one to one within `radius` of the origin, in its own unit: a cheap bound that spares the search; `false` when in doubt.
    fn is_surely_one_to_one(&self, _radius: f64) -> bool {
        false
    }
}

/// Whether `at` lies on the branch of `map` that holds the origin.
pub(super) fn is_on_branch(map: &impl PlaneMap, at: [f64; 2]) -> bool {
    if !(at[0].is_finite() && at[1].is_finite()) {
        return false;
    }
    // Not `hypot`, which takes longer than the rest: of a bound the last digit does not matter.
    let radius = (at[0] * at[0] + at[1] * at[1]).sqrt();
    map.is_surely_one_to_one(radius) || first_fold(|s| determinant(map.map([at[0] * s, at[1] * s]).1), 1.0, PLACES).is_none()
}

/// The point on the branch of `map` that it takes to `goal`.
pub(super) fn invert(map: &impl PlaneMap, goal: [f64; 2]) -> Result<[f64; 2], NoCounterpart> {
    if !(goal[0].is_finite() && goal[1].is_finite()) {
        return Err(NoCounterpart::NoSolution);
    }
    // The first step from the origin leads to the goal or nearly there, where the map leaves it that far.
    for start in map.start(goal).into_iter().chain([goal, [0.0; 2]]) {
        if let Ok(found) = newton::solve(goal, start, |at| map.map(at))
            && is_on_branch(map, found)
        {
            return Ok(found);
        }
    }
    let found = follow(map, goal)?;
    if is_on_branch(map, found) { Ok(found) } else { Err(NoCounterpart::Fold) }
}

/// Where the factor `1 + ...` of `radial`, the signed coefficients of r^2, r^4, ..., alone takes a place nearly to `goal`: Newton's steps along the ray, each of which takes
/// a quarter of what one in the plane does.
pub(super) fn radial_start(radial: &[f64], goal: [f64; 2]) -> Option<[f64; 2]> {
    let square = goal[0] * goal[0] + goal[1] * goal[1];
    let mut share = 1.0;
    for _ in 0..RADIAL_STEPS {
        let t = share * share * square;
        let (mut factor, mut slope) = (0.0, 0.0);
        for (i, k) in radial.iter().enumerate().rev() {
            factor = t * (k + factor);
            slope = t * ((2 * i + 3) as f64 * k + slope);
        }
        share -= (share * (1.0 + factor) - 1.0) / (1.0 + slope);
    }
    (0.5..2.0).contains(&share).then(|| goal.map(|goal| share * goal))
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

/// Brown's polynomials stay one to one where the symmetric part of their derivatives is positive. `radial` holds the signed coefficients of r^2, r^4, ...
/// of the factor `1 + ...`; `tangential` those of the decentring terms; `linear` bounds what else there is.
///
/// Across the radius the derivative is the factor itself, along it the derivative of r times the factor; the other terms change both by no more than their
/// norm. Cheap bounds first: most points of most lenses need no more.
pub(super) fn is_one_to_one(radius: f64, radial: &[f64], tangential: &[f64], linear: f64) -> bool {
    let r2 = radius * radius;
    let (mut power, mut sum) = (1.0, 0.0);
    for (i, k) in radial.iter().enumerate() {
        power *= r2;
        sum += (2 * i + 3) as f64 * k.abs() * power;
    }
    // The derivatives of p1 (r^2 + 2 x^2) and 2 p1 x y are below 6 r and 2 r, whatever the direction: 8 r bounds their norm.
    let rest = linear + 8.0 * radius * tangential.iter().map(|p| p.abs()).sum::<f64>();
    sum + rest < 1.0 || (rest < 1.0 && stays_above(rest, r2, radial, |_| 1.0) && stays_above(rest, r2, radial, |i| (2 * i + 3) as f64))
}

/// The same for a quotient of two such polynomials as the factor; `false` too where the denominator may vanish.
///
/// With the factor `n / d` the two derivatives are `n / d` and `(n d + 2 s (n' d - n d')) / d^2`, s the squared radius: times the positive denominators both
/// are polynomials.
pub(super) fn is_quotient_one_to_one(radius: f64, [above, below]: [[f64; 3]; 2], tangential: &[f64], linear: f64) -> bool {
    let end = radius * radius;
    let rest = linear + 8.0 * radius * tangential.iter().map(|p| p.abs()).sum::<f64>();
    let [n, d] = [above, below].map(|k| [1.0, k[0], k[1], k[2]]);
    let mut along = [0.0; 7];
    for (i, n_i) in n.iter().enumerate() {
        for (j, d_j) in d.iter().enumerate() {
            along[i + j] += (1.0 + 2.0 * (i as f64 - j as f64)) * n_i * d_j - rest * d[i] * d_j;
        }
    }
    let across: [f64; 3] = std::array::from_fn(|i| above[i] - rest * below[i]);
    let stays = |bound: f64, polynomial: &[f64]| stays_above(bound, end, polynomial, |_| 1.0);
    rest < 1.0 && stays(0.0, &below) && stays(rest, &across) && stays(rest, &along[1..])
}

/// Whether `1 + sum weight(i) k_i s^(i+1)` is above `bound` for all s from 0 to `end`; `false` where it is so close to the bound that this is in doubt.
///
/// A polynomial lies between the least and the largest of its coefficients in Bernstein's form, and closer to them on either half.
pub(super) fn stays_above(bound: f64, end: f64, radial: &[f64], weight: impl Fn(usize) -> f64) -> bool {
    let degree = radial.len();
    let mut coefficients = [0.0; HIGHEST + 1];
    let mut power = 1.0;
    coefficients[0] = 1.0 - bound;
    for (i, k) in radial.iter().enumerate() {
        power *= end;
        coefficients[i + 1] = weight(i) * k * power;
    }
    let bernstein = &mut coefficients[..=degree];
    // Over the binomials of the degree, then summed as in Pascal's triangle.
    let mut binomial = 1.0;
    for (i, c) in bernstein.iter_mut().enumerate() {
        *c /= binomial;
        binomial *= (degree - i) as f64 / (i + 1) as f64;
    }
    for last in (0..degree).rev() {
        (last..degree).for_each(|i| bernstein[i + 1] += bernstein[i]);
    }
    is_positive(bernstein, HALVED)
}

/// Whether a polynomial with these coefficients in Bernstein's form is positive, from so many halvings at most.
fn is_positive(bernstein: &[f64], halvings: usize) -> bool {
    if bernstein.iter().all(|c| *c > 0.0) {
        return true;
    }
    let degree = bernstein.len() - 1;
    // Written so that what is not a number is refused.
    if !(bernstein[0] > 0.0 && bernstein[degree] > 0.0) || halvings == 0 {
        return false;
    }
    let (mut left, mut right) = ([0.0; HIGHEST + 1], [0.0; HIGHEST + 1]);
    right[..=degree].copy_from_slice(bernstein);
    for (step, first) in left[..=degree].iter_mut().enumerate() {
        *first = right[0];
        (0..degree - step).for_each(|i| right[i] = 0.5 * (right[i] + right[i + 1]));
    }
    is_positive(&left[..=degree], halvings - 1) && is_positive(&right[..=degree], halvings - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of lenses with up to a seventh of distortion on either side; where there is none to be found, none.
    #[test]
    fn a_radial_start_is_nearly_there() {
        let goal = [8.0, -6.0];
        for k in [[0.0; 3], [-4.61e-4, 1.2e-6, -4e-10], [7e-4, 0.0, 0.0], [-1.2e-3, 3e-6, -1e-8], [0.0, 2e-6, 0.0], [0.0, 0.0, -4e-8]] {
            let start = radial_start(&k, goal).unwrap();
            let t = start[0] * start[0] + start[1] * start[1];
            let factor = 1.0 + t * (k[0] + t * (k[1] + t * k[2]));
            let off = [0, 1].map(|axis| factor * start[axis] / goal[axis] - 1.0);
            assert!(off[0].abs() < 2e-3 && off[1].abs() < 2e-3, "{k:?}: {off:?}");
            // Of the sixth of a distortion it began with; of a small one its fourth power is left.
            let distortion = 100.0 * (k[0] + 100.0 * (k[1] + 100.0 * k[2]));
            assert!(off[0].abs() <= 3.0 * (3.0 * distortion).powi(4).abs() + 1e-15, "{k:?}: {off:?} {distortion}");
        }
        // It folds before; it has a pole on the way; it is none.
        for k in [[-0.02, 0.0, 0.0], [-1.0 / 300.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0], [f64::INFINITY, 0.0, 0.0]] {
            assert_eq!(radial_start(&k, goal), None, "{k:?}");
        }
    }

    /// The radial polynomials of real lenses, and where the derivative of r (1 + k1 r^2 + k2 r^4 + k3 r^6) first vanishes.
    #[test]
    fn what_is_surely_one_to_one_has_no_fold() {
        for radial in [[-0.28, 0.09, -0.012], [-0.4, 0.15, 0.0], [-0.1, -0.05, 0.0], [0.2, -0.3, 0.05], [-0.5, 0.5, -0.4]] {
            let slope = |r: f64| 1.0 + r * r * (3.0 * radial[0] + r * r * (5.0 * radial[1] + r * r * 7.0 * radial[2]));
            let fold = first_fold(slope, 3.0, 3000).unwrap_or(3.0);
            let sure = |radius: f64| is_one_to_one(radius, &radial, &[], 0.0);
            assert!(!sure(1.001 * fold) || fold == 3.0, "{radial:?} folds at {fold}");
            assert!(sure(0.995 * fold), "{radial:?} is safe up to {fold}");
            let margin = 8.0 * 0.9 * fold * 0.2;
            assert_eq!(
                is_one_to_one(0.9 * fold, &radial, &[0.2], 0.0),
                margin < 1.0 && (0..=900).all(|i| slope(1e-3 * f64::from(i) * fold) > margin)
            );
        }
    }

    #[test]
    fn what_is_surely_one_to_one_of_a_quotient_has_no_fold() {
        for (above, below) in [
            ([-0.28, 0.09, -0.012], [0.0; 3]),
            ([0.3, 0.02, 0.001], [0.6, 0.11, 0.004]),
            ([0.1, -0.05, 0.0], [0.4, 0.1, 0.02]),
            ([-0.3, 0.0, 0.0], [-0.2, -0.05, 0.0]),
        ] {
            let polynomial = |k: [f64; 3], s: f64| 1.0 + s * (k[0] + s * (k[1] + s * k[2]));
            let radius = |r: f64| r * polynomial(above, r * r) / polynomial(below, r * r);
            // By differences; a pole is where the denominator changes its sign.
            let slope = |r: f64| if polynomial(below, r * r) > 0.0 { (radius(r + 1e-6) - radius(r - 1e-6)) / 2e-6 } else { -1.0 };
            let fold = first_fold(slope, 3.0, 3000).unwrap_or(3.0);
            let sure = |radius: f64, p: f64| is_quotient_one_to_one(radius, [above, below], &[p], 0.0);
            assert!(!sure(1.001 * fold, 0.0) || fold == 3.0, "{above:?} over {below:?} folds at {fold}");
            assert!(sure(0.995 * fold, 0.0), "{above:?} over {below:?} is safe up to {fold}");
            let least = (0..=800).map(|i| slope(1e-3 * f64::from(i) * fold)).fold(f64::INFINITY, f64::min);
            assert!(!sure(0.8 * fold, 1.05 * least / (8.0 * 0.8 * fold)), "decentring as steep as the radial terms");
        }
    }

    proptest::proptest! {
        #[test]
        fn polynomials_stay_above_what_they_stay_above(radial in proptest::collection::vec(-3.0..3.0f64, 1..7), end in 0.01..2.0f64, bound in -1.0..0.9f64) {
            let polynomial = |s: f64| 1.0 + radial.iter().rev().fold(0.0, |sum, k| (sum + k) * s);
            let places: Vec<f64> = (0..=4000).map(|i| end * f64::from(i) / 4000.0).collect();
            let lowest = places.iter().map(|&s| polynomial(s)).fold(f64::INFINITY, f64::min);
            let stays = stays_above(bound, end, &radial, |_| 1.0);
            // Between two places, and in the digits, it may be lower by this.
            let steepest: f64 = (1..).zip(&radial).map(|(i, k)| f64::from(i) * k.abs() * end.powi(i)).sum();
            let gap = 1e-12 + steepest / 4000.0;
            if lowest < bound {
                proptest::prop_assert!(!stays, "{lowest}");
            }
            if lowest > bound + gap {
                proptest::prop_assert!(stays, "{lowest}");
            }
        }
    }
}
