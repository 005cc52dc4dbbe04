//! The `[figure]` table: a drawing of a paper, as a flat scene.

use calibench_diagnostics::Problem;
use calibench_synth::testfield::{Figure4, Join, Zhu};
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::scene::surroundings;
use super::section::Section;
use super::views::ImagingTables;
use super::wire::{Bits, Grey, GreyNoise, Phase, Pixels, bounded};
use super::{Pointing, SceneSubject, Starts};

bounded! {
    /// Columns and rows of a drawing.
    DrawingSide(usize), i64 "i64", 40, 20_000;
    /// A length in a drawing, px.
    DrawingLength(f64), f64 "f64", 0.1, 10_000.0;
    /// An angle in a drawing, degrees.
    DrawingAngle(f64), f64 "f64", 5.0, 175.0;
    /// The width of a pen, px.
    DrawingPen(f64), f64 "f64", 0.0, 5.0;
}

/// The keys of `[figure]` that are tables of their own.
pub const TABLES: [&str; 1] = ["pointing"];

/// A drawing of a paper.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FigureWire {
    /// `zhu-a` to `zhu-h`: the eight images of Zhu, Wu & Wan, Fig. 4; `zhu`: all eight on one sheet, (a) to (d) above (e) to (h).
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// Columns and rows of one image, px; the reference point lies in its middle: on the common corner of four pixels if even, on the centre of one if odd. Default 498.
    pub side: Option<DrawingSide>,
    /// Length of lines and edges, px. Default 150.
    pub arm: Option<DrawingLength>,
    /// Width of lines, px. Default 3.
    pub stroke: Option<DrawingLength>,
    /// Width of the round pen that draws the outline beside the filling, px: what is drawn reaches half of it past its geometry. Default 0.
    pub pen: Option<DrawingPen>,
    /// Whether one edge of (b) to (g) runs along +x, rather than the bisector. Default false.
    pub edge_along_x: Option<bool>,
    /// How the two lines of (b) to (d) join. Default `mitre`.
    pub join: Option<JoinWire>,
    /// Another angle of a line or solid corner, degrees; it then opens to the right. Default: that of the image.
    #[schemars(with = "Option<DrawingAngle>")]
    pub angle: Option<Spanned<DrawingAngle>>,
    /// Grey value of what is drawn. Default 0.
    pub ink: Option<Grey>,
    /// Grey value around it. Default 1.
    pub background: Option<Grey>,
    /// `area` (default): a pixel is the exact mean over its area. `centre`: it has the grey value at its centre, as drawing programs make it.
    pub pixels: Option<Pixels>,
    /// `fixed` (default), or `uniform`: each trial moves the drawing by a random part of a pixel.
    pub phase: Option<Phase>,
    /// Standard deviation of the white Gaussian grey-value noise, fraction of full scale. Default 0.
    #[schemars(with = "Option<GreyNoise>")]
    pub grey_noise: Option<Spanned<GreyNoise>>,
    /// Quantisation: 8, 12 or 16 bits; grey values below 0 and above 1 are clipped then. Default: none.
    pub bits: Option<Bits>,
}

/// How two lines join at a corner.
#[derive(Clone, Copy, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum JoinWire {
    /// The outer edges go on until they meet.
    #[default]
    Mitre,
    /// The tip of the mitre is cut where the lines' own ends are.
    Bevel,
    /// An arc about where the lines' middles meet.
    Round,
    /// Each line ends where the middles meet.
    Butt,
    /// Each line goes on by half its width.
    Square,
}

impl From<JoinWire> for Join {
    fn from(join: JoinWire) -> Self {
        match join {
            JoinWire::Mitre => Self::Mitre,
            JoinWire::Bevel => Self::Bevel,
            JoinWire::Round => Self::Round,
            JoinWire::Butt => Self::Butt,
            JoinWire::Square => Self::Square,
        }
    }
}

/// Reads a `[figure]` table.
pub fn read(mut section: Section<'_>, imaging: ImagingTables<'_>, problems: &mut Vec<Problem>) -> Option<SceneSubject> {
    let span = section.span.clone();
    let pointing = section.take_table("pointing", "[figure.pointing]", problems);
    if pointing.is_none() {
        let problem = Problem::new(span.clone(), "[figure] has no [figure.pointing]");
        problems.push(problem.help("measuring starts where somebody points: add `sigma` (px) and `whole_pixels`, or `detector`"));
    }
    let pointing = pointing.and_then(|section| Pointing::read(section, problems))?;
    let starts = Starts::of_drawing(pointing, problems)?;
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
        edge_along_x: wire.edge_along_x.unwrap_or(false),
        pen: wire.pen.map_or(0.0, |pen| pen.0),
        join: wire.join.unwrap_or_default().into(),
        angle: wire.angle.as_ref().map(|angle| angle.get_ref().0),
    };
    if let Some(angle) = wire.angle.as_ref().filter(|_| matches!(figure, Drawn::Sheet | Drawn::One(Figure4::EndPoint))) {
        let problem = Problem::new(angle.span(), "`angle` of a figure that has no one corner");
        problems.push(problem.help("expected with `zhu-b` to `zhu-h`"));
    }
    let scene = match figure {
        Drawn::One(figure) => zhu.scene(figure),
        Drawn::Sheet => zhu.sheet(),
    };
    let scene = scene.map_err(|error| problems.push(Problem::new(span.clone(), error.to_string()))).ok()?;
    let pixels = wire.pixels.unwrap_or_default();
    if let Some(span) = imaging.span().filter(|_| pixels == Pixels::Centre) {
        problems.push(Problem::new(span, "[optics] or [sensor] beside `pixels = \"centre\"`: drawn pixels have neither"));
    }
    let own = wire.grey_noise.as_ref().map(Spanned::span);
    if let Some(span) = own.filter(|_| imaging.sensor_span().is_some()) {
        problems.push(Problem::new(span, "[sensor] beside `grey_noise` of [figure]: expected one of them"));
    }
    let imaging = imaging.read(&surroundings(&scene), problems)?;
    Some(SceneSubject {
        scene,
        starts,
        pixels,
        bits: wire.bits.map(|bits| bits.0),
        grey_noise: wire.grey_noise.map_or(0.0, |noise| noise.get_ref().0),
        phase: wire.phase.unwrap_or_default(),
        imaging,
    })
}

/// What of Fig. 4 is drawn.
#[derive(Clone, Copy)]
enum Drawn {
    /// One of the eight images.
    One(Figure4),
    /// All of them on one sheet.
    Sheet,
}

/// What a name stands for.
fn named(name: &Spanned<String>, problems: &mut Vec<Problem>) -> Option<Drawn> {
    let letters = Figure4::ALL.iter().map(|figure| format!("zhu-{}", figure.letter()));
    let names: Vec<String> = letters.chain(["zhu".to_owned()]).collect();
    let found = names.iter().position(|known| known == name.get_ref());
    if found.is_none() {
        let message = format!("no figure is called `{}`: expected one of {}", name.get_ref(), names.join(", "));
        problems.push(Problem::new(name.span(), message).nearest(name.get_ref(), names.iter().map(String::as_str)));
    }
    found.map(|index| Figure4::ALL.get(index).map_or(Drawn::Sheet, |figure| Drawn::One(*figure)))
}
