//! The section of a scenario whose points are adjusted with control.

use calibench_records::figures::Quantity;

use super::{pictures, tables};
use crate::canvas::{Canvas, Pictures};
use crate::load::Loaded;
use crate::studies::accepted;
use crate::studies::shown::OnPage;

/// The text of a calibrated scenario and its pictures; `None` without adjustments.
pub fn section(loaded: &Loaded, OnPage { stem, illustrated, .. }: OnPage<'_>) -> Option<(String, Pictures)> {
    let found = loaded.calibrations.as_ref()?;
    let (views, told) = loaded.scenario.adjusted()?;
    let mut text = tables::methods(found);
    if found.sets.len() > 1 {
        text.push_str(&tables::sets(found));
    }
    if let (Some(classes), Some(table)) = (told.acceptance, accepted::table(found)) {
        text.push_str(&format!("{}\n\n{table}", accepted::of_classes(classes, &views.unit)));
    }
    let mut drawn: Pictures = Vec::new();
    // Networks that are alike need no picture of their own; what real operators leave behind does.
    let shown = |name: &str| illustrated || (!told.drawn && name == "convergence");
    let mut add = |name: &str, caption: &str, canvas: Option<Canvas>| {
        if let Some(canvas) = canvas.filter(|_| shown(name)) {
            let file = format!("{stem}-{name}.png");
            text.push_str(&format!("{caption}\n\n![{caption}]({file})\n\n"));
            drawn.push((file, canvas));
        }
    };
    add("plan", "The network from above, and the wall with control and check points", pictures::plan::plan(views));
    add("distribution", "The distribution of the image points over the frame", pictures::distribution::distribution(loaded, views));
    let sigma0 = |method: &&String| found.get(method, Quantity::Sigma0).and_then(|sigma0| sigma0.value.mean()).unwrap_or(f64::INFINITY);
    let best = found.methods.iter().min_by(|a, b| sigma0(a).total_cmp(&sigma0(b)));
    add("factors", "The reduction factor of all interior and exterior parameters", best.and_then(|m| pictures::factors::factors(found, m)));
    add("residuals", "The residuals after the calibration", pictures::residuals::residuals(found));
    add("convergence", "The residuals by the convergence of the image", pictures::residuals::by_convergence(found, views));
    Some((text, drawn))
}
