//! What a page says first: who has the least error in which scenario, and how many printed figures reproduce.

use calibench_records::description::is_limited;
use calibench_records::score::Score;

use crate::load::{Loaded, LoadedSweep};
use crate::markdown::plain;
use crate::markdown::{MarkdownTable, anchor};
use crate::published::{Counts, Figures, Kind, Table, Verdict};

/// Shares of lost and rejected points above this disqualify a method here, as on the page `which operator, when`.
const MOST_FAILURES: f64 = 0.01;

/// The answers of a page, gathered while its sections are made.
#[derive(Default)]
pub struct Answers {
    /// The file of each published table, and its title.
    tables: Vec<(String, String)>,
    figures: Figures,
    winners: Vec<Winner>,
    said: Option<String>,
}

/// The method with the least RMSE in a scenario, or in cells of a sweep.
struct Winner {
    scenario: String,
    /// How many cells the scenario has; 1 where nothing is swept.
    cells: usize,
    method: String,
    /// Its RMSE in each of the cells that it leads, px.
    least: Vec<f64>,
    /// What stands in the table: RMSE, ratio to the bound, failures, the next, OpenCV's.
    row: Vec<String>,
}

impl Answers {
    /// Counts the printed figures of the published table in the file `name`.
    pub fn table(&mut self, name: &str, table: &Table, verdicts: &[Verdict]) {
        self.tables.push((name.to_owned(), table.title.clone()));
        self.figures.add(name, table, verdicts);
    }

    /// An answer in words, of a section that has one.
    pub fn say(&mut self, answer: String) {
        self.said = Some(answer);
    }

    /// A scenario with scores. Methods that are limited to kinds of targets measure other points than the rest: nobody leads there.
    pub fn scenario(&mut self, loaded: &Loaded) {
        let labels = loaded.head.methods.iter().map(|info| &*info.label);
        if labels.clone().any(is_limited) {
            return;
        }
        let candidates: Vec<(&str, &Score)> =
            labels.zip(&loaded.scores.methods).filter(|(name, _)| loaded.scenario.compares(name)).collect();
        if let Some((method, least, row)) = lead(&candidates) {
            let (scenario, method) = (loaded.name.clone(), method.to_owned());
            self.winners.push(Winner { scenario, cells: 1, method, least: vec![least], row });
        }
    }

    /// A sweep: who leads in most of its cells.
    pub fn sweep(&mut self, loaded: &LoadedSweep) {
        let mut wins: Vec<(String, Vec<f64>)> = Vec::new();
        let cells = loaded.sweep.cells.len();
        let compared = || loaded.methods.iter().map(|method| &*method.name).filter(|name| loaded.scenario.compares(name));
        if compared().any(is_limited) || !compete(compared()) {
            return;
        }
        for cell in 0..cells {
            let named = loaded.methods.iter().enumerate().filter(|(_, method)| loaded.scenario.compares(&method.name));
            let candidates: Vec<(&str, &Score)> =
                named.filter_map(|(index, method)| Some((method.name.as_str(), loaded.score(cell, index)?))).collect();
            if let Some((best, rmse, _)) = lead(&candidates) {
                match wins.iter_mut().find(|(name, _)| name == best) {
                    Some((_, least)) => least.push(rmse),
                    None => wins.push((best.to_owned(), vec![rmse])),
                }
            }
        }
        let Some((method, least)) = wins.into_iter().max_by_key(|(_, least)| least.len()) else { return };
        let count = least.len();
        let row = vec![format!("in {count} of {cells} cells")];
        self.winners.push(Winner { scenario: loaded.name.clone(), cells, method, least, row });
    }

    /// The first paragraph: a sentence or two, without the numbers that stand in the tables.
    pub fn paragraph(&self) -> String {
        let mut sentences: Vec<String> = self.said.iter().cloned().collect();
        if self.figures.is_empty() {
            sentences.extend(self.leaders());
        } else {
            sentences.push(self.figures.counts(None).sentence());
        }
        sentences.join(" ")
    }

    /// Who leads how often, by operator.
    fn leaders(&self) -> Option<String> {
        let mut wins: Vec<(&str, Vec<f64>)> = Vec::new();
        for winner in &self.winners {
            let operator = winner.method.split(':').next().unwrap_or(&winner.method);
            match wins.iter_mut().find(|(name, _)| *name == operator) {
                Some((_, least)) => least.extend(&winner.least),
                None => wins.push((operator, winner.least.clone())),
            }
        }
        wins.sort_by_key(|(_, least)| std::cmp::Reverse(least.len()));
        let of: usize = self.winners.iter().map(|winner| winner.cells).sum();
        let things = if self.winners.iter().any(|winner| winner.cells > 1) { "cells" } else { "scenarios" };
        let ((first, least), rest) = wins.split_first()?;
        let rmse = range(least);
        if of == 1 {
            return Some(format!("`{first}` has the least error, {rmse} px RMSE."));
        }
        let rest: String = rest.iter().map(|(name, least)| format!(", `{name}` in {}", least.len())).collect();
        Some(format!("Least error: `{first}` in {} of {of} {things}, {rmse} px RMSE{rest}.", least.len()))
    }

