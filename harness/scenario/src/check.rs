//! From the tables of a file to a checked scenario. All mistakes that can be told apart are reported together.

use std::ops::Range;
use std::path::Path;

use calibench_diagnostics::{Problem, Problems};
use calibench_measure::Registry;
use calibench_model::{PixelPoint, Polygon, Scene, SceneTarget, TargetKind};
use calibench_random::Key;
use calibench_synth::overlap::{crosses_itself, overlap};
use toml::Spanned;
use toml::de::DeTable;

use super::methods::methods;
use super::section::Section;
use super::sensor::Surroundings;
use super::sweep::Sweep;
use super::views::{ImagingTables, ViewTables};
use super::wire::{Head, PolygonWire, Position, SceneWire, TargetWire};
use super::{Pixels, Pointing, Scenario, SceneSubject, Starts, Subject, calibration, figure, photographs};
use crate::sweep;

/// The largest image, px: 400 megapixels take about 8 GB to render.
const MOST_PIXELS: usize = 400_000_000;

/// Side of the bound's window where the file gives none, px.
const BOUND_WINDOW: usize = 15;

/// The keys of the file's top level that are tables of their own.
pub const TOP_TABLES: [&str; 14] = [
    "sweep",
    "method",
    "calibration",
    "scene",
    "figure",
    "photographs",
    "judgement",
    "camera",
    "testfield",
    "stations",
    "station",
    "optics",
    "sensor",
    "pointing",
];
/// The keys of `[scene]` that are tables of their own.
pub const SCENE_TABLES: [&str; 3] = ["polygon", "target", "pointing"];

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
    File { name: &scenario.name, path: &sweep.file, text: &scenario.text, registry }.parse(Some(index))
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
            None => read(self, root, false, problems),
        }
    }

    /// Checks every cell, or one. The scenario is that of the first, with the sweep beside it.
    fn cells(self, root: &DeTable<'_>, sweep: Sweep, cell: Option<usize>, problems: &mut Vec<Problem>) -> Option<Scenario> {
        let mut first = None;
        for index in cell.map_or(0..sweep.cells(), |index| index..index + 1) {
            let mut found = Vec::new();
            let table = sweep.replaced(root, index, self.registry, &mut found);
            let scenario = if found.is_empty() { read(self, table, true, &mut found) } else { None };
            let plain = index == 0;
            for problem in found {
                if !problems.iter().any(|known| known.span == problem.span && known.message == problem.message) {
                    let help =
                        problem.help.clone().filter(|_| plain).or_else(|| (!plain).then(|| format!("in the cell {}", sweep.label(index))));
                    problems.push(Problem { help, ..problem });
                }
            }
            first = first.or(scenario);
            // What is wrong everywhere is said once; what is wrong here and there is not said a thousand times.
            if problems.len() >= MOST_PROBLEMS {
                break;
            }
        }
        let sweep = Some(sweep).filter(|_| cell.is_none());
        first.map(|scenario| Scenario { sweep, ..scenario })
    }
}

/// Cells are not checked further once there are this many problems.
const MOST_PROBLEMS: usize = 10;

