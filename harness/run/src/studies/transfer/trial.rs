//! One trial: every case of every method.

use calibench_model::camera::Camera;
use calibench_random::Key;
use calibench_records::figures::Quantity;
use calibench_records::results::{Calibrated, Figure};
use calibench_scenario::studies::transfer::{Calibrates, Case, Conditions, Decomposition};

use super::Campaign;
use super::calibrated::{Calibration, calibration};
use super::camera::applied;
use super::decomposition::Split;
use super::drawn::Drawn;
use super::figures;
use super::points::{Checked, checked};
use crate::RunError;

/// All adjustments of the trial of `key`, by method and then by case.
///
/// # Errors
/// Images that cannot be rendered.
pub fn run(campaign: &Campaign<'_>, key: Key<'_>) -> Result<Vec<Calibrated>, RunError> {
    let mut bench = Bench { campaign, drawn: Drawn::new(campaign, key)?, calibrations: Vec::new(), compared: Vec::new() };
    let transfer = campaign.transfer;
    let mut all = Vec::new();
    for method in (0..transfer.methods.len()).filter(|&method| campaign.tools.lack(transfer, method).is_none()) {
        for (set, case) in transfer.cases.iter().enumerate().filter(|(_, case)| case.methods.contains(&method)) {
            all.push(bench.case(method, set, case, key.trial == 0));
        }
        for (place, plan) in transfer.decompositions.iter().enumerate().filter(|(_, plan)| plan.methods.contains(&method)) {
            let outcome = bench.split(method, plan);
            all.push(Calibrated { method, set: transfer.cases.len() + place, outcome, check_failed: None });
        }
    }
    Ok(all)
}

/// What a trial has come to so far: a calibration serves many cases.
struct Bench<'a> {
    campaign: &'a Campaign<'a>,
    drawn: Drawn<'a>,
    calibrations: Vec<((usize, Conditions), Result<Calibration, String>)>,
    compared: Vec<(Camera, Result<f64, String>)>,
}

impl Bench<'_> {
    fn case(&mut self, method: usize, set: usize, case: &Case, first: bool) -> Calibrated {
        let unit = self.campaign.subject.unit.name();
        let mut failed = Vec::new();
        let outcome = self.applied(method, &case.conditions).and_then(|(calibration, camera)| {
            let mut found = figures::of_camera(self.campaign, &calibration, &camera)?;
            match self.over_frame(&camera) {
                Ok(rms) => found.push(Figure::plain(Quantity::OverFrame, rms, "px")),
                Err(why) => failed.push(format!("over the frame: {why}")),
            }
            match self.checked(&camera, &case.conditions) {
                Ok(points) => {
                    found.extend(figures::of_points(&points, unit));
                    if first || case.points {
                        found.extend(figures::every_point(self.campaign, &points, unit));
                    }
                }
                Err(why) => failed.push(why),
            }
            Ok(found)
        });
        let check_failed = (!failed.is_empty()).then(|| failed.join("; "));
        Calibrated { method, set, outcome, check_failed }
    }

    fn split(&mut self, method: usize, plan: &Decomposition) -> Result<Vec<Figure>, String> {
        let split = Split::new(plan, |conditions| {
            let (_, camera) = self.applied(method, conditions)?;
            Ok(self.checked(&camera, conditions)?.iter().map(|point| point.error.xy()).collect())
        })?;
        let runs = Figure::plain(Quantity::Runs, split.runs() as f64, "");
        Ok(split.figures(self.campaign.subject.unit.name()).into_iter().chain([runs]).collect())
    }

    /// The calibration of a method, and the camera that is applied of it.
    fn applied(&mut self, method: usize, conditions: &Conditions) -> Result<(Calibration, Camera), String> {
        let calibration = self.calibration(method, conditions)?;
        let camera = match self.campaign.transfer.methods[method].calibrates {
            // A data sheet's camera is in mm, and there is nothing to convert.
            Calibrates::Never => calibration.camera,
            _ => applied(&calibration.camera, conditions, self.campaign.transfer.pitch_um)?,
        };
        Ok((calibration, camera))
    }

    fn checked(&mut self, camera: &Camera, conditions: &Conditions) -> Result<Vec<Checked>, String> {
        let held = self.calibration(self.campaign.transfer.poses_of, conditions)?;
        checked(self.campaign, &self.drawn, camera, &held.poses, conditions)
    }

    fn over_frame(&mut self, camera: &Camera) -> Result<f64, String> {
        let known = self.campaign.compared.iter().chain(&self.compared);
        if let Some((_, known)) = known.into_iter().find(|(other, _)| other == camera) {
            return known.clone();
        }
        let found = figures::over_frame(&self.campaign.subject.camera, camera);
        self.compared.push((*camera, found.clone()));
        found
    }

    fn calibration(&mut self, method: usize, conditions: &Conditions) -> Result<Calibration, String> {
        let transfer = self.campaign.transfer;
        let plan = &transfer.methods[method];
        let key = (method, relevant(plan.calibrates, conditions));
        if let Some((_, known)) = self.calibrations.iter().find(|(other, _)| *other == key) {
            return known.clone();
        }
        // Another calibration from the same control starts where one ended: from nothing but the same images.
        let near = match plan.calibrates {
            Calibrates::FromControl if method != transfer.poses_of => self.calibration(transfer.poses_of, conditions).ok(),
            Calibrates::FromControl => {
                self.calibrations.iter().find(|((other, _), _)| *other == method).and_then(|(_, known)| known.clone().ok())
            }
            Calibrates::FromBoard { .. } | Calibrates::Never => None,
        };
        let found = calibration(self.campaign, &self.drawn, method, conditions, near.as_ref().map(|near| near.poses.as_slice()));
        self.calibrations.push((key, found.clone()));
        found
    }
}

/// The conditions without what makes no difference to a calibration.
fn relevant(calibrates: Calibrates, conditions: &Conditions) -> Conditions {
    let Conditions { measurement, survey, bend, refocus, board_sigma_px, network, .. } = *conditions;
    match calibrates {
        Calibrates::FromControl => Conditions { measurement, survey, network, ..Conditions::none() },
        Calibrates::FromBoard { .. } => Conditions { measurement, bend, refocus, board_sigma_px, ..Conditions::none() },
        Calibrates::Never => Conditions::none(),
    }
}
