//! Exterior orientations, one image at a time.

use std::io;

use calibench_adjust::approximate::{ApproximateError, Resection, Search, Tolerance, resect};
use calibench_exchange::{POSE_COLUMNS, POSE_SIGMA_COLUMNS, station_numbers, write_table};
use calibench_model::camera::Camera;

use crate::{Survey, control_of};

/// A second minimum whose sum of squares is less than this many times the first one's makes a pose doubtful.
const RIVAL: f64 = 2.0;

const FURTHER_COLUMNS: [&str; 6] = ["points", "sigma0_px", "redundancy", "rejected", "another", "note"];

/// The exterior orientation of an image of a survey.
#[derive(Clone, Debug)]
pub struct ImageOrientation {
    /// Index of the image.
    pub image: usize,
    /// How many control points are measured in it.
    pub points: usize,
    /// The pose and its cofactors.
    pub found: Resection,
    /// Indices of the targets whose points did not fit.
    pub rejected: Vec<usize>,
}

/// Resects every image of `survey` from its control points; `cameras` holds that of each image, `tolerance_px` is the residual beyond which a point is
/// left out (`None`: all are kept). In the order of the images.
///
/// # Errors
/// For an image: why it has no orientation, in which case the others still have theirs.
pub fn resect_images(survey: &Survey, cameras: &[Camera], tolerance_px: Option<f64>) -> Vec<Result<ImageOrientation, ApproximateError>> {
    let known: Vec<_> = (0..survey.targets()).map(|target| survey.known(target)).collect();
    let against = tolerance_px.map(|px| Search { seed: 1, tolerance: Tolerance::Pixels(px) });
    let one = |image: usize| {
        let control = control_of(survey, &known, image);
        let found = resect(&cameras[image], &control, against.as_ref())?;
        let targets: Vec<usize> =
            survey.of_image(image).map(|sight| survey.sight(sight).target).filter(|&target| known[target].is_some()).collect();
        let rejected = found.rejected.iter().map(|&place| targets[place]).collect();
        Ok(ImageOrientation { image, points: control.len(), found, rejected })
    };
    (0..survey.images.len()).map(one).collect()
}

impl ImageOrientation {
    /// Standard deviations from the residuals: of X0, Y0, Z0 in object units, then of a small rotation about the camera's x, y and z axes in rad.
    pub fn sigmas(&self) -> [f64; 6] {
        [3, 4, 5, 0, 1, 2].map(|i| self.found.sigma0 * self.found.cofactor[(i, i)].sqrt())
    }

    /// How close another minimum comes: the ratio of its sum of squared residuals to this one's.
    pub fn rival(&self) -> Option<f64> {
        let squares = self.found.sigma0 * self.found.sigma0 * self.found.redundancy as f64;
        self.found.rival.map(|rival| rival.squares / squares.max(f64::MIN_POSITIVE))
    }

    /// Another pose fits nearly as well.
    pub fn is_doubtful(&self) -> bool {
        self.rival().is_some_and(|ratio| ratio < RIVAL)
    }

    fn cells(&self, survey: &Survey) -> Vec<String> {
        let [sx, sy, sz, turns @ ..] = self.sigmas();
        let numbers = station_numbers(&self.found.pose).into_iter().chain([sx, sy, sz]).chain(turns.map(f64::to_degrees));
        let mut row = vec![survey.images[self.image].clone()];
        row.extend(numbers.map(|number| number.to_string()));
        let rejected: Vec<&str> = self.rejected.iter().map(|&target| survey.target(target)).collect();
        row.extend([self.points.to_string(), self.found.sigma0.to_string(), self.found.redundancy.to_string(), rejected.join(" ")]);
        row.push(self.rival().map_or(String::new(), |ratio| ratio.to_string()));
        row.push(if self.is_doubtful() { "another pose fits nearly as well" } else { "" }.to_owned());
        row
    }
}

/// Writes a station file: poses in object units and degrees with standard deviations, sigma0 in px.
///
/// # Errors
/// What `file` returns.
pub fn write_orientations(file: impl io::Write, survey: &Survey, rows: &[ImageOrientation]) -> io::Result<()> {
    let columns = [&["image"], &POSE_COLUMNS[..], &POSE_SIGMA_COLUMNS, &FURTHER_COLUMNS].concat();
    write_table(file, &columns, rows.iter().map(|row| row.cells(survey)))
}
