//! The `[figure]` table: a drawing of a paper, as a flat scene.

use calibench_synth::pointing::Hand;
use calibench_synth::testfield::{Figure4, Zhu};
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::check::surroundings;
use super::problem::Problem;
use super::section::Section;
use super::views::ImagingTables;
use super::wire::{Grey, Phase, Pixels, PointingWire, bounded};
use super::{SceneSubject, Starts};

bounded! {
    /// Columns and rows of a drawing.
    DrawingSide(usize), i64 "i64", 40, 20_000;
    /// A length in a drawing, px.
    DrawingLength(f64), f64 "f64", 0.1, 10_000.0;
}

/// The keys of `[figure]` that are tables of their own.
pub const TABLES: [&str; 1] = ["pointing"];

/// A drawing of a paper.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FigureWire {
    /// `zhu-a` to `zhu-h`: the eight images of Zhu, Wu & Wan, Fig. 4.
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// Columns and rows, px. Default 498.
    pub side: Option<DrawingSide>,
    /// Length of lines and edges, px. Default 150.
    pub arm: Option<DrawingLength>,
    /// Width of lines, px. Default 3.
    pub stroke: Option<DrawingLength>,
    /// Grey value of what is drawn. Default 0.
    pub ink: Option<Grey>,
    /// Grey value around it. Default 1.
    pub background: Option<Grey>,
    /// `area` (default): a pixel is the exact mean over its area. `centre`: it has the grey value at its centre, as drawing programs make it.
    pub pixels: Option<Pixels>,
    /// `fixed` (default), or `uniform`: each trial moves the drawing by a random part of a pixel.
    pub phase: Option<Phase>,
}

/// Reads a `[figure]` table.
pub fn read(mut section: Section<'_>, imaging: ImagingTables<'_>, problems: &mut Vec<Problem>) -> Option<SceneSubject> {
    let span = section.span.clone();
    let pointing = section.take_table("pointing", "[figure.pointing]", problems);
    if pointing.is_none() {
        let problem = Problem::new(span.clone(), "[figure] has no [figure.pointing]");
        problems.push(problem.help("measuring starts where somebody points: add `sigma` (px) and `whole_pixels`"));
    }
    let pointing: PointingWire = pointing.and_then(|section| section.read(&[], problems))?;
    let wire: FigureWire = section.read(&TABLES, problems)?;
    let figure = named(&wire.name, problems)?;
    let plain = Zhu::default();
    let length = |value: Option<DrawingLength>, default: f64| value.map_or(default, |value| value.0);
    let grey = |value: Option<Grey>, default: f64| value.map_or(default, |value| value.0);
    let side = wire.side.map_or(plain.side, |side| side.0);
    // The reference point keeps its place beside the middle: (248.5, 248.5) of 498.
    let middle = side as f64 / 2.0 - 0.5;
    let zhu = Zhu {
        side,
        at: calibench_model::PixelPoint::new(middle, middle),
        arm: length(wire.arm, plain.arm),
        stroke: length(wire.stroke, plain.stroke),
        ink: grey(wire.ink, plain.ink),
        background: grey(wire.background, plain.background),
    };
    let scene = zhu.scene(figure).map_err(|error| problems.push(Problem::new(span.clone(), error.to_string()))).ok()?;
    let pixels = wire.pixels.unwrap_or_default();
    if let Some(span) = imaging.span().filter(|_| pixels == Pixels::Centre) {
        problems.push(Problem::new(span, "[optics] or [sensor] beside `pixels = \"centre\"`: drawn pixels have neither"));
    }
    let imaging = imaging.read(&surroundings(&scene), problems)?;
    let starts = Starts::Pointed(Hand { sigma: pointing.sigma.0, whole_pixels: pointing.whole_pixels });
    Some(SceneSubject { scene, starts, pixels, bits: None, grey_noise: 0.0, phase: wire.phase.unwrap_or_default(), imaging })
}

fn named(name: &Spanned<String>, problems: &mut Vec<Problem>) -> Option<Figure4> {
    let names: Vec<String> = Figure4::ALL.iter().map(|figure| format!("zhu-{}", figure.letter())).collect();
    let found = names.iter().position(|known| known == name.get_ref());
    if found.is_none() {
        let message = format!("no figure is called `{}`: expected one of {}", name.get_ref(), names.join(", "));
        problems.push(Problem::new(name.span(), message).nearest(name.get_ref(), names.iter().map(String::as_str)));
    }
    found.map(|index| Figure4::ALL[index])
}
