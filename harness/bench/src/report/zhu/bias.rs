//! The bias of the strength's maximum over the angle of the corner: along the bisector and across it.

use super::{OPERATOR, Part};
use crate::report::markdown::{MarkdownTable, fixed, signed};
use crate::report::sweep::LoadedSweep;
use crate::score::Pooled;

pub(super) fn section(loaded: &LoadedSweep) -> Option<Part> {
    let method = loaded.methods.iter().position(|method| method.name.starts_with(OPERATOR))?;
    let names = loaded.sweep.axes.iter().map(|axis| format!("`{}`", axis.name));
    let header: Vec<String> = names.chain(["along the bisector, px", "across it, px", "points", "missed"].map(str::to_owned)).collect();
    let mut rows = MarkdownTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    for cell in 0..loaded.cells.len() {
        let Some(score) = loaded.score(cell, method) else { continue };
        let values = loaded.sweep.values(cell).into_iter().map(|value| value.text.clone());
        // The corner opens to the right: x runs along the bisector, into the area.
        let figures = [mean(&score.whole.dx), mean(&score.whole.dy)];
        let counts = [score.whole.dx.count().to_string(), (score.points() - score.whole.dx.count()).to_string()];
        rows.row(values.chain(figures).chain(counts));
    }
    let text = format!(
        "## The bias runs along the bisector\n\nMean error of `{}` with its standard error over the trials of `{}`, in which the corner opens to the right (its bisector is +x) and lies at random \
         on the pixel grid. The strength needs gradients of both edges inside its integration window, so its maximum lies inside the area: the further the sharper the corner and the wider the \
         integration. Across the bisector symmetry leaves nothing. The curves stand under the scenario below.\n\n{}\n",
        loaded.methods[method].name,
        loaded.scenario.name,
        rows.render()
    );
    Some((text, None))
}

fn mean(pooled: &Pooled) -> String {
    match (pooled.mean(), pooled.standard_error()) {
        (Some(mean), Some(error)) => format!("{} \u{b1} {}", signed(mean, 3), fixed(error, 3)),
        (Some(mean), None) => signed(mean, 3),
        _ => "none".into(),
    }
}
