//! Cameras that are mounted rigidly to each other: from their images of known points to where each sits, and whether they are one rig.

mod calibration;
mod doubts;
mod held;
mod leave_out;
mod one_rig;
mod pairing;
mod prepared;
mod start;

pub use calibration::{RigCalibration, RigCamera, calibrate_rig};
pub use doubts::{RigDoubt, RigSubject};
pub use held::Held;
pub use leave_out::{BySets, Scatter};
pub use one_rig::OneRig;
pub use pairing::{Moments, Pairing, Spread, TimedImage};
pub use prepared::{RigPrepared, RigSettings, prepare_rig};
