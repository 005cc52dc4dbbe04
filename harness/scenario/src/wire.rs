//! The tables of a scenario file as they are written. The docs of fields become the descriptions of the JSON Schema.

use std::borrow::Cow;

use calibench_model::camera::ImageSize;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use toml::Spanned;

/// A number or count with bounds, NaN excluded; the bounds are part of the error and of the schema.
macro_rules! bounded {
    ($($(#[$doc:meta])* $name:ident($inner:ty), $wire:ident $text:literal, $min:expr, $max:expr;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, serde::Deserialize)]
        #[serde(try_from = $text)]
        pub struct $name(pub $inner);

        impl TryFrom<$wire> for $name {
            type Error = String;

            fn try_from(value: $wire) -> Result<Self, String> {
                let (min, max): ($wire, $wire) = ($min, $max);
                let form = if $text == "i64" { "whole number" } else { "number" };
                if value >= min && value <= max {
                    Ok(Self(value as $inner))
                } else {
                    Err(format!("expected a {form} from {min} to {max}, found {value}"))
                }
            }
        }

        impl schemars::JsonSchema for $name {
            fn inline_schema() -> bool {
                true
            }

            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
                let form = if $text == "i64" { "integer" } else { "number" };
                let (min, max): ($wire, $wire) = ($min, $max);
                schemars::json_schema!({ "type": form, "minimum": min, "maximum": max })
            }
        }
    )*};
}
pub(super) use bounded;

bounded! {
    /// A grey value as a fraction of full scale.
    Grey(f64), f64 "f64", 0.0, 1.0;
    /// A standard deviation of grey values, fraction of full scale.
    GreyNoise(f64), f64 "f64", 0.0, 1.0;
    /// An image coordinate, px.
    Coordinate(f64), f64 "f64", -1e6, 1e6;
    /// A standard deviation of pointing, px.
    HandSigma(f64), f64 "f64", 0.0, 100.0;
    /// A standard deviation of a turn, degrees.
    MapTurn(f64), f64 "f64", 0.0, 30.0;
    /// A standard deviation of a length, as a part of it.
    MapStretch(f64), f64 "f64", 0.0, 0.5;
    /// Columns or rows.
    Side(usize), i64 "i64", 1, 1_000_000;
    /// How many trials.
    Trials(u64), i64 "i64", 1, 1_000_000;
    /// A seed.
    Seed(u64), i64 "i64", 0, i64::MAX;
}

/// A position [x, y], px. (An array of two would take more numbers in silence.)
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Vec<Coordinate>")]
pub struct Position(pub f64, pub f64);

impl TryFrom<Vec<Coordinate>> for Position {
    type Error = String;

    fn try_from(numbers: Vec<Coordinate>) -> Result<Self, String> {
        match numbers[..] {
            [x, y] => Ok(Self(x.0, y.0)),
            _ => Err(format!("expected two numbers [x, y], found {}", numbers.len())),
        }
    }
}

impl JsonSchema for Position {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Position".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "array", "minItems": 2, "maxItems": 2, "items": Coordinate::json_schema(generator) })
    }
}

/// Columns and rows of an image, px.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Vec<Side>")]
pub struct ImageSides(usize, usize);

impl ImageSides {
    /// As a camera has it.
    pub fn size(self) -> ImageSize {
        // Sides are bounded by a million.
        ImageSize { width: self.0 as u32, height: self.1 as u32 }
    }
}

impl TryFrom<Vec<Side>> for ImageSides {
    type Error = String;

    fn try_from(sides: Vec<Side>) -> Result<Self, String> {
        match sides[..] {
            [width, height] => Ok(Self(width.0, height.0)),
            _ => Err(format!("expected two numbers [columns, rows], found {}", sides.len())),
        }
    }
}

impl JsonSchema for ImageSides {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "ImageSides".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "array", "minItems": 2, "maxItems": 2, "items": Side::json_schema(generator) })
    }
}

/// A scenario: what is measured with which methods, and why.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Head {
    /// What this scenario is to show, in a sentence or two.
    #[schemars(with = "String")]
    pub why: Spanned<String>,
    /// Where it comes from: paper, figure, table, data set.
    #[schemars(with = "String")]
    pub source: Spanned<String>,
    /// Whether `check` leaves it to `check --nightly`, and says so: what is large only to be large, beside a smaller twin. Default false.
    pub nightly: Option<bool>,
    /// What is to be known when its figures are read: paragraphs of Markdown for its report.
    pub notes: Option<Vec<String>>,
    /// Seed of all random numbers, chosen before looking at results and never changed to pass.
    pub seed: Seed,
    /// Side of the window to which the Cramér-Rao bound of each target belongs, px, odd: no operator that sees no more can be better. Default 15.
    pub bound_window: Option<OddWindow>,
    /// The same of discs, which have to lie in their window as a whole. Default: `bound_window`.
    pub bound_window_discs: Option<OddWindow>,
    /// Number of trials; each has its own phase, noise and pointing. Default 1.
    #[schemars(with = "Option<Trials>")]
    pub trials: Option<Spanned<Trials>>,
}

