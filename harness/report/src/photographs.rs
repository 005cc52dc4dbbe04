//! Photographs: how far the operators differ, where they refuse, and pictures of both.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use calibench_images::photo::Levels;
use calibench_model::{PixelPoint, escape, median};
use calibench_records::description::{Study, looks};
use calibench_records::judgement::Summary;
use calibench_records::stored::read_judgement;

use super::canvas::Canvas;
use super::figures::{Layer, MarkAt, Panel, Window, panels};
use super::load::Loaded;
use super::markdown::{MarkdownTable, fixed};
use super::scores_section::reasons;

type PointKey = (Arc<str>, Arc<str>);

/// One point in the hands of all methods.
struct Compared {
    key: PointKey,
    positions: Vec<Option<PixelPoint>>,
}

impl Compared {
    /// The middle of what the operators measured: the median of x and of y; `None` if fewer than two measured it.
    fn middle(&self, operators: &[usize]) -> Option<PixelPoint> {
        let found: Vec<PixelPoint> = operators.iter().filter_map(|&m| self.positions[m]).collect();
        if found.len() < 2 {
            return None;
        }
        Some(PixelPoint::new(median(found.iter().map(|p| p.x))?, median(found.iter().map(|p| p.y))?))
    }

    /// How far method `method` is from that middle, px.
    fn off(&self, method: usize, operators: &[usize]) -> Option<f64> {
        Some(self.positions[method]?.distance(self.middle(operators)?))
    }
}

/// How many points a picture shows of each operator, and how many an operator's refusals are shown by.
const SHOWN: usize = 5;
/// Columns and rows of a panel, px of the photograph.
const SIDE: u32 = 31;

/// A point to be shown: whose, and what is said of it.
struct Chosen<'a> {
    point: &'a Compared,
    title: String,
}

/// What a section says.
pub struct Said {
    /// The verdict on operator and model in a sentence or two, where there is one.
    pub answer: Option<String>,
    /// The text of the section.
    pub text: String,
    /// Its pictures, with their file names.
    pub pictures: Vec<(String, Canvas)>,
}

/// The section of photographs.
pub fn section(loaded: &Loaded) -> Said {
    if let Some(why) = loaded.unavailable() {
        let text = format!(
            "**unavailable**: {why}.\n\nThe photographs are not part of this project; the README says where they come from and where to put them.\n"
        );
        return Said { answer: None, text, pictures: Vec::new() };
    }
    let points = compared(loaded);
    let operators: Vec<usize> = (0..loaded.head.methods.len()).filter(|&m| looks(&loaded.head.methods[m].label)).collect();
    let Said { answer, mut text, mut pictures } = judged(loaded);
    text.push_str("### What was measured\n\n");
    text.push_str(&seen(loaded, &points));
    text.push_str(&counts(loaded));
    text.push_str(&differences(loaded, &points));
    let furthest = operators.iter().flat_map(|&m| ranked(loaded, &points, m, &operators).into_iter().take(SHOWN)).collect::<Vec<_>>();
    let usual = operators.iter().flat_map(|&m| {
        let ranked = ranked(loaded, &points, m, &operators);
        let middle = ranked.len().saturating_sub(SHOWN) / 2;
        ranked.into_iter().skip(middle).take(SHOWN)
    });
    let usual = usual.collect::<Vec<_>>();
    let refused = operators.iter().flat_map(|&m| {
        let refused = points.iter().filter(move |p| p.positions[m].is_none());
        refused.take(SHOWN).map(move |point| Chosen { point, title: title(loaded, point, m, None) })
    });
    let refused = refused.collect::<Vec<_>>();
    for (name, heading, about, chosen) in [
        (
            "furthest",
            "Where each is furthest from the others",
            "For each operator the five points at which it is furthest from the middle of all.",
            furthest,
        ),
        ("usual", "Where each is as usual", "For each operator five points in the middle of that ranking.", usual),
        ("refused", "Where one refuses", "For each operator the first five points that it rejected.", refused),
    ] {
        if let Some(picture) = picture(loaded, &chosen, &operators) {
            text.push_str(&format!(
                "### {heading}\n\n{about} The middle is the median of x and of y over all operators. {SIDE} x {SIDE} px, enlarged 8 times; the title gives operator, \
                 photograph, corner and distance. Distances below a tenth of a pixel cannot be seen here; the table above has them.\n\n![{heading}]({name}.png)\n\n"
            ));
            pictures.push((format!("{name}.png"), picture));
        }
    }
    Said { answer, text, pictures }
}

