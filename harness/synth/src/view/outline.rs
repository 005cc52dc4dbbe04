//! A plate's outlines in the image.

use calibench_model::camera::{NoCounterpart, Ray};
use calibench_model::{Outline, PixelPoint, Plate};

use rayon::prelude::*;

use super::occlusion::Sheet;
use super::polygon::{Tangent, apart, bounds, doubled_area};
use super::trace::trace;
use super::{Frame, View, ViewError, clip};
use crate::raster::{Piece, orient};

/// Areas that a thread takes at a time.
const JOB: usize = 64;

/// Appends the pieces of a plate: its sheet and what is printed on it.
pub(super) fn sheet(view: &View<'_>, sheet: &Sheet<'_>, frame: &Frame, pieces: &mut Vec<Piece>) -> Result<(), ViewError> {
    let plate = sheet.plate;
    outline(view, sheet, frame, &plate.border(), plate.level - view.field.background, pieces)?;
    if sheet.front {
        let traced = plate.areas.par_chunks(JOB).map(|areas| {
            let mut pieces = Vec::new();
            for area in areas {
                outline(view, sheet, frame, &area.outline, area.level - area.ground, &mut pieces)?;
            }
            Ok(pieces)
        });
        for traced in traced.collect::<Result<Vec<_>, ViewError>>()? {
            pieces.extend(traced);
        }
    }
    Ok(())
}

fn outline(
    view: &View<'_>,
    sheet: &Sheet<'_>,
    frame: &Frame,
    outline: &Outline,
    contrast: f64,
    pieces: &mut Vec<Piece>,
) -> Result<(), ViewError> {
    if contrast == 0.0 {
        return Ok(());
    }
    let first = pieces.len();
    let free = sheet.hidden_by.is_empty() || is_free(view, sheet, outline);
    if free && whole(view, sheet.plate, frame, outline, pieces).is_ok() {
        orient(&mut pieces[first..], contrast);
        return Ok(());
    }
    pieces.truncate(first);
    let seen = frame.directions.intersect(&clip::tangents(view.pose, sheet.plate, outline));
    // The parts share one sense of rotation, that of the outline: a part may be too thin to tell its own.
    let contrast = contrast * doubled_area(&seen).signum();
    let mut parts = vec![seen];
    for hull in &sheet.hidden_by {
        parts = parts.iter().flat_map(|part| hull.subtract(part)).collect();
    }
    for part in parts.iter().filter(|part| part.len() > 2) {
        let first = pieces.len();
        polygon(view, frame, part, pieces).map_err(|why| ViewError::NoPlace { plate: sheet.plate.id.clone(), why })?;
        // y turns over between tangents and pixels.
        pieces[first..].iter_mut().for_each(|piece| piece.contrast = -contrast);
    }
    Ok(())
}

/// Whether nothing hides any part of an outline, judged by boxes.
fn is_free(view: &View<'_>, sheet: &Sheet<'_>, outline: &Outline) -> bool {
    let around = bounds(&clip::tangents(view.pose, sheet.plate, outline));
    sheet.hidden_by.iter().all(|hull| apart(hull.bounds(), around))
}

/// The outline curve by curve.
fn whole(view: &View<'_>, plate: &Plate, frame: &Frame, outline: &Outline, pieces: &mut Vec<Piece>) -> Result<(), NoCounterpart> {
    let (first, mut near) = (pieces.len(), None);
    for curve in &outline.0 {
        let project = |t: f64, near: Option<PixelPoint>| view.image(view.pose.ray(&plate.point(curve.at(t))), near);
        near = Some(trace(&project, frame.sides, view.longest(), near, pieces)?);
    }
    close(&mut pieces[first..]);
    Ok(())
}

/// A polygon of tangents.
fn polygon(view: &View<'_>, frame: &Frame, polygon: &[Tangent], pieces: &mut Vec<Piece>) -> Result<(), NoCounterpart> {
    let (first, mut near) = (pieces.len(), None);
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let project =
            |t: f64, near: Option<PixelPoint>| view.image(Ray::from_tangent(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])), near);
        near = Some(trace(&project, frame.sides, view.longest(), near, pieces)?);
    }
    close(&mut pieces[first..]);
    Ok(())
}

/// Makes each piece start exactly where the one before it ends: rounding must not leave a gap.
fn close(pieces: &mut [Piece]) {
    for i in 1..pieces.len() {
        pieces[i].points[0] = pieces[i - 1].points[4];
    }
    if let [first, .., last] = pieces {
        last.points[4] = first.points[0];
    }
}
