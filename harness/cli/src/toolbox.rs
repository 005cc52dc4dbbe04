//! What a build of calibench can do.

use calibench_measure::{BoardDetector, Registry};

/// What a build of calibench can do.
pub struct Toolbox {
    /// Its methods.
    pub registry: Registry,
    /// Its chessboard detector, if it has one.
    pub detector: Option<Box<dyn BoardDetector>>,
    /// Binds the threads that its libraries start by themselves to a number.
    pub bind_threads: fn(usize),
}
