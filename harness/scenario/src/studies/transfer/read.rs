//! Reading `[transfer]` and its tables.

use calibench_diagnostics::Problem;
use calibench_measure::Registry;
use calibench_model::camera::{Camera, CameraModel, fold};
use nalgebra::{Point3, Vector3};
use toml::Spanned;

use super::method::{Told, method};
use super::wire::{CaseWire, Conversion, DecompositionWire, Names, Poses, TransferWire};
use super::{Calibrates, Case, Conditions, Decomposition, Method, Site, Sites, Transfer, board, operator};
use crate::section::Section;
use crate::studies::{filled, matched};

/// The tables within, for proposals.
const TABLES: [&str; 4] = ["board", "method", "case", "decomposition"];
/// The fewest stations from which points are intersected.
const LEAST_STATIONS: usize = 2;
/// The fewest control points: an image is resected from as many.
const LEAST_CONTROL: usize = 4;
/// How far from a line control must lie, as a fraction of its length.
const OFF_LINE: f64 = 1e-3;

/// Reads the tables; the first that is asked of `sites` is where calibrations are applied.
pub(crate) fn read(mut section: Section<'_>, registry: &Registry, sites: &mut Sites<'_>, problems: &mut Vec<Problem>) -> Option<Transfer> {
    let before = problems.len();
    let span = section.span.clone();
    let board = section.take_table("board", "[transfer.board]", problems);
    let listed = section.take_tables("method", "[[transfer.method]]", problems).unwrap_or_default();
    let cases = section.take_tables("case", "[[transfer.case]]", problems).unwrap_or_default();
    let splits = section.take_tables("decomposition", "[[transfer.decomposition]]", problems).unwrap_or_default();
    for (name, none) in [("[[transfer.method]]", listed.is_empty()), ("[[transfer.case]]", cases.is_empty())] {
        if none {
            problems.push(Problem::new(span.clone(), format!("[transfer] without a {name}: expected at least one")));
        }
    }
    let wire: TransferWire = section.read(&TABLES, problems)?;
    let views = sites(&wire.apply).map_err(|why| problems.push(Problem::new(wire.apply.span(), why))).ok()?;
    check_camera(&views.camera, &wire, problems);
    let [stations, control, check] = points(&wire, &views, problems);
    let board = match board {
        Some(section) => Some(board::read(section, views.camera.size(), sites, problems)?),
        None => None,
    };
    let measured_by = wire.measured_by.as_ref().and_then(|text| operator::read(text, false, registry, problems));
    let told = Told { wire: &wire, camera: &views.camera, board: board.as_ref(), registry };
    let mut methods: Vec<Method> = Vec::new();
    let mut broken = false;
    for section in listed {
        let found = method(section, &told, &methods, problems);
        broken |= found.is_none();
        methods.extend(found);
    }
    if broken {
        return None;
    }
    let poses_of = poses_of(&wire.poses_of, &methods, problems);
    let names: Vec<&str> = methods.iter().map(|method| method.name.as_str()).collect();
    let mut applied = Applied {
        methods: &names,
        stations: views.stations.iter().map(|station| station.name.as_str()).collect(),
        seen: &stations,
        networks: Vec::new(),
        bend: board.as_ref().map_or(0.0, |board| board.bend),
        drawn: measured_by.is_none(),
    };
    let mut found: Vec<Case> = Vec::new();
    for section in cases {
        found.extend(applied.case(section, &found, problems));
    }
    let mut decompositions: Vec<Decomposition> = Vec::new();
    for section in splits {
        let taken: Vec<&str> =
            found.iter().map(|case| case.name.as_str()).chain(decompositions.iter().map(|split| split.name.as_str())).collect();
        let split = applied.decomposition(section, &taken, problems);
        decompositions.extend(split);
    }
    if problems.len() > before {
        return None;
    }
    let (width, networks) = (f64::from(views.camera.size().width), applied.networks);
    Some(Transfer {
        stations,
        control,
        check,
        networks,
        sigma_px: wire.sigma_px.0,
        measured_by,
        survey_sigma: wire.survey_sigma.0,
        pitch_um: wire.pitch.get_ref().0,
        other_pitch_um: wire.sensor_width.map(|mm| 1e3 * mm.get_ref().0 / width),
        board: board.map(|board| board.board),
        methods,
        poses_of: poses_of?,
        cases: found,
        decompositions,
    })
}

