//! The marks of a plot apart: a small picture for each group.

use super::Plot;
use super::picture::Inside;
use crate::Canvas;

/// Panels in a row, their width, the gaps around them and the room for a name above.
const COLUMNS: usize = 4;
/// Width of a panel, px of the picture.
pub(crate) const PANEL: u32 = 300;
const GAP: u32 = 12;
const NAME: u32 = 24;

/// A panel for each group with its heading, and a line below them. Panels are as high as the plot is in proportion.
pub(crate) fn panels(plot: &Plot, groups: &[(usize, String)], remark: &str) -> Canvas {
    let inner = (f64::from(PANEL) * plot.height / super::WIDTH).round().max(20.0) as u32;
    let height = inner + NAME + GAP;
    let columns = groups.len().min(COLUMNS) as u32;
    let (width, rows) = ((columns * (PANEL + GAP) + GAP).max(2 * PANEL + 3 * GAP), groups.len().div_ceil(COLUMNS) as u32);
    let mut canvas = Canvas::new(width, rows * height + GAP + 40);
    for (index, (group, heading)) in groups.iter().enumerate() {
        let (x, y) = (GAP + (index % COLUMNS) as u32 * (PANEL + GAP), GAP + (index / COLUMNS) as u32 * height);
        canvas.text(heading, 15, (x, y + NAME / 2));
        let inside = Inside { plot, at: [x, y + NAME, PANEL, inner].map(|px| px as i32) };
        inside.draw(&mut canvas, |said| said.group == Some(*group));
        canvas.paint(|area| inside.outline(area));
    }
    canvas.text(remark, 15, (GAP, rows * height + GAP + 20));
    canvas
}
