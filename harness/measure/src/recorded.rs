//! Positions that were measured before the run, by whatever means.

use calibench_model::{Image, Measurement, Rejection};

/// What is run: by this a method that was recorded tells whether it was recorded for it.
#[derive(Clone, Copy, Debug)]
pub struct RunId<'a> {
    /// The scenario.
    pub scenario: &'a str,
    /// The seed of its random numbers.
    pub seed: u64,
    /// Whether its images are photographs, which have names of their own.
    pub photographs: bool,
}

/// Which image of a run is meant; it says nothing of what is in it.
#[derive(Clone, Copy, Debug)]
pub struct ImageId<'a> {
    /// The trial, counted from 0.
    pub trial: u64,
    /// The view's name.
    pub view: &'a str,
}

/// The names that a run has.
#[derive(Clone, Debug, Default)]
pub struct Known<'a> {
    /// Its targets.
    pub targets: Vec<&'a str>,
    /// Its photographs; empty where images are rendered.
    pub photographs: Vec<&'a str>,
}

/// A method whose positions were measured before the run: it is asked by name.
pub trait Recorded: Send + Sync {
    /// Why nothing of it is of this run, if so.
    fn unfit(&self, run: &RunId<'_>) -> Option<String>;

    /// Whether all its names are among those of the run.
    ///
    /// # Errors
    /// The first one that is not, with its place and the nearest right one.
    fn check(&self, known: &Known<'_>) -> Result<(), String>;

    /// What was measured of the targets of these names in an image, in their order. The grey values tell whether it is the image that was measured, and nothing else.
    fn recall(&self, which: ImageId<'_>, image: &Image, targets: &[&str]) -> Vec<Result<Measurement, Rejection>>;
}
