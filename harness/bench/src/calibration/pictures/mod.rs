//! The pictures of a calibration.

mod correlations;
mod distribution;
mod frame;
mod levels;
mod residuals;
mod uncertainty;

use std::io;
use std::path::Path;

use super::Calibration;

/// A picture and what it shows.
pub(super) struct Picture {
    /// Its file name.
    pub(super) file: String,
    /// What it shows, in a sentence.
    pub(super) caption: String,
}

/// Draws all pictures into `folder`.
pub(super) fn draw(calibration: &Calibration<'_>, folder: &Path) -> io::Result<Vec<Picture>> {
    let mut drawn = Vec::new();
    let mut add = |file: &str, caption: String, canvas: crate::report::Canvas| {
        drawn.push(Picture { file: file.to_owned(), caption });
        canvas.write(&folder.join(file))
    };
    add("residuals.png", "Residuals (adjusted less observed) of all images together.".into(), residuals::together(calibration))?;
    for (index, (names, canvas)) in residuals::by_image(calibration).into_iter().enumerate() {
        add(&format!("residuals-by-image-{}.png", index + 1), format!("Residuals by image: {names}."), canvas)?;
    }
    let caption = "Where the image points lie in the frame: their number in each cell. Empty cells are extrapolation.";
    add("distribution.png", caption.into(), distribution::picture(calibration))?;
    if calibration.covariances.parameters.len() > 1 {
        let caption = "Correlations of the interior orientation, framed where |rho| exceeds 0.9.";
        add("correlations.png", caption.into(), correlations::picture(calibration))?;
    }
    for (file, caption, canvas) in uncertainty::pictures(calibration) {
        add(file, caption, canvas)?;
    }
    Ok(drawn)
}
