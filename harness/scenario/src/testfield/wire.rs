//! The `[testfield]` tables as they are written.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;

use super::super::wire::{Grey, bounded};

bounded! {
    /// A length above zero, object units.
    Length(f64), f64 "f64", 1e-6, 1e6;
    /// A length, object units.
    Distance(f64), f64 "f64", 0.0, 1e6;
    /// A height over a plane, object units.
    Height(f64), f64 "f64", -1e6, 1e6;
    /// A coordinate in object space, object units.
    ObjectCoordinate(f64), f64 "f64", -1e9, 1e9;
    /// An angle, degrees.
    Degrees(f64), f64 "f64", -360.0, 360.0;
    /// A count.
    Count(usize), i64 "i64", 1, 1_000_000;
    /// A count that may be zero.
    CountOrNone(usize), i64 "i64", 0, 1_000_000;
    /// A difference of reflectances.
    Contrast(f64), f64 "f64", 0.0, 1.0;
    /// A fraction.
    Fraction(f64), f64 "f64", 0.0, 1.0;
}

/// `N` coordinates or lengths. (An array would take more numbers in silence.)
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Vec<ObjectCoordinate>")]
pub struct Tuple<const N: usize>(pub [f64; N]);

impl<const N: usize> TryFrom<Vec<ObjectCoordinate>> for Tuple<N> {
    type Error = String;

    fn try_from(numbers: Vec<ObjectCoordinate>) -> Result<Self, String> {
        let numbers: Vec<f64> = numbers.iter().map(|number| number.0).collect();
        numbers.try_into().map(Self).map_err(|numbers: Vec<f64>| format!("expected {N} numbers in brackets, found {}", numbers.len()))
    }
}

impl<const N: usize> JsonSchema for Tuple<N> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("Tuple{N}").into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "array", "minItems": N, "maxItems": N, "items": ObjectCoordinate::json_schema(generator) })
    }
}

/// A planar chessboard: its first inner corner, r1c1, is the origin; x to the right, y upwards, it faces +z.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChessboardWire {
    /// Rows of inner corners.
    pub rows: Count,
    /// Inner corners in a row.
    pub columns: Count,
    /// The side of a square, object units.
    pub square: Length,
    /// The width of blank paper around the squares, object units. Default: a square.
    pub margin: Option<Distance>,
    /// The height of the sheet's bend in its middle, object units. Default 0: flat.
    pub bend: Option<Height>,
    /// The direction across the crest of the bend, from x towards y, degrees. Default 0.
    pub bend_across: Option<Degrees>,
    /// Standard deviation per axis of each printed corner, object units; at most a fiftieth of a square. Default 0.
    pub print_noise: Option<Distance>,
    /// Reflectance of the paper. Default 0.85.
    pub paper: Option<Grey>,
    /// Reflectance of the ink. Default 0.05.
    pub ink: Option<Grey>,
    /// Radiance behind the board, fraction of full scale. Default 0.2.
    pub background: Option<Grey>,
}

/// The coded target field of Vosselman & Förstner; all defaults are the paper's.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CodedWire {
    /// Squares to a side, 1 to 8. Default 8.
    pub squares: Option<Count>,
    /// Squares to a side, around the middle, whose targets are measured. Default: half of `squares` where that is possible, else all.
    pub measured: Option<Count>,
    /// Distance of the lines, object units. Default 125 mm.
    pub spacing: Option<Length>,
    /// Width of the lines, object units. Default 2 mm.
    pub line: Option<Length>,
    /// Side of the sheet, object units. Default 1200 mm.
    pub sheet: Option<Length>,
    /// Sizes of the small squares, triangles, crosses and discs, object units. Default 9, 13, 15 and 13 mm.
    pub small: Option<Tuple<4>>,
    /// Sizes of the large ones. Default 17, 25, 25 and 24 mm.
    pub large: Option<Tuple<4>>,
    /// The height of the sheet's bend in its middle, object units. Default 0.8 mm.
    pub bend: Option<Height>,
    /// The direction across the crest of the bend, from x towards y, degrees. Default 0.
    pub bend_across: Option<Degrees>,
    /// Reflectance of the sheet. Default 0.85.
    pub paper: Option<Grey>,
    /// Reflectance of lines and targets. Default 0.05.
    pub ink: Option<Grey>,
    /// Radiance behind the sheet, fraction of full scale. Default 0.2.
    pub background: Option<Grey>,
}