fn read(file: File<'_>, root: DeTable<'_>, in_sweep: bool, problems: &mut Vec<Problem>) -> Option<Scenario> {
    let File { name, text, registry, .. } = file;
    let folder = Path::new(file.path).parent().unwrap_or(Path::new(""));
    let mut root = Section { name: "the scenario", span: 0..text.lines().next().map_or(0, str::len), table: root };
    let listed = root.take_tables("method", "[[method]]", problems);
    let methods_missing = listed.as_ref().is_none_or(Vec::is_empty);
    let scene = root.take_table("scene", "[scene]", problems);
    let figure = root.take_table("figure", "[figure]", problems);
    let photographs = root.take_table("photographs", "[photographs]", problems);
    let judged = root.take_table("judgement", "[judgement]", problems);
    let views = ViewTables::take(&mut root, problems);
    let imaging = ImagingTables::take(&mut root, problems);
    let calibration = root.take_table("calibration", "[calibration]", problems);
    let start = root.span.clone();
    if methods_missing && problems.is_empty() {
        problems.push(Problem::new(start.clone(), "the scenario lists no method").help("add a [[method]] table with a `name`"));
    }
    let methods = methods(listed.unwrap_or_default(), registry, problems);
    let head: Option<Head> = root.read(&TOP_TABLES, problems);
    let seed = head.as_ref().map_or(0, |head| head.seed.0);
    let key = Key { seed, scenario: name, trial: 0, view: "", target: "" };
    let stray = views.span().or_else(|| imaging.span());
    if let Some(stray) = calibration.as_ref().filter(|_| views.span().is_none()) {
        problems.push(Problem::new(stray.span.clone(), "[calibration] without [testfield]: expected one with [camera] and stations"));
    }
    let subject = match (scene, figure, photographs, views.span()) {
        (Some(scene), None, None, None) => read_scene(scene, imaging, problems).map(|scene| Subject::Scene(Box::new(scene))),
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
            let views = views.read(imaging, &start, folder, key, problems);
            views.and_then(|views| calibration::attach(calibration, views, &methods, problems)).map(|views| Subject::Views(Box::new(views)))
        }
        (None, None, None, None) => {
            let problem = Problem::new(start, "the scenario has nothing to measure");
            problems
                .push(problem.help("add a [scene] or [figure] table, [camera] with [testfield] and [stations], or a [photographs] table"));
            None
        }
        (scene, figure, photographs, _) => {
            let subjects = [scene, figure, photographs].into_iter().flatten().map(|section| section.span);
            let second = subjects.chain(stray).nth(1).unwrap_or(start);
            let message = "more than one of [scene], [figure], [photographs] and [testfield] with its tables: expected one of them";
            let problem = Problem::new(second, message);
            problems.push(problem.help(
                "photographs have no camera, testfield, optics or sensor; a scene has no [camera] and no [pointing] of its own level",
            ));
            None
        }
    };
    let (head, subject) = (head?, subject?);
    let trials_span = head.trials.as_ref().map(Spanned::span);
    let mut trials = head.trials.map_or(1, |trials| trials.into_inner().0);
    let [why, source] = [("why", head.why), ("source", head.source)].map(|(key, value)| stated(key, value, problems));
    let notes = head.notes.unwrap_or_default();
    let bound_window = head.bound_window.map_or(BOUND_WINDOW, |window| window.0);
    let scenario = Scenario {
        name: name.to_owned(),
        why,
        source,
        notes,
        seed: head.seed.0,
        trials,
        methods,
        bound_window,
        subject,
        sweep: None,
        text: text.to_owned(),
    };
    if in_sweep && scenario.is_deterministic() {
        // Noise may be swept from nothing: one trial says all of such a cell.
        trials = 1;
    }
    if trials > 1 && scenario.is_deterministic() {
        let problem = Problem::new(trials_span.unwrap_or(0..0), format!("{trials} trials of a scenario in which nothing is random"));
        problems.push(problem.help("expected 1, or `grey_noise`, `phase = \"uniform\"` or [scene.pointing]"));
    }
    Some(Scenario { trials, ..scenario })
}

fn stated(key: &str, value: Spanned<String>, problems: &mut Vec<Problem>) -> String {
    if value.get_ref().trim().is_empty() {
        problems.push(Problem::new(value.span(), format!("`{key}` is empty: expected a sentence")));
    }
    value.into_inner()
}

