//! The picture of the league.

use super::cells::{Cell, Honesty, League};
use crate::field::rgb;
use crate::plain;
use crate::plot::{Axis, Figure, Plot, Said, around};

/// A ratio to the best of this size has the darkest shade.
const DARKEST: f64 = 30.0;

/// A class's name without its family.
pub fn short(class: &str) -> &str {
    class.rsplit_once('/').map_or(class, |(_, name)| name)
}

/// A number of pixels in few letters.
pub fn px(value: f64) -> String {
    match value {
        value if !value.is_finite() => "none".to_owned(),
        value if value < 0.995 => format!("{value:.2}"),
        value if value < 9.95 => format!("{value:.1}"),
        value => format!("{value:.0}"),
    }
}

/// Calibrators by classes: px over the frame.
pub fn figure(league: &League) -> Figure {
    let classes: Vec<String> = league.classes.iter().map(|class| short(&class.class).to_owned()).collect();
    let rows: Vec<String> = league.calibrators.iter().map(|one| format!("{} {}", one.name, one.version)).rev().collect();
    let height = (34.0 * rows.len() as f64).clamp(120.0, 1400.0);
    let mut plot = Plot::new(
        "league",
        "Distance from the true camera over the frame, by calibrator and class",
        Axis::named("class", classes),
        Axis::named("calibrator", rows.clone()),
        height,
    )
    .with_names_at_the_left();
    plot.series(1, None, &["calibrator", "class", "px over the frame", "honesty", "wrong and silent, %"]);
    for class in 0..league.classes.len() {
        let best = league.best(class).and_then(|best| league.cell(class, best)?.frame()).map(|(median, _)| median);
        let as_good = league.as_good(class);
        for place in 0..league.calibrators.len() {
            let (x, y) = (class as f64, (rows.len() - 1 - place) as f64);
            let Some(cell) = league.cell(class, place).filter(|cell| cell.trials > 0) else {
                plot.note((x, y), "\u{2013}", false);
                continue;
            };
            let Some((median, _)) = cell.frame() else { continue };
            let part = best.map_or(1.0, |best| ((median / best).ln() / DARKEST.ln()).clamp(0.0, 1.0));
            let said = [
                league.calibrators[place].name.clone(),
                league.classes[class].class.clone(),
                plain(median),
                cell.honesty().word().to_owned(),
                plain(cell.percent(cell.silent())),
            ];
            plot.cell([(x - 0.5, y - 0.5), (x + 0.5, y + 0.5)], Some(rgb(0.6 * part)), &Said::of(said));
            plot.note((x, y), &format!("{}{}", px(median), mark(cell)), true);
            if as_good.contains(&place) {
                plot.line(&around((x, y)), &Said::default());
            }
        }
    }
    let caption = "Median distance from the true camera over the whole frame after the best rotation, px; the darker the farther from the best of the class. Framed: as good as \
                   the best. `!`: wrong and silent in some trials; `+`: errors larger than stated; none: no camera in most trials; \u{2013}: not asked, or no such model.";
    Figure { name: "league".to_owned(), caption: caption.to_owned(), remark: String::new(), plot }
}

/// What is to be noticed of a cell, in a letter.
fn mark(cell: &Cell) -> &'static str {
    match (cell.silent() > 0, cell.honesty()) {
        (true, _) => "!",
        (false, Honesty::Overconfident) => "+",
        _ => "",
    }
}
