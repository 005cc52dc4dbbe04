//! A test by lengths in words.

use calibench_accept::basis::OF_LENGTHS;
use calibench_accept::lengths::Together;
use calibench_accept::{Decision, LengthAcceptance, LengthTest};

use super::{basis_words, rule_words, with_unit};
use crate::markdown::{MarkdownTable, fixed, plain, signed};

/// The decision and why, the errors together, and a table of all lengths; `unit` is that of the lengths.
pub fn of_lengths(test: &LengthTest<'_>, found: &LengthAcceptance, unit: Option<&str>) -> String {
    let mut text = format!("{}\n{}\n", headline(test, found, unit), rule_words(test.rule));
    for unmet in &found.unmet {
        text.push_str(&format!("not a whole test: {unmet}\n"));
    }
    if let Some(together) = &found.together {
        text.push_str(&together_words(test, found, together, unit));
    }
    for assumed in &found.assumed {
        text.push_str(&format!("note: {assumed}\n"));
    }
    text.push_str(&format!("\n{}\n{}", table(test, found), basis_words(&OF_LENGTHS)));
    text
}

fn headline(test: &LengthTest<'_>, found: &LengthAcceptance, unit: Option<&str>) -> String {
    let decisions = || found.results.iter().filter_map(|result| result.outcome.decision());
    let count = |wanted| decisions().filter(|decision| *decision == wanted).count();
    let (all, limit) = (decisions().count(), with_unit(&test.limit.to_string(), unit));
    let word = found.decision.words();
    match found.decision {
        Decision::Pass => format!("{word}: all {all} tested lengths are within the limit {limit}"),
        Decision::Fail => format!("{word}: {} of {all} tested lengths are beyond the limit {limit}", count(Decision::Fail)),
        Decision::CannotTell => match count(Decision::CannotTell) {
            0 => format!("{word}: all {all} tested lengths are within the limit {limit}, but the test is not whole"),
            near => format!("{word}: {near} of {all} tested lengths are too near the limit {limit} for what is known of them"),
        },
    }
}

fn together_words(test: &LengthTest<'_>, found: &LengthAcceptance, together: &Together, unit: Option<&str>) -> String {
    let (error, place) = together.largest;
    let (length, result) = (&test.lengths[place], &found.results[place]);
    let [from, to] = &length.targets;
    let mut text = format!(
        "largest error  {}, of {} on line {}, {from} to {to}; limit {}\nRMS            {}\n",
        with_unit(&plain(error), unit),
        with_unit(&plain(length.calibrated), unit),
        length.line,
        with_unit(&plain(result.limit), unit),
        with_unit(&plain(together.rms), unit),
    );
    if let Some((scale, sigma)) = together.scale {
        let how = if scale < 0.0 { "short" } else { "long" };
        let [scale, sigma] = [scale.abs(), sigma].map(|number| 1e6 * number);
        text.push_str(&format!("scale          {} ppm too {how}, standard deviation {} ppm\n", plain(scale), plain(sigma)));
    }
    text.push_str(&format!(
        "together       all errors are within their limits at a probability of {:.4}, if the reference's errors are independent\n",
        together.probability
    ));
    text
}

/// Decimals that show three digits of the least limit.
fn decimals(found: &LengthAcceptance) -> usize {
    let least = found.results.iter().map(|result| result.limit).filter(|limit| *limit > 0.0).fold(f64::INFINITY, f64::min);
    if least.is_finite() { (2.0 - least.log10().floor()).clamp(0.0, 9.0) as usize } else { 4 }
}

fn table(test: &LengthTest<'_>, found: &LengthAcceptance) -> String {
    let digits = decimals(found);
    let mut table = MarkdownTable::new(&["line", "from", "to", "calibrated", "sigma", "measured", "error", "limit", "p", "decision"]);
    for (length, result) in test.lengths.iter().zip(&found.results) {
        let number = |value: Option<f64>| value.map_or_else(String::new, |value| fixed(value, digits));
        table.row([
            length.line.clone(),
            length.targets[0].clone(),
            length.targets[1].clone(),
            fixed(length.calibrated, digits),
            plain(length.sigma),
            number(length.measured),
            result.error.map_or_else(String::new, |error| signed(error, digits)),
            fixed(result.limit, digits),
            result.probability.map_or_else(String::new, |p| format!("{p:.4}")),
            result.outcome.words().to_owned(),
        ]);
    }
    table.render()
}