fn read_scene(mut section: Section<'_>, imaging: ImagingTables<'_>, problems: &mut Vec<Problem>) -> Option<SceneSubject> {
    let polygons = section.take_tables("polygon", "[[scene.polygon]]", problems).unwrap_or_default();
    let targets = section.take_tables("target", "[[scene.target]]", problems).unwrap_or_default();
    let pointing = section.take_table("pointing", "[scene.pointing]", problems);
    let pointed = pointing.is_some();
    let pointing = pointing.and_then(|section| Pointing::read(section, problems));
    let span = section.span.clone();
    for (missing, list) in [("polygon", polygons.is_empty()), ("target", targets.is_empty())] {
        if list {
            problems.push(Problem::new(span.clone(), format!("[scene] has no {missing}")).help(format!("add a [[scene.{missing}]] table")));
        }
    }
    let read = |sections: Vec<Section<'_>>, problems: &mut Vec<Problem>| {
        sections.into_iter().filter_map(|s| s.read::<PolygonWire>(&[], problems)).collect::<Vec<_>>()
    };
    let polygons = read(polygons, problems);
    let targets: Vec<TargetWire> = targets.into_iter().filter_map(|s| s.read(&[], problems)).collect();
    let wire: SceneWire = section.read(&SCENE_TABLES, problems)?;
    unique(polygons.iter().map(|p| &p.id), "polygon", problems);
    unique(targets.iter().map(|t| &t.id), "target", problems);
    check_size(&wire, problems);
    let (width, height) = (wire.width.get_ref().0, wire.height.get_ref().0);
    let areas = areas(&polygons, problems);
    let mut scene = Scene { width, height, background: wire.background.0, polygons: areas, targets: Vec::new() };
    let mut given = Vec::new();
    for target in &targets {
        given.extend(check_start(target, pointed, pointing.is_some(), problems));
        scene.targets.extend(check_target(target, &scene, problems));
    }
    let phase = wire.phase.unwrap_or_default();
    if phase == super::Phase::Uniform && !pointed {
        problems
            .push(Problem::new(span, "`phase = \"uniform\"` moves the targets: their starts must move too").help("add [scene.pointing]"));
    }
    let starts = pointing.map_or(Starts::Given(given), Starts::from);
    let pixels = wire.pixels.unwrap_or_default();
    check_imaging(&imaging, pixels, &wire, problems);
    let imaging = imaging.read(&surroundings(&scene), problems)?;
    Some(SceneSubject {
        scene,
        starts,
        pixels,
        bits: wire.bits.map(|bits| bits.0),
        grey_noise: wire.grey_noise.map_or(0.0, |n| n.0),
        phase,
        imaging,
    })
}

/// Drawn pixels have no lens, and a sensor's noise and levels are its own.
fn check_imaging(imaging: &ImagingTables<'_>, pixels: Pixels, wire: &SceneWire, problems: &mut Vec<Problem>) {
    if let Some(span) = imaging.span().filter(|_| pixels == Pixels::Centre) {
        problems.push(Problem::new(span, "[optics] or [sensor] beside `pixels = \"centre\"`: drawn pixels have neither"));
    }
    if let Some(span) = imaging.sensor_span().filter(|_| wire.bits.is_some() || wire.grey_noise.is_some()) {
        problems.push(Problem::new(span, "[sensor] beside `bits` or `grey_noise` of [scene]: expected them in [sensor]"));
    }
}

/// What a sensor's signal-to-noise ratios refer to.
pub(super) fn surroundings(scene: &Scene) -> Surroundings {
    let levels = || scene.polygons.iter().map(|polygon| polygon.grey).chain([scene.background]);
    let (low, high) = (levels().fold(f64::INFINITY, f64::min), levels().fold(f64::NEG_INFINITY, f64::max));
    Surroundings { contrast: Some(high - low), mean: Some(0.5 * (high + low)), ..Surroundings::default() }
}

fn unique<'a>(ids: impl Iterator<Item = &'a Spanned<String>>, what: &str, problems: &mut Vec<Problem>) {
    let mut seen: Vec<&str> = Vec::new();
    for id in ids {
        if id.get_ref().trim().is_empty() || id.get_ref().chars().any(char::is_control) {
            problems.push(Problem::new(id.span(), format!("the id of a {what} is a name, found {:?}", id.get_ref())));
        }
        if seen.contains(&id.get_ref().as_str()) {
            problems.push(Problem::new(id.span(), format!("{what} `{}` stands here a second time; expected each id once", id.get_ref())));
        }
        seen.push(id.get_ref());
    }
}

fn check_size(wire: &SceneWire, problems: &mut Vec<Problem>) {
    let (width, height) = (wire.width.get_ref().0, wire.height.get_ref().0);
    if width * height > MOST_PIXELS {
        let gigabytes = width as f64 * height as f64 * 20.0 / 1e9;
        let message = format!("an image of {width} x {height} px needs about {gigabytes:.0} GB: expected at most 400 megapixels");
        problems.push(Problem::new(span_of_both(wire.width.span(), wire.height.span()), message));
    }
}

