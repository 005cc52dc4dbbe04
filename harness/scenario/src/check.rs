//! From the tables of a file to a checked scenario. All mistakes that can be told apart are reported together.

use std::ops::Range;
use std::path::Path;

use calibench_diagnostics::{Problem, Problems};
use calibench_measure::Registry;
use calibench_model::TargetKind;
use calibench_random::Key;
use toml::Spanned;
use toml::de::DeTable;

use super::methods::{check_boards, check_busy, check_kinds, methods, without_board};
use super::section::Section;
use super::site::Surroundings;
use super::studies::printed;
use super::study_tables::{self, StudyTables};
use super::sweep::{self, Sweep};
use super::views::{ImagingTables, ViewTables};
use super::wire::Head;
use super::{Drawn, Resolved, Scenario, Subject, figure, photographs, scene};

/// Side of the bound's window where the file gives none, px.
const BOUND_WINDOW: usize = 15;

/// The keys of the file's top level that are tables of their own, before those of studies and behind them.
const TOP_TABLES: ([&str; 2], [&str; 14]) = (
    ["sweep", "method"],
    [
        "recognition",
        "transfer",
        "scene",
        "figure",
        "photographs",
        "printed",
        "judgement",
        "camera",
        "testfield",
        "stations",
        "station",
        "optics",
        "sensor",
        "pointing",
    ],
);

/// Reads a scenario called `name` from the `text` of `file`, with the methods of `registry`.
///
/// # Errors
/// Every mistake with its place in the text.
pub fn parse(name: &str, file: &str, text: &str, registry: &Registry) -> Result<Scenario, Problems> {
    File { name, path: file, text, registry }.parse(None)
}

/// Reads cell `index` of a swept scenario: the scenario with the cell's values in their places.
///
/// # Errors
/// None for a scenario that [`parse`] returned, unless files that it names have changed since.
pub fn parse_cell(scenario: &Scenario, sweep: &Sweep, index: usize, registry: &Registry) -> Result<Scenario, Problems> {
    let file = File { name: &scenario.name, path: &sweep.file, text: &scenario.text, registry };
    Ok(Scenario { kinds: scenario.kinds.clone(), ..file.parse(Some(index))? })
}

/// A file to be read.
#[derive(Clone, Copy)]
struct File<'a> {
    name: &'a str,
    path: &'a str,
    text: &'a str,
    registry: &'a Registry,
}

impl File<'_> {
    /// The scenario, or one cell of it.
    fn parse(self, cell: Option<usize>) -> Result<Scenario, Problems> {
        let mut problems = Vec::new();
        let scenario = self.tables(cell, &mut problems);
        match scenario {
            Some(scenario) if problems.is_empty() => Ok(scenario),
            _ => {
                problems.sort_by_key(|problem| problem.span.start);
                Err(Problems { file: self.path.to_owned(), text: self.text.to_owned(), problems })
            }
        }
    }

    fn tables(self, cell: Option<usize>, problems: &mut Vec<Problem>) -> Option<Scenario> {
        let (root, errors) = DeTable::parse_recoverable(self.text);
        if !errors.is_empty() {
            problems.extend(errors.iter().map(|error| Problem::new(error.span().unwrap_or(0..0), error.message())));
            return None;
        }
        let mut root = root.into_inner();
        let swept = root.contains_key("sweep");
        match sweep::read::take(&mut root, self.text, self.path, problems) {
            Some(sweep) => self.cells(&root, sweep, cell, problems),
            None if swept => None,
            None => {
                let drawn = Drawn::of(&root, None);
                Some(read(self, root, &drawn, false, problems)?.0)
            }
        }
    }

    /// Checks every cell, or one. The scenario is that of the first, with the sweep beside it.
    fn cells(self, root: &DeTable<'_>, sweep: Sweep, cell: Option<usize>, problems: &mut Vec<Problem>) -> Option<Scenario> {
        let mut first: Option<(Scenario, Vec<Range<usize>>)> = None;
        let (mut kinds, mut lacking) = (Vec::new(), Vec::new());
        let drawn = Drawn::of(root, Some(&sweep));
        for index in cell.map_or(0..sweep.cells(), |index| index..index + 1) {
            let mut found = Vec::new();
            let table = sweep.replaced(root, index, self.registry, &mut found);
            let scenario = if found.is_empty() { read(self, table, &drawn, true, &mut found) } else { None };
            kinds.extend(scenario.iter().flat_map(|(scenario, _)| scenario.kinds.clone()));
            let plain = index == 0;
            for problem in found {
                if !problems.iter().any(|known| known.span == problem.span && known.message == problem.message) {
                    let help =
                        problem.help.clone().filter(|_| plain).or_else(|| (!plain).then(|| format!("in the cell {}", sweep.label(index))));
                    problems.push(Problem { help, ..problem });
                }
            }
            lacking.extend(scenario.iter().map(|(scenario, _)| without_board(&scenario.methods, &scenario.subject)));
            first = first.or(scenario);
            // What is wrong everywhere is said once; what is wrong here and there is not said a thousand times.
            if problems.len() >= MOST_PROBLEMS {
                break;
            }
        }
        let (scenario, listed_at) = first?;
        let (sweep, kinds) = (Some(sweep).filter(|_| cell.is_none()), once(&kinds));
        if sweep.is_some() && problems.is_empty() && scenario.methods.len() == listed_at.len() {
            check_busy(&scenario.methods, &listed_at, &kinds, problems);
            check_boards(&scenario.methods, &listed_at, &lacking, problems);
        }
        Some(Scenario { kinds, sweep, ..scenario })
    }
}

