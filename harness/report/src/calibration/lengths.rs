//! Measured distances, and lengths that were asked for.

use std::io;

use calibench_calibrate::{AdjustedLength, Calibration, CheckedDistance};
use calibench_files::NewFolder;

use super::csv::table;
use super::digits::rounded;
use crate::markdown::MarkdownTable;

/// A distance that the others check by less is not checked: it makes the scale.
const UNCHECKED: f64 = 1e-3;
/// Lengths that a page or a terminal lists.
const MOST: usize = 50;

/// Lengths, measured ones first; nothing where there are none.
pub(super) fn section(calibration: &Calibration<'_>) -> String {
    let lengths = calibration.lengths().unwrap_or_default();
    if lengths.is_empty() {
        return String::new();
    }
    let mut table = MarkdownTable::new(&["from", "to", "adjusted", "standard deviation", "measured", "its sigma", "w", "checked by"]);
    for AdjustedLength { targets: [from, to], value, sigma, measured } in lengths.iter().take(MOST) {
        let (value, deviation) = rounded(*value, *sigma);
        let (known, stated, w, checked) = measured.map_or_else(Default::default, of_measured);
        table.row([from.clone(), to.clone(), value, deviation, known, stated, w, checked]);
    }
    let rest = lengths.len().saturating_sub(MOST);
    let more = if rest > 0 { format!("\nand {rest} more in `distances.csv`\n") } else { String::new() };
    format!("\n## Lengths\n\n{}{more}", table.render())
}

fn of_measured(CheckedDistance { value, sigma, redundancy, w }: CheckedDistance) -> (String, String, String, String) {
    let is_checked = redundancy.is_some_and(|redundancy| redundancy > UNCHECKED);
    let by = match redundancy {
        Some(redundancy) if is_checked => format!("the others to {:.0} %", 100.0 * redundancy),
        _ => "nothing: the scale is its own".into(),
    };
    (value.to_string(), sigma.to_string(), w.filter(|_| is_checked).map_or_else(String::new, |w| format!("{w:.1}")), by)
}

/// All of them as CSV, where there are any.
pub(super) fn write(calibration: &Calibration<'_>, folder: &NewFolder) -> io::Result<()> {
    let lengths = calibration.lengths().map_err(io::Error::other)?;
    if lengths.is_empty() {
        return Ok(());
    }
    let rows = lengths.iter().map(|length| {
        let [from, to] = length.targets.clone();
        let measured = length.measured;
        let of = |get: fn(CheckedDistance) -> Option<f64>| measured.and_then(get).map_or_else(String::new, |value| value.to_string());
        let given = [of(|m| Some(m.value)), of(|m| Some(m.sigma)), of(|m| m.redundancy), of(|m| m.w)];
        [from, to, length.value.to_string(), length.sigma.to_string()].into_iter().chain(given).collect::<Vec<String>>()
    });
    let columns = ["target_a", "target_b", "length", "sigma", "measured", "sigma_measured", "redundancy", "w"];
    table(folder, "distances.csv", &columns, rows)
}
