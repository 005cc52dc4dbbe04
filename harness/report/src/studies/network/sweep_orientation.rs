//! What the first method's orientation is worth at every cell of a sweep.

use calibench_records::figures::Quantity;

use super::tables::mean;
use crate::load::adjustments::{Summaries, Summary};
use crate::markdown::{MarkdownTable, fixed, with_half};

/// Reported standard deviations and true errors of every scored parameter, the camera over the frame, and check points, cell by cell: the cell's value of
/// `axis`, and what was found there.
pub fn table(axis: &str, cells: &[(String, &Summaries)]) -> String {
    let Some((method, first)) = cells.first().and_then(|(_, found)| Some((found.methods.first()?, *found))) else { return String::new() };
    let names = first.scored();
    let mut header = vec![format!("`{axis}`")];
    header.extend(names.iter().flat_map(|name| [format!("sigma of {name}"), format!("true error of {name}")]));
    header.extend(["over the frame, px", "RMSE_XY", "RMSE_Z", "failed"].map(str::to_owned));
    let mut rows = MarkdownTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    for (value, found) in cells {
        let mut row = vec![value.clone()];
        for name in &names {
            let parameter = found.parameter(method, name);
            row.push(parameter.and_then(|summary| summary.sigma.mean()).map_or_else(String::new, scaled(name)));
            row.push(parameter.and_then(|summary| root(summary, name)).unwrap_or_default());
        }
        row.push(mean(found.get(method, Quantity::OverFrame), 2));
        row.extend([Quantity::RmseXy, Quantity::RmseZ].map(|error| mean(found.get(method, error), 4)));
        row.push(found.failures(method, None).to_string());
        rows.row(row);
    }
    let without = |(value, found): &(String, &Summaries)| {
        let images = found.left_out(method);
        (images > 0.0).then(|| format!("{} at {value}", fixed(images, 1)))
    };
    let without: Vec<String> = cells.iter().filter_map(without).collect();
    let without = if without.is_empty() {
        String::new()
    } else {
        format!("\nImages left out, with fewer points than a pose takes, a trial: {}.\n", without.join(", "))
    };
    format!(
        "Interior orientation with `{method}`, set `{}`: mean reported standard deviation, and root mean square true error ± half its 95 % interval over {} trials; c, x0 and y0 in um, others in their unit times 10^6. *Over the frame*: distance \
         of the estimated camera from the true one after the best rotation. RMSE of check points against the truth, object units.\n\n{}{without}\n",
        first.sets.first().map_or("", String::as_str),
        first.trials,
        rows.render()
    )
}

fn times(name: &str) -> f64 {
    if ["c", "x0", "y0"].contains(&name) { 1e3 } else { 1e6 }
}

fn scaled(name: &str) -> impl Fn(f64) -> String {
    let times = times(name);
    move |value| fixed(times * value, 1)
}

fn root(summary: &Summary, name: &str) -> Option<String> {
    let square = summary.square.mean()?;
    let half = summary.square.half().map(|half| times(name) * 0.5 * half / square.sqrt());
    Some(with_half(times(name) * square.sqrt(), half, 1))
}