/// Each kind once.
fn once(kinds: &[TargetKind]) -> Vec<TargetKind> {
    TargetKind::ALL.into_iter().filter(|kind| kinds.contains(kind)).collect()
}

/// Cells are not checked further once there are this many problems.
const MOST_PROBLEMS: usize = 10;

fn read(
    file: File<'_>,
    root: DeTable<'_>,
    drawn: &Drawn,
    in_sweep: bool,
    problems: &mut Vec<Problem>,
) -> Option<(Scenario, Vec<Range<usize>>)> {
    let File { name, text, registry, .. } = file;
    let folder = Path::new(file.path).parent().unwrap_or(Path::new(""));
    let mut resolved = Resolved::of(&root);
    let mut root = Section { name: "the scenario", span: 0..text.lines().next().map_or(0, str::len), table: root };
    let listed = root.take_tables("method", "[[method]]", problems);
    let methods_missing = listed.as_ref().is_none_or(Vec::is_empty);
    let scene = root.take_table("scene", "[scene]", problems);
    let figure = root.take_table("figure", "[figure]", problems);
    let photographs = root.take_table("photographs", "[photographs]", problems);
    let print = root.take_table("printed", "[printed]", problems);
    let judged = root.take_table("judgement", "[judgement]", problems);
    let views = ViewTables::take(&mut root, problems);
    let imaging = ImagingTables::take(&mut root, problems);
    let studied = StudyTables::take(&mut root, problems);
    let transfer = root.take_table("transfer", "[transfer]", problems);
    let start = root.span.clone();
    if methods_missing && transfer.is_none() && print.is_none() && problems.is_empty() {
        problems.push(Problem::new(start.clone(), "the scenario lists no method").help("add a [[method]] table with a `name`"));
    }
    let listed = listed.unwrap_or_default();
    let listed_at: Vec<_> = listed.iter().map(|section| section.span.clone()).collect();
    let methods = methods(listed, registry, problems);
    let tables: Vec<&str> = TOP_TABLES.0.into_iter().chain(study_tables::keys()).chain(TOP_TABLES.1).collect();
    let head: Option<Head> = root.read(&tables, problems);
    let key = |of| Key { seed: head.as_ref().map_or(0, |head| head.seed.0), of, trial: 0, view: "", target: "" };
    let stray = views.span().or_else(|| imaging.span());
    let others = [&scene, &figure, &photographs, &judged].into_iter().flatten().chain(studied.tables());
    let other = others.map(|section| section.span.clone()).next().or_else(|| stray.clone());
    let other = other.or_else(|| listed_at.first().cloned());
    alone(transfer.as_ref(), [print.as_ref().map(|print| print.span.clone()), other.clone()], BESIDE_TRANSFER, problems)?;
    alone(print.as_ref(), [None, other], "nothing is measured there", problems)?;
    if views.span().is_none() {
        studied.without_field(problems);
    }
    let subject = match (scene, figure, photographs, views.span()) {
        (Some(section), None, None, None) => scene::read(section, imaging, problems).map(|scene| Subject::Scene(Box::new(scene))),
        (None, Some(figure), None, None) => figure::read(figure, imaging, problems).map(|scene| Subject::Scene(Box::new(scene))),
        (None, None, Some(photographs), None) if stray.is_none() => {
            photographs::read(photographs, judged, problems).map(Subject::Photographs)
        }
        (_, _, None, _) if judged.is_some() => {
            let message = "[judgement] without [photographs]: it judges calibrations of which no truth is known";
            problems.push(Problem::new(judged.map_or(start, |section| section.span), message));
            None
        }
        (None, None, None, Some(_)) => {
            let views = views.read(imaging, &start, folder, [key(&drawn.field), key(&drawn.all)], problems);
            views.and_then(|views| studied.read(views, &methods, problems)).map(|views| Subject::Views(Box::new(views)))
        }
        (None, None, None, None) if transfer.is_some() => transfer
            .and_then(|section| Surroundings { name, folder, registry, parse }.read(section, &mut resolved, problems))
            .map(|views| Subject::Views(Box::new(views))),
        (None, None, None, None) if print.is_some() => {
            print.and_then(|section| printed::read(section, problems)).map(|read| Subject::Printed(Box::new(read)))
        }
        (None, None, None, None) => {
            problems.push(nothing(start));
            None
        }
        (scene, figure, photographs, _) => {
            let subjects = [scene, figure, photographs].into_iter().flatten().map(|section| section.span);
            let second = subjects.chain(stray).nth(1).unwrap_or(start);
            problems.push(several(second));
            None
        }
    };
    let (head, subject) = (head?, subject?);
    let resolved = resolved.with_files_of(&subject);
    let kinds = once(&subject.kinds());
    if methods.len() == listed_at.len() {
        check_kinds(&methods, &listed_at, &kinds, in_sweep, problems);
        if !in_sweep {
            check_boards(&methods, &listed_at, &[without_board(&methods, &subject)], problems);
        }
    }
    let (trials, trials_span) = head.trials.map_or((1, 0..0), |trials| (trials.get_ref().0, trials.span()));
    let [why, source] = [("why", head.why), ("source", head.source)].map(|(key, value)| stated(key, value, problems));
    let bound_window = head.bound_window.map_or(BOUND_WINDOW, |window| window.0);
    let scenario = Scenario {
        name: name.to_owned(),
        why,
        source,
        notes: head.notes.unwrap_or_default(),
        nightly: head.nightly.unwrap_or(false),
        seed: head.seed.0,
        trials,
        methods,
        bound_window,
        bound_window_discs: head.bound_window_discs.map_or(bound_window, |window| window.0),
        subject,
        kinds,
        sweep: None,
        text: text.to_owned(),
        resolved,
        drawn: drawn.all.clone(),
    };
    Some((sensible_trials(scenario, &trials_span, in_sweep, problems), listed_at))
}

