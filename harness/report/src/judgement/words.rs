//! Figures and names in sentences.

use calibench_records::judgement::Estimate;

use crate::plain;

/// A figure with its interval.
pub(super) fn interval(estimate: &Estimate) -> String {
    let (low, high) = estimate.interval;
    format!("{} px RMS (95 % over views {} to {})", plain(estimate.value), plain(low), plain(high))
}

pub(super) fn chance(p: f64) -> String {
    if p < 0.001 { "p < 0.001".into() } else { format!("p = {p:.3}") }
}

pub(super) fn listed(names: &[String]) -> String {
    match names {
        [] => "none".into(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
