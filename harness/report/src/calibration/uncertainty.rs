//! The uncertainty of projected points over the frame, and where it is extrapolated.

use std::io;

use calibench_adjust::{Distance, Held, Uncertainty, Variance};
use calibench_calibrate::Calibration;
use calibench_files::NewFolder;
use calibench_model::camera::{CameraModel, ImageSize};
use calibench_model::{PixelPoint, upper_median};

use super::csv::table;
use crate::hull::Hull;
use crate::plain;

/// Places along the longer side of the frame.
const PLACES: usize = 48;

/// The uncertainty of points at one distance, on a grid over the frame of a camera.
pub(super) struct UncertaintyMap {
    pub(super) distance: Distance,
    /// Columns and rows of the grid, from the first pixel's centre to the last's.
    pub(super) grid: (usize, usize),
    /// Row by row; `None` where the camera has no ray.
    pub(super) places: Vec<Option<Uncertainty>>,
    /// What image points surround.
    pub(super) measured: Hull,
}

impl UncertaintyMap {
    /// Standard deviation (2D), px: `sqrt(sxx + syy)`, in the order of the places; not a number where the camera has no ray.
    pub(super) fn sigmas(&self) -> Vec<f64> {
        let sigma = |u: &Uncertainty| (u.covariance.sxx + u.covariance.syy).max(0.0).sqrt();
        self.places.iter().map(|place| place.as_ref().map_or(f64::NAN, sigma)).collect()
    }

    /// Of an object point, in words.
    pub(super) fn whose(&self) -> String {
        match self.distance {
            Distance::Far => "far away".into(),
            Distance::Near(distance) => format!("at {} object units", plain(distance)),
        }
    }
}

/// Maps for points far away and at the working distance. Empty if the interior orientation is fixed.
pub(super) fn maps(calibration: &Calibration<'_>, camera: usize) -> Vec<UncertaintyMap> {
    if calibration.covariances.of_camera(camera).0.is_empty() {
        return Vec::new();
    }
    let points = measured(calibration, camera);
    let near = working_distance(calibration, camera);
    [Distance::Far, Distance::Near(near)].into_iter().filter_map(|distance| map(calibration, camera, distance, &points)).collect()
}

/// The uncertainty of the image of a point far away, poses held by what was measured: over a grid, and at chosen places.
#[derive(Clone, Debug)]
pub struct FrameUncertainty {
    /// Columns and rows of the grid, from the first pixel's centre to the last's.
    pub grid: (usize, usize),
    /// Row by row: where, the standard deviation (2D, px; `None` where the camera has no ray), and whether image points surround it.
    pub places: Vec<(PixelPoint, Option<f64>, bool)>,
    /// The same at corners, middles of sides and the middle of the frame, row by row.
    pub chosen: Vec<(PixelPoint, Option<f64>, bool)>,
}

impl FrameUncertainty {
    /// Of a camera; `None` where its interior orientation is fixed, or nothing can be said.
    pub fn of(calibration: &Calibration<'_>, camera: usize) -> Option<Self> {
        if calibration.covariances.of_camera(camera).0.is_empty() {
            return None;
        }
        let size = calibration.camera(camera).size();
        let (grid, measured) = (grid(size), Hull::of(&measured(calibration, camera)));
        let of = |grid: (usize, usize)| -> Option<Vec<(PixelPoint, Option<f64>, bool)>> {
            let wanted = places(size, grid);
            let found = at_places(calibration, camera, Distance::Far, &wanted)?;
            let sigma = |found: &Uncertainty| (found.covariance.sxx + found.covariance.syy).max(0.0).sqrt();
            Some(wanted.iter().zip(found).map(|(at, found)| (*at, found.as_ref().map(sigma), measured.holds(*at))).collect())
        };
        Some(Self { grid, places: of(grid)?, chosen: of((3, 3))? })
    }
}

