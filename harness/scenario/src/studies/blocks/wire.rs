//! The `[blocks]` and `[[block]]` tables as they are written.

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use crate::studies::network::wire::{PrincipalDistance, Sigma};
use crate::testfield::wire::Distance as Length;
use crate::wire::bounded;

/// Lists of patterns.
type Lists = Spanned<Vec<Spanned<Vec<Spanned<String>>>>>;

bounded! {
    /// A number of points.
    Count(usize), i64 "i64", 6, 1_000_000;
}

/// Free networks of what each method measured: what all `[[block]]`s have in common. Object points are unknown; two horizontal and three vertical control
/// points hold the frame.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlocksWire {
    /// Principal distance, mm: it is held, with the principal point in the centre and no distortion but that of additional parameters.
    pub c: PrincipalDistance,
    /// A-priori standard deviation of an image coordinate, px.
    pub sigma_px: Sigma,
    /// Image points farther than this from where the resected image pictures their surveyed place are gross errors and left out, px. Default 1.
    pub gross_px: Option<Sigma>,
    /// Spacing b of the 3 x 3 grid on which Ebner's parameters are orthogonal, mm. Default: 0.4 of the frame's width.
    pub grid: Option<PrincipalDistance>,
    /// Whether the records keep the image points of every trial. Default: those of the first.
    pub keep_points: Option<bool>,
}

/// A free network.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlockWire {
    /// Its name in records and tables.
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// Its targets, by patterns of their names as in "*-large-disc-*". Default: all.
    #[schemars(with = "Option<Vec<String>>")]
    pub targets: Option<Spanned<Vec<Spanned<String>>>>,
    /// Its images, by patterns of stations' names as in "12*". Default: all.
    #[schemars(with = "Option<Vec<String>>")]
    pub images: Option<Spanned<Vec<Spanned<String>>>>,
    /// Several choices of images in place of one: a network for each of them.
    #[schemars(with = "Option<Vec<Vec<String>>>")]
    pub each: Option<Lists>,
    /// Ebner's parameters that are solved for, of e1 to e12. Default: none.
    #[schemars(with = "Option<Vec<String>>")]
    pub parameters: Option<Spanned<Vec<Spanned<String>>>>,
    /// Groups of images with parameters of their own. Default: one set for all.
    #[schemars(with = "Option<Vec<Vec<String>>>")]
    pub groups: Option<Lists>,
    /// An earlier block by whose parameters image coordinates are corrected.
    #[schemars(with = "Option<String>")]
    pub corrected_by: Option<Spanned<String>>,
    /// Every height is observed as that of the survey with this standard deviation, object units. Default: heights are free.
    pub height_sigma: Option<Length>,
    /// How many of an image's points are used, chosen at random in each trial. Default: all.
    pub points_per_image: Option<Count>,
    /// The bend of the object points is reported: their height in the middle over that at this distance from it along u, and along v, object units.
    pub bend_over: Option<Length>,
    /// Labels of the methods whose points are adjusted. Default: all.
    #[schemars(with = "Option<Vec<String>>")]
    pub methods: Option<Spanned<Vec<Spanned<String>>>>,
}

/// What residuals have in common in pairs of images.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ResidualsWire {
    /// The blocks whose residuals are compared, by name.
    #[schemars(with = "Vec<String>")]
    pub blocks: Spanned<Vec<Spanned<String>>>,
    /// Pairs of images by their names. Correlations within pairs stand beside those of the first of one with the second of another.
    #[schemars(with = "Vec<[String; 2]>")]
    pub pairs: Spanned<Vec<[Spanned<String>; 2]>>,
}
