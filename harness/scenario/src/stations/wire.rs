//! The `[stations]` and `[[station]]` tables as they are written.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::optics::Pixels;
use super::super::sensor::{Exposure, Gradient, Numbers};
use super::super::testfield::wire::{Count, Degrees, Fraction, Height, Length, Tuple};
use super::super::wire::{Position, bounded};

bounded! {
    /// Stray light, fraction of full scale.
    Veil(f64), f64 "f64", -0.5, 1.0;
}

/// Stations on a ring around the field's normal.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ConvergentWire {
    /// How many places.
    pub count: Count,
    /// Angle of the lines of sight from the field's normal, degrees, 0 to 85: opposite stations converge at twice this.
    pub angle: Degrees,
    /// Where the ring begins, from the field's right towards its upper side, degrees. Default 0.
    pub start: Option<Degrees>,
    /// Distances from the field's middle, object units, taken in turn.
    pub distances: Vec<Length>,
    /// Rolls (kappa), degrees; at every place one image for each. Default: 0 alone.
    pub rolls: Option<Vec<Degrees>>,
}

/// Stations on an arc before the field, from left to right.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArcWire {
    /// How many places.
    pub count: Count,
    /// Angle between the lines of sight of the first and the last, degrees, 0 to 170.
    pub convergence: Degrees,
    /// Distances from the field's middle, before heights, object units, taken in turn.
    pub distances: Vec<Length>,
    /// Heights over the field's middle, object units, taken in turn. Default: 0 alone.
    pub heights: Option<Vec<Height>>,
    /// Rolls (kappa), degrees; at every place one image for each. Default: 0 alone.
    pub rolls: Option<Vec<Degrees>>,
}

/// Views of a board: every tilt at every distance with every roll.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoardWire {
    /// Tilts [about the board's u axis, then about the upright v axis], degrees, each within 85.
    pub tilts: Vec<Tuple<2>>,
    /// Distances from the board's middle, object units.
    pub distances: Vec<Length>,
    /// Rolls (kappa), degrees. Default: 0 alone.
    pub rolls: Option<Vec<Degrees>>,
}

/// Stations at random within bounds.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RandomWire {
    /// The number of stations.
    pub count: Count,
    /// The least and the greatest distance from what is looked at, object units.
    pub distance: Tuple<2>,
    /// The greatest angle of the line of sight from the field's normal, degrees, 0 to 85.
    pub tilt: Degrees,
    /// Rolls are uniform from minus to plus this, degrees, 0 to 180. Default 0.
    pub roll: Option<Degrees>,
    /// The cameras look at a point this far from the field's middle at most [to the sides, up or down], object units. Default [0, 0].
    pub aside: Option<Tuple<2>>,
}

/// A field on a stand: turned in its own plane, tilted with the stand before the camera, and the camera rolled. Every tilt with every turn and roll.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StandWire {
    /// Tilts phi of the stand about its upright axis, degrees, each within 85; at 0 the field is pictured with the first turn only. At most 9.
    pub phis: Vec<Degrees>,
    /// Turns of the field in its own plane, degrees, positive anticlockwise for the camera. At most 9. Default: 0 alone.
    pub turns: Option<Vec<Degrees>>,
    /// Rolls (kappa) of the camera, degrees. At most 9. Default: 0 alone.
    pub rolls: Option<Vec<Degrees>>,
    /// Distance from the field's middle, object units.
    pub distance: Length,
    /// Height of the stand's bend in the field's middle over that at `bend_reach`, object units: it stays on the stand when the field is turned. Default 0.
    pub bend: Option<Height>,
    /// With `bend`: how far from the middle it is meant, object units; beyond, the field goes on falling.
    pub bend_reach: Option<Length>,
    /// With `bend`: the direction across its crest, from the stand's right upwards, degrees. Default 0.
    pub bend_across: Option<Degrees>,
}

/// A station.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StationWire {
    /// Its name in records and tables.
    #[schemars(with = "String")]
    pub name: toml::Spanned<String>,
    /// Projection centre [x, y, z], object units.
    pub at: Tuple<3>,
    /// omega, phi, kappa, degrees: `M = M_kappa M_phi M_omega`, passive. Or give `towards`.
    pub angles: Option<Tuple<3>>,
    /// The object point that the axis meets [x, y, z], object units.
    pub towards: Option<Tuple<3>>,
    /// With `towards`: the object direction that is upwards in the image. Default: that of the field.
    pub up: Option<Tuple<3>>,
    /// With `towards`: the roll (kappa) that follows, degrees; positive turns the picture clockwise. Default 0.
    pub roll: Option<Degrees>,
    /// Standard deviation of the Gaussian blur of its image, px: in place of `blur` of `[optics]`; `corner_blur` keeps its ratio to it.
    pub blur: Option<Pixels>,
    /// A straight motion during its exposure [dx, dy], px: in place of `motion` of `[optics]`.
    pub motion: Option<Position>,
    /// Factor of the light in its image, beside `exposure` of `[sensor]`. Default 1.
    pub exposure: Option<Exposure>,
    /// Stray light in its image, alike everywhere, added after exposure and before noise, fraction of full scale; negative for a black level that a camera takes away. -0.5 to 1. Default 0.
    pub veil: Option<Veil>,
    /// Illumination gradient [x, y] of its image: change of the light across the whole frame, in place of that of `[sensor]`; it leaves `veil` alone.
    pub gradient_across: Option<Numbers<Gradient, 2>>,
}

/// What `[stations]` has beside the keys of its kind.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CommonWire {
    /// The fraction of the targets that every station must see. Default: one target; with random stations all.
    pub sees: Option<Fraction>,
    /// true: random stations are drawn anew in each trial. Default: the same in all.
    pub each_trial: Option<bool>,
    /// What the stations look at [x, y, z], object units. Default: the middle of the targets.
    pub middle: Option<Tuple<3>>,
    /// The direction from the field towards the cameras [x, y, z]. Default: the mean of the plates' normals.
    pub facing: Option<Tuple<3>>,
    /// The field's upwards direction [x, y, z]. Default: that of the first plate.
    pub up: Option<Tuple<3>>,
}
