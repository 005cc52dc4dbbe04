//! Faults put into what is kept of sweeps: of a method in a cell there are sums, and no points.

use rayon::prelude::*;

use super::mutate::Mutation;
use crate::cells::Cells;
use crate::finding::{Finding, Rules, Verdict};
use crate::moments::{PointSums, Sum};
use crate::sums_judged::judged;

/// How the gate judged one kind of fault in all methods of all cells of a sweep.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SweepOutcome {
    /// The scenario.
    pub scenario: String,
    /// The fault.
    pub mutation: Mutation,
    /// Methods in cells into which it was put.
    pub tried: usize,
    /// How many of these fail a strict check, and how many a plain one.
    pub caught: [usize; 2],
    /// Methods in cells that have no such fault, by reason.
    pub untested: Vec<(&'static str, usize)>,
}

/// Puts every fault into every method of every cell of `sweeps`, one at a time.
pub fn sweep_power(sweeps: &[Cells<PointSums>]) -> Vec<SweepOutcome> {
    let all: Vec<(&Cells<PointSums>, Mutation)> =
        sweeps.iter().flat_map(|cells| Mutation::ALL.map(|(mutation, _)| (cells, mutation))).collect();
    all.into_par_iter().map(|(cells, mutation)| one(cells, mutation)).collect()
}

fn one(cells: &Cells<PointSums>, mutation: Mutation) -> SweepOutcome {
    let mut outcome = SweepOutcome { scenario: cells.scenario.clone(), mutation, tried: 0, caught: [0; 2], untested: Vec::new() };
    for old in cells.values() {
        match faulty(old, mutation) {
            Ok(new) => {
                outcome.tried += 1;
                let findings = judged(old, &new, &|verdict: Verdict, metric, message| Finding::new(verdict, "", "", metric, message));
                for (strict, caught) in [true, false].into_iter().zip(&mut outcome.caught) {
                    *caught += usize::from(findings.iter().any(|finding| finding.fails_by(Rules { strict, locked: false })));
                }
            }
            Err(why) => match outcome.untested.iter_mut().find(|(reason, _)| *reason == why) {
                Some((_, count)) => *count += 1,
                None => outcome.untested.push((why, 1)),
            },
        }
    }
    outcome
}

/// The sums of points with this fault, as far as its expectation goes; the digest of other points is another one.
fn faulty(old: &PointSums, mutation: Mutation) -> Result<PointSums, &'static str> {
    let mut new = old.clone();
    let sums: Vec<&mut Sum> = new.targets.values_mut().collect();
    match mutation {
        Mutation::MoreNoise => scaled(sums, 1.1 * 1.1)?,
        Mutation::DoubledNoise => scaled(sums, 4.0)?,
        Mutation::LostDoubled => {
            let lost = sums.iter().map(|sum| sum.counts[1]).sum();
            if lost == 0 {
                return Err("no point is lost");
            }
            no_longer_measured(sums, lost, 1)?;
        }
        Mutation::TenthRejected => {
            let tenth = sums.iter().map(|sum| sum.counts[0]).sum::<u64>().div_ceil(10);
            no_longer_measured(sums, tenth, 2)?;
        }
        Mutation::CopiedTrial => return Err("sums have no trials; any point that changes changes their digest"),
        Mutation::OneNan => {
            let sum = sums.into_iter().find(|sum| sum.counts[0] > 0).ok_or("no point is measured")?;
            (sum.counts[0], sum.counts[1], sum.nans) = (sum.counts[0] - 1, sum.counts[1] + 1, sum.nans + 1);
        }
        Mutation::Swapped => {
            for sum in sums {
                sum.mean.swap(0, 1);
                sum.covariance.swap(0, 2);
            }
        }
    }
    if new == *old {
        return Err("the results stay the same");
    }
    new.digest = format!("faulty {}", old.digest);
    Ok(new)
}

fn scaled(sums: Vec<&mut Sum>, factor: f64) -> Result<(), &'static str> {
    if sums.iter().all(|sum| sum.counts[0] == 0) {
        return Err("no point is measured");
    }
    sums.into_iter().flat_map(|sum| &mut sum.covariance).for_each(|value| *value *= factor);
    Ok(())
}

