//! From the tables of a file to checked figures.

use std::ops::Range;

use calibench_diagnostics::Problem;
use calibench_model::camera::{Fold, ImageSize, Photogrammetric, fold};
use calibench_model::convert::{Tangential, Tool, from_naive};
use nalgebra::{Point3, Vector3};
use toml::Spanned;

use super::wire::{AbsoluteError, CameraWire, GridWire, NetworkWire, PixelWire, PointWire, PrintedWire, VariantWire};
use super::{CheckPoint, Column, Grid, NETWORK, NetworkPlan, Printed, SENSOR, Turned, Variant};
use crate::Unit;
use crate::section::Section;
use crate::testfield::wire::{Height, Length};

/// Tables below `[printed]`.
const TABLES: [&str; 6] = ["pixel", "camera", "grid", "point", "network", "variant"];

/// The names of the tools whose conventions there are.
fn tools() -> [&'static str; 4] {
    Tool::ALL.map(|(_, name)| name)
}

/// Reads the table.
pub fn read(mut section: Section<'_>, problems: &mut Vec<Problem>) -> Option<Printed> {
    let (before, span) = (problems.len(), section.span.clone());
    let pitches = section.take_tables("pixel", "[[printed.pixel]]", problems).unwrap_or_default();
    let cameras = section.take_tables("camera", "[[printed.camera]]", problems).unwrap_or_default();
    let grids = section.take_tables("grid", "[[printed.grid]]", problems).unwrap_or_default();
    let points = section.take_tables("point", "[[printed.point]]", problems).unwrap_or_default();
    let network = section.take_table("network", "[printed.network]", problems);
    let variants = section.take_tables("variant", "[[printed.variant]]", problems).unwrap_or_default();
    let head: PrintedWire = section.read(&TABLES, problems)?;
    let mut names = Names::default();
    let pitches: Vec<_> = pitches.into_iter().filter_map(|section| pitch(section, problems)).collect();
    let cameras: Vec<Column> = cameras.into_iter().filter_map(|section| camera(section, &head, &mut names, problems)).collect();
    if cameras.is_empty() && problems.len() == before {
        problems.push(Problem::new(span.clone(), "[printed] has no camera").help("add a [[printed.camera]] with `name` and `c`"));
    }
    if problems.len() > before {
        return None;
    }
    let (mut point_names, mut grid_names) = (Names::default(), Names::default());
    let grids: Vec<_> = grids.into_iter().filter_map(|section| grid(section, &cameras, &mut grid_names, problems)).collect();
    let listed = points.len();
    let points: Vec<_> = points.into_iter().filter_map(|section| point(section, &cameras, &mut point_names, problems)).collect();
    let variants: Vec<_> = variants.into_iter().filter_map(|section| variant(section, &cameras, &mut names, problems)).collect();
    let network = network.map(|section| network_plan(section, &cameras, listed, problems));
    if let (None, Some(stray)) = (&network, variants.iter().find(|variant| variant.refit)) {
        let message = format!("`{}` is to be fitted again, and there is no network: expected [printed.network]", stray.name);
        problems.push(Problem::new(span, message));
    }
    let network = network.map_or(Some(None), |read| read.map(Some))?;
    let (distance, unit) = (head.distance.0, named_unit(&head.unit, problems)?);
    (problems.len() == before).then_some(Printed { distance, unit, pitches, cameras, grids, points, network, variants })
}

fn named_unit(name: &Spanned<String>, problems: &mut Vec<Problem>) -> Option<Unit> {
    let found = [Unit::Millimetre, Unit::Metre].into_iter().find(|unit| unit.name() == name.get_ref());
    if found.is_none() {
        problems.push(Problem::new(name.span(), format!("no unit is called `{}`: expected mm or m", name.get_ref())));
    }
    found
}

/// Names that stand once.
#[derive(Default)]
struct Names(Vec<String>);

impl Names {
    fn add(&mut self, name: &Spanned<String>, problems: &mut Vec<Problem>) -> String {
        let text = name.get_ref().clone();
        if text.trim().is_empty() {
            problems.push(Problem::new(name.span(), "`name` is empty: expected a name"));
        } else if self.0.contains(&text) || [SENSOR, NETWORK].contains(&text.as_str()) {
            problems.push(Problem::new(name.span(), format!("`{text}` stands twice: expected each name once")));
        }
        self.0.push(text.clone());
        text
    }
}

fn pitch(section: Section<'_>, problems: &mut Vec<Problem>) -> Option<(String, f64)> {
    let wire: PixelWire = section.read(&[], problems)?;
    let mm = wire.mm.0 * wire.times.map_or(1.0, |times| times.0);
    Some((wire.name.into_inner(), mm * 1e3 / wire.pixels.0 as f64))
}

