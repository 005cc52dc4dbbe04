//! Error vectors of check points.

use std::collections::BTreeMap;

use calibench_records::figures::Group;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::axes::Axes;
use crate::canvas::{Canvas, Mark};
use crate::field::{arrow, write};
use crate::load::adjustments::Summaries;
use crate::markdown::plain;

const WIDTH: i32 = 620;
const HEIGHT: i32 = 250;
/// From panel to panel, px.
const STEP: i32 = HEIGHT + 130;
/// The longest arrow, px.
const LONGEST: f64 = 60.0;

/// A point: true place and error.
pub(super) type Vectors = Vec<([f64; 3], [f64; 3])>;

/// A picture for each case whose points are kept, one panel a method: along the wall and upwards, so that the eye sees Y and Z; X is in the table.
pub fn pictures(found: &Summaries) -> Vec<(String, Canvas)> {
    let of = |set: &String| {
        let panels: Vec<(&str, Vectors)> = found.methods.iter().map(|method| (method.as_str(), vectors(found, method, set))).collect();
        let panels: Vec<_> = panels.into_iter().filter(|(_, vectors)| !vectors.is_empty()).collect();
        (!panels.is_empty()).then(|| (set.clone(), picture(&panels)))
    };
    found.sets.iter().filter_map(of).collect()
}

pub(super) fn vectors(found: &Summaries, method: &str, set: &str) -> Vectors {
    let mut points: BTreeMap<&str, ([f64; 3], [f64; 3])> = BTreeMap::new();
    for ((m, s, name), summary) in &found.figures {
        let is_meant = m == method && s == set && name.group() == Group::Object;
        // Other cases keep the points of the first trial alone, for the curious.
        let (true, Some((target, axis)), Some(first)) = (is_meant && summary.value.count > 1, name.text().rsplit_once('/'), summary.first)
        else {
            continue;
        };
        let (Some(axis), Some(error)) = (["X", "Y", "Z"].iter().position(|known| *known == axis), first.error) else { continue };
        let entry = points.entry(target).or_insert(([f64::NAN; 3], [0.0; 3]));
        (entry.0[axis], entry.1[axis]) = (first.value - error, error);
    }
    points.into_values().filter(|(at, _)| at.iter().all(|v| v.is_finite())).collect()
}

fn picture(panels: &[(&str, Vectors)]) -> Canvas {
    let all = || panels.iter().flat_map(|(_, vectors)| vectors);
    let span = |axis: usize| all().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], (at, _)| [a.min(at[axis]), b.max(at[axis])]);
    let ([left, right], [low, high]) = (span(1), span(2));
    // The longest arrow stays within the frame, wherever it starts.
    let room = |a: f64, b: f64, side: i32| (b - a).max(1e-3) * (LONGEST + 8.0) / (f64::from(side) - 2.0 * (LONGEST + 8.0));
    let (across, up) = (room(left, right, WIDTH), room(low, high, HEIGHT));
    let (x, y) = ([left - across, right + across], [low - up, high + up]);
    // Many panels stand in two columns, so that they are seen together.
    let columns = if panels.len() > 3 { 2 } else { 1 };
    let rows = panels.len().div_ceil(columns) as i32;
    let mut canvas = Canvas::new((columns as i32 * (WIDTH + 130)) as u32, (rows * STEP + 40) as u32);
    for (place, (method, vectors)) in panels.iter().enumerate() {
        let (column, row) = ((place % columns) as i32, (place / columns) as i32);
        let axes = Axes { at: [80 + column * (WIDTH + 130), 70 + row * STEP, WIDTH, HEIGHT], x, y };
        let longest = vectors.iter().map(|(_, e)| e[1].hypot(e[2])).fold(0.0, f64::max).max(1e-12);
        canvas.text(&format!("{method}: longest {} cm", plain(100.0 * longest)), 17, (axes.at[0] as u32, (axes.at[1] - 50) as u32));
        let mut marks = Vec::new();
        canvas.paint(|area| {
            axes.vertical(area, "Z");
            axes.horizontal(area, "Y");
            for (at, error) in vectors {
                let from = axes.place(at[1], at[2]);
                let scale = LONGEST / longest;
                let to = (from.0 + (scale * error[1]).round() as i32, from.1 - (scale * error[2]).round() as i32);
                arrow(area, from, to);
                marks.push((Mark::Dot, BLACK, (f64::from(from.0), f64::from(from.1))));
            }
            write(area, "arrows: Y and Z of the error", (axes.at[0] + WIDTH, axes.at[1] - 14), HPos::Right);
        });
        canvas.marks(&marks);
    }
    canvas
}
