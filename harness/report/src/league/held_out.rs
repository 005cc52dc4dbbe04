//! Photographs without truth: what cameras from half of them predict of the others.

use super::cells::{Cell, League};
use super::page::{precise, said};
use super::picture::short;
use crate::markdown::MarkdownTable;

/// The section of the first page; empty where no photographs were asked about.
pub fn section(league: &League) -> String {
    let mut text = String::new();
    for (place, class) in league.classes.iter().enumerate() {
        text.push_str(&format!(
            "\n### {}\n\n{} Asked for: `{}`.\n\n{}",
            short(&class.class),
            class.why.trim(),
            class.model,
            table(league, place)
        ));
    }
    if text.is_empty() {
        return text;
    }
    format!(
        "\n## Photographs without truth\n\nEach calibrates half of the photographs; its camera predicts points of the others from every other point, and from one side of the \
         board, which carries errors of the camera on. Medians over splits, px (2D); all get the same points and the same splits.\n{text}"
    )
}

fn table(league: &League, class: usize) -> String {
    let mut rows = MarkdownTable::new(&[
        "calibrator",
        "version",
        "predicted, px",
        "95 %",
        "times the best",
        "from one side, px",
        "no camera, %",
        "doubtful, %",
        "says",
    ]);
    let best = league.best(class);
    let key = |cell: &Cell| cell.frame().map_or(f64::INFINITY, |(median, _)| median);
    let mut asked: Vec<(usize, &Cell)> = league.asked(class).collect();
    asked.sort_by(|a, b| key(a.1).total_cmp(&key(b.1)));
    for (place, cell) in asked {
        let Some((median, [low, high])) = cell.frame() else { continue };
        let ratio = best.filter(|best| *best != place).and_then(|best| league.ratio(class, [place, best]));
        let percent = |count: usize| if count == 0 { String::new() } else { format!("{:.0}", cell.percent(count)) };
        rows.row([
            format!("`{}`", league.calibrators[place].name),
            league.calibrators[place].version.clone(),
            precise(median),
            format!("{} to {}", precise(low), precise(high)),
            ratio.map_or_else(String::new, |(ratio, [low, high])| format!("{ratio:.3} ({low:.3} to {high:.3})")),
            cell.across().map_or_else(String::new, precise),
            percent(cell.frames.iter().filter(|frame| frame.is_none()).count()),
            percent(cell.ended[1]),
            said(cell),
        ]);
    }
    rows.render()
}
