//! `harris_paraboloid`, `harris_linear`: the maximum of the Harris strength, refined by a paraboloid or by the weights of its neighbours.

use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start};

use crate::harris::{Harris, Strengths, smooth};
use crate::operator::{Operator, window_centre};
use crate::paraboloid::Weights;
use crate::parameter::{Parameter, Settings};
use crate::registry::{Build, Method};

/// Harris paraboloid: the strongest pixel of the window, refined by the maximum of a paraboloid through its 3 x 3 strengths.
///
/// With a derivation Gaussian the strength is the scale-adapted one of Eq. 2.
///
/// The window of odd side, px, is centred on the pixel nearest to the start: it is where the strongest pixel is sought. The paper detects on
/// the whole image; an approximation says which of its detections is meant. The strength looks `3 sigma + 1` px past it, and one more for the fit.
///
/// Source: Zhu et al. 2007, Eq. 1, 4, 9 to 13.
pub struct HarrisParaboloid {
    half: usize,
    refinement: Refinement,
    harris: Harris,
    /// Standard deviation of the derivation Gaussian, px; 0: Sobel gradients of the image as it is.
    derivation: f64,
}

/// From the 3 x 3 strengths around the strongest pixel to a position.
enum Refinement {
    /// The maximum of a paraboloid.
    Paraboloid(Weights),
    /// The linear fit that the paraboloid improves on: along each axis the mean of the three positions, weighted by the strengths (negative ones count
    /// as zero). The paper says no more of it than that the four connected neighbours are weighted by their strengths.
    ///
    /// Source: Malik et al. 2002, as described in Zhu et al. 2007.
    Linear,
}

impl Refinement {
    fn apply(&self, f: &[[f64; 3]; 3]) -> Option<(f64, f64)> {
        match self {
            Self::Paraboloid(weights) => weights.fit(f).maximum(),
            Self::Linear => {
                let axis = |before: f64, behind: f64| {
                    let (before, behind) = (before.max(0.0), behind.max(0.0));
                    (behind - before) / (before + f[1][1] + behind)
                };
                Some((axis(f[1][0], f[1][2]), axis(f[0][1], f[2][1])))
            }
        }
    }
}

const WINDOW: Parameter =
    Parameter::odd("window", "side of the window in which the strongest pixel is sought, px", [3, 31], 11.0).always_shown();
const K: Parameter = Parameter::real("k", "scale of the weights exp(-d^2/k^2) of the fit, px", [1e-3, 1e3], 0.2);
const SIGMA: Parameter = Parameter::real("sigma", "standard deviation of the integration Gaussian, px", [0.1, 10.0], 1.0);
const ALPHA: Parameter = Parameter::real("alpha", "weight of the squared trace in the strength", [0.0, 0.24], 0.04);

const DERIVATION: Parameter =
    Parameter::real("derivation", "standard deviation of the derivation Gaussian, px; 0: Sobel gradients", [0.0, 5.0], 0.0);

/// The method's entry.
pub fn method() -> Method {
    Method {
        name: "harris_paraboloid",
        about: "maximum of the Harris strength in the window, refined by a paraboloid through its 3x3 strengths",
        source: "Zhu et al. 2007, Eq. 1, 4, 9 to 13",
        version: "1".into(),
        parameters: const { &[WINDOW, K, SIGMA, ALPHA, DERIVATION] },
        build: Build::With(|settings| Box::new(HarrisParaboloid::of(settings))),
    }
}

/// The entry of the linear fit.
pub fn linear() -> Method {
    Method {
        name: "harris_linear",
        about: "maximum of the Harris strength in the window, refined by the strengths of its four neighbours",
        source: "Malik et al. 2002, as described in Zhu et al. 2007",
        version: "1".into(),
        parameters: const { &[WINDOW, SIGMA, ALPHA, DERIVATION] },
        build: Build::With(|settings| Box::new(HarrisParaboloid::new(settings, Refinement::Linear))),
    }
}

