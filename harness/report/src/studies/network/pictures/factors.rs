//! Reduction factors of all interior and exterior parameters.

use calibench_records::figures::{FigureName, Group, Quantity};
use plotters::prelude::*;

use crate::axes::{Axes, upright, whisker};
use crate::canvas::{COLOURS, Canvas, Mark};
use crate::load::adjustments::Summaries;
use crate::plain;

const BAR: i32 = 18;

/// Bars: the ratio of reported standard deviations, mean over the trials. Circles: that of true errors, with 95 % intervals.
pub fn factors(found: &Summaries, method: &str) -> Option<Canvas> {
    let interior = found.scored().into_iter().map(|name| Quantity::Parameter.of(&[name]));
    let exterior =
        found.figures.keys().filter(|(m, set, name)| m == method && name.group() == Group::Eop && Some(set) == found.sets.first());
    let mut names: Vec<FigureName> = exterior.map(|(.., name)| name.clone()).collect();
    names.sort_by_key(|name| order(name.text()));
    let all: Vec<FigureName> = interior.chain(names).collect();
    let values: Vec<_> = all
        .iter()
        .filter_map(|name| {
            let summary = found.get(method, name.clone())?;
            Some((name.clone(), summary.sigma_ratio.mean()?, summary.errors.ratio()))
        })
        .collect();
    if values.is_empty() {
        return None;
    }
    let width = values.len() as i32 * BAR;
    let highest = values.iter().filter_map(|v| v.2.map(|(r, h)| r + h.unwrap_or(0.0))).fold(1.05_f64, f64::max).min(2.0);
    let axes = Axes { at: [70, 90, width, 320], x: [0.0, values.len() as f64], y: [0.0, highest] };
    let mut canvas = Canvas::new((width + 100) as u32, 520);
    canvas.text(&format!("Reduction factor of every parameter, {method} over {}", found.methods.first()?), 20, (70, 22));
    canvas.text("bars: reported standard deviations (dark: interior, light: exterior orientation)", 16, (90, 48));
    canvas.text("true errors, with 95 % intervals", 16, (760, 48));
    canvas.marks(&[(Mark::Circle, COLOURS[0], (745.0, 48.0))]);
    canvas.paint(|area| {
        axes.vertical(area, "reduction factor");
        for (i, (name, ratio, _)) in values.iter().enumerate() {
            let colour = if name.group() == Group::Iop { COLOURS[1] } else { COLOURS[5] };
            let (left, top) = axes.place(i as f64 + 0.15, *ratio);
            let (right, bottom) = axes.place(i as f64 + 0.85, 0.0);
            area.draw(&Rectangle::new([(left, top), (right, bottom)], colour.filled())).ok();
            upright(area, name.text(), (axes.place(i as f64 + 0.5, 0.0).0 - 6, bottom + 6));
        }
        axes.level(area, 1.0, RGBColor(120, 120, 120));
        for (i, (.., truth)) in values.iter().enumerate() {
            if let Some((ratio, Some(half))) = truth {
                whisker(area, &axes, i as f64 + 0.5, (ratio - half, ratio + half), COLOURS[0]);
            }
        }
    });
    canvas.say_as(["parameter", "by reported standard deviations", "by true errors", "95 % from", "to", "trials"]);
    for (i, (name, ratio, truth)) in values.iter().enumerate() {
        let Some((of_errors, half)) = truth else { continue };
        let trials = found.get(method, name.clone()).map_or(0, |summary| summary.value.count);
        let (x, y) = axes.place(i as f64 + 0.5, of_errors.min(highest));
        let ends = half.map(|half| (of_errors - half, of_errors + half));
        canvas.say_estimate((f64::from(x), f64::from(y)), &[name.text(), &plain(*ratio)], (*of_errors, ends), &[&trials.to_string()]);
    }
    let marks = values.iter().enumerate().filter_map(|(i, v)| {
        let (x, y) = axes.place(i as f64 + 0.5, v.2?.0.min(highest));
        Some((Mark::Circle, COLOURS[0], (f64::from(x), f64::from(y))))
    });
    canvas.marks(&marks.collect::<Vec<_>>());
    Some(canvas)
}

/// Images by number where their names are numbers, parameters in their usual order.
fn order(name: &str) -> (u64, String, usize) {
    let (image, parameter) = name.split_once('/').unwrap_or((name, ""));
    let usual = ["X0", "Y0", "Z0", "omega", "phi", "kappa"];
    (image.parse().unwrap_or(u64::MAX), image.to_owned(), usual.iter().position(|known| *known == parameter).unwrap_or(usual.len()))
}
