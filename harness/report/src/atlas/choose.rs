//! Which method to take: the least error among those that hardly ever fail, and who cannot be told from it.

use calibench_records::statistics::{holm, paired_t};

/// The greatest share of points, lost and rejected together, with which a method is still recommended.
pub const MOST_FAILURES: f64 = 0.01;
/// The chance that any method of a page is called worse than the best of its row though it is not.
pub const LEVEL: f64 = 0.05;

/// A method under some conditions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Candidate {
    /// Its name and setting.
    pub name: String,
    /// Mean squared error by trial, px^2, failures counted; the same trials for all candidates.
    pub losses: Vec<f64>,
    /// Points lost or rejected.
    pub failed: u64,
    /// All points.
    pub points: u64,
    /// RMSE of the points that were kept in units of their bound.
    pub ratio: Option<f64>,
    /// Points per second, where it was measured.
    pub speed: Option<f64>,
}

impl Candidate {
    /// `sqrt(mean(dx^2 + dy^2))`, px, with failures counted as errors of 1 px.
    pub fn rmse(&self) -> f64 {
        if self.losses.is_empty() { f64::INFINITY } else { (self.losses.iter().sum::<f64>() / self.losses.len() as f64).sqrt() }
    }

    /// The share of points that were lost or rejected.
    pub fn failures(&self) -> f64 {
        if self.points == 0 { 1.0 } else { self.failed as f64 / self.points as f64 }
    }

    fn is_sound(&self) -> bool {
        self.failures() <= MOST_FAILURES && !self.losses.is_empty()
    }
}

/// The answer under some conditions, as places in the list of candidates.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Verdict {
    /// The least RMSE; `None` if every candidate fails too often.
    pub best: Option<usize>,
    /// Those that cannot be told from it, in the order of their RMSE.
    pub ties: Vec<usize>,
    /// The next one that is worse beyond chance.
    pub second: Option<usize>,
}

/// The verdict of each row of a page. All comparisons of the page share [`LEVEL`] (Holm): one-sided paired t-tests of the losses by trial and of their logarithms.
pub fn decide(rows: &[Vec<Candidate>]) -> Vec<Verdict> {
    let ranked: Vec<Vec<usize>> = rows.iter().map(|row| rank(row)).collect();
    let pairs = || ranked.iter().enumerate().flat_map(|(row, order)| order.iter().skip(1).map(move |other| (row, order[0], *other)));
    let p: Vec<f64> = pairs().map(|(row, best, other)| growth(&rows[row][best], &rows[row][other])).collect();
    let mut verdicts: Vec<Verdict> = ranked.iter().map(|order| Verdict { best: order.first().copied(), ..Verdict::default() }).collect();
    for ((row, _, other), adjusted) in pairs().zip(holm(&p)) {
        let verdict = &mut verdicts[row];
        if adjusted > LEVEL {
            verdict.ties.push(other);
        } else if verdict.second.is_none() {
            verdict.second = Some(other);
        }
    }
    verdicts
}

/// The sound candidates by their RMSE.
fn rank(row: &[Candidate]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..row.len()).filter(|&index| row[index].is_sound()).collect();
    order.sort_by(|&a, &b| row[a].rmse().total_cmp(&row[b].rmse()));
    order
}

/// The p-value of `other` being no worse: the smaller one of two t-tests, doubled. Of the differences of the losses, which are the RMSE's own; and of
/// their logarithms, because one wild point in one trial widens the scatter of the differences so far that they say nothing.
fn growth(best: &Candidate, other: &Candidate) -> f64 {
    let pairs = || other.losses.iter().zip(&best.losses);
    let differences: Vec<f64> = pairs().map(|(other, best)| other - best).collect();
    let ratios: Vec<f64> = pairs().filter(|(other, best)| **other > 0.0 && **best > 0.0).map(|(other, best)| (other / best).ln()).collect();
    (2.0 * paired_t(&differences).growth.min(paired_t(&ratios).growth)).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Losses around `level` with the noise of a trial that all share, and a little of their own.
    fn candidate(name: &str, level: f64, own: usize, failed: u64) -> Candidate {
        let loss = |trial: usize| {
            level * (1.0 + 0.3 * ((trial * 7 % 11) as f64 - 5.0) / 5.0) * (1.0 + 0.02 * ((trial * own % 13) as f64 - 6.0) / 6.0)
        };
        Candidate { name: name.into(), losses: (0..13).map(loss).collect(), failed, points: 1000, ..Candidate::default() }
    }

    #[test]
    fn a_known_best_is_named_and_the_next_one_is_what_it_costs() {
        let row = vec![candidate("b", 1.2e-3, 3, 0), candidate("a", 1.0e-3, 5, 2), candidate("c", 4e-3, 7, 0)];
        assert_eq!(decide(&[row]), [Verdict { best: Some(1), ties: vec![], second: Some(0) }]);
    }

    #[test]
    fn ties_are_named_as_ties() {
        let row = vec![candidate("a", 1.0e-3, 3, 0), candidate("b", 1.0005e-3, 5, 0), candidate("c", 1.3e-3, 7, 0)];
        let verdict = &decide(&[row])[0];
        assert_eq!(
            (verdict.best.into_iter().chain(verdict.ties.clone()).collect::<std::collections::BTreeSet<_>>(), verdict.second),
            ([0, 1].into(), Some(2))
        );
    }

    #[test]
    fn a_lossy_operator_is_not_recommended_however_exact() {
        let row = vec![candidate("lossy", 1e-4, 3, 11), candidate("sound", 1e-3, 5, 10)];
        assert_eq!(decide(&[row])[0].best, Some(1));
        assert_eq!(decide(&[vec![candidate("lossy", 1e-4, 3, 11)]])[0], Verdict::default());
        assert_eq!(decide(&[vec![]])[0], Verdict::default());
    }

    #[test]
    fn one_wild_trial_does_not_hide_that_all_others_are_worse() {
        let mut wild = candidate("wild", 2e-3, 3, 1);
        wild.losses[4] = 0.5;
        let verdict = &decide(&[vec![candidate("a", 1e-3, 5, 0), wild]])[0];
        assert_eq!((verdict.best, verdict.second), (Some(0), Some(1)));
    }

    #[test]
    fn one_trial_tells_nothing_apart() {
        let one = |level: f64| Candidate { losses: vec![level], points: 10, ..Candidate::default() };
        assert_eq!(decide(&[vec![one(1.0), one(0.1)]])[0], Verdict { best: Some(1), ties: vec![0], second: None });
    }
}
