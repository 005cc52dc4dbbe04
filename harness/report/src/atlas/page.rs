//! The page `which operator, when`.

use super::choose::{Candidate, LEVEL, MOST_FAILURES, Verdict, decide};
use super::frontier::short;
use super::rows::Row;
use crate::markdown::plain;
use crate::markdown::{MarkdownTable, anchor, contents};

/// A table of the page.
pub struct Group {
    /// Its heading.
    pub title: &'static str,
    /// What the rows of this table share.
    pub about: String,
    /// The scenario whose records these are.
    pub scenario: String,
    /// Its rows.
    pub rows: Vec<Row>,
}

const HEADER: [&str; 10] =
    ["where", "take", "RMSE, px", "/ bound", "failed, %", "points/s", "as good", "the next costs", "OpenCV, best", "usual"];

/// The page, and its answer in a sentence for each group.
pub struct Page {
    /// Markdown of one paragraph.
    pub answer: String,
    /// Markdown of the whole page.
    pub text: String,
    /// Of each row of each group, in their order.
    pub verdicts: Vec<Verdict>,
}

/// The page, from its groups: a short table first, then one for each group, then how it was decided.
pub fn which(groups: &[Group], machine: &str, evidence: &str) -> Page {
    let all: Vec<Vec<Candidate>> = groups.iter().flat_map(|group| &group.rows).map(|row| row.candidates.clone()).collect();
    let verdicts = decide(&all);
    let short = answers(groups, &verdicts);
    let mut body = String::new();
    let mut next = verdicts.iter();
    for group in groups {
        let mut table = MarkdownTable::new(&HEADER);
        for (row, verdict) in group.rows.iter().zip(&mut next) {
            table.row(cells(row, verdict));
        }
        body.push_str(&format!("## {}\n\n{}\n\n{}\n", group.title, group.about, table.render()));
    }
    body.push_str(&rules(all.len(), machine));
    body.push_str(evidence);
    let text = format!(
        "# Which operator, when\n\n{}\n{}Made by `calibench report atlas` from the records of the scenarios `atlas/*` and the speeds in `reference/speeds.csv`; nothing here is written by hand.\n\n{}\n",
        short.table.render(),
        contents(&body),
        body.trim_end()
    );
    Page { answer: short.sentences.join(" "), text, verdicts }
}

/// The answer: in each group, who is best or as good as the best in most rows, and who is best in the others.
struct Short {
    table: MarkdownTable,
    sentences: Vec<String>,
}

fn answers(groups: &[Group], verdicts: &[Verdict]) -> Short {
    let mut short = Short { table: MarkdownTable::new(&["what is measured", "where", "take"]), sentences: Vec::new() };
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
        let link = format!("[{}](#{})", group.title, anchor(group.title));
        // Where fewer than two thirds of the rows agree, each speaks for itself.
        let most = wins.first().filter(|(_, count)| 3 * count >= 2 * rows.len());
        if let Some((most, count)) = most {
            let share = format!("{count} of {} rows", rows.len());
            short.sentences.push(format!("{}: `{most}` in {share}.", group.title));
            short.table.row([link.clone(), share, format!("`{most}`")]);
        }
        for (row, verdict) in rows {
            let take = match sound(row, verdict).next() {
                Some(_) if most.is_some_and(|(most, _)| sound(row, verdict).any(|name| name == *most)) => continue,
                Some(best) => format!("`{best}`"),
                None => "none: every operator fails too often".to_owned(),
            };
            short.table.row([link.clone(), row.title.clone(), take]);
        }
    }
    short
}

/// The best of a row and those that are as good.
fn sound<'a>(row: &'a Row, verdict: &'a Verdict) -> impl Iterator<Item = &'a str> {
    verdict.best.iter().chain(&verdict.ties).map(|&index| row.candidates[index].name.as_str())
}

fn rules(rows: usize, machine: &str) -> String {
    let machine = if machine.is_empty() { "not measured: `calibench speed` does".to_owned() } else { machine.to_owned() };
    format!(
        "## How it was decided\n\n*Take* is the method with the least RMSE among those that lose (more than 1 px off) or reject at most {} % of the points; in the RMSE each such point counts as 1 px off. \
         *As good* are those that one-sided paired t-tests on the trials' mean squared errors and on their logarithms (the smaller p-value doubled) do not tell from it: all comparisons of the {rows} rows of this page share a chance of {} that any is told apart wrongly (Holm). \
         The test knows as many values as there are trials. *The next costs* names the first that is told apart, and its RMSE as a multiple. *OpenCV* is that multiple for `cornerSubPix`, at its best setting here and at the usual 11 x 11. \
         */ bound* is the RMSE in units of the Cramér-Rao bound, over the points that were kept and can be below 1 where the method's window is larger than the bound's or where it is told more than the bound assumes. \
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
    ]
    .into_iter()
    .chain(opencv(row, best))
    .collect()
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
    format!("{:.2}{failing}", other.rmse() / best.rmse())
}

/// What `cornerSubPix` costs at its best setting, which is named, and at the usual one.
fn opencv(row: &Row, best: &Candidate) -> [String; 2] {
    const USUAL: &str = "opencv_subpix:window=11";
    let theirs = || row.candidates.iter().filter(|candidate| candidate.name.starts_with("opencv_subpix") && candidate.points > 0);
    let Some(least) = theirs().min_by(|a, b| a.rmse().total_cmp(&b.rmse())) else { return [String::new(), String::new()] };
    let usual = theirs().find(|candidate| candidate.name == USUAL).map_or_else(String::new, |usual| times(usual, best));
    let setting = least.name.split_once(':').map_or("", |(_, setting)| setting);
    [format!("{} ({setting})", times(least, best)), usual]
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
        let rows = vec![
            Row { title: "sharp".into(), candidates: first, cells: Vec::new(), asks_for_speed: false },
            Row { title: "dark".into(), candidates: second, cells: Vec::new(), asks_for_speed: false },
        ];
        let page = which(&[Group { title: "Corners", about: "About.".into(), scenario: "a/b".into(), rows }], "a machine", "Evidence.\n");
        let text = &page.text;
        let short: Vec<&str> = text.lines().filter(|line| line.starts_with("| [Corners](#corners) ")).collect();
        assert!(short.len() == 2 && short[0].contains("| sharp ") && short[0].contains("| `a:window=9` "), "{text}");
        assert!(short[1].contains("| dark ") && short[1].contains("| none: every operator fails too often |"), "{text}");
        assert!(text.contains("| 3.00 (window=11) |  3.00 |"), "{text}");
        assert!(text.contains("none; `lossy` fails least, 18.0 %"), "{text}");
        assert!(text.contains("20k") && text.contains("a machine") && text.ends_with("Evidence.\n"));
        assert_eq!(page.answer, "");
    }

    #[test]
    fn what_most_rows_agree_on_is_the_answer() {
        let row = |title: &str| Row {
            title: title.into(),
            candidates: vec![candidate("a:window=9", 0.01, 0), candidate("b", 0.03, 0)],
            cells: Vec::new(),
            asks_for_speed: false,
        };
        let rows = vec![row("sharp"), row("soft")];
        let page = which(&[Group { title: "Corners", about: "About.".into(), scenario: "a/b".into(), rows }], "a machine", "");
        assert_eq!(page.answer, "Corners: `a:window=9` in 2 of 2 rows.");
    }
}
