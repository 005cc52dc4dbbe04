//! Why a run cannot be completed.

use calibench_images::PhotoError;
use calibench_measure::KindsGap;
use calibench_scenario::ImagingError;
use calibench_synth::local::LocalError;
use calibench_synth::optics::OpticsError;
use calibench_synth::sensor::SensorError;
use calibench_synth::stations::StationError;
use calibench_synth::view::ViewError;
use thiserror::Error;

/// A run that cannot be completed.
#[derive(Debug, Error)]
pub enum RunError {
    /// A photograph that is there and cannot be read, or an image that cannot be written.
    #[error(transparent)]
    Photo(#[from] PhotoError),
    /// Photographs and printed figures are not rendered.
    #[error("the scenario is of photographs or printed figures: there is nothing to render; expected one with [scene] or [testfield]")]
    NothingToRender,
    /// A station that the scenario does not have.
    #[error("no station is called `{name}`; expected one of {known}")]
    NoStation {
        /// What was asked for.
        name: String,
        /// The names that there are.
        known: String,
    },
    /// What was asked for cannot be, in words.
    #[error("{0}")]
    Asked(String),
    /// It was asked to end.
    #[error("stopped; older records are as they were")]
    Stopped,
    /// Methods that are limited to kinds of targets, and other targets.
    #[error(transparent)]
    Kinds(#[from] KindsGap),
    /// A recorded method with names that the run does not have.
    #[error("`{method}`: {problem}")]
    Recorded {
        /// The method.
        method: String,
        /// The name with its place.
        problem: String,
    },
    /// A view that cannot be pictured.
    #[error("station `{station}`: {source}")]
    View {
        /// From where.
        station: String,
        /// The reason.
        source: ViewError,
    },
    /// Stations of a trial that see too little.
    #[error(transparent)]
    Station(#[from] StationError),
    /// A local distortion that cannot be.
    #[error(transparent)]
    Local(#[from] LocalError),
    /// A lens that cannot be.
    #[error(transparent)]
    Optics(#[from] OpticsError),
    /// A lens or a sensor that cannot be at its station.
    #[error(transparent)]
    Imaging(#[from] ImagingError),
    /// An image that the sensor cannot write.
    #[error(transparent)]
    Sensor(#[from] SensorError),
    /// Results that cannot be written.
    #[error("{0}")]
    Output(#[from] std::io::Error),
}
