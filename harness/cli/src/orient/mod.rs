//! `calibench orient`: the relative orientation of two images, and the model that they make; interior orientations fixed.

use std::path::{Path, PathBuf};

use calibench_adjust::approximate::{ApproximateError, Tolerance};
use calibench_calibrate::orientation::{Pair, PairError, Seen, Side};
use calibench_cameras::inputs_of;
use calibench_model::camera::Camera;
use calibench_model::{Points, escape};
use calibench_report::orientation;
use clap::Args;

use super::context::Context;
use super::convert::positive;
use super::output;
use crate::camera_files::say_outside;
use crate::deliver::deliver;
use crate::failure::Failure;
use crate::inputs::{camera_for, read_measured};

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
    /// Size of the images, for camera files that do not state it or are of another size
    #[arg(long, value_name = "WxH", value_parser = super::reading::size)]
    size: Option<calibench_model::camera::ImageSize>,
    /// The camera of a file took the images of --size, too, if they have the same aspect and another size: it is taken as it is in theirs
    #[arg(long, requires = "size")]
    same_camera: bool,
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
        let inputs = inputs_of([&self.points, &self.camera].into_iter().chain(&self.camera_right));
        let output = output::table("-o", self.output.as_deref(), &inputs)?;
        let poses = output::table("--poses", self.poses.as_deref(), &inputs)?;
        output::distinct(("-o", output.as_ref()), ("--poses", poses.as_ref()))?;
        let camera = |path: &Path| camera_for(path, self.size, self.same_camera);
        let left = camera(&self.camera)?;
        let right = self.camera_right.as_deref().map_or(Ok(left), camera)?;
        let seen = self.seen(&read_measured(&self.points)?)?;
        let sights = seen.iter().flat_map(|seen| [(&left, seen.at[0]), (&right, seen.at[1])]);
        let is_outside = say_outside(sights.filter_map(|(camera, at)| Some((camera, at?))));
        let pair = self.orient([&left, &right], seen)?;
        if !context.quiet {
            crate::say::plain(escape::message(&orientation::summary(&pair, [&self.left, &self.right])));
        }
        orientation::warnings(&pair).iter().for_each(|warning| say!("warning: {warning}"));
        deliver(output.as_ref(), |file| pair.write_points(file))?;
        if let Some(poses) = &poses {
            deliver(Some(poses), |file| pair.write_poses(file, [&self.left, &self.right]))?;
        }
        if pair.found.rival.is_none() && !is_outside { Ok(()) } else { Err(Failure::Doubt) }
    }

    fn orient(&self, cameras: [&Camera; 2], seen: Vec<Seen>) -> Result<Pair, Failure> {
        let tolerance = self.tolerance.map_or(Tolerance::Unknown, Tolerance::Pixels);
        Pair::orient(cameras, seen, (tolerance, self.seed), self.base, self.least_angle.to_radians()).map_err(|error| {
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
        Seen::of(points, &self.left, &self.right).map_err(|error| match &error {
            PairError::Same(image) => Failure::input(format!("--left and --right both name {image}: expected two images")),
            PairError::NoPoint { side: Side::Left, .. } => Failure::input(format!("--left {error}")),
            PairError::NoPoint { side: Side::Right, .. } => Failure::input(format!("--right {error}")),
        })
    }
}
