//! What inputs may be.

use std::borrow::Cow;

use calibench_model::{ControlRow, PixelPoint, Points};

use super::LENS;
use super::{scale, shape};
use crate::raster::Raster;
use crate::{BoardShape, Calibration, GrossErrors, Optics, Settings, model};

/// Other inputs in place of those given.
pub(super) struct Alternative<'a> {
    pub(super) kind: &'static str,
    pub(super) what: String,
    pub(super) points: Cow<'a, Points>,
    pub(super) control: Cow<'a, [ControlRow]>,
    pub(super) settings: Settings,
}

/// All that can be tried.
pub(super) fn all<'a>(
    points: &'a Points,
    control: &'a [ControlRow],
    settings: &Settings,
    found: Option<&Calibration<'_>>,
) -> Vec<Alternative<'a>> {
    // Gross errors and the bend of a board are another question.
    let settings = Settings { gross: GrossErrors::Kept, shape: BoardShape::Flat, ..settings.clone() };
    let given = |kind, what: String| Alternative {
        kind,
        what,
        points: Cow::Borrowed(points),
        control: Cow::Borrowed(control),
        settings: settings.clone(),
    };
    let mut all = Vec::new();
    if settings.cameras.iter().any(|optics| !model::is_wide(optics)) {
        let what = "the lens pictures angles, as a fisheye does, and the model is that of a pinhole: --model opencv-fisheye";
        all.push(Alternative { settings: with_model(&settings, "opencv-fisheye"), ..given(LENS, what.into()) });
    }
    match Raster::of(control) {
        Some(raster) => {
            all.extend(raster.exchanged(control).map(|other| {
                let what = format!(
                    "columns and rows of the board are exchanged: {} x {} in place of {} x {}",
                    raster.rows, raster.columns, raster.columns, raster.rows
                );
                Alternative { control: Cow::Owned(other), ..given("raster", what) }
            }));
            let shapes = found.into_iter().flat_map(|found| shape::others(&raster, control, &found.prepared.settings, points));
            all.extend(shapes.map(|(kind, what, other)| Alternative { control: Cow::Owned(other), ..given(kind, what) }));
        }
        // A plane that is mirrored in the image is the same plane from behind.
        None => {
            let mirrored = mirrored(points, &settings);
            all.extend(mirrored.map(|(kind, what, other)| Alternative { points: Cow::Owned(other), ..given(kind, what.into()) }));
            let scaled = found.and_then(|found| scale::other(control, &found.prepared.settings, points));
            all.extend(scaled.map(|(what, other)| Alternative { control: Cow::Owned(other), ..given("scale", what) }));
        }
    }
    all
}

/// The same with OpenCV's pinhole and its five coefficients, all of them unknown, where another pinhole was asked for or some are held.
pub(super) fn richer<'a>(points: &'a Points, control: &'a [ControlRow], settings: &Settings) -> Option<Alternative<'a>> {
    let is_other = |optics: &Optics| !model::is_wide(optics) && (optics.solve.is_some() || model::name(optics) != "opencv5");
    if !settings.cameras.iter().any(is_other) {
        return None;
    }
    let settings = Settings { gross: GrossErrors::Kept, shape: BoardShape::Flat, ..with_model(settings, "opencv5") };
    Some(Alternative { kind: "", what: String::new(), points: Cow::Borrowed(points), control: Cow::Borrowed(control), settings })
}

/// The same cameras with another model where they are pinholes; what was said of parameters of another model does not count.
fn with_model(settings: &Settings, model: &str) -> Settings {
    let other = |optics: &Optics| {
        if model::is_wide(optics) {
            optics.clone()
        } else {
            Optics { model: Some(model.into()), solve: None, priors: Vec::new(), start: None, ..optics.clone() }
        }
    };
    Settings { cameras: settings.cameras.iter().map(other).collect(), ..settings.clone() }
}

/// The points as they are if x and y are exchanged, or y counts upwards.
fn mirrored(points: &Points, settings: &Settings) -> impl Iterator<Item = (&'static str, &'static str, Points)> {
    let height = settings.cameras.first().map_or(0.0, |optics| f64::from(optics.size.height));
    let exchanged = |at: PixelPoint| PixelPoint::new(at.y, at.x);
    let up = move |at: PixelPoint| PixelPoint::new(at.x, height - 1.0 - at.y);
    [
        ("axes", "x and y of the image points are exchanged", moved(points, exchanged)),
        ("up", "y of the image points counts upwards, and y = height - 1 - y is meant", moved(points, up)),
    ]
    .into_iter()
}

fn moved(points: &Points, to: impl Fn(PixelPoint) -> PixelPoint) -> Points {
    let mut moved = points.clone();
    moved.move_each(to);
    moved
}
