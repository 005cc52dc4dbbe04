//! The tables of boards as they are written.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use toml::Spanned;

use super::super::wire::{Count, CountOrNone, Degrees, Distance, Fraction, Height, Length, Tuple};
use crate::wire::Grey;

/// What all boards have.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SheetWire {
    /// The width of blank paper around what is printed, object units. Default: a square, a tag, or a spacing.
    pub margin: Option<Distance>,
    /// The height of the sheet's bend in its middle, object units. Default 0: flat.
    pub bend: Option<Height>,
    /// The direction across the crest of the bend, from x towards y, degrees. Default 0.
    pub bend_across: Option<Degrees>,
    /// Standard deviation per axis of each printed point, object units; at most a fiftieth of the smallest target. Default 0.
    pub print_noise: Option<Distance>,
    /// Reflectance of the paper. Default 0.85.
    pub paper: Option<Grey>,
    /// Reflectance of the ink; lighter than the paper for a board that is light on dark. Default 0.05.
    pub ink: Option<Grey>,
    /// Radiance behind the board, fraction of full scale. Default 0.2.
    pub background: Option<Grey>,
}

/// Any board, in the words of `--board`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoardWire {
    /// As in "charuco:8x5:30:21:DICT_4X4_50"; lengths in object units.
    #[schemars(with = "String")]
    pub board: Spanned<String>,
}

/// A chessboard whose light squares hold markers, counted in squares; its first inner corner, r1c1, is the origin; x to the right, y upwards.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CharucoWire {
    /// Squares in a row.
    pub columns: Count,
    /// Rows of squares.
    pub rows: Count,
    /// The side of a square, object units.
    pub square: Length,
    /// The side of a marker, object units.
    pub marker: Length,
    /// The dictionary by its name in OpenCV, as in "DICT_4X4_50".
    #[schemars(with = "String")]
    pub dictionary: Spanned<String>,
    /// The id of the first marker. Default 0.
    pub first: Option<CountOrNone>,
    /// As OpenCV made it before 4.6: with an even number of rows the square at the upper left is light. Default false.
    pub legacy: Option<bool>,
}

/// Kalibr's rows of AprilTags, the first at the lower left; the lower left corner of tag 0, t0c0, is the origin; x to the right, y upwards.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AprilGridWire {
    /// Tags in a row.
    pub columns: Count,
    /// Rows of tags.
    pub rows: Count,
    /// The side of a tag, object units.
    pub tag: Length,
    /// The gap between two tags, as a fraction of a tag's side. Default 0.3.
    pub spacing: Option<Length>,
    /// The dictionary by its name in OpenCV. Default "DICT_APRILTAG_36h11".
    #[schemars(with = "Option<String>")]
    pub dictionary: Option<Spanned<String>>,
    /// The id of the first tag. Default 0.
    pub first: Option<CountOrNone>,
    /// Cells of a tag's dark frame: 2, as Kalibr prints it, or 1. Default 2.
    pub border: Option<Count>,
    /// Whether small squares touch the tags' corners. Default true.
    pub squares: Option<bool>,
    /// How much is cut off the small squares' corners, as a fraction of their side, at most 0.4. Default 0.
    pub chamfer: Option<Fraction>,
}

/// OpenCV's GridBoard: rows of ArUco markers, the first at the upper left; its upper left corner, that of the first marker (t0c0), is the origin; x to the right, y upwards.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GridBoardWire {
    /// Markers in a row.
    pub columns: Count,
    /// Rows of markers.
    pub rows: Count,
    /// The side of a marker, object units.
    pub marker: Length,
    /// The gap between two markers, object units.
    pub separation: Length,
    /// The dictionary by its name in OpenCV, as in "DICT_6X6_250".
    #[schemars(with = "String")]
    pub dictionary: Spanned<String>,
    /// The id of the first marker. Default 0.
    pub first: Option<CountOrNone>,
    /// Cells of a marker's dark frame, 1 or 2. Default 1.
    pub border: Option<Count>,
}

/// Rows of discs or rings; the middle of the first at the upper left, r1c1, is the origin; x to the right, y upwards.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CirclesWire {
    /// Circles in a row.
    pub columns: Count,
    /// Rows of circles.
    pub rows: Count,
    /// The distance of rows, and of circles in a row (of an asymmetric grid half of it), object units.
    pub spacing: Length,
    /// The diameter, object units. Default: half of the spacing.
    pub diameter: Option<Length>,
    /// The diameter of what is left out in the middle of each, object units. Default: nothing.
    pub hole: Option<Length>,
    /// Whether every other row is moved by the spacing to the right. Default false.
    pub asymmetric: Option<bool>,
    /// Circles unlike the others, as in `["20@r10c1"]`: a disc of this diameter at that point; "20/10@r1c1,r1c5" rings, "gap@r4c4" no circle. Object units; at most 8 in all.
    #[schemars(with = "Option<Vec<String>>")]
    pub marks: Option<Spanned<Vec<String>>>,
}

