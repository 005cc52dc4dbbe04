//! Predictions of experiments that a paper did not make and somebody can: ours, and what a rival explanation would have instead.

use std::ops::Range as Bytes;
use std::path::Path;

use calibench_diagnostics::{Problem, Problems};
use serde::Deserialize;

use crate::first_screen::{NOT_RUN, Sources};
use crate::markdown::{MarkdownTable, plain};
use crate::published::{PREDICTIONS, PublishedError, Range};
use crate::{LoadError, ReportError};

/// An interval is at most this share of the distance between the two explanations.
const SHARE: f64 = 1.0 / 3.0;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Predictions {
    #[serde(default)]
    prediction: Vec<Prediction>,
    /// Those on public photographs, stated before these were measured.
    #[serde(default)]
    photographs: Vec<OnPhotographs>,
}

/// A prediction on photographs that are no part of this project: its figures are stated, and not from records.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct OnPhotographs {
    /// Which photographs, and how they are measured.
    experiment: String,
    /// What is measured, with its unit.
    measured: String,
    /// From, to.
    stated: toml::Spanned<[f64; 2]>,
    /// Why it comes out so.
    because: String,
    /// What would have it otherwise.
    rival: String,
    /// What that has.
    then: f64,
    /// What was measured, once it was.
    outcome: Option<f64>,
    /// What was learned from it.
    #[serde(default)]
    learned: String,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Prediction {
    /// What somebody does.
    experiment: String,
    /// What is measured in it, with its unit.
    measured: String,
    /// Our figure of it, as on a first screen.
    ours: toml::Spanned<String>,
    /// What it is divided by, trial by trial.
    over: Option<String>,
    /// Why it comes out so.
    because: String,
    /// What would have it otherwise.
    rival: String,
    /// The figure that the rival explanation has, what is printed, or a number.
    then: toml::Spanned<String>,
    /// What that is divided by.
    then_over: Option<String>,
}

/// The page of the predictions in `folder`; `None` where there are none.
///
/// # Errors
/// A file or records that cannot be read, a figure that is not there, an interval that tells the two explanations not apart.
pub fn page(family: &str, folder: &Path, sources: &Sources<'_>) -> Result<Option<String>, ReportError> {
    let path = folder.join(PREDICTIONS);
    let text = match calibench_files::bounded::text(&path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        text => text.map_err(|source| PublishedError::File { path: path.clone(), source })?,
    };
    let fail = |problem| PublishedError::from(Problems { file: path.display().to_string(), text: text.clone(), problems: vec![problem] });
    let read: Predictions = toml::from_str(&text).map_err(|e| fail(Problem::new(e.span().unwrap_or(0..0), e.message())))?;
    let mut rows =
        MarkdownTable::new(&["experiment", "measured", "we predict", "95 % of single runs", "because", "if instead", "it would be"]);
    for one in &read.prediction {
        let asked = [Some(one.ours.get_ref()), one.over.as_ref(), Some(one.then.get_ref()), one.then_over.as_ref()];
        if asked.into_iter().flatten().any(|asked| sources.asks_for_absent(asked)) {
            rows.row([&one.experiment, &one.measured, NOT_RUN, "", &one.because, &one.rival].map(str::to_owned));
            continue;
        }
        let ours = runs(sources, &one.ours, one.over.as_deref())?.map_err(fail)?;
        let then = runs(sources, &one.then, one.then_over.as_deref())?.map_err(fail)?;
        let (middle, range) = told(&ours, mean(&then), one.ours.span()).map_err(fail)?;
        let interval = format!("{} to {}", plain(range.low), plain(range.high));
        rows.row(
            [&one.experiment, &one.measured, &plain(middle), &interval, &one.because, &one.rival, &plain(mean(&then))].map(Clone::clone),
        );
    }
    let stated = stated(&read.photographs).map_err(fail)?;
    Ok(Some(format!(
        "# {family}: predictions\n\n[The paper in one screen](README.md).\n\nExperiments that the paper did not make and somebody can. Each of our figures stands here before anybody measured it, with where 95 % of its single runs lie: at most a third of \
         the distance to what a rival explanation would have, so that one measurement decides between the two.\n\n{}{stated}",
        rows.render()
    )))
}

/// The predictions on public photographs, with what became of them.
fn stated(all: &[OnPhotographs]) -> Result<String, Problem> {
    if all.is_empty() {
        return Ok(String::new());
    }
    let mut learned = String::new();
    let mut rows = MarkdownTable::new(&["photographs", "measured", "stated", "because", "if instead", "it would be", "outcome"]);
    for one in all {
        let [low, high] = *one.stated.get_ref();
        decides([low, high], 0.5 * (low + high), one.then, one.stated.span())?;
        let verdict = |outcome: f64| if (low..=high).contains(&outcome) { "as stated" } else { "not as stated" };
        let outcome =
            one.outcome.map_or_else(|| "not measured yet".to_owned(), |outcome| format!("{}: **{}**", plain(outcome), verdict(outcome)));
        if !one.learned.is_empty() {
            learned.push_str(&format!("\n{}\n", one.learned.trim()));
        }
        let interval = format!("{} to {}", plain(low), plain(high));
        rows.row([&one.experiment, &one.measured, &interval, &one.because, &one.rival, &plain(one.then), &outcome].map(Clone::clone));
    }
    Ok(format!(
        "\n## On public photographs\n\nStated in a change of its own before the photographs were measured, the outcome in the next, whichever way it went. The photographs are no part of this project, so that \
         these figures are in no record.\n\n{}{learned}",
        rows.render()
    ))
}

