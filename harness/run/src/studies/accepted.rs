//! Whether what was measured in a trial keeps what `[acceptance]` asks, decided as `accept` decides it.

use calibench_accept::points::{Classes, PointTest};
use calibench_accept::{Decision, LengthTest};
use calibench_calibrate::AdjustedLength;
use calibench_model::{ControlRow, MeasuredDistance, TestLength};
use calibench_random::{Key, Purpose, stream};
use calibench_records::figures::Quantity;
use calibench_records::results::Figure;
use calibench_scenario::studies::acceptance::TestLines;
use rand_distr::{Distribution, StandardNormal};

use super::told::Trial;

/// The lengths as they are calibrated in the trial of `key`: with an error of their own each, nothing measured yet.
pub(super) fn calibrated(plan: &TestLines, trial: &Trial<'_>, key: Key<'_>) -> Vec<TestLength> {
    let of = |(line, between): (usize, [usize; 2])| {
        let targets = between.map(|target| trial.subject.field.targets[target].id.clone());
        let [from, to] = targets.each_ref().map(|name| trial.target(name));
        let name = format!("calibrated {} {}", targets[0], targets[1]);
        let error: f64 = StandardNormal.sample(&mut stream(Key { view: "", target: &name, ..key }, Purpose::Control));
        let calibrated = (to? - from?).norm() + plan.sigma * error;
        Some(TestLength { line: format!("{}", line + 1), targets, calibrated, sigma: plan.sigma, measured: None })
    };
    plan.lengths().filter_map(of).collect()
}

/// What becomes of `tested` lengths, of which `measured` has those that the network gives; `scale` are the distances that gave its scale.
pub(super) fn lengths(
    plan: &TestLines,
    mut tested: Vec<TestLength>,
    measured: &[AdjustedLength],
    scale: &[MeasuredDistance],
    unit: &'static str,
) -> Vec<Figure> {
    for length in &mut tested {
        length.measured = measured.iter().find(|found| found.targets == length.targets).map(|found| found.value);
    }
    let test = LengthTest { lengths: &tested, limit: plan.limit, rule: plan.rule, diagonal: Some(plan.diagonal), scale: Some(scale) };
    let found = test.run();
    let mut figures = decided(found.decision);
    if let Some(together) = &found.together {
        let over_limit = found
            .results
            .iter()
            .filter(|result| result.outcome.decision().is_some())
            .filter_map(|result| Some(result.error?.abs() / result.limit));
        figures.push(Figure::plain(Quantity::LargestLengthError, together.largest.0.abs(), unit));
        figures.push(Figure::plain(Quantity::LargestOverLimit, over_limit.fold(0.0, f64::max), ""));
        figures.push(Figure::plain(Quantity::RmsOfLengthErrors, together.rms, unit));
    }
    figures
}

/// What becomes of check points, measured and as they were surveyed.
pub(super) fn points(classes: Classes, surveyed: &[ControlRow], measured: &[ControlRow]) -> Vec<Figure> {
    let test = PointTest { surveyed, measured, classes, survey: None };
    test.run().map_or_else(|_| Vec::new(), |found| decided(found.decision))
}

fn decided(decision: Decision) -> Vec<Figure> {
    let each = [
        (Quantity::AcceptancePass, Decision::Pass),
        (Quantity::AcceptanceFail, Decision::Fail),
        (Quantity::AcceptanceCannotTell, Decision::CannotTell),
    ];
    each.map(|(quantity, what)| Figure::plain(quantity, f64::from(u8::from(decision == what)), "")).into()
}

#[cfg(test)]
mod tests {
    use calibench_records::results::find;

    use super::*;

    /// Forty points that are off by 3 and 4 in the plane and 12 in height: 5, 12 and 13; thirty are enough, 29 are not.
    #[test]
    fn check_points_are_decided_by_their_root_mean_squares() {
        let row = |place: usize, off: [f64; 3]| ControlRow::new(place.to_string(), [0, 1, 2].map(|axis| place as f64 + off[axis]));
        let decided = |count: usize, classes: Classes, sigma: f64| {
            let surveyed: Vec<ControlRow> =
                (0..count).map(|place| ControlRow { sigmas: Some([sigma; 3]), ..row(place, [0.0; 3]) }).collect();
            let measured: Vec<ControlRow> =
                (0..count).map(|place| row(place, [3.0, if place % 2 == 0 { 4.0 } else { -4.0 }, -12.0])).collect();
            let figures = points(classes, &surveyed, &measured);
            [Quantity::AcceptancePass, Quantity::AcceptanceFail, Quantity::AcceptanceCannotTell]
                .map(|quantity| find(&figures, quantity).unwrap().value)
        };
        let none = Classes::default();
        let [pass, fail, cannot_tell] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(decided(40, Classes { horizontal: Some(5.1), ..none }, 0.0), pass);
        assert_eq!(decided(40, Classes { horizontal: Some(4.9), ..none }, 0.0), fail);
        assert_eq!(decided(40, Classes { vertical: Some(12.1), spatial: Some(12.9), ..none }, 0.0), fail);
        // The survey's own error of 1 on each axis is added: sqrt(5^2 + 2).
        assert_eq!(decided(40, Classes { horizontal: Some(5.1), ..none }, 1.0), fail);
        assert_eq!(decided(29, Classes { horizontal: Some(9.0), ..none }, 0.0), cannot_tell);
        assert!(points(none, &[], &[]).is_empty());
    }
}