/// The places of a grid, row by row.
fn places(size: ImageSize, grid: (usize, usize)) -> Vec<PixelPoint> {
    let along = |i: usize, n: usize, length: u32| f64::from(length - 1) * i as f64 / (n - 1) as f64;
    let place = |k: usize| PixelPoint::new(along(k % grid.0, grid.0, size.width), along(k / grid.0, grid.1, size.height));
    (0..grid.0 * grid.1).map(place).collect()
}

/// The uncertainty at each of some places; `None` where the camera has no ray.
fn at_places(calibration: &Calibration<'_>, camera: usize, distance: Distance, wanted: &[PixelPoint]) -> Option<Vec<Option<Uncertainty>>> {
    let variance = if calibration.solution.counts().redundancy() > 0 { Variance::Estimated } else { Variance::Apriori };
    let found = calibration.solution.projection_uncertainty(camera, variance, wanted, (distance, Held::ByPoints)).ok()?;
    let mut found = found.into_iter().peekable();
    Some(wanted.iter().map(|at| found.next_if(|found| found.at == *at)).collect())
}

fn map(calibration: &Calibration<'_>, camera: usize, distance: Distance, measured: &[PixelPoint]) -> Option<UncertaintyMap> {
    let size = calibration.camera(camera).size();
    let grid = grid(size);
    let places = at_places(calibration, camera, distance, &places(size, grid))?;
    Some(UncertaintyMap { distance, grid, places, measured: Hull::of(measured) })
}

fn grid(size: ImageSize) -> (usize, usize) {
    let step = f64::from(size.width.max(size.height)) / PLACES as f64;
    let places = |length: u32| ((f64::from(length) / step).round() as usize).max(3);
    (places(size.width), places(size.height))
}

/// Image points of a camera that take part.
pub(super) fn measured(calibration: &Calibration<'_>, camera: usize) -> Vec<PixelPoint> {
    let observations = calibration.prepared.network.observations.iter();
    observations.filter(|o| calibration.owner(o.image) == camera).map(|o| o.position).collect()
}

/// The median distance of what a camera sees, along its axis, object units.
fn working_distance(calibration: &Calibration<'_>, camera: usize) -> f64 {
    let (poses, points) = (calibration.solution.poses(), calibration.solution.points());
    let depth = |o: &calibench_adjust::ImageObservation| -poses[o.image].ray(&points[o.point]).z;
    let observations = calibration.prepared.network.observations.iter().filter(|o| calibration.owner(o.image) == camera);
    upper_median(observations.map(depth)).filter(|depth| *depth > 0.0).unwrap_or(1.0)
}

/// Writes `uncertainty.csv`: a row for each place that has a ray, px and px^2.
pub(super) fn write(calibration: &Calibration<'_>, maps: &[Vec<UncertaintyMap>], folder: &NewFolder) -> io::Result<()> {
    let columns = ["camera", "distance", "x", "y", "sxx", "sxy", "syy", "sigma", "measured"];
    let rows = maps.iter().enumerate().flat_map(|(camera, maps)| {
        let name = calibration.name_of(camera);
        maps.iter().flat_map(move |map| rows(name, map))
    });
    table(folder, "uncertainty.csv", &columns, rows)
}

fn rows(camera: &str, map: &UncertaintyMap) -> Vec<Vec<String>> {
    let distance = match map.distance {
        Distance::Far => "far".to_owned(),
        Distance::Near(distance) => distance.to_string(),
    };
    let row = |(place, sigma): (&Uncertainty, f64)| {
        let Uncertainty { at, covariance: c } = place;
        let numbers = [at.x, at.y, c.sxx, c.sxy, c.syy, sigma].map(|number| number.to_string());
        let measured = if map.measured.holds(*at) { "inside" } else { "outside" };
        [camera.to_owned(), distance.clone()].into_iter().chain(numbers).chain([measured.to_owned()]).collect()
    };
    map.places.iter().zip(map.sigmas()).filter_map(|(place, sigma)| Some((place.as_ref()?, sigma))).map(row).collect()
}
