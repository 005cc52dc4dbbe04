//! What a twin is made of, and how it comes nearer to what photographs look like.

use crate::look::{Figure, Light, Look, NoiseLine};
use crate::tone::{LONGEST, Tone};

/// The variance that a photosite of full width adds to any line spread, px^2.
const PIXEL: f64 = 1.0 / 12.0;
/// The smallest Gaussian blur beside a motion, px.
const LEAST_BLUR: f64 = 0.12;
/// Blur beyond which no operator is asked, px^2.
const WIDEST: f64 = 16.0;
/// A motion below this is not told from none, px.
const LEAST_MOTION: f64 = 0.3;

/// What a view is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewDesign {
    /// Its light.
    pub light: Light,
    /// Covariance of blur in the middle of the frame, without the pixel's own: xx, xy, yy, px^2.
    pub blur: [f64; 3],
}

/// What a twin is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// By view.
    pub views: Vec<ViewDesign>,
    /// How much larger the variance of blur is in the frame's corners, px^2.
    pub corner: f64,
    /// The curve from light to grey.
    pub tone: Tone,
    /// Whether a colour filter's mosaic was interpolated to grey.
    pub demosaiced: bool,
    /// Noise against light.
    pub noise: NoiseLine,
    /// Standard deviation of the Gaussian that smooths the developed image, px; 0: none.
    pub smoothing: f64,
    /// Positive: amount of an unsharp mask. Negative: less the share of the light in a tail.
    pub halo: f64,
    /// Dark areas grow by this on every side, as a share of a square.
    pub ink_spread: f64,
    /// Standard deviation per axis of what the lens does beyond its model, px.
    pub local: f64,
    /// Variance of printed edges across themselves, as a share of a square, squared.
    pub raggedness: f64,
}

/// How much sharpening makes an overshoot of the whole contrast, about.
pub(crate) const HALO_GAIN: f64 = 12.0;
/// How long a shoulder is whose profiles are asymmetric by the whole contrast, about.
const TONE_GAIN: f64 = 6.0;
/// Share of light in a tail at most.
const MOST_TAIL: f64 = 0.4;
/// Amount of sharpening at most.
const MOST_SHARPENING: f64 = 3.0;
/// An image is smoothed by no more than this, px.
const MOST_SMOOTHING: f64 = 2.0;

impl Design {
    /// [`Self::plain`] with as much blur as photographs of use have, so that as much around the frame matters: what can picture this can picture what follows.
    pub fn widest(views: usize) -> Self {
        let plain = Self::plain(views);
        let views = plain.views.iter().map(|view| ViewDesign { blur: [WIDEST, 0.0, WIDEST], ..*view }).collect();
        Self { views, ..plain }
    }

    /// So many views of usual light and blur, without noise: what says where things are.
    pub fn plain(views: usize) -> Self {
        let light = Light { exposure: 0.8, veil: 0.0, gradient: [0.0; 2] };
        Self {
            views: vec![ViewDesign { light, blur: [0.5, 0.0, 0.5] }; views],
            corner: 0.0,
            tone: Tone::default(),
            demosaiced: false,
            noise: NoiseLine::default(),
            smoothing: 0.0,
            halo: 0.0,
            ink_spread: 0.0,
            local: 0.0,
            raggedness: 0.0,
        }
    }

    /// A first one, that of photographs that look so, with a filter's mosaic or without. Views without a look of their own have that of the others.
    pub fn first(look: &Look, demosaiced: bool) -> Option<Self> {
        let tone = Tone::default();
        let lights = look.lights(tone);
        let usual = lights.iter().flatten().next().copied()?;
        let spread = look.spread().powi(2);
        let view = |(light, spreads): (&Option<Light>, &Option<[f64; 3]>)| {
            let [xx, xy, yy] = spreads.unwrap_or([spread, 0.0, spread]);
            ViewDesign { light: light.unwrap_or(usual), blur: [xx - PIXEL, xy, yy - PIXEL] }
        };
        Some(Self {
            views: lights.iter().zip(&look.spreads).map(view).collect(),
            corner: look.corner,
            tone,
            demosaiced,
            noise: look.noise(tone),
            // Interpolation of a mosaic smooths noise by itself.
            smoothing: look.correlation.filter(|_| !demosaiced).map_or(0.0, |figure| blur_of(figure.value)),
            halo: 0.0,
            ink_spread: look.shift.map_or(0.0, |figure| figure.value),
            local: 0.0,
            raggedness: 0.0,
        })
    }

