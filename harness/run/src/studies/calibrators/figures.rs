//! The figures of an answer.

use calibench_calibrators::Status;
use calibench_records::figures::Quantity;
use calibench_records::results::Figure;

use super::Answered;

/// Figures of an answer to `image_points`; an answer without a camera has those alone that say how it ended. Time is not among them: the same seed gives the same bytes.
pub fn of(answered: &Answered, image_points: usize) -> Vec<Figure> {
    let answer = &answered.calibrated.answer;
    let mut figures = Vec::new();
    if let Ok(Some(score)) = &answered.score {
        figures.push(Figure { name: Quantity::OverFrame.into(), value: score.frame_px, sigma: score.stated_px, error: None, unit: "px" });
        figures.extend(score.covered_px.map(|px| Figure::plain(Quantity::OverCovered, px, "px")));
        figures.extend(score.length_mm.map(|mm| Figure::plain(Quantity::LengthError, mm, "mm")));
        figures.extend(score.z2_frame.map(|z2| Figure::plain(Quantity::SquareOverStated, z2, "")));
        figures.extend(score.z2_parameters.map(|z2| Figure::plain(Quantity::SquareOverStatedParameters, z2, "")));
    }
    let is = |yes: bool| f64::from(u8::from(yes));
    for (status, quantity) in [
        (Status::Calibrated, Quantity::IsCalibrated),
        (Status::Doubtful, Quantity::IsDoubtful),
        (Status::Refused, Quantity::IsRefused),
        (Status::Failed, Quantity::IsFailed),
    ] {
        figures.push(Figure::plain(quantity, is(answer.status == status), ""));
    }
    figures.push(Figure::plain(Quantity::IsWrongAndSilent, is(answered.is_wrong_and_silent()), ""));
    figures.extend(answer.rms_px.map(|rms| Figure::plain(Quantity::StatedRms, rms, "px")));
    figures.push(Figure::plain(Quantity::PointsLeftOut, answer.outliers.len() as f64, ""));
    figures.push(Figure::plain(Quantity::ImagePoints, image_points as f64, ""));
    figures
}
