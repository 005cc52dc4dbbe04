//! Conversions between camera conventions, without loss and without silence.
//!
//! [`convert`] gives the same camera in another convention: by formula where the models are the same up to units, by a fit over the frame, whose residuals
//! and region it reports, where they are not. [`naive()`] and [`Mistake`] are the conversions that go wrong, and [`difference()`] says what they cost.

mod brown;
mod closed_form;
mod covariance;
mod difference;
mod fit;
mod grid;
mod mistake;
mod naive;
mod rotation;
mod target;
#[cfg(test)]
mod tests;
mod tool;
mod wide_angle;

use nalgebra::DMatrix;
use thiserror::Error;

use crate::PixelPoint;
use crate::camera::{Camera, CameraModel, NoCounterpart};
use fit::{Problem, State};
use grid::{Sight, sights, spread};

pub use difference::{Compensated, Difference, DifferenceOptions, difference, difference_at, difference_of_rays};
pub use grid::{Region, Spread, Vector, cell_share};
pub use mistake::{Mistake, mistaken};
pub use naive::{Tangential, from_naive, naive};
pub use rotation::Rotation;
pub use target::Target;
pub use tool::Tool;

/// Largest residual that passes without a word, px.
pub const WARNING_PX: f64 = 0.01;
/// Largest residual that passes at all, px.
pub const ERROR_PX: f64 = 0.5;
/// Columns of the grid that a fit runs over. Twice as many change the RMS by less than 1 % and move the fitted camera by less than a tenth of its largest
/// residual.
pub const COLUMNS: usize = 41;

/// How to convert.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvertOptions {
    /// The part of the frame to fit over, and that the result holds for.
    pub region: Region,
    /// A fit may rotate the camera.
    pub rotation: bool,
    /// Largest residual that passes without a word, px.
    pub warning_px: f64,
    /// Largest residual that passes, px.
    pub error_px: f64,
    /// Take the result whatever its residuals.
    pub accept: bool,
    /// Columns of the grid; rows make it square.
    pub columns: usize,
    /// Covariance of the source's parameters, in their order and units.
    pub covariance: Option<DMatrix<f64>>,
}

impl Default for ConvertOptions {
    fn default() -> Self {
        Self {
            region: Region::Frame,
            rotation: false,
            warning_px: WARNING_PX,
            error_px: ERROR_PX,
            accept: false,
            columns: COLUMNS,
            covariance: None,
        }
    }
}

/// How a conversion was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// By formula: the same camera.
    Exact,
    /// By least squares over the region.
    Fitted,
}

/// What the thresholds say of a conversion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Below both.
    Good,
    /// Above that of warnings.
    Warning,
    /// Above that of errors, and accepted.
    Accepted,
}

/// A camera in another convention.
#[derive(Clone, Debug, PartialEq)]
pub struct Conversion {
    /// The camera.
    pub camera: Camera,
    /// How it was found.
    pub method: Method,
    /// Residuals in the image over the region, on a grid twice as dense as the fit's: where the camera pictures a ray, against where the source does.
    pub residual: Spread,
    /// The residuals, for plots; empty if exact.
    pub residuals: Vec<Vector>,
    /// What it holds for.
    pub region: Region,
    /// Rotation of the source's rays before the camera pictures them: R in `pixel = camera(R ray)`.
    pub rotation: Rotation,
    /// Covariance of the camera's parameters, in their order and units, if the source had one: `J Q J^T`, with J = d(camera) / d(source) by the formula or by
    /// the implicit function of the normal equations. A fit's own misfit is not in it.
    pub covariance: Option<DMatrix<f64>>,
    /// What the thresholds say.
    pub verdict: Verdict,
}

/// Why a camera cannot be converted or compared.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ConvertError {
    /// The source is not one to one over the region.
    #[error(
        "the camera folds over {radius_px:.1} px from its principal point: {:.2} % of the frame have no ray; restrict the region to a smaller radius",
        share * 100.0
    )]
    Fold {
        /// Smallest distance of the fold from the principal point, px.
        radius_px: f64,
        /// Share of the frame beyond it, 0 to 1.
        share: f64,
    },
    /// The target cannot picture rays of the source.
    #[error("the target cannot picture {:.2} % of the region", share * 100.0)]
    NotPictured {
        /// Share of the region, 0 to 1.
        share: f64,
    },
    /// The fit's residuals are too large.
    #[error(
        "the target differs by up to {max_px:.3} px (RMS {rms_px:.3} px) from the source, at ({:.0}, {:.0}); accept it to take it all the same", at.x, at.y
    )]
    Residual {
        /// RMS, px.
        rms_px: f64,
        /// Largest, px.
        max_px: f64,
        /// Where the largest is.
        at: PixelPoint,
    },
    /// The fit found no minimum.
    #[error("the fit does not converge")]
    NotConverged,
    /// The region holds fewer nodes of the grid than the fit has parameters for.
    #[error("the region holds {nodes} nodes of the grid, and {parameters} parameters need {} at least: choose a larger region", parameters.div_ceil(2))]
    TooFewNodes {
        /// Nodes of the grid within the region; each gives two equations.
        nodes: usize,
        /// Parameters of the fit.
        parameters: usize,
    },
    /// A parameter has no effect of its own.
    #[error("parameter `{parameter}` cannot be estimated: the others have the same effect")]
    NotEstimable {
        /// Its name.
        parameter: &'static str,
    },
    /// The target's shape makes no sense.
    #[error("no such target: {fault}")]
    Target {
        /// The fault.
        fault: &'static str,
    },
    /// The camera is not one of Table 2.
    #[error("the naive conversion holds for cameras of OpenCV, Agisoft and Pix4D with k1 to k3, p1, p2 only")]
    NotInTable,
    /// The covariance is not that of the source.
    #[error("the source has {expected} parameters, its covariance is {rows} x {columns}")]
    CovarianceShape {
        /// Parameters of the source.
        expected: usize,
        /// Rows given.
        rows: usize,
        /// Columns given.
        columns: usize,
    },
    /// A ray or pixel without counterpart.
    #[error(transparent)]
    NoCounterpart(#[from] NoCounterpart),
}

