//! Which call of each system to use.

use super::cells::{Cell, League};
use crate::markdown::MarkdownTable;

/// The section of the first page; empty where no system has several calls.
pub fn calls(league: &League) -> String {
    let mut rows =
        MarkdownTable::new(&["system", "call", "version", "as good as its best, classes", "of", "no camera, %", "wrong and silent, %"]);
    let mut systems: Vec<&str> = league.calibrators.iter().map(|one| one.system.as_str()).collect();
    systems.dedup();
    let mut any = false;
    for system in systems {
        let own = league.of_system(system);
        if own.calibrators.len() < 2 {
            continue;
        }
        let as_good: Vec<Vec<usize>> = (0..own.classes.len()).map(|class| own.as_good(class)).collect();
        let count = |place: usize| as_good.iter().filter(|places| places.contains(&place)).count();
        let mut order: Vec<usize> = (0..own.calibrators.len()).collect();
        order.sort_by_key(|place| std::cmp::Reverse(count(*place)));
        for place in order {
            let cells: Vec<&Cell> =
                (0..own.classes.len()).filter_map(|class| own.cell(class, place)).filter(|cell| cell.trials > 0).collect();
            let trials: usize = cells.iter().map(|cell| cell.trials).sum();
            let percent = |of: fn(&Cell) -> usize| {
                format!("{:.1}", 100.0 * cells.iter().map(|cell| of(cell)).sum::<usize>() as f64 / trials.max(1) as f64)
            };
            rows.row([
                system.to_owned(),
                format!("`{}`", own.calibrators[place].name),
                own.calibrators[place].version.clone(),
                count(place).to_string(),
                cells.len().to_string(),
                percent(|cell| cell.frames.iter().filter(|frame| frame.is_none()).count()),
                percent(Cell::silent),
            ]);
            any = true;
        }
    }
    if any {
        format!(
            "\n## Which call of a system\n\nOf the calls of one system, by classes in which it is as good as the best of them.\n\n{}",
            rows.render()
        )
    } else {
        String::new()
    }
}
