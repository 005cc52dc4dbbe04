//! The `[scene]` table: polygons and targets of a flat image.

use std::ops::Range;

use calibench_diagnostics::Problem;
use calibench_model::{PixelPoint, Polygon, Scene, SceneTarget, TargetKind};
use calibench_synth::overlap::{crosses_itself, overlap};
use toml::Spanned;

use super::section::Section;
use super::sensor::Surroundings;
use super::views::ImagingTables;
use super::wire::{PolygonWire, Position, SceneWire, TargetWire};
use super::{Phase, Pixels, Pointing, SceneSubject, Starts};

/// The largest image, px: 400 megapixels take about 8 GB to render.
const MOST_PIXELS: usize = 400_000_000;

/// The keys of `[scene]` that are tables of their own.
pub const SCENE_TABLES: [&str; 3] = ["polygon", "target", "pointing"];

/// Reads `[scene]`; mistakes are added to `problems`.
pub fn read(mut section: Section<'_>, imaging: ImagingTables<'_>, problems: &mut Vec<Problem>) -> Option<SceneSubject> {
    let polygons = section.take_tables("polygon", "[[scene.polygon]]", problems).unwrap_or_default();
    let targets = section.take_tables("target", "[[scene.target]]", problems).unwrap_or_default();
    let mut pointing = section.take_table("pointing", "[scene.pointing]", problems);
    let before = problems.len();
    let no_map = "a flat scene hands on no map of its targets";
    for (key, why) in [("map_turn", no_map), ("map_stretch", no_map), ("clipped", "a flat scene hides nothing")] {
        if let Some((span, _)) = pointing.as_mut().and_then(|pointing| pointing.take(key)) {
            let problem = Problem::new(span, format!("`{key}` of [scene.pointing]: {why}"));
            problems.push(problem.help("leave it out"));
        }
    }
    let pointed = pointing.is_some();
    let idle = problems.len() > before;
    let pointing = pointing.and_then(|section| Pointing::read(section, problems)).filter(|_| !idle);
    let span = section.span.clone();
    for (missing, list) in [("polygon", polygons.is_empty()), ("target", targets.is_empty())] {
        if list {
            problems.push(Problem::new(span.clone(), format!("[scene] has no {missing}")).help(format!("add a [[scene.{missing}]] table")));
        }
    }
    let read = |sections: Vec<Section<'_>>, problems: &mut Vec<Problem>| {
        sections.into_iter().filter_map(|s| s.read::<PolygonWire>(&[], problems)).collect::<Vec<_>>()
    };
    let polygons = read(polygons, problems);
    let targets: Vec<TargetWire> = targets.into_iter().filter_map(|s| s.read(&[], problems)).collect();
    let wire: SceneWire = section.read(&SCENE_TABLES, problems)?;
    unique(polygons.iter().map(|p| &p.id), "polygon", problems);
    unique(targets.iter().map(|t| &t.id), "target", problems);
    check_size(&wire, problems);
    let (width, height) = (wire.width.get_ref().0, wire.height.get_ref().0);
    let areas = areas(&polygons, problems);
    let mut scene = Scene { width, height, background: wire.background.0, polygons: areas, targets: Vec::new() };
    let mut given = Vec::new();
    for target in &targets {
        given.extend(check_start(target, pointed, pointing.is_some(), problems));
        scene.targets.extend(check_target(target, &scene, problems));
    }
    let phase = wire.phase.unwrap_or_default();
    if phase == Phase::Uniform && !pointed {
        problems
            .push(Problem::new(span, "`phase = \"uniform\"` moves the targets: their starts must move too").help("add [scene.pointing]"));
    }
    let starts = match pointing {
        Some(pointing) => Starts::of_drawing(pointing, problems)?,
        None => Starts::Given(given),
    };
    let pixels = wire.pixels.unwrap_or_default();
    check_imaging(&imaging, pixels, &wire, problems);
    let imaging = imaging.read(&surroundings(&scene), problems)?;
    Some(SceneSubject {
        scene,
        starts,
        pixels,
        bits: wire.bits.map(|bits| bits.0),
        grey_noise: wire.grey_noise.map_or(0.0, |n| n.0),
        phase,
        imaging,
    })
}

/// Drawn pixels have no lens, and a sensor's noise and levels are its own.
fn check_imaging(imaging: &ImagingTables<'_>, pixels: Pixels, wire: &SceneWire, problems: &mut Vec<Problem>) {
    if let Some(span) = imaging.span().filter(|_| pixels == Pixels::Centre) {
        problems.push(Problem::new(span, "[optics] or [sensor] beside `pixels = \"centre\"`: drawn pixels have neither"));
    }
    if let Some(span) = imaging.sensor_span().filter(|_| wire.bits.is_some() || wire.grey_noise.is_some()) {
        problems.push(Problem::new(span, "[sensor] beside `bits` or `grey_noise` of [scene]: expected them in [sensor]"));
    }
}

/// What a sensor's signal-to-noise ratios refer to.
pub fn surroundings(scene: &Scene) -> Surroundings {
    let levels = || scene.polygons.iter().map(|polygon| polygon.grey).chain([scene.background]);
    let (low, high) = (levels().fold(f64::INFINITY, f64::min), levels().fold(f64::NEG_INFINITY, f64::max));
    Surroundings { contrast: Some(high - low), mean: Some(0.5 * (high + low)), ..Surroundings::default() }
}

