//! The conditions of the page `which operator, when`, and the candidates under each.

use super::choose::Candidate;
use super::load::Part;
use crate::speeds::Speeds;

/// A row of the page.
pub struct Row {
    /// The conditions, in words.
    pub title: String,
    /// Its candidates.
    pub candidates: Vec<Candidate>,
    /// The cells of the sweep that it stands for; none where rows share cells.
    pub cells: Vec<usize>,
    /// Its condition is a speed.
    pub asks_for_speed: bool,
}

type Test<'a> = &'a dyn Fn(f64) -> bool;

const BLUR: &str = "optics.blur";
const NOISE: &str = "sensor.snr_contrast_db";

/// Blur by noise, in three classes each.
pub fn images(part: &Part, speeds: &Speeds) -> Vec<Row> {
    let blurs: [(&str, Test<'_>); 3] =
        [("sharp, blur to 0.5 px", &|b| b <= 0.5), ("usual, 0.7 and 1 px", &|b| b > 0.5 && b < 1.2), ("soft, from 1.4 px", &|b| b >= 1.2)];
    let noises: [(&str, Test<'_>); 3] =
        [("noise to 1 %", &|db| db > 37.0), ("noise 2 %", &|db| db <= 37.0 && db > 30.0), ("noise 5 and 10 %", &|db| db <= 30.0)];
    let pairs = blurs.iter().flat_map(|blur| noises.iter().map(move |noise| (blur, noise)));
    pairs
        .map(|(blur, noise)| row(part, speeds, format!("{}; {}", blur.0, noise.0), &part.cells(&[(BLUR, blur.1), (NOISE, noise.1)])))
        .collect()
}

/// The classes of one axis.
pub fn along(part: &Part, speeds: &Speeds, axis: &str, classes: &[(&str, Test<'_>)]) -> Vec<Row> {
    classes.iter().map(|(title, test)| row(part, speeds, (*title).to_owned(), &part.cells(&[(axis, test)]))).collect()
}

/// By the room for a window: each method with each window that fits is a candidate.
pub fn rooms(part: &Part, axis: &str, rooms: &[(&str, f64)]) -> Vec<Row> {
    let Some(place) = part.sweep.sweep.axes.iter().position(|known| known.path == axis) else { return Vec::new() };
    let of = |&(title, most): &(&str, f64)| {
        let windows = part.sweep.sweep.axes[place].values.iter().filter_map(|value| value.number).filter(|window| *window <= most);
        let candidates = windows.flat_map(|window| {
            let cells = part.cells(&[(axis, &|value: f64| value == window)]);
            let named = move |candidate: Candidate| Candidate { name: with_window(&candidate.name, window), ..candidate };
            candidates(part, &Speeds::default(), &cells).into_iter().map(named)
        });
        Row { title: title.to_owned(), candidates: candidates.collect(), cells: Vec::new(), asks_for_speed: false }
    };
    rooms.iter().map(of).collect()
}

/// By the speed that is needed: those that are slower, or whose speed is not known, are no candidates.
pub fn needs(part: &Part, speeds: &Speeds, least: &[f64]) -> Vec<Row> {
    let all = candidates(part, speeds, &usual(part));
    let of = |&least: &f64| Row {
        title: format!("at least {} points/s", super::frontier::short(least)),
        candidates: all.iter().filter(|candidate| candidate.speed.is_some_and(|speed| speed >= least)).cloned().collect(),
        cells: Vec::new(),
        asks_for_speed: true,
    };
    least.iter().map(of).collect()
}

/// The cells of usual blur with 2 % of noise, or all if the sweep has no such axes.
pub fn usual(part: &Part) -> Vec<usize> {
    let found = part.cells(&[(BLUR, &|b| b > 0.5 && b < 1.2), (NOISE, &|db| db <= 37.0 && db > 30.0)]);
    if !found.is_empty() {
        return found;
    }
    let blur = part.cells(&[(BLUR, &|b| b > 0.5 && b < 1.2)]);
    if blur.is_empty() { (0..part.sweep.cells.len()).collect() } else { blur }
}

fn with_window(name: &str, window: f64) -> String {
    let mark = if name.contains(':') { ',' } else { ':' };
    format!("{name}{mark}window={window}")
}

fn row(part: &Part, speeds: &Speeds, title: String, cells: &[usize]) -> Row {
    Row { title, candidates: candidates(part, speeds, cells), cells: cells.to_vec(), asks_for_speed: false }
}

/// The scenario whose image stands for those of `scenario`: `atlas/corners` for `atlas/corners-pose`.
fn family(scenario: &str) -> &str {
    scenario.split('-').next().unwrap_or(scenario)
}

/// All methods that measured, over `cells`.
pub fn candidates(part: &Part, speeds: &Speeds, cells: &[usize]) -> Vec<Candidate> {
    let available = part.sweep.methods.iter().enumerate().filter(|(_, method)| method.unavailable.is_none());
    let of = |(method, info): (usize, &crate::sweep::LoadedMethod)| {
        let scores: Vec<_> = cells.iter().filter_map(|cell| part.sweep.score(*cell, method)).collect();
        let bounded = scores.iter().filter_map(|score| Some((score.to_bound.mean()?, score.to_bound.count() as f64)));
        let (sum, count) = bounded.fold((0.0, 0.0), |(sum, count), (mean, n)| (sum + mean * n, count + n));
        Candidate {
            name: info.name.clone(),
            losses: part.losses(cells, method),
            failed: scores.iter().map(|score| score.points() - score.measured).sum(),
            points: scores.iter().map(|score| score.points()).sum(),
            ratio: (count > 0.0).then(|| (sum / count).sqrt()),
            speed: speeds.of(family(&part.sweep.name), &info.name).map(|speed| speed.points_per_second),
        }
    };
    available.map(of).collect()
}
