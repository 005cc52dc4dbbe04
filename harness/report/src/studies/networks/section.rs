//! Free networks and rigs on a page: whether what they say of themselves is so.

use std::fmt::Write;

use calibench_records::description::{self, Study};
use calibench_records::figures::{FigureName, Quantity};

use crate::LoadError;
use crate::load::adjustments::{Summaries, Summary};
use crate::load::{Loaded, LoadedSweep};
use crate::markdown::{MarkdownTable, fixed, with_half};
use crate::studies::section::Section;
use crate::studies::shown::{OnPage, Shown};
use crate::studies::{accepted, scored};

/// Networks that are adjusted in every trial as `calibrate` adjusts them.
pub struct Networks;

impl Section for Networks {
    fn of(&self, loaded: &Loaded, _: OnPage<'_>) -> Shown {
        let (Some(found), Study::Networks(views, told)) = (&loaded.calibrations, &loaded.scenario.study) else { return Shown::default() };
        let mut text = text(found, told);
        if let (Some(lengths), Some(table)) = (&told.acceptance, accepted::table(found)) {
            let _ = writeln!(text, "{}\n\n{table}", accepted::of_lengths(lengths, &views.unit));
        }
        let answer = accepted::answer(found).or_else(|| answer(found, told));
        Shown { text, answer, ..Shown::default() }
    }

    fn of_sweep(&self, loaded: &LoadedSweep, on: OnPage<'_>) -> Result<Shown, LoadError> {
        let Study::Networks(views, told) = &loaded.scenario.study else { return scored::sweep(loaded, on) };
        let introduction = told.acceptance.as_ref().map(|lengths| accepted::of_lengths(lengths, &views.unit)).unwrap_or_default();
        accepted::sweep(loaded, on, &format!("{} {introduction}", kind(told)))?.map_or_else(|| scored::sweep(loaded, on), Ok)
    }
}

/// What the networks are, the tables, and what their columns mean.
pub fn text(found: &Summaries, told: &description::Networks) -> String {
    let mut out = format!("{} They are told {} px of an image coordinate.\n\n", kind(told), told.sigma_px);
    out += &statements(found);
    out += &parameters(found);
    out
}

fn kind(told: &description::Networks) -> String {
    let model = &told.model;
    match (&told.mounts[..], told.distances.len()) {
        ([], 0) => format!(
            "Free networks of one camera ({model}), from image points alone: targets have no coordinates, and nothing tells the scale."
        ),
        ([], 1) => {
            format!("Free networks of one camera ({model}), from image points and one measured distance: targets have no coordinates.")
        }
        ([], count) => {
            format!("Free networks of one camera ({model}), from image points and {count} measured distances: targets have no coordinates.")
        }
        (mounts, _) => format!(
            "Rigs of {} cameras (each {model}), {}, before known targets: interiors and mounts from nothing.",
            mounts.len(),
            mounts.join(", ")
        ),
    }
}

/// How the page's first screen puts it.
fn answer(found: &Summaries, told: &description::Networks) -> Option<String> {
    let method = found.methods.first()?;
    let within = found.get(method, Quantity::WithinRegion)?;
    let silent = found.get(method, Quantity::IsWrongMinimumAndSilent)?;
    let what = if told.mounts.is_empty() { "free networks" } else { "rigs" };
    let [share, half] = [within.value.mean()?, within.value.half()?].map(|value| fixed(100.0 * value, 1));
    let wrong = (silent.value.mean()? * silent.value.count as f64).round();
    Some(format!(
        "Of {} {what} {share} ± {half} % have the true parameters within their region of 95 %, and {wrong} ended in a wrong minimum without a word.",
        within.value.count
    ))
}

/// A row for each method.
fn statements(found: &Summaries) -> String {
    let header = [
        "method",
        "networks",
        "cost / redundancy",
        "square / number",
        "within 95 %, %",
        "lengths: z²",
        "lengths within 95 %, %",
        "doubted, %",
        "wrong minima",
        "of them silent",
        "not adjusted",
    ];
    let mut rows = MarkdownTable::new(&header);
    for method in &found.methods {
        let of = |quantity: Quantity| found.get(method, quantity).map(|summary| &summary.value);
        let mean = |quantity: Quantity| of(quantity).and_then(|value| Some(with_half(value.mean()?, value.half(), 4))).unwrap_or_default();
        let share = |quantity: Quantity| {
            of(quantity)
                .and_then(|value| Some(with_half(100.0 * value.mean()?, value.half().map(|half| 100.0 * half), 2)))
                .unwrap_or_default()
        };
        let count =
            |quantity: Quantity| of(quantity).and_then(|value| Some(fixed(value.mean()? * value.count as f64, 0))).unwrap_or_default();
        let failed = found.failed.iter().find(|((other, ..), _)| other == method).map(|(_, (count, why))| format!("{count}: {why}"));
        rows.row([
            format!("`{method}`"),
            of(Quantity::CostOverRedundancy).map_or_else(String::new, |value| value.count.to_string()),
            mean(Quantity::CostOverRedundancy),
            mean(Quantity::SquareOverCovariance),
            share(Quantity::WithinRegion),
            mean(Quantity::SquareOfLengths),
            share(Quantity::LengthsWithin),
            share(Quantity::IsDoubtful),
            count(Quantity::IsWrongMinimum),
            count(Quantity::IsWrongMinimumAndSilent),
            failed.unwrap_or_else(|| "0".into()),
        ]);
    }
    format!(
        "{}\nMeans over networks ± half their 95 % interval. *Cost / redundancy*: 1 where residuals are those of the stated noise. *Square / number*: the errors of all parameters of cameras and \
         mounts together, measured in their stated covariance, over how many they are; 1 where it is true. *Within 95 %*: how often these errors are within the region that the covariance says. \
         *Lengths*: distances between targets, of rigs between cameras, alike one by one. *Wrong minima*: an adjustment that begins at the truth has a smaller sum of squares; *silent*: and \
         nothing was doubted.\n\n",
        rows.render()
    )
}

/// Parameters and places with what is stated of them beside their errors.
fn parameters(found: &Summaries) -> String {
    let mut rows = MarkdownTable::new(&["method", "parameter", "stated", "error, RMS", "error / stated"]);
    let mut any = false;
    for ((method, _, name), summary) in &found.figures {
        let Some([stated, error]) = stated_and_error(name, summary) else { continue };
        any = true;
        rows.row([format!("`{method}`"), format!("`{name}`"), digits(stated), digits(error), fixed(error / stated, 3)]);
    }
    let mut out = String::new();
    if any {
        let _ = writeln!(
            out,
            "{}\nStandard deviations as the adjustments state them (root mean) beside the errors that there are.\n",
            rows.render()
        );
    }
    out
}

/// The mean stated standard deviation and the root mean square error of what has both.
fn stated_and_error(name: &FigureName, summary: &Summary) -> Option<[f64; 2]> {
    let is_estimated = matches!(name.quantity(), Quantity::Parameter | Quantity::CentreX | Quantity::CentreY | Quantity::CentreZ);
    Some([summary.sigma.mean()?, summary.square.mean()?.sqrt()]).filter(|_| is_estimated)
}

/// Three significant digits.
fn digits(value: f64) -> String {
    if (1e-3..1e4).contains(&value) {
        format!("{value:.*}", (2.0 - value.log10().floor()).max(0.0) as usize)
    } else {
        format!("{value:.2e}")
    }
}
