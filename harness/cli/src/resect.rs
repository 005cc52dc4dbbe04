//! `calibench resect`: exterior orientations from control points, interior orientation fixed.

use std::path::PathBuf;

use calibench_adjust::approximate::{Resection, Search, Tolerance, resect};
use calibench_calibrate::{Survey, control_of};
use calibench_exchange::{Inputs, POSE_COLUMNS, POSE_SIGMA_COLUMNS, read_control, station_numbers, write_table};
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

const FURTHER_COLUMNS: [&str; 6] = ["points", "sigma0_px", "redundancy", "rejected", "another", "note"];

impl Resect {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let inputs = Inputs::new([&self.points, &self.control].into_iter().chain(self.cameras.paths()));
        let output = output::table("-o", self.output.as_deref(), &inputs)?;
        let survey = Survey::new(read_measured(&self.points)?, &read_control(&self.control)?)?;
        let cameras = self.cameras.of(&survey.images)?;
        let known: Vec<_> = (0..survey.targets()).map(|target| survey.known(target)).collect();
        let against = self.tolerance.map(|px| Search { seed: 1, tolerance: Tolerance::Pixels(px) });
        let (mut rows, mut failed) = (Vec::new(), Vec::new());
        for (index, image) in survey.images.iter().enumerate() {
            let control = control_of(&survey, &known, index);
            let rejected = |found: &Resection| {
                let targets = survey.of_image(index).map(|sight| survey.sight(sight).target);
                let names: Vec<&str> = targets.filter(|&target| known[target].is_some()).map(|target| survey.target(target)).collect();
                found.rejected.iter().map(|&i| names[i]).collect::<Vec<_>>().join(" ")
            };
            match resect(&cameras[index], &control, against.as_ref()) {
                Ok(found) => rows.push(row(image, control.len(), &found, rejected(&found))),
                Err(error) => failed.push(format!("image {image}: {error}")),
            }
        }
        failed.iter().for_each(|failed| say!("{failed}"));
        if rows.is_empty() {
            return Err(Failure::input(format!("no image could be oriented: {}", failed.join("; "))));
        }
        if !context.quiet {
            say!("resect: {} of {} images oriented", rows.len(), survey.images.len());
        }
        let columns = [&["image"], &POSE_COLUMNS[..], &POSE_SIGMA_COLUMNS, &FURTHER_COLUMNS].concat();
        deliver(output.as_ref(), |file| write_table(file, &columns, &rows))?;
        if failed.is_empty() { Ok(()) } else { Err(Failure::input(format!("{} images could not be oriented", failed.len()))) }
    }
}

/// A pose with standard deviations from the residuals: of X0 in object units, of a small rotation about the camera's axes in degrees; and how close
/// another minimum comes, as the ratio of the sums of squares.
fn row(image: &str, points: usize, found: &Resection, rejected: String) -> Vec<String> {
    let sigma = |i: usize| found.sigma0 * found.cofactor[(i, i)].sqrt();
    let numbers = station_numbers(&found.pose).into_iter().chain([sigma(3), sigma(4), sigma(5)]);
    let turns = [sigma(0), sigma(1), sigma(2)].map(f64::to_degrees);
    let mut row = vec![image.to_owned()];
    row.extend(numbers.chain(turns).map(|number| number.to_string()));
    let squares = found.sigma0 * found.sigma0 * found.redundancy as f64;
    let another = found.rival.map(|rival| rival.squares / squares.max(f64::MIN_POSITIVE));
    let doubtful = another.is_some_and(|ratio| ratio < 2.0);
    row.extend([points.to_string(), found.sigma0.to_string(), found.redundancy.to_string(), rejected]);
    row.push(another.map_or(String::new(), |ratio| ratio.to_string()));
    row.push(if doubtful { "another pose fits nearly as well" } else { "" }.to_owned());
    row
}
