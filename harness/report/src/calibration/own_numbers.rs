//! What each image has for itself.

use std::io;

use calibench_adjust::PerImage;
use calibench_calibrate::{Calibration, OwnNumber, Scatter};
use calibench_files::NewFolder;
use calibench_model::camera::CameraModel;
use calibench_model::escape;

use super::csv::table;
use super::digits::rounded;
use crate::markdown::MarkdownTable;

/// Images that a page lists.
const MOST: usize = 50;

/// One line for each number whose scatter the images told.
pub(super) fn facts<'c>(calibration: &'c Calibration<'_>) -> impl Iterator<Item = String> + 'c {
    calibration.prepared.scatter.iter().map(|Scatter { camera, name, sigma, unit }| {
        let of = calibration.of(*camera);
        if *sigma == 0.0 {
            format!("{name}{of} is not seen to differ from image to image")
        } else {
            format!("{name}{of} differs from image to image by {} {unit} (standard deviation, as the images tell)", rounded(0.0, *sigma).1)
        }
    })
}

/// What the camera's covariance has not: by how much a further photograph may differ.
pub(super) fn warning(calibration: &Calibration<'_>) -> Option<String> {
    let (prepared, scale) = (calibration.prepared, calibration.covariances.variance_factor.sqrt());
    let is_unseen =
        |own: &PerImage| prepared.scatter.iter().any(|seen| seen.sigma == 0.0 && seen.camera == own.camera && seen.name == own.name);
    let one = |own: &PerImage| {
        let unit = own.along.first().map_or("", |(parameter, _)| calibration.camera(own.camera).parameters()[*parameter].unit);
        format!("{}{} by {} {unit}", own.name, calibration.of(own.camera), rounded(0.0, own.sigma * scale).1).trim_end().to_owned()
    };
    let all: Vec<String> = prepared.network.per_image.iter().filter(|own| !is_unseen(own)).map(one).collect();
    let words = || {
        format!(
            "a further photograph differs from the camera of all, {} (standard deviations), which its covariance has not",
            all.join(", ")
        )
    };
    (!all.is_empty()).then(words)
}

/// The table of images; nothing where nothing was asked for.
pub(super) fn section(calibration: &Calibration<'_>) -> String {
    let numbers = calibration.own_numbers();
    if numbers.is_empty() {
        return String::new();
    }
    let mut rows = MarkdownTable::new(&["image", "number", "differs by", "standard deviation", "unit", "t"]);
    for number in numbers.iter().take(MOST) {
        let (value, sigma) = rounded(number.value, number.sigma);
        let image = escape::markdown(&number.image).into_owned();
        rows.row([
            image,
            number.name.clone(),
            value,
            sigma,
            unit(calibration, number).into(),
            format!("{:.1}", number.value / number.sigma),
        ]);
    }
    let rest = numbers.len().saturating_sub(MOST);
    let more = if rest > 0 { format!("\nand {rest} more in `per-image.csv`\n") } else { String::new() };
    format!(
        "\n## What each image has for itself\n\nBy how much the camera of an image differs from that of all.\n\n{}{more}",
        rows.render()
    )
}

/// All of them as CSV, where there are any.
pub(super) fn write(calibration: &Calibration<'_>, folder: &NewFolder) -> io::Result<()> {
    let numbers = calibration.own_numbers();
    if numbers.is_empty() {
        return Ok(());
    }
    let rows = numbers.iter().map(|number| {
        let values = [number.value, number.sigma, number.prior_sigma, number.share].map(|value| value.to_string());
        [number.image.clone(), number.name.clone()].into_iter().chain(values).collect::<Vec<_>>()
    });
    table(folder, "per-image.csv", &["image", "number", "value", "sigma", "prior_sigma", "redundancy"], rows)
}

fn unit(calibration: &Calibration<'_>, number: &OwnNumber) -> &'static str {
    let parameters = calibration.camera(number.camera).parameters();
    parameters.get(number.parameter).map_or("", |parameter| parameter.unit)
}
