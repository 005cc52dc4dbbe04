//! `calibench resect`: exterior orientations from control points, interior orientation fixed.

use std::path::PathBuf;

use calibench_calibrate::orientation::{Orientations, StatedPrecision, resect_images};
use calibench_calibrate::{Survey, few};
use calibench_cameras::inputs_of;
use calibench_exchange::read_control;
use calibench_report::plain;
use clap::Args;

use super::camera_files::CameraFiles;
use super::context::Context;
use super::output;
use crate::deliver::deliver;
use crate::failure::Failure;
use crate::inputs::read_measured;

#[derive(Args)]
pub struct Resect {
    #[command(flatten)]
    cameras: CameraFiles,
    /// Measured points: CSV with image,target,x,y, as `measure` writes it
    #[arg(long, value_name = "CSV")]
    points: PathBuf,
    /// Control points: CSV with target,X,Y,Z
    #[arg(long, value_name = "CSV")]
    control: PathBuf,
    /// Search for gross errors: residuals longer than this are left out, px
    #[arg(long, value_name = "PX", value_parser = super::convert::positive, allow_negative_numbers = true)]
    tolerance: Option<f64>,
    /// Standard deviation of an image coordinate, px: residuals are held against it [default: against those of the other images]
    #[arg(long, value_name = "PX", value_parser = super::convert::positive, allow_negative_numbers = true)]
    sigma: Option<f64>,
    /// The poses, as a station file [default: standard output]
    #[arg(short, long, value_name = "CSV")]
    output: Option<PathBuf>,
}

impl Resect {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let inputs = inputs_of([&self.points, &self.control].into_iter().chain(self.cameras.paths()));
        let output = output::table("-o", self.output.as_deref(), &inputs)?;
        let survey = Survey::new(read_measured(&self.points)?, &read_control(&self.control)?)?;
        let cameras = self.cameras.of(&survey.images)?;
        let found = resect_images(&survey, &cameras, StatedPrecision { tolerance_px: self.tolerance, sigma_px: self.sigma });
        let failed: Vec<String> = found.failed.iter().map(|(image, error)| format!("image {}: {error}", survey.images[*image])).collect();
        failed.iter().for_each(|failed| say!("{failed}"));
        if found.found.is_empty() {
            return Err(Failure::input(format!("no image could be oriented: {}", failed.join("; "))));
        }
        if !context.quiet {
            say!("resect: {} of {} images oriented", found.found.len(), survey.images.len());
            if let Some(pooled) = found.pooled() {
                say!("residuals of all images together: {} px for an image coordinate", plain(pooled));
            }
        }
        say_left_out(&found, &survey);
        let doubts = found.doubts(&survey);
        let is_doubtful = say_doubts(&found, &survey, &doubts);
        deliver(output.as_ref(), |file| found.write(&survey, &doubts, file))?;
        match (failed.is_empty(), is_doubtful) {
            (false, _) => Err(Failure::input(format!("{} images could not be oriented", failed.len()))),
            (true, true) => Err(Failure::Doubt),
            (true, false) => Ok(()),
        }
    }
}

/// Says which points took no part.
fn say_left_out(found: &Orientations, survey: &Survey) {
    let unknown: Vec<String> =
        (0..survey.targets()).filter(|&target| survey.known(target).is_none()).map(|target| survey.target(target).to_owned()).collect();
    if !unknown.is_empty() {
        say!("warning: {} of {} targets are no control points: {}", unknown.len(), survey.targets(), few(&unknown));
    }
    for one in found.found.iter().filter(|one| !one.rejected.is_empty()) {
        let names: Vec<String> = one.rejected.iter().map(|&target| survey.target(target).to_owned()).collect();
        say!("warning: image {}: {} of {} points left out: {}", survey.images[one.image], names.len(), one.points, few(&names));
    }
}

/// Says what is in doubt, if anything is.
fn say_doubts(found: &Orientations, survey: &Survey, each: &[Vec<String>]) -> bool {
    for (one, doubts) in found.found.iter().zip(each) {
        doubts.iter().for_each(|doubt| say!("image {}: in doubt: {doubt}", survey.images[one.image]));
    }
    let agree = found.agree_with_stated();
    if !agree {
        say!("in doubt: the residuals do not agree with --sigma (chi squared at 0.001)");
    }
    !agree || each.iter().any(|doubts| !doubts.is_empty())
}
