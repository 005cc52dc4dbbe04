//! The images that a calibration can use.

use std::borrow::Cow;

use calibench_synth::stations::Station;

use super::{ImagePoint, Job, Observed};

/// The fewest points of an image that takes part: with fewer a pose is hardly determined.
const FEWEST: usize = 6;

/// What a method measured, without the images in which it measured too little.
pub struct Seen<'a> {
    /// The stations that are left.
    pub stations: Cow<'a, [Station]>,
    /// Image points of the method in them, and the survey.
    pub observed: Cow<'a, Observed>,
    /// How many images were left out.
    pub left_out: usize,
}

impl<'a> Seen<'a> {
    /// What `method` measured of what was `observed`.
    ///
    /// # Errors
    /// In words: no image is left.
    pub fn of(job: &Job<'a>, observed: &'a Observed, method: usize) -> Result<Self, String> {
        let count = |view: usize| observed.points.iter().filter(|point| point.method == method && point.view == view).count();
        let views: Vec<usize> = (0..job.stations.len()).filter(|&view| count(view) >= FEWEST).collect();
        if views.is_empty() {
            return Err(format!("no image has {FEWEST} points or more"));
        }
        let left_out = job.stations.len() - views.len();
        if left_out == 0 {
            return Ok(Self { stations: Cow::Borrowed(job.stations), observed: Cow::Borrowed(observed), left_out });
        }
        let stations = views.iter().map(|&view| job.stations[view].clone()).collect();
        let moved = |point: &ImagePoint| Some(ImagePoint { view: views.binary_search(&point.view).ok()?, ..*point });
        let points = observed.points.iter().filter(|point| point.method == method).filter_map(moved).collect();
        Ok(Self { stations, observed: Cow::Owned(Observed { points, control: observed.control.clone() }), left_out })
    }

    /// The job in these images.
    pub fn job<'j>(&'j self, job: &Job<'j>) -> Job<'j> {
        Job { stations: &self.stations, ..*job }
    }
}
