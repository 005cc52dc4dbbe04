//! Calibrations with noise, those that agree with the print, and what they say of the rest.

use std::error::Error;
use std::fmt::Write;
use std::path::Path;

use calibench_files::OutputFile;
use calibench_records::figures::Quantity;
use calibench_records::results::{Figure, find};

use crate::drawn::{Drawn, Noise};
use crate::screened::{NAMES, PRINTED, Screened, scenario, sigmas, trials};

/// A standard deviation agrees within this share.
const AGREES: f64 = 0.10;
/// Sigma of c with 9 x 9 and 15 x 15, mm: one figure of each further column, which says how much noise its coordinates have.
const FURTHER: [f64; 2] = [0.0291, 0.0275];
/// Standard deviation of a coordinate that stops at whole pixels, px.
const ROUNDING: f64 = 0.288_675_134_594_812_9;

/// A calibration that agrees with the first column of Table 2.
#[derive(Clone)]
pub struct Kept {
    /// The network's number.
    pub network: u64,
    /// What is written of it, in the order of [`header`].
    figures: Vec<f64>,
}

/// The calibration of a network, if it agrees.
pub fn kept(drawn: &Drawn, screened: &Screened) -> Option<Kept> {
    let (noise, totals) = noise(drawn, screened)?;
    let trial = trials(&scenario(&drawn.scenario(&noise, drawn.survey, Some(&screened.check), 1)), 1).pop()?;
    let of = |method| trial.calibrations.iter().find(|calibrated| calibrated.method == method)?.outcome.as_deref().ok();
    let figures = figures(drawn, screened, totals, [of(0)?, of(1)?, of(2)?])?;
    Some(Kept { network: drawn.number, figures })
}

/// The noise of coordinates that gives sigma of c of each column, and their standard deviations, px; `None` where there is none, or none that a hand can have.
fn noise(drawn: &Drawn, screened: &Screened) -> Option<(Noise, [f64; 3])> {
    let [pixel, nine, fifteen] = [PRINTED[0], FURTHER[0], FURTHER[1]].map(|sigma| variance(screened, sigma / screened.cofactors[0]));
    let (pixel, nine, fifteen) = (pixel?, nine?, fifteen?);
    let floor = drawn.common * fifteen;
    let hand = pixel - floor - ROUNDING * ROUNDING;
    let noise = Noise { hand: hand.max(0.0).sqrt(), floor: floor.sqrt(), own: [nine - floor, fifteen - floor].map(f64::sqrt) };
    (hand > 0.0).then_some((noise, [pixel, nine, fifteen].map(f64::sqrt)))
}

/// The variance of an image coordinate (told: 0.5 px) with which the standard deviation of unit weight is `sigma0`, control being as good as told.
fn variance(screened: &Screened, sigma0: f64) -> Option<f64> {
    // Each observation has its redundancy number's share in v^T P v.
    let [image, control] = screened.redundancy;
    let share = (sigma0 * sigma0 * (image + control) - control) / image;
    (share > 0.0).then_some(0.25 * share)
}

fn figures(drawn: &Drawn, screened: &Screened, totals: [f64; 3], all: [&[Figure]; 3]) -> Option<Vec<f64>> {
    let [pixel, nine, fifteen] = all.map(sigmas);
    let (pixel, nine, fifteen) = (pixel?, nine?, fifteen?);
    let agrees = |ours: f64, printed: f64| (ours / printed).ln().abs() < AGREES;
    if !pixel.iter().zip(PRINTED).all(|(ours, printed)| agrees(*ours, printed)) {
        return None;
    }
    let step = |figures: &[Figure]| {
        let of = |quantity: Quantity| find(figures, quantity).map(|figure| figure.value);
        let distance = of(Quantity::Distance)?;
        Some([of(Quantity::RmseXySurvey)? / distance, of(Quantity::RmseZSurvey)? / distance])
    };
    let (coarse, fine) = (step(all[0])?, step(all[2])?);
    let mut row =
        vec![screened.points as f64, drawn.convergent(25.0) as f64, drawn.rolled() as f64, drawn.depth(), 1e3 * drawn.survey, drawn.common];
    row.extend(totals);
    row.extend([pixel, nine, fifteen].concat());
    for further in [nine, fifteen] {
        let ratios: [f64; 4] = std::array::from_fn(|index| further[index] / pixel[index]);
        row.extend(ratios);
        row.push(ratios.iter().sum::<f64>() / 4.0);
    }
    row.extend(coarse.into_iter().chain(fine).chain([fine[0] / coarse[0], fine[1] / coarse[1]]));
    let values =
        all.map(|figures| NAMES.map(|name| find(figures, Quantity::Parameter.of(&[name])).map_or(f64::NAN, |figure| figure.value)));
    for further in [values[1], values[2]] {
        row.extend((0..4).map(|index| (further[index] - values[0][index]) / pixel[index]));
    }
    Some(row)
}

fn header() -> String {
    let mut names: Vec<String> =
        ["network", "image_points", "convergent", "rolled", "depth_m", "survey_mm", "common"].map(String::from).into();
    names.extend(["pixel", "9", "15"].map(|column| format!("noise_{column}_px")));
    names.extend(["pixel", "9", "15"].iter().flat_map(|column| NAMES.map(|name| format!("sigma_{name}_{column}"))));
    names.extend(["9", "15"].iter().flat_map(|column| ["c", "x0", "y0", "k1", "mean"].map(|name| format!("factor_{name}_{column}"))));
    names.extend(["relative_xy_pixel", "relative_z_pixel", "relative_xy_15", "relative_z_15", "factor_xy", "factor_z"].map(String::from));
    // By how much a parameter moves from the first column, in its standard deviations there.
    names.extend(["9", "15"].iter().flat_map(|column| NAMES.map(|name| format!("move_{name}_{column}"))));
    names.join(",")
}

/// One row for each calibration, five digits.
pub fn write(path: &Path, kept: &[Kept]) -> Result<(), Box<dyn Error>> {
    let mut text = header() + "\n";
    for kept in kept {
        let _ = write!(text, "{}", kept.network);
        kept.figures.iter().for_each(|figure| {
            let rounded: f64 = format!("{figure:.4e}").parse().unwrap_or(f64::NAN);
            let _ = write!(text, ",{rounded}");
        });
        text.push('\n');
    }
    OutputFile::open(path)?.write(|out| out.write_all(text.as_bytes()).map_err(Box::<dyn Error>::from))
}
