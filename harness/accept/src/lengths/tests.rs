use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::*;

/// Seven lines of five lengths, 200 to 1000 mm, each measured as `error` says of its place and length.
fn lengths(sigma: f64, error: impl Fn(usize, f64) -> f64) -> Vec<TestLength> {
    let length = |place: usize| {
        let calibrated = 200.0 * (place % 5 + 1) as f64;
        TestLength {
            line: (place / 5 + 1).to_string(),
            targets: ["0".to_owned(), format!("{place}")],
            calibrated,
            sigma,
            measured: Some(calibrated + error(place, calibrated)),
        }
    };
    (0..35).map(length).collect()
}

/// 0.02 + 2e-5 L, at most 0.03, in a volume whose diagonal is 1500.
fn test(lengths: &[TestLength]) -> LengthTest<'_> {
    LengthTest { lengths, limit: "0.02,2e-5,0.03".parse().unwrap(), rule: Rule::DEFAULT, diagonal: Some(1500.0), scale: Some(&[]) }
}

#[test]
fn a_whole_test_within_its_limit_passes() {
    let all = lengths(0.001, |place, _| if place % 2 == 0 { 0.01 } else { -0.01 });
    let found = test(&all).run();
    assert_eq!((found.decision, found.unmet.as_slice(), found.assumed.as_slice()), (Decision::Pass, &[][..], &[][..]));
    // By hand: the limits of 200, 400, 600 mm and beyond.
    let limits: Vec<f64> = found.results[..5].iter().map(|result| result.limit).collect();
    for (limit, expected) in limits.iter().zip([0.024, 0.028, 0.03, 0.03, 0.03]) {
        assert!((limit - expected).abs() < 1e-15, "{limits:?}");
    }
    let together = found.together.unwrap();
    assert_eq!(together.count, 35);
    assert!((together.rms - 0.01).abs() < 1e-12 && together.probability > 0.999_999);
}

#[test]
fn one_length_beyond_fails_and_one_too_near_cannot_be_told() {
    let of = |error: f64| {
        let all = lengths(0.002, |place, _| if place == 7 { error } else { 0.0 });
        test(&all).run()
    };
    // Of 600 mm: the limit is 0.03, the band 0.0033.
    for (error, decision) in
        [(0.0266, Decision::Pass), (-0.027, Decision::CannotTell), (0.033, Decision::CannotTell), (-0.034, Decision::Fail)]
    {
        let found = of(error);
        assert_eq!(found.decision, decision, "{error}");
        assert_eq!(found.results[7].outcome, Outcome::Tested(decision));
        let (largest, place) = found.together.unwrap().largest;
        assert!((largest - error).abs() < 1e-9 && place == 7);
    }
}

#[test]
fn what_is_no_whole_test_cannot_be_passed_but_failed() {
    let all = lengths(0.001, |_, _| 0.0);
    let of = |lengths: &[TestLength], diagonal| LengthTest { diagonal, ..test(lengths) }.run();
    let fewer = of(&all[..34], Some(1500.0));
    assert_eq!((fewer.decision, fewer.unmet.as_slice()), (Decision::CannotTell, &[Unmet::Lines(6)][..]));
    let larger = of(&all, Some(1501.0));
    assert_eq!(
        (larger.decision, larger.unmet.as_slice()),
        (Decision::CannotTell, &[Unmet::Longest { longest: 1000.0, diagonal: 1501.0 }][..])
    );
    assert_eq!(
        larger.unmet[0].to_string(),
        "the longest tested length, 1000, is 66.6 % of the volume's diagonal of 1501; expected two thirds at least"
    );
    let untold = of(&all, None);
    assert_eq!((untold.decision, untold.assumed.as_slice()), (Decision::Pass, &[Assumed::VolumeUntold][..]));
    let mut missing = all.clone();
    missing.push(TestLength { measured: None, ..all[0].clone() });
    let missing = of(&missing, None);
    assert_eq!((missing.decision, missing.unmet.as_slice()), (Decision::CannotTell, &[Unmet::NotMeasured(1)][..]));
    let failed = of(&lengths(0.001, |place, _| if place == 0 { 1.0 } else { 0.0 })[..3], None);
    assert_eq!(failed.decision, Decision::Fail);
    let none = of(&[], None);
    assert_eq!((none.decision, none.together), (Decision::CannotTell, None));
}

