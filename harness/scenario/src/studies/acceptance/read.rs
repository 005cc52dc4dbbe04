//! Reading `[acceptance]`.

use calibench_accept::{Limit, Rule};
use calibench_diagnostics::Problem;
use calibench_model::Testfield;
use toml::Spanned;

use super::wire::{ClassesWire, LengthsWire};
use super::{Classes, TestLines};
use crate::section::Section;
use crate::studies::places;

/// Reads lengths between targets of `field`.
pub fn read_lengths(section: Section<'_>, field: &Testfield, problems: &mut Vec<Problem>) -> Option<TestLines> {
    let before = problems.len();
    let wire: LengthsWire = section.read(&[], problems)?;
    let targets: Vec<&str> = field.targets.iter().map(|target| target.id.as_str()).collect();
    if wire.lines.get_ref().is_empty() {
        problems.push(Problem::new(wire.lines.span(), "`lines` is empty: expected a list of targets for each measurement line"));
    }
    let mut line = |names: &Vec<Spanned<String>>| {
        if names.len() < 2 {
            let span = names.first().map_or_else(|| wire.lines.span(), Spanned::span);
            problems.push(Problem::new(span, format!("a line of {} targets: expected two at least, as six of a whole test", names.len())));
        }
        places("target", names, &targets, problems)
    };
    let lines = wire.lines.get_ref().iter().map(&mut line).collect();
    let limit = limit(&wire.limit, problems);
    if let (Some(_), Some(band)) = (&wire.probability, &wire.guard_band) {
        problems.push(Problem::new(band.span(), "`guard_band` beside `probability`: expected one of them"));
    }
    if problems.len() > before {
        return None;
    }
    let by_probability = wire.probability.map_or(Rule::DEFAULT, |probability| Rule::Probability(probability.0));
    Some(TestLines {
        lines,
        sigma: wire.sigma.map_or(0.0, |sigma| sigma.0),
        limit: limit?,
        rule: wire.guard_band.map_or(by_probability, |band| Rule::GuardBand(band.into_inner().0)),
        diagonal: wire.volume.map_or_else(|| largest_distance(field), |edges| edges.0.iter().map(|edge| edge * edge).sum::<f64>().sqrt()),
    })
}

/// Reads the accuracies that check points must keep.
pub fn read_classes(section: Section<'_>, problems: &mut Vec<Problem>) -> Option<Classes> {
    let span = section.span.clone();
    let wire: ClassesWire = section.read(&[], problems)?;
    let [horizontal, vertical, spatial] = [wire.horizontal, wire.vertical, wire.spatial].map(|class| class.map(|class| class.0));
    let classes = Classes { horizontal, vertical, spatial };
    if classes == Classes::default() {
        problems.push(Problem::new(span, "[acceptance] without a class: expected `horizontal`, `vertical` or `spatial`"));
        return None;
    }
    Some(classes)
}

/// As the command line has it, so that both refuse the same.
fn limit(written: &Spanned<Vec<f64>>, problems: &mut Vec<Problem>) -> Option<Limit> {
    let text: Vec<String> = written.get_ref().iter().map(f64::to_string).collect();
    text.join(",").parse().map_err(|error| problems.push(Problem::new(written.span(), format!("`limit`: {error}")))).ok()
}

fn largest_distance(field: &Testfield) -> f64 {
    let points: Vec<_> = field.targets.iter().map(|target| field.position(target)).collect();
    let from =
        |(place, point): (usize, &nalgebra::Point3<f64>)| points[..place].iter().map(|other| (other - point).norm()).fold(0.0, f64::max);
    points.iter().enumerate().map(from).fold(0.0, f64::max)
}
