//! How often a blind recognition was wrong: in one scenario, and over a sweep.

mod steps;

pub use steps::steps;

use calibench_records::figures::{FigureName, Quantity};
use calibench_records::names::cell_folder;

use crate::LoadError;
use crate::load::adjustments::{Summaries, load};
use crate::markdown::{MarkdownTable, fixed};
use crate::sweep::LoadedSweep;

/// The name under which counts of recognition stand.
const SET: &str = "recognition";
/// The size groups, as the records name them.
const GROUPS: [&str; 4] =
    ["small squares and triangles", "small crosses and discs", "large squares and triangles", "large crosses and discs"];

/// What is told of every table.
const LEGEND: &str = "Counts of all trials. *Targets*: dark areas of whole squares that are a target. *Labelled*: those with a name and a place within 2 px of their truth. *Wrong label*: a name whose target is elsewhere. \
    *Alone / joint*: share taken for the other kind of their size, by what they look like alone, and as the best of six decisions on the four of a size; after ± half its 95 % interval over the trials. *Lines off*: root mean square distance, across, of the grid's lines from the true places of the nodes on them, and that of the one line of a trial \
    of which it is largest, means over the trials.";

/// Counts of a scenario's recognisers.
struct Counts<'a> {
    found: &'a Summaries,
    method: &'a str,
}

impl<'a> Counts<'a> {
    fn of(found: &'a Summaries) -> Option<Self> {
        found.sets.iter().any(|set| set == SET).then_some(())?;
        Some(Self { found, method: found.methods.first()? })
    }

    fn sum(&self, figure: FigureName) -> f64 {
        let summary = self.found.of_set(self.method, SET, figure);
        summary.map_or(0.0, |summary| summary.value.mean().unwrap_or(0.0) * summary.value.count as f64)
    }

    /// A share in percent with half its interval over the trials.
    fn percent(&self, figure: FigureName) -> String {
        let Some(summary) = self.found.of_set(self.method, SET, figure) else { return String::new() };
        let mean = fixed(summary.value.mean().unwrap_or(f64::NAN), 2);
        summary.value.half().filter(|half| *half > 0.0).map_or_else(|| mean.clone(), |half| format!("{mean} ± {}", fixed(half, 2)))
    }

    /// What the figures of a quantity are of.
    fn of_quantity(&self, quantity: Quantity) -> impl Iterator<Item = Vec<&'a str>> + use<'a> {
        let method = self.method;
        let mine = self.found.figures.keys().filter(move |(m, set, name)| m == method && set == SET && name.quantity() == quantity);
        mine.map(|(.., name)| name.parts())
    }

    /// Classifiers and groups of images.
    fn lists(&self) -> (Vec<String>, Vec<String>) {
        let all: Vec<Vec<&str>> = self.of_quantity(Quantity::SeenImages).collect();
        let mut classifiers: Vec<String> = all.iter().map(|parts| parts[0].to_owned()).collect();
        classifiers.dedup();
        let mut images: Vec<String> =
            all.iter().filter(|parts| Some(parts[0]) == classifiers.first().map(String::as_str)).map(|parts| parts[1].to_owned()).collect();
        images.sort();
        (classifiers, images)
    }

    /// The cells of a row.
    fn row(&self, classifier: &str, images: &str) -> Vec<String> {
        let count = |quantity: Quantity| self.sum(quantity.of(&[classifier, images]));
        let of = |part: Quantity, whole: Quantity| {
            let whole = count(whole);
            if whole > 0.0 { fixed(100.0 * count(part) / whole, 2) } else { String::new() }
        };
        let mut row = vec![
            format!("{:.0} of {:.0}", count(Quantity::SeenGrids), count(Quantity::SeenImages)),
            format!("{:.0}", count(Quantity::SeenTargets)),
        ];
        let mean = |quantity: Quantity| {
            let summary = self.found.of_set(self.method, SET, quantity.of(&[classifier, images]));
            summary.and_then(|summary| summary.value.mean()).map_or_else(String::new, |mean| fixed(mean, 3))
        };
        row.push(format!("{} / {}", mean(Quantity::LineError), mean(Quantity::LineErrorMost)));
        row.extend([of(Quantity::Labelled, Quantity::SeenTargets), of(Quantity::WrongLabels, Quantity::Labels)]);
        for group in GROUPS {
            let share = |how: &str| self.percent(Quantity::WrongKindsPercent.of(&[classifier, how, group, images]));
            row.push(format!("{} / {}", share("single"), share("joint")));
        }
        row
    }
}

