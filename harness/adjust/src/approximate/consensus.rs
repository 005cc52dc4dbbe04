//! Searches against gross errors: few points at random, and what the others say.

use std::ops::Range;

use rand::SeedableRng;
use rand::seq::index::sample;
use rand_chacha::ChaCha8Rng;

use super::ApproximateError;

/// Trials at most, and at least.
const MOST_TRIALS: usize = 5000;
const FEWEST_TRIALS: usize = 40;
/// The risk that every trial held a gross error.
const RISK: f64 = 1e-6;
/// Without a tolerance, up to this share of the points may be wrong.
const WRONG: f64 = 0.45;
/// Rounds of fitting the agreeing points and asking again which agree.
const ROUNDS: usize = 20;
/// Points that are looked at before it is asked whether a model can still be the best.
pub(super) const AT_A_TIME: usize = 64;
/// A residual that is never a gross error, px.
const ROUNDING: f64 = 1e-7;

/// What a residual may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// Longer residuals are gross errors, px: random sample consensus.
    Pixels(f64),
    /// Not known: it is estimated from the median (least median of squares), so that one right residual in a thousand is taken for a gross error. Fewer
    /// than half of the points may be wrong.
    Unknown,
}

/// How to search against gross errors. The same seed gives the same answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Search {
    /// Where the choice of points starts.
    pub seed: u64,
    /// What a residual may be.
    pub tolerance: Tolerance,
}

/// The model on which most agree, refined, and the indices that agree with it.
///
/// `size` points determine a model; `freedom` is the number of residuals of a point, 1 or 2. `propose` makes models of chosen points, `squares` adds the
/// squared residuals of a range of points, px^2 ([`each`] makes it of one point's), and `refine` fits a model to all chosen points.
///
/// # Errors
/// [`ApproximateError::NoSolution`] if no trial gave a model, [`ApproximateError::NoConsensus`].
///
/// Source: Fischler & Bolles 1981, with the truncated squares of Torr & Zisserman 2000; Rousseeuw & Leroy 1987 for the median.
pub(super) fn search<M: Clone>(
    count: usize,
    size: usize,
    freedom: usize,
    options: &Search,
    propose: impl Fn(&[usize]) -> Vec<M>,
    squares: impl Fn(&M, Range<usize>, &mut Vec<f64>),
    refine: impl Fn(&M, &[usize]) -> Option<M>,
) -> Result<(M, Vec<usize>), ApproximateError> {
    let judge = Judge { count, size, freedom, tolerance: options.tolerance };
    let (mut model, mut agreeing) = best_trial(&judge, options.seed, propose, &squares).ok_or(ApproximateError::NoSolution)?;
    for _ in 0..ROUNDS {
        if agreeing.len() <= size {
            break;
        }
        let Some(refined) = refine(&model, &agreeing) else { break };
        let mut found = Vec::with_capacity(count);
        squares(&refined, 0..count, &mut found);
        let found = judge.agreeing(&found);
        model = refined;
        if found == agreeing {
            break;
        }
        agreeing = found;
    }
    let needed = (size + 1).min(count);
    if agreeing.len() < needed {
        return Err(ApproximateError::NoConsensus { agreeing: agreeing.len(), found: count, needed });
    }
    Ok((model, agreeing))
}

/// The squared residuals of a range of points, from one point's.
pub(super) fn each<M>(square: impl Fn(&M, usize) -> f64) -> impl Fn(&M, Range<usize>, &mut Vec<f64>) {
    move |model, range, squares| squares.extend(range.map(|index| square(model, index)))
}

/// The indices below `count` that are not among `agreeing`, which ascend.
pub(super) fn others(count: usize, agreeing: &[usize]) -> Vec<usize> {
    let mut agreeing = agreeing.iter().copied().peekable();
    (0..count).filter(|index| agreeing.next_if_eq(index).is_none()).collect()
}

fn best_trial<M>(
    judge: &Judge,
    seed: u64,
    propose: impl Fn(&[usize]) -> Vec<M>,
    squares: impl Fn(&M, Range<usize>, &mut Vec<f64>),
) -> Option<(M, Vec<usize>)> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut best: Option<(f64, M, Vec<usize>)> = None;
    let (mut trial, mut trials) = (0, judge.trials(judge.size));
    while trial < trials {
        trial += 1;
        for model in propose(&sample(&mut random, judge.count, judge.size).into_vec()) {
            let least = best.as_ref().map(|(least, ..)| *least);
            let Some((cost, found)) = judge.better(least, |range, found| squares(&model, range, found)) else { continue };
            let agreeing = judge.agreeing(&found);
            trials = judge.trials(agreeing.len());
            best = Some((cost, model, agreeing));
        }
    }
    best.map(|(_, model, agreeing)| (model, agreeing))
}

