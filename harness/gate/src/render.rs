//! Findings as text.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde::Serialize;

use super::ALPHA;
use super::finding::{Finding, Rules, Verdict};

/// How many findings of one method and metric are listed before the rest is only counted.
const LISTED: usize = 10;
/// The headings of the table.
const HEADINGS: [&str; 8] = ["scenario", "method", "target", "metric", "baseline", "now", "change", "p"];

/// What a check compared: without it, a green line says nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Tally {
    /// Scenarios with their baselines, each cell of a sweep counted as one.
    pub scenarios: usize,
    /// Methods of these that both have.
    pub methods: usize,
    /// Methods whose numbers are not those that were blessed.
    pub changed: usize,
    /// Blessed points.
    pub points: usize,
    /// Figures of adjustments.
    pub figures: usize,
    /// Cells of published tables.
    pub cells: usize,
    /// Ceilings.
    pub ceilings: usize,
}

impl Tally {
    fn words(self) -> String {
        let Self { scenarios, methods, changed, points, figures, cells, ceilings } = self;
        format!(
            "compared: {scenarios} scenarios and cells of sweeps, {methods} methods, {points} points, {figures} figures of adjustments, {cells} published cells, {ceilings} ceilings; \
             {changed} methods have other numbers"
        )
    }
}

/// The findings of [`Check::conclude`](super::Check::conclude): a table of what fails, of what changed, of what is not blessed and of what informs, and
/// lines that sum up. The p-values are adjusted for all tests of their family.
pub fn render(findings: &[Finding], rules: Rules, tally: Tally) -> String {
    let mut text = String::new();
    let titles = [
        (Verdict::Fails, "Fails"),
        (Verdict::Changed, if rules.strict { "Changed without a bless: fails" } else { "Changed" }),
        (Verdict::Unblessed, if rules.locked { "Not blessed: fails" } else { "Not blessed" }),
        (Verdict::Informs, "For information"),
    ];
    for (verdict, title) in titles {
        let part: Vec<&Finding> = findings.iter().filter(|finding| finding.verdict == verdict).collect();
        if !part.is_empty() {
            // Writing to a String cannot fail.
            let _ = write!(text, "{title}\n\n{}\n", table(&part));
        }
    }
    format!("{text}{}\n{}", tally.words(), summary(findings, rules))
}

fn summary(findings: &[Finding], rules: Rules) -> String {
    let count = |verdict| findings.iter().filter(|finding| finding.verdict == verdict).count();
    let [changed, unblessed, informing] = [Verdict::Changed, Verdict::Unblessed, Verdict::Informs].map(count);
    let rest = format!("{changed} changed, {unblessed} not blessed, {informing} for information");
    let failing: Vec<&Finding> = findings.iter().filter(|finding| finding.fails_by(rules)).collect();
    if failing.is_empty() {
        return format!("The gate holds: nothing fails, {rest}.\n");
    }
    let mut methods: Vec<String> =
        failing.iter().map(|finding| format!("{} in {}", escaped(&finding.method), escaped(&finding.scenario))).collect();
    methods.sort();
    methods.dedup();
    let (count, methods) = (failing.len(), methods.join(", "));
    format!("The gate fails: {count} findings ({methods}); {rest}; family-wise error rate {ALPHA}.\n")
}

/// Says which scenarios were `left` to another check; nothing where none were.
pub fn not_tested(left: &[String]) -> String {
    let names = left.iter().map(|name| escaped(name)).collect::<Vec<_>>().join(", ");
    match left.len() {
        0 => String::new(),
        1 => format!("Not tested: {names}, which is left to `calibench check --nightly`.\n"),
        count => format!("Not tested: {count} scenarios that are left to `calibench check --nightly`: {names}.\n"),
    }
}

/// All findings, rules, the tally and what was `left` to another check as one JSON object.
pub fn json(findings: &[Finding], rules: Rules, tally: Tally, left: &[String]) -> String {
    let list: Vec<serde_json::Value> = findings.iter().map(|finding| entry(finding, rules)).collect();
    let holds = !findings.iter().any(|finding| finding.fails_by(rules));
    let all = serde_json::json!({
        "holds": holds, "strict": rules.strict, "locked": rules.locked, "family_wise_error_rate": ALPHA, "compared": tally, "not_tested": left, "findings": list,
    });
    format!("{all:#}\n")
}

fn entry(finding: &Finding, rules: Rules) -> serde_json::Value {
    let mut value = serde_json::to_value(finding).unwrap_or_default();
    if let Some(object) = value.as_object_mut() {
        object.insert("fails".into(), finding.fails_by(rules).into());
    }
    value
}

/// A name as a terminal may show it: control characters are written out.
pub(super) fn escaped(name: &str) -> String {
    let hidden = |c: char| c.is_control() || ('\u{202a}'..='\u{202e}').contains(&c) || ('\u{2066}'..='\u{2069}').contains(&c);
    name.chars().map(|c| if hidden(c) { c.escape_default().to_string() } else { c.to_string() }).collect()
}

fn table(findings: &[&Finding]) -> String {
    let mut rows = vec![(HEADINGS.map(str::to_owned), String::new())];
    let mut seen: BTreeMap<_, usize> = BTreeMap::new();
    for finding in findings {
        let count = seen.entry((&finding.scenario, &finding.method, finding.metric)).or_default();
        *count += 1;
        if *count <= LISTED {
            rows.push((cells(finding), escaped(&finding.message)));
        }
    }
    let mut text = aligned(&rows);
    for ((scenario, method, metric), count) in seen.iter().filter(|(_, count)| **count > LISTED) {
        let _ =
            writeln!(text, "  and {} more of {metric} of {} in {} (all with --json)", count - LISTED, escaped(method), escaped(scenario));
    }
    text
}

fn cells(finding: &Finding) -> [String; 8] {
    let number = |value: Option<f64>| value.map_or_else(String::new, figure);
    let target = finding.target.as_deref().map(escaped).unwrap_or_default();
    let change =
        finding.change().map_or_else(String::new, |change| if change > 0.0 { format!("+{}", figure(change)) } else { figure(change) });
    let p = finding.p.map_or_else(String::new, |p| if p == 0.0 { "0".to_owned() } else { format!("{p:.1e}") });
    let (scenario, method, metric) = (escaped(&finding.scenario), escaped(&finding.method), finding.metric.to_owned());
    [scenario, method, target, metric, number(finding.baseline), number(finding.now), change, p]
}

/// Counts as they are, the rest to a millionth of a pixel, or shorter than that when tiny.
fn figure(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e9 {
        return format!("{value}");
    }
    if value.abs() < 1e-5 { format!("{value:.1e}") } else { format!("{value:.6}") }
}

fn aligned(rows: &[([String; 8], String)]) -> String {
    // A column that holds nothing but its heading is left out.
    let used = |column: usize| rows.iter().skip(1).any(|(cells, _)| !cells[column].is_empty());
    let longest = |column: usize| rows.iter().map(|(cells, _)| cells[column].chars().count()).max().unwrap_or(0);
    let width = |column: usize| if used(column) { longest(column) } else { 0 };
    let widths: [usize; 8] = std::array::from_fn(width);
    let mut text = String::new();
    for (cells, message) in rows {
        let mut line = String::from("  ");
        for (column, (cell, width)) in cells.iter().zip(widths).enumerate().filter(|(_, (_, width))| *width > 0) {
            // Names to the left, figures to the right.
            let _ = if column < 4 { write!(line, "{cell:<width$}  ") } else { write!(line, "{cell:>width$}  ") };
        }
        line.push_str(message);
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}
