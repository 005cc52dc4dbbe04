//! Fewer trials than a test needs: the figures themselves are compared, within a stated growth. Changed numbers are never left unjudged.

use super::finding::{Finding, Verdict};
use super::judge::bounded;
use super::pairs::{Item, Pairs};
use super::point_entry::Entry;

/// By how much, as a fraction, a root mean square may grow without being worse where no test can tell.
pub const FEW_GROWTH: f64 = 0.01;

/// What became worse: points that are measured no more, a root mean square error that grew by more than [`FEW_GROWTH`].
pub(super) fn few(scenario: &str, label: &str, pairs: &Pairs) -> Vec<Finding> {
    let count = |of: fn(&Item) -> &Entry| pairs.items.iter().filter(|item| of(item).is_kept()).count() as f64;
    let rms = |of: fn(&Item) -> &Entry| {
        let squares: Vec<f64> = pairs.items.iter().filter_map(|item| bounded(of(item))).map(|[x, y]| x * x + y * y).collect();
        (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
    };
    let figures = |of: fn(&Item) -> &Entry| (count(of), rms(of));
    let ((kept, old), (keeps, new)) = (figures(|item| &item.old), figures(|item| &item.new));
    let trials = pairs.trials;
    let fails = |metric, message: String, [a, b]: [f64; 2]| Finding::new(Verdict::Fails, scenario, label, metric, message).figures(a, b);
    let mut findings = Vec::new();
    if keeps < kept {
        findings.push(fails(
            "measured",
            format!("fewer points are measured; {trials} trials are too few to call that chance"),
            [kept, keeps],
        ));
    }
    if new > old * (1.0 + FEW_GROWTH) + super::TOLERANCE {
        let message = format!("worse by more than {} %; {trials} trials are too few for a test", 100.0 * FEW_GROWTH);
        findings.push(fails("rms_error", message, [old, new]));
    }
    findings
}