    /// How many printed figures of each table come out, by kind.
    pub fn counted(&self) -> String {
        if self.tables.is_empty() {
            return String::new();
        }
        let header: Vec<&str> =
            ["printed in"].into_iter().chain(Kind::COUNTED.map(Kind::word)).chain(["not comparable", "figures"]).collect();
        let mut rows = MarkdownTable::new(&header);
        let row = |counts: &Counts| {
            let judged = counts
                .judged
                .map(|(comes, fails)| if comes + fails == 0 { String::new() } else { format!("{comes} of {}", comes + fails) });
            judged.into_iter().chain([counts.not_comparable.to_string(), counts.all().to_string()]).collect::<Vec<_>>()
        };
        for (name, title) in &self.tables {
            let counts = self.figures.counts(Some(name));
            rows.row(std::iter::once(format!("[{title}](#{})", anchor(title))).chain(row(&counts)));
        }
        if self.tables.len() > 1 {
            rows.row(std::iter::once("**all**".to_owned()).chain(row(&self.figures.counts(None))));
        }
        format!(
            "{}\nHow many come out (reproduce, or are consistent) of those that are judged, by what kind of evidence that is. A printed figure that several cells compare, or whose ratios stand \
             in a table of ours, is counted once, where it is printed, by the verdict of the strongest kind; of these the gravest counts. What was put in is not comparable.\n\n",
            rows.render()
        )
    }

    /// The table behind the leaders.
    pub fn led(&self) -> String {
        let mut text = String::new();
        if self.winners.len() > 1 {
            let mut rows =
                MarkdownTable::new(&["scenario", "least RMSE", "px", "RMSE / bound", "failed, %", "the next", "`opencv_subpix`"]);
            for winner in &self.winners {
                let link = format!("[{}](#{})", short(&winner.scenario), anchor(&heading(&winner.scenario)));
                rows.row([link, format!("`{}`", winner.method)].into_iter().chain(winner.row.iter().cloned()));
            }
            text.push_str(&format!(
                "{}\nLost and rejected points count as 1 px off; methods that fail at more than {} % of the points are left out while another is sound. \u{b1}: standard error. \
                 *The next* and `opencv_subpix` are multiples of the least RMSE.\n\n",
                rows.render(),
                MOST_FAILURES * 100.0
            ));
        }
        text
    }
}

/// The heading of a scenario's section.
pub fn heading(scenario: &str) -> String {
    format!("Scenario `{scenario}`")
}

fn short(scenario: &str) -> &str {
    scenario.split_once('/').map_or(scenario, |(_, rest)| rest)
}

/// The mean squared error, px^2, with failures counted as errors of 1 px, and the share of failures; `None` where nothing was tried.
fn loss(score: &Score) -> Option<(f64, f64)> {
    let points = score.points() as f64;
    let failed = (score.points() - score.measured) as f64;
    let kept = score.kept.square.mean().unwrap_or(0.0) * score.kept.square.count() as f64;
    (points > 0.0 && score.kept.square.count() == score.measured).then(|| ((kept + failed) / points, failed / points))
}

/// The least and the largest of some figures.
fn range(figures: &[f64]) -> String {
    let (least, most) = figures.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), x| (least.min(*x), most.max(*x)));
    let [least, most] = [least, most].map(plain);
    if least == most { least } else { format!("{least} to {most}") }
}

