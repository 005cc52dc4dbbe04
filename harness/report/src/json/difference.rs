//! How far two cameras differ, as JSON.

use calibench_model::camera::ImageSize;
use calibench_model::convert::{Compensated, Difference};
use schemars::JsonSchema;
use serde::Serialize;

use super::{Answer, Size, Sizes};

/// How far two cameras differ over the frame.
#[derive(Serialize, JsonSchema)]
pub struct DifferenceAnswer {
    /// The file of the first camera, as it was named.
    first: String,
    /// That of the second.
    second: String,
    /// Size of the images of both.
    size: Size,
    /// Angle of the best rotation, which was taken out, degrees; null where none was.
    rotation_deg: Option<f64>,
    /// How large the differences are, after the rotation.
    difference: Sizes,
    /// The part of the frame where points were measured; null where none were given.
    inside: Option<Part>,
    /// The rest of the frame.
    outside: Option<Part>,
    /// What remains after the best change of principal distance and point as well; null where the rotation was found at given points.
    compensated: Option<Remaining>,
    /// Share of the region that one of the cameras does not picture, 0 to 1.
    not_comparable: f64,
    /// What the differences are on an object; null without a distance.
    on_object: Option<OnObject>,
    /// Whether the differences are within a limit; null without one.
    limit: Option<Limit>,
}

#[derive(Serialize, JsonSchema)]
struct Limit {
    /// The limit of the root mean square over the frame, px.
    rms_px: f64,
    /// Whether it is kept. Where it is not the exit code is 1.
    is_kept: bool,
}

/// The differences in a part of the frame.
#[derive(Clone, Copy, Serialize, JsonSchema)]
pub struct Part {
    /// Root mean square of their lengths (2D), the mean over the area, px.
    pub rms_px: f64,
    /// The largest length, px.
    pub max_px: f64,
}

#[derive(Serialize, JsonSchema)]
struct Remaining {
    /// How large they are.
    difference: Sizes,
    /// Relative change of the second camera's principal distance, a number: 0 for none.
    scale: f64,
    /// Change of its principal point to the right, px.
    shift_x_px: f64,
    /// Downwards, px.
    shift_y_px: f64,
}

#[derive(Serialize, JsonSchema)]
struct OnObject {
    /// The distance, in the object's unit.
    distance: f64,
    /// Root mean square across the line of sight, in the unit of the distance.
    rms: f64,
    /// The largest.
    max: f64,
}

impl Answer for DifferenceAnswer {
    const COMMAND: &'static str = "diff";
    const SCHEMA: u32 = 1;
}

impl DifferenceAnswer {
    /// Of the cameras of two files with images of a size; with what is inside and outside of measured points, if there are any, and at a distance.
    pub fn new(
        [first, second]: [String; 2],
        size: ImageSize,
        found: &Difference,
        is_rotated: bool,
        parts: Option<[Option<Part>; 2]>,
        distance: Option<f64>,
    ) -> Self {
        let [inside, outside] = parts.unwrap_or_default();
        let remaining = |Compensated { spread, scale, shift: [dx, dy], .. }: &Compensated| Remaining {
            difference: spread.into(),
            scale: *scale,
            shift_x_px: *dx,
            shift_y_px: *dy,
        };
        let on_object = |distance| OnObject {
            distance,
            rms: found.on_object(found.spread.rms_px, distance),
            max: found.on_object(found.spread.max_px, distance),
        };
        Self {
            first,
            second,
            size: size.into(),
            rotation_deg: is_rotated.then(|| found.rotation.angle().to_degrees()),
            difference: (&found.spread).into(),
            inside,
            outside,
            compensated: found.compensated.as_ref().map(remaining),
            not_comparable: found.not_comparable,
            on_object: distance.map(on_object),
            limit: None,
        }
    }

    /// It, with a limit of the root mean square over the frame, px.
    #[must_use]
    pub fn with_limit(self, limit: Option<f64>, rms_px: f64) -> Self {
        Self { limit: limit.map(|limit| Limit { rms_px: limit, is_kept: rms_px <= limit }), ..self }
    }
}
