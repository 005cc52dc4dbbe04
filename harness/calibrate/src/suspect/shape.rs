//! Rasters that are not as large as they are said to be, or not in both directions alike: from their points as the images place them.

use std::collections::HashMap;

use calibench_diagnostics::plain;
use calibench_model::{ControlRow, Points, upper_median};
use nalgebra::Point3;

use crate::raster::Raster;
use crate::{BoardShape, GrossErrors, Settings, prepare};

/// A share by which steps must differ from what is stated to be others.
const OTHER: f64 = 5e-3;

/// Kinds, words and control of the rasters that the images show.
pub(super) fn others(
    raster: &Raster,
    control: &[ControlRow],
    settings: &Settings,
    points: &Points,
) -> Vec<(&'static str, String, Vec<ControlRow>)> {
    let Some(found) = Found::of(raster, control, settings, points) else { return Vec::new() };
    spacing(raster, control, &found).into_iter().chain(stretch(raster, control, &found)).collect()
}

/// How long the steps of each axis are, as the images show them, object units.
struct Found([Vec<f64>; 2]);

impl Found {
    /// From a free network; the median over all rows or columns.
    fn of(raster: &Raster, control: &[ControlRow], settings: &Settings, points: &Points) -> Option<Self> {
        let free = Settings { shape: BoardShape::Free, gross: GrossErrors::Kept, ..settings.clone() };
        let prepared = prepare(points.clone(), control, &free).ok()?;
        let (solution, ..) = prepared.solution().ok()?;
        let names = prepared.network.points.iter().map(|point| point.name.as_str());
        let at: HashMap<&str, Point3<f64>> = names.zip(solution.points().iter().copied()).collect();
        let mut by_place = HashMap::new();
        for (row, place) in control.iter().zip(&raster.places) {
            at.get(row.target.as_str()).and_then(|at| by_place.insert(*place, *at));
        }
        let steps = |axis: usize| {
            let step = |k: usize| {
                let lengths = by_place.iter().filter(|(place, _)| place[axis] == k).filter_map(|(place, from)| {
                    let mut next = *place;
                    next[axis] += 1;
                    Some((by_place.get(&next)? - from).norm())
                });
                upper_median(lengths)
            };
            (0..raster.at[axis].len() - 1).map(step).collect::<Option<Vec<_>>>()
        };
        Some(Self([steps(0)?, steps(1)?]))
    }

    /// The found length of steps over the stated one: the median over steps that `counts` takes by their stated length.
    fn scale(&self, raster: &Raster, axis: usize, counts: impl Fn(f64) -> bool) -> Option<f64> {
        let stated = stated(raster, axis);
        upper_median(stated.iter().zip(&self.0[axis]).filter(|(stated, _)| counts(**stated)).map(|(stated, found)| found / stated))
    }
}

fn stated(raster: &Raster, axis: usize) -> Vec<f64> {
    raster.at[axis].windows(2).map(|pair| pair[1] - pair[0]).collect()
}

/// Coordinates from steps.
fn summed(first: f64, steps: impl Iterator<Item = f64>) -> Vec<f64> {
    std::iter::once(first)
        .chain(steps.scan(first, |at, step| {
            *at += step;
            Some(*at)
        }))
        .collect()
}

/// Tags and gaps between them: another gap.
fn spacing(raster: &Raster, control: &[ControlRow], found: &Found) -> Option<(&'static str, String, Vec<ControlRow>)> {
    let lengths = [stated(raster, 0), stated(raster, 1)].concat();
    let (tag, gap) = (lengths.iter().copied().fold(0.0, f64::max), lengths.iter().copied().fold(f64::INFINITY, f64::min));
    let is = |length: f64, other: f64| (length / other - 1.0).abs() < 1e-3;
    if is(tag, gap) || !lengths.iter().all(|&length| is(length, tag) || is(length, gap)) {
        return None;
    }
    let scale = |of: f64| {
        let both: Option<Vec<f64>> = [0, 1].into_iter().map(|axis| found.scale(raster, axis, |length| is(length, of))).collect();
        both.map(|both| f64::midpoint(both[0], both[1]))
    };
    let ratio = scale(gap)? / scale(tag)?;
    if (ratio - 1.0).abs() < OTHER {
        return None;
    }
    let at = [0, 1].map(|axis| {
        summed(raster.at[axis][0], stated(raster, axis).into_iter().map(|length| if is(length, gap) { length * ratio } else { length }))
    });
    let what = format!(
        "the gap between the tags of the board is {} of a tag's side, and {} is stated: the spacing of the board",
        plain(ratio * gap / tag),
        plain(gap / tag)
    );
    Some(("spacing", what, raster.with(&at, control)))
}

/// Another scale along columns than along rows.
fn stretch(raster: &Raster, control: &[ControlRow], found: &Found) -> Option<(&'static str, String, Vec<ControlRow>)> {
    let ratio = found.scale(raster, 0, |_| true)? / found.scale(raster, 1, |_| true)?;
    if (ratio - 1.0).abs() < OTHER {
        return None;
    }
    let at = [summed(raster.at[0][0], stated(raster, 0).into_iter().map(|length| length * ratio)), raster.at[1].clone()];
    let what =
        format!("the board is {} times as long along its rows (X) as is stated, beside its columns (Y): how was it printed?", plain(ratio));
    Some(("stretch", what, raster.with(&at, control)))
}
