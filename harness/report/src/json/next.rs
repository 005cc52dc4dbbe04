//! What to photograph next, as JSON.

use calibench_calibrate::{Next, Photograph};
use calibench_exchange::station_numbers;
use schemars::JsonSchema;
use serde::Serialize;

/// What further photographs would do to the standard deviation of the image of a point far away, RMS over the frame after the best rotation.
#[derive(Serialize, JsonSchema)]
pub(super) struct NextAnswer {
    /// As it is, px.
    now_px: f64,
    /// With one more photograph like those so far, px.
    usual_px: f64,
    /// All control must be in view, as in the photographs so far.
    whole: bool,
    /// Those that lower it most, each taken after the ones before.
    photographs: Vec<Proposed>,
}

#[derive(Serialize, JsonSchema)]
struct Proposed {
    /// X0, Y0, Z0: where the camera would stand, object units.
    centre: [f64; 3],
    /// omega, phi, kappa, degrees.
    angles_deg: [f64; 3],
    /// Where the middle of the control would be in the frame: x, y, px.
    middle_px: [f64; 2],
    /// Distance of that middle along the camera's axis, object units.
    distance: f64,
    /// Of the control's plane to the image plane, degrees.
    tilt_deg: f64,
    /// The direction of the image in which the control is nearer, degrees from its right to its top; null without a tilt.
    nearer_deg: Option<f64>,
    /// Control points in view.
    points: usize,
    /// The standard deviation then, px.
    then_px: f64,
}

impl NextAnswer {
    pub(super) fn new(next: &Next) -> Self {
        let photographs = next.photographs.iter().map(proposed).collect();
        Self { now_px: next.before, usual_px: next.usual, whole: next.whole, photographs }
    }
}

fn proposed(one: &Photograph) -> Proposed {
    let [x, y, z, omega, phi, kappa] = station_numbers(&one.pose);
    Proposed {
        centre: [x, y, z],
        angles_deg: [omega, phi, kappa],
        middle_px: [one.middle.x, one.middle.y],
        distance: one.depth,
        tilt_deg: one.tilt.to_degrees(),
        nearer_deg: one.nearer.map(f64::to_degrees),
        points: one.points.len(),
        then_px: one.uncertainty,
    }
}