/// Rows of ring codes; the middle of the first at the upper left is the origin; x to the right, y upwards.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RingsWire {
    /// Sectors of a ring: 12, 14, 16 or 20. Default 12.
    pub bits: Option<Count>,
    /// Codes in a row.
    pub columns: Count,
    /// Rows of codes.
    pub rows: Count,
    /// Distance of the middles of neighbouring codes, object units.
    pub spacing: Length,
    /// The diameter of the disc in the middle, object units.
    pub diameter: Length,
    /// Inner and outer diameter of the ring, in diameters of the disc. Default 2 and 3.
    pub ring: Option<Tuple<2>>,
    /// Whether the number of dark sectors is even. Default false.
    pub even: Option<bool>,
    /// The first id that is used. Default 1.
    pub first: Option<Count>,
}

/// A part of the PuzzleBoard's pattern, a chessboard with a dot on every side of a square, counted in inner corners; the first at the upper left, r1c1, is the origin; x to the right, y upwards.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PuzzleWire {
    /// Inner corners in a row, 6 to 501.
    pub columns: Count,
    /// Rows of inner corners, 6 to 501.
    pub rows: Count,
    /// The side of a square, object units.
    pub square: Length,
    /// Column and row of the first corner in the pattern of 501 x 501, from 0. Default [0, 0].
    pub place: Option<Place>,
    /// The diameter of a dot, as a share of the square's side, 0.2 to 0.4. Default 1/3, as published.
    pub dot: Option<Fraction>,
}

/// A chessboard with dots in three squares: one, the next to its right and the next below, counted in inner corners; the first at the upper left, r1c1, is the origin; x to the right, y upwards. The square at the upper left is dark.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DottedWire {
    /// Inner corners in a row, 4 to 100.
    pub columns: Count,
    /// Rows of inner corners, 4 to 100.
    pub rows: Count,
    /// The side of a square, object units.
    pub square: Length,
    /// Column and row of the square with the first dot, from 0 at the upper left. Default: the light square in the middle, or to the left of it.
    pub place: Option<Place>,
    /// The diameter of a dot, as a share of the square's side, 0.2 to 0.5. Default 0.34, as OpenCV draws it.
    pub dot: Option<Fraction>,
}

/// Two whole numbers from 0. (An array would take more numbers in silence.)
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Vec<CountOrNone>")]
pub struct Place(pub [usize; 2]);

impl TryFrom<Vec<CountOrNone>> for Place {
    type Error = String;

    fn try_from(counts: Vec<CountOrNone>) -> Result<Self, String> {
        let counts: Vec<usize> = counts.iter().map(|count| count.0).collect();
        counts.try_into().map(Self).map_err(|counts: Vec<usize>| format!("expected 2 numbers in brackets, found {}", counts.len()))
    }
}

impl JsonSchema for Place {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Place".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "array", "minItems": 2, "maxItems": 2, "items": CountOrNone::json_schema(generator) })
    }
}

/// Free-standing markers; their corners are t0c0, t0c1, ... clockwise from the upper left.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TagsWire {
    /// The dictionary by its name in OpenCV, as in "DICT_APRILTAG_36h11".
    #[schemars(with = "String")]
    pub dictionary: Spanned<String>,
    /// Cells of a marker's dark frame. Default 1.
    pub border: Option<Count>,
    /// The width of the light rim around a marker, as a fraction of its side. Default 0.25.
    pub rim: Option<Distance>,
    /// Reflectance of the paper. Default 0.85.
    pub paper: Option<Grey>,
    /// Reflectance of the ink. Default 0.05.
    pub ink: Option<Grey>,
    /// Radiance behind all, fraction of full scale. Default 0.2.
    pub background: Option<Grey>,
}

/// A marker.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TagWire {
    /// Its id in the dictionary.
    pub id: CountOrNone,
    /// Its middle [x, y, z], object units.
    pub middle: Tuple<3>,
    /// The direction of its upper edge [x, y, z], to the right for who reads it; any length.
    pub right: Tuple<3>,
    /// The direction of its left edge [x, y, z], upwards, at a right angle to `right`; any length.
    pub up: Tuple<3>,
    /// Its side, object units.
    pub side: Length,
}
