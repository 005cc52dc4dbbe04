//! `calibench orient`: the relative orientation of two images, and the model that they make; interior orientations fixed.

use std::collections::HashMap;
use std::path::PathBuf;

use calibench_adjust::approximate::{ApproximateError, RelativeOrientation, Search, Tolerance, orient_relatively};
use calibench_diagnostics::nearest;
use calibench_exchange::{Inputs, Points};
use calibench_model::PixelPoint;
use calibench_model::camera::Camera;
use calibench_model::escape;
use clap::Args;

use super::context::Context;
use super::convert::positive;
use super::output;
use crate::deliver::deliver;
use crate::failure::Failure;
use crate::inputs::{camera, read_measured};

mod model;
mod seen;
mod words;

use model::Model;
use seen::Seen;

#[derive(Args)]
pub struct Orient {
    /// Measured points: CSV with image,target,x,y, as `measure` writes it
    #[arg(long, value_name = "CSV")]
    points: PathBuf,
    /// The image in whose axes the model is (x right, y up, z backwards), as the point file names it
    #[arg(long, value_name = "IMAGE")]
    left: String,
    /// The other image
    #[arg(long, value_name = "IMAGE")]
    right: String,
    /// A camera file of any known format
    #[arg(long, value_name = "FILE")]
    camera: PathBuf,
    /// Camera of the right image, if it is another one
    #[arg(long, value_name = "FILE")]
    camera_right: Option<PathBuf>,
    /// Size of the images, for camera files that do not state it
    #[arg(long, value_name = "WxH", value_parser = super::reading::size)]
    size: Option<calibench_model::camera::ImageSize>,
    /// Length of the base, object units
    #[arg(long, value_name = "LENGTH", default_value_t = 1.0, value_parser = positive, allow_negative_numbers = true)]
    base: f64,
    /// Residuals longer than this are gross errors, px [default: estimated from the median, one right point in a thousand is lost]
    #[arg(long, value_name = "PX", value_parser = positive, allow_negative_numbers = true)]
    tolerance: Option<f64>,
    /// Rays that meet at a smaller angle are parallel, degrees
    #[arg(long, value_name = "DEG", default_value_t = 0.1, value_parser = positive, allow_negative_numbers = true)]
    least_angle: f64,
    /// Seed of the search for gross errors
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// The points: model coordinates with standard deviations, residuals, status [default: standard output]
    #[arg(short, long, value_name = "CSV")]
    output: Option<PathBuf>,
    /// Both poses, as a station file with standard deviations
    #[arg(long, value_name = "CSV")]
    poses: Option<PathBuf>,
}

impl Orient {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let inputs = Inputs::new([&self.points, &self.camera].into_iter().chain(&self.camera_right));
        let output = output::table("-o", self.output.as_deref(), &inputs)?;
        let poses = output::table("--poses", self.poses.as_deref(), &inputs)?;
        output::distinct(("-o", output.as_ref()), ("--poses", poses.as_ref()))?;
        let left = camera(&self.camera, self.size)?;
        let right = self.camera_right.as_deref().map_or(Ok(left), |path| camera(path, self.size))?;
        let seen = self.seen(&read_measured(&self.points)?)?;
        let found = self.orient([&left, &right], &seen)?;
        let model = Model::of([&left, &right], &seen, &found, self.base, self.least_angle.to_radians());
        if !context.quiet {
            eprint!("{}", escape::message(&words::summary(&model, [&self.left, &self.right])));
        }
        words::warnings(&model).iter().for_each(|warning| say!("warning: {warning}"));
        deliver(output.as_ref(), |file| model.write_points(file))?;
        match &poses {
            Some(poses) => deliver(Some(poses), |file| model.write_poses(file, [&self.left, &self.right])),
            None => Ok(()),
        }
    }

    fn orient(&self, cameras: [&Camera; 2], seen: &[Seen]) -> Result<RelativeOrientation, Failure> {
        let pairs: Vec<[PixelPoint; 2]> = seen.iter().filter_map(Seen::pair).collect();
        let tolerance = self.tolerance.map_or(Tolerance::Unknown, Tolerance::Pixels);
        orient_relatively(cameras, &pairs, &Search { seed: self.seed, tolerance }).map_err(|error| {
            Failure::input(match error {
                ApproximateError::TooFew { needed, found, .. } => format!(
                    "images {} and {} have {found} targets in common: five determine the relative orientation (up to ten solutions), \
                     {needed} are the least with which one can be chosen and checked",
                    self.left, self.right
                ),
                other => format!("images {} and {}: {other}", self.left, self.right),
            })
        })
    }

    /// The targets of both images, in the order of the file.
    fn seen(&self, points: &Points) -> Result<Vec<Seen>, Failure> {
        if self.left == self.right {
            return Err(Failure::input(format!("--left and --right both name {}: expected two images", self.left)));
        }
        for (option, name) in [("left", &self.left), ("right", &self.right)] {
            if points.images().find(name).is_none() {
                let near = nearest(name, points.images().iter());
                let near = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
                return Err(Failure::input(format!("--{option} {name}: no point is of this image{near}")));
            }
        }
        let (mut seen, mut places) = (Vec::<Seen>::new(), HashMap::new());
        for row in points.rows() {
            let Some(side) = [&self.left, &self.right].iter().position(|name| **name == row.image) else { continue };
            let place = *places.entry(row.target).or_insert_with(|| {
                seen.push(Seen { target: row.target.to_owned(), at: [None; 2] });
                seen.len() - 1
            });
            seen[place].at[side] = Some(row.start.position);
        }
        Ok(seen)
    }
}