const COLUMNS: [&str; 5] = ["grids", "targets", "lines off: all / most, px", "labelled, %", "wrong label, %"];

fn header<'a>(first: &[&'a str]) -> Vec<&'a str> {
    const SIZES: [&str; 4] = [
        "small squares, triangles: alone / joint, %",
        "small crosses, discs: alone / joint, %",
        "large squares, triangles: alone / joint, %",
        "large crosses, discs: alone / joint, %",
    ];
    first.iter().copied().chain(COLUMNS).chain(SIZES).collect()
}

/// The section of a scenario; `None` for one without recognition.
pub fn section(found: &Summaries) -> Option<String> {
    let counts = Counts::of(found)?;
    let (classifiers, images) = counts.lists();
    let mut rows = MarkdownTable::new(&header(&["classifier", "images"]));
    for classifier in &classifiers {
        for images in &images {
            rows.row([format!("`{classifier}`"), images.clone()].into_iter().chain(counts.row(classifier, images)));
        }
    }
    Some(format!("### Recognition\n\n{LEGEND} {} trials.\n\n{}\n{}", found.trials, rows.render(), confusions(&counts, &classifiers)))
}

/// Which kind was taken for which, in joint decisions.
fn confusions(counts: &Counts<'_>, classifiers: &[String]) -> String {
    let mut lines = String::new();
    for classifier in classifiers {
        let mut kinds: Vec<(String, f64)> = Vec::new();
        let mine = counts.of_quantity(Quantity::TakenFor).filter(|parts| parts[..2] == [classifier, "joint"]);
        for parts in mine {
            let what = format!("{} taken for {}", parts[2], parts[3]);
            let count = counts.sum(Quantity::TakenFor.of(&parts));
            match kinds.iter_mut().find(|(known, _)| *known == what) {
                Some((_, sum)) => *sum += count,
                None => kinds.push((what, count)),
            }
        }
        let all: Vec<String> = kinds.iter().map(|(what, count)| format!("{what} {count:.0} times")).collect();
        let said = if all.is_empty() { "nothing is taken for another kind".to_owned() } else { all.join(", ") };
        lines.push_str(&format!("- `{classifier}`, joint decisions: {said}.\n"));
    }
    format!("{lines}\n")
}

/// Whether the records of a sweep count what was recognised: its first cell with figures tells.
///
/// # Errors
/// Records that cannot be read.
pub fn is_counted(loaded: &LoadedSweep) -> Result<bool, LoadError> {
    for index in 0..loaded.cells.len() {
        if let Some(found) = load(&cell_folder(&loaded.folder, index), &loaded.sweep.run(&loaded.name, index))? {
            return Ok(Counts::of(&found).is_some());
        }
    }
    Ok(false)
}

/// The section of a sweep in which recognition is counted.
///
/// # Errors
/// Records that cannot be read.
pub fn sweep(loaded: &LoadedSweep) -> Result<String, LoadError> {
    let axes: Vec<String> = loaded.sweep.axes.iter().map(|axis| format!("`{}`", axis.name)).collect();
    let first: Vec<&str> = axes.iter().map(String::as_str).chain(["classifier", "images"]).collect();
    let mut rows = MarkdownTable::new(&header(&first));
    for index in 0..loaded.cells.len() {
        let Some(found) = load(&cell_folder(&loaded.folder, index), &loaded.sweep.run(&loaded.name, index))? else { continue };
        let Some(counts) = Counts::of(&found) else { continue };
        let values: Vec<String> = loaded.sweep.values(index).into_iter().map(|value| value.text.clone()).collect();
        let (classifiers, images) = counts.lists();
        for classifier in &classifiers {
            for images in &images {
                let own = [format!("`{classifier}`"), images.clone()];
                rows.row(values.iter().cloned().chain(own).chain(counts.row(classifier, images)));
            }
        }
    }
    Ok(format!("{LEGEND}\n\n{}\n", rows.render()))
}
