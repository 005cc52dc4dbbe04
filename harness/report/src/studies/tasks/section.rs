//! Measured lengths on a page: whether the intervals around them hold the truth.

use calibench_records::description::{self, Study};
use calibench_records::figures::{FigureName, Quantity};
use calibench_records::statistics::running::Running;

use crate::load::Loaded;
use crate::load::adjustments::Summaries;
use crate::markdown::{MarkdownTable, fixed, with_half};
use crate::studies::section::Section;
use crate::studies::shown::{OnPage, Shown};

/// Cameras that are calibrated in every trial, and then measure.
pub struct Tasks;

/// The name of all ways of measuring together.
const ALL: &str = "all";

impl Section for Tasks {
    fn of(&self, loaded: &Loaded, _: OnPage<'_>) -> Shown {
        let (Some(found), Study::Tasks(views, told)) = (&loaded.calibrations, &loaded.scenario.study) else { return Shown::default() };
        Shown { text: text(found, told, &views.unit), answer: answer(found), ..Shown::default() }
    }
}

/// What is measured, how often intervals hold it, and what the columns mean.
pub fn text(found: &Summaries, told: &description::Tasks, unit: &str) -> String {
    let description::Tasks { model, noise_px, count, print, scale, flatness } = told;
    format!(
        "Cameras ({model}) that are calibrated from boards which err: each corner by {print} {unit}, the scale by {scale}, each bend by {flatness} {unit} (standard deviations, told to the \
         calibration). Each then measures {count} lengths in images of {noise_px} px noise.\n\n{}{}",
        table(found, unit),
        doubted(found)
    )
}

fn table(found: &Summaries, unit: &str) -> String {
    let [stated, error] = ["stated", "error, RMS"].map(|what| format!("{what}, {unit}"));
    let mut rows = MarkdownTable::new(&["method", "measured with", "cameras", "within 95 %, %", "z²", &stated, &error, "stated / error"]);
    for method in &found.methods {
        for way in ways(found, method) {
            let of = |quantity: Quantity| found.get(method, quantity.of(&[&way]));
            let Some((within, length)) = of(Quantity::TasksWithin).zip(of(Quantity::TaskLength)) else { continue };
            let Some((stated, error)) = rms(&length.sigma).zip(length.square.mean().map(f64::sqrt)) else { continue };
            let squares = of(Quantity::SquareOfTasks).and_then(|summary| Some(with_half(summary.value.mean()?, summary.value.half(), 3)));
            let share = within.value.mean().map(|mean| with_half(100.0 * mean, within.value.half().map(|half| 100.0 * half), 2));
            rows.row([
                format!("`{method}`"),
                way.clone(),
                within.value.count.to_string(),
                share.unwrap_or_default(),
                squares.unwrap_or_default(),
                fixed(stated, 4),
                fixed(error, 4),
                fixed(stated / error, 3),
            ]);
        }
    }
    format!(
        "{}\nMeans over cameras ± half their 95 % interval: the lengths of one camera share its errors. *Within 95 %*: how often the truth is in the interval that `task` says; 95 where it is \
         honest. *z²*: errors in standard uncertainties, squared; 1 where they are true. *Stated*: root mean square. *Stated / error*: the standard uncertainty over the errors that there are; a few cameras that are hardly known weigh most in it.\n\n",
        rows.render()
    )
}

/// The root mean square of numbers of which mean and deviation are kept.
fn rms(numbers: &Running) -> Option<f64> {
    let (mean, count) = (numbers.mean()?, numbers.count as f64);
    let variance = numbers.deviation().map_or(0.0, |deviation| deviation.powi(2) * (count - 1.0) / count);
    Some((mean * mean + variance).sqrt())
}

/// The ways of measuring that the figures know, all of them last.
fn ways(found: &Summaries, method: &str) -> Vec<String> {
    let of = |name: &FigureName| (name.quantity() == Quantity::TaskLength).then(|| name.parts()[0].to_owned());
    let mut ways: Vec<String> = found.figures.keys().filter(|(other, ..)| other == method).filter_map(|(_, _, name)| of(name)).collect();
    ways.sort_by_key(|way| way == ALL);
    ways
}

fn doubted(found: &Summaries) -> String {
    let line = |method: &String| {
        let doubted = found.get(method, Quantity::IsDoubtful)?.value.mean()?;
        let failed = found
            .failed
            .iter()
            .find(|((other, ..), _)| other == method)
            .map(|(_, (count, why))| format!("; {count} not calibrated: {why}"));
        Some(format!("`{method}`: {} % of the calibrations are in doubt{}.\n\n", fixed(100.0 * doubted, 1), failed.unwrap_or_default()))
    };
    found.methods.iter().filter_map(line).collect()
}

fn answer(found: &Summaries) -> Option<String> {
    let method = found.methods.first()?;
    let within = &found.get(method, Quantity::TasksWithin.of(&[ALL]))?.value;
    let half = within.half()?;
    Some(format!(
        "{} ± {} % of the 95 % intervals hold the truth, of {} calibrated cameras.",
        fixed(100.0 * within.mean()?, 1),
        fixed(100.0 * half, 1),
        within.count
    ))
}
