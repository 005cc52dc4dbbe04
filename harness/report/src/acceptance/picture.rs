//! The errors of lengths, over length.

use calibench_accept::lengths::Outcome;
use calibench_accept::{Decision, LengthAcceptance, LengthTest};

use super::with_unit;
use crate::Canvas;
use crate::markdown::plain;
use crate::plot::{Axis, Plot, Said, Shape};

/// Places along a limit's line.
const STEPS: usize = 120;

/// How an outcome is drawn: colour, symbol.
const fn look(outcome: Outcome) -> (usize, Shape) {
    match outcome {
        Outcome::Tested(Decision::Pass) => (1, Shape::Circle),
        Outcome::Tested(Decision::CannotTell) => (4, Shape::Diamond),
        Outcome::Tested(Decision::Fail) => (0, Shape::Cross),
        Outcome::GaveScale => (3, Shape::Plus),
        Outcome::NotMeasured => (2, Shape::Triangle),
    }
}

/// The error of each length over the calibrated one, with two standard uncertainties of that to both sides, between the limits; `unit` is that of the lengths.
pub fn errors_over_length(test: &LengthTest<'_>, found: &LengthAcceptance, unit: Option<&str>) -> Canvas {
    let title = |what: &str| unit.map_or_else(|| what.to_owned(), |unit| format!("{what}, {unit}"));
    let of = || test.lengths.iter().zip(&found.results);
    let longest = of().map(|(length, _)| length.calibrated).fold(0.0, f64::max);
    let sizes = of().map(|(length, result)| result.limit.max(result.error.unwrap_or(0.0).abs() + 2.0 * length.sigma));
    let high = 1.1 * sizes.fold(f64::MIN_POSITIVE, f64::max);
    let right = if longest > 0.0 { 1.05 * longest } else { 1.0 };
    let (x, y) = (Axis::linear(&title("calibrated length"), [0.0, right]), Axis::linear(&title("error"), [-high, high]));
    let mut plot = Plot::new("errors-over-length", &format!("Errors of lengths: {}", found.decision.words()), x, y, 380.0);
    plot.series(5, None, &[""]);
    for side in [-1.0, 1.0] {
        let at = |step: usize| {
            let length = right * step as f64 / STEPS as f64;
            (length, side * test.limit.at(length))
        };
        plot.line(&(0..=STEPS).map(at).collect::<Vec<_>>(), &Said::default());
    }
    let outcomes = [Decision::Pass, Decision::CannotTell, Decision::Fail].map(Outcome::Tested).into_iter().chain([Outcome::GaveScale]);
    for outcome in outcomes {
        let (colour, shape) = look(outcome);
        let mut lengths = of().filter(|(_, result)| result.outcome == outcome).peekable();
        if lengths.peek().is_none() {
            continue;
        }
        plot.series(colour, None, &["line", "from", "to", "calibrated", "error", "limit"]);
        plot.legend(colour, shape, outcome.words(), false);
        for (length, result) in lengths {
            let Some(error) = result.error else { continue };
            let numbers = [length.calibrated, error, result.limit].map(plain);
            let names = [&length.line, &length.targets[0], &length.targets[1]].map(Clone::clone);
            let said = Said::of(names.into_iter().chain(numbers));
            if length.sigma > 0.0 {
                plot.whisker(length.calibrated, [error - 2.0 * length.sigma, error + 2.0 * length.sigma], &Said::default());
            }
            plot.symbol(shape, (length.calibrated, error), &said);
        }
    }
    let limit = with_unit(&test.limit.to_string(), unit);
    plot.picture(&format!("limit {limit}; bars: two standard uncertainties of the reference"))
}
