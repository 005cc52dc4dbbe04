//! Cameras that are mounted rigidly to each other.
//!
//! An image's pose is mount x station: the station is where the rig stood, the mount where a camera sits on it. What an image says of its pose (the normal equations that
//! any image has) is said of both through the adjoint of the mount, so that stations are eliminated one by one, and interiors and mounts stay.

mod cofactors;
mod equations;
mod frames;
mod place;
mod quality;
mod reliability;
mod snooping;
mod solution;
mod undetermined;

#[cfg(test)]
mod tests;

use calibench_model::Pose;

use crate::AdjustError;
use crate::network::{Datum, Network, NetworkError, Status};
pub use frames::{adjoint, mounted, relative};
pub use quality::{Mount, RigCovariances};
pub use snooping::snoop_rig;
pub use solution::{RigSolution, adjust_rig};

/// Cameras that are mounted rigidly to each other, before control that is known.
#[derive(Clone, Debug, Default)]
pub struct Rig {
    /// Cameras, images, control points and image coordinates. Poses of its images are not used: [`Self::pose`] makes them.
    pub network: Network,
    /// Of each camera, start values: where it sits on the rig and how it is turned against it ("camera from rig"). That of [`Self::origin`] keeps its value.
    pub mounts: Vec<Pose>,
    /// Index of the camera whose mount is known, as a rule none at all: it defines the frame of the rig.
    pub origin: usize,
    /// Where the rig stood, start values ("rig from object"), with names for messages.
    pub stations: Vec<Station>,
    /// Of each image: index of its station.
    pub station_of: Vec<usize>,
}

/// A place where the rig stood: the images of one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Station {
    /// Its name in messages.
    pub name: String,
    /// Start values: the rig's frame in that of the object.
    pub pose: Pose,
}

impl Rig {
    /// The pose of an image at the start values.
    pub fn pose(&self, image: usize) -> Pose {
        mounted(&self.mounts[self.network.images[image].camera], &self.stations[self.station_of[image]].pose)
    }

    fn check(&self) -> Result<(), AdjustError> {
        let network = &self.network;
        network.check()?;
        let no_such = |of: &str, what, index, count| Err(NetworkError::NoSuch { of: of.to_owned(), what, index, count }.into());
        if self.mounts.len() != network.cameras.len() {
            return no_such("the rig", "mount", network.cameras.len(), self.mounts.len());
        }
        if self.origin >= network.cameras.len() {
            return no_such("the origin of the rig", "camera", self.origin, network.cameras.len());
        }
        if self.station_of.len() != network.images.len() {
            return no_such("the rig", "station of image", network.images.len(), self.station_of.len());
        }
        for (image, &station) in network.images.iter().zip(&self.station_of) {
            if station >= self.stations.len() {
                return no_such(&format!("image {}", image.name), "station", station, self.stations.len());
            }
        }
        let is_known = network.points.iter().all(|point| point.coordinates == [Status::Fixed; 3]);
        if !network.per_image.is_empty() {
            return Err(AdjustError::NotAvailable("the images of a rig have no numbers of their own"));
        }
        if !is_known || network.datum != Datum::Control || !network.surfaces.is_empty() {
            return Err(AdjustError::NotAvailable("a rig is adjusted before control points that are fixed"));
        }
        self.check_twice()
    }

    /// A camera has one image at a station.
    fn check_twice(&self) -> Result<(), AdjustError> {
        let mut seen = std::collections::BTreeMap::new();
        for (index, image) in self.network.images.iter().enumerate() {
            if let Some(other) = seen.insert((self.station_of[index], image.camera), index) {
                let of = format!("station {}", self.stations[self.station_of[index]].name);
                let (first, second) = (&self.network.images[other].name, &image.name);
                let camera = &self.network.cameras[image.camera].name;
                let why = format!("{of}: {first} and {second} are both of {camera}; expected one image of a camera at a station");
                return Err(NetworkError::Datum(why).into());
            }
        }
        Ok(())
    }
}
