//! From points and control to splines with start values: a lean camera is adjusted first.

use std::sync::Arc;

use calibench_adjust::{Interior, KnotPrior, Network, SplinedNetwork};
use calibench_model::camera::{Camera, CameraModel, ImageSize, Ray, Splined};
use calibench_model::{ControlRow, Points};

use super::grid::{Core, SplineGrid};
use crate::ended::ended;
use crate::{BoardShape, CalibrationError, DatumChoice, GrossErrors, LeftOut, Optics, Prepared, Settings, Shape, Survey, few, prepare};

/// Bound of Huber's weights of the lean camera's adjustment, in standard deviations.
const BOUND: f64 = 1.5;
/// Lean models that are tried for the start, one after the other.
const LEAN: [&str; 2] = ["opencv8", "opencv-fisheye"];

/// How splines are calibrated.
#[derive(Clone, Debug)]
pub struct SplinedSettings {
    /// As of other models, of one camera; its model and what is solved for are not looked at.
    pub settings: Settings,
    /// The grid.
    pub grid: SplineGrid,
    /// What is done with fx, fy, cx and cy.
    pub core: Core,
}

/// Splines with their start values.
#[derive(Clone, Debug)]
pub struct SplinedPrepared {
    /// How they were asked for.
    pub asked: SplinedSettings,
    /// Who measured what.
    pub survey: Arc<Survey>,
    /// The camera of another model that they start from, adjusted.
    pub lean: Camera,
    /// Where that came from, in words.
    pub origin: String,
    /// What is held of the shape of a planar testfield.
    pub shape: Shape,
    /// What is adjusted.
    pub splines: SplinedNetwork,
    /// Rows that take no part, with the reason.
    pub left_out: Vec<LeftOut>,
}

/// Joins points with control, adjusts a lean camera, and puts splines in its place: their core is that of the stereographic camera that is nearest to the images, or what the user says; their control points are zero.
///
/// # Errors
/// What [`prepare`] refuses; settings that splines do not go with; image points beyond the grid, by name.
pub fn prepare_splined(points: &Points, control: &[ControlRow], asked: &SplinedSettings) -> Result<SplinedPrepared, CalibrationError> {
    let settings = &asked.settings;
    let [optics] = &settings.cameras[..] else { return refuse("splines are adjusted of one camera: expected no --camera") };
    if settings.datum.is_minimal() || settings.shape == BoardShape::Free {
        return refuse("splines are adjusted before control that is fixed: expected --control, or photographs of a board");
    }
    if matches!(settings.gross, GrossErrors::Weighted(_) | GrossErrors::Rejected(_)) {
        return refuse("--huber and --snoop are not there for splines: expected --plain or neither");
    }
    let (prepared, lean, network) = lean(points, control, settings, optics)?;
    let image_coordinates = 2 * network.observations.len();
    let nearest = stereographic(&network, &lean);
    let core = std::array::from_fn(|i| asked.core.values[i].unwrap_or(nearest[i]));
    let camera = asked.grid.flat(optics.size, core);
    let prior = KnotPrior::of_mrcal(image_coordinates, camera.control.len());
    let splines = SplinedNetwork { network, camera, core: asked.core.free, prior };
    within_grid(&splines, asked)?;
    let Prepared { survey, origins, shape, left_out, .. } = prepared;
    let origin = origins.into_iter().next().unwrap_or_default();
    Ok(SplinedPrepared { asked: asked.clone(), survey, lean, origin, shape, splines, left_out })
}

fn refuse<T>(why: &str) -> Result<T, CalibrationError> {
    Err(CalibrationError::Splines(why.into()))
}

