//! `calibench resect`: exterior orientations from control points, interior orientation fixed.

use std::path::PathBuf;

use calibench_calibrate::Survey;
use calibench_calibrate::orientation::{resect_images, write_orientations};
use calibench_exchange::{Inputs, read_control};
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
    /// The poses, as a station file [default: standard output]
    #[arg(short, long, value_name = "CSV")]
    output: Option<PathBuf>,
}

impl Resect {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let inputs = Inputs::new([&self.points, &self.control].into_iter().chain(self.cameras.paths()));
        let output = output::table("-o", self.output.as_deref(), &inputs)?;
        let survey = Survey::new(read_measured(&self.points)?, &read_control(&self.control)?)?;
        let cameras = self.cameras.of(&survey.images)?;
        let (mut oriented, mut failed) = (Vec::new(), Vec::new());
        for (image, result) in survey.images.iter().zip(resect_images(&survey, &cameras, self.tolerance)) {
            match result {
                Ok(found) => oriented.push(found),
                Err(error) => failed.push(format!("image {image}: {error}")),
            }
        }
        failed.iter().for_each(|failed| say!("{failed}"));
        if oriented.is_empty() {
            return Err(Failure::input(format!("no image could be oriented: {}", failed.join("; "))));
        }
        if !context.quiet {
            say!("resect: {} of {} images oriented", oriented.len(), survey.images.len());
        }
        deliver(output.as_ref(), |file| write_orientations(file, &survey, &oriented))?;
        if failed.is_empty() { Ok(()) } else { Err(Failure::input(format!("{} images could not be oriented", failed.len()))) }
    }
}
