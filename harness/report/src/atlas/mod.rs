//! The atlas of operators: every operator over every condition, what to take when, and accuracy against speed.

mod choose;
mod explorer;
mod frontier;
mod load;
mod neighbours;
mod page;
mod pictures;
mod rows;
mod settings;

use std::collections::BTreeMap;

use self::frontier::Spot;
use self::page::Group;
use super::markdown::{MarkdownTable, contents};
use super::sweep::{Metric, deviations};
use super::{Canvas, LoadError, Places, ReportError};
use crate::composed::Composed;
use crate::speeds::Speeds;
pub use load::Part;
pub use settings::{Found, best, unmeasured};

/// The family of this report.
pub const FAMILY: &str = "atlas";
/// The page that says what to take.
const WHICH: &str = "which-operator.md";
/// The page of what stands beside the target.
const NEIGHBOURS: &str = "neighbours.md";
/// Every figure of every cell.
const NUMBERS: &str = "numbers.csv";

/// The sweeps that are measured at the settings of a search, with that search, and their targets.
const SEARCHED: [(&str, &str, &str); 3] = [
    ("atlas/corners", "atlas/search-corners", "chess corners"),
    ("atlas/discs", "atlas/search-discs", "discs"),
    ("atlas/wedges", "atlas/search-wedges", "corners of one area"),
];

type Parts = BTreeMap<String, Part>;

/// The report from the records of `names` and the measured speeds.
///
/// # Errors
/// Records or speeds that cannot be read.
pub(crate) fn compose(places: &Places, names: &[String]) -> Result<Composed, ReportError> {
    let speeds = Speeds::read(&places.published.with_file_name("speeds.csv"))?;
    let mut parts = Parts::new();
    for name in names {
        let part = Part::load(&places.records, name)?.ok_or_else(|| LoadError::None(name.clone()))?;
        parts.insert(name.clone(), part);
    }
    let mut text = String::new();
    let mut files = Vec::new();
    for (scenario, search, targets) in SEARCHED {
        speed_section(&parts, &speeds, (scenario, search, targets), &mut text, &mut files);
    }
    for part in parts.values() {
        section(part, &usual(&parts, &part.sweep.name), &mut text, &mut files);
    }
    let groups = groups(&parts, &speeds);
    let which = page::which(&groups, &speeds.machine, &evidence(&parts));
    let neighbours = neighbours::page(&parts);
    let page = format!("# Atlas of operators\n\n{}\n\n{}{}{}\n", which.answer, contents(&text), introduction(), text.trim_end());
    let mut composed = Composed::page(page, files);
    composed.explorer = Some(explorer::data(&groups, &which.verdicts, &parts, &speeds));
    composed.pages.push((WHICH.to_owned(), which.text));
    composed.pages.extend(neighbours.map(|text| (NEIGHBOURS.to_owned(), text)));
    let mut table = Vec::new();
    numbers(&parts, &mut table).map_err(std::io::Error::from)?;
    composed.tables.push((NUMBERS.to_owned(), table));
    Ok(composed)
}

fn introduction() -> String {
    format!(
        "[Which operator, when]({WHICH}) is what follows from it, [what stands beside the target]({NEIGHBOURS}) what neighbours, small squares and what hides a half cost. [{NUMBERS}]({NUMBERS}) holds every figure of every cell; `calibench plot atlas/corners --x blur --y rmse --by method --at \
         snr_contrast_db=34` draws any of them. Made by `calibench report atlas` from records and `reference/speeds.csv`. Some of the operators are our own; all get the same images, starts and scores. \
         The gate does not compare these sweeps: their cells that matter are scenarios of their own (`operators/*`).\n\n"
    )
}

/// The labels of a sweep's methods but those that it has from its search alone.
fn usual(parts: &Parts, scenario: &str) -> Vec<String> {
    let Some(part) = parts.get(scenario) else { return Vec::new() };
    // The settings of the search stand in the scenarios beside those of its corners.
    let family = scenario.split('-').next().unwrap_or(scenario);
    let search = SEARCHED.iter().find(|(evaluated, _, _)| *evaluated == family).and_then(|(_, search, _)| parts.get(*search));
    let found: Vec<String> =
        search.map_or_else(Vec::new, |search| best(search).into_iter().flat_map(|(_, found)| found).map(|found| found.label).collect());
    let methods = part.sweep.methods.iter().filter(|method| method.unavailable.is_none()).map(|method| method.name.clone());
    methods.filter(|label| part.sweep.scenario.is_default(label) || !found.contains(label)).collect()
}