/// A house whose twelve junctions are known, after Zhu, Wu & Wan, Fig. 5.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HouseWire {
    /// Width of the sheet, object units; its height is three quarters of it.
    pub width: Length,
    /// How many small squares make the texture. Default 400.
    pub specks: Option<CountOrNone>,
    /// Side of these squares, object units. Default: 0.0075 of the width.
    pub speck: Option<Length>,
    /// Their reflectance differs from their ground's by up to this, at most 0.2. Default 0.1.
    pub contrast: Option<Contrast>,
    /// Radiance behind the sheet, fraction of full scale. Default 0.5.
    pub background: Option<Grey>,
}

/// A wall of control points: sheets in space with targets.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WallWire {
    /// Standard deviation of the survey per axis, object units. Default 0.
    pub survey_sigma: Option<Distance>,
    /// Radiance behind the wall, fraction of full scale. Default 0.2.
    pub background: Option<Grey>,
}

/// A sheet of a wall.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlateWire {
    /// Its name.
    pub id: String,
    /// Its middle [x, y, z] at the time of the survey, object units.
    pub middle: Tuple<3>,
    /// The direction of its width [x, y, z], to the right for who looks at its front; any length.
    pub right: Tuple<3>,
    /// The direction of its height [x, y, z], upwards, at a right angle to `right`; any length.
    pub up: Tuple<3>,
    /// Its width, object units.
    pub width: Length,
    /// Its height, object units.
    pub height: Length,
    /// The height of its bend in its middle, object units. Default 0: flat.
    pub bend: Option<Height>,
    /// The direction across the crest of the bend, from `right` towards `up`, degrees. Default 0.
    pub bend_across: Option<Degrees>,
    /// How far it has moved since the survey [x, y, z], object units. Default 0.
    pub shift: Option<Tuple<3>>,
    /// Its reflectance. Default 0.85.
    pub paper: Option<Grey>,
    /// The reflectance of its targets. Default 0.05.
    pub ink: Option<Grey>,
}

/// Panels in rows and columns as the sheets of a wall, around the origin in the plane of x and y, facing +z.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PanelsWire {
    /// Rows.
    pub rows: Count,
    /// Columns.
    pub columns: Count,
    /// Width of a panel, object units.
    pub width: Length,
    /// Height of a panel, object units.
    pub height: Length,
    /// The gap between panels, object units; at least `width sin^2(tilt)`.
    pub gap: Distance,
    /// Depths are uniform from minus to plus this, object units. Default 0.
    pub relief: Option<Distance>,
    /// Tilts about both axes are uniform from minus to plus this, degrees, at most 60. Default 0.
    pub tilt: Option<Degrees>,
    /// Their reflectance. Default 0.85.
    pub paper: Option<Grey>,
    /// The reflectance of their targets. Default 0.05.
    pub ink: Option<Grey>,
}

/// A target at a given place of a wall.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WallTargetWire {
    /// Its name in records and tables.
    pub id: String,
    /// Its plate.
    pub plate: String,
    /// What it is: cross, chess_corner, disc, square, triangle or corner.
    #[schemars(with = "String")]
    pub kind: toml::Spanned<String>,
    /// Its reference point [u, v] from the plate's middle, object units.
    pub at: Tuple<2>,
    /// Its size, object units: a disc's diameter, the side of a square or triangle, of one of the two squares of a chess corner, or of a corner's edges; a bar's length.
    pub size: Length,
    /// How it is turned, from right towards up, degrees. Default 0.
    pub turn: Option<Degrees>,
    /// The angle of a corner, 30 to 150 degrees. Default 90.
    pub angle: Option<Degrees>,
    /// The width of a cross's bars as a fraction of their length, 0.05 to 0.5. Default a third, which is what `lsm` matches.
    pub bar: Option<Fraction>,
    /// Its surveyed position [x, y, z], object units. Default: the true one at the time of the survey with the survey's error.
    pub surveyed: Option<Tuple<3>>,
}

/// Targets strewn over every plate of a wall: on a grid (`rows`, `columns`) or at random (`count`, `distance`).
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FillWire {
    /// What they are, in turn: cross, chess_corner, disc, square, triangle or corner.
    #[schemars(with = "Vec<String>")]
    pub kinds: toml::Spanned<Vec<String>>,
    /// Their size, object units.
    pub size: Length,
    /// Rows of a grid.
    pub rows: Option<Count>,
    /// Columns of a grid.
    pub columns: Option<Count>,
    /// How many on each plate, at random.
    pub count: Option<Count>,
    /// The least distance of random targets, object units.
    pub distance: Option<Length>,
    /// How all are turned, degrees. Default: each at random.
    pub turn: Option<Degrees>,
    /// The angles of corners, 30 to 150 degrees, in turn. Default: 90 alone.
    pub angles: Option<Vec<Degrees>>,
    /// The width of crosses' bars as a fraction of their length, 0.05 to 0.5. Default a third, which is what `lsm` matches.
    pub bar: Option<Fraction>,
}
