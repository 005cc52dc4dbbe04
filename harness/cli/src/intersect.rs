//! `calibench intersect`: object points from oriented images, interior and exterior orientations fixed.

use std::path::PathBuf;

use calibench_adjust::approximate::{Intersection, Search, Sight, Tolerance, intersect};
use calibench_calibrate::Survey;
use calibench_exchange::{Inputs, StationRow, read_stations, write_table};
use calibench_model::Pose;
use clap::Args;

use super::camera_files::CameraFiles;
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
    /// The points: a control file with quality and status [default: standard output]
    #[arg(short, long, value_name = "CSV")]
    output: Option<PathBuf>,
}

const COLUMNS: [&str; 13] =
    ["target", "X", "Y", "Z", "sX", "sY", "sZ", "images", "angle_deg", "sigma0_px", "redundancy", "rejected", "note"];

impl Intersect {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let inputs = Inputs::new([&self.points, &self.stations].into_iter().chain(self.cameras.paths()));
        let output = output::table("-o", self.output.as_deref(), &inputs)?;
        let points = read_measured(&self.points)?;
        let survey = Survey::without_control(&points);
        let cameras = self.cameras.of(&survey.images)?;
        let poses = poses(&survey, &read_stations(&self.stations)?)?;
        let against = self.tolerance.map(|px| Search { seed: 1, tolerance: Tolerance::Pixels(px) });
        let mut by_target: Vec<Vec<usize>> = vec![Vec::new(); survey.targets.len()];
        survey.sights.iter().enumerate().for_each(|(index, sight)| by_target[sight.target].push(index));
        let (mut rows, mut failed) = (Vec::new(), 0);
        for (target, seen) in survey.targets.iter().zip(&by_target) {
            let oriented: Vec<usize> = seen.iter().copied().filter(|&i| poses[survey.sights[i].image].is_some()).collect();
            let sight = |&i: &usize| {
                let sight = &survey.sights[i];
                poses[sight.image].as_ref().map(|pose| Sight { camera: &cameras[sight.image], pose, image: sight.position })
            };
            let sights: Vec<Sight<'_>> = oriented.iter().filter_map(sight).collect();
            match intersect(&sights, self.least_angle.to_radians(), against.as_ref()) {
                Ok(found) => {
                    let name = |&i: &usize| survey.images[survey.sights[oriented[i]].image].as_str();
                    let rejected = found.rejected.iter().map(name).collect::<Vec<_>>().join(" ");
                    rows.push(row(&target.name, sights.len(), &found, rejected));
                }
                Err(error) => {
                    failed += 1;
                    eprintln!("target {}: {error}", target.name);
                }
            }
        }
        if rows.is_empty() {
            return Err(Failure::input("no target could be intersected"));
        }
        if !context.quiet {
            eprintln!("intersect: {} of {} targets, {failed} without a result", rows.len(), survey.targets.len());
        }
        deliver(output.as_ref(), |file| write_table(file, &COLUMNS, &rows))
    }
}

/// The pose of each image, with a word about those that have none.
fn poses(survey: &Survey, stations: &[StationRow]) -> Result<Vec<Option<Pose>>, Failure> {
    let stem = |name: &str| name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_owned();
    let of = |image: &String| {
        let same = stations.iter().find(|row| row.image == *image);
        // `render` names stations, photographs have an ending.
        same.or_else(|| stations.iter().find(|row| row.image == stem(image))).map(|row| row.pose)
    };
    let poses: Vec<Option<Pose>> = survey.images.iter().map(of).collect();
    if poses.iter().all(Option::is_none) {
        let (image, station) = (&survey.images[0], &stations[0].image);
        return Err(Failure::input(format!("no image has a station: points are of `{image}`, stations are of `{station}`")));
    }
    for (image, _) in survey.images.iter().zip(&poses).filter(|(_, pose)| pose.is_none()) {
        eprintln!("image {image}: has no station; its points are left out");
    }
    Ok(poses)
}

/// A point with standard deviations from its residuals; without redundancy there are none.
fn row(target: &str, images: usize, found: &Intersection, rejected: String) -> Vec<String> {
    let mut row = vec![target.to_owned()];
    row.extend(found.point.iter().map(f64::to_string));
    let sigma = |i: usize| if found.redundancy > 0 { (found.sigma0 * found.cofactor[(i, i)].sqrt()).to_string() } else { String::new() };
    row.extend([sigma(0), sigma(1), sigma(2)]);
    row.extend([images.to_string(), found.angle.to_degrees().to_string(), found.sigma0.to_string(), found.redundancy.to_string()]);
    row.extend([rejected, if found.redundancy > 0 { String::new() } else { "not checked".into() }]);
    row
}