/// The scenario, with one trial where a sweep leaves nothing random: noise may be swept from nothing, and one trial says all of such a cell.
fn sensible_trials(scenario: Scenario, span: &Range<usize>, in_sweep: bool, problems: &mut Vec<Problem>) -> Scenario {
    let trials = scenario.trials;
    if trials <= 1 || !scenario.is_deterministic() {
        return scenario;
    }
    if !in_sweep {
        let problem = Problem::new(span.clone(), format!("{trials} trials of a scenario in which nothing is random"));
        problems.push(problem.help("expected 1, or `grey_noise`, `phase = \"uniform\"` or [scene.pointing]"));
    }
    Scenario { trials: 1, ..scenario }
}

fn nothing(start: Range<usize>) -> Problem {
    Problem::new(start, "the scenario has nothing to measure").help(
        "add a [scene] or [figure] table, [camera] with [testfield] and [stations], a [photographs] table, a [transfer] table, or a [printed] table",
    )
}

fn several(second: Range<usize>) -> Problem {
    let message = "more than one of [scene], [figure], [photographs] and [testfield] with its tables: expected one of them";
    Problem::new(second, message)
        .help("photographs have no camera, testfield, optics or sensor; a scene has no [camera] and no [pointing] of its own level")
}

/// What else would say what stands beside `[transfer]`.
const BESIDE_TRANSFER: &str = "its scenarios say what is pictured, and [[transfer.method]] what calibrates";

/// Whether nothing stands beside a table that must be alone, with the reason `why` it must.
fn alone(table: Option<&Section<'_>>, beside: [Option<Range<usize>>; 2], why: &str, problems: &mut Vec<Problem>) -> Option<()> {
    let (Some(table), Some(beside)) = (table, beside.into_iter().flatten().next()) else { return Some(()) };
    let problem = Problem::new(beside, format!("beside {}: {why}", table.name));
    problems.push(problem.help(format!("expected {} and its tables alone", table.name)));
    None
}

fn stated(key: &str, value: Spanned<String>, problems: &mut Vec<Problem>) -> String {
    if value.get_ref().trim().is_empty() {
        problems.push(Problem::new(value.span(), format!("`{key}` is empty: expected a sentence")));
    }
    value.into_inner()
}