/// The settings that a search found, and accuracy against speed.
fn speed_section(
    parts: &Parts,
    speeds: &Speeds,
    (scenario, search, targets): (&str, &str, &str),
    text: &mut String,
    files: &mut Vec<(String, Canvas)>,
) {
    let (Some(part), Some(search)) = (parts.get(scenario), parts.get(search)) else { return };
    let mut table = MarkdownTable::new(&["images", "operator", "best setting", "RMSE there, px"]);
    for (class, found) in best(search) {
        for Found { operator, label, rmse } in found {
            table.row([class.clone(), format!("`{operator}`"), format!("`{label}`"), super::plain(rmse)]);
        }
    }
    text.push_str(&format!(
        "## Settings for {targets}\n\nFrom the records of `{}` (seed {}): of each operator the setting with the least RMSE, a lost or rejected point counted as 1 px off. `{scenario}` measures them with seed {}.\n\n{}\n",
        search.sweep.name,
        search.sweep.seed,
        part.sweep.seed,
        table.render()
    ));
    let missing = unmeasured(search, part);
    if !missing.is_empty() {
        text.push_str(&format!("**`{scenario}` lacks settings that the search found: `{}`.**\n\n", missing.join("`, `")));
    }
    let candidates = rows::candidates(part, speeds, &rows::usual(part));
    let spots: Vec<Spot> = candidates
        .into_iter()
        .filter_map(|candidate| {
            Some(Spot { speed: candidate.speed?, rmse: candidate.rmse(), name: candidate.name })
                .filter(|spot| spot.rmse.is_finite() && spot.rmse > 0.0)
        })
        .collect();
    if spots.is_empty() {
        text.push_str("Speeds were not measured: `calibench speed` writes `reference/speeds.csv`.\n\n");
        return;
    }
    let name = format!("{}-speed.png", scenario.replace("atlas/", ""));
    let title = format!("{targets}: accuracy and speed; the line joins those that no other beats in both");
    files.push((name.clone(), frontier::picture(&spots, &title)));
    text.push_str(&format!("Accuracy against speed on usual images, failures counted as 1 px ({}; the speeds are reference data, not records):\n\n![{title}]({name})\n\n", speeds.machine));
}

fn section(part: &Part, usual: &[String], text: &mut String, files: &mut Vec<(String, Canvas)>) {
    let scenario = &part.sweep.scenario;
    let drawn = pictures::pictures(&part.sweep, usual);
    if drawn.is_empty() {
        return;
    }
    let trials = part.sweep.cells.iter().map(|cell| cell.trials).max().unwrap_or(0);
    text.push_str(&format!("## Scenario `{}`\n\n{}\n\n{}", part.sweep.name, scenario.why.trim(), deviations(&part.sweep)));
    scenario.notes.iter().for_each(|note| text.push_str(&format!("- {}\n", note.split_whitespace().collect::<Vec<_>>().join(" "))));
    text.push_str(&format!(
        "- {} cells of {trials} trials, seed {}; bars in the curves are 95 % intervals.\n\n",
        part.sweep.cells.len(),
        part.sweep.seed
    ));
    for (name, about, picture) in drawn {
        text.push_str(&format!("{about}:\n\n![{about}]({name})\n\n"));
        files.push((name, picture));
    }
}