    /// One that looks more like photographs of look `real` than this one, which looks like `twin`. `before` is an earlier one and its look: what it tells of how looks
    /// follow designs is used.
    #[must_use]
    pub fn nearer(&self, real: &Look, twin: &Look, before: Option<(&Self, &Look)>) -> Self {
        let mut next = self.clone();
        let wanted = |real: Option<Figure>, twin: Option<Figure>| real.zip(twin).map_or(0.0, |(real, twin)| real.value - twin.value);
        next.tone.shoulder = (self.tone.shoulder + TONE_GAIN * wanted(real.asymmetry, twin.asymmetry)).clamp(0.0, LONGEST);
        let (lights, own) = (real.lights(next.tone), twin.lights(self.tone));
        let views = next.views.iter_mut().zip(lights.iter().zip(&own)).zip(real.spreads.iter().zip(&twin.spreads));
        for ((view, lights), spreads) in views {
            if let (Some(real), Some(twin)) = lights {
                view.light.exposure *= real.exposure / twin.exposure;
                view.light.veil += real.veil - twin.veil;
                (0..2).for_each(|k| view.light.gradient[k] += real.gradient[k] - twin.gradient[k]);
            }
            if let (Some(real), Some(twin)) = spreads {
                (0..3).for_each(|k| view.blur[k] += real[k] - twin[k]);
                // Edges that are sharper than the rest of the chain allows stay so: this does not run away.
                [0, 2].into_iter().for_each(|k| view.blur[k] = view.blur[k].max(LEAST_BLUR * LEAST_BLUR));
            }
        }
        next.corner += real.corner - twin.corner;
        next.noise = louder(self.noise, real.noise(next.tone), twin.noise(self.tone));
        let correlation = correlation_of(self.smoothing) + wanted(real.correlation, twin.correlation);
        next.smoothing = blur_of(correlation);
        let gain = |usual: f64, change: f64, change_of_look: f64| {
            let found = change / change_of_look;
            if found.is_finite() && found > 0.2 * usual && found < 5.0 * usual { found } else { usual }
        };
        let looks = before.map(|(design, look)| (design, wanted(twin.halo, look.halo), wanted(twin.raggedness, look.raggedness)));
        let (of_halo, of_rags) = looks.map_or((f64::NAN, f64::NAN), |(design, halo, rags)| {
            ((self.halo - design.halo) / halo, (self.raggedness - design.raggedness) / rags)
        });
        next.halo = (self.halo + gain(HALO_GAIN, of_halo, 1.0) * wanted(real.halo, twin.halo)).clamp(-MOST_TAIL, MOST_SHARPENING);
        let scale = 1.0 / (real.side * real.side);
        next.raggedness = (self.raggedness + gain(1.5 * scale, of_rags, 1.0) * wanted(real.raggedness, twin.raggedness)).max(0.0);
        next.ink_spread += wanted(real.shift, twin.shift);
        next
    }
}

/// Levels at which noise is compared.
const LEVELS: [f64; 2] = [0.12, 0.6];

/// `noise` by as much more as the looks of photographs have than those of the twin.
fn louder(noise: NoiseLine, real: NoiseLine, twin: NoiseLine) -> NoiseLine {
    let at = |level: f64| noise.at(level).max(1e-10) * (real.at(level) / twin.at(level).max(1e-12)).clamp(0.1, 10.0);
    let [low, high] = LEVELS.map(at);
    let slope = ((high - low) / (LEVELS[1] - LEVELS[0])).max(0.0);
    let dark = low - slope * LEVELS[0];
    if dark >= 0.0 { NoiseLine { dark, slope } } else { NoiseLine { dark: 0.0, slope: high / LEVELS[1] } }
}

/// Blur and motion of a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smear {
    /// Standard deviation of a Gaussian, px.
    pub blur: f64,
    /// A straight motion [dx, dy], px, where one is told.
    pub motion: Option<[f64; 2]>,
}

impl ViewDesign {
    /// Blur and motion with this covariance: the smaller axis is that of the blur, what the larger one has more is a motion.
    pub fn smear(&self) -> Smear {
        let [xx, xy, yy] = self.blur;
        let (mean, half) = (0.5 * (xx + yy), (0.25 * (xx - yy).powi(2) + xy * xy).sqrt());
        let length = (24.0 * half).sqrt();
        let least = LEAST_BLUR * LEAST_BLUR;
        if length < LEAST_MOTION || mean - half < least {
            return Smear { blur: mean.max(least).sqrt(), motion: None };
        }
        let direction = 0.5 * (2.0 * xy).atan2(xx - yy);
        Smear { blur: (mean - half).sqrt(), motion: Some([length * direction.cos(), length * direction.sin()]) }
    }
}

/// The correlation of neighbouring pixels of white noise that a Gaussian of `blur` px has smoothed.
pub(crate) fn correlation_of(blur: f64) -> f64 {
    if blur > 0.0 { (-0.25 / (blur * blur)).exp() } else { 0.0 }
}

/// The Gaussian that leaves this correlation, px.
pub(crate) fn blur_of(correlation: f64) -> f64 {
    if correlation <= 1e-3 { 0.0 } else { (-0.25 / correlation.min(0.95).ln()).sqrt().min(MOST_SMOOTHING) }
}
