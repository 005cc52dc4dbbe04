//! Calibrate here, apply there, within a run: cameras are calibrated from control or from a board, changed on their way as the scenario says, and check points
//! are intersected with them.
//!
//! Calibrations are told what a user would know: image coordinates, the survey, a flat board, a data sheet. Conditions of one trial share their random
//! numbers, so that their differences are what they differ by.

mod bent;
mod calibrated;
mod camera;
mod decomposition;
mod drawn;
mod figures;
mod imaged;
mod methods;
mod points;
mod trial;

#[cfg(test)]
mod tests;

pub(crate) use methods::method_infos;

use calibench_model::PixelPoint;
use calibench_model::camera::Camera;
use calibench_random::Key;
use calibench_records::results::Trial;
use calibench_scenario::studies::transfer::{Calibrates, Conditions};
use calibench_scenario::{Transfer, ViewsSubject};
use calibench_synth::view::View;
use nalgebra::Point3;

use crate::prepared::is_pointed_at;
use crate::{RunError, Tools};

/// A target or corner, by its place in the field, and its image coordinates, px.
pub type Seen = (usize, PixelPoint);

/// What is the same in all trials.
pub struct Campaign<'a> {
    subject: &'a ViewsSubject,
    transfer: &'a Transfer,
    /// What pictures the board, where images of one are rendered.
    board: Option<&'a ViewsSubject>,
    /// Where the targets are, object units.
    truth: Vec<Point3<f64>>,
    /// Which of them are control.
    is_control: Vec<bool>,
    /// Which of them are check points.
    is_check: Vec<bool>,
    /// All stations, by their places.
    all: Vec<usize>,
    tools: Tools<'a>,
    /// Of each station the control and check points that it sees, and where, px.
    images: Vec<Vec<Seen>>,
    /// Principal distance and point of the true camera, mm.
    interior: [f64; 3],
    /// How far the cameras that are never calibrated are from the true one, px, or why they cannot be compared.
    compared: Vec<(Camera, Result<f64, String>)>,
}

impl<'a> Campaign<'a> {
    /// Of `transfer`, which is applied to `subject`; `board` pictures the board from which calibrations are made.
    ///
    /// # Errors
    /// A view that cannot be pictured, by the name of its station.
    pub fn new(
        subject: &'a ViewsSubject,
        transfer: &'a Transfer,
        board: Option<&'a ViewsSubject>,
        tools: Tools<'a>,
    ) -> Result<Self, RunError> {
        let field = &subject.field;
        let is = |list: &[usize]| (0..field.targets.len()).map(|target| list.contains(&target)).collect::<Vec<bool>>();
        let (is_control, is_check) = (is(&transfer.control), is(&transfer.check));
        let image = |station: &calibench_synth::stations::Station| {
            let view = View { field, camera: &subject.camera, local: None, pose: &station.pose };
            let seen = view
                .seen(station.own.optics(&subject.imaging.optics).reach())
                .map_err(|source| RunError::View { station: station.name.clone(), source })?;
            let used = seen.truth().into_iter().enumerate().filter(|(target, _)| is_control[*target] || is_check[*target]);
            Ok(used.filter(|(_, truth)| is_pointed_at(subject, truth)).filter_map(|(target, truth)| Some((target, truth.at?))).collect())
        };
        let images = subject.stations.iter().map(image).collect::<Result<_, RunError>>()?;
        let truth = field.targets.iter().map(|target| field.position(target)).collect();
        let interior = camera::interior(&subject.camera, transfer.pitch_um).map_err(std::io::Error::other)?;
        let never = transfer.methods.iter().filter(|method| method.calibrates == Calibrates::Never);
        let compared = never.map(|method| (method.start, figures::over_frame(&subject.camera, &method.start))).collect();
        let all = (0..subject.stations.len()).collect();
        Ok(Self { subject, transfer, board, truth, is_control, is_check, all, tools, images, interior, compared })
    }

    /// The trial of `key`: every case of every method, then the splits.
    ///
    /// # Errors
    /// Images that cannot be rendered.
    pub fn trial(&self, key: Key<'_>) -> Result<Trial, RunError> {
        Ok(Trial { number: key.trial, calibrations: trial::run(self, key)?, ..Trial::default() })
    }

    /// The stations that there are under `conditions`.
    fn all_stations(&self, conditions: &Conditions) -> &[usize] {
        conditions.network.map_or(&self.all, |network| &self.transfer.networks[network])
    }

    /// Those of them from which check points are intersected.
    fn check_stations(&self, conditions: &Conditions) -> &[usize] {
        conditions.network.map_or(&self.transfer.stations, |network| &self.transfer.networks[network])
    }
}