/// Tells agreement from gross errors.
struct Judge {
    count: usize,
    size: usize,
    freedom: usize,
    tolerance: Tolerance,
}

impl Judge {
    /// How many trials it takes when so many points agree.
    fn trials(&self, agreeing: usize) -> usize {
        let share = match self.tolerance {
            Tolerance::Pixels(_) => agreeing as f64 / self.count as f64,
            Tolerance::Unknown => 1.0 - WRONG,
        };
        let clean = share.powi(self.size as i32);
        let trials = RISK.ln() / (-clean).ln_1p();
        (trials.min(MOST_TRIALS as f64) as usize).max(FEWEST_TRIALS)
    }

    /// The largest squared residual of a point that agrees.
    fn limit(&self, squares: &[f64]) -> f64 {
        let limit = match self.tolerance {
            Tolerance::Pixels(tolerance) => tolerance * tolerance,
            Tolerance::Unknown => self.variance(squares) * if self.freedom == 1 { 10.83 } else { 13.82 },
        };
        limit.max(ROUNDING * ROUNDING)
    }

    /// The variance of a residual from the median of their squares, which is .455 or 1.386 times as large for one or two of them.
    fn variance(&self, squares: &[f64]) -> f64 {
        let spare = self.count.saturating_sub(self.size).max(1) as f64;
        let small_sample = (1.0 + 5.0 / spare).powi(2);
        self.median(squares) / if self.freedom == 1 { 0.455 } else { 1.386 } * small_sample
    }

    /// The square that just more than half of the points that are not fitted exactly stay below.
    fn median(&self, squares: &[f64]) -> f64 {
        let mut some = squares.to_vec();
        let middle = self.middle();
        if middle >= some.len() { f64::INFINITY } else { *some.select_nth_unstable_by(middle, f64::total_cmp).1 }
    }

    /// The place of the median in order.
    fn middle(&self) -> usize {
        ((self.count + self.size) / 2).min(self.count.saturating_sub(1))
    }

    /// The cost of a model and its squares, where it is below `least`. As soon as it cannot be, no further points are looked at: most models are wrong, and
    /// pictures of points take longer than all else.
    fn better(&self, least: Option<f64>, squares_of: impl Fn(Range<usize>, &mut Vec<f64>)) -> Option<(f64, Vec<f64>)> {
        let mut squares = Vec::with_capacity(self.count);
        let Some(least) = least else {
            squares_of(0..self.count, &mut squares);
            return Some((self.cost(&squares), squares));
        };
        let (mut larger, mut sum) = (0, 0.0);
        while squares.len() < self.count {
            let start = squares.len();
            squares_of(start..(start + AT_A_TIME).min(self.count), &mut squares);
            let lost = match self.tolerance {
                Tolerance::Unknown => {
                    larger += squares[start..].iter().filter(|square| square.is_nan() || **square >= least).count();
                    larger >= self.count - self.middle()
                }
                Tolerance::Pixels(_) => {
                    let limit = self.limit(&[]);
                    squares[start..].iter().for_each(|square| sum += square.min(limit));
                    sum >= least
                }
            };
            if lost {
                return None;
            }
        }
        let cost = self.cost(&squares);
        (cost < least).then_some((cost, squares))
    }

    fn cost(&self, squares: &[f64]) -> f64 {
        match self.tolerance {
            Tolerance::Pixels(_) => {
                let limit = self.limit(squares);
                squares.iter().map(|square| square.min(limit)).sum()
            }
            Tolerance::Unknown => self.median(squares),
        }
    }

