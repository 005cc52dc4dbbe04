//! Halves as a test of the sigmas: fair to those that are right.

use calibench_records::judgement::HONEST;
use rayon::prelude::*;
use statrs::distribution::{Binomial, ChiSquared, ContinuousCDF, DiscreteCDF};

use super::*;

const TRIALS: u64 = 400;

/// The sum of many trials' chi-squares beside its distribution: two-sided p-value.
fn p_of(sum: f64, freedom: f64) -> f64 {
    let lower = ChiSquared::new(freedom).unwrap().cdf(sum);
    2.0 * lower.min(1.0 - lower)
}

#[test]
fn with_gaussian_noise_halves_differ_as_predicted() {
    let (mut chi, mut freedom, mut square, mut predicted) = (0.0, 0.0, 0.0, 0.0);
    let (mut jackknife, mut sigma, mut alarms, mut over) = (0.0, 0.0, 0, Vec::new());
    let trials = (0..TRIALS).into_par_iter().map(|trial| judged(&material("honest", trial, 12, &[0.1]), &options(&["opencv4"], 3)));
    for (rows, summary) in trials.collect::<Vec<_>>() {
        let cell = &summary.cells[0];
        // Splits of one trial depend on each other: the first stands for all.
        let first = rows.iter().find(|row| &*row.measure == "split_test").unwrap();
        let modes = first.count.unwrap() as f64;
        (chi, freedom) = (chi + first.value.unwrap() * modes, freedom + modes);
        let first = rows.iter().find(|row| &*row.measure == "split").unwrap();
        (square, predicted) = (square + first.value.unwrap().powi(2), predicted + first.sigma.unwrap().powi(2));
        let principal = cell.principal.as_ref().unwrap();
        jackknife += principal.jackknife().unwrap().map(|s| s * s).iter().sum::<f64>();
        sigma += principal.all.map(|(_, s)| s * s).iter().sum::<f64>();
        let predicted = cell.predicted.unwrap();
        over.push(predicted.by_views.unwrap() / predicted.formal);
        alarms += u64::from(cell.split.unwrap().p < HONEST);
    }
    eprintln!("chi-square / freedom {:.3} of {freedom}, {alarms} alarms", chi / freedom);
    // About 2000 degrees of freedom: sigmas that are 10 % off make the sum 21 % off, 6 of its standard deviations. False alarm 1e-3.
    assert!(p_of(chi, freedom) > 1e-3, "{}", chi / freedom);
    assert!(p_of(chi / 1.21, freedom) < 1e-3 && p_of(chi * 1.21, freedom) < 1e-3, "the same test refuses sigmas that are 10 % off");
    // Over the frame the corners rule, with few degrees of freedom a trial.
    let over_frame = (square / predicted).sqrt();
    assert!((over_frame - 1.0).abs() < 0.2, "{over_frame}");
    let jackknife = (jackknife / sigma).sqrt();
    eprintln!("over the frame {over_frame:.3}, jackknife / sigma {jackknife:.3}");
    assert!((jackknife - 1.0).abs() < 0.15, "{jackknife}");
    // The median: where one view alone holds a corner of the frame, leaving it out says far too much, and the jackknife is never too small in the mean
    // (Efron & Stein 1981).
    over.sort_by(f64::total_cmp);
    let by_views = over[over.len() / 2];
    eprintln!("over the frame by leaving views out / sigma {by_views:.3}");
    assert!((by_views - 1.0).abs() < 0.2, "{by_views}");
    // Twice the median is a bound: alarms are at most as frequent as stated. False alarm 1e-3.
    let limit = Binomial::new(HONEST, TRIALS).unwrap().inverse_cdf(0.999);
    assert!(alarms <= limit, "{alarms} alarms, at most {limit}");
}