fn groups(parts: &Parts, speeds: &Speeds) -> Vec<Group> {
    let mut groups = Vec::new();
    let mut add = |name: &str, title: &'static str, about: &str, rows: &dyn Fn(&Part) -> Vec<rows::Row>| {
        if let Some(part) = parts.get(name) {
            let trials = part.sweep.cells.iter().map(|cell| cell.trials).max().unwrap_or(0);
            groups.push(Group {
                title,
                about: format!("{about} `{name}`, {trials} trials a cell."),
                scenario: name.to_owned(),
                rows: rows(part),
            });
        }
    };
    add("atlas/corners", "Chess corners, by image", "Tilt to 50 degrees, any rotation and phase.", &|part| rows::images(part, speeds));
    add("atlas/corners", "Chess corners, by the speed that is needed", "Images of usual blur with 2 % of noise, one thread.", &|part| {
        rows::needs(part, speeds, &[1e3, 3e4, 1e5, 3e5, 1e6])
    });
    add("atlas/corners-pose", "Chess corners, by tilt", "Blur 0.7 px, 2 % of noise.", &|part| {
        rows::along(
            part,
            speeds,
            "stations.tilts.0.1",
            &[
                ("tilt 0", &|t| t < 1.0),
                ("tilt 15 and 30 degrees", &|t| (1.0..40.0).contains(&t)),
                ("tilt 45 and 60 degrees", &|t| t > 40.0),
            ],
        )
    });
    add(
        "atlas/corners-window",
        "Chess corners, by the room for a window",
        "Blur 0.4, 0.7 and 1.5 px, 2 % of noise; all settings but the window are the usual ones, and the bound is that of 15 x 15 px.",
        &|part| {
            rows::rooms(
                part,
                "method.window",
                &[("window to 7 px", 7.0), ("window to 11 px", 11.0), ("window to 15 px", 15.0), ("window to 25 px", 25.0)],
            )
        },
    );
    add("atlas/discs", "Discs, by image", "14 px wide, tilt to 45 degrees.", &|part| rows::images(part, speeds));
    add("atlas/discs-size", "Discs, by size", "Blur 0.7 px, 2 % of noise, tilt to 60 degrees.", &|part| {
        rows::along(
            part,
            speeds,
            "testfield.fill.size",
            &[("4 px wide", &|s| s < 0.015), ("8 px wide", &|s| (0.015..0.03).contains(&s)), ("16 and 32 px wide", &|s| s > 0.03)],
        )
    });
    add("atlas/wedges", "Corners of one area, by angle", "Blur 0.3 to 2 px, 2 % of noise.", &|part| {
        rows::along(
            part,
            speeds,
            "testfield.fill.angles.0",
            &[
                ("30 degrees", &|a| a < 45.0),
                ("60 degrees", &|a| (45.0..75.0).contains(&a)),
                ("90 degrees", &|a| (75.0..105.0).contains(&a)),
                ("120 degrees", &|a| (105.0..135.0).contains(&a)),
                ("150 degrees", &|a| a > 135.0),
            ],
        )
    });
    add("atlas/wedges", "Corners of one area, by blur", "Angles 30 to 150 degrees, 2 % of noise.", &|part| {
        rows::along(
            part,
            speeds,
            "optics.blur",
            &[("blur 0.3 px", &|b| b < 0.5), ("blur 0.7 px", &|b| (0.5..1.0).contains(&b)), ("blur 1.4 and 2 px", &|b| b > 1.0)],
        )
    });
    groups
}

fn evidence(parts: &Parts) -> String {
    let mut text = format!("## Evidence\n\n- [The curves and maps](README.md), [every figure of every cell]({NUMBERS})\n");
    for (name, part) in parts {
        text.push_str(&format!("- `{name}`: `calibench run {name}`, seed {}, {} cells\n", part.sweep.seed, part.sweep.cells.len()));
    }
    text
}

/// Every figure of every cell and method.
fn numbers(parts: &Parts, output: &mut dyn std::io::Write) -> Result<(), csv::Error> {
    const METRICS: [Metric; 7] =
        [Metric::Rmse, Metric::Bias, Metric::Scatter, Metric::Ratio, Metric::Predicted, Metric::Lost, Metric::Rejected];
    let mut csv = csv::Writer::from_writer(output);
    let named = METRICS.iter().map(|metric| metric.name().0);
    csv.write_record(["scenario", "cell", "method"].into_iter().chain(named).chain(["points"]))?;
    for (name, part) in parts {
        for cell in 0..part.sweep.cells.len() {
            for (method, info) in part.sweep.methods.iter().enumerate() {
                let Some(score) = part.sweep.score(cell, method) else { continue };
                let value = |metric: &Metric| metric.of(score).map_or_else(String::new, |found| format!("{:.4e}", found.value));
                let head = [name.clone(), part.sweep.sweep.cells[cell].label.clone(), info.name.clone()];
                csv.write_record(head.into_iter().chain(METRICS.iter().map(value)).chain([score.points().to_string()]))?;
            }
        }
    }
    Ok(csv.flush()?)
}
