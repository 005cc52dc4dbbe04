//! `lsm`: least-squares matching with an artificial mask.

mod area;
mod bank;
mod beside;
mod border;
mod chosen;
mod curves;
mod fit;
mod mask;
mod planes;
mod profile;
mod start;
mod sweep;

use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start, TargetKind, stop};

use self::beside::Laid;
use self::fit::{Fitted, Limits, Work};
use self::mask::Mask;
use self::planes::Planes;
use self::profile::Profile;
use crate::operator::{Operator, window_centre};
use crate::parameter::{Domain, Parameter, Settings};
use crate::registry::{Build, Method};
use crate::residuals::misfit;

/// The largest standard deviation of a result, px: beyond, the window holds no such target.
const LARGEST: f64 = 1.0;
/// See [`misfit`]: of 702 corners of OpenCV's sample photographs none leaves as much, of 200 corners beside a bar all that are more than 0.25 px off do.
const MISFIT: f64 = 0.2;
/// A lens that moves nothing within the window by as much, px, maps it affinely.
const FLAT: f64 = 1e-3;

/// Least-squares matching of an artificial mask: an ideal shape (see [`TargetKind::outlines`]), mapped into the image by an affine
/// transformation, blurred there by a pixel and a Gaussian, with a grey value for the ground and a contrast: eight parameters, or nine with
/// the Gaussian's width.
///
/// The blur belongs to the image and does not follow the affine map. Coverage and derivatives are line integrals along the mask's border, exact to
/// 1e-6. A disc is left out the turn of its own plane, the edges of a corner their length. What is pictured comes from the start, or from `shape`;
/// the affine start from the start, or from `size` and the image, or from the image alone: the moments of the pixels beyond a
/// threshold, turned to where the residuals are smallest. If these pixels are all in the window, it moves onto their
/// grey-weighted centroid.
///
/// Where the start tells what the lens does to the picture beyond an affine map, as the points around it on a board do, the mask is warped so.
///
/// The position is that of the mask's reference point; a triangle's is its centroid. Covariance: `sigma0^2 N^-1`, with `sigma0^2` from the residuals.
///
/// Source: Vosselman & Förstner 1988, Sect. 3.4; Förstner 1982; blur as a parameter: Thurgood & Mikhail 1982.
pub struct Lsm {
    window: usize,
    shape: Option<TargetKind>,
    size: f64,
    sigma: f64,
    limits: Limits,
    /// What stands beside a target is left out.
    beside: bool,
    /// Masks of all kinds, in the order of [`TargetKind::ALL`].
    masks: Vec<Option<Mask>>,
    profile: Profile,
    misfit: f64,
}

/// The kinds of targets, in their order, after what the start says.
const SHAPES: &[&str] = &["start", "corner", "chess_corner", "junction", "cross", "disc", "square", "triangle"];

const PARAMETERS: &[Parameter] = &[
    Parameter::odd("window", "side of the window, px", [5, 47], 15.0).always_shown(),
    Parameter::named("shape", "what is pictured, or start: as the start says", SHAPES, 0),
    Parameter::real("size", "size of the target where the start gives no affine map, px; 0 to take it from the image", [0.0, 100.0], 0.0),
    Parameter::real("sigma", "standard deviation of the Gaussian blur, px; where it is sought, its start", [0.2, 4.0], 0.7),
    Parameter::named("sharpness", "whether the blur is held or sought, too", &["held", "sought"], 1),
    Parameter::named(
        "neighbours",
        "whether what stands beside a closed target is counted with the window or left out",
        &["counted", "left_out"],
        1,
    ),
    Parameter::whole("iterations", "most steps", [1, 100], 30.0),
    Parameter {
        name: "epsilon",
        about: "step of the position at which iteration ends, px",
        // Below it are the steps that single precision's rounding makes.
        domain: Domain::Real { min: 1e-6, max: 0.1 },
        default: 1e-3,
        always_shown: false,
    },
    misfit(MISFIT),
];

/// The method's entry.
pub fn method() -> Method {
    Method {
        name: "lsm",
        about: "least-squares matching with an artificial mask: six affine parameters, two of grey values, the blur if wanted",
        source: "Vosselman & Förstner 1988, Sect. 3.4; Thurgood & Mikhail 1982 (blur)",
        version: "2".into(),
        parameters: PARAMETERS,
        build: Build::With(|settings| Box::new(Lsm::new(settings))),
    }
}

