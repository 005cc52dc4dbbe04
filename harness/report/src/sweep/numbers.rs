//! The numbers behind a plot.

use std::io::Write;

use calibench_records::score::Score;

use super::layout::{Dimension, Layout};
use crate::load::sweep::LoadedSweep;

/// Writes what a plot shows as CSV, one row a point: the value of each swept key, method, figure, its 95 % interval, points and trials.
///
/// # Errors
/// What the output refuses.
pub fn write_numbers(output: impl Write, loaded: &LoadedSweep, layout: &Layout) -> Result<(), csv::Error> {
    let mut csv = csv::Writer::from_writer(output);
    let (metric, unit) = layout.metric.name();
    let paths = loaded.sweep.axes.iter().map(|axis| axis.path.as_str());
    csv.write_record(paths.chain(["method", "metric", "unit", "value", "low", "high", "points", "trials"]))?;
    for (_, panel) in layout.panels(loaded) {
        for by in layout.shown(loaded, layout.by) {
            for x in layout.shown(loaded, Dimension::Axis(layout.x)) {
                let at = panel.with(layout.by, by).with(Dimension::Axis(layout.x), x);
                let (cell, method) = (at.cell(loaded), at.method());
                let found = layout.estimate(loaded, &at);
                let text = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
                let interval = found.and_then(|found| found.interval);
                let mut row: Vec<String> = loaded.sweep.values(cell).iter().map(|value| value.text.clone()).collect();
                row.extend([loaded.methods[method].name.clone(), metric.into(), unit.into()]);
                row.extend([text(found.map(|found| found.value)), text(interval.map(|ends| ends.0)), text(interval.map(|ends| ends.1))]);
                row.push(loaded.score(cell, method).map_or(0, Score::points).to_string());
                row.push(loaded.cells[cell].trials.to_string());
                csv.write_record(&row)?;
            }
        }
    }
    Ok(csv.flush()?)
}