/// `count` measured points become lost (1) or rejected (2), one of each target in turn.
fn no_longer_measured(mut sums: Vec<&mut Sum>, count: u64, place: usize) -> Result<(), &'static str> {
    let mut left = count;
    let mut measured = sums.iter().map(|sum| sum.counts[0]).sum::<u64>();
    if measured == 0 {
        return Err("no point is measured");
    }
    while left > 0 && measured > 0 {
        for sum in sums.iter_mut().filter(|sum| sum.counts[0] > 0) {
            if left == 0 {
                break;
            }
            sum.counts[0] -= 1;
            sum.counts[place] += 1;
            (left, measured) = (left - 1, measured - 1);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Coordinates;
    use crate::tests::{NO_CORNER, holding, measured, method};

    fn sums() -> PointSums {
        let sum = Sum { counts: [30, 2, 0], mean: [0.1, 0.0], covariance: [0.04, 0.0, 0.01], ..Sum::default() };
        let targets = [("a".into(), sum), ("b".into(), Sum { counts: [40, 0, 0], ..sum })].into();
        PointSums { digest: "d".into(), targets }
    }

    #[test]
    fn every_fault_is_put_in_as_its_name_says() {
        let old = sums();
        let of = |mutation| faulty(&old, mutation).unwrap();
        let a = |sums: &PointSums| sums.targets["a"];
        assert!((of(Mutation::DoubledNoise).targets["b"].spread() / 0.05 - 4.0).abs() < 1e-12);
        assert!((a(&of(Mutation::MoreNoise)).spread().sqrt() / 0.05_f64.sqrt() - 1.1).abs() < 1e-12);
        let lost = of(Mutation::LostDoubled);
        assert_eq!((a(&lost).counts, lost.targets["b"].counts), ([29, 3, 0], [39, 1, 0]));
        let rejected = of(Mutation::TenthRejected);
        assert_eq!((a(&rejected).counts, rejected.targets["b"].counts), ([26, 2, 4], [37, 0, 3]));
        assert_eq!((a(&of(Mutation::OneNan)).counts, a(&of(Mutation::OneNan)).nans), ([29, 3, 0], 1));
        assert_eq!((a(&of(Mutation::Swapped)).mean, a(&of(Mutation::Swapped)).covariance), ([0.0, 0.1], [0.01, 0.0, 0.04]));
        for (mutation, _) in Mutation::ALL.into_iter().filter(|(mutation, _)| *mutation != Mutation::CopiedTrial) {
            assert_ne!(of(mutation).digest, old.digest, "{mutation:?}");
        }
        assert!(faulty(&old, Mutation::CopiedTrial).is_err());
    }

    #[test]
    fn points_are_taken_from_those_that_are_measured() {
        let taken = |measured: [u64; 3], count: u64| {
            let mut sums = measured.map(|kept| Sum { counts: [kept, 0, 7], ..Sum::default() });
            no_longer_measured(sums.iter_mut().collect(), count, 1).unwrap();
            sums.map(|sum| sum.counts)
        };
        assert_eq!(taken([2, 0, 5], 4), [[0, 2, 7], [0, 0, 7], [3, 2, 7]]);
        assert_eq!(taken([2, 0, 5], 0), [[2, 0, 7], [0, 0, 7], [5, 0, 7]]);
        assert_eq!(taken([1, 0, 2], 9), [[0, 1, 7], [0, 0, 7], [0, 2, 7]], "no more than there are");
        let sum = |kept| Sum { counts: [kept, 0, 0], covariance: [1.0, 2.0, 3.0], ..Sum::default() };
        let mut one_of_two = [sum(0), sum(4)];
        scaled(one_of_two.iter_mut().collect(), 4.0).unwrap();
        assert_eq!(one_of_two[1].covariance, [4.0, 8.0, 12.0]);
        assert!(scaled(vec![&mut sum(0)], 4.0).is_err());
    }

    #[test]
    fn the_first_target_with_a_measured_point_gets_the_one_that_is_no_number() {
        let mut old = sums();
        old.targets.insert("0".into(), Sum { counts: [0, 1, 0], ..Sum::default() });
        let new = faulty(&old, Mutation::OneNan).unwrap();
        let counts = |name: &str| (new.targets[name].counts, new.targets[name].nans);
        assert_eq!([counts("0"), counts("a"), counts("b")], [([0, 1, 0], 0), ([29, 3, 0], 1), ([40, 0, 0], 0)]);
    }

    #[test]
    fn faults_in_sweeps_are_counted_by_sweep() {
        // Two cells of three points; no point is lost, and dx is dy. The third cell has no point that is measured.
        let with = |kept: bool| {
            let entry = move |k: f64| if kept { measured([0.1 * k; 2], None) } else { NO_CORNER };
            holding(Coordinates::Errors, method((0..3).map(move |trial| (trial, "a", entry(trial as f64)))))
        };
        let mut cells = Cells::new("f/s", "", 7, Coordinates::Errors);
        [true, true, false].into_iter().zip(["x", "y", "z"]).for_each(|(kept, label)| cells.add(label, &with(kept)));
        let all = sweep_power(&[cells]);
        assert_eq!(all.iter().map(|outcome| outcome.mutation).collect::<Vec<_>>(), Mutation::ALL.map(|(mutation, _)| mutation));
        let of = |mutation| {
            let found = all.iter().find(|outcome| outcome.mutation == mutation).unwrap();
            assert_eq!(found.scenario, "f/s");
            (found.tried, found.caught, found.untested.clone())
        };
        let none = ("no point is measured", 1);
        assert_eq!(of(Mutation::DoubledNoise), (2, [2, 2], vec![none]));
        assert_eq!(of(Mutation::OneNan), (2, [2, 2], vec![none]));
        // One of three is not more than one: a change.
        assert_eq!(of(Mutation::TenthRejected), (2, [2, 0], vec![none]));
        assert_eq!(of(Mutation::LostDoubled), (0, [0, 0], vec![("no point is lost", 3)]));
        assert_eq!(of(Mutation::Swapped), (0, [0, 0], vec![("the results stay the same", 3)]));
    }

    #[test]
    fn nothing_can_be_taken_from_nothing() {
        let mut old = sums();
        old.targets.values_mut().for_each(|sum| *sum = Sum { counts: [0, 0, 5], ..Sum::default() });
        assert!(Mutation::ALL.iter().all(|(mutation, _)| faulty(&old, *mutation).is_err()));
    }
}
