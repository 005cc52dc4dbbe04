//! The pictures of a calibration.

mod board;
mod correlations;
mod distribution;
mod residuals;
mod uncertainty;

use std::io;

use calibench_calibrate::Calibration;
use calibench_files::NewFolder;
use calibench_model::camera::CameraModel;

use super::uncertainty::UncertaintyMap;
use crate::Canvas;

pub(super) use correlations::{own, tint};
pub(super) use distribution::counts;
pub(super) use residuals::{PANELS, length};
pub(super) use uncertainty::plain_level;

/// A picture and what it shows.
pub(super) struct Picture {
    /// Its file name.
    pub(super) file: String,
    /// What it shows, in a sentence.
    pub(super) caption: String,
}

/// Draws all pictures into `folder`, camera by camera; `maps` are the uncertainty's of each.
pub(super) fn draw(calibration: &Calibration<'_>, maps: &[Vec<UncertaintyMap>], folder: &NewFolder) -> io::Result<Vec<Picture>> {
    let mut drawn = Vec::new();
    if let Some(canvas) = board::picture(calibration) {
        folder.write("board.png", |output| canvas.encode(output))?;
        drawn.push(Picture { file: "board.png".into(), caption: board::CAPTION.into() });
    }
    for (camera, maps) in maps.iter().enumerate() {
        let (prefix, whose) = named(calibration, camera);
        for (file, caption, canvas) in of_camera(calibration, camera, maps) {
            let file = format!("{prefix}{file}");
            folder.write(&file, |output| canvas.encode(output))?;
            drawn.push(Picture { file, caption: format!("{whose}{caption}") });
        }
    }
    Ok(drawn)
}

/// What stands before the file names and before the captions of a camera's pictures, where there are several.
pub(super) fn named(calibration: &Calibration<'_>, camera: usize) -> (String, String) {
    match calibration.cameras() {
        1 => (String::new(), String::new()),
        _ => (format!("{}-", calibration.name_of(camera)), format!("{}: ", calibration.name_of(camera))),
    }
}

fn of_camera(calibration: &Calibration<'_>, camera: usize, maps: &[UncertaintyMap]) -> Vec<(String, String, Canvas)> {
    let residuals = residuals::together(calibration, camera);
    let mut drawn = vec![("residuals.png".into(), "Residuals (adjusted less observed) of all images together.".into(), residuals)];
    for (index, (names, canvas)) in residuals::by_image(calibration, camera).into_iter().enumerate() {
        drawn.push((format!("residuals-by-image-{}.png", index + 1), format!("Residuals by image: {names}."), canvas));
    }
    let caption = "Where the image points lie in the frame: their number in each cell. Empty cells are extrapolation.";
    drawn.push(("distribution.png".into(), caption.into(), distribution::picture(calibration, camera)));
    if let Some(canvas) = correlations::picture(calibration, camera) {
        let caption = "Correlations of the interior orientation, framed where |rho| exceeds 0.9.";
        drawn.push(("correlations.png".into(), caption.into(), canvas));
    }
    drawn.extend(
        uncertainty::pictures(calibration.camera(camera).size(), maps)
            .into_iter()
            .map(|(file, caption, canvas)| (file.to_owned(), caption, canvas)),
    );
    drawn
}
