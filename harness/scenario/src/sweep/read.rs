//! Reading the `[sweep]` table.

use std::ops::Range;

use calibench_diagnostics::Problem;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::wire::{RangeWire, Scale};
use super::{Axis, MOST_CELLS, Sweep, Value};
use crate::section::Section;

/// Takes `[sweep]` out of `root`, the table of `text`; mistakes are added to `problems`. `None` if there is none or it is wrong.
pub fn take(root: &mut DeTable<'_>, text: &str, file: &str, problems: &mut Vec<Problem>) -> Option<Sweep> {
    let (key, value) = root.remove_entry("sweep")?;
    let before = problems.len();
    let DeValue::Table(table) = value.into_inner() else {
        problems.push(Problem::new(key.span(), "`sweep` is a table, [sweep], with a list of values for each swept key"));
        return None;
    };
    let mut axes = Vec::new();
    collect(table, "", text, &mut axes, problems);
    if axes.is_empty() && problems.len() == before {
        let problem = Problem::new(key.span(), "[sweep] has no key");
        problems.push(problem.help("name a key with its table and its values, as in \"optics.blur\" = [0.3, 0.6, 1.2]"));
    }
    // The order of the text: a table keeps its keys sorted.
    axes.sort_by_key(|axis: &Axis| axis.span.start);
    apart(&axes, problems);
    name(&mut axes);
    let cells = axes.iter().try_fold(1_usize, |cells, axis| cells.checked_mul(axis.values.len())).unwrap_or(usize::MAX);
    if cells > MOST_CELLS {
        problems.push(Problem::new(key.span(), format!("[sweep] makes {cells} cells: expected at most {MOST_CELLS}")));
    }
    (problems.len() == before).then(|| Sweep { axes, file: file.to_owned() })
}

/// The axes of `table`, whose keys follow `prefix`.
fn collect(table: DeTable<'_>, prefix: &str, text: &str, axes: &mut Vec<Axis>, problems: &mut Vec<Problem>) {
    for (key, value) in table {
        let (span, path) = (key.span(), format!("{prefix}{}", key.get_ref()));
        let place = value.span();
        let found = match value.into_inner() {
            DeValue::Array(values) => listed(&path, &place, values.iter().map(Spanned::span), text, problems),
            DeValue::Table(table) if ["from", "to", "count", "scale"].iter().any(|key| table.contains_key(*key)) => {
                let section = Section { name: "the range", span: span.clone(), table };
                section.read::<RangeWire>(&[], problems).and_then(|wire| range(&wire, &place, problems))
            }
            DeValue::Table(table) => {
                collect(table, &format!("{path}."), text, axes, problems);
                None
            }
            other => {
                let message = format!("`{path}` has one value, {}: expected a list of values or a range", other.type_str());
                let help = "as in [0.3, 0.6, 1.2] or { from = 0.3, to = 3, count = 5, scale = \"log\" }";
                problems.push(Problem::new(place, message).help(help));
                None
            }
        };
        if let Some((values, log)) = found {
            axes.push(Axis { name: path.clone(), path, values, log, span });
        }
    }
}

type Values = Option<(Vec<Value>, bool)>;

fn listed(path: &str, place: &Range<usize>, spans: impl Iterator<Item = Range<usize>>, text: &str, problems: &mut Vec<Problem>) -> Values {
    let values: Vec<Value> = spans.map(|span| Value::written(text, span)).collect();
    if values.is_empty() {
        problems.push(Problem::new(place.clone(), format!("`{path}` has no value: expected at least one")));
        return None;
    }
    for (index, value) in values.iter().enumerate() {
        if values[..index].iter().any(|earlier| same(earlier, value)) {
            problems
                .push(Problem::new(value.span.clone(), format!("`{}` is listed twice for `{path}`; expected each value once", value.text)));
        }
    }
    let log = is_geometric(&values.iter().filter_map(|value| value.number).collect::<Vec<_>>());
    Some((values, log))
}

fn same(a: &Value, b: &Value) -> bool {
    a.text == b.text || (a.number.is_some() && a.number == b.number)
}

