//! What differs from image to image of a camera: which numbers, and how far they scatter.

use calibench_adjust::{Network, Options, PerImage, Solution, Variance, adjust, snoop};
use calibench_model::camera::{Camera, CameraModel};

use crate::ended::ITERATIONS;
use crate::{CalibrationError, GrossErrors, Settings};

/// Images of a camera from which the scatter of a number of their own is told, at least.
const LEAST: usize = 6;
/// Where its estimation starts: a thousandth of the principal distance.
const START: f64 = 1e-3;
/// Rounds of it at most, and the change that ends them.
const ROUNDS: usize = 50;
const SAME: f64 = 1e-3;
/// Of what images say of their own numbers, the share below which these are not seen at all.
const UNSEEN: f64 = 0.02;

/// How far a number of each image's own scatters, as the images say.
#[derive(Clone, Debug, PartialEq)]
pub struct Scatter {
    /// Index of the camera.
    pub camera: usize,
    /// The number.
    pub name: String,
    /// Its standard deviation over the images, in its unit; zero where it is not seen to differ.
    pub sigma: f64,
    /// Its unit.
    pub unit: &'static str,
}

/// The numbers that are asked for; those whose scatter is to be estimated with where that starts.
///
/// # Errors
/// A parameter that the model does not have or that is held, or one named twice; too few images to estimate a scatter from.
pub(crate) fn asked(settings: &Settings, network: &Network) -> Result<Vec<PerImage>, CalibrationError> {
    let mut found: Vec<PerImage> = Vec::new();
    for (camera, optics) in settings.cameras.iter().enumerate() {
        for own in &optics.per_image {
            let refused = |why: String| CalibrationError::PerImage { name: own.name.clone(), why };
            let (model, statuses) = (&network.cameras[camera].camera, &network.cameras[camera].parameters);
            let along = along(model, &own.name).ok_or_else(|| refused(no_such(model)))?;
            let parameters = model.parameters();
            if let Some((held, _)) = along.iter().find(|(parameter, _)| !statuses[*parameter].is_unknown()) {
                return Err(refused(format!(
                    "{} is held; expected one that is solved for, of which images have their own beside it",
                    parameters[*held].name
                )));
            }
            if found.iter().any(|other| other.camera == camera && other.along.iter().any(|(of, _)| along.iter().any(|(is, _)| of == is))) {
                return Err(refused("two numbers of an image's own change the same parameter; expected each once".into()));
            }
            let images = network.images.iter().filter(|image| image.camera == camera).count();
            let is_length = ["px", "mm"].contains(&parameters[along[0].0].unit);
            let sigma = match own.sigma {
                Some(sigma) => sigma,
                None if !is_length => {
                    return Err(refused(format!(
                        "its standard deviation is estimated of lengths alone, as c, x0 and y0; expected {}:SIGMA",
                        own.name
                    )));
                }
                None if images < LEAST => {
                    return Err(refused(format!(
                        "{images} images do not tell how far it scatters; expected {LEAST} or more, or {}:SIGMA",
                        own.name
                    )));
                }
                None => START * principal_distance(model),
            };
            found.push(PerImage { name: own.name.clone(), camera, along, sigma });
        }
    }
    Ok(found)
}

fn no_such(model: &Camera) -> String {
    let names: Vec<&str> = model.parameters().iter().map(|parameter| parameter.name).collect();
    format!("the model has no such parameter: expected c, x0, y0, or one of {}", names.join(", "))
}

/// In the unit of the model's lengths.
fn principal_distance(model: &Camera) -> f64 {
    along(model, "c").map_or(1.0, |along| model.parameters()[along[0].0].value.abs())
}