/// A pixel, and the 3 x 3 strengths around it.
type Peak = ((i64, i64), [[f64; 3]; 3]);

impl HarrisParaboloid {
    fn new(settings: &Settings, refinement: Refinement) -> Self {
        let [alpha, sigma, derivation] = ["alpha", "sigma", "derivation"].map(|key| settings.get(key));
        let harris = if derivation > 0.0 { Harris::scale_adapted(alpha, derivation, sigma) } else { Harris::new(alpha, sigma) };
        Self { half: settings.whole("window") / 2, refinement, harris, derivation }
    }

    /// As a method of this name with `settings` has it.
    pub fn of(settings: &Settings) -> Self {
        Self::new(settings, Refinement::Paraboloid(Weights::new(settings.get("k"))))
    }

    /// The pixel (column, row) from which the paraboloid is fitted: the strongest one of the window around `start`.
    ///
    /// # Errors
    /// As [`Operator::measure`] has them.
    pub fn strongest_pixel(&self, image: &Image, start: &Start) -> Result<(i64, i64), Rejection> {
        self.peak(image, start).map(|(pixel, _)| pixel)
    }

    /// The strongest pixel and the 3 x 3 strengths around it.
    fn peak(&self, image: &Image, start: &Start) -> Result<Peak, Rejection> {
        let ring = self.half + 1;
        let (x, y) = window_centre(image, start, (ring + self.harris.reach() + self.smoothing()) as i64)?;
        let strengths = self.strengths_around(image, (x, y), ring)?;
        let (column, row) = strongest(&strengths, start.position, (x, y))?;
        let whole = |index: usize, centre: i64| centre + index as i64 - ring as i64;
        Ok(((whole(column, x), whole(row, y)), strengths.around(column, row)))
    }

    /// How far from a pixel grey values have a part in the strengths of its 3 x 3 surroundings, px.
    pub fn reach(&self) -> usize {
        1 + self.harris.reach() + self.smoothing()
    }

    /// The strengths of the pixels within `ring` px of pixel (`x`, `y`) along each axis.
    ///
    /// # Errors
    /// [`Rejection::Border`], [`Rejection::NotFinite`].
    pub fn strengths_around(&self, image: &Image, (x, y): (i64, i64), ring: usize) -> Result<Strengths, Rejection> {
        if self.derivation == 0.0 {
            return self.harris.strengths(image, x, y, ring);
        }
        let reach = ring + self.harris.reach() + self.smoothing();
        let rows = image.rows_around(x, y, reach as i64).ok_or(Rejection::Border)?;
        let side = 2 * reach + 1;
        let around = Image::new(side, side, rows.flatten().copied().collect());
        self.harris.strengths(&smooth(&around, self.derivation), reach as i64, reach as i64, ring)
    }

    /// How far the derivation Gaussian looks, px.
    fn smoothing(&self) -> usize {
        (4.0 * self.derivation).ceil() as usize
    }
}

impl Operator for HarrisParaboloid {
    /// # Errors
    /// [`Rejection::Border`], [`Rejection::NotFinite`], [`Rejection::NoCorner`] when no strength in the window is positive or the paraboloid has no
    /// maximum, [`Rejection::NoMaximum`] when the strength still grows at the window's border, [`Rejection::LeftWindow`] when the paraboloid's
    /// maximum is more than a pixel from the strongest one.
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        let ((x, y), around) = self.peak(image, start)?;
        let (dx, dy) = self.refinement.apply(&around).ok_or(Rejection::NoCorner)?;
        if dx.abs() > 1.0 || dy.abs() > 1.0 {
            return Err(Rejection::LeftWindow);
        }
        Ok(Measurement { position: PixelPoint::new(x as f64 + dx, y as f64 + dy), covariance: None })
    }
}