/// The best of some methods, its RMSE, px, with failures counted, and its row.
fn lead<'a>(candidates: &[(&'a str, &Score)]) -> Option<(&'a str, f64, Vec<String>)> {
    let mut ranked: Vec<(&str, &Score, f64, f64)> =
        candidates.iter().filter_map(|(name, score)| loss(score).map(|(loss, failures)| (*name, *score, loss, failures))).collect();
    ranked.sort_by(|a, b| (a.3 > MOST_FAILURES).cmp(&(b.3 > MOST_FAILURES)).then(a.2.total_cmp(&b.2)));
    let (best, score, least, failures) = *ranked.first()?;
    let times = |other: Option<&(&str, &Score, f64, f64)>| other.filter(|_| least > 0.0).map(|other| (other.2 / least).sqrt());
    let next = ranked.get(1);
    let opencv = ranked.iter().filter(|other| other.0.starts_with("opencv_subpix")).min_by(|a, b| a.2.total_cmp(&b.2));
    let rmse = least.sqrt();
    let error = score.kept.square.standard_error().filter(|_| rmse > 0.0).map(|error| error / (2.0 * rmse));
    let bound = calibench_records::score::root(&score.to_bound, 0.99);
    Some((
        best,
        rmse,
        vec![
            error.map_or_else(|| plain(rmse), |error| format!("{} \u{b1} {}", plain(rmse), plain_error(rmse, error))),
            bound.map_or_else(String::new, |(ratio, _)| format!("{ratio:.2}")),
            format!("{:.1}", 100.0 * failures),
            next.zip(times(next)).map_or_else(String::new, |(other, times)| format!("`{}`: {times:.2}", other.0)),
            times(opencv).map_or_else(String::new, |times| format!("{times:.2}")),
        ],
    ))
}

/// A standard error with the decimals of its figure.
fn plain_error(value: f64, error: f64) -> String {
    let decimals = plain(value).split_once('.').map_or(0, |(_, decimals)| decimals.len());
    format!("{error:.decimals$}")
}

/// Whether these are of two operators at least: settings of one alone say nothing of who is better.
fn compete<'a>(mut labels: impl Iterator<Item = &'a str>) -> bool {
    let operator = |label: &'a str| label.split(':').next();
    labels.next().is_some_and(|first| labels.any(|other| operator(other) != operator(first)))
}

#[cfg(test)]
mod tests {
    use calibench_records::score::Errors;

    use super::*;
    use crate::published::{Cell, Metric};

    fn score(errors: &[f64], rejected: u64) -> Score {
        let mut kept = Errors::default();
        errors.chunks(2).for_each(|trial| kept.add(&trial.iter().map(|e| (*e, 0.0)).collect::<Vec<_>>()));
        let mut score = Score { measured: errors.len() as u64, kept, whole: kept, ..Score::default() };
        if rejected > 0 {
            score.rejected.insert("no_corner", rejected);
        }
        score
    }

    #[test]
    fn the_least_error_leads_unless_it_fails_too_often() {
        let (good, lossy, cv) = (score(&[0.03, 0.05, 0.04, 0.04], 0), score(&[0.01, 0.01, 0.01], 1), score(&[0.1, 0.1, 0.1, 0.1], 0));
        let candidates = [("lossy", &lossy), ("opencv_subpix:window=11", &cv), ("good:window=9", &good)];
        let (best, rmse, row) = lead(&candidates).unwrap();
        assert_eq!((best, plain(rmse).as_str()), ("good:window=9", "0.0406"));
        // sqrt((9 + 25 + 16 + 16) / 4) = 4.06 hundredths; 0.1 / 0.0406 = 2.46.
        assert!(row[0].starts_with("0.0406 \u{b1} 0.000"), "{row:?}");
        assert_eq!(row[1..], ["", "0.0", "`opencv_subpix:window=11`: 2.46", "2.46"].map(String::from));
    }

    #[test]
    fn settings_of_one_operator_do_not_compete() {
        assert!(!compete(["a:window=3", "a", "a:window=5"].into_iter()) && !compete(["a"].into_iter()) && !compete(std::iter::empty()));
        assert!(compete(["a:window=3", "a", "ab"].into_iter()));
    }

    #[test]
    fn a_paragraph_counts_figures_and_scenarios() {
        let mut answers = Answers::default();
        for (scenario, method, rmse) in [("f/a", "one:window=9", 0.12), ("f/b", "one", 0.1), ("f/c", "two", 0.3)] {
            let row = vec!["0.1".into()];
            answers.winners.push(Winner { scenario: scenario.into(), cells: 1, method: method.into(), least: vec![rmse], row });
        }
        assert_eq!(answers.paragraph(), "Least error: `one` in 2 of 3 scenarios, 0.100 to 0.120 px RMSE, `two` in 1.");
        assert!(answers.led().contains("[a](#scenario-fa)"), "{}", answers.led());
        let cells = vec![Cell::bare("1", Metric::Figure), Cell { row: "s".into(), ..Cell::bare("1", Metric::Figure) }];
        let table = Table { title: "Table 1: x".into(), cells, ..Table::bare() };
        answers.table("table-1", &table, &[Verdict::Reproduces, Verdict::Differs]);
        assert!(answers.paragraph().starts_with("Of 2 printed figures 2 are predictions, of which 1 come out;"), "{}", answers.paragraph());
        assert!(!answers.paragraph().contains("Least error"), "who leads is another question");
        assert!(answers.counted().contains("| [Table 1: x](#table-1-x) |     1 of 2 |"), "{}", answers.counted());
    }
}