/// Whether the camera that is true can be: one to one over the frame, and of a model whose focus can be changed.
fn check_camera(camera: &Camera, wire: &TransferWire, problems: &mut Vec<Problem>) {
    let file = wire.apply.get_ref();
    if let Some(fold) = fold(camera) {
        let share = 100.0 * fold.share;
        let message = format!(
            "the camera of `{file}` folds over inside its frame, {:.0} px from the principal point: {share:.1} % of it have no ray",
            fold.radius_px
        );
        problems.push(Problem::new(wire.apply.span(), message));
    }
    if !matches!(camera, Camera::Agisoft(_) | Camera::OpenCv(_) | Camera::Pix4d(_) | Camera::Photogrammetric(_)) {
        let message = format!(
            "the camera of `{file}` is of the model {}: expected metashape, opencv, pix4d or photogrammetric",
            camera.convention().name
        );
        problems.push(Problem::new(wire.apply.span(), message));
    }
}

/// Stations, control and check points by their places.
fn points(wire: &TransferWire, views: &Site, problems: &mut Vec<Problem>) -> [Vec<usize>; 3] {
    let stations: Vec<&str> = views.stations.iter().map(|station| station.name.as_str()).collect();
    let targets: Vec<&str> = views.field.targets.iter().map(|target| target.id.as_str()).collect();
    let before = problems.len();
    let seen = match &wire.stations {
        Some(patterns) => {
            filled("stations", Some(patterns), problems);
            matched("station", patterns.get_ref(), &stations, problems)
        }
        None => (0..stations.len()).collect(),
    };
    if seen.len() < LEAST_STATIONS && problems.len() == before {
        let at = wire.stations.as_ref().map_or(wire.apply.span(), Spanned::span);
        problems.push(Problem::new(at, format!("calibrations are applied in {} stations: expected at least {LEAST_STATIONS}", seen.len())));
    }
    filled("check", Some(&wire.check), problems);
    let before = problems.len();
    let control = matched("target", wire.control.get_ref(), &targets, problems);
    let check = matched("target", wire.check.get_ref(), &targets, problems);
    if let Some(&both) = check.iter().find(|point| control.contains(point)) {
        problems.push(Problem::new(
            wire.check.span(),
            format!("`{}` is a control point and a check point: expected one of them", targets[both]),
        ));
    }
    let places: Vec<Point3<f64>> = control.iter().map(|&target| views.field.targets[target].surveyed).collect();
    if problems.len() == before && control.len() < LEAST_CONTROL {
        problems.push(Problem::new(wire.control.span(), format!("{} control points: expected at least {LEAST_CONTROL}", control.len())));
    } else if problems.len() == before && is_line(&places) {
        problems.push(Problem::new(
            wire.control.span(),
            "all control points lie on a line: expected some beside it, a line determines no pose",
        ));
    }
    [seen, control, check]
}

fn is_line(points: &[Point3<f64>]) -> bool {
    let farthest = |of: &dyn Fn(&Point3<f64>) -> f64| points.iter().map(of).fold(0.0, f64::max);
    let length = farthest(&|point| (point - points[0]).norm());
    let end = points.iter().find(|point| (*point - points[0]).norm() == length);
    let along = end.and_then(|end| (end - points[0]).try_normalize(0.0)).unwrap_or_else(Vector3::x);
    farthest(&|point| (point - points[0]).cross(&along).norm()) <= OFF_LINE * length
}

fn poses_of(name: &Spanned<String>, methods: &[Method], problems: &mut Vec<Problem>) -> Option<usize> {
    let found = methods.iter().position(|method| method.name == *name.get_ref());
    let problem = match found {
        None => Problem::new(name.span(), format!("no method is called `{}`", name.get_ref()))
            .nearest(name.get_ref(), methods.iter().map(|method| method.name.as_str())),
        Some(place) if methods[place].calibrates != Calibrates::FromControl => Problem::new(
            name.span(),
            format!("`{}` has no exterior orientations there: expected a method with `from = \"control\"`", name.get_ref()),
        ),
        found => return found,
    };
    problems.push(problem);
    None
}

