//! The `[printed]` table as it is written.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use crate::camera::{Coefficient, Distance, Pitch, Place};
use crate::testfield::wire::{Height, Length, ObjectCoordinate};
use crate::wire::{Side, bounded};

bounded! {
    /// A number of stations.
    Stations(usize), i64 "i64", 2, 1000;
    /// The error of a coordinate without its sign, object units.
    AbsoluteError(f64), f64 "f64", 0.0, 1e9;
    /// A power of the principal distance.
    Power(i32), i64 "i64", 0, 12;
    /// A number that a length is multiplied by.
    Factor(f64), f64 "f64", 1e-6, 1e6;
}

/// Figures that a paper printed, recomputed and tested against each other: pixel sizes, cameras and their conversions, errors of check points, and the
/// network of stations that the errors of some cameras determine.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PrintedWire {
    /// Width of the images, px.
    pub width: Side,
    /// Height of the images, px.
    pub height: Side,
    /// Pixel pitch through which mm of the sensor become px, um.
    pub pitch: Pitch,
    /// Distance of the object, object units: what a pixel is there.
    pub distance: Length,
    /// The unit of object coordinates and errors: `mm` or `m`.
    #[schemars(with = "String")]
    pub unit: Spanned<String>,
}

/// A length on the sensor over the pixels that it holds: a pixel pitch.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PixelWire {
    /// What it is called.
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// The length, mm.
    pub mm: Distance,
    /// What the length is multiplied by. Default 1.
    pub times: Option<Factor>,
    /// The number of pixels.
    pub pixels: Side,
}

/// A printed camera: a correction of measured coordinates.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CameraWire {
    /// The heading of its column.
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// The convention of the tool that it was converted from: `photoscan`, `pix4d`, `opencv` or `lens`. Default: it is no tool's.
    #[schemars(with = "Option<String>")]
    pub tool: Option<Spanned<String>>,
    /// Principal distance, mm.
    pub c: Distance,
    /// Principal point, x, mm to the right. Default 0.
    pub x0: Option<Place>,
    /// Principal point, y, mm upwards. Default 0.
    pub y0: Option<Place>,
    /// k1, k2, k3, mm^-2, mm^-4, mm^-6. Default 0.
    pub k: Option<[Coefficient; 3]>,
    /// p1, p2, mm^-1. Default 0.
    pub p: Option<[Coefficient; 2]>,
}

/// A camera through which a square grid is shown: what its distortion does to straight lines.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GridWire {
    /// What it shows, as in `barrel`.
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// The printed camera that it is, but for what is given.
    #[schemars(with = "String")]
    pub camera: Spanned<String>,
    /// Others k1, k2, k3.
    pub k: Option<[Coefficient; 3]>,
    /// Others p1, p2.
    pub p: Option<[Coefficient; 2]>,
}

/// A printed camera with something changed: what that costs in the image and on the object.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VariantWire {
    /// Its name in records.
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// The camera that is changed.
    #[schemars(with = "String")]
    pub camera: Spanned<String>,
    /// Another principal distance, mm.
    pub c: Option<Distance>,
    /// Another x0, mm.
    pub x0: Option<Place>,
    /// Another y0, mm.
    pub y0: Option<Place>,
    /// Others k1, k2, k3.
    pub k: Option<[Coefficient; 3]>,
    /// Others p1, p2.
    pub p: Option<[Coefficient; 2]>,
    /// Powers of c that the tool's coefficients are divided by, in place of 2, 4, 6.
    pub powers: Option<[Power; 3]>,
    /// Whether the network is fitted again with it. Default: it is applied in the network of the printed cameras.
    pub refit: Option<bool>,
    /// What is turned in sign between print and the true camera, where the network is fitted again: another reading. Default: as `[printed.network]` says.
    #[schemars(with = "Option<Vec<String>>")]
    pub turned_truth: Option<Vec<Spanned<String>>>,
    /// What is turned in sign in every column as it is applied, where the network is fitted again. Default: nothing.
    #[schemars(with = "Option<Vec<String>>")]
    pub turned_columns: Option<Vec<Spanned<String>>>,
}

/// A check point with the printed errors of every camera.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointWire {
    /// Its name.
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// X, Y, Z, object units.
    pub at: [ObjectCoordinate; 3],
    /// Absolute errors in X, Y, Z by camera, object units.
    #[schemars(with = "BTreeMap<String, [AbsoluteError; 3]>")]
    pub errors: Spanned<BTreeMap<Spanned<String>, [AbsoluteError; 3]>>,
}

/// The network that the printed errors of some cameras determine, when one camera is true and its exterior orientations are held.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NetworkWire {
    /// The true camera: the tool's own, ideal to distorted.
    #[schemars(with = "String")]
    pub truth: Spanned<String>,
    /// What is turned in sign between its column and the tool's own camera, of `x0`, `y0`, `p1` and `p2`. Default: nothing.
    #[schemars(with = "Option<Vec<String>>")]
    pub turned_truth: Option<Vec<Spanned<String>>>,
    /// How many stations.
    #[schemars(with = "u32")]
    pub stations: Spanned<Stations>,
    /// Direction from the points to the stations, object axes.
    #[schemars(with = "[f64; 3]")]
    pub from: Spanned<[Height; 3]>,
    /// Direction upwards, object axes.
    #[schemars(with = "[f64; 3]")]
    pub up: Spanned<[Height; 3]>,
    /// The cameras whose errors the network is fitted to.
    #[schemars(with = "Vec<String>")]
    pub fitted: Spanned<Vec<Spanned<String>>>,
    /// Distances that the fit starts from, object units.
    #[schemars(with = "Vec<f64>")]
    pub distances: Spanned<Vec<Length>>,
    /// Half lengths of the base that the fit starts from, object units.
    #[schemars(with = "Vec<f64>")]
    pub bases: Spanned<Vec<Length>>,
    /// Heights of the stations above the points' mean that the fit starts from, object units; they look at that mean. Default: 0 alone.
    #[schemars(with = "Option<Vec<f64>>")]
    pub heights: Option<Spanned<Vec<Height>>>,
    /// How far a predicted error may be from the printed one to count as near, object units.
    pub within: Length,
}