/// The figure in every trial, of a number that number; or what is wrong with it.
fn runs(sources: &Sources<'_>, asked: &toml::Spanned<String>, over: Option<&str>) -> Result<Result<Vec<f64>, Problem>, LoadError> {
    let text = asked.get_ref();
    if let Some(number) = text.parse().ok().or_else(|| sources.printed(text)) {
        return Ok(Ok(vec![number]));
    }
    let unknown = || Problem::new(asked.span(), format!("`{text}`: no such figure in the tables and records of this paper"));
    let Some(above) = sources.runs_of(text)? else { return Ok(Err(unknown())) };
    let Some(over) = over else { return Ok(Ok(above.into_values().collect())) };
    let Some(below) = sources.runs_of(over)? else {
        return Ok(Err(Problem::new(asked.span(), format!("`{over}`: no such figure in the tables and records of this paper"))));
    };
    Ok(Ok(crate::published::ratio(&above, &below).into_values().collect()))
}

fn mean(runs: &[f64]) -> f64 {
    runs.iter().sum::<f64>() / runs.len() as f64
}

/// The mean of `ours` and where they lie, if that tells them from `then`.
fn told(ours: &[f64], then: f64, place: Bytes<usize>) -> Result<(f64, Range), Problem> {
    let none = || Problem::new(place.clone(), "no trial has this figure");
    let (range, middle) = (Range::of(ours).ok_or_else(none)?, mean(ours));
    decides([range.low, range.high], middle, then, place)?;
    Ok((middle, range))
}

/// Whether an interval tells `middle` from `then`.
fn decides([low, high]: [f64; 2], middle: f64, then: f64, place: Bytes<usize>) -> Result<(), Problem> {
    if high - low <= SHARE * (then - middle).abs() {
        return Ok(());
    }
    let [low, high, middle, then] = [low, high, middle, then].map(plain);
    Err(Problem::new(
        place,
        format!("from {low} to {high} is more than a third of the distance from {middle} to {then}: it does not decide"),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_tells_two_explanations_apart() {
        assert_eq!(told(&[1.0, 2.0, 3.0], 8.0, 0..1).unwrap().0, 2.0, "2 wide, 6 away");
        let wide = told(&[1.0, 2.0, 3.1], 8.0, 4..9).unwrap_err();
        assert!(wide.message.contains("is more than a third of the distance") && wide.span == (4..9), "{wide:?}");
        assert!(told(&[], 8.0, 0..1).is_err());
    }

    #[test]
    fn what_was_stated_keeps_its_outcome() {
        let of = |stated: &str, outcome: &str| {
            let text = format!(
                "[[photographs]]\nexperiment = 'a'\nmeasured = 'px'\nstated = {stated}\nbecause = 'b'\nrival = 'c'\nthen = 8\n{outcome}"
            );
            stated_of(&text)
        };
        assert!(of("[1.0, 2.0]", "").unwrap().contains("not measured yet"));
        assert!(of("[1.0, 2.0]", "outcome = 1.5").unwrap().contains("1.50: **as stated**"));
        assert!(of("[1.0, 2.0]", "outcome = 2.5").unwrap().contains("2.50: **not as stated**"));
        assert!(of("[1.0, 4.0]", "").unwrap_err().message.contains("more than a third"));
    }

    fn stated_of(text: &str) -> Result<String, Problem> {
        let read: Predictions = toml::from_str(text).unwrap();
        stated(&read.photographs)
    }

    #[test]
    fn a_figure_that_is_not_there_is_a_mistake_with_its_line() {
        let folder = tempfile::tempdir().unwrap();
        let sources = Sources { tables: Vec::new(), runs: Vec::new(), sweeps: Vec::new() };
        assert!(page("p", folder.path(), &sources).unwrap().is_none());
        let text = "[[prediction]]\nexperiment = 'a wall'\nmeasured = 'px'\nours = 'OURS'\nbecause = 'a'\nrival = 'b'\nthen = '1'\n";
        let said = |ours: &str| {
            std::fs::write(folder.path().join(PREDICTIONS), text.replace("OURS", ours)).unwrap();
            page("p", folder.path(), &sources).map_or_else(|error| error.to_string(), Option::unwrap)
        };
        assert!(said("error p/s").contains(NOT_RUN), "{}", said("error p/s"));
        assert!(said("errors p").contains("predictions.toml:4:8: `errors p`: no such figure"), "{}", said("errors p"));
        assert!(said("0.5").contains("0.500 to 0.500 | a       | b          |        1.00 |"), "{}", said("0.5"));
    }
}