/// Areas of constant grey on a uniform background, rendered exactly.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneWire {
    /// Columns of the image.
    #[schemars(with = "Side")]
    pub width: Spanned<Side>,
    /// Rows of the image.
    #[schemars(with = "Side")]
    pub height: Spanned<Side>,
    /// Grey value between the polygons, fraction of full scale.
    pub background: Grey,
    /// `area` (default): a pixel is the exact mean over its area. `centre`: it has the grey value at its centre, as drawing programs make it.
    pub pixels: Option<Pixels>,
    /// Quantisation: 8, 12 or 16 bits. Default: none.
    pub bits: Option<Bits>,
    /// Standard deviation of the white Gaussian grey-value noise, fraction of full scale. Default 0.
    pub grey_noise: Option<GreyNoise>,
    /// `fixed` (default), or `uniform`: each trial moves the whole scene by a random part of a pixel.
    pub phase: Option<Phase>,
}

/// Bits of a grey value.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "i64")]
pub struct Bits(pub u32);

impl TryFrom<i64> for Bits {
    type Error = String;

    fn try_from(bits: i64) -> Result<Self, String> {
        match bits {
            8 | 12 | 16 => Ok(Self(bits as u32)),
            _ => Err(format!("expected 8, 12 or 16 bits, found {bits}")),
        }
    }
}

impl JsonSchema for Bits {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Bits".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "enum": [8, 12, 16] })
    }
}

/// An odd side of a window, px.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "i64")]
pub struct OddWindow(pub usize);

impl TryFrom<i64> for OddWindow {
    type Error = String;

    fn try_from(side: i64) -> Result<Self, String> {
        if (3..=201).contains(&side) && side % 2 == 1 {
            Ok(Self(side as usize))
        } else {
            Err(format!("expected an odd number from 3 to 201, found {side}"))
        }
    }
}

impl JsonSchema for OddWindow {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "OddWindow".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "integer", "minimum": 3, "maximum": 201, "not": { "multipleOf": 2 } })
    }
}

/// How the scene becomes pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Pixels {
    /// The exact mean over the pixel's area.
    #[default]
    Area,
    /// The grey value at the pixel's centre.
    Centre,
}

/// Where the scene lies on the pixel grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Phase {
    /// As given.
    #[default]
    Fixed,
    /// Moved in each trial by a uniform random part of a pixel, per axis from -0.5 to 0.5 px.
    Uniform,
}

/// A hand that points at targets.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(inline)]
pub struct PointingWire {
    /// Standard deviation of the hand per axis, px.
    pub sigma: HandSigma,
    /// Whether the pointer stops at whole pixels.
    pub whole_pixels: bool,
    /// Methods that start from a target's shape get its affine map, turned in the image by a random angle of this standard deviation, degrees. Default 5, or 0
    /// where `sigma` is 0.
    pub map_turn: Option<MapTurn>,
    /// And with both axes longer or shorter by a random part of this standard deviation. Default 0.1, or 0 where `sigma` is 0.
    pub map_stretch: Option<MapStretch>,
    /// Whether targets are pointed at too of which a part is hidden or outside the image, as long as their reference point is in view. Default false.
    pub clipped: Option<bool>,
}

/// An area of constant grey.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PolygonWire {
    /// Its name.
    #[schemars(with = "String")]
    pub id: Spanned<String>,
    /// Its grey value, fraction of full scale.
    pub grey: Grey,
    /// Its vertices [x, y], px; pixel centres are whole numbers, y points down. At least three, not crossing itself or another polygon.
    #[schemars(with = "Vec<Position>")]
    pub vertices: Spanned<Vec<Position>>,
}

/// A point to be measured.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TargetWire {
    /// Its name in records and tables.
    #[schemars(with = "String")]
    pub id: Spanned<String>,
    /// What it is: corner or chess_corner (a vertex of a polygon), junction, cross, disc, square or triangle.
    #[schemars(with = "String")]
    pub kind: Spanned<String>,
    /// Its true position [x, y], px.
    #[schemars(with = "Position")]
    pub at: Spanned<Position>,
    /// Where measuring starts [x, y], px. Only without `[scene.pointing]`.
    #[schemars(with = "Option<Position>")]
    pub start: Option<Spanned<Position>>,
}

/// Photographs of a chessboard that somebody took: without truth.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PhotographsWire {
    /// Folder of the photographs, below the data folder (`CALIBENCH_DATA`, `../shared/data` beside the checkout without it) or absolute. If it is absent the scenario is `unavailable`.
    #[schemars(with = "String")]
    pub folder: Spanned<String>,
    /// File names, in the order of the report.
    #[schemars(with = "Vec<String>")]
    pub files: Spanned<Vec<String>>,
    /// The chessboard's inner corners, as in `9x6`.
    #[schemars(with = "String")]
    pub board: Spanned<String>,
}
