//! A calibration as a page with pictures and tables, and as a summary for a terminal.

mod board;
mod checks;
mod csv;
mod digits;
mod discs;
mod figures;
mod html;
mod known;
mod lengths;
mod limits;
mod measured_board;
mod next;
mod own_numbers;
mod page;
mod ply;
mod rig;
mod rig_stands;
mod scale;
mod sets_page;
mod splined;
mod splined_page;
mod tables;
mod uncertainty;
mod warnings;

use calibench_calibrate::Calibration;

pub use crate::corners::Pictured;
pub use known::{CAMERAS_FILE, CalibratedCamera, CalibratedCameras};
pub(crate) use limits::CORRELATED;
pub use page::{summary, write_report};
pub use ply::scene_ply;
pub use rig::rig_summary;
pub use rig_stands::rig_stands;
pub use splined::splined_summary;
pub use splined_page::write_splined_report;
pub use uncertainty::FrameUncertainty;
pub use warnings::warnings;

/// The bend of the board that was adjusted and its standard deviations, object units: along u, along v, twist.
pub(crate) fn board_bend(calibration: &Calibration<'_>) -> Option<([f64; 3], [f64; 3])> {
    board::adjusted(calibration).map(|(_, values, sigmas)| (values, sigmas))
}

/// How many observations of the network are in each image.
pub(crate) fn points_by_image(calibration: &Calibration<'_>) -> Vec<usize> {
    let network = &calibration.prepared.network;
    let mut counts = vec![0; network.images.len()];
    network.observations.iter().for_each(|o| counts[o.image] += 1);
    counts
}

/// The images of a camera.
pub(crate) fn images_of(calibration: &Calibration<'_>, camera: usize) -> impl Iterator<Item = usize> {
    (0..calibration.solution.poses().len()).filter(move |&image| calibration.owner(image) == camera)
}

#[cfg(test)]
mod page_tests;
#[cfg(test)]
mod tests;
