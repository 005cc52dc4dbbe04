//! What a twin is made of, in the terms of its scenario, with what photographs leave open.

use crate::design::{Design, HALO_GAIN};
use crate::fitted::Fitted;
use crate::look::{Figure, Look};

/// A part of what a twin is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// The scenario's key.
    pub key: &'static str,
    /// What it is.
    pub what: &'static str,
    /// Its unit; empty of a number.
    pub unit: &'static str,
    /// Its value; of views the mean.
    pub value: f64,
    /// Where it is at 95 %, where that is told.
    pub interval: Option<[f64; 2]>,
}

/// Standard deviations of an interval of 95 %.
const NORMAL: f64 = 1.96;

/// The parts of a twin of photographs that look like `real`, on a board with squares of `square` object units.
pub fn made_of(real: &Look, found: &Fitted, square: f64) -> Vec<Part> {
    let (design, twin) = (&found.design, &found.look);
    // What is found errs as the photographs do and as the twin does by which it was found.
    let both = |real: Option<Figure>, twin: Option<Figure>| {
        real.zip(twin).map(|(real, twin)| real.sigma.hypot(twin.sigma)).filter(|s| s.is_finite())
    };
    let root = |variance: f64, sigma: Option<f64>, scale: f64| {
        let ends = sigma.map(|sigma| [variance - NORMAL * sigma, variance + NORMAL * sigma].map(|v| v.max(0.0).sqrt() * scale));
        (variance.max(0.0).sqrt() * scale, ends)
    };
    let around = |value: f64, sigma: Option<f64>, low: f64| sigma.map(|sigma| [(value - NORMAL * sigma).max(low), value + NORMAL * sigma]);
    let variance = design.views.iter().map(|view| 0.5 * (view.blur[0] + view.blur[2])).sum::<f64>() / design.views.len().max(1) as f64;
    let (blur, of_blur) = root(variance, both(real.variance, twin.variance), 1.0);
    let noise = design.noise.at(design.tone.light(real.level)).sqrt();
    let of_noise = around(noise, both(Some(real.noise_middle), Some(twin.noise_middle)), 0.0);
    let of_smoothing = both(real.correlation, twin.correlation).map(|sigma| smoothing(design, sigma));
    let of_halo = around(design.halo, both(real.halo, twin.halo).map(|sigma| HALO_GAIN * sigma), f64::NEG_INFINITY);
    let in_squares = both(real.raggedness, twin.raggedness).map(|sigma| 1.5 * sigma / (real.side * real.side));
    let (ragged, of_ragged) = root(design.raggedness, in_squares, square);
    let spread = around(design.ink_spread * square, both(real.shift, twin.shift).map(|sigma| sigma * square), f64::NEG_INFINITY);
    let part = |key, what, unit, value, interval| Part { key, what, unit, value, interval };
    let (key, what, value, of_halo) = if design.halo < 0.0 {
        ("optics.tail", "light in a wide tail of the point spread", -design.halo, of_halo.map(|[from, to]| [(-to).max(0.0), -from]))
    } else {
        ("sensor.sharpening", "amount of sharpening", design.halo, of_halo.map(|[from, to]| [from.max(0.0), to]))
    };
    vec![
        part("station.blur", "blur, mean over views", "px", blur, of_blur),
        part(
            "sensor noise",
            "noise in the middle of the levels",
            "grey levels of 255",
            255.0 * noise,
            of_noise.map(|ends| ends.map(|end| 255.0 * end)),
        ),
        part("sensor.smoothing", "smoothing of the developed image", "px", design.smoothing, of_smoothing),
        part(key, what, "", value, of_halo),
        part("camera.local.sigma", "what is left of the photographs' hold-out, given to the lens", "px", design.local, None),
        part("testfield.ragged", "raggedness of edges", "object units", ragged, of_ragged),
        part("testfield.ink_spread", "growth of dark areas", "object units", design.ink_spread * square, spread),
    ]
}

/// Where the smoothing of noise is whose correlation errs by `sigma`.
fn smoothing(design: &Design, sigma: f64) -> [f64; 2] {
    let correlation = crate::design::correlation_of(design.smoothing);
    [correlation - NORMAL * sigma, correlation + NORMAL * sigma].map(crate::design::blur_of)
}