/// A lean camera, adjusted: what was prepared, the camera, and the network from its end.
fn lean(
    points: &Points,
    control: &[ControlRow],
    settings: &Settings,
    optics: &Optics,
) -> Result<(Prepared, Camera, Network), CalibrationError> {
    let gross = if settings.gross == GrossErrors::Kept { GrossErrors::Kept } else { GrossErrors::Weighted(BOUND) };
    let mut why = None;
    for model in LEAN {
        let optics = Optics { model: Some(model.to_owned()), solve: None, priors: Vec::new(), ..optics.clone() };
        let own = Settings { cameras: vec![optics], datum: DatumChoice::Fixed, gross, ..settings.clone() };
        let found = prepared_with_board(points, control, own).and_then(|prepared| {
            let (solution, ..) = prepared.solution()?;
            let (camera, mut network) = (solution.cameras()[0], ended(&solution));
            network.cameras = vec![Interior::fixed(network.cameras[0].name.clone(), camera)];
            drop(solution);
            Ok((prepared, camera, network))
        });
        match found {
            Ok(found) => return Ok(found),
            Err(error) => why = why.or(Some(error)),
        }
    }
    why.map_or_else(|| refuse("no lean camera"), Err)
}

/// A board may be bent: with a camera that does not picture the lens that cannot be tested, and three coefficients cost little.
fn prepared_with_board(points: &Points, control: &[ControlRow], settings: Settings) -> Result<Prepared, CalibrationError> {
    if settings.shape != BoardShape::Tested {
        return prepare(points.clone(), control, &settings);
    }
    match prepare(points.clone(), control, &Settings { shape: BoardShape::Bent, ..settings.clone() }) {
        Err(CalibrationError::NoBoard { .. }) => prepare(points.clone(), control, &Settings { shape: BoardShape::Flat, ..settings }),
        found => found,
    }
}

/// fx, fy, cx and cy of the stereographic camera that pictures what `lean` does, by least squares over the image points.
fn stereographic(network: &Network, lean: &Camera) -> [f64; 4] {
    let size = lean.size();
    let plain = Splined::flat(ImageSize { width: size.width, height: size.height }, [1.0, 1.0, 0.0, 0.0], 2, [3, 3], 90.0);
    let pair = |o: &calibench_adjust::ImageObservation| {
        let ray: Ray = network.images[o.image].pose.ray(&network.points[o.point].position);
        let u = plain.picture(ray).ok()?.distorted;
        let at = lean.project(ray).ok()?;
        Some([[u[0], at.x], [u[1], at.y]])
    };
    let pairs: Vec<[[f64; 2]; 2]> = network.observations.iter().filter_map(pair).collect();
    let line = |axis: usize| {
        let n = pairs.len().max(1) as f64;
        let mean = |k: usize| pairs.iter().map(|pair| pair[axis][k]).sum::<f64>() / n;
        let (u, at) = (mean(0), mean(1));
        let product = |k: usize| pairs.iter().map(|pair| (pair[axis][0] - u) * (pair[axis][k] - [u, at][k])).sum::<f64>();
        let slope = product(1) / product(0);
        [slope, at - slope * u]
    };
    let ([fx, cx], [fy, cy]) = (line(0), line(1));
    let usual = f64::from(size.width.max(size.height));
    let sane = |f: f64| if f.is_finite() && f > 0.0 { f } else { usual };
    let middle = |c: f64, side: u32| if c.is_finite() { c } else { 0.5 * f64::from(side - 1) };
    [sane(fx), sane(fy), middle(cx, size.width), middle(cy, size.height)]
}

/// Refuses image points beyond the grid, by name.
fn within_grid(splines: &SplinedNetwork, asked: &SplinedSettings) -> Result<(), CalibrationError> {
    let outside = splines.outside();
    if outside.is_empty() {
        return Ok(());
    }
    let names: Vec<String> = outside.iter().map(|(index, _)| splines.name_of(*index)).collect();
    let widest = outside.iter().map(|(_, fov)| *fov).fold(0.0, f64::max);
    let SplineGrid { columns, rows, fov_x_deg, order } = asked.grid;
    // A little more: the poses are those of a lean camera.
    let wider = (widest + 4.0).ceil();
    let advice = if wider < 340.0 {
        format!(
            "expected a horizontal field of view of {wider} degrees or more, as in --model splined:{columns}x{rows}:{wider}:{order}, or more rows"
        )
    } else {
        "are they rightly named?".to_owned()
    };
    Err(CalibrationError::Splines(format!(
        "{} of {} image points lie beyond the grid of splines of {fov_x_deg} degrees: {}; {advice}",
        outside.len(),
        splines.network.observations.len(),
        few(&names)
    )))
}