/// What the photographs say of operators and models, if the scenario asks for it.
fn judged(loaded: &Loaded) -> Said {
    match judgement_of(loaded) {
        None => Said { answer: None, text: String::new(), pictures: Vec::new() },
        Some(Ok(summary)) => {
            let (text, pictures) = super::judgement::section(&summary);
            Said { answer: super::judgement::answer(&summary), text, pictures }
        }
        Some(Err(why)) => {
            let text = format!("**unavailable**: the records of the judgement cannot be read ({why}): run the scenario again.\n\n");
            Said { answer: None, text, pictures: Vec::new() }
        }
    }
}

/// The judgement that the scenario asks for, or why its records cannot be read.
fn judgement_of(loaded: &Loaded) -> Option<Result<Summary, String>> {
    let wanted = matches!(loaded.scenario.study, Study::Photographs { judged: true });
    let read = || read_judgement(&loaded.folder, &loaded.name).map_err(|error| error.to_string());
    wanted.then(|| read().map(|(seed, rows)| Summary::new(&rows, seed)))
}

/// The points that `method` measured, the one furthest from the others first.
fn ranked<'a>(loaded: &Loaded, points: &'a [Compared], method: usize, operators: &[usize]) -> Vec<Chosen<'a>> {
    let mut found: Vec<(f64, &Compared)> = points.iter().filter_map(|p| Some((p.off(method, operators)?, p))).collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.into_iter().map(|(off, point)| Chosen { point, title: title(loaded, point, method, Some(off)) }).collect()
}

fn title(loaded: &Loaded, point: &Compared, method: usize, off: Option<f64>) -> String {
    let operator = loaded.head.methods[method].label.split(':').next().unwrap_or_default();
    let photograph = point.key.0.split('.').next().unwrap_or_default();
    let off = off.map_or(String::new(), |off| format!(" {} px", fixed(off, 2)));
    format!("{operator}, {photograph} {}{off}", point.key.1)
}

fn compared(loaded: &Loaded) -> Vec<Compared> {
    let methods = loaded.head.methods.len();
    let mut places: BTreeMap<PointKey, usize> = BTreeMap::new();
    let mut points: Vec<Compared> = Vec::new();
    for point in &loaded.first.points {
        let key = (point.view.clone(), point.target.clone());
        let place = *places.entry(key.clone()).or_insert_with(|| {
            points.push(Compared { key, positions: vec![None; methods] });
            points.len() - 1
        });
        points[place].positions[point.method] = point.outcome.position();
    }
    points
}

fn seen(loaded: &Loaded, points: &[Compared]) -> String {
    let mut views: Vec<&str> = points.iter().map(|p| &*p.key.0).collect();
    views.dedup();
    views.sort_unstable();
    views.dedup();
    let missed = &loaded.first.missed_views;
    let mut text =
        format!("The board was found in {} of {} photographs, {} corners in all.", views.len(), views.len() + missed.len(), points.len());
    for (view, why) in missed {
        text.push_str(&format!(" {}: {}.", escape::code(view), escape::markdown(why)));
    }
    if let Some((name, version)) = &loaded.head.run.detector {
        text.push_str(&format!(" Detector: `{name}`, version {version}."));
    }
    text.push_str(
        " Every operator starts from the same whole pixels: the detected corners, rounded. The truth is not known; a small difference \
         between two operators does not say that either is right.\n\n",
    );
    text
}

