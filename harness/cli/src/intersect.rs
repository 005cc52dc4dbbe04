//! `calibench intersect`: object points from oriented images, interior and exterior orientations fixed.

use std::path::PathBuf;

use calibench_calibrate::Survey;
use calibench_calibrate::orientation::{ObjectPoints, StatedPrecision, poses_of};
use calibench_cameras::inputs_of;
use calibench_exchange::read_stations;
use calibench_report::plain;
use clap::Args;

use super::camera_files::{CameraFiles, say_outside};
use super::context::Context;
use super::output;
use crate::deliver::deliver;
use crate::failure::Failure;
use crate::inputs::read_measured;

#[derive(Args)]
pub struct Intersect {
    #[command(flatten)]
    cameras: CameraFiles,
    /// Measured points: CSV with image,target,x,y, as `measure` writes it
    #[arg(long, value_name = "CSV")]
    points: PathBuf,
    /// Exterior orientations: CSV with image,X0,Y0,Z0,omega_deg,phi_deg,kappa_deg, as `render`, `resect` and `calibrate --report` write it
    #[arg(long, value_name = "CSV")]
    stations: PathBuf,
    /// Rays that meet at a smaller angle are parallel, degrees
    #[arg(long, value_name = "DEG", default_value_t = 0.1, value_parser = super::convert::positive, allow_negative_numbers = true)]
    least_angle: f64,
    /// Search for gross errors: residuals longer than this are left out, px
    #[arg(long, value_name = "PX", value_parser = super::convert::positive, allow_negative_numbers = true)]
    tolerance: Option<f64>,
    /// Standard deviation of an image coordinate, px [default: that of the residuals of all targets together]
    #[arg(long, value_name = "PX", value_parser = super::convert::positive, allow_negative_numbers = true)]
    sigma: Option<f64>,
    /// The points: a control file with quality and status [default: standard output]
    #[arg(short, long, value_name = "CSV")]
    output: Option<PathBuf>,
}

impl Intersect {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let inputs = inputs_of([&self.points, &self.stations].into_iter().chain(self.cameras.paths()));
        let output = output::table("-o", self.output.as_deref(), &inputs)?;
        let survey = Survey::without_control(read_measured(&self.points)?);
        let cameras = self.cameras.of(&survey.images)?;
        let poses = poses_of(&survey, &read_stations(&self.stations)?)?;
        for (image, _) in survey.images.iter().zip(&poses).filter(|(_, pose)| pose.is_none()) {
            say!("image {image}: has no station; its points are left out");
        }
        let sights = (0..survey.sights()).map(|index| survey.sight(index));
        let is_outside = say_outside(sights.map(|sight| (&cameras[sight.image], sight.position)));
        let stated = StatedPrecision { tolerance_px: self.tolerance, sigma_px: self.sigma };
        let points = ObjectPoints::of(&survey, &cameras, &poses, self.least_angle.to_radians(), stated);
        points.first_failures.iter().for_each(|(target, error)| say!("target {}: {error}", survey.target(*target)));
        let untold = points.failed - points.first_failures.len();
        if untold > 0 {
            say!("{untold} more targets without a result");
        }
        if points.is_empty() {
            return Err(Failure::input("no target could be intersected"));
        }
        if !context.quiet {
            say!("intersect: {} of {} targets, {} without a result", points.len(), survey.targets(), points.failed);
            if let Some(pooled) = points.pooled() {
                say!("residuals of all targets together: {} px for an image coordinate", plain(pooled));
            }
        }
        if points.left_out() > 0 {
            say!("warning: {} image points left out; the table says of which images", points.left_out());
        }
        let agree = self.sigma.is_none_or(|sigma| points.agrees_with(sigma));
        if !agree {
            say!("in doubt: the residuals do not agree with --sigma (chi squared at 0.001)");
        }
        let (misfits, no_chance) = (points.misfits(), points.misfits_are_no_chance());
        if misfits > 0 {
            let how = if no_chance { "in doubt" } else { "warning" };
            say!("{how}: {misfits} of {} targets do not fit (chi squared at 0.001 of each; the table's notes say which)", points.len());
        }
        deliver(output.as_ref(), |file| points.write(&survey, file))?;
        if agree && !no_chance && !is_outside { Ok(()) } else { Err(Failure::Doubt) }
    }
}