/// `source` in the convention of `target`.
///
/// Exact where the target holds all terms of the source: then the region is not looked at, and a fold goes along. Otherwise least squares over a regular grid of
/// pixels, with all parameters of the target's shape free, principal distance and point among them.
///
/// # Errors
/// A source that folds over inside the region, a target that cannot picture it, residuals above `error_px` unless accepted, a covariance of another
/// size, a parameter that the covariance asks for and the fit cannot estimate.
pub fn convert(source: &Camera, target: Target, options: &ConvertOptions) -> Result<Conversion, ConvertError> {
    target.check()?;
    if let Some(camera) = closed_form::exact(source, &target) {
        return exactly(source, camera, &target, options);
    }
    let mut starts = target.starts(source)?;
    starts.extend(naive::first_order(source, &target));
    let (mut conversion, state, over) = fitted(source, target, options, starts)?;
    if let Some(q) = &options.covariance {
        conversion.covariance = Some(covariance::propagate(&covariance::jacobian(&over.problem(options), &state, source)?, q)?);
    }
    Ok(conversion)
}

/// The camera of the target's convention that is closest to `source`, which need not be a [`Camera`], by least squares over the region.
///
/// # Errors
/// As [`convert`]; a covariance cannot be given.
pub fn fit(source: &dyn CameraModel, target: Target, options: &ConvertOptions) -> Result<Conversion, ConvertError> {
    target.check()?;
    Ok(fitted(source, target, options, target.starts(source)?)?.0)
}

/// What a fit ran over.
struct Over {
    sights: Vec<Sight>,
    free: Vec<usize>,
}

impl Over {
    fn problem(&self, options: &ConvertOptions) -> Problem<'_> {
        Problem { sights: &self.sights, free: &self.free, rotation: options.rotation }
    }
}

/// The fit from the best of `starts`, without covariance.
fn fitted(
    source: &dyn CameraModel,
    target: Target,
    options: &ConvertOptions,
    starts: Vec<Camera>,
) -> Result<(Conversion, State<Camera>, Over), ConvertError> {
    let free = target.free(&target.blank(source.size()));
    let over = Over { sights: sights(source, options.region, options.columns)?, free };
    let problem = over.problem(options);
    let (nodes, parameters) = (over.sights.len(), problem.unknowns());
    if 2 * nodes < parameters {
        return Err(ConvertError::TooFewNodes { nodes, parameters });
    }
    let state = problem.solve(cheapest(starts, &problem)?)?;
    let (residual, residuals) = check(source, &state, options)?;
    let verdict = judge(residual, options)?;
    let (camera, region, rotation) = (state.camera, options.region, state.rotation);
    let conversion = Conversion { camera, method: Method::Fitted, residual, residuals, region, rotation, covariance: None, verdict };
    Ok((conversion, state, over))
}

/// The camera without distortion that agrees with `source` on its axis and beside it, as OpenCV's; `None` if there is none.
pub fn without_distortion(source: &Camera) -> Option<Camera> {
    Target::OpenCv { coefficients: 4 }.plain(source).ok()
}

fn exactly(source: &Camera, camera: Camera, target: &Target, options: &ConvertOptions) -> Result<Conversion, ConvertError> {
    let propagate = |q: &DMatrix<f64>| {
        let jacobian =
            covariance::jacobian_of(|changed| closed_form::closed_form(changed, target), source).ok_or(ConvertError::NotConverged)?;
        covariance::propagate(&jacobian, q)
    };
    let covariance = options.covariance.as_ref().map(propagate).transpose()?;
    let residual = Spread { rms_px: 0.0, max_px: 0.0, at: PixelPoint::default() };
    let (rotation, verdict) = (Rotation::identity(), Verdict::Good);
    Ok(Conversion { camera, method: Method::Exact, residual, residuals: Vec::new(), region: Region::Frame, rotation, covariance, verdict })
}

/// The camera whose residuals are smallest; the first if none pictures all rays.
fn cheapest(cameras: Vec<Camera>, problem: &Problem) -> Result<State<Camera>, ConvertError> {
    let state = |camera| State { camera, rotation: Rotation::identity() };
    let cost = |state: &State<Camera>| problem.cost(state).unwrap_or(f64::INFINITY);
    let states = cameras.into_iter().map(state);
    states.min_by(|a, b| cost(a).total_cmp(&cost(b))).ok_or(ConvertError::NotConverged)
}

/// Residuals between the nodes of the fit as well.
fn check(source: &dyn CameraModel, state: &State<Camera>, options: &ConvertOptions) -> Result<(Spread, Vec<Vector>), ConvertError> {
    let dense: Vec<Sight> = sights(source, options.region, 2 * options.columns.max(3) - 1)?;
    let problem = Problem { sights: &dense, free: &[], rotation: false };
    let residuals = problem.residuals(state).ok_or(ConvertError::NotPictured { share: 0.0 })?;
    Ok((spread(&dense, &residuals), residuals))
}

fn judge(residual: Spread, options: &ConvertOptions) -> Result<Verdict, ConvertError> {
    let Spread { rms_px, max_px, at } = residual;
    match max_px {
        max if max <= options.warning_px => Ok(Verdict::Good),
        max if max <= options.error_px => Ok(Verdict::Warning),
        _ if options.accept => Ok(Verdict::Accepted),
        _ => Err(ConvertError::Residual { rms_px, max_px, at }),
    }
}
