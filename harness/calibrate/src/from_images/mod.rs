//! Object coordinates from image points alone: pairs of images oriented relatively, the others chained to them by resection and intersection with
//! adjustments in between, and distances for the scale.

mod chain;
mod pairs;

use calibench_adjust::approximate::Shape;
use calibench_model::camera::{Camera, OpenCvFisheye};
use calibench_model::{ControlRow, Points};
use nalgebra::Point3;
use rayon::prelude::*;

use crate::distances::scale_by;
use crate::start::{middle, pinhole};
use crate::{CalibrationError, DatumChoice, Optics, Prepared, Settings, Survey, model, optics, prepare};
use chain::Chain;

/// Focal lengths that are tried, in longer sides; each is adjusted on the way, so that they need not be dense.
const FOCAL: [f64; 4] = [0.6, 0.9, 1.5, 3.0];
/// The same of lenses that picture angles.
const FOCAL_WIDE: [f64; 3] = [0.22, 0.32, 0.5];
/// Pairs from which a chain is begun, images up to which each is, and chains that go on.
const SEEDS: usize = 3;
const FIRST: usize = 8;
const GO_ON: usize = 3;
/// Mean square of the residuals, in parts of what is as bad as it gets, from which coordinates are none.
const BAD: f64 = 0.5;
/// The same, below which no other chain is asked.
const GOOD: f64 = 0.1;

/// Joins points of which no coordinates are known with start values for everything: a free network, whose scale is that of `settings.distances`.
/// Coordinates of targets in `approximate` are start values; without them they come from the images alone, about the middle of the object, along the axes
/// of one of the images.
///
/// # Errors
/// [`CalibrationError::NoModel`] where images do not hang together, or no lens explains them; as of [`prepare`].
pub fn prepare_free(points: Points, approximate: &[ControlRow], settings: &Settings) -> Result<Prepared, CalibrationError> {
    let datum = if settings.datum.is_minimal() { settings.datum.clone() } else { DatumChoice::Free };
    let settings = Settings { datum, ..settings.clone() };
    if !approximate.is_empty() {
        return prepare(points, approximate, &settings);
    }
    let survey = Survey::without_control(points);
    let control = coordinates(&survey, &settings)?;
    prepare(survey.into_points(), &control, &settings)
}

/// Object coordinates of the targets that have some.
fn coordinates(survey: &Survey, settings: &Settings) -> Result<Vec<ControlRow>, CalibrationError> {
    settings.cameras.iter().try_for_each(model::check)?;
    let owners = optics::owners(&settings.cameras, &survey.images)?;
    let trials = trials(&settings.cameras)?;
    let candidates = pairs::candidates(survey);
    let (all, first) = (survey.images.len(), FIRST.min(survey.images.len()));
    let begun = |cameras: &Vec<Camera>| -> Vec<Chain<'_>> {
        let seeds = pairs::seeds(survey, &owners, cameras, &candidates);
        seeds.iter().take(SEEDS).map(|seed| Chain::begun(survey, &owners, cameras.clone(), seed, first)).collect()
    };
    let begun: Vec<Vec<Chain<'_>>> = trials.par_iter().map(begun).collect();
    let mut chains: Vec<(f64, Chain<'_>)> = begun.into_iter().flatten().map(|chain| (chain.misfit(first), chain)).collect();
    chains.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: Option<(f64, Chain<'_>)> = None;
    for (_, mut chain) in chains.into_iter().take(GO_ON) {
        chain.grow(all);
        let misfit = chain.misfit(all);
        if best.as_ref().is_none_or(|(least, _)| misfit < *least) {
            best = Some((misfit, chain));
        }
        if misfit < GOOD {
            break;
        }
    }
    let (misfit, best) = best.ok_or_else(|| CalibrationError::NoModel {
        why: "no two images show eight targets or more from different places; give --control, or --approx with coordinates near the true ones".into(),
    })?;
    let lost = best.lost();
    if !lost.is_empty() {
        let names = crate::few(&lost);
        let count = lost.len();
        let why = format!(
            "{count} of {all} images do not hang together with the others: {names}; expected six targets or more in common with them"
        );
        return Err(CalibrationError::NoModel { why });
    }
    if misfit > BAD {
        let why = "no lens explains them: are the names of targets and the size of the images right? --start and --approx help".into();
        return Err(CalibrationError::NoModel { why });
    }
    let points = best.into_points();
    let scale = scale_by(&settings.distances, |name| survey.target_called(name).and_then(|target| points[target])).unwrap_or(1.0);
    let middle = Shape::of(points.iter().flatten().copied()).centroid;
    let row = |(target, point): (usize, &Option<Point3<f64>>)| {
        point.map(|point| ControlRow::new(survey.target(target), ((point - middle) * scale).into()))
    };
    Ok(points.iter().enumerate().filter_map(row).collect())
}

/// Sets of cameras that are tried.
fn trials(all: &[Optics]) -> Result<Vec<Vec<Camera>>, CalibrationError> {
    if let Some(cameras) = all.iter().map(|optics| optics.start).collect::<Option<Vec<Camera>>>() {
        return Ok(vec![cameras]);
    }
    let is_wide = all.iter().any(model::is_wide);
    let of = |optics: &Optics, focal: f64, wide: bool| -> Result<Camera, CalibrationError> {
        if let Some(camera) = optics.start {
            return Ok(camera);
        }
        let (side, [cx, cy]) = (f64::from(optics.size.width.max(optics.size.height)), middle(optics.size)?);
        let f = focal * side;
        Ok(if wide {
            OpenCvFisheye { size: optics.size, fx: f, fy: f, cx, cy, skew: 0.0, k: [0.0; 4] }.into()
        } else {
            pinhole(optics.size, f, [cx, cy])
        })
    };
    let wide = FOCAL_WIDE.iter().filter(|_| is_wide).map(|focal| (*focal, true));
    let tried = FOCAL.iter().map(|focal| (*focal, false)).chain(wide);
    tried.map(|(focal, wide)| all.iter().map(|optics| of(optics, focal, wide)).collect()).collect()
}
