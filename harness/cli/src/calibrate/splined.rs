//! `calibench calibrate --model splined:...`: mrcal's splines.

use calibench_calibrate::splined::{Core, SplineGrid, SplinedCalibration, SplinedSettings, calibrate_splined, prepare_splined};
use calibench_cameras::{inputs_of, of_splines};
use calibench_model::NamedCamera;
use calibench_model::camera::Splined;
use calibench_report::calibration::{splined_summary, write_splined_report};
use calibench_report::json::SplinedAnswer;
use clap::Args;

use super::super::context::Context;
use super::{Calibrate, Input, Outputs, camera_file};
use crate::deliver::{answer, print};
use crate::failure::Failure;

#[derive(Args)]
pub struct SplinedArguments {
    /// Values at which the core of splines is held, as in fx=2019,fy=2059,cx=3018,cy=1957 [default: those of the nearest stereographic camera]
    #[arg(long, value_name = "NAME=VALUE", value_delimiter = ',', allow_hyphen_values = true)]
    hold: Vec<String>,
}

impl SplinedArguments {
    /// Refuses what other models do not know.
    pub fn without_splines(&self) -> Result<(), Failure> {
        match self.hold.first() {
            Some(_) => Err(Failure::input("--hold: holds the core of splines; of other models expected --start with --solve")),
            None => Ok(()),
        }
    }

    /// The core, held where `--hold` says, with the parameters `solve` solved for.
    fn core(&self, solve: &[String]) -> Result<Core, Failure> {
        let held = self.hold.iter().try_fold(Core::HELD, |core, text| core.holding(text));
        let core = held.map_err(|why| Failure::input(format!("--hold: {why}")))?;
        core.solving(solve).map_err(|why| Failure::input(format!("--solve: {why}")))
    }
}

impl Calibrate {
    /// The grid of splines that --model names, if it names one.
    ///
    /// # Errors
    /// A grid that is none.
    pub(super) fn spline_grid(&self) -> Result<Option<SplineGrid>, Failure> {
        let Some(model) = self.cameras.models().find(|model| SplineGrid::is_meant(model)) else { return Ok(None) };
        model.parse::<SplineGrid>().map(Some).map_err(|why| Failure::input(format!("--model: {why}")))
    }

    /// What splines do not go with, by the option.
    fn refuse_for_splines(&self) -> Result<(), Failure> {
        let given = [
            (self.cameras.are_several(), "--camera"),
            (self.rig.is_asked(), "--rig"),
            (self.reconstruction.path.is_some(), "--reconstruction"),
            (self.distances.is_some(), "--distances"),
            (!self.length.is_empty(), "--length"),
            (self.approx.is_some(), "--approx"),
            (self.eccentricity.is_some(), "--eccentricity"),
            (self.poses.is_some(), "--poses"),
            (!self.compare.is_empty(), "--compare"),
            (self.scene.is_some(), "--scene"),
            (self.certificate.is_some(), "--certificate"),
            (self.known.is_given(), "what is stated of a board (--board-file, --save-board, --board-scale, --print-noise)"),
            (self.huber.is_some(), "--huber"),
            (self.snoop, "--snoop"),
            (self.cameras.has_priors(), "--prior"),
            (self.cameras.has_per_image(), "--per-image"),
        ];
        let name = |(_, name): &(bool, &'static str)| Err(Failure::input(format!("{name} is not there for splines")));
        given.iter().find(|(is_given, _)| *is_given).map_or(Ok(()), name)
    }

    /// As [`Calibrate::run`], of splines.
    pub(super) fn run_splined(&self, grid: SplineGrid, taken: &[String], context: &Context<'_>) -> Result<(), Failure> {
        self.refuse_for_splines()?;
        let core = self.splined.core(&self.cameras.common_solve().unwrap_or_default())?;
        let given = [&self.points, &self.control].into_iter().flatten().cloned();
        let inputs = inputs_of(self.photos.iter().cloned().chain(given).chain(self.cameras.starts()));
        let outputs = self.outputs(&inputs)?;
        let Input { points, photos, control, is_free, mut doubts, .. } = self.input(context)?;
        doubts.extend(taken.iter().cloned());
        if is_free {
            return Err(Failure::input(
                "splines: expected --control, or photographs of a board: they are adjusted before coordinates that are known",
            ));
        }
        if control.iter().any(|row| row.disc.is_some()) {
            say!(
                "the centres of discs' pictures are taken as the pictures of their centres: of splines their eccentricity is not taken out"
            );
        }
        let settings = self.settings(&photos, None)?;
        let prepared = prepare_splined(&points, &control, &SplinedSettings { settings, grid, core })?;
        let found = calibrate_splined(&prepared)?;
        let told = if self.answered.json {
            answer(&SplinedAnswer::new(&found, &doubts))
        } else {
            let before: String = doubts.iter().map(|doubt| format!("in doubt: {doubt}\n")).collect();
            print(&(before + &splined_summary(&found)))
        };
        // What one place refuses is not lost for the others.
        let delivered = self.deliver_splined(&found, &doubts, &outputs);
        told.and(delivered)?;
        if found.doubts.is_empty() && doubts.is_empty() { Ok(()) } else { Err(Failure::Doubt) }
    }

    fn deliver_splined(&self, found: &SplinedCalibration<'_>, doubts: &[String], outputs: &Outputs) -> Result<(), Failure> {
        let camera = outputs.camera.as_ref().map_or(Ok(()), |output| {
            let splines = found.solution.camera();
            let ending = output.path().extension().and_then(|ending| ending.to_str());
            let holds_splines = self.to.as_deref().map_or(ending == Some("cameramodel"), |to| to == "mrcal");
            // The nearest camera of another model takes longer than all the rest where a part of the frame has no ray.
            let named = if holds_splines { NamedCamera::splined("", splines.clone()) } else { nearest(splines) };
            if !holds_splines {
                named.notes.iter().for_each(|note| say!("{}: {note}", output.path().display()));
                if let Some(why) = named.doubt() {
                    return Err(Failure::input(format!("-o {}: {why}; expected the ending cameramodel, mrcal's", output.path().display())));
                }
            }
            camera_file::write_named(output, &[named], self.to.as_deref())
        });
        let report = outputs.report.as_ref();
        let report = report.map_or(Ok(()), |folder| folder.replace(|folder| write_splined_report(found, doubts, folder)));
        camera?;
        Ok(report?)
    }
}

/// Splines with the camera of another model that is nearest to them, for files that hold none; where there is none, that is said.
fn nearest(splines: &Splined) -> NamedCamera {
    of_splines("", splines.clone()).unwrap_or_else(|why| {
        say!("{why}");
        NamedCamera::splined("", splines.clone())
    })
}