fn camera(section: Section<'_>, head: &PrintedWire, names: &mut Names, problems: &mut Vec<Problem>) -> Option<Column> {
    let wire: CameraWire = section.read(&[], problems)?;
    let name = names.add(&wire.name, problems);
    let size = ImageSize { width: head.width.0 as u32, height: head.height.0 as u32 };
    let pitch_um = head.pitch.0;
    let tool = match &wire.tool {
        None => None,
        Some(name) => Some(tool(name, problems)?),
    };
    let camera = Photogrammetric {
        size,
        pitch_um,
        c: wire.c.0,
        x0: wire.x0.map_or(0.0, |x0| x0.0),
        y0: wire.y0.map_or(0.0, |y0| y0.0),
        k: wire.k.map_or([0.0; 3], |k| k.map(|k| k.0)),
        p: wire.p.map_or([0.0; 2], |p| p.map(|p| p.0)),
        b: [0.0; 2],
    };
    Some(Column { name, camera, tool })
}

fn tool(name: &Spanned<String>, problems: &mut Vec<Problem>) -> Option<Tool> {
    let found = Tool::named(name.get_ref());
    if found.is_none() {
        let message = format!("no tool is called `{}`: expected one of {}", name.get_ref(), tools().join(", "));
        problems.push(Problem::new(name.span(), message).nearest(name.get_ref(), tools()));
    }
    found
}

fn grid(section: Section<'_>, cameras: &[Column], names: &mut Names, problems: &mut Vec<Problem>) -> Option<Grid> {
    let wire: GridWire = section.read(&[], problems)?;
    let name = names.add(&wire.name, problems);
    let base = cameras[place(&wire.camera, cameras, problems)?].camera;
    let k = wire.k.map_or(base.k, |k| k.map(|k| k.0));
    let camera = Photogrammetric { k, p: wire.p.map_or(base.p, |p| p.map(|p| p.0)), ..base };
    if let Some(Fold { radius_px, .. }) = fold(&camera) {
        let message =
            format!("`{name}` folds over inside the frame, {radius_px:.0} px from its axis: a grid needs a camera that is one to one");
        problems.push(Problem::new(wire.name.span(), message));
    } else if camera.k == [0.0; 3] && camera.p == [0.0; 2] {
        problems.push(Problem::new(wire.name.span(), format!("`{name}` has no distortion to show: give `k` or `p`")));
    }
    Some(Grid { name, camera })
}

fn point(section: Section<'_>, cameras: &[Column], names: &mut Names, problems: &mut Vec<Problem>) -> Option<CheckPoint> {
    let wire: PointWire = section.read(&[], problems)?;
    let name = names.add(&wire.name, problems);
    let at = Point3::from(wire.at.map(|value| value.0));
    let given = wire.errors.get_ref();
    for column in given.keys() {
        place(column, cameras, problems);
    }
    let of = |column: &Column| {
        given.iter().find(|(name, _)| *name.get_ref() == column.name).map(|(_, errors)| errors.map(|e: AbsoluteError| e.0))
    };
    let missing: Vec<&str> = cameras.iter().filter(|column| of(column).is_none()).map(|column| column.name.as_str()).collect();
    if !missing.is_empty() {
        problems.push(Problem::new(
            wire.errors.span(),
            format!("point `{name}` has no errors of {}: expected X, Y, Z of every camera", missing.join(", ")),
        ));
        return None;
    }
    Some(CheckPoint { name, at, errors: cameras.iter().filter_map(of).collect() })
}

/// The place of the camera that is called so.
fn place(name: &Spanned<String>, cameras: &[Column], problems: &mut Vec<Problem>) -> Option<usize> {
    let found = cameras.iter().position(|column| column.name == *name.get_ref());
    if found.is_none() {
        let problem = Problem::new(name.span(), format!("no camera is called `{}`", name.get_ref()));
        problems.push(problem.nearest(name.get_ref(), cameras.iter().map(|column| column.name.as_str())));
    }
    found
}

fn variant(section: Section<'_>, cameras: &[Column], names: &mut Names, problems: &mut Vec<Problem>) -> Option<Variant> {
    let wire: VariantWire = section.read(&[], problems)?;
    let name = names.add(&wire.name, problems);
    let of = place(&wire.camera, cameras, problems)?;
    let base = cameras[of].camera;
    let mut k = wire.k.map_or(base.k, |k| k.map(|k| k.0));
    if let Some(powers) = wire.powers {
        for (index, (k, power)) in k.iter_mut().zip(powers).enumerate() {
            *k *= base.c.powi(2 * (index as i32 + 1) - power.0);
        }
    }
    let camera = Photogrammetric {
        c: wire.c.map_or(base.c, |c| c.0),
        x0: wire.x0.map_or(base.x0, |x0| x0.0),
        y0: wire.y0.map_or(base.y0, |y0| y0.0),
        k,
        p: wire.p.map_or(base.p, |p| p.map(|p| p.0)),
        ..base
    };
    let turned_truth = wire.turned_truth.map(|names| turned(&names, problems));
    let turned_columns = turned(&wire.turned_columns.unwrap_or_default(), problems);
    let refit = wire.refit.unwrap_or(false);
    if !refit && (turned_truth.is_some() || turned_columns != Turned::default()) {
        problems.push(Problem::new(wire.name.span(), format!("`{name}` turns signs of the network's cameras: expected `refit = true`")));
    }
    Some(Variant { name, of, camera, refit, turned_truth, turned_columns })
}

