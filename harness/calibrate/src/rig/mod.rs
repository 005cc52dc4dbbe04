//! Cameras that are mounted rigidly to each other: from their images of known points to where each sits, and whether they are one rig.

mod calibration;
mod doubted;
mod doubts;
mod held;
mod leave_out;
mod one_rig;
mod pairing;
mod prepared;
mod start;
mod still;
mod whole;

pub use calibration::{RigCalibration, RigCamera};
pub use doubted::{RigDoubt, RigSubject};
pub use held::Held;
pub use leave_out::{BySets, Scatter, motion};
pub use one_rig::OneRig;
pub use pairing::{Moments, Pairing, Spread, TimedImage};
pub use prepared::{RigPrepared, RigSettings, prepare_rig};
pub use still::{Known, Stand, Still, still_stands};
pub use whole::calibrate_rig;