/// What cases and decompositions are read with.
struct Applied<'a> {
    methods: &'a [&'a str],
    stations: Vec<&'a str>,
    /// The stations from which check points are intersected.
    seen: &'a [usize],
    networks: Vec<Vec<usize>>,
    bend: f64,
    /// Whether coordinates are drawn.
    drawn: bool,
}

impl Applied<'_> {
    fn case(&mut self, section: Section<'_>, earlier: &[Case], problems: &mut Vec<Problem>) -> Option<Case> {
        let before = problems.len();
        let wire: CaseWire = section.read(&[], problems)?;
        let name = wire.name.get_ref().clone();
        if earlier.iter().any(|other| other.name == name) {
            problems.push(Problem::new(wire.name.span(), format!("the name `{name}` is taken: expected each once")));
        }
        if let Some(sigma) = wire.board_sigma_px.as_ref().filter(|_| !self.drawn) {
            let message = "`board_sigma_px` is of corners that are drawn: expected no `measured_by` in [transfer]";
            problems.push(Problem::new(sigma.span(), message));
        }
        let conditions = Conditions {
            measurement: wire.measurement.unwrap_or(true),
            survey: wire.survey.unwrap_or(true),
            naive: wire.conversion == Some(Conversion::Naive),
            held: wire.poses == Poses::Held,
            pitch_um: wire.pitch.map(|pitch| pitch.0),
            principal_point: wire.principal_point.map_or([0.0; 2], |at| at.0),
            bend: wire.bend.map_or(self.bend, |bend| bend.0),
            refocus: wire.refocus.map_or(0.0, |mm| mm.0),
            board_sigma_px: wire.board_sigma_px.map(|sigma| sigma.get_ref().0),
            network: self.network(wire.stations.as_ref(), problems),
        };
        let methods = match &wire.methods {
            Some(patterns) => matched("method", patterns.get_ref(), self.methods, problems),
            None => (0..self.methods.len()).collect(),
        };
        (problems.len() == before).then_some(Case { name, methods, conditions, points: wire.points.unwrap_or(false) })
    }

    fn decomposition(&mut self, section: Section<'_>, taken: &[&str], problems: &mut Vec<Problem>) -> Option<Decomposition> {
        let before = problems.len();
        let wire: DecompositionWire = section.read(&[], problems)?;
        filled("methods", Some(&wire.methods), problems);
        let name = wire.name.get_ref().clone();
        if taken.contains(&name.as_str()) {
            problems.push(Problem::new(wire.name.span(), format!("the name `{name}` is taken: expected each once")));
        }
        let off = Conditions { held: wire.poses == Some(Poses::Held), ..Conditions::none() };
        let on = Conditions {
            measurement: true,
            survey: true,
            naive: true,
            held: true,
            pitch_um: wire.pitch.map(|pitch| pitch.0),
            principal_point: wire.principal_point.map_or([0.0; 2], |at| at.0),
            bend: wire.bend.map_or(0.0, |bend| bend.0),
            refocus: wire.refocus.map_or(0.0, |mm| mm.0),
            board_sigma_px: None,
            network: self.network(wire.stations.as_ref(), problems),
        };
        let methods = matched("method", wire.methods.get_ref(), self.methods, problems);
        (problems.len() == before).then_some(Decomposition { name, methods, on, off, switches: off.differing(&on) })
    }

    /// The place of the network that patterns name, if they do: some of the stations from which check points are intersected.
    fn network(&mut self, patterns: Option<&Names>, problems: &mut Vec<Problem>) -> Option<usize> {
        let (patterns, before) = (patterns?, problems.len());
        filled("stations", Some(patterns), problems);
        let chosen = matched("station", patterns.get_ref(), &self.stations, problems);
        let left: Vec<usize> = chosen.into_iter().filter(|station| self.seen.contains(station)).collect();
        if problems.len() == before && left.len() < LEAST_STATIONS {
            let message = format!("{} stations are left: expected at least {LEAST_STATIONS} of those of [transfer]", left.len());
            problems.push(Problem::new(patterns.span(), message));
        }
        let place = self.networks.iter().position(|network| *network == left).unwrap_or(self.networks.len());
        if place == self.networks.len() {
            self.networks.push(left);
        }
        Some(place)
    }
}
