//! `calibench intersect`: object points from oriented images, interior and exterior orientations fixed.

use std::collections::HashMap;
use std::path::PathBuf;

use calibench_adjust::approximate::{Intersection, Search, Sight, Tolerance, intersect};
use calibench_calibrate::Survey;
use calibench_exchange::{Inputs, StationRow, read_stations, write_table};
use calibench_model::Pose;
use clap::Args;
use rayon::prelude::*;

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

/// Targets whose failure is told one by one.
const MOST_TOLD: usize = 100;
/// Targets that are intersected before their rows are kept.
const BATCH: usize = 1 << 14;

/// A row of the result.
struct Found {
    target: u32,
    images: u32,
    point: [f64; 3],
    /// Not numbers without redundancy.
    sigma: [f64; 3],
    angle: f64,
    sigma0: f64,
    redundancy: u32,
    /// Images whose sights did not fit.
    rejected: Vec<u32>,
}

impl Intersect {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let inputs = Inputs::new([&self.points, &self.stations].into_iter().chain(self.cameras.paths()));
        let output = output::table("-o", self.output.as_deref(), &inputs)?;
        let survey = Survey::without_control(read_measured(&self.points)?);
        let cameras = self.cameras.of(&survey.images)?;
        let poses = poses(&survey, &read_stations(&self.stations)?)?;
        let against = self.tolerance.map(|px| Search { seed: 1, tolerance: Tolerance::Pixels(px) });
        let one = |target: usize| {
            let seen = survey.of_target(target).map(|index| survey.sight(index)).filter(|sight| poses[sight.image].is_some());
            let images: Vec<usize> = seen.clone().map(|sight| sight.image).collect();
            let sight = |sight: calibench_calibrate::Sight| {
                poses[sight.image].as_ref().map(|pose| Sight { camera: &cameras[sight.image], pose, image: sight.position })
            };
            let sights: Vec<Sight<'_>> = seen.filter_map(sight).collect();
            intersect(&sights, self.least_angle.to_radians(), against.as_ref()).map(|found| Found::of(target, &images, &found))
        };
        let (mut rows, mut failed) = (Vec::new(), 0);
        for first in (0..survey.targets()).step_by(BATCH) {
            let batch: Vec<_> = (first..(first + BATCH).min(survey.targets())).into_par_iter().map(one).collect();
            for (target, found) in (first..).zip(batch) {
                match found {
                    Ok(found) => rows.push(found),
                    Err(error) => {
                        failed += 1;
                        if failed <= MOST_TOLD {
                            say!("target {}: {error}", survey.target(target));
                        }
                    }
                }
            }
        }
        if failed > MOST_TOLD {
            say!("{} more targets without a result", failed - MOST_TOLD);
        }
        if rows.is_empty() {
            return Err(Failure::input("no target could be intersected"));
        }
        if !context.quiet {
            say!("intersect: {} of {} targets, {failed} without a result", rows.len(), survey.targets());
        }
        deliver(output.as_ref(), |file| write_table(file, &COLUMNS, rows.iter().map(|row| row.cells(&survey))))
    }
}

/// The pose of each image, with a word about those that have none.
fn poses(survey: &Survey, stations: &[StationRow]) -> Result<Vec<Option<Pose>>, Failure> {
    let stem = |name: &str| name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_owned();
    let named: HashMap<&str, &StationRow> = stations.iter().map(|row| (row.image.as_str(), row)).collect();
    // `render` names stations, photographs have an ending.
    let of = |image: &String| named.get(image.as_str()).or_else(|| named.get(stem(image).as_str())).map(|row| row.pose);
    let poses: Vec<Option<Pose>> = survey.images.iter().map(of).collect();
    if poses.iter().all(Option::is_none) {
        let (image, station) = (&survey.images[0], &stations[0].image);
        return Err(Failure::input(format!("no image has a station: points are of `{image}`, stations are of `{station}`")));
    }
    for (image, _) in survey.images.iter().zip(&poses).filter(|(_, pose)| pose.is_none()) {
        say!("image {image}: has no station; its points are left out");
    }
    Ok(poses)
}

impl Found {
    fn of(target: usize, images: &[usize], found: &Intersection) -> Self {
        let checked = found.redundancy > 0;
        let sigma = |i: usize| if checked { found.sigma0 * found.cofactor[(i, i)].sqrt() } else { f64::NAN };
        Self {
            target: target as u32,
            images: images.len() as u32,
            point: found.point.into(),
            sigma: [sigma(0), sigma(1), sigma(2)],
            angle: found.angle,
            sigma0: found.sigma0,
            redundancy: found.redundancy as u32,
            rejected: found.rejected.iter().map(|&i| images[i] as u32).collect(),
        }
    }

    /// A point with standard deviations from its residuals; without redundancy there are none.
    fn cells(&self, survey: &Survey) -> Vec<String> {
        let checked = self.redundancy > 0;
        let mut row = vec![survey.target(self.target as usize).to_owned()];
        row.extend(self.point.iter().map(f64::to_string));
        row.extend(self.sigma.iter().map(|sigma| if checked { sigma.to_string() } else { String::new() }));
        row.extend([self.images.to_string(), self.angle.to_degrees().to_string(), self.sigma0.to_string(), self.redundancy.to_string()]);
        let rejected: Vec<&str> = self.rejected.iter().map(|&image| survey.images[image as usize].as_str()).collect();
        row.extend([rejected.join(" "), if checked { String::new() } else { "not checked".into() }]);
        row
    }
}
