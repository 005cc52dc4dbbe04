//! The bias of the strength's maximum over the angle of the corner: along the bisector and across it.

use calibench_records::score::Pooled;

use super::part::{OPERATOR, Part};
use crate::markdown::{MarkdownTable, fixed, signed};
use crate::sweep::{Choice, Layout, LoadedSweep, Metric, curves};

pub(super) fn section(loaded: &LoadedSweep) -> Option<Part> {
    let methods: Vec<usize> = (0..loaded.methods.len()).filter(|&method| loaded.methods[method].name.starts_with(OPERATOR)).collect();
    let names = loaded.sweep.axes.iter().map(|axis| format!("`{}`", axis.name));
    let columns =
        methods.iter().flat_map(|&method| ["along", "across", "measured"].map(|what| format!("`{}`: {what}", loaded.methods[method].name)));
    let header: Vec<String> = names.chain(columns).collect();
    let mut rows = MarkdownTable::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
    for cell in 0..loaded.cells.len() {
        let mut cells: Vec<String> = loaded.sweep.values(cell).into_iter().map(|value| value.text.clone()).collect();
        for score in methods.iter().map(|&method| loaded.score(cell, method)) {
            let Some(score) = score else {
                cells.extend([const { String::new() }; 3]);
                continue;
            };
            // The corner opens to the right: x runs along the bisector, into the area.
            cells.extend([mean(&score.whole.dx), mean(&score.whole.dy), format!("{} of {}", score.whole.dx.count(), score.points())]);
        }
        rows.row(cells);
    }
    let by = loaded.sweep.axes.iter().map(|axis| axis.name.clone()).nth(1);
    let layout = Layout::new(loaded, &Choice { by, ..Choice::default() }, Metric::MeanX, false).ok()?;
    let text = format!(
        "## The bias runs along the bisector\n\nMean error in px, with its standard error over the trials of `{}`, in which the corner opens to the right (its bisector is +x) and lies at random \
         on the pixel grid; lost points are among them. The strength needs gradients of both edges inside its integration window, so its maximum lies inside the area. With `alpha = 0` the \
         strength is the determinant alone, and the bias grows with the sharpness of the corner and, for each angle, with the width of the integration. Across the bisector symmetry leaves \
         nothing.\n\nThe paper's `alpha = 0.04` subtracts a part of the squared trace, which drives the maximum further inwards where the determinant is small beside it: with narrow integration, \
         where a pixel sees hardly more than one edge, and at blunt corners (at 30 degrees it moves it outwards). Two edges of equal weight that meet at an angle have a determinant of `sin^2(angle) / 4` of the squared trace: 0.0625 at \
         150 degrees, and the rounding of the tip by blur and gradient takes it below 0.04 unless the integration is wide beside them (3 px is). The strength is then nowhere positive, and every \
         point is rejected as `no_corner`; most points are rejected at 120 and 135 degrees, too, with an integration of 0.5 px.\n\n{}\n![Mean error along the bisector over the angle](bias-along.png)\n\n",
        loaded.name,
        rows.render()
    );
    Some((text, Some(("bias-along.png".into(), curves(loaded, &layout)))))
}

fn mean(pooled: &Pooled) -> String {
    match (pooled.mean(), pooled.standard_error()) {
        (Some(mean), Some(error)) => format!("{} \u{b1} {}", signed(mean, 3), fixed(error, 3)),
        (Some(mean), None) => signed(mean, 3),
        _ => "none".into(),
    }
}
