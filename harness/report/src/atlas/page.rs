//! The page `which operator, when`.

use super::choose::{Candidate, LEVEL, MOST_FAILURES, Verdict, decide};
use super::frontier::short;
use super::rows::Row;
use crate::field::plain;
use crate::markdown::MarkdownTable;

/// A table of the page.
pub struct Group {
    /// Its heading.
    pub title: &'static str,
    /// What the rows of this table share.
    pub about: String,
    /// Its rows.
    pub rows: Vec<Row>,
}

const HEADER: [&str; 9] =
    ["where", "take", "RMSE, px", "RMSE / bound", "failed, %", "points/s", "as good", "the next costs", "OpenCV costs"];

/// The page, from its groups: a short table first, then one for each group, then how it was decided.
pub fn which(groups: &[Group], machine: &str, evidence: &str) -> String {
    let all: Vec<Vec<Candidate>> = groups.iter().flat_map(|group| &group.rows).map(|row| row.candidates.clone()).collect();
    let verdicts = decide(&all);
    let mut text = String::from(
        "# Which operator, when\n\nMade by `calibench report atlas` from the records of the scenarios `atlas/*` and the speeds in `reference/speeds.csv`; nothing here is written by hand.\n\n",
    );
    text.push_str(&short_table(groups, &verdicts));
    text.push_str(&rules(all.len(), machine));
    let mut next = verdicts.iter();
    for group in groups {
        let mut table = MarkdownTable::new(&HEADER);
        for (row, verdict) in group.rows.iter().zip(&mut next) {
            table.row(cells(row, verdict));
        }
        text.push_str(&format!("## {}\n\n{}\n\n{}\n", group.title, group.about, table.render()));
    }
    text.push_str(evidence);
    text.trim_end().to_owned() + "\n"
}

/// In each group, who is best or as good as the best in most rows, and who is best in the others.
fn short_table(groups: &[Group], verdicts: &[Verdict]) -> String {
    let mut table = MarkdownTable::new(&["what is measured", "take", "unless, or by"]);
    let mut next = verdicts.iter();
    for group in groups {
        let rows: Vec<(&Row, &Verdict)> = group.rows.iter().zip(&mut next).collect();
        let mut wins: Vec<(&str, usize)> = Vec::new();
        for name in rows.iter().flat_map(|(row, verdict)| sound(row, verdict)) {
            match wins.iter_mut().find(|(known, _)| *known == name) {
                Some((_, count)) => *count += 1,
                None => wins.push((name, 1)),
            }
        }
        wins.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        let Some(&(most, count)) = wins.first() else {
            table.row([group.title.to_owned(), "none: every operator fails too often".into(), String::new()]);
            continue;
        };
        // Where fewer than two thirds of the rows agree, each speaks for itself.
        let common = 3 * count >= 2 * rows.len();
        let other = |(row, verdict): &(&Row, &Verdict)| match sound(row, verdict).next() {
            Some(_) if common && sound(row, verdict).any(|name| name == most) => None,
            Some(best) => Some(format!("{}: `{best}`", row.title)),
            None => Some(format!("{}: none is sound", row.title)),
        };
        let unless = rows.iter().filter_map(other).collect::<Vec<_>>().join("; ");
        let take = if common { format!("`{most}` ({count} of {} rows)", rows.len()) } else { "it depends".to_owned() };
        table.row([group.title.to_owned(), take, unless]);
    }
    format!("{}\n", table.render())
}

/// The best of a row and those that are as good.
fn sound<'a>(row: &'a Row, verdict: &'a Verdict) -> impl Iterator<Item = &'a str> {
    verdict.best.iter().chain(&verdict.ties).map(|&index| row.candidates[index].name.as_str())
}