/// The strongest pixel inside the outermost ring of `strengths`; of equally strong ones that nearest to the start.
fn strongest(strengths: &Strengths, start: PixelPoint, centre: (i64, i64)) -> Result<(usize, usize), Rejection> {
    let middle = (strengths.side() / 2) as f64;
    let (fx, fy) = (start.x - centre.0 as f64 + middle, start.y - centre.1 as f64 + middle);
    let distance = |(column, row): (usize, usize)| (column as f64 - fx).hypot(row as f64 - fy);
    let inner = 1..strengths.side() - 1;
    let mut best = (1, 1);
    for (column, row) in inner.clone().flat_map(|row| inner.clone().map(move |column| (column, row))) {
        let (new, old) = (strengths.at(column, row), strengths.at(best.0, best.1));
        if new > old || (new == old && distance((column, row)) < distance(best)) {
            best = (column, row);
        }
    }
    let peak = strengths.at(best.0, best.1);
    if peak <= 0.0 {
        return Err(Rejection::NoCorner);
    }
    let grows = strengths.around(best.0, best.1).iter().flatten().any(|&neighbour| neighbour > peak);
    if grows { Err(Rejection::NoMaximum) } else { Ok(best) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance;
    use crate::registry::Registry;

    fn operator(spec: &str) -> Box<dyn Operator> {
        Registry::builtin().parse(spec).unwrap().operator.unwrap()
    }

    #[test]
    fn conforms_at_several_settings() {
        for spec in ["window=11", "window=5,k=1", "window=7,sigma=2,k=100", "window=31,alpha=0.06"] {
            conformance::check(&*operator(&format!("harris_paraboloid:{spec}")), 1e-7);
        }
        // An image is smoothed in single precision: some ten roundings of 6e-8 in every grey value, and a position follows a grey value by up to a few px.
        conformance::check(&*operator("harris_paraboloid:window=7,derivation=0.7,sigma=0.5"), 2e-6);
    }

    #[test]
    fn the_linear_fit_conforms() {
        for spec in ["window=11", "window=7,sigma=2"] {
            conformance::check(&*operator(&format!("harris_linear:{spec}")), 1e-7);
        }
    }

    #[test]
    fn the_linear_fit_is_pulled_to_the_pixel() {
        // On a wide hill neighbours are nearly as strong as the middle: the mean of three tells a third of what the difference of slopes does.
        let hill =
            |cx: f64| Image::from_fn(41, 41, move |x, y| (-((x as f64 - cx).powi(2) + (y as f64 - 20.0).powi(2)) / 8.0).exp() as f32);
        let found = |name: &str| {
            operator(&format!("{name}:sigma=2")).measure(&hill(20.3), &Start::at(PixelPoint::new(21.0, 19.0))).unwrap().position.x - 20.0
        };
        let (linear, paraboloid) = (found("harris_linear"), found("harris_paraboloid"));
        assert!(linear > 0.01 && linear < 0.15 && (paraboloid - 0.3).abs() < 0.02, "{linear} {paraboloid}");
    }

    #[test]
    fn a_symmetric_blob_is_found_at_its_centre() {
        for (cx, cy) in [(20.0, 20.0), (20.3, 19.8)] {
            let image = Image::from_fn(41, 41, |x, y| {
                let r2 = (x as f64 - cx).powi(2) + (y as f64 - cy).powi(2);
                (-r2 / 8.0).exp() as f32
            });
            let found = operator("harris_paraboloid:sigma=2").measure(&image, &Start::at(PixelPoint::new(21.0, 18.0))).unwrap();
            // The strength of a blob is nearly a paraboloid at its top; its third-order part costs some hundredths.
            assert!(found.position.distance(PixelPoint::new(cx, cy)) < 0.02, "{found:?}");
        }
    }

    #[test]
    fn strength_that_grows_outwards_is_no_maximum() {
        let image = Image::from_fn(61, 61, |x, y| if x > 36 && y > 30 { 1.0 } else { 0.0 });
        let found = operator("harris_paraboloid:window=5").measure(&image, &Start::at(PixelPoint::new(33.0, 30.0)));
        assert_eq!(found.unwrap_err(), Rejection::NoMaximum);
    }
}
