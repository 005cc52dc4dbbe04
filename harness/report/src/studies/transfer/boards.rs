//! A sweep of calibrations that are applied elsewhere: how many views, how tilted, where.

use std::collections::BTreeMap;
use std::sync::Arc;

use calibench_model::median;
use calibench_records::adjustments::{Numbers, Row};
use calibench_records::figures::Quantity;
use plotters::prelude::*;

use super::cases::hundredths;
use crate::axes::Axes;
use crate::canvas::{COLOURS, Canvas, METHOD_MARKS, OwnMark};
use crate::load::adjustments::{Summaries, Summary};
use crate::markdown::{MarkdownTable, fixed};
use crate::plain;

/// What was found under one combination of swept values.
pub struct Cell {
    /// The values, as they stand in the file, in the order of the axes.
    pub values: Vec<String>,
    /// The figures.
    pub found: Summaries,
    /// The median distance from the true camera over the frame, px, by method.
    pub medians: BTreeMap<String, f64>,
}

/// Distances from the true camera by method, px, of the first set that has one. A few trials stand in each cell: they are kept together.
#[derive(Default)]
pub struct Distances {
    values: BTreeMap<Arc<str>, Vec<f64>>,
    sets: BTreeMap<Arc<str>, Arc<str>>,
}

impl Distances {
    /// Adds what a row says of them.
    pub fn add(&mut self, row: &Row) {
        let Row { method, set, figure: Ok((name, Numbers { value, .. })), .. } = row else { return };
        if name.quantity() != Quantity::OverFrame {
            return;
        }
        if self.sets.entry(method.clone()).or_insert_with(|| set.clone()) == set {
            self.values.entry(method.clone()).or_default().push(*value);
        }
    }

    /// Their medians, px.
    pub fn medians(self) -> BTreeMap<String, f64> {
        self.values.into_iter().filter_map(|(method, values)| Some((method.to_string(), median(values)?))).collect()
    }
}

/// A row a cell and method: the camera, its own opinion of c beside the truth, and check points under every case.
pub fn table(axes: &[String], cells: &[Cell]) -> String {
    let Some(first) = cells.first() else { return String::new() };
    let is_case = |set: &&String| first.found.figures.keys().any(|(_, s, name)| s == *set && name.quantity() == Quantity::RmseXy);
    let cases: Vec<&String> = first.found.sets.iter().filter(is_case).collect();
    let mut header: Vec<String> = axes.iter().map(|axis| format!("`{axis}`")).collect();
    header.extend(["method", "camera, px: median", "mean", "sigma of c, um", "true error of c, um"].map(str::to_owned));
    header.extend(cases.iter().map(|case| format!("planimetric, {case}")));
    header.push("failed".into());
    let mut rows = MarkdownTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    // What the axes do not touch is told once.
    let same = |method: &&String| cells.len() > 1 && cells.iter().all(|cell| cell.medians.get(*method) == first.medians.get(*method));
    let (fixed_ones, changing): (Vec<&String>, Vec<&String>) = first.found.methods.iter().partition(same);
    for cell in cells {
        for &method in &changing {
            let um = |value: Option<f64>| value.map_or_else(String::new, |value| fixed(1e3 * value, 1));
            let c = cell.found.parameter(method, "c");
            let mut row = cell.values.clone();
            row.push(method.clone());
            row.push(cell.medians.get(method).map_or_else(String::new, |value| fixed(*value, 2)));
            row.push(
                cell.found.get(method, Quantity::OverFrame).and_then(|s| s.value.mean()).map_or_else(String::new, |value| fixed(value, 2)),
            );
            row.push(um(c.and_then(|c: &Summary| c.sigma.mean())));
            row.push(um(c.and_then(|c| c.square.mean()).map(f64::sqrt)));
            row.extend(cases.iter().map(|case| hundredths(cell.found.of_set(method, case, Quantity::RmseXy))));
            row.push(cell.found.failures(method, None).to_string());
            rows.row(row);
        }
    }
    format!(
        "The camera over the frame: distance from the true one after the best rotation, root mean square in px, median and mean of {} trials. Check points: root mean square in hundredths of the object unit, mean ± half its 95 % interval.{}\n\n{}\n",
        first.found.trials,
        untouched(first, &cases, &fixed_ones),
        rows.render()
    )
}

/// A sentence on the methods that no axis touches.
fn untouched(cell: &Cell, cases: &[&String], methods: &[&String]) -> String {
    let of = |method: &&String| {
        let errors = cases.iter().map(|case| format!("{} ({case})", hundredths(cell.found.of_set(method, case, Quantity::RmseXy))));
        let median = cell.medians.get(*method).map_or_else(String::new, |value| fixed(*value, 2));
        format!(" The same everywhere: {method}, {median} px in the median, planimetric {}.", errors.collect::<Vec<_>>().join(", "))
    };
    methods.iter().map(of).collect()
}

/// A place of a curve: value along x, median of the camera's error, px.
#[derive(Clone, Copy)]
struct Place {
    x: f64,
    median: f64,
    trials: u64,
}

/// By the values of the other axes and the method.
type Curves = BTreeMap<(String, String), Vec<Place>>;