    fn agreeing(&self, squares: &[f64]) -> Vec<usize> {
        let limit = self.limit(squares);
        (0..self.count).filter(|&i| squares[i] <= limit).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(tolerance: Tolerance, seed: u64, points: &[[f64; 2]]) -> Result<([f64; 2], Vec<usize>), ApproximateError> {
        let through = |a: [f64; 2], b: [f64; 2]| {
            let slope = (b[1] - a[1]) / (b[0] - a[0]);
            [a[1] - slope * a[0], slope]
        };
        let refine = |_: &[f64; 2], chosen: &[usize]| {
            let n = chosen.len() as f64;
            let sum = |f: fn([f64; 2]) -> f64| chosen.iter().map(|&i| f(points[i])).sum::<f64>();
            let (x, y, xx, xy) = (sum(|p| p[0]), sum(|p| p[1]), sum(|p| p[0] * p[0]), sum(|p| p[0] * p[1]));
            let slope = (n * xy - x * y) / (n * xx - x * x);
            Some([(y - slope * x) / n, slope])
        };
        let propose = |chosen: &[usize]| vec![through(points[chosen[0]], points[chosen[1]])];
        let square = |m: &[f64; 2], i: usize| (points[i][1] - m[0] - m[1] * points[i][0]).powi(2);
        search(points.len(), 2, 1, &Search { seed, tolerance }, propose, each(square), refine)
    }

    #[test]
    fn gross_errors_are_found_either_way() {
        let wobble = |i: u32| 0.1 * f64::from(i * 7 % 5) - 0.2;
        let mut points: Vec<[f64; 2]> = (0..30).map(|i| [f64::from(i), 2.0 + 0.5 * f64::from(i) + wobble(i)]).collect();
        for wrong in [3, 9, 11, 20, 28] {
            points[wrong][1] += 5.0 + wrong as f64;
        }
        for tolerance in [Tolerance::Pixels(0.5), Tolerance::Unknown] {
            let ([constant, slope], agreeing) = line(tolerance, 7, &points).unwrap();
            assert_eq!(agreeing.len(), 25, "{tolerance:?}");
            assert!((constant - 2.0).abs() < 0.1 && (slope - 0.5).abs() < 0.01);
            assert_eq!(line(tolerance, 7, &points), line(tolerance, 7, &points));
        }
    }

    /// A model is given up at no point if it costs less, and always if it does not.
    #[test]
    fn what_is_given_up_early_could_not_be_better() {
        let mut state = 3_u64;
        let mut draw = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) as f64 / f64::from(1_u32 << 31)
        };
        let (mut better, mut spared) = (0, 0);
        for round in 0..2000 {
            let count = 3 + round % 150;
            let tolerance = [Tolerance::Unknown, Tolerance::Pixels(0.7), Tolerance::Pixels(f64::INFINITY)][round % 3];
            let judge = Judge { count, size: 3.min(count), freedom: 2, tolerance };
            let of = |draw: &mut dyn FnMut() -> f64| match (8.0 * draw()) as u32 {
                0 => f64::INFINITY,
                1 => 0.25,
                _ => draw(),
            };
            let squares: Vec<f64> = (0..count).map(|_| of(&mut draw)).collect();
            // Some are as good, not better.
            let least = if draw() < 0.3 { judge.cost(&squares) } else { draw() * [1.0, count as f64][usize::from(round % 3 > 0)] };
            let looked = std::cell::Cell::new(0);
            let found = judge.better(Some(least), |range, found| {
                looked.set(looked.get() + range.len());
                found.extend_from_slice(&squares[range]);
            });
            let cost = judge.cost(&squares);
            assert_eq!(found, (cost < least).then(|| (cost, squares.clone())), "{tolerance:?} {least} {squares:?}");
            assert_eq!(judge.better(None, |range, found| found.extend_from_slice(&squares[range])), Some((cost, squares.clone())));
            better += usize::from(found.is_some());
            spared += usize::from(looked.get() < count);
        }
        assert!(better > 300 && spared > 300, "{better} {spared}");
    }

    #[test]
    fn others_are_all_that_do_not_agree() {
        assert_eq!(others(6, &[1, 2, 5]), [0, 3, 4]);
        assert_eq!((others(3, &[]), others(2, &[0, 1])), (vec![0, 1, 2], vec![]));
    }

    #[test]
    fn scattered_points_agree_on_nothing() {
        let points: Vec<[f64; 2]> = (0..6).map(|i| [f64::from(i), f64::from(i * i * i % 7) * 100.0 + f64::from(i * i)]).collect();
        let error = line(Tolerance::Pixels(1e-3), 1, &points).unwrap_err();
        assert_eq!(error, ApproximateError::NoConsensus { agreeing: 2, found: 6, needed: 3 });
    }
}
