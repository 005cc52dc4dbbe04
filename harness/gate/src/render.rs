//! Findings as text.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::ALPHA;
use super::finding::Finding;

/// How many findings of one method and metric are listed before the rest is only counted.
const LISTED: usize = 10;
/// The headings of the table.
const HEADINGS: [&str; 8] = ["scenario", "method", "target", "metric", "baseline", "now", "change", "p"];

/// The findings of [`Check::conclude`](super::Check::conclude): a table of what fails, one of what informs, and a line that sums up.
/// The p-values are adjusted for all tests of the check.
pub fn render(findings: &[Finding]) -> String {
    let (failing, informing): (Vec<&Finding>, Vec<&Finding>) = findings.iter().partition(|finding| finding.fails());
    let mut text = String::new();
    for (title, part) in [("Fails", &failing), ("For information", &informing)] {
        if !part.is_empty() {
            // Writing to a String cannot fail.
            let _ = write!(text, "{title}\n\n{}\n", table(part));
        }
    }
    text + &summary(&failing, informing.len())
}

fn summary(failing: &[&Finding], informing: usize) -> String {
    if failing.is_empty() {
        return format!("The gate holds: nothing fails, {informing} for information.\n");
    }
    let mut methods: Vec<String> = failing.iter().map(|finding| format!("{} in {}", finding.method, finding.scenario)).collect();
    methods.sort();
    methods.dedup();
    let (count, methods) = (failing.len(), methods.join(", "));
    format!("The gate fails: {count} findings ({methods}), {informing} for information; family-wise error rate {ALPHA}.\n")
}

fn table(findings: &[&Finding]) -> String {
    let mut rows = vec![(HEADINGS.map(str::to_owned), String::new())];
    let mut seen: BTreeMap<_, usize> = BTreeMap::new();
    for finding in findings {
        let count = seen.entry((&finding.scenario, &finding.method, finding.metric)).or_default();
        *count += 1;
        if *count <= LISTED {
            rows.push((cells(finding), finding.message.clone()));
        }
    }
    let mut text = aligned(&rows);
    for ((scenario, method, metric), count) in seen.iter().filter(|(_, count)| **count > LISTED) {
        let _ = writeln!(text, "  and {} more of {metric} of {method} in {scenario}", count - LISTED);
    }
    text
}

fn cells(finding: &Finding) -> [String; 8] {
    let number = |value: Option<f64>| value.map_or_else(String::new, figure);
    let target = finding.target.clone().unwrap_or_default();
    let change =
        finding.change().map_or_else(String::new, |change| if change > 0.0 { format!("+{}", figure(change)) } else { figure(change) });
    let p = finding.p.map_or_else(String::new, |p| if p == 0.0 { "0".to_owned() } else { format!("{p:.1e}") });
    let (scenario, method, metric) = (finding.scenario.clone(), finding.method.clone(), finding.metric.to_owned());
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
