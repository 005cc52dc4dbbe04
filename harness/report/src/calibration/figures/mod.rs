//! What the figures of a calibration show, each once: for its pictures and for its page.

mod board;
mod corners_of_board;
mod correlations;
mod maps;
mod residuals;
mod uncertainty;

use calibench_calibrate::Calibration;

use super::uncertainty::UncertaintyMap;
use crate::Canvas;
use crate::corners::Corner;
use crate::plot::{Figure, Plot};

pub(super) use residuals::corners;

/// A camera whose figures are made.
struct OfCamera<'c, 'n> {
    calibration: &'c Calibration<'n>,
    camera: usize,
    /// What stands before the names and before the captions of its figures.
    prefix: String,
    whose: String,
}

impl<'c, 'n> OfCamera<'c, 'n> {
    fn new(calibration: &'c Calibration<'n>, camera: usize) -> Self {
        let (prefix, whose) = named(calibration, camera);
        Self { calibration, camera, prefix, whose }
    }

    /// The name of a figure: no two have the same.
    fn name(&self, name: &str) -> String {
        format!("{}{name}", self.prefix)
    }

    fn figure(&self, name: &str, (caption, remark): (&str, String), plot: Plot) -> Figure {
        Figure { name: self.name(name), caption: format!("{}{caption}", self.whose), remark, plot }
    }
}

/// The figures of a calibration.
pub(super) struct Figures {
    /// Of residuals, correlations and uncertainty, camera by camera.
    pub(super) first: Vec<Figure>,
    /// Of each camera's distortion, in their order; `None` where no camera without it is defined.
    pub(super) distortion: Vec<Option<Figure>>,
}

impl Figures {
    /// Every one.
    pub(super) fn all(&self) -> impl Iterator<Item = &Figure> {
        self.first.iter().chain(self.distortion.iter().flatten())
    }
}

/// What the figures of a calibration show; `maps` are the uncertainty's of each camera, `corners` all image points.
pub(super) fn figures(calibration: &Calibration<'_>, maps: &[Vec<UncertaintyMap>], corners: &[Corner<'_>]) -> Figures {
    let mut first: Vec<Figure> = board::figure(calibration).into_iter().chain(corners_of_board::figure(calibration)).collect();
    let cameras: Vec<OfCamera<'_, '_>> = (0..maps.len()).map(|camera| OfCamera::new(calibration, camera)).collect();
    for (of, maps) in cameras.iter().zip(maps) {
        first.push(residuals::together(of, corners));
        first.push(residuals::by_image(of));
        first.push(maps::distribution(of));
        first.extend(correlations::figure(of));
        first.extend(maps.iter().filter_map(|map| uncertainty::figure(of, map)));
    }
    Figures { first, distortion: cameras.iter().map(maps::distortion).collect() }
}

/// The residuals of each image of a camera in a small picture of its own, some in a file: file, caption and picture.
pub(super) fn panels(calibration: &Calibration<'_>, camera: usize, corners: &[Corner<'_>]) -> Vec<(String, String, Canvas)> {
    residuals::panels(&OfCamera::new(calibration, camera), corners)
}

/// What stands before the file names and before the captions of a camera's pictures, where there are several.
pub(super) fn named(calibration: &Calibration<'_>, camera: usize) -> (String, String) {
    match calibration.cameras() {
        1 => (String::new(), String::new()),
        _ => (format!("{}-", calibration.name_of(camera)), format!("{}: ", calibration.name_of(camera))),
    }
}
