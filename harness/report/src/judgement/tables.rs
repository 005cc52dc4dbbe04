//! The tables behind the verdict.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use calibench_model::escape::{code, markdown};
use calibench_records::judgement::{COMPARABLE, Cell, Summary, Trusted};

use super::words::listed;
use crate::markdown::{MarkdownTable, fixed};
use crate::plain;

fn number(value: Option<f64>) -> String {
    value.map_or_else(|| "-".into(), plain)
}

/// What the hold-out figures are and on what they rest.
pub fn about_holdout(summary: &Summary) -> String {
    let mut text = format!(
        "Each photograph is left out in turn; the camera calibrated from the others is held, the photograph is resected from every other point, \
         and the remaining ones are predicted, both ways. RMS (2D) in px with the 95 % interval over views (photographs drawn again). Operators are compared on \
         the {} corners that all of them have, each calibrated with its own. Thin frame: trusted; bold frame: the least.",
        summary.common
    );
    for method in &summary.methods {
        if let Some(why) = &method.unavailable {
            text.push_str(&format!(" `{}` is unavailable: {why}.", method.method));
        } else if method.found < method.of {
            text.push_str(&lacking(&method.method, [method.found, method.of], &method.rejected));
            if !summary.is_compared(&method.method) {
                text.push_str(&format!(" With less than {} % of the corners it is not compared with the others.", 100.0 * COMPARABLE));
            }
        }
    }
    for (view, why) in &summary.missed {
        text.push_str(&format!(" {}: {}.", code(view), markdown(why)));
    }
    text
}

/// The corners that an operator rejected, or that its file has no word of.
fn lacking(method: &str, [found, of]: [usize; 2], rejected: &BTreeMap<Arc<str>, usize>) -> String {
    let missing = of - found;
    let reasons: Vec<String> = rejected.iter().map(|(why, count)| format!("{count} {}", markdown(why))).collect();
    let share = fixed(100.0 * missing as f64 / of as f64, 1);
    if reasons.is_empty() {
        format!(" `{method}` lacks {missing} of {of} corners ({share} %).")
    } else if rejected.values().sum::<usize>() < missing {
        format!(" `{method}` lacks {missing} of {of} corners ({share} %), among them {} rejected.", listed(&reasons))
    } else {
        format!(" `{method}` rejected {missing} of {of} corners ({share} %: {}).", listed(&reasons))
    }
}

/// Every operator with every model.
pub fn cells(summary: &Summary) -> String {
    let mut table = MarkdownTable::new(&["operator", "model", "free", "hold-out px", "95 %", "across px", "straight px", "residuals px"]);
    for cell in &summary.cells {
        let interval = cell.holdout.map_or(String::new(), |e| format!("{} to {}", plain(e.interval.0), plain(e.interval.1)));
        table.row([
            code(&cell.method),
            code(&cell.model),
            cell.parameters.to_string(),
            number(cell.holdout.map(|e| e.value)),
            interval,
            number(cell.across.map(|e| e.value)),
            number(cell.straight.map(|e| e.value)),
            number(residuals(cell)),
        ]);
    }
    let mut text = format!(
        "`across` predicts one side of the field from the other, left, right, top and bottom (of points that are no board, halves along their longest extents): errors of the camera are carried on, and noise with them; that shows what a pose makes up for. \
         `straight` is how far undistorted rows and columns are from straight lines (standard deviation of a coordinate; the camera calibrated without the \
         photograph; no pose takes part). `residuals` are those of the adjustment of all photographs. `free`: how many parameters of the camera are solved for. All \
         but `straight` are 2D.\n\n{}\n",
        table.render()
    );
    let troubles: BTreeSet<(&str, &str)> = summary.cells.iter().filter_map(|cell| Some((&*cell.model, cell.trouble.as_deref()?))).collect();
    let mut last = "";
    for (model, why) in troubles {
        if model != last {
            text.push_str(&format!("- `{model}` could not be judged everywhere: {why}.\n"));
        }
        last = model;
    }
    text + "\n"
}

