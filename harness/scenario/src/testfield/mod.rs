//! The `[testfield]` table: what the cameras of a scenario look at.

use std::path::{Path, PathBuf};

use calibench_diagnostics::Problem;
use calibench_model::Testfield;
use calibench_model::boards::{Board, Chessboard as PlainBoard};
use calibench_random::Key;
use calibench_synth::testfield::{Chessboard, Coded, FieldError, Fill, House, Print, Wall};
use toml::de::DeValue;

use super::section::Section;

pub mod boards;
mod common;
mod generator;
pub mod print;
mod spans;
mod wall;
pub mod wire;

use common::{BACKGROUND, bend, levels};
pub use generator::Generator;
pub(super) use spans::Spans;
use wire::{ChessboardWire, CodedWire, Height, HouseWire};

/// The kinds of testfield.
pub const KINDS: [&str; 13] =
    ["chessboard", "wall", "coded", "house", "board", "charuco", "aprilgrid", "gridboard", "circles", "rings", "puzzle", "dotted", "tags"];

/// Those that are boards.
pub const BOARDS: [&str; 9] = ["chessboard", "board", "charuco", "aprilgrid", "gridboard", "circles", "rings", "puzzle", "dotted"];

/// The unit of object space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unit {
    /// mm.
    #[default]
    Millimetre,
    /// m.
    Metre,
}

impl Unit {
    /// Its name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Metre => "m",
        }
    }

    /// Millimetres in it: 1 or 1000.
    pub const fn mm(self) -> f64 {
        match self {
            Self::Millimetre => 1.0,
            Self::Metre => 1000.0,
        }
    }
}

/// A checked `[testfield]`.
#[derive(Clone, Debug)]
pub struct FieldPlan {
    /// The unit of its lengths, and of object space.
    pub unit: Unit,
    /// What makes it.
    pub generator: Generator,
    /// How it was printed, where it is a board.
    pub print: Print,
    /// The file of its corners, if there is one.
    pub corner_file: Option<PathBuf>,
    spans: Spans,
}

impl FieldPlan {
    /// The testfield of `key`.
    ///
    /// # Errors
    /// What does not fit together. A plan that was read has been tried with the scenario's key.
    pub fn generate(&self, key: Key<'_>) -> Result<Testfield, FieldError> {
        self.print.applied(self.perfect(key)?, key)
    }

    /// It as it was meant to be printed.
    fn perfect(&self, key: Key<'_>) -> Result<Testfield, FieldError> {
        match &self.generator {
            Generator::Chessboard(board) => board.generate(key),
            Generator::Wall(wall, None) => wall.generate(key),
            Generator::Wall(wall, Some(panels)) => {
                let sheets = wall.sheets.iter().cloned().chain(panels.sheets(key)?).collect();
                Wall { sheets, ..wall.clone() }.generate(key)
            }
            Generator::Coded(field) => field.generate(key),
            Generator::House(house) => house.generate(key),
            Generator::Board(sheet) => sheet.generate(key),
            Generator::Tags(tags) => tags.generate(),
        }
    }

    /// What of it is drawn by chance, in words.
    pub fn drawn(&self) -> Vec<&'static str> {
        let words = match &self.generator {
            Generator::Chessboard(board) => vec![("errors of the print", board.print_noise > 0.0)],
            Generator::Board(sheet) => vec![("errors of the print", sheet.print_noise > 0.0)],
            Generator::Wall(wall, panels) => vec![
                ("the relief of the wall", panels.as_ref().is_some_and(|panels| panels.relief > 0.0 || panels.tilt > 0.0)),
                ("the layout of its targets", wall.fill.as_ref().is_some_and(Fill::is_random)),
                ("errors of the survey", wall.survey_sigma > 0.0),
            ],
            Generator::Coded(_) => vec![("the layout of the field", true)],
            Generator::House(house) => vec![("the texture of the walls", house.specks > 0)],
            Generator::Tags(_) => Vec::new(),
        };
        let ragged = (self.print.ragged > 0.0).then_some("how ragged printed edges are");
        words.into_iter().filter_map(|(what, is_drawn)| is_drawn.then_some(what)).chain(ragged).collect()
    }

    /// The board that it is, if it is one.
    pub const fn board(&self) -> Option<Board> {
        match &self.generator {
            Generator::Chessboard(board) => {
                Some(Board::Chessboard(PlainBoard { columns: board.columns, rows: board.rows, square: board.square }))
            }
            Generator::Board(sheet) => Some(sheet.board),
            Generator::Wall(..) | Generator::Coded(_) | Generator::House(_) | Generator::Tags(_) => None,
        }
    }

    /// Standard deviation of the surveyed coordinates, object units; `None` for a testfield that was made, not surveyed.
    pub fn survey_sigma(&self) -> Option<f64> {
        match &self.generator {
            Generator::Wall(wall, _) => Some(wall.survey_sigma).filter(|sigma| *sigma > 0.0),
            _ => None,
        }
    }

    /// An error of [`Self::generate`] at its place in the file.
    pub fn problem(&self, error: &FieldError) -> Problem {
        let span = match error {
            FieldError::Parameter { parameter, .. } => self.spans.of_key(parameter),
            FieldError::Twice { id, .. } | FieldError::Axes(id) => self.spans.of_id(id),
            FieldError::UnknownPlate { target, .. } | FieldError::OffPlate { target, .. } => self.spans.of_id(target),
            FieldError::Overlap { first, second, .. } => self.spans.of_id(second).or_else(|| self.spans.of_id(first)),
            _ => None,
        };
        Problem::new(span.unwrap_or_else(|| self.spans.whole.clone()), error.to_string())
    }
}

