//! Whole calibration systems within a run: each is told the same points of a trial, and its camera is compared with the true one.
//!
//! They are told what a user would know: image coordinates, the board as it is meant to be, sizes, a stated precision. What is wrong with that the scenario says.

mod disturbed;
mod figures;
mod told;

#[cfg(test)]
mod tests;

use calibench_calibrators::{Calibrated, Grid, Listed, Score};
use calibench_diagnostics::nearest;
use calibench_random::Key;
use calibench_records::results::{Calibrated as Row, PointResult};
use calibench_scenario::ViewsSubject;
use calibench_scenario::studies::calibrators::Calibrators;
use rayon::prelude::*;

pub(super) use told::in_model;
pub use told::{Asked, asked};

use super::adjust::Adjust;
use crate::Tools;

/// A study with the calibrators that there are.
pub(super) struct Study<'a> {
    pub plan: &'a Calibrators,
    pub tools: Tools<'a>,
}

impl Adjust for Study<'_> {
    fn adjust(&self, subject: &ViewsSubject, points: &[PointResult], methods: &[usize], key: Key<'_>) -> Vec<Row> {
        let of_method = |&method: &usize| {
            let asked = asked(self.plan, subject, (points, method), key);
            let of_set = |(set, name): (usize, &String)| {
                let answered = asked.as_ref().map_err(Clone::clone).and_then(|asked| {
                    let listed = found(self.tools.calibrators, name)?;
                    Ok((answer(asked, listed)?, asked))
                });
                let outcome = answered.map(|(answered, asked)| figures::of(&answered, asked.image_points()));
                Row { method, set, outcome, check_failed: None }
            };
            self.plan.names.par_iter().enumerate().map(of_set).collect::<Vec<_>>()
        };
        methods.iter().flat_map(of_method).collect()
    }
}

/// The calibrator called `name`.
///
/// # Errors
/// That there is none, in words.
pub fn found<'a>(all: &'a [Listed], name: &str) -> Result<&'a Listed, String> {
    all.iter().find(|listed| listed.name == name).ok_or_else(|| {
        let near = nearest(name, all.iter().map(|listed| listed.name.as_str()));
        let meant = near.map_or_else(String::new, |near| format!(": is `{near}` meant?"));
        format!("no calibrator is called `{name}`{meant}")
    })
}

/// The calibrators of a study that cannot be asked here, each with the reason.
pub fn absent(plan: &Calibrators, tools: Tools<'_>) -> Vec<(String, String)> {
    let why = |name: &String| match found(tools.calibrators, name) {
        Err(why) => Some(why),
        Ok(listed) if !listed.models.contains(&plan.model) => Some(listed.lacks(&plan.model)),
        Ok(listed) => listed.calibrator.version().err(),
    };
    plan.names.iter().filter_map(|name| Some((name.clone(), why(name)?))).collect()
}

/// What a calibrator made of a trial, against the truth.
#[derive(Clone, Debug)]
pub struct Answered {
    /// Its answer, and what that took.
    pub calibrated: Calibrated,
    /// How far its camera is from the true one; `None` without a camera, `Err` with the reason for one that cannot be compared.
    pub score: Result<Option<Score>, String>,
}

impl Answered {
    /// Whether a camera was given without a word that is farther off than five of its stated standard deviations and than a pixel; farther than a pixel, of one that states
    /// none.
    pub fn is_wrong_and_silent(&self) -> bool {
        const SIGMAS: f64 = 5.0;
        const FARTHER_PX: f64 = 1.0;
        if self.calibrated.answer.status != calibench_calibrators::Status::Calibrated {
            return false;
        }
        match &self.score {
            Err(_) => true,
            Ok(None) => false,
            Ok(Some(score)) => {
                let beyond = score.stated_px.map(|stated| score.frame_px > SIGMAS * stated);
                let beyond = beyond.or_else(|| score.z2_parameters.map(|z2| z2.sqrt() > SIGMAS)).unwrap_or(true);
                beyond && score.frame_px > FARTHER_PX
            }
        }
    }
}

/// Asks `listed`, and compares.
///
/// # Errors
/// Why it cannot run here or cannot be asked this, in words.
pub fn answer(asked: &Asked<'_>, listed: &Listed) -> Result<Answered, String> {
    let calibrated = listed.calibrate(&asked.task)?;
    let score = Score::of(&calibrated.answer, &asked.grid, &asked.truth, &asked.measured);
    Ok(Answered { calibrated, score })
}

/// The grid on which cameras are compared.
pub(super) fn grid(subject: &ViewsSubject) -> Grid {
    Grid::new(calibench_model::camera::CameraModel::size(&subject.camera))
}
