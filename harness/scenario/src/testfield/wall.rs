//! The wall: `[[testfield.plate]]`, `[[testfield.target]]`, `[testfield.panels]` and `[testfield.fill]`.

use calibench_diagnostics::Problem;
use calibench_model::TargetKind;
use calibench_synth::testfield::{Arrangement, Fill, Panels, Shape, Sheet, Turn, Wall, WallTarget};
use nalgebra::{Point3, Vector3};
use toml::Spanned;

use super::common::{BACKGROUND, bend, levels};
use super::generator::Generator;
use super::spans::Spans;
use super::wire::{Degrees, FillWire, Fraction, PanelsWire, PlateWire, WallTargetWire, WallWire};
use crate::section::Section;

/// The tables within, for proposals.
const TABLES: [&str; 6] = ["plate", "target", "panels", "fill", "kind", "unit"];
/// Kinds that can be put on a wall.
const SHAPES: [&str; 6] = ["cross", "chess_corner", "disc", "square", "triangle", "corner"];

/// Reads a wall; mistakes are added to `problems`, places to `spans`.
pub fn read(mut section: Section<'_>, spans: &mut Spans, problems: &mut Vec<Problem>) -> Option<Generator> {
    let before = problems.len();
    let plates = section.take_tables("plate", "[[testfield.plate]]", problems).unwrap_or_default();
    let targets = section.take_tables("target", "[[testfield.target]]", problems).unwrap_or_default();
    let panels = section.take_table("panels", "[testfield.panels]", problems);
    let fill = section.take_table("fill", "[testfield.fill]", problems);
    *spans = Spans::of(&section);
    plates.iter().chain(&targets).chain(&panels).chain(&fill).for_each(|inner| spans.add(inner));
    let wire: Option<WallWire> = section.read(&TABLES, problems);
    let sheets: Vec<Sheet> = plates.into_iter().filter_map(|plate| plate.read(&[], problems)).map(|wire| sheet(&wire)).collect();
    let targets: Vec<WallTarget> = targets.into_iter().filter_map(|section| target(section.read(&[], problems)?, problems)).collect();
    let panels = panels.and_then(|panels| panels.read(&[], problems)).map(|wire| panelled(&wire));
    let fill = fill.and_then(|section| read_fill(section, problems));
    if problems.len() > before {
        return None;
    }
    let wire = wire?;
    let wall = Wall {
        sheets,
        targets,
        fill,
        survey_sigma: wire.survey_sigma.map_or(0.0, |sigma| sigma.0),
        background: wire.background.map_or(BACKGROUND, |level| level.0),
    };
    Some(Generator::Wall(wall, panels))
}

fn sheet(wire: &PlateWire) -> Sheet {
    Sheet {
        id: wire.id.clone(),
        middle: Point3::from(wire.middle.0),
        u: Vector3::from(wire.right.0),
        v: Vector3::from(wire.up.0),
        size: [wire.width.0, wire.height.0],
        bend: bend(wire.bend, wire.bend_across),
        levels: levels(wire.paper, wire.ink),
        shift: wire.shift.map_or(Vector3::zeros(), |shift| Vector3::from(shift.0)),
    }
}

fn panelled(wire: &PanelsWire) -> Panels {
    Panels {
        rows: wire.rows.0,
        columns: wire.columns.0,
        size: [wire.width.0, wire.height.0],
        gap: wire.gap.0,
        relief: wire.relief.map_or(0.0, |relief| relief.0),
        tilt: wire.tilt.map_or(0.0, |tilt| tilt.0.to_radians()),
        levels: levels(wire.paper, wire.ink),
    }
}

fn target(wire: WallTargetWire, problems: &mut Vec<Problem>) -> Option<WallTarget> {
    let angles = [wire.angle.unwrap_or(Degrees(90.0))];
    let shape = shapes(wire.kind.get_ref(), wire.kind.span(), &angles, wire.bar, problems)?.pop()?;
    Some(WallTarget {
        id: wire.id,
        plate: wire.plate,
        shape,
        at: wire.at.0,
        size: wire.size.0,
        turn: wire.turn.map_or(0.0, |turn| turn.0.to_radians()),
        surveyed: wire.surveyed.map(|at| Point3::from(at.0)),
    })
}

fn read_fill(section: Section<'_>, problems: &mut Vec<Problem>) -> Option<Fill> {
    let span = section.span.clone();
    let wire: FillWire = section.read(&[], problems)?;
    let arrangement = match (wire.rows, wire.columns, wire.count, wire.distance) {
        (Some(rows), Some(columns), None, None) => Arrangement::Grid { rows: rows.0, columns: columns.0 },
        (None, None, Some(count), Some(distance)) => Arrangement::Random { count: count.0, distance: distance.0 },
        _ => {
            let problem = Problem::new(span, "[testfield.fill] does not say where the targets are");
            problems.push(problem.help("give `rows` and `columns` for a grid, or `count` and `distance` for random places"));
            return None;
        }
    };
    let kinds = listed(&wire.kinds, problems)?;
    let angles = wire.angles.unwrap_or_else(|| vec![Degrees(90.0)]);
    let mut all = Vec::new();
    for kind in kinds {
        all.extend(shapes(kind, wire.kinds.span(), &angles, wire.bar, problems)?);
    }
    let turn = wire.turn.map_or(Turn::Random, |turn| Turn::Fixed(turn.0.to_radians()));
    Some(Fill { shapes: all, size: wire.size.0, arrangement, turn })
}

fn listed<'a>(kinds: &'a Spanned<Vec<String>>, problems: &mut Vec<Problem>) -> Option<&'a [String]> {
    if kinds.get_ref().is_empty() {
        problems.push(Problem::new(kinds.span(), "`kinds` is empty: expected at least one kind of target"));
        return None;
    }
    Some(kinds.get_ref())
}

/// The shapes of a kind: one, or for corners one for each angle.
fn shapes(
    kind: &str,
    span: std::ops::Range<usize>,
    angles: &[Degrees],
    bar: Option<Fraction>,
    problems: &mut Vec<Problem>,
) -> Option<Vec<Shape>> {
    let shapes = match kind.parse::<TargetKind>() {
        Ok(TargetKind::Cross) => vec![Shape::Cross { bar: bar.map_or(calibench_model::target::BAR, |bar| bar.0) }],
        Ok(TargetKind::ChessCorner) => vec![Shape::Chess],
        Ok(TargetKind::Disc) => vec![Shape::Disc],
        Ok(TargetKind::Square) => vec![Shape::Square],
        Ok(TargetKind::Triangle) => vec![Shape::Triangle],
        Ok(TargetKind::Corner) => angles.iter().map(|angle| Shape::Corner { angle: angle.0.to_radians() }).collect(),
        Ok(TargetKind::Junction) | Err(_) => {
            let message = format!("no target of a wall is a `{kind}`; expected one of {}", SHAPES.join(", "));
            problems.push(Problem::new(span, message).nearest(kind, SHAPES));
            return None;
        }
    };
    Some(shapes)
}
