//! Boards with markers, circles or ring codes, and free-standing markers.

use calibench_diagnostics::Problem;
use calibench_model::boards::{AprilGrid, Board, Charuco, Circles, Dictionary, Dotted, GridBoard, Marks, Puzzle, Rings};
use calibench_synth::testfield::{BoardSheet, Tag, Tags};
use nalgebra::{Point3, Vector3};
use toml::Spanned;

use super::common::{BACKGROUND, bend, levels};
use super::generator::Generator;
use super::print;
use super::spans::Spans;
use crate::section::Section;

pub mod wire;

use wire::{
    AprilGridWire, BoardWire, CharucoWire, CirclesWire, DottedWire, GridBoardWire, PuzzleWire, RingsWire, SheetWire, TagWire, TagsWire,
};

/// The kinds that are one sheet.
pub const SHEETS: [&str; 8] = ["board", "charuco", "aprilgrid", "gridboard", "circles", "rings", "puzzle", "dotted"];
/// The keys that all of them have.
const COMMON: [&str; 7] = ["margin", "bend", "bend_across", "print_noise", "paper", "ink", "background"];
/// Reads a board of one of [`SHEETS`]; mistakes are added to `problems`.
pub fn read(mut section: Section<'_>, kind: &str, problems: &mut Vec<Problem>) -> Option<Generator> {
    let sheet: Option<SheetWire> = section.take_keys(&COMMON).read(&[], problems);
    // For proposals: the print's keys were taken before.
    let taken = [&COMMON[..], &print::KEYS].concat();
    let (board, usual_margin) = match kind {
        "board" => in_a_word(&section.read(&taken, problems)?, problems)?,
        "charuco" => charuco(&section.read(&taken, problems)?, problems)?,
        "aprilgrid" => aprilgrid(&section.read(&taken, problems)?, problems)?,
        "gridboard" => gridboard(&section.read(&taken, problems)?, problems)?,
        "circles" => circles(&section.read(&taken, problems)?, problems)?,
        "puzzle" => puzzle(&section.read(&taken, problems)?),
        "dotted" => dotted(&section.read(&taken, problems)?),
        _ => rings(&section.read(&taken, problems)?),
    };
    let sheet = sheet?;
    Some(Generator::Board(BoardSheet {
        board,
        margin: sheet.margin.map_or(usual_margin, |margin| margin.0),
        bend: bend(sheet.bend, sheet.bend_across),
        print_noise: sheet.print_noise.map_or(0.0, |noise| noise.0),
        levels: levels(sheet.paper, sheet.ink),
        background: sheet.background.map_or(BACKGROUND, |level| level.0),
    }))
}

/// A board in the words of `--board`.
fn in_a_word(wire: &BoardWire, problems: &mut Vec<Problem>) -> Option<(Board, f64)> {
    let board =
        wire.board.get_ref().parse::<Board>().map_err(|error| problems.push(Problem::new(wire.board.span(), error.to_string()))).ok()?;
    let usual_margin = board.step();
    Some((board, usual_margin))
}

fn dictionary(name: &Spanned<String>, problems: &mut Vec<Problem>) -> Option<&'static Dictionary> {
    let found = Dictionary::named(name.as_ref());
    if found.is_none() {
        let known: Vec<&str> = Dictionary::names().collect();
        let message = format!("`{}` is no dictionary of markers; expected one of {}", name.as_ref(), known.join(", "));
        problems.push(Problem::new(name.span(), message).nearest(name.as_ref(), known));
    }
    found
}

fn charuco(wire: &CharucoWire, problems: &mut Vec<Problem>) -> Option<(Board, f64)> {
    let board = Charuco {
        columns: wire.columns.0,
        rows: wire.rows.0,
        square: wire.square.0,
        marker: wire.marker.0,
        dictionary: dictionary(&wire.dictionary, problems)?,
        first: wire.first.map_or(0, |first| first.0 as u32),
        legacy: wire.legacy.unwrap_or(false),
    };
    Some((Board::Charuco(board), wire.square.0))
}

fn aprilgrid(wire: &AprilGridWire, problems: &mut Vec<Problem>) -> Option<(Board, f64)> {
    let dictionary = match &wire.dictionary {
        Some(name) => dictionary(name, problems)?,
        None => Dictionary::named("DICT_APRILTAG_36h11")?,
    };
    let board = AprilGrid {
        columns: wire.columns.0,
        rows: wire.rows.0,
        tag: wire.tag.0,
        spacing: wire.spacing.map_or(0.3, |spacing| spacing.0),
        dictionary,
        first: wire.first.map_or(0, |first| first.0 as u32),
        border: wire.border.map_or(2, |cells| cells.0),
        squares: wire.squares.unwrap_or(true).then(|| wire.chamfer.map_or(0.0, |cut| cut.0)),
    };
    Some((Board::AprilGrid(board), wire.tag.0))
}

