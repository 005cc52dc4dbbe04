//! The `[printed]` table: figures of a paper as data.

mod read;
#[cfg(test)]
mod tests;
pub mod wire;

use calibench_model::camera::Photogrammetric;
use calibench_model::convert::{Target, Tool};
use nalgebra::{Point3, Vector3};

pub(crate) use read::read;

use super::plan::StudyPlan;
use crate::Unit;

/// The label of what stands in the place of a method.
pub const PRINT: &str = "print";
/// The set under which figures of the sensor stand in the records.
pub const SENSOR: &str = "sensor";
/// The set under which the network stands in the records.
pub const NETWORK: &str = "network";

/// A checked `[printed]` table.
#[derive(Clone, Debug)]
pub struct Printed {
    /// Distance of the object, object units.
    pub distance: f64,
    /// The unit of object coordinates and errors.
    pub unit: Unit,
    /// Pixel pitches by name, um.
    pub pitches: Vec<(String, f64)>,
    /// The cameras, in the order of their columns.
    pub cameras: Vec<Column>,
    /// Cameras through which a square grid is shown.
    pub grids: Vec<Grid>,
    /// The check points.
    pub points: Vec<CheckPoint>,
    /// The network that is fitted, if one is.
    pub network: Option<NetworkPlan>,
    /// Changed cameras.
    pub variants: Vec<Variant>,
}

/// A printed camera.
#[derive(Clone, Debug)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// As printed: a correction of measured coordinates.
    pub camera: Photogrammetric,
    /// The tool whose convention it was converted from, if it is a tool's.
    pub tool: Option<Tool>,
}

impl Column {
    /// The convention that it was converted from, if it is a tool's.
    pub fn target(&self) -> Option<Target> {
        Some(self.tool?.target(self.camera.size, self.camera.pitch_um))
    }
}

/// A camera through which a square grid is shown.
#[derive(Clone, Debug)]
pub struct Grid {
    /// What it shows.
    pub name: String,
    /// A correction of measured coordinates.
    pub camera: Photogrammetric,
}

/// A check point.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckPoint {
    /// Its name.
    pub name: String,
    /// Where it is, object units.
    pub at: Point3<f64>,
    /// Absolute errors in X, Y, Z by camera, object units.
    pub errors: Vec<[f64; 3]>,
}

/// What a network is fitted to, and from where.
#[derive(Clone, Debug, PartialEq)]
pub struct NetworkPlan {
    /// The place of the true camera.
    pub truth: usize,
    /// What is turned in sign between its column and the tool's own camera.
    pub turned_truth: Turned,
    /// How many stations: two at least.
    pub stations: usize,
    /// Unit vector from the points to the stations, object axes.
    pub from: Vector3<f64>,
    /// Unit vector upwards, at a right angle to [`Self::from`], object axes.
    pub up: Vector3<f64>,
    /// The places of the cameras whose errors it is fitted to.
    pub fitted: Vec<usize>,
    /// Distances to start from, object units.
    pub distances: Vec<f64>,
    /// Half lengths of the base to start from, object units.
    pub bases: Vec<f64>,
    /// Heights to start from, object units.
    pub heights: Vec<f64>,
    /// How far a predicted error may be from the printed one to count as near, object units.
    pub within: f64,
}

/// A printed camera with something changed.
#[derive(Clone, Debug)]
pub struct Variant {
    /// Its name.
    pub name: String,
    /// The place of the camera that is changed.
    pub of: usize,
    /// What is made of it.
    pub camera: Photogrammetric,
    /// Whether the network is fitted again with it.
    pub refit: bool,
    /// What is turned in sign between the true camera's column and the tool's own, if it is not what the network's plan says.
    pub turned_truth: Option<Turned>,
    /// What is turned in sign in every column as it is applied.
    pub turned_columns: Turned,
}

/// Which parameters of a camera are turned in sign.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Turned {
    /// x0.
    pub x0: bool,
    /// y0.
    pub y0: bool,
    /// p1 and p2.
    pub p: [bool; 2],
}

impl Turned {
    /// Their names in files.
    pub const NAMES: [&'static str; 4] = ["x0", "y0", "p1", "p2"];

    /// What is turned in `camera`.
    pub fn of(self, camera: &Photogrammetric) -> Photogrammetric {
        let sign = |value: f64, turned: bool| if turned { -value } else { value };
        let p = [0, 1].map(|i| sign(camera.p[i], self.p[i]));
        Photogrammetric { x0: sign(camera.x0, self.x0), y0: sign(camera.y0, self.y0), p, ..*camera }
    }
}

impl StudyPlan for Printed {
    /// [`SENSOR`], the cameras, [`NETWORK`], the variants.
    fn sets(&self) -> Vec<String> {
        let cameras = self.cameras.iter().map(|column| column.name.clone());
        let variants = self.variants.iter().map(|variant| variant.name.clone());
        std::iter::once(SENSOR.to_owned()).chain(cameras).chain([NETWORK.to_owned()]).chain(variants).collect()
    }

    fn own_methods(&self) -> Option<Vec<String>> {
        Some(vec![PRINT.to_owned()])
    }
}