fn rules(rows: usize, machine: &str) -> String {
    let machine = if machine.is_empty() { "not measured: `calibench speed` does".to_owned() } else { machine.to_owned() };
    format!(
        "**How it was decided.** *Take* is the method with the least RMSE among those that lose (more than 1 px off) or reject at most {} % of the points; in the RMSE each such point counts as 1 px off. \
         *As good* are those that one-sided paired t-tests on the trials' mean squared errors and on their logarithms (the smaller p-value doubled) do not tell from it: all comparisons of the {rows} rows of this page share a chance of {} that any is told apart wrongly (Holm). \
         The test knows as many values as there are trials. *The next costs* names the first that is told apart, and its RMSE as a multiple. *OpenCV costs* is the same for `cornerSubPix` at its best setting here and, after the comma, at the usual 11 x 11. \
         *RMSE / bound* is over the points that were kept and can be below 1 where the method's window is larger than the bound's or where it is told more than the bound assumes. \
         Points per second on one thread: {machine}.\n\n",
        MOST_FAILURES * 100.0,
        LEVEL
    )
}

fn cells(row: &Row, verdict: &Verdict) -> Vec<String> {
    let Some(best) = verdict.best.map(|best| &row.candidates[best]) else { return failing(row) };
    let name = |index: &usize| format!("`{}`", row.candidates[*index].name);
    let ties: Vec<String> = verdict.ties.iter().map(name).collect();
    let next = verdict.second.map_or_else(String::new, |second| cost(&row.candidates[second], best));
    vec![
        row.title.clone(),
        format!("`{}`", best.name),
        plain(best.rmse()),
        best.ratio.map_or_else(|| "none".into(), |ratio| format!("{ratio:.2}")),
        format!("{:.2}", 100.0 * best.failures()),
        best.speed.map_or_else(|| "not measured".into(), short),
        ties.join(", "),
        next,
        opencv(row, best),
    ]
}

/// The row of conditions under which every method fails too often: the one that fails least.
fn failing(row: &Row) -> Vec<String> {
    let least = row.candidates.iter().filter(|candidate| candidate.points > 0).min_by(|a, b| a.failures().total_cmp(&b.failures()));
    let text =
        least.map_or_else(|| "none".to_owned(), |least| format!("none; `{}` fails least, {:.1} %", least.name, 100.0 * least.failures()));
    vec![row.title.clone(), text]
}

fn cost(other: &Candidate, best: &Candidate) -> String {
    format!("`{}`: {}", other.name, times(other, best))
}

fn times(other: &Candidate, best: &Candidate) -> String {
    let failing = if other.failures() > MOST_FAILURES { format!(", fails {:.1} %", 100.0 * other.failures()) } else { String::new() };
    format!("{:.2} times{failing}", other.rmse() / best.rmse())
}

fn opencv(row: &Row, best: &Candidate) -> String {
    let theirs = || row.candidates.iter().filter(|candidate| candidate.name.starts_with("opencv_subpix") && candidate.points > 0);
    let Some(least) = theirs().min_by(|a, b| a.rmse().total_cmp(&b.rmse())) else { return String::new() };
    let usual = theirs().find(|candidate| candidate.name == "opencv_subpix:window=11").filter(|usual| usual.name != least.name);
    let first = cost(least, best);
    usual.map_or_else(|| first.clone(), |usual| format!("{first}, usual {}", times(usual, best)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn candidate(name: &str, rmse: f64, failed: u64) -> Candidate {
        let losses = (0..12).map(|trial| rmse * rmse * (1.0 + 0.1 * f64::from(trial % 3))).collect();
        Candidate { name: name.into(), losses, failed, points: 500, ratio: Some(rmse / 0.01), speed: Some(2e4) }
    }

    #[test]
    fn the_page_names_the_best_says_what_others_cost_and_where_none_is_sound() {
        let first = vec![candidate("a:window=9", 0.01, 0), candidate("opencv_subpix:window=11", 0.03, 0), candidate("lossy", 0.001, 90)];
        let second = vec![candidate("lossy", 0.001, 90)];
        let rows = vec![Row { title: "sharp".into(), candidates: first }, Row { title: "dark".into(), candidates: second }];
        let page = which(&[Group { title: "Corners", about: "About.".into(), rows }], "a machine", "Evidence.\n");
        assert!(page.contains("| Corners          | it depends | sharp: `a:window=9`; dark: none is sound |"), "{page}");
        assert!(page.contains("`opencv_subpix:window=11`: 3.00 times"), "{page}");
        assert!(page.contains("none; `lossy` fails least, 18.0 %"), "{page}");
        assert!(page.contains("20k") && page.contains("a machine") && page.ends_with("Evidence.\n"));
    }
}
