//! The section of printed figures: cameras, the network that they ask for, changed cameras.

use calibench_records::description::Printed;
use calibench_records::results::Group;

use crate::field::plain;
use crate::load::Loaded;
use crate::load::adjustments::Summaries;
use crate::markdown::MarkdownTable;

/// What stands above the figures of the network.
const NETWORK: &str = "The network of stations that explains the fitted columns, and where its stations stand.";
/// What stands above changed cameras.
const VARIANTS: &str = "Each camera with something changed: in the image against the camera as printed, after the best rotation and where neither folds over; and what it predicts in the same network. \
                        *Misfit*: root mean square of predicted less printed absolute errors.";
/// What stands above changed cameras that others are fitted to.
const AGAIN: &str = "The network fitted again, with a camera changed.";

/// The section of `loaded`, whose sets are `sets`.
pub fn section(loaded: &Loaded, sets: &Printed) -> String {
    let Some(found) = &loaded.calibrations else { return String::new() };
    let mut text = by_figure(found, std::slice::from_ref(&sets.sensor), &[Group::Network]) + "\n";
    text.push_str(&format!("### Cameras\n\n{}\n", by_figure(found, &sets.cameras, &[Group::Network, Group::Check])));
    if let Some(network) = &sets.network {
        text.push_str(&format!("### The network\n\n{NETWORK}\n\n{}\n", by_figure(found, std::slice::from_ref(network), &[Group::Network])));
        text.push_str(&format!("{}\n{}\n", numbers(found, network), stations(found, network)));
    }
    if !sets.variants.is_empty() {
        text.push_str(&format!("### Changed cameras\n\n{VARIANTS}\n\n{}\n", by_set(found, &sets.variants)));
    }
    if !sets.again.is_empty() {
        text.push_str(&format!("### Fitted again\n\n{AGAIN}\n\n{}\n", by_figure(found, &sets.again, &[Group::Network])));
    }
    text + &failures(found)
}

/// The value of a figure; nothing where a set has none.
fn value(found: &Summaries, set: &str, group: Group, name: &str) -> Option<f64> {
    found.of_set(found.methods.first()?, set, group, name)?.first.map(|numbers| numbers.value)
}

/// The names of all figures of some sets in a group, in the order of the alphabet.
fn names(found: &Summaries, sets: &[String], group: Group) -> Vec<String> {
    let mine = found.figures.keys().filter(|(_, set, of, _)| *of == group && sets.contains(set));
    let mut names: Vec<String> = mine.map(|(.., name)| name.clone()).collect();
    names.sort();
    names.dedup();
    names
}

fn cell(value: Option<f64>) -> String {
    value.map_or_else(String::new, plain)
}

/// A row for every figure, a column for every set.
fn by_figure(found: &Summaries, sets: &[String], groups: &[Group]) -> String {
    let header: Vec<&str> = std::iter::once("figure").chain(sets.iter().map(String::as_str)).collect();
    let mut table = MarkdownTable::new(&header);
    for &group in groups {
        for name in names(found, sets, group) {
            let label = if group == Group::Check { format!("{name}, of printed errors") } else { name.clone() };
            table.row(std::iter::once(label).chain(sets.iter().map(|set| cell(value(found, set, group, &name)))));
        }
    }
    table.render()
}

/// A row for every set, a column for every figure.
fn by_set(found: &Summaries, sets: &[String]) -> String {
    let names = names(found, sets, Group::Network);
    let header: Vec<&str> = std::iter::once("camera").chain(names.iter().map(String::as_str)).collect();
    let mut table = MarkdownTable::new(&header);
    for set in sets {
        table.row(std::iter::once(set.clone()).chain(names.iter().map(|name| cell(value(found, set, Group::Network, name)))));
    }
    table.render()
}

