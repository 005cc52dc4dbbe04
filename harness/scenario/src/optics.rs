//! The `[optics]` table: how light is spread before it is sampled.

use calibench_diagnostics::Problem;
use calibench_synth::optics::{Motion, Optics, Tail};
use schemars::JsonSchema;
use serde::Deserialize;

use super::section::Section;
use super::wire::{Position, bounded};

bounded! {
    /// A length in the image, px.
    Pixels(f64), f64 "f64", 0.0, 1000.0;
    /// A share of the light.
    TailShare(f64), f64 "f64", 0.0, 0.5;
    /// A share of a pixel that is sensitive to light.
    Fill(f64), f64 "f64", 0.0025, 1.0;
}

/// Blur and aperture. Every key is a stage that may be left out.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OpticsWire {
    /// Standard deviation of the Gaussian blur, px: 0, or 0.02 to 100. Default 0.
    pub blur: Option<Pixels>,
    /// The same in the frame's corners, at least `blur`: its square grows with that of the distance from the middle. Default: as `blur`.
    pub corner_blur: Option<Pixels>,
    /// Radius of a defocus disc, px. Default 0.
    pub defocus: Option<Pixels>,
    /// A straight motion during the exposure [dx, dy], px.
    pub motion: Option<Position>,
    /// Share of the light that is spread wider, 0 to 0.5, with `tail_blur`.
    pub tail: Option<TailShare>,
    /// Standard deviation of that wider Gaussian, px, at least that of the rest.
    pub tail_blur: Option<Pixels>,
    /// Width of the photosite as a part of the pitch. Default 1.
    pub fill_factor_linear: Option<Fill>,
    /// Area of the photosite as a part of the pixel's. Not beside `fill_factor_linear`.
    pub fill_factor_area: Option<Fill>,
}

/// A motion [dx, dy], px.
pub(crate) fn motion(Position(dx, dy): Position) -> Motion {
    Motion { length: dx.hypot(dy), direction: dy.atan2(dx) }
}

/// Reads an `[optics]` table.
pub fn read(section: Section<'_>, problems: &mut Vec<Problem>) -> Option<Optics> {
    let span = section.span.clone();
    let wire: OpticsWire = section.read(&[], problems)?;
    if wire.fill_factor_linear.is_some() && wire.fill_factor_area.is_some() {
        problems.push(Problem::new(span, "both `fill_factor_linear` and `fill_factor_area`: expected one of them"));
        return None;
    }
    if wire.tail.is_some() != wire.tail_blur.is_some() {
        problems.push(Problem::new(span, "`tail` and `tail_blur` need each other: expected both or none"));
        return None;
    }
    let tail = wire.tail.zip(wire.tail_blur).map(|(share, blur)| Tail { share: share.0, blur: blur.0 });
    let length = |value: Option<Pixels>| value.map_or(0.0, |value| value.0);
    let aperture = wire.fill_factor_linear.map_or_else(|| wire.fill_factor_area.map_or(1.0, |area| area.0.sqrt()), |linear| linear.0);
    let motion = wire.motion.map(motion);
    let (blur, corner_blur) = (length(wire.blur), wire.corner_blur.map(|blur| blur.0));
    let optics = Optics { blur, corner_blur, defocus: length(wire.defocus), motion, tail, aperture };
    match optics.check() {
        Ok(()) => Some(optics),
        Err(error) => {
            problems.push(Problem::new(span, error.to_string()));
            None
        }
    }
}
