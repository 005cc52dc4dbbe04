//! Calibration systems on a page: a row for each, of each method of measuring.

use calibench_records::figures::Quantity;

use crate::load::Loaded;
use crate::load::adjustments::Summaries;
use crate::markdown::{MarkdownTable, fixed, with_half};
use crate::studies::section::Section;
use crate::studies::shown::{OnPage, Shown};

/// Calibration systems, each told the points of every trial.
pub struct Calibrators;

impl Section for Calibrators {
    fn of(&self, loaded: &Loaded, _: OnPage<'_>) -> Shown {
        Shown { text: loaded.calibrations.as_ref().map(table).unwrap_or_default(), ..Shown::default() }
    }
}

/// What comes of each system, mean over the trials ± half its 95 % interval.
pub fn table(found: &Summaries) -> String {
    let header = [
        "calibrator",
        "points of",
        "over the frame, px",
        "stated, px",
        "where measured, px",
        "100 mm, mm",
        "z²",
        "calibrated, %",
        "wrong and silent, %",
    ];
    let mut rows = MarkdownTable::new(&header);
    for (method, set) in found.methods.iter().flat_map(|method| found.sets.iter().map(move |set| (method, set))) {
        let of = |quantity: Quantity| found.figures.get(&(method.clone(), set.clone(), quantity.into()));
        let mean = |quantity: Quantity, digits: usize| {
            let value = of(quantity).map(|summary| &summary.value);
            value.and_then(|value| Some(with_half(value.mean()?, value.half(), digits))).unwrap_or_default()
        };
        let share =
            |quantity: Quantity| of(quantity).and_then(|one| one.value.mean()).map_or_else(String::new, |mean| fixed(100.0 * mean, 0));
        let failed = found.failed.iter().find(|((other, own, _), _)| other == method && own == set).map(|(_, (_, why))| why.clone());
        let z2 = if of(Quantity::SquareOverStated).is_some() { Quantity::SquareOverStated } else { Quantity::SquareOverStatedParameters };
        rows.row([
            format!("`{set}`"),
            format!("`{method}`"),
            failed.unwrap_or_else(|| mean(Quantity::OverFrame, 3)),
            of(Quantity::OverFrame).and_then(|one| one.sigma.mean()).map_or_else(String::new, |sigma| fixed(sigma, 3)),
            mean(Quantity::OverCovered, 3),
            mean(Quantity::LengthError, 3),
            mean(z2, 2),
            share(Quantity::IsCalibrated),
            share(Quantity::IsWrongAndSilent),
        ]);
    }
    format!(
        "{}\nMeans over trials ± half their 95 % interval. *Over the frame*: distance from the true camera after the best rotation, RMS (2D); *stated*: what the covariance says of it, where there \
         is one; *where measured*: over the part of the frame with image points; *100 mm*: error of a length; *z²*: mean square of errors in stated standard deviations, over the frame, else of the \
         parameters: 1 where what is stated is true; *wrong and silent*: nothing said against it, and farther off than five stated standard deviations and a pixel.\n\n",
        rows.render()
    )
}
