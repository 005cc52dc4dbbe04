//! `ellipse_edges`: an ellipse through points of a disc's edge.

pub mod conic;
mod profile;

use calibench_model::{Covariance, Image, Measurement, PixelPoint, Rejection, Start};

use crate::ellipse::{Ellipse, Guess, seek};
use crate::operator::Operator;
use crate::registry::{Build, Method};
use profile::{common, profiles};

/// So often the profiles are laid anew around the ellipse; the last time its centre must not move by more than this, px.
const LAYINGS: usize = 4;
const STILL: f64 = 0.1;
const VAGUE: f64 = 1.0;

/// Ellipse through edge points: profiles across the outline, four a pixel, the edge in each to a fraction of a pixel, the ellipse through these points.
///
/// Grey values are interpolated bilinearly from 4 px inside (less in small discs) to 4 px outside. An edge blurred by a Gaussian is fitted to the mean of all profiles, and
/// then shifted along each. The first ellipse is the direct one of least algebraic distance, the last that of least orthogonal distances. The start is the
/// area nearest to the given position that stands out from its ground. The result is the centre of the *ellipse*, as with `parametric_circle`.
/// The covariance (px^2) is that of the distances, of which one a pixel is taken as independent:
/// on sharp edges (blur 0.3 px) with little noise (0.5 % of the contrast) the interpolation leaves an error of some thousandths of a pixel that it does not show.
///
/// Source: Fitzgibbon, Pilu & Fisher 1999 (direct fit); the profiles are our own.
pub struct EllipseEdges;

/// The method's entry.
pub fn method() -> Method {
    Method {
        name: "ellipse_edges",
        about: "ellipse through the points where profiles across a disc's outline meet its edge",
        source: "calibench; Fitzgibbon, Pilu & Fisher 1999",
        version: "1".into(),
        parameters: &[],
        build: Build::With(|_| Box::new(EllipseEdges)),
    }
}

impl Operator for EllipseEdges {
    /// # Errors
    /// [`Rejection::Border`], [`Rejection::NotFinite`], [`Rejection::NoCorner`] when nothing stands out near the start or its edge is no ellipse,
    /// [`Rejection::NotConverged`], [`Rejection::ErrorEllipse`] when the standard deviation is above a pixel.
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        let Guess { mut ellipse, .. } = seek(image, start)?;
        for laying in 0.. {
            let profiles = profiles(image, &ellipse).ok_or(Rejection::Border)?;
            let edge = common(&profiles).ok_or(Rejection::NoCorner)?;
            let points: Vec<_> = profiles.iter().filter_map(|profile| profile.crossing(&edge)).collect();
            let rough = if laying == 0 { conic::direct(&points).ok_or(Rejection::NoCorner)? } else { ellipse };
            let fit = conic::orthogonal(&points, rough).ok_or(Rejection::NotConverged)?;
            if laying + 1 == LAYINGS {
                return if distance(&fit.ellipse, &ellipse) <= STILL { measurement(&fit) } else { Err(Rejection::NotConverged) };
            }
            ellipse = fit.ellipse;
        }
        Err(Rejection::NotConverged)
    }

    fn unknowns(&self) -> calibench_model::Unknowns {
        calibench_model::Unknowns { shape: true, levels: true, blur: true, ..Default::default() }
    }
}

fn distance(a: &Ellipse, b: &Ellipse) -> f64 {
    (a.position[0] - b.position[0]).hypot(a.position[1] - b.position[1])
}

fn measurement(fit: &conic::Fit) -> Result<Measurement, Rejection> {
    // Of the profiles only one a pixel is independent of the others.
    let q = fit.cofactors * (fit.variance * profile::DENSELY);
    let covariance = Covariance { sxx: q[(0, 0)], sxy: q[(0, 1)], syy: q[(1, 1)] };
    // Written so that NaN is rejected, too.
    if covariance.sxx + covariance.syy <= VAGUE * VAGUE {
        let [x, y] = fit.ellipse.position;
        Ok(Measurement { position: PixelPoint::new(x, y), covariance: Some(covariance) })
    } else {
        Err(Rejection::ErrorEllipse)
    }
}

#[cfg(test)]
mod tests {
    use crate::parametric_circle::tests::{operator, pools};

    #[test]
    fn errors_are_within_a_third_of_the_bound() {
        let [bound, own] = pools("ellipse_edges", 54);
        let (_, interval) = bound.ratio();
        assert!(bound.trials() >= 2500 && interval[0] <= 1.35 && interval[1] >= 1.0, "{interval:?}");
        // Sharp edges at little noise are where interpolation, not noise, says how far off the points are.
        let (ratio, _) = own.ratio();
        assert!((0.8..1.6).contains(&ratio), "{ratio}");
    }

    #[test]
    fn conforms() {
        crate::conformance::check_on(&*operator("ellipse_edges"), crate::conformance::disc, 1e-4);
    }
}
