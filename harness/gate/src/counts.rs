//! The test of counts: over points, allowing for points of one trial that fail together.

use calibench_records::statistics::paired::{PValues, sign_test};

use super::pairs::Pairs;

/// The points that became so and those that ceased to be, by trial.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Flips {
    /// How many points are so in the first run, and in the second.
    pub counts: [u64; 2],
    /// (became so, ceased to be so) in each trial.
    pub by_trial: Vec<(u64, u64)>,
}

impl Flips {
    /// Counts what `is` true of.
    pub fn of(pairs: &Pairs, is: impl Fn(&super::point_entry::Entry) -> bool) -> Self {
        let mut flips = Self { counts: [0; 2], by_trial: vec![(0, 0); pairs.trials] };
        for item in &pairs.items {
            let (old, new) = (is(&item.old), is(&item.new));
            flips.counts[0] += u64::from(old);
            flips.counts[1] += u64::from(new);
            let trial = &mut flips.by_trial[item.trial];
            trial.0 += u64::from(new && !old);
            trial.1 += u64::from(old && !new);
        }
        flips
    }

    /// How much more the trials' differences scatter than those of points that flip one by one: a ratio of variances, at least 1.
    pub fn dispersion(&self) -> f64 {
        let trials = self.by_trial.len() as f64;
        let flips: u64 = self.by_trial.iter().map(|(up, down)| up + down).sum();
        if trials < 2.0 || flips == 0 {
            return 1.0;
        }
        let differences: Vec<f64> = self.by_trial.iter().map(|(up, down)| *up as f64 - *down as f64).collect();
        let mean = differences.iter().sum::<f64>() / trials;
        let scatter = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() * trials / (trials - 1.0);
        (scatter / flips as f64).max(1.0)
    }

    /// The p-values of McNemar's exact test on the points that flipped, with both numbers divided by [`Self::dispersion`] to the test's disadvantage.
    ///
    /// Source: McNemar 1947, Psychometrika 12, 153-157; the division by an estimated dispersion is that of quasi-likelihood (Wedderburn 1974).
    pub fn test(&self) -> PValues {
        let dispersion = self.dispersion();
        let (up, down) = self.by_trial.iter().fold((0, 0), |sum, trial| (sum.0 + trial.0, sum.1 + trial.1));
        let part = |count: u64| count as f64 / dispersion;
        let growth = sign_test(part(up).floor() as u64, part(down).ceil() as u64).growth;
        let fall = sign_test(part(up).ceil() as u64, part(down).floor() as u64).fall;
        PValues { two_sided: (2.0 * growth.min(fall)).min(1.0), growth, fall }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{NO_CORNER, measured, method};

    #[test]
    fn flips_are_counted_by_trial() {
        let kept = measured([0.0; 2], None);
        let of = |marks: [[bool; 3]; 2]| {
            let entries = marks.into_iter().zip(0..).flat_map(|(trial, number)| {
                let entry = move |(mark, name): (bool, &'static str)| (number, name, if mark { NO_CORNER } else { kept });
                trial.into_iter().zip(["a", "b", "c"]).map(entry)
            });
            method(entries)
        };
        // Trial 0: a becomes rejected, b ceases to be, c stays so. Trial 1: a and b become so, c stays measured.
        let (old, new) = (of([[false, true, true], [false, false, false]]), of([[true, false, true], [true, true, false]]));
        let found = Flips::of(&Pairs::of(&old, &new, false), |entry| entry.status() == "rejected");
        assert_eq!(found, Flips { counts: [2, 4], by_trial: vec![(1, 1), (2, 0)] });
    }

    #[test]
    fn two_trials_scatter() {
        // Differences 15 and 7 with mean 11: squares 16 + 16, times 2/1, over 27 + 5 flips.
        let found = flips(&[(18, 3), (9, 2)]);
        assert!((found.dispersion() - 2.0).abs() < 1e-12, "{}", found.dispersion());
        // Halves 13.5 and 2.5, rounded to the disadvantage of each test: 13 of 16 up for growth; 2 of 16 down for a fall.
        let p = found.test();
        let growth = f64::from(560 + 120 + 16 + 1) / 65_536.0;
        assert!((p.growth / growth - 1.0).abs() < 1e-9 && (p.two_sided / (2.0 * growth) - 1.0).abs() < 1e-9, "{p:?}");
        assert!((p.fall - f64::from(65_536 - 1 - 16) / 65_536.0).abs() < 1e-9, "{p:?}");
    }

    #[test]
    fn three_trials_scatter_about_their_mean() {
        // Differences 4, -2 and 0 with mean 2/3: squares (100 + 64 + 4)/9, times 3/2, over 6 flips.
        assert!((flips(&[(4, 0), (0, 2), (0, 0)]).dispersion() - 14.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn what_nothing_speaks_for_is_chance() {
        for trials in [&[(0, 0); 5][..], &[(12, 0)], &[]] {
            assert_eq!(flips(trials).dispersion(), 1.0, "{trials:?}");
        }
        // As many up as down: both tails are above a half.
        let p = flips(&[(1, 0), (0, 1)]).test();
        assert_eq!(p.two_sided, 1.0);
    }

    #[test]
    fn a_fall_is_the_mirror_of_a_growth() {
        let (up, down) = (flips(&[(18, 3), (9, 2)]).test(), flips(&[(3, 18), (2, 9)]).test());
        assert_eq!((up.growth, up.fall, up.two_sided), (down.fall, down.growth, down.two_sided));
    }

    fn flips(by_trial: &[(u64, u64)]) -> Flips {
        Flips { counts: [0; 2], by_trial: by_trial.to_vec() }
    }

    #[test]
    fn points_that_flip_one_by_one_are_mcnemars() {
        // 9 up and 1 down in ten trials: differences 1 (nine times) and -1, whose scatter is below that of single points.
        let mut trials = vec![(1, 0); 9];
        trials.push((0, 1));
        let found = flips(&trials);
        assert_eq!(found.dispersion(), 1.0);
        assert!((found.test().growth - 11.0 / 1024.0).abs() < 1e-12, "{:?}", found.test());
    }

    #[test]
    fn points_that_flip_together_count_less() {
        // One trial of four loses 12 points: differences 12, 0, 0, 0 with mean 3, squares 81 + 27 = 108, times 4/3, over 12 flips: 12.
        let found = flips(&[(12, 0), (0, 0), (0, 0), (0, 0)]);
        assert!((found.dispersion() - 12.0).abs() < 1e-12);
        assert!((found.test().growth - 0.5).abs() < 1e-12, "one unit that flipped");
    }

    #[test]
    fn all_points_of_all_trials_are_all_evidence() {
        let found = flips(&[(36, 0); 12]);
        assert!((found.test().growth / 0.5_f64.powi(432) - 1.0).abs() < 1e-6);
        assert!((found.test().fall - 1.0).abs() < 1e-12);
    }
}
