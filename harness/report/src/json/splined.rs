//! A calibrated camera of splines as JSON.

use calibench_adjust::SplinedPlace;
use calibench_calibrate::splined::SplinedCalibration;
use calibench_model::camera::CameraModel;
use schemars::JsonSchema;
use serde::Serialize;

use super::{Answer, Size};

/// A camera of mrcal's splined stereographic model. Pixels count from the centre of the first, y down.
#[derive(Serialize, JsonSchema)]
pub struct SplinedAnswer {
    /// Why the result is in doubt, and the exit code 3; empty where no doubt was found.
    doubts: Vec<String>,
    /// The same doubts for programs.
    doubted: Vec<SplinedDoubted>,
    /// Images that take part.
    images: usize,
    /// Image points of them, those left out included.
    image_points: usize,
    /// Image points that were left out as gross errors.
    rejected: Vec<SplinedRejected>,
    /// Unknowns of the adjustment.
    unknowns: usize,
    /// Image coordinates less the unknowns that they determine; the prior determines the others, so that it need not be whole.
    redundancy: f64,
    /// Iterations.
    iterations: usize,
    /// A-priori standard deviation of an image coordinate, px.
    sigma_px: f64,
    /// Estimated over a-priori standard deviation of unit weight, a number; null without redundancy.
    sigma0: Option<f64>,
    /// Weighted sum of squared residuals of image points, a number.
    cost: f64,
    /// The same of the prior, a number.
    cost_of_prior: f64,
    /// Root mean square of the residuals in use (2D), px.
    rms_px: f64,
    /// What is known of control points beforehand.
    prior: PriorAnswer,
    /// The bend of the board along u, along v and its twist, object units; null where none was adjusted.
    board: Option<[f64; 3]>,
    /// The camera.
    camera: SplinedCamera,
    /// The standard deviation (2D) of the image of a point far away, RMS over the frame, px; null where a part of the frame has no ray.
    over_frame_px: Option<f64>,
    /// The same where image points hold the splines; null where none do.
    over_held_px: Option<f64>,
    /// The share of the frame that has no image point in its cell of the splines, 0 to 1: the uncertainty there is the prior's.
    share_unheld: f64,
    /// How well the camera is known over the frame, row by row; places without a ray are missing.
    uncertainty: Vec<UncertainPlace>,
}

impl Answer for SplinedAnswer {
    const COMMAND: &'static str = "calibrate-splined";
    const SCHEMA: u32 = 1;
}

#[derive(Serialize, JsonSchema)]
struct SplinedDoubted {
    /// `over-frame`, `fold`, `grid` or `gross-errors`.
    subject: &'static str,
    /// In words.
    words: String,
}

#[derive(Serialize, JsonSchema)]
struct SplinedRejected {
    /// The image.
    image: String,
    /// The target.
    target: String,
    /// Its residual in standard deviations as all residuals show them, a number.
    w: f64,
}

/// Standard deviations of a control point's offset from zero, numbers.
#[derive(Serialize, JsonSchema)]
struct PriorAnswer {
    /// Along the direction from the middle of the grid.
    sigma_along: f64,
    /// Across it.
    sigma_across: f64,
}

#[derive(Serialize, JsonSchema)]
struct SplinedCamera {
    /// Size of its images.
    size: Size,
    /// fx, fy, cx, cy, px.
    core: [f64; 4],
    /// Their standard deviations, px; null of what was held.
    core_sigmas: [Option<f64>; 4],
    /// Order of the splines.
    order: usize,
    /// Columns of control points.
    columns: usize,
    /// Rows of control points.
    rows: usize,
    /// Horizontal field of view that the grid spans, degrees.
    fov_x_deg: f64,
    /// Control points (x, y), numbers, row by row from the top.
    control: Vec<[f64; 2]>,
    /// Their standard deviations.
    control_sigmas: Vec<[f64; 2]>,
}

#[derive(Serialize, JsonSchema)]
struct UncertainPlace {
    /// Column, px.
    x: f64,
    /// Row, px.
    y: f64,
    /// Covariance (xx, xy, yy), px^2.
    covariance: [f64; 3],
    /// Whether an image point lies in its cell of the splines.
    held: bool,
}

impl SplinedAnswer {
    /// Of calibrated splines, with doubts that were had before.
    pub fn new(found: &SplinedCalibration<'_>, before: &[String]) -> Self {
        let (prepared, solution) = (found.prepared, &found.solution);
        let (network, camera) = (&prepared.splines.network, solution.camera());
        let rejected = found.found.iter().map(|one| {
            let o = &network.observations[one.observation];
            SplinedRejected { image: network.images[o.image].name.clone(), target: network.points[o.point].name.clone(), w: one.w }
        });
        let place = |place: &SplinedPlace| {
            let c = place.covariance;
            UncertainPlace { x: place.at.x, y: place.at.y, covariance: [c.sxx, c.sxy, c.syy], held: place.is_held }
        };
        let (sigmas, free) = (found.quality.core_sigmas(), prepared.splines.core);
        let over_frame = found.over_frame_px();
        Self {
            doubts: before.iter().cloned().chain(found.doubts.iter().map(|doubt| doubt.words.clone())).collect(),
            doubted: found
                .doubts
                .iter()
                .map(|doubt| SplinedDoubted { subject: doubt.subject.name(), words: doubt.words.clone() })
                .collect(),
            images: network.images.len(),
            image_points: network.observations.len(),
            rejected: rejected.collect(),
            unknowns: solution.counts().unknowns,
            redundancy: found.quality.fit.redundancy,
            iterations: solution.iterations(),
            sigma_px: prepared.asked.settings.sigma(),
            sigma0: found.quality.fit.sigma0,
            cost: solution.cost() - solution.prior_cost(),
            cost_of_prior: solution.prior_cost(),
            rms_px: found.rms_px(),
            prior: PriorAnswer { sigma_along: 1.0 / prepared.splines.prior.along, sigma_across: 1.0 / prepared.splines.prior.across },
            board: solution.surfaces().first().copied(),
            camera: SplinedCamera {
                size: camera.size().into(),
                core: camera.core,
                core_sigmas: std::array::from_fn(|i| free[i].then_some(sigmas[i])),
                order: camera.order,
                columns: camera.columns,
                rows: camera.rows,
                fov_x_deg: camera.fov_x_deg,
                control: camera.control.clone(),
                control_sigmas: found.quality.control_sigmas(),
            },
            over_frame_px: over_frame.is_finite().then_some(over_frame),
            over_held_px: found.over_held_px(),
            share_unheld: found.share_unheld(),
            uncertainty: found.over_frame.iter().map(place).collect(),
        }
    }
}
