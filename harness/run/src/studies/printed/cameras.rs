//! What follows from printed cameras alone: how tools are converted, where cameras fold over, what the direct conversion costs.

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, Fold, Photogrammetric, fold};
use calibench_model::convert::{ConvertOptions, DifferenceOptions, Region, Tangential, Target, convert, difference, from_naive, naive};
use calibench_records::figures::Quantity;
use calibench_records::results::Figure;
use calibench_scenario::Printed;
use calibench_scenario::studies::printed::{Column, Variant};

/// By which power of c the radial coefficients are divided.
const POWERS: [Quantity; 3] = [Quantity::PowerK1, Quantity::PowerK2, Quantity::PowerK3];
/// Columns and rows of the grid on which an inverse is tried.
const GRID: (usize, usize) = (61, 41);

/// The figures of a column.
///
/// # Errors
/// In words: a camera that cannot be converted or compared.
pub fn figures(printed: &Printed, column: &Column) -> Result<Vec<Figure>, String> {
    let camera = column.camera;
    let mut all = vec![Figure::plain(Quantity::LessFirst, camera.c - printed.cameras[0].camera.c, "mm")];
    folded([Quantity::FoldCorrectionRadius, Quantity::FoldCorrectionShare], &camera.into(), camera.pitch_um, &mut all);
    all.push(Figure::plain(Quantity::InverseError, round_trip(&camera.into()), "px"));
    let Some(tool) = column.target() else { return Ok(all) };
    let told = |error: calibench_model::convert::ConvertError| format!("{}: {error}", column.name);
    all.extend(scheme(&camera, tool).map_err(told)?);
    let own = from_naive(&camera, tool, Tangential::Converted).map_err(told)?;
    folded([Quantity::FoldOwnRadius, Quantity::FoldOwnShare], &own, camera.pitch_um, &mut all);
    all.extend(direct(printed, &camera, &own).map_err(told)?);
    Ok(all)
}

/// Where a camera folds over inside the frame, if it does.
fn folded([radius, of_frame]: [Quantity; 2], camera: &Camera, pitch_um: f64, all: &mut Vec<Figure>) {
    if let Some(Fold { radius_px, share }) = fold(camera) {
        all.push(Figure::plain(radius, radius_px * pitch_um * 1e-3, "mm"));
        all.push(Figure::plain(of_frame, 100.0 * share, "%"));
    }
}

/// The largest distance between a pixel and where the camera pictures its ray, px: over the frame, or within its fold.
fn round_trip(camera: &Camera) -> f64 {
    let (size, (columns, rows)) = (camera.size(), GRID);
    let place = |index: usize, count: usize, length: u32| f64::from(length - 1) * index as f64 / (count - 1) as f64;
    let pixels =
        (0..columns * rows).map(|i| PixelPoint::new(place(i % columns, columns, size.width), place(i / columns, rows, size.height)));
    let back = |pixel: PixelPoint| Some(camera.project(camera.unproject(pixel).ok()?).ok()?.distance(pixel));
    pixels.filter_map(back).fold(0.0, f64::max)
}

/// How the tool's coefficients become photogrammetric ones: by which power of c the radial ones are divided, and what p1 and p2 are made of, over c.
fn scheme(camera: &Photogrammetric, tool: Target) -> Result<Vec<Figure>, calibench_model::convert::ConvertError> {
    let probe = Photogrammetric { k: [1e-4, 1e-6, 1e-8], p: [0.0; 2], ..*camera };
    let own = from_naive(&probe, tool, Tangential::Converted)?;
    // Twice the pitch is twice the principal distance of the same tool's camera.
    let [once, twice] = [camera.pitch_um, 2.0 * camera.pitch_um].map(|um| naive(&own, um, Tangential::Converted));
    let (once, twice) = (once?, twice?);
    let powers = (0..3).map(|i| Figure::plain(POWERS[i], -(twice.k[i] / once.k[i]).log2(), ""));
    let mut all: Vec<Figure> = powers.collect();
    for (of, p) in [([Quantity::P1OfFirst, Quantity::P2OfFirst], [1e-4, 0.0]), ([Quantity::P1OfSecond, Quantity::P2OfSecond], [0.0, 1e-4])]
    {
        // As printed, p1 is the tool's first over c: this is the tool's camera with that coefficient alone.
        let own = from_naive(&Photogrammetric { p, ..probe }, tool, Tangential::AsPrinted)?;
        let made = naive(&own, camera.pitch_um, Tangential::Converted)?.p;
        all.extend((0..2).map(|i| Figure::plain(of[i], made[i] / 1e-4, "")));
    }
    Ok(all)
}

/// What the direct conversion `camera` of the tool's `own` camera costs, beside an exact one.
fn direct(printed: &Printed, camera: &Photogrammetric, own: &Camera) -> Result<Vec<Figure>, calibench_model::convert::ConvertError> {
    let region = Region::inside_fold(own);
    let options = ConvertOptions { region, accept: true, ..ConvertOptions::default() };
    let exact = convert(own, Target::photogrammetric(camera.pitch_um), &options)?;
    let over = DifferenceOptions { region, ..DifferenceOptions::default() };
    let as_is = difference(own, &(*camera).into(), &DifferenceOptions { rotation: false, ..over })?;
    let turned = difference(own, &(*camera).into(), &over)?;
    let unit = printed.unit.name();
    Ok(vec![
        Figure::plain(Quantity::ExactRms, exact.residual.rms_px, "px"),
        Figure::plain(Quantity::ExactMost, exact.residual.max_px, "px"),
        Figure::plain(Quantity::DirectRms, as_is.spread.rms_px, "px"),
        Figure::plain(Quantity::DirectMost, as_is.spread.max_px, "px"),
        Figure::plain(Quantity::DirectRmsTurned, turned.spread.rms_px, "px"),
        Figure::plain(Quantity::DirectMostTurned, turned.spread.max_px, "px"),
        Figure::plain(Quantity::DirectRmsOnObject.of(&[unit]), as_is.on_object(as_is.spread.rms_px, printed.distance), unit),
        Figure::plain(Quantity::DirectMostOnObject.of(&[unit]), as_is.on_object(as_is.spread.max_px, printed.distance), unit),
    ])
}

/// What a changed camera costs in the image, against the printed one.
///
/// # Errors
/// In words: cameras that cannot be compared.
pub fn varied(printed: &Printed, variant: &Variant) -> Result<Vec<Figure>, String> {
    let base: Camera = printed.cameras[variant.of].camera.into();
    // Compared where both are one to one: of two regions the smaller.
    let within = |camera: Camera| match Region::inside_fold(&camera) {
        Region::Frame => None,
        Region::Radius { px } => Some(px),
    };
    let radius = [base, variant.camera.into()].into_iter().filter_map(within).min_by(f64::total_cmp);
    let region = radius.map_or(Region::Frame, |px| Region::Radius { px });
    let over = DifferenceOptions { region, ..DifferenceOptions::default() };
    let found = difference(&base, &variant.camera.into(), &over).map_err(|error| format!("{}: {error}", variant.name))?;
    let (spread, unit) = (found.spread, printed.unit.name());
    let radius = radius.map(|px| Figure::plain(Quantity::ComparedWithin, px, "px"));
    let all = [
        Figure::plain(Quantity::DifferenceRms, spread.rms_px, "px"),
        Figure::plain(Quantity::DifferenceMost, spread.max_px, "px"),
        Figure::plain(Quantity::DifferenceOnObject.of(&[unit]), found.on_object(spread.rms_px, printed.distance), unit),
    ];
    Ok(all.into_iter().chain(radius).collect())
}