impl Lsm {
    fn new(settings: &Settings) -> Self {
        let limits =
            Limits { iterations: settings.whole("iterations"), epsilon: settings.get("epsilon"), blur: settings.get("sharpness") > 0.0 };
        let sigma = settings.get("sigma");
        Self {
            window: settings.whole("window"),
            shape: settings.whole("shape").checked_sub(1).map(|index| TargetKind::ALL[index]),
            size: settings.get("size"),
            sigma,
            limits,
            beside: settings.whole("neighbours") > 0,
            masks: TargetKind::ALL.into_iter().map(Mask::new).collect(),
            profile: Profile::new(sigma),
            misfit: settings.get("misfit"),
        }
    }

    fn work(&self) -> Work {
        Work { planes: Planes::new(self.window), profile: self.profile.clone(), warp: None }
    }

    /// The mask for a start.
    fn mask(&self, start: &Start) -> Result<&Mask, Rejection> {
        let kind = self.shape.or(start.kind).ok_or(Rejection::UnknownKind)?;
        TargetKind::ALL.iter().zip(&self.masks).find(|(k, _)| **k == kind).and_then(|(_, mask)| mask.as_ref()).ok_or(Rejection::NoCorner)
    }

    fn measure_with(&self, work: &mut Work, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        let half = self.window as i64 / 2;
        work.warp = start.warp.filter(|warp| warp.farthest(half as f64) >= FLAT);
        let whole = self.beside && start.affine.is_some() && self.mask(start).is_ok_and(|mask| !mask.is_open());
        let first = start::centre(image, start, half, whole)?;
        let range = work.observe(image, first, half)?;
        let mask = self.mask(start)?;
        let corner = |(x, y): (i64, i64)| ((x - half) as f64, (y - half) as f64);
        let (left, top) = corner(first);
        let area = start::area(mask, work.planes.grey(), range, [start.position.x - left, start.position.y - top]);
        let position = area.map_or(start.position, |area| PixelPoint::new(left + area.centre[0], top + area.centre[1]));
        // The target may be whole in the first window and the second still reach past the image.
        let centre = window_centre(image, &Start::at(position), half).unwrap_or(first);
        if centre != first {
            work.observe(image, centre, half)?;
        }
        let (left, top) = corner(centre);
        let shapes = start::shapes(mask, start.affine, self.size, area.as_ref(), self.window as f64);
        let at = [position.x - left, position.y - top];
        let begin = start::best(work, mask, at, &shapes, self.sigma).ok_or(Rejection::NoCorner)?;
        let mut laid = Laid { image, centre, half };
        let fitted = if self.beside {
            beside::fit(work, mask, begin, (self.limits, self.misfit), &mut laid)?
        } else {
            work.fit(mask, begin, self.limits)?
        };
        let (left, top) = corner(laid.centre);
        if let Some(why) = vague(&fitted) {
            return Err(why);
        }
        if work.planes.structure(0.5 * fitted.parameters.contrast).is_no_noise(self.misfit) {
            return Err(Rejection::Misfit);
        }
        let [dx, dy] = fitted.parameters.pose.at;
        Ok(Measurement { position: PixelPoint::new(left + dx, top + dy), covariance: Some(fitted.covariance) })
    }
}

/// Why a position is not known well enough, if it is not.
fn vague(fitted: &Fitted) -> Option<Rejection> {
    let covariance = &fitted.covariance;
    if !(covariance.sxx + covariance.syy).is_finite() {
        return Some(Rejection::NotConverged);
    }
    (covariance.sxx.max(covariance.syy) > LARGEST * LARGEST).then_some(Rejection::ErrorEllipse)
}

impl Operator for Lsm {
    /// # Errors
    /// [`Rejection::Border`] when the window leaves the image; [`Rejection::NotFinite`]; [`Rejection::UnknownKind`] when neither the start nor `shape` says what is pictured; [`Rejection::NoCorner`] when the target has no one shape (a junction) or the window no
    /// contrast; [`Rejection::NotConverged`]; [`Rejection::LeftWindow`]; [`Rejection::ErrorEllipse`] when a coordinate's standard deviation exceeds 1 px; [`Rejection::Misfit`].
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        self.measure_with(&mut self.work(), image, start)
    }

    fn measure_all(&self, image: &Image, starts: &[Start]) -> Vec<Result<Measurement, Rejection>> {
        let mut work = self.work();
        let one = |start| {
            stop::point();
            self.measure_with(&mut work, image, start)
        };
        starts.iter().map(one).collect()
    }

    fn needs_kind(&self) -> bool {
        self.shape.is_none()
    }

    fn unknowns(&self) -> calibench_model::Unknowns {
        calibench_model::Unknowns { shape: true, levels: calibench_model::Levels::Two, blur: self.limits.blur, ..Default::default() }
    }
}

#[cfg(test)]
mod crowded;
#[cfg(test)]
mod tests;
