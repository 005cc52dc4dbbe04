//! Tables of printed figures.

use calibench_records::figures::{FigureName, Group, Quantity};

use crate::load::adjustments::Summaries;
use crate::markdown::{MarkdownTable, plain};

/// Where a station stands.
pub const STATION: [Quantity; 3] = [Quantity::StationX, Quantity::StationY, Quantity::StationZ];
/// Its angles.
pub const ANGLES: [Quantity; 3] = [Quantity::Omega, Quantity::Phi, Quantity::Kappa];

/// The value of a figure; nothing where a set has none.
pub fn value(found: &Summaries, set: &str, figure: FigureName) -> Option<f64> {
    found.of_set(found.methods.first()?, set, figure)?.first.map(|numbers| numbers.value)
}

/// The names of all figures of some sets in a group, in the order of the alphabet.
fn names(found: &Summaries, sets: &[String], group: Group) -> Vec<FigureName> {
    let mine = found.figures.keys().filter(|(_, set, name)| name.group() == group && sets.contains(set));
    let mut names: Vec<FigureName> = mine.map(|(.., name)| name.clone()).collect();
    names.sort();
    names.dedup();
    names
}

fn cell(value: Option<f64>) -> String {
    value.map_or_else(String::new, plain)
}

/// A row for every figure, a column for every set.
pub fn by_figure(found: &Summaries, sets: &[String], groups: &[Group]) -> String {
    let header: Vec<&str> = std::iter::once("figure").chain(sets.iter().map(String::as_str)).collect();
    let mut table = MarkdownTable::new(&header);
    for &group in groups {
        for name in names(found, sets, group) {
            let label = if group == Group::Check { format!("{name}, of printed errors") } else { name.to_string() };
            table.row(std::iter::once(label).chain(sets.iter().map(|set| cell(value(found, set, name.clone())))));
        }
    }
    table.render()
}

/// A row for every set, a column for every figure.
pub fn by_set(found: &Summaries, sets: &[String]) -> String {
    let names = names(found, sets, Group::Network);
    let header: Vec<&str> = std::iter::once("camera").chain(names.iter().map(FigureName::text)).collect();
    let mut table = MarkdownTable::new(&header);
    for set in sets {
        table.row(std::iter::once(set.clone()).chain(names.iter().map(|name| cell(value(found, set, name.clone())))));
    }
    table.render()
}

/// The numbers of a network.
pub fn numbers(found: &Summaries, network: &str) -> String {
    let mut table = MarkdownTable::new(&["number", "value"]);
    let of_site = |name: &FigureName| !STATION.contains(&name.quantity()) && !ANGLES.contains(&name.quantity());
    for name in names(found, &[network.to_owned()], Group::Eop).into_iter().filter(of_site) {
        let found = value(found, network, name.clone());
        table.row([name.to_string(), cell(found)]);
    }
    table.render()
}

/// The stations of a network, in their order.
pub fn stations(found: &Summaries, network: &str) -> String {
    let mut table = MarkdownTable::new(&["station", "X", "Y", "Z"]);
    let at = |station: usize, axis: Quantity| value(found, network, axis.of(&[&station.to_string()]));
    for station in (1..).take_while(|&station| at(station, Quantity::StationX).is_some()) {
        let axes = STATION.map(|axis| at(station, axis).map_or_else(String::new, |value| format!("{value:.2}")));
        table.row(std::iter::once(station.to_string()).chain(axes));
    }
    table.render()
}

/// What has no figures, and why.
pub fn failures(found: &Summaries) -> String {
    let lines: String = found.failed.iter().map(|((_, set, _), (_, why))| format!("- `{set}` has no predictions: {why}.\n")).collect();
    if lines.is_empty() { lines } else { lines + "\n" }
}