/// Parameters that a number changes, and by how much for each unit of it.
fn along(model: &Camera, name: &str) -> Option<Vec<(usize, f64)>> {
    let parameters = model.parameters();
    let place = |names: &[&str]| parameters.iter().position(|parameter| names.contains(&parameter.name));
    let exact = place(&[name]).map(|place| vec![(place, 1.0)]);
    exact.or_else(|| match name {
        "c" => match (place(&["f", "F"]), place(&["fx"]), place(&["fy"])) {
            (Some(f), ..) => Some(vec![(f, 1.0)]),
            (None, Some(fx), Some(fy)) => Some(vec![(fx, 1.0), (fy, parameters[fy].value / parameters[fx].value)]),
            (None, Some(fx), None) => Some(vec![(fx, 1.0)]),
            _ => None,
        },
        "x0" => place(&["cx"]).map(|place| vec![(place, 1.0)]),
        "y0" => place(&["cy"]).map(|place| vec![(place, 1.0)]),
        _ => None,
    })
}

/// Estimates the scatter of numbers for which none is given, as components of variance beside that of the image points.
///
/// # Errors
/// As of an adjustment.
///
/// Source: Förstner 1979; Kubik 1970.
pub(crate) fn estimate(network: &mut Network, settings: &Settings) -> Result<Vec<Scatter>, CalibrationError> {
    let given = settings.cameras.iter().flat_map(|optics| optics.per_image.iter().map(|own| own.sigma.is_some()));
    let wanted: Vec<usize> = given.enumerate().filter(|(_, given)| !given).map(|(place, _)| place).collect();
    if wanted.is_empty() {
        return Ok(Vec::new());
    }
    let mut options = Options { most_iterations: ITERATIONS, ..Options::default() };
    if let GrossErrors::Rejected(risk) = settings.gross {
        let (_, found) = snoop(network, &options, risk.snooping(network.observations.len(), settings.tested()))?;
        options.left_out = found.iter().filter(|found| found.left_out).map(|found| found.observation).collect();
    }
    let mut seen = vec![true; network.per_image.len()];
    let mut unit_weight = 1.0;
    for _ in 0..ROUNDS {
        let components = Components::of(&adjust(network, &options)?, network.per_image.len())?;
        unit_weight = components.image_points;
        let mut most = 0.0_f64;
        for &of in &wanted {
            if !seen[of] {
                continue;
            }
            let ratio = (components.own[of] / components.image_points).sqrt();
            seen[of] = components.share[of] > UNSEEN;
            network.per_image[of].sigma *= ratio;
            most = most.max((ratio - 1.0).abs());
        }
        if most < SAME {
            break;
        }
    }
    let scatter = |of: usize| {
        let own = &network.per_image[of];
        let unit = network.cameras[own.camera].camera.parameters()[own.along[0].0].unit;
        Scatter { camera: own.camera, name: own.name.clone(), sigma: if seen[of] { own.sigma * unit_weight.sqrt() } else { 0.0 }, unit }
    };
    Ok(wanted.into_iter().map(scatter).collect())
}

/// Variance factors of the image points and of each number of the images' own, and how much of these the image points say.
struct Components {
    image_points: f64,
    own: Vec<f64>,
    share: Vec<f64>,
}

impl Components {
    fn of(solution: &Solution<'_>, count: usize) -> Result<Self, CalibrationError> {
        let (mut squares, mut shares, mut images) = (vec![0.0; count], vec![0.0; count], vec![0_usize; count]);
        for number in solution.own_numbers(Variance::Apriori)? {
            squares[number.of] += (number.value / solution.network().per_image[number.of].sigma).powi(2);
            shares[number.of] += number.share;
            images[number.of] += 1;
        }
        let redundancy = solution.counts().redundancy() as f64 - shares.iter().sum::<f64>();
        let image_points = (solution.cost() - squares.iter().sum::<f64>()) / redundancy.max(f64::MIN_POSITIVE);
        let own = squares.iter().zip(&shares).map(|(square, share)| square / share.max(f64::MIN_POSITIVE)).collect();
        let share = shares.iter().zip(&images).map(|(share, images)| share / (*images).max(1) as f64).collect();
        Ok(Self { image_points, own, share })
    }
}
