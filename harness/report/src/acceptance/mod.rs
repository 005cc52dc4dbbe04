//! What a test of acceptance found, in words and as a picture.

mod lengths;
mod picture;
mod points;

use calibench_accept::Rule;
use calibench_accept::basis::Basis;

pub use lengths::of_lengths;
pub use picture::errors_over_length;
pub use points::of_points;

/// How it was decided.
fn rule_words(rule: Rule) -> String {
    match rule {
        Rule::Probability(least) => format!("decided at a probability of {} % with the reference's uncertainty", 100.0 * least),
        Rule::GuardBand(0.0) => "decided without the reference's uncertainty".to_owned(),
        Rule::GuardBand(factor) => format!("decided with a guard band of {factor} standard uncertainties of the reference"),
    }
}

/// A number with its unit, if that is told.
fn with_unit(number: &str, unit: Option<&str>) -> String {
    unit.map_or_else(|| number.to_owned(), |unit| format!("{number} {unit}"))
}

/// Which standards were followed, and that it was by what others say of them.
fn basis_words(basis: &[Basis]) -> String {
    let mut standards: Vec<&str> = basis.iter().map(|one| one.standard).collect();
    standards.dedup();
    format!("after {}, as others publish them: not checked against the standards' own text\n", standards.join("; "))
}
