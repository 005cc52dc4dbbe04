//! `[free_network]` with `[[distance]]`, and `[rig]` with `[[mount]]`: networks as photogrammetrists have them, each adjusted in every trial as `calibrate` adjusts it.

mod read;
#[cfg(test)]
mod tests;
pub mod wire;

use std::borrow::Cow;

use calibench_adjust::mounted;
use calibench_model::Pose;
use calibench_synth::stations::Station;

pub(crate) use read::{read_free, read_rig};

use super::plan::StudyPlan;
use crate::studies::acceptance::TestLines;

/// The name under which its figures stand in the records.
pub const SET: &str = "network";

/// Checked tables.
#[derive(Clone, Debug, PartialEq)]
pub struct Networks {
    /// The camera model that is calibrated.
    pub model: String,
    /// The standard deviation of an image coordinate that the adjustment is told, px.
    pub sigma_px: f64,
    /// Of each method, in the scenario's order, the standard deviation per axis of its image coordinates, px: they are drawn.
    pub drawn: Vec<(String, Option<f64>)>,
    /// What is adjusted.
    pub kind: Kind,
}

/// What is adjusted.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// One camera, and targets of which nothing is known.
    Free {
        /// Distances that are measured anew in each trial.
        distances: Vec<Bar>,
        /// Lengths between targets, by their places in the field, whose errors are looked at.
        lengths: Vec<[usize; 2]>,
        /// What its measuring must keep.
        acceptance: Option<TestLines>,
    },
    /// Cameras that are mounted rigidly to each other, before targets that are known.
    Rig(Vec<Mount>),
}

/// A distance that is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    /// The targets at its ends, by their places in the field.
    pub between: [usize; 2],
    /// Its standard deviation, object units.
    pub sigma: f64,
}

/// A camera on a rig.
#[derive(Clone, Debug, PartialEq)]
pub struct Mount {
    /// Its name.
    pub name: String,
    /// Where it sits, and how it is turned against the rig: "camera from rig".
    pub pose: Pose,
}

impl Mount {
    /// The name of its image at a station.
    pub fn image(&self, station: &str) -> String {
        format!("{}-{station}", self.name)
    }
}

impl Networks {
    /// The mounts of its rig; none of a free network.
    pub fn mounts(&self) -> &[Mount] {
        match &self.kind {
            Kind::Free { .. } => &[],
            Kind::Rig(mounts) => mounts,
        }
    }

    /// Where its cameras are when the rig stands at `stations`: those of each mount in turn; of a free network `stations` themselves.
    pub fn cameras_at<'s>(&self, stations: Cow<'s, [Station]>) -> Cow<'s, [Station]> {
        let mounts = self.mounts();
        if mounts.is_empty() {
            return stations;
        }
        let of = |mount: &Mount| {
            let at = |station: &Station| Station {
                name: mount.image(&station.name),
                pose: mounted(&mount.pose, &station.pose),
                ..station.clone()
            };
            stations.iter().map(at).collect::<Vec<_>>()
        };
        Cow::Owned(mounts.iter().flat_map(of).collect())
    }
}

impl StudyPlan for Networks {
    fn sets(&self) -> Vec<String> {
        vec![SET.to_owned()]
    }

    fn is_random(&self) -> bool {
        self.drawn.iter().any(|(_, sigma)| sigma.is_some_and(|sigma| sigma > 0.0))
    }

    fn runs_apart(&self) -> bool {
        true
    }

    fn drawn(&self) -> Option<&[(String, Option<f64>)]> {
        Some(&self.drawn)
    }
}