fn gridboard(wire: &GridBoardWire, problems: &mut Vec<Problem>) -> Option<(Board, f64)> {
    let board = GridBoard {
        columns: wire.columns.0,
        rows: wire.rows.0,
        marker: wire.marker.0,
        separation: wire.separation.0,
        dictionary: dictionary(&wire.dictionary, problems)?,
        first: wire.first.map_or(0, |first| first.0 as u32),
        border: wire.border.map_or(1, |cells| cells.0),
    };
    Some((Board::GridBoard(board), wire.marker.0))
}

fn circles(wire: &CirclesWire, problems: &mut Vec<Problem>) -> Option<(Board, f64)> {
    let spacing = wire.spacing.0;
    let marks = match &wire.marks {
        Some(texts) => {
            let parts: Vec<&str> = texts.as_ref().iter().map(String::as_str).collect();
            Marks::read(&parts).map_err(|error| problems.push(Problem::new(texts.span(), error))).ok()?
        }
        None => Marks::default(),
    };
    let board = Circles {
        columns: wire.columns.0,
        rows: wire.rows.0,
        spacing,
        diameter: wire.diameter.map_or(0.5 * spacing, |diameter| diameter.0),
        hole: wire.hole.map(|hole| hole.0),
        asymmetric: wire.asymmetric.unwrap_or(false),
        marks,
    };
    Some((Board::Circles(board), spacing))
}

fn rings(wire: &RingsWire) -> (Board, f64) {
    let board = Rings {
        bits: wire.bits.map_or(12, |bits| bits.0),
        columns: wire.columns.0,
        rows: wire.rows.0,
        spacing: wire.spacing.0,
        diameter: wire.diameter.0,
        ring: wire.ring.map_or([2.0, 3.0], |ring| ring.0),
        even: wire.even.unwrap_or(false),
        first: wire.first.map_or(1, |first| first.0),
    };
    (Board::Rings(board), wire.spacing.0)
}

fn dotted(wire: &DottedWire) -> (Board, f64) {
    let (columns, rows) = (wire.columns.0, wire.rows.0);
    let place = wire.place.map_or(Dotted::middle(columns, rows), |place| place.0);
    let board = Dotted { columns, rows, square: wire.square.0, place, dot: wire.dot.map_or(Dotted::DOT, |dot| dot.0) };
    (Board::Dotted(board), wire.square.0)
}

fn puzzle(wire: &PuzzleWire) -> (Board, f64) {
    let board = Puzzle {
        columns: wire.columns.0,
        rows: wire.rows.0,
        square: wire.square.0,
        place: wire.place.map_or([0, 0], |place| place.0),
        dot: wire.dot.map_or(Puzzle::DOT, |dot| dot.0),
    };
    (Board::Puzzle(board), wire.square.0)
}

/// Reads free-standing markers; mistakes are added to `problems`, places to `spans`.
pub fn read_tags(mut section: Section<'_>, spans: &mut Spans, problems: &mut Vec<Problem>) -> Option<Generator> {
    let before = problems.len();
    let tags = section.take_tables("tag", "[[testfield.tag]]", problems).unwrap_or_default();
    *spans = Spans::of(&section);
    tags.iter().for_each(|inner| spans.add(inner));
    let wire: Option<TagsWire> = section.read(&["tag", "kind", "unit"], problems);
    let tags: Vec<Tag> = tags.into_iter().filter_map(|section| section.read(&[], problems)).map(|wire| tag(&wire)).collect();
    let wire = wire?;
    let dictionary = dictionary(&wire.dictionary, problems)?;
    (problems.len() == before).then(|| {
        Generator::Tags(Tags {
            dictionary,
            border: wire.border.map_or(1, |cells| cells.0),
            rim: wire.rim.map_or(0.25, |rim| rim.0),
            tags,
            levels: levels(wire.paper, wire.ink),
            background: wire.background.map_or(BACKGROUND, |level| level.0),
        })
    })
}

fn tag(wire: &TagWire) -> Tag {
    Tag {
        id: wire.id.0 as u32,
        middle: Point3::from(wire.middle.0),
        right: Vector3::from(wire.right.0),
        up: Vector3::from(wire.up.0),
        side: wire.side.0,
    }
}
