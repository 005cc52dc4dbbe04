//! What a build of calibench can do.

use calibench_calibrate::BoardSolver;
use calibench_measure::{BoardDetector, Registry};
use calibench_run::Tools;

/// What a build of calibench can do.
#[derive(Default)]
pub struct Toolbox {
    /// Its methods.
    pub registry: Registry,
    /// OpenCV's detector of chessboards, if it has it.
    pub detector: Option<Box<dyn BoardDetector>>,
    /// OpenCV's calibration from a board, if it has it.
    pub solver: Option<Box<dyn BoardSolver>>,
    /// Binds the threads that its libraries start by themselves to a number, if any do.
    pub bind_threads: Option<fn(usize)>,
    /// A digest of the code of all that it has beside calibench's own methods, if there is one: without it that of the whole program stands for it.
    pub code: Option<&'static str>,
}

impl Toolbox {
    /// What it has beside its methods; calibrators are the project's ([`crate::Project::tools`]).
    pub fn tools(&self) -> Tools<'_> {
        Tools { detector: self.detector.as_deref(), solver: self.solver.as_deref(), calibrators: &[] }
    }
}