fn counts(loaded: &Loaded) -> String {
    let mut rows = MarkdownTable::new(&["method", "version", "points", "measured", "rejected"]);
    for (info, score) in loaded.head.methods.iter().zip(&loaded.scores.methods) {
        let label = format!("`{}`", info.label);
        match &info.unavailable {
            Some(why) => rows.row([label, info.version.to_string(), "unavailable".into(), why.clone()]),
            None => rows.row([label, info.version.to_string(), score.points().to_string(), score.measured.to_string(), reasons(score)]),
        }
    }
    format!("### How many points each measured\n\n{}\n", rows.render())
}

fn differences(loaded: &Loaded, points: &[Compared]) -> String {
    let mut rows = MarkdownTable::new(&["between", "points", "median px", "95 % px", "worst px", "worst point"]);
    let label = |m: usize| &loaded.head.methods[m].label;
    let methods = loaded.head.methods.len();
    for (a, b) in (0..methods).flat_map(|a| (a + 1..methods).map(move |b| (a, b))) {
        let distance = |p: &Compared| Some((p.positions[a]?.distance(p.positions[b]?), p.key.clone()));
        let mut found: Vec<(f64, PointKey)> = points.iter().filter_map(distance).collect();
        found.sort_by(|x, y| x.0.total_cmp(&y.0));
        let Some((worst, (view, target))) = found.last() else { continue };
        rows.row([
            format!("`{}` and `{}`", label(a), label(b)),
            found.len().to_string(),
            fixed(quantile(&found, 0.5), 4),
            fixed(quantile(&found, 0.95), 4),
            fixed(*worst, 4),
            format!("{target} of {view}"),
        ]);
    }
    format!(
        "### How far they differ\n\nDistances between the positions of two operators, over the points that both measured. `pixel` is the start.\n\n{}\n",
        rows.render()
    )
}

/// The quantile of sorted values: the smallest that at least the share `q` does not exceed.
fn quantile(sorted: &[(f64, PointKey)], q: f64) -> f64 {
    let rank = (q * sorted.len() as f64).ceil() as usize;
    sorted[rank.clamp(1, sorted.len()) - 1].0
}

fn picture(loaded: &Loaded, chosen: &[Chosen<'_>], operators: &[usize]) -> Option<Canvas> {
    let available: Vec<usize> = operators.iter().copied().filter(|&m| loaded.head.methods[m].unavailable.is_none()).collect();
    let mut layers = vec![Layer::start()];
    layers.extend(Layer::methods(available.iter().map(|&m| &*loaded.head.methods[m].label)));
    let start = loaded.method("pixel");
    let panel = |Chosen { point, title }: &Chosen<'_>, image: &Levels| {
        let started = start.and_then(|m| point.positions[m]);
        let mut marks: Vec<MarkAt> = started.map(|at| MarkAt { layer: 0, at }).into_iter().collect();
        marks.extend(available.iter().enumerate().filter_map(|(i, &m)| Some(MarkAt { layer: i + 1, at: point.positions[m]? })));
        let centre = started.or_else(|| point.positions.iter().copied().flatten().next())?;
        Some(Panel { title: title.clone(), window: Window::around(image, centre, SIDE), marks })
    };
    // One photograph at a time: there may be many, and of each a few pixels are shown.
    let views: BTreeSet<&str> = chosen.iter().map(|chosen| &*chosen.point.key.0).collect();
    let mut found: BTreeMap<usize, Panel> = BTreeMap::new();
    for view in views {
        let Some(image) = loaded.levels(view) else { continue };
        let of_view = chosen.iter().enumerate().filter(|(_, chosen)| *chosen.point.key.0 == *view);
        found.extend(of_view.filter_map(|(place, chosen)| Some((place, panel(chosen, &image)?))));
    }
    let found: Vec<Panel> = found.into_values().collect();
    (!found.is_empty()).then(|| panels(&found, &layers, SIDE, 8, SHOWN))
}