/// The median over the first axis, a curve for each value of the others and each method; `None` where the first axis has fewer than two numbers.
pub fn picture(axes: &[String], cells: &[Cell]) -> Option<Canvas> {
    let mut curves = Curves::new();
    for cell in cells {
        let x: f64 = cell.values.first()?.parse().ok()?;
        let others = axes.iter().zip(&cell.values).skip(1).map(|(axis, value)| format!("{axis} {value}")).collect::<Vec<_>>().join(", ");
        for (method, median) in cell.medians.iter().filter(|(_, median)| **median > 0.0) {
            // What the axes do not touch is the same everywhere.
            curves.entry((others.clone(), method.clone())).or_default().push(Place { x, median: *median, trials: cell.found.trials });
        }
    }
    let changing = |points: &[Place]| points.windows(2).any(|pair| (pair[0].median / pair[1].median - 1.0).abs() > 1e-9);
    let panels: Vec<String> =
        curves.keys().map(|(others, _)| others.clone()).collect::<std::collections::BTreeSet<_>>().into_iter().collect();
    let methods: Vec<String> = {
        let mut known: Vec<String> = Vec::new();
        cells
            .first()?
            .found
            .methods
            .iter()
            .filter(|m| curves.iter().any(|((_, method), points)| method == *m && changing(points)))
            .for_each(|m| known.push(m.clone()));
        known
    };
    let all: Vec<Place> =
        curves.iter().filter(|((_, method), _)| methods.contains(method)).flat_map(|(_, points)| points.clone()).collect();
    let span = |of: fn(&Place) -> f64| all.iter().map(of).fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
    let ([left, right], [low, high]) = (span(|p| p.x), span(|p| p.median));
    if methods.is_empty() || right <= left {
        return None;
    }
    Some(drawn(&axes[0], &panels, &methods, &curves, ([left, right], [low, high])))
}

const PANEL: [i32; 2] = [330, 260];
const COLUMNS: usize = 3;

fn drawn(axis: &str, panels: &[String], methods: &[String], curves: &Curves, ([left, right], [low, high]): ([f64; 2], [f64; 2])) -> Canvas {
    let rows = panels.len().div_ceil(COLUMNS) as i32;
    let columns = panels.len().min(COLUMNS) as i32;
    let (width, height) = (columns * (PANEL[0] + 90) + 20, 60 + rows * (PANEL[1] + 100) + 26 * methods.len() as i32);
    let mut canvas = Canvas::new(width as u32, height as u32);
    canvas.text("Error of the camera over the frame, px (median; both scales logarithmic)", 19, (20, 14));
    let (x, y) = ([left.log10() - 0.05, right.log10() + 0.05], [low.log10().floor(), high.log10().ceil()]);
    let look = |i: usize| (METHOD_MARKS[i % METHOD_MARKS.len()], COLOURS[i % COLOURS.len()]);
    canvas.say_as(["", "method", axis, "error of the camera (median), px", "trials"]);
    let mut marks: Vec<OwnMark<'_>> = Vec::new();
    for (place, panel) in panels.iter().enumerate() {
        let at = [60 + (place % COLUMNS) as i32 * (PANEL[0] + 90), 80 + (place / COLUMNS) as i32 * (PANEL[1] + 100), PANEL[0], PANEL[1]];
        let axes = Axes { at, x, y };
        let xs: std::collections::BTreeSet<u64> =
            curves.iter().filter(|((others, _), _)| others == panel).flat_map(|(_, points)| points.iter().map(|p| p.x.to_bits())).collect();
        canvas.paint(|area| {
            axes.decades(area, panel);
            axes.values(area, axis, &xs.into_iter().map(f64::from_bits).collect::<Vec<_>>());
        });
        for (i, method) in methods.iter().enumerate() {
            let Some(points) = curves.get(&(panel.clone(), method.clone())) else { continue };
            let line: Vec<(i32, i32)> = points.iter().map(|point| axes.place(point.x.log10(), point.median.log10())).collect();
            let places: Vec<(f64, f64)> = line.iter().map(|(x, y)| (f64::from(*x), f64::from(*y))).collect();
            marks.extend(places.iter().map(|at| (Some(&**method), (look(i).0, look(i).1, *at))));
            canvas.of(Some(method), |canvas| {
                canvas.paint(|area| {
                    area.draw(&PathElement::new(line, ShapeStyle::from(&look(i).1).stroke_width(2))).ok();
                });
                for (point, at) in points.iter().zip(places) {
                    let texts = [panel.clone(), method.clone(), point.x.to_string(), plain(point.median), point.trials.to_string()];
                    canvas.say(at, texts);
                }
            });
        }
    }
    for (i, method) in methods.iter().enumerate() {
        let y = 60 + rows * (PANEL[1] + 100) + 26 * i as i32;
        marks.push((Some(method), (look(i).0, look(i).1, (40.0, f64::from(y - 4)))));
        canvas.of(Some(method), |canvas| canvas.text(method, 16, (58, (y - 4) as u32)));
    }
    canvas.marks_of(&marks);
    canvas
}