/// The numbers of a network.
fn numbers(found: &Summaries, network: &str) -> String {
    let mut table = MarkdownTable::new(&["number", "value"]);
    for name in names(found, &[network.to_owned()], Group::Eop).into_iter().filter(|name| !name.contains('/')) {
        let found = value(found, network, Group::Eop, &name);
        table.row([name, cell(found)]);
    }
    table.render()
}

/// The stations of a network, in their order.
fn stations(found: &Summaries, network: &str) -> String {
    let mut table = MarkdownTable::new(&["station", "X", "Y", "Z"]);
    let at = |station: usize, axis: &str| value(found, network, Group::Eop, &format!("{station}/{axis}"));
    for station in (1..).take_while(|&station| at(station, "X").is_some()) {
        let axes = ["X", "Y", "Z"].map(|axis| at(station, axis).map_or_else(String::new, |value| format!("{value:.2}")));
        table.row(std::iter::once(station.to_string()).chain(axes));
    }
    table.render()
}

/// What has no figures, and why.
fn failures(found: &Summaries) -> String {
    let lines: String = found.failed.iter().map(|((_, set, _), (_, why))| format!("- `{set}` has no predictions: {why}.\n")).collect();
    if lines.is_empty() { lines } else { lines + "\n" }
}

#[cfg(test)]
mod tests {
    use calibench_records::adjustments::Numbers;

    use super::*;
    use crate::load::adjustments::Summary;

    /// Cameras `a` (c 1, RMSE 2) and `b` (c 3), a network of two stations.
    fn summaries() -> Summaries {
        let mut found = Summaries { methods: vec!["print".into()], trials: 1, ..Summaries::default() };
        let mut add = |set: &str, group: Group, name: &str, value: f64| {
            let first = Some(Numbers { value, sigma: None, error: None });
            found.figures.insert(("print".into(), set.into(), group, name.into()), Summary { first, ..Summary::default() });
        };
        add("a", Group::Network, "c, mm", 1.0);
        add("b", Group::Network, "c, mm", 3.0);
        add("a", Group::Check, "RMSE X, m", 2.0);
        add("a", Group::Object, "V1/X", 7.0);
        add("net", Group::Eop, "height, m", 5.0);
        for (station, height) in [("1", 10.0), ("2", 20.0)] {
            add("net", Group::Eop, &format!("{station}/X"), height);
            add("net", Group::Eop, &format!("{station}/Y"), 0.0);
            add("net", Group::Eop, &format!("{station}/Z"), height);
        }
        found
    }

    /// Cells between bars, without blanks.
    fn cells(table: &str) -> Vec<Vec<String>> {
        let rows = table.lines().filter(|line| !line.contains("--"));
        rows.map(|row| row.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()).collect()
    }

    #[test]
    fn figures_stand_by_set_and_what_a_set_lacks_is_empty() {
        let sets = ["a".to_owned(), "b".to_owned()];
        let found = cells(&by_figure(&summaries(), &sets, &[Group::Network, Group::Check]));
        assert_eq!(found, [["figure", "a", "b"], ["c, mm", "1.00", "3.00"], ["RMSE X, m, of printed errors", "2.00", ""]]);
        assert_eq!(cells(&by_set(&summaries(), &sets)), [["camera", "c, mm"], ["a", "1.00"], ["b", "3.00"]]);
    }

    #[test]
    fn a_network_is_its_numbers_and_its_stations() {
        assert_eq!(cells(&numbers(&summaries(), "net")), [["number", "value"], ["height, m", "5.00"]]);
        let stations = cells(&stations(&summaries(), "net"));
        assert_eq!(stations, [["station", "X", "Y", "Z"], ["1", "10.00", "0.00", "10.00"], ["2", "20.00", "0.00", "20.00"]]);
    }

    #[test]
    fn what_has_no_predictions_is_said_with_its_reason() {
        let mut found = summaries();
        assert_eq!(failures(&found), "");
        found.failed.insert(("print".into(), "a".into(), Group::Check), (1, "rays are parallel".into()));
        assert_eq!(failures(&found), "- `a` has no predictions: rays are parallel.\n\n");
    }
}