fn turned(names: &[Spanned<String>], problems: &mut Vec<Problem>) -> Turned {
    let mut turned = Turned::default();
    for name in names {
        match name.get_ref().as_str() {
            "x0" => turned.x0 = true,
            "y0" => turned.y0 = true,
            "p1" => turned.p[0] = true,
            "p2" => turned.p[1] = true,
            other => problems.push(
                Problem::new(name.span(), format!("`{other}` has no sign to turn: expected x0, y0, p1 or p2"))
                    .nearest(other, Turned::NAMES),
            ),
        }
    }
    turned
}

fn network_plan(section: Section<'_>, cameras: &[Column], points: usize, problems: &mut Vec<Problem>) -> Option<NetworkPlan> {
    let (before, span) = (problems.len(), section.span.clone());
    let wire: NetworkWire = section.read(&[], problems)?;
    let truth = place(&wire.truth, cameras, problems);
    let fitted: Vec<usize> = wire.fitted.get_ref().iter().filter_map(|name| place(name, cameras, problems)).collect();
    if wire.fitted.get_ref().is_empty() {
        problems.push(Problem::new(wire.fitted.span(), "`fitted` is empty: expected cameras whose errors determine the network"));
    }
    if points < 3 {
        problems.push(Problem::new(span, format!("a network takes 3 check points at least, found {points}")));
    }
    let turned_truth = turned(&wire.turned_truth.unwrap_or_default(), problems);
    one_to_one(truth.map(|truth| (&cameras[truth], turned_truth)), wire.truth.span(), problems);
    let from = unit(&wire.from, "from", problems);
    let up = unit(&wire.up, "up", problems);
    let (from, up) = (from?, up?);
    let Some(up) = (up - from * from.dot(&up)).try_normalize(1e-6) else {
        problems.push(Problem::new(wire.up.span(), "`up` lies along `from`: expected another direction"));
        return None;
    };
    let distances = lengths(&wire.distances, "distances", problems);
    let bases = lengths(&wire.bases, "bases", problems);
    let heights = match &wire.heights {
        None => vec![0.0],
        Some(heights) if heights.get_ref().is_empty() => {
            problems.push(Problem::new(heights.span(), "`heights` is empty: expected where a fit starts"));
            Vec::new()
        }
        Some(heights) => heights.get_ref().iter().map(|height| height.0).collect(),
    };
    let (stations, within) = (wire.stations.get_ref().0, wire.within.0);
    (problems.len() == before).then_some(NetworkPlan {
        truth: truth?,
        turned_truth,
        stations,
        from,
        up,
        fitted,
        distances,
        bases,
        heights,
        within,
    })
}

/// The true camera pictures the whole frame.
fn one_to_one(truth: Option<(&Column, Turned)>, span: Range<usize>, problems: &mut Vec<Problem>) {
    let Some((column @ Column { name, camera, .. }, turned)) = truth else { return };
    let Some(target) = column.target() else {
        let problem = Problem::new(span, format!("`{name}` has no tool: a true camera is a tool's own"));
        problems.push(problem.help(format!("add `tool`, one of {}", tools().join(", "))));
        return;
    };
    match from_naive(&turned.of(camera), target, Tangential::Converted) {
        Err(error) => problems.push(Problem::new(span, format!("`{name}`: {error}"))),
        Ok(own) => {
            if let Some(fold) = fold(&own) {
                let mm = fold.radius_px * camera.pitch_um * 1e-3;
                let message = format!("`{name}` folds over inside the frame, {mm:.1} mm from its axis: a true camera is one to one");
                problems.push(Problem::new(span, message));
            }
        }
    }
}

fn unit(direction: &Spanned<[Height; 3]>, key: &str, problems: &mut Vec<Problem>) -> Option<Vector3<f64>> {
    let unit = Vector3::from(direction.get_ref().map(|value| value.0)).try_normalize(1e-9);
    if unit.is_none() {
        problems.push(Problem::new(direction.span(), format!("`{key}` is no direction: expected one that is not zero")));
    }
    unit
}

fn lengths(list: &Spanned<Vec<Length>>, key: &str, problems: &mut Vec<Problem>) -> Vec<f64> {
    if list.get_ref().is_empty() {
        problems.push(Problem::new(list.span(), format!("`{key}` is empty: expected where a fit starts")));
    }
    list.get_ref().iter().map(|length| length.0).collect()
}