fn residuals(cell: &Cell) -> Option<f64> {
    let (sum, count) = cell.views.iter().fold((0.0, 0), |(sum, count), view| {
        let (rms, n) = view.residual;
        (sum + rms * rms * n as f64, count + n)
    });
    (count > 0).then(|| (sum / count as f64).sqrt())
}

/// Differences of halves beside what is predicted.
pub fn halves(summary: &Summary) -> String {
    let mut table = MarkdownTable::new(&[
        "operator",
        "model",
        "difference px",
        "predicted px",
        "over the frame",
        "in modes",
        "p",
        "splits",
        "centre px",
        "corner px",
    ]);
    for cell in &summary.cells {
        let Some(split) = cell.split else { continue };
        table.row([
            code(&cell.method),
            code(&cell.model),
            plain(split.difference),
            plain(split.predicted),
            fixed(split.ratio(), 2),
            fixed(split.modes, 2),
            if split.p < 0.001 { "<0.001".into() } else { fixed(split.p, 3) },
            split.count.to_string(),
            number(cell.uncertainty.map(|u| u.0)),
            number(cell.uncertainty.map(|u| u.1)),
        ]);
    }
    format!(
        "`centre` and `corner`: predicted standard deviation (2D) of the image of a point far away, from all photographs, not enlarged.\n\n{}\n",
        table.render()
    )
}

/// The photographs one by one, with the trusted operator and the published camera.
pub fn views(summary: &Summary, trusted: &Trusted<'_>) -> String {
    let cell = trusted.cell;
    let with_published = !cell.published_views.is_empty();
    let mut header = vec!["photograph", "corners", "residuals px", "p", "hold-out px", "named by"];
    if with_published {
        header.push("published camera px");
    }
    let mut table = MarkdownTable::new(&header);
    for view in &cell.views {
        let by = summary.cells.iter().filter(|other| other.model == cell.model);
        let named = by.filter(|other| other.outlying().iter().any(|outlier| outlier.name == view.name)).count();
        let mut row = vec![
            code(&view.name),
            view.residual.1.to_string(),
            plain(view.residual.0),
            if view.p < 0.001 { "<0.001".into() } else { fixed(view.p, 3) },
            number(cell.held_out.get(&view.name).map(|held| held.0)),
            format!("{named} of {}", summary.cells.iter().filter(|other| other.model == cell.model && !other.views.is_empty()).count()),
        ];
        if with_published {
            row.push(number(cell.published_views.get(&view.name).copied()));
        }
        table.row(row);
    }
    let published =
        if with_published { " `published camera`: RMS residual of the same corners with the published camera held." } else { "" };
    format!(
        "`{}` with `{}`; `named by`: operators that name the photograph as outlying.{published}\n\n{}\n",
        cell.method,
        cell.model,
        table.render()
    )
}

/// Scatter of the principal point beside its sigmas.
pub fn principal(summary: &Summary, model: &str) -> String {
    let mut table = MarkdownTable::new(&[
        "operator",
        "x px",
        "y px",
        "sigma x",
        "sigma y",
        "jackknife x",
        "jackknife y",
        "half x",
        "predicted",
        "half y",
        "predicted",
    ]);
    for cell in summary.cells.iter().filter(|cell| &*cell.model == model) {
        let Some(principal) = &cell.principal else { continue };
        let jackknife = principal.jackknife();
        let halves = principal.between_halves();
        let [x, y] = principal.all;
        table.row([
            code(&cell.method),
            fixed(x.0, 2),
            fixed(y.0, 2),
            plain(x.1),
            plain(y.1),
            number(jackknife.map(|j| j[0])),
            number(jackknife.map(|j| j[1])),
            number(halves.map(|h| h[0].0)),
            number(halves.map(|h| h[0].1)),
            number(halves.map(|h| h[1].0)),
            number(halves.map(|h| h[1].1)),
        ]);
    }
    format!(
        "With `{model}`, px. `sigma`: as the adjustment of all photographs predicts; `jackknife`: what leaving photographs out shows of the same standard deviation, \
         whether or not errors within a photograph depend on each other; `half`: scatter of the principal point from halves, beside the predicted.\n\n{}\n",
        table.render()
    )
}