fn unique<'a>(ids: impl Iterator<Item = &'a Spanned<String>>, what: &str, problems: &mut Vec<Problem>) {
    let mut seen: Vec<&str> = Vec::new();
    for id in ids {
        if id.get_ref().trim().is_empty() || id.get_ref().chars().any(char::is_control) {
            problems.push(Problem::new(id.span(), format!("the id of a {what} is a name, found {:?}", id.get_ref())));
        }
        if seen.contains(&id.get_ref().as_str()) {
            problems.push(Problem::new(id.span(), format!("{what} `{}` stands here a second time; expected each id once", id.get_ref())));
        }
        seen.push(id.get_ref());
    }
}

fn check_size(wire: &SceneWire, problems: &mut Vec<Problem>) {
    let (width, height) = (wire.width.get_ref().0, wire.height.get_ref().0);
    if width * height > MOST_PIXELS {
        let gigabytes = width as f64 * height as f64 * 20.0 / 1e9;
        let message = format!("an image of {width} x {height} px needs about {gigabytes:.0} GB: expected at most 400 megapixels");
        problems.push(Problem::new(span_of_both(wire.width.span(), wire.height.span()), message));
    }
}

fn span_of_both(a: Range<usize>, b: Range<usize>) -> Range<usize> {
    a.start.min(b.start)..a.end.max(b.end)
}

fn point(at: &Position) -> PixelPoint {
    PixelPoint::new(at.0, at.1)
}

fn areas(wires: &[PolygonWire], problems: &mut Vec<Problem>) -> Vec<Polygon> {
    let mut areas: Vec<Polygon> = Vec::new();
    for wire in wires {
        let vertices: Vec<PixelPoint> = wire.vertices.get_ref().iter().map(point).collect();
        let (span, count) = (wire.vertices.span(), vertices.len());
        let area = Polygon { id: wire.id.get_ref().clone(), vertices, grey: wire.grey.0 };
        let wrong = if count < 3 {
            Some(format!("a polygon has at least 3 vertices, found {count}"))
        } else if area.doubled_area().abs() < 1e-9 {
            Some("the polygon has no area".to_owned())
        } else if let Some(at) = crosses_itself(&area) {
            Some(format!("the polygon crosses or touches itself at ({}, {})", at.x, at.y))
        } else {
            let met = areas.iter().find_map(|other| overlap(&area, other).map(|at| (other, at)));
            met.map(|(other, at)| format!("polygon `{}` overlaps polygon `{}` at ({:.3}, {:.3})", area.id, other.id, at.x, at.y))
        };
        match wrong {
            Some(message) => problems.push(Problem::new(span, message)),
            None => areas.push(area),
        }
    }
    areas
}

/// The start that a target gives; `conflict` if one beside [scene.pointing] is to be reported, which a mistake in that table makes idle.
fn check_start(wire: &TargetWire, pointed: bool, conflict: bool, problems: &mut Vec<Problem>) -> Option<PixelPoint> {
    match (&wire.start, pointed) {
        (Some(start), false) => Some(point(start.get_ref())),
        (None, true) => None,
        (Some(_), true) if !conflict => None,
        (Some(start), true) => {
            problems.push(Problem::new(start.span(), "`start` beside [scene.pointing]: expected one of them"));
            None
        }
        (None, false) => {
            let problem = Problem::new(wire.id.span(), format!("target `{}` has no `start`", wire.id.get_ref()));
            problems.push(problem.help("give its `start`, or say in [scene.pointing] how a hand points at it"));
            None
        }
    }
}

fn check_target(wire: &TargetWire, scene: &Scene, problems: &mut Vec<Problem>) -> Option<SceneTarget> {
    let at = point(wire.at.get_ref());
    let kind = wire.kind.get_ref().parse::<TargetKind>();
    let kind = kind.map_err(|error| {
        let names = TargetKind::ALL.map(TargetKind::name);
        problems.push(Problem::new(wire.kind.span(), error.to_string()).nearest(wire.kind.get_ref(), names));
    });
    let corner = at.to_corner();
    if corner.x < 0.0 || corner.y < 0.0 || corner.x > scene.width as f64 || corner.y > scene.height as f64 {
        let message = format!("target `{}` lies outside the image of {} x {} px", wire.id.get_ref(), scene.width, scene.height);
        problems.push(Problem::new(wire.at.span(), message));
    } else if matches!(kind, Ok(TargetKind::Corner | TargetKind::ChessCorner)) {
        let vertices = scene.polygons.iter().flat_map(|polygon| &polygon.vertices);
        let nearest = vertices.min_by(|a, b| a.distance(at).total_cmp(&b.distance(at)));
        if let Some(vertex) = nearest.filter(|vertex| vertex.distance(at) > 1e-9) {
            let message = format!("target `{}` at ({}, {}) is no vertex of a polygon", wire.id.get_ref(), at.x, at.y);
            problems.push(Problem::new(wire.at.span(), message).help(format!("the nearest vertex is ({}, {})", vertex.x, vertex.y)));
        }
    }
    Some(SceneTarget { id: wire.id.get_ref().clone(), kind: kind.ok()?, at })
}