/// Reads `[testfield]` of a scenario in `folder` and tries it with `key`; mistakes are added to `problems`.
pub fn read(mut section: Section<'_>, folder: &Path, key: Key<'_>, problems: &mut Vec<Problem>) -> Option<FieldPlan> {
    let unit = take_unit(&mut section, problems);
    let kind = take_kind(&mut section, "[testfield]", &KINDS, problems);
    let (unit, kind) = (unit?, kind?);
    let mut spans = Spans::of(&section);
    let is_board = BOARDS.contains(&kind);
    let printed = is_board.then(|| section.take_keys(&print::KEYS));
    let others: Vec<&str> = ["bend", "print_noise"].into_iter().filter(|key| spans.of_key(key).is_some()).collect();
    let generator = match kind {
        "chessboard" => Generator::Chessboard(chessboard(&section.read(&print::KEYS, problems)?)),
        "coded" => Generator::Coded(coded(&section.read(&[], problems)?, unit)),
        "house" => Generator::House(house(&section.read(&[], problems)?)),
        "wall" => wall::read(section, &mut spans, problems)?,
        "tags" => boards::read_tags(section, &mut spans, problems)?,
        kind => boards::read(section, kind, problems)?,
    };
    let step = match &generator {
        Generator::Chessboard(board) => board.square,
        Generator::Board(sheet) => sheet.board.step(),
        _ => 1.0,
    };
    let (print, corner_file) = match printed {
        Some(section) => print::read(section, (step, &others), folder, problems)?,
        None => (Print { ragged_length: step, ..Print::default() }, None),
    };
    let plan = FieldPlan { unit, generator, print, corner_file, spans };
    match plan.generate(key) {
        Ok(_) => Some(plan),
        Err(error) => {
            problems.push(plan.problem(&error));
            None
        }
    }
}

/// Takes the key `kind`, one of `kinds`.
pub(super) fn take_kind(
    section: &mut Section<'_>,
    name: &str,
    kinds: &[&'static str],
    problems: &mut Vec<Problem>,
) -> Option<&'static str> {
    let listed = kinds.join(", ");
    let Some((_, value)) = section.take("kind") else {
        problems.push(Problem::new(section.span.clone(), format!("{name} has no `kind`")).help(format!("`kind`: one of {listed}")));
        return None;
    };
    let found = value.get_ref().as_str().unwrap_or_default();
    let known = kinds.iter().copied().find(|kind| *kind == found);
    if known.is_none() {
        let message = format!("`kind` of {name} is one of {listed}; found {}", shown(value.get_ref()));
        problems.push(Problem::new(value.span(), message).nearest(found, kinds.iter().copied()));
    }
    known
}

fn take_unit(section: &mut Section<'_>, problems: &mut Vec<Problem>) -> Option<Unit> {
    let Some((_, value)) = section.take("unit") else { return Some(Unit::default()) };
    match value.get_ref().as_str() {
        Some("mm") => Some(Unit::Millimetre),
        Some("m") => Some(Unit::Metre),
        _ => {
            problems.push(Problem::new(value.span(), format!("`unit` is \"mm\" or \"m\"; found {}", shown(value.get_ref()))));
            None
        }
    }
}

fn shown(value: &DeValue<'_>) -> String {
    value.as_str().map_or_else(|| format!("a value of type {}", value.type_str()), |text| format!("`{text}`"))
}

fn chessboard(wire: &ChessboardWire) -> Chessboard {
    Chessboard {
        rows: wire.rows.0,
        columns: wire.columns.0,
        square: wire.square.0,
        margin: wire.margin.map_or(wire.square.0, |margin| margin.0),
        bend: bend(wire.bend, wire.bend_across),
        print_noise: wire.print_noise.map_or(0.0, |noise| noise.0),
        levels: levels(wire.paper, wire.ink),
        background: wire.background.map_or(BACKGROUND, |level| level.0),
    }
}

fn coded(wire: &CodedWire, unit: Unit) -> Coded {
    let paper = Coded::paper();
    let length = |mm: f64| mm / unit.mm();
    let squares = wire.squares.map_or(paper.squares, |count| count.0);
    let half = if squares.is_multiple_of(4) { squares / 2 } else { squares };
    let peak = wire.bend.unwrap_or(Height(length(0.8)));
    Coded {
        squares,
        measured: wire.measured.map_or(half, |count| count.0),
        spacing: wire.spacing.map_or(length(paper.spacing), |spacing| spacing.0),
        line: wire.line.map_or(length(paper.line), |line| line.0),
        sheet: wire.sheet.map_or(length(paper.sheet), |side| side.0),
        small: wire.small.map_or(paper.small.map(length), |sizes| sizes.0),
        large: wire.large.map_or(paper.large.map(length), |sizes| sizes.0),
        bend: bend(Some(peak), wire.bend_across),
        levels: levels(wire.paper, wire.ink),
        background: wire.background.map_or(paper.background, |level| level.0),
    }
}

fn house(wire: &HouseWire) -> House {
    let usual = House::default();
    House {
        width: wire.width.0,
        specks: wire.specks.map_or(usual.specks, |count| count.0),
        speck: wire.speck.map_or(0.0075 * wire.width.0, |side| side.0),
        contrast: wire.contrast.map_or(usual.contrast, |contrast| contrast.0),
        background: wire.background.map_or(usual.background, |level| level.0),
    }
}

#[cfg(test)]
mod tests;