fn span_of_both(a: Range<usize>, b: Range<usize>) -> Range<usize> {
    a.start.min(b.start)..a.end.max(b.end)
}

fn point(at: &Position) -> PixelPoint {
    PixelPoint::new(at.0, at.1)
}

fn areas(wires: &[PolygonWire], problems: &mut Vec<Problem>) -> Vec<Polygon> {
    let mut areas: Vec<Polygon> = Vec::new();
    for wire in wires {
        let vertices: Vec<PixelPoint> = wire.vertices.get_ref().iter().map(point).collect();
        let (span, count) = (wire.vertices.span(), vertices.len());
        let area = Polygon { id: wire.id.get_ref().clone(), vertices, grey: wire.grey.0 };
        let wrong = if count < 3 {
            Some(format!("a polygon has at least 3 vertices, found {count}"))
        } else if area.doubled_area().abs() < 1e-9 {
            Some("the polygon has no area".to_owned())
        } else if let Some(at) = crosses_itself(&area) {
            Some(format!("the polygon crosses or touches itself at ({}, {})", at.x, at.y))
        } else {
            let met = areas.iter().find_map(|other| overlap(&area, other).map(|at| (other, at)));
            met.map(|(other, at)| format!("polygon `{}` overlaps polygon `{}` at ({:.3}, {:.3})", area.id, other.id, at.x, at.y))
        };
        match wrong {
            Some(message) => problems.push(Problem::new(span, message)),
            None => areas.push(area),
        }
    }
    areas
}

/// The start that a target gives; `conflict` if one beside [scene.pointing] is to be reported, which a mistake in that table makes idle.
fn check_start(wire: &TargetWire, pointed: bool, conflict: bool, problems: &mut Vec<Problem>) -> Option<PixelPoint> {
    match (&wire.start, pointed) {
        (Some(start), false) => Some(point(start.get_ref())),
        (None, true) => None,
        (Some(_), true) if !conflict => None,
        (Some(start), true) => {
            problems.push(Problem::new(start.span(), "`start` beside [scene.pointing]: expected one of them"));
            None
        }
        (None, false) => {
            let problem = Problem::new(wire.id.span(), format!("target `{}` has no `start`", wire.id.get_ref()));
            problems.push(problem.help("give its `start`, or say in [scene.pointing] how a hand points at it"));
            None
        }
    }
}

fn check_target(wire: &TargetWire, scene: &Scene, problems: &mut Vec<Problem>) -> Option<SceneTarget> {
    let at = point(wire.at.get_ref());
    let kind = wire.kind.get_ref().parse::<TargetKind>();
    let kind = kind.map_err(|error| {
        let names = TargetKind::ALL.map(TargetKind::name);
        problems.push(Problem::new(wire.kind.span(), error.to_string()).nearest(wire.kind.get_ref(), names));
    });
    let corner = at.to_corner();
    if corner.x < 0.0 || corner.y < 0.0 || corner.x > scene.width as f64 || corner.y > scene.height as f64 {
        let message = format!("target `{}` lies outside the image of {} x {} px", wire.id.get_ref(), scene.width, scene.height);
        problems.push(Problem::new(wire.at.span(), message));
    } else if matches!(kind, Ok(TargetKind::Corner | TargetKind::ChessCorner)) {
        let vertices = scene.polygons.iter().flat_map(|polygon| &polygon.vertices);
        let nearest = vertices.min_by(|a, b| a.distance(at).total_cmp(&b.distance(at)));
        if let Some(vertex) = nearest.filter(|vertex| vertex.distance(at) > 1e-9) {
            let message = format!("target `{}` at ({}, {}) is no vertex of a polygon", wire.id.get_ref(), at.x, at.y);
            problems.push(Problem::new(wire.at.span(), message).help(format!("the nearest vertex is ({}, {})", vertex.x, vertex.y)));
        }
    }
    Some(SceneTarget { id: wire.id.get_ref().clone(), kind: kind.ok()?, at })
}