#[test]
fn lengths_that_gave_the_scale_are_no_test() {
    let all = lengths(0.0, |_, _| 0.0);
    let bar = MeasuredDistance { targets: ["4".into(), "0".into()], value: 1000.0, sigma: 0.01 };
    let of = |scale| LengthTest { scale, ..test(&all) }.run();
    let found = of(Some(std::slice::from_ref(&bar)));
    assert_eq!(found.results[4].outcome, Outcome::GaveScale);
    assert_eq!((found.decision, found.unmet.as_slice()), (Decision::CannotTell, &[Unmet::Lines(6)][..]));
    assert_eq!(found.assumed, [Assumed::Exact(34), Assumed::GaveScale(1)]);
    assert_eq!(of(None).assumed, [Assumed::Exact(35), Assumed::ScaleUntold]);
}

/// By hand: errors that grow by 30 ppm, all of the same size otherwise.
#[test]
fn a_wrong_scale_is_seen_in_the_errors() {
    let all = lengths(0.0, |_, length| 3e-5 * length);
    let (scale, sigma) = test(&all).run().together.unwrap().scale.unwrap();
    assert!((scale - 3e-5).abs() < 1e-12 && sigma < 1e-9, "{scale} {sigma}");
    // The scatter of the errors is that of the scale times the root of the sum of squared lengths: 7 * 200^2 * 55.
    let all = lengths(0.0, |place, _| if place / 5 % 2 == 0 { 0.01 } else { -0.01 });
    let (_, sigma) = test(&all).run().together.unwrap().scale.unwrap();
    let by_hand = (35.0 * 1e-4 - (0.01 * 3000.0_f64).powi(2) / (7.0 * 4e4 * 55.0)) / 34.0 / (7.0 * 4e4 * 55.0);
    assert!((sigma / by_hand.sqrt() - 1.0).abs() < 1e-6, "{sigma} {}", by_hand.sqrt());
}

/// Simulated lengths: the reference's errors are drawn, so that the true error of each is the found one less that of the reference. Of all tests in which the
/// probability that all keep their limits is p, a share of p keeps them.
#[test]
fn whole_tests_keep_their_limits_as_often_as_the_probability_says() {
    const TESTS: usize = 400;
    let (sigma, mut random) = (0.004, ChaCha8Rng::seed_from_u64(35));
    let mut draw = || Distribution::<f64>::sample(&StandardNormal, &mut random);
    // Of all tests, and of those that pass: what was expected, its variance, and what came.
    let (mut all, mut of_passed, mut passed) = ([0.0; 3], [0.0; 3], 0);
    for _ in 0..TESTS {
        let errors: Vec<f64> = (0..35).map(|_| 0.009 * draw()).collect();
        let drawn = lengths(sigma, |place, _| errors[place]);
        let found = test(&drawn).run();
        let p = found.together.unwrap().probability;
        // Truths given what was found.
        let keeps = found.results.iter().zip(&errors).all(|(result, error)| (error + sigma * draw()).abs() <= result.limit);
        let is_passed = found.decision == Decision::Pass;
        passed += usize::from(is_passed);
        for sums in std::iter::once(&mut all).chain(is_passed.then_some(&mut of_passed)) {
            *sums = [sums[0] + p, sums[1] + p * (1.0 - p), sums[2] + f64::from(keeps)];
        }
    }
    for [expected, variance, kept] in [all, of_passed] {
        assert!((kept - expected).abs() <= 4.0 * variance.sqrt(), "{kept} of {expected}");
    }
    assert!((TESTS / 20..TESTS).contains(&passed), "{passed}");
}
