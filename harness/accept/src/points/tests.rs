use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::*;

/// Residuals of seven check points, m, with the standard deviations that are printed below them.
///
/// Source: Abdullah 2014, PE&RS 80(5), 397, table 3 and step 2.
const PUBLISHED: [[f64; 3]; 7] = [
    [-0.060, 0.080, 0.055],
    [0.100, -0.045, -0.006],
    [-0.060, 0.080, -0.017],
    [-0.112, 0.007, 0.042],
    [-0.120, 0.150, -0.011],
    [-0.100, -0.045, 0.013],
    [-0.060, 0.080, 0.048],
];
const DEVIATIONS: [f64; 3] = [0.075, 0.073, 0.030];

fn points(errors: &[[f64; 3]], sigmas: Option<[f64; 3]>) -> (Vec<ControlRow>, Vec<ControlRow>) {
    let at = |place: usize| [10.0 * place as f64, 500.0, 20.0];
    let surveyed = |place: usize| ControlRow { sigmas, ..ControlRow::new(format!("p{place}"), at(place)) };
    let measured = |(place, error): (usize, &[f64; 3])| {
        let at = at(place);
        ControlRow::new(format!("p{place}"), [0, 1, 2].map(|axis| at[axis] + error[axis]))
    };
    ((0..errors.len()).map(surveyed).collect(), errors.iter().enumerate().map(measured).collect())
}

fn run(errors: &[[f64; 3]], classes: Classes, survey: Option<Survey>) -> PointAcceptance {
    let (surveyed, measured) = points(errors, None);
    PointTest { surveyed: &surveyed, measured: &measured, classes, survey }.run().unwrap()
}

#[test]
fn published_residuals_have_their_published_scatter() {
    let found = run(&PUBLISHED, Classes::default(), None);
    for (axis, printed) in found.axes.iter().zip(DEVIATIONS) {
        let deviation = axis.deviation.unwrap();
        assert!((deviation - printed).abs() <= 0.000_5 + 1e-9, "{deviation} and {printed}");
        // By hand: n squares are n times that of the mean and n - 1 variances.
        let squares = axis.mean * axis.mean + 6.0 / 7.0 * deviation * deviation;
        assert!((axis.rmse - squares.sqrt()).abs() < 1e-12);
    }
    assert_eq!((found.too_few, found.decision), (Some(TooFew(7)), Decision::CannotTell));
    assert_eq!(found.remarks, [Remark::SurveyUntold(7)]);
}

/// By hand: errors of 3, 4 and 12 cm in every point, those of the survey 1.2 and 5 cm: 5, 12 and 13 of the points, 5.142, 13 and 13.978 with the survey.
#[test]
fn accuracies_are_sums_of_squares_with_the_survey() {
    let errors: Vec<[f64; 3]> = (0..30).map(|i| if i % 2 == 0 { [0.03, 0.04, 0.12] } else { [-0.03, -0.04, -0.12] }).collect();
    let survey = Some(Survey { horizontal: 0.012, vertical: 0.05 });
    let classes =
        |horizontal, vertical, spatial| Classes { horizontal: Some(horizontal), vertical: Some(vertical), spatial: Some(spatial) };
    let found = run(&errors, classes(0.052, 0.131, 0.14), survey);
    for (accuracy, (of_points, total)) in found.accuracies.iter().zip([(0.05, 0.051_420), (0.12, 0.13), (0.13, 0.139_800)]) {
        assert!((accuracy.of_points - of_points).abs() < 1e-9 && (accuracy.total - total).abs() < 1e-6, "{accuracy:?}");
        assert_eq!(accuracy.decision, Some(Decision::Pass));
        assert!(accuracy.interval[0] < accuracy.total && accuracy.total < accuracy.interval[1]);
    }
    assert_eq!(found.decision, Decision::Pass);
    // Without the survey's error the horizontal class would be met still at 0.05; with it no longer.
    for (class, with, without) in [(0.051, Decision::Fail, Decision::Pass), (0.049, Decision::Fail, Decision::Fail)] {
        let classes = Classes { horizontal: Some(class), ..Classes::default() };
        assert_eq!((run(&errors, classes, survey).decision, run(&errors, classes, None).decision), (with, without), "{class}");
        // A point less cannot be told, good or bad.
        assert_eq!(run(&errors[1..], classes, survey).decision, Decision::CannotTell);
    }
    // The survey's errors from its table: 12 mm from x and y, 50 mm of z.
    let (surveyed, measured) = points(&errors, Some([0.012 / 2.0_f64.sqrt(), 0.012 / 2.0_f64.sqrt(), 0.05]));
    let table = PointTest { surveyed: &surveyed, measured: &measured, classes: Classes::default(), survey: None }.run().unwrap();
    assert!((table.accuracies[2].total - 0.139_800).abs() < 1e-6 && table.remarks.is_empty(), "{table:?}");
    assert_eq!(table.decision, Decision::CannotTell, "no class was asked for");
}

#[test]
fn what_is_missing_biased_or_close_is_said() {
    let mut errors = vec![[0.03, 0.0, 0.01]; 31];
    errors.iter_mut().step_by(2).for_each(|error| *error = [-0.01, 0.0, -0.01]);
    let (surveyed, measured) = points(&errors, Some([0.001; 3]));
    let classes = Classes { horizontal: Some(0.03), vertical: Some(0.0101), spatial: None };
    let found = PointTest { surveyed: &surveyed, measured: &measured[..30], classes, survey: None }.run().unwrap();
    assert_eq!((found.missing.as_slice(), found.decision), (&["p30".to_owned()][..], Decision::Pass));
    let said: Vec<String> = found.remarks.iter().map(Remark::to_string).collect();
    assert_eq!(said.len(), 3, "{said:?}");
    assert!(said[0].starts_with("1 check points were not measured"));
    assert!(said[1].starts_with("the mean error of X, 0.0100, is 33 % of the class"), "{said:?}");
    assert!(said[2].contains("of the vertical accuracy holds its class"));
    assert_eq!(PointTest { surveyed: &surveyed, measured: &[], classes, survey: None }.run(), Err(NoPoints));
}

/// Of 95 in 100 drawn tests the interval holds the root mean square that the errors were drawn with, where axes are alike and where they are not.
#[test]
fn intervals_hold_the_truth_in_95_of_100() {
    const TESTS: usize = 2000;
    let mut random = ChaCha8Rng::seed_from_u64(2023);
    for sigmas in [[1.0_f64, 1.0, 1.0], [1.0, 0.2, 3.0]] {
        let mut held = [0_usize; 3];
        let truths = [sigmas[0].hypot(sigmas[1]), sigmas[2], sigmas[0].hypot(sigmas[1]).hypot(sigmas[2])];
        for _ in 0..TESTS {
            let errors: Vec<[f64; 3]> =
                (0..30).map(|_| sigmas.map(|sigma| sigma * Distribution::<f64>::sample(&StandardNormal, &mut random))).collect();
            let found = run(&errors, Classes::default(), None);
            for ((accuracy, truth), held) in found.accuracies.iter().zip(truths).zip(&mut held) {
                *held += usize::from((accuracy.interval[0]..=accuracy.interval[1]).contains(&truth));
            }
        }
        for held in held {
            let share = held as f64 / TESTS as f64;
            assert!((share - 0.95).abs() < 0.02, "{sigmas:?}: {share}");
        }
    }
}