/// At least three positive numbers with steps of a factor, within 15 % (rounded ones such as 1, 2, 5, 10 are not, 0.5, 1, 2, 4 are).
fn is_geometric(values: &[f64]) -> bool {
    let steps: Vec<f64> = values.windows(2).map(|pair| (pair[1] / pair[0]).ln()).collect();
    let positive = values.len() > 2 && values.iter().all(|value| *value > 0.0);
    positive && steps.iter().all(|step| (step / steps[0] - 1.0).abs() < 0.15)
}

fn range(wire: &RangeWire, place: &Range<usize>, problems: &mut Vec<Problem>) -> Values {
    let (from, to, log) = (wire.from.get_ref().0, wire.to.get_ref().0, wire.scale.unwrap_or_default() == Scale::Log);
    if from == to {
        problems.push(Problem::new(wire.to.span(), format!("the range ends where it begins, at {to}: expected two ends")));
        return None;
    }
    if log && (from <= 0.0 || to <= 0.0) {
        let span = if from <= 0.0 { wire.from.span() } else { wire.to.span() };
        problems.push(Problem::new(span, "a range with `scale = \"log\"` has ends above 0"));
        return None;
    }
    let last = wire.count.0 - 1;
    let value = |index: usize| {
        let part = index as f64 / last as f64;
        match index {
            0 => from,
            index if index == last => to,
            _ if log => (from.ln() + (to / from).ln() * part).exp(),
            _ => from + (to - from) * part,
        }
    };
    Some(((0..wire.count.0).map(|index| Value::computed(short(value(index)), place.clone())).collect(), log))
}

/// Six digits: what labels show is what is run.
fn short(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// No axis is another's or lies within it.
fn apart(axes: &[Axis], problems: &mut Vec<Problem>) {
    for (index, axis) in axes.iter().enumerate() {
        let within = |other: &Axis| axis.path == other.path || axis.path.starts_with(&format!("{}.", other.path));
        if let Some(other) = axes.iter().enumerate().find(|(i, other)| *i != index && within(other)) {
            problems
                .push(Problem::new(axis.span.clone(), format!("`{}` is swept by `{}` too; expected one of them", axis.path, other.1.path)));
        }
    }
}

/// The last part of each path where no other has it too.
fn name(axes: &mut [Axis]) {
    let last = |axis: &Axis| axis.path.rsplit('.').next().unwrap_or_default().to_owned();
    let short: Vec<String> = axes.iter().map(last).collect();
    for (axis, name) in axes.iter_mut().zip(&short) {
        if short.iter().filter(|other| *other == name).count() == 1 {
            axis.name.clone_from(name);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_of_a_factor_are_told_from_others() {
        assert!(is_geometric(&[0.5, 1.0, 2.0, 4.0]) && is_geometric(&[10.0, 1.0, 0.1]));
        assert!(!is_geometric(&[0.3, 0.5, 0.7, 1.0]) && !is_geometric(&[1.0, 2.0]) && !is_geometric(&[0.0, 1.0, 2.0]));
    }

    #[test]
    fn ranges_hold_both_ends_and_short_numbers() {
        let text = "[sweep]\n\"a.b\" = { from = 0.1, to = 10, count = 5, scale = \"log\" }\na.c = { from = 0, to = 0.3, count = 4 }\n";
        let mut root = DeTable::parse(text).unwrap().into_inner();
        let mut problems = Vec::new();
        let sweep = take(&mut root, text, "f.toml", &mut problems).unwrap();
        let texts = |axis: &Axis| axis.values.iter().map(|value| value.text.clone()).collect::<Vec<_>>();
        assert_eq!(texts(&sweep.axes[0]), ["0.1", "0.316228", "1", "3.16228", "10"]);
        assert_eq!(texts(&sweep.axes[1]), ["0", "0.1", "0.2", "0.3"]);
        assert_eq!((sweep.cells(), sweep.places(6), sweep.label(6)), (20, vec![1, 2], "b=0.316228, c=0.2".into()));
        assert!(sweep.axes[0].log && !sweep.axes[1].log && !root.contains_key("sweep"));
    }
}
