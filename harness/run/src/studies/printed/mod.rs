//! Printed figures, recomputed: pixel sizes, conversions, errors of check points, and the network that some of the errors determine.

mod cameras;
mod errors;
mod fit;
mod network;
mod predicted;
#[cfg(test)]
mod tests;

use calibench_records::figures::Quantity;
use calibench_records::results::{Calibrated, Figure, MethodInfo, Trial};
use calibench_scenario::Printed;
use calibench_scenario::studies::printed::PRINT;

use predicted::Predictions;

/// Figures of a set, or why there are none, and why there are no predictions of it.
type Set = (Result<Vec<Figure>, String>, Option<String>);

/// What stands in the place of methods, as results list it.
pub(crate) fn method_infos() -> Vec<MethodInfo> {
    vec![MethodInfo { label: PRINT.into(), version: "1".into(), unavailable: None }]
}

/// All figures of `printed`: one trial without points.
pub fn run(printed: &Printed) -> Trial {
    let predictions = printed.network.as_ref().map(|plan| Predictions::new(printed, plan));
    let predictions = predictions.as_ref().map(Result::as_ref);
    let mut sets: Vec<Set> = vec![(Ok(sensor(printed)), None)];
    sets.extend(printed.cameras.iter().enumerate().map(|(index, column)| {
        let own = cameras::figures(printed, column).map(|figures| figures.into_iter().chain(errors::recomputed(printed, index)).collect());
        with_predicted(own, predictions.map(|found| found.map_err(Clone::clone)?.column(index)))
    }));
    sets.push(match predictions {
        None => (Ok(Vec::new()), None),
        Some(Ok(found)) => (Ok(found.network()), None),
        Some(Err(why)) => (Err(why.clone()), None),
    });
    sets.extend(printed.variants.iter().map(|variant| {
        with_predicted(cameras::varied(printed, variant), predictions.map(|found| found.map_err(Clone::clone)?.variant(variant)))
    }));
    let calibrated = |(set, (outcome, check_failed))| Calibrated { method: 0, set, outcome, check_failed };
    Trial { calibrations: sets.into_iter().enumerate().map(calibrated).collect(), ..Trial::default() }
}

/// A set with what is predicted of it, if anything is to be.
fn with_predicted(own: Result<Vec<Figure>, String>, predicted: Option<Result<Vec<Figure>, String>>) -> Set {
    match (own, predicted) {
        (Ok(own), Some(Ok(predicted))) => (Ok(own.into_iter().chain(predicted).collect()), None),
        (own, Some(Err(why))) => (own, Some(why)),
        (own, _) => (own, None),
    }
}

/// Pixel pitches, the number of pixels and of check points.
fn sensor(printed: &Printed) -> Vec<Figure> {
    let pitches = printed.pitches.iter().map(|(name, um)| Figure::plain(Quantity::Pitch.of(&[name]), *um, "um"));
    let size = printed.cameras[0].camera.size;
    let pixels = f64::from(size.width) * f64::from(size.height) * 1e-6;
    let points = printed.points.len() as f64;
    pitches.chain([Figure::plain(Quantity::MillionPixels, pixels, ""), Figure::plain(Quantity::PrintedCheckPoints, points, "")]).collect()
}
