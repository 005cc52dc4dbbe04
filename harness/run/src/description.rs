//! What the pages of a scenario tell of it, for its records.

use std::collections::BTreeSet;

use calibench_measure::Configured;
use calibench_model::camera::{CameraModel, Photogrammetric};
use calibench_model::convert::Tool;
use calibench_model::escape::markdown;
use calibench_model::told::{Told, notes};
use calibench_records::description::{
    self, Adjustment, Axis, Cell, CheckPoint, Description, PlacedNetwork, PrintedCamera, Role, Room, Systems, Target, Value, Views,
    operator,
};
use calibench_scenario::studies::acceptance::{Classes, TestLines};
use calibench_scenario::studies::network::CheckPlan;
use calibench_scenario::studies::networks::Kind;
use calibench_scenario::studies::printed::{NETWORK, SENSOR};
use calibench_scenario::studies::tasks::BoardErrors;
use calibench_scenario::{Blocks, Networks, Printed, Scenario, Study, Subject, Sweep, Tasks, ViewsSubject};
use calibench_synth::stations::Station;
use calibench_synth::view::View;

use crate::prepared::is_pointed_at;

/// What methods told, as paragraphs beside a scenario's own notes.
pub fn told_notes<'m>(told: impl IntoIterator<Item = (&'m str, Told)>) -> impl Iterator<Item = String> {
    notes(told).into_iter().map(|(name, note)| format!("**`{name}`:** {}", markdown(&note)))
}

/// The description of `scenario`, which `methods` were run on, its own or others; but for what these tell ([`told_notes`]).
pub fn description(scenario: &Scenario, methods: &[Configured]) -> Description {
    let default = |method: &Configured| (operator(&method.label).to_owned(), method.default_label.clone());
    let study = match &scenario.subject {
        Subject::Scene(_) => description::Study::Scene,
        Subject::Views(subject) => of_views(subject),
        Subject::Printed(printed) => description::Study::Printed(Box::new(of_print(printed))),
        Subject::Photographs(subject) => description::Study::Photographs { judged: subject.judgement.is_some() },
    };
    Description {
        why: scenario.why.clone(),
        source: scenario.source.clone(),
        notes: scenario.notes.iter().cloned().chain(drawn_once(scenario)).collect(),
        seed: scenario.seed,
        trials: scenario.trials,
        bound_window: scenario.bound_window,
        bound_window_discs: Some(scenario.bound_window_discs).filter(|window| *window != scenario.bound_window),
        methods: labels(scenario),
        finders: finders(scenario.methods.iter().chain(methods)),
        defaults: scenario.methods.iter().chain(methods).map(default).collect(),
        study,
        sweep: scenario.sweep.as_ref().map(sweep),
    }
}

/// What intervals over trials do not hold, where there are several.
fn drawn_once(scenario: &Scenario) -> Option<String> {
    let Subject::Views(subject) = &scenario.subject else { return None };
    let pattern = subject.imaging.has_pattern().then_some("the pattern of the sensor");
    let all: Vec<&str> = subject.drawn_once.iter().copied().chain(pattern).collect();
    let told = scenario.trials > 1 && !all.is_empty();
    told.then(|| {
        format!(
            "Drawn once, the same in all trials, so that no interval over trials holds what another draw would change: {}.",
            all.join(", ")
        )
    })
}

/// The names of methods that find boards, each once.
fn finders<'m>(methods: impl Iterator<Item = &'m Configured>) -> Vec<String> {
    let names: BTreeSet<&str> = methods.filter(|method| method.board_finder().is_some()).map(Configured::name).collect();
    names.into_iter().map(str::to_owned).collect()
}

/// Those of methods that measure, or of the study's own.
fn labels(scenario: &Scenario) -> Vec<String> {
    let measuring = || scenario.methods.iter().map(|method| method.label.clone()).collect();
    scenario.subject.study().own_methods().unwrap_or_else(measuring)
}

fn of_print(printed: &Printed) -> description::Printed {
    let variants = |again: bool| {
        let chosen = printed.variants.iter().filter(move |variant| variant.refit == again);
        chosen.map(|variant| variant.name.clone()).collect()
    };
    let size = printed.cameras[0].camera.size;
    let camera = |name: &str, camera: &Photogrammetric, tool: Option<Tool>| PrintedCamera {
        name: name.to_owned(),
        tool: tool.map(|tool| tool.name().to_owned()),
        c: camera.c,
        principal_point: [camera.x0, camera.y0],
        k: camera.k,
        p: camera.p,
    };
    let point =
        |point: &calibench_scenario::studies::printed::CheckPoint| CheckPoint { name: point.name.clone(), at: point.at.coords.into() };
    description::Printed {
        sensor: SENSOR.to_owned(),
        size: [size.width, size.height],
        pitch_um: printed.cameras[0].camera.pitch_um,
        unit: printed.unit.name().to_owned(),
        cameras: printed.cameras.iter().map(|column| camera(&column.name, &column.camera, column.tool)).collect(),
        grids: printed.grids.iter().map(|grid| camera(&grid.name, &grid.camera, None)).collect(),
        points: printed.points.iter().map(point).collect(),
        network: printed.network.as_ref().map(|plan| PlacedNetwork { set: NETWORK.to_owned(), from: plan.from.into() }),
        variants: variants(false),
        again: variants(true),
    }
}

fn sweep(sweep: &Sweep) -> description::Sweep {
    let axis = |axis: &calibench_scenario::sweep::Axis| {
        let values = axis.values.iter().map(|value| Value { text: value.text.clone(), number: value.number }).collect();
        Axis { path: axis.path.clone(), name: axis.name.clone(), values, log: axis.log }
    };
    let cell = |index| Cell { label: sweep.label(index), places: sweep.places(index) };
    description::Sweep { axes: sweep.axes.iter().map(axis).collect(), cells: (0..sweep.cells()).map(cell).collect() }
}

fn of_views(subject: &ViewsSubject) -> description::Study {
    let views = Box::new(views(subject));
    match &subject.study {
        Study::Points => description::Study::Views(views),
        Study::Network(plan) => {
            let classes = plan.check.as_ref().and_then(|check| check.acceptance);
            let acceptance =
                classes.map(|Classes { horizontal, vertical, spatial }| description::Classes { horizontal, vertical, spatial });
            let told = Adjustment { pitch_um: plan.start.pitch_um, drawn: plan.drawn.is_some(), acceptance };
            description::Study::Network(views, told)
        }
        Study::Blocks(plan) => description::Study::Blocks(views, in_blocks(subject, plan)),
        Study::Calibrators(plan) => description::Study::Calibrators(views, Systems { model: plan.model.clone(), sigma_px: plan.sigma_px }),
        Study::Networks(plan) => description::Study::Networks(views, of_networks(subject, plan)),
        Study::Tasks(plan) => description::Study::Tasks(views, of_tasks(plan)),
        Study::Transfer { .. } => description::Study::Transfer(views),
    }
}

fn of_networks(subject: &ViewsSubject, plan: &Networks) -> description::Networks {
    let name = |target: usize| subject.field.targets[target].id.clone();
    let distances = match &plan.kind {
        Kind::Free { distances, .. } => distances.iter().map(|bar| bar.between.map(name)).collect(),
        Kind::Rig(_) => Vec::new(),
    };
    let mounts = plan.mounts().iter().map(|mount| mount.name.clone()).collect();
    let acceptance = match &plan.kind {
        Kind::Free { acceptance, .. } => acceptance.as_ref().map(test_lengths),
        Kind::Rig(_) => None,
    };
    description::Networks { model: plan.model.clone(), sigma_px: plan.sigma_px, mounts, distances, acceptance }
}

fn of_tasks(plan: &Tasks) -> description::Tasks {
    let BoardErrors { print, scale, flatness } = plan.board;
    description::Tasks { model: plan.model.clone(), noise_px: plan.noise_px, count: plan.count, print, scale, flatness }
}

fn test_lengths(plan: &TestLines) -> description::TestLengths {
    description::TestLengths {
        count: plan.lengths().count(),
        lines: plan.lines.len(),
        limit: [plan.limit.constant, plan.limit.rate],
        most: Some(plan.limit.most).filter(|most| most.is_finite()),
        sigma: plan.sigma,
    }
}

fn views(subject: &ViewsSubject) -> Views {
    let check = subject.study.network().and_then(|calibration| calibration.check.as_ref());
    let size = subject.camera.size();
    Views {
        size: [size.width, size.height],
        unit: subject.unit.name().to_owned(),
        extent: subject.field.extent().map(|ends| ends.map(|at| at.coords.into())),
        normal: subject.field.plates.first().map(|plate| plate.normal().into()),
        stations: stations(subject, check),
        targets: targets(subject, check),
        room: room(subject),
    }
}

/// The room of the targets in view, as the testfield is meant to be.
fn room(subject: &ViewsSubject) -> Option<Room> {
    subject.field.targets.iter().find(|target| target.room.is_some())?;
    let of_station = |station: &Station| {
        let field = station.field(&subject.field);
        let seen = View { field: &field, camera: &subject.camera, local: None, pose: &station.pose }.seen(0.0);
        let truth = seen.map_or_else(|_| Vec::new(), |seen| seen.truth());
        truth.into_iter().filter(|truth| is_pointed_at(subject, truth)).filter_map(|truth| truth.room).collect::<Vec<_>>()
    };
    let mut all: Vec<f64> = subject.stations.iter().flat_map(of_station).collect();
    all.sort_by(f64::total_cmp);
    Some(Room { least: *all.first()?, middle: all[all.len() / 2] })
}

fn in_blocks(subject: &ViewsSubject, blocks: &Blocks) -> description::Blocks {
    let name = |station: usize| subject.stations[station].name.clone();
    let plan = blocks.residuals.as_ref();
    description::Blocks {
        pitch_um: blocks.camera.base.pitch_um,
        pairs: plan.map(|plan| plan.pairs.iter().map(|pair| pair.map(name)).collect()).unwrap_or_default(),
        compared: plan.map(|plan| plan.blocks.iter().map(|&block| blocks.list[block].name.clone()).collect()).unwrap_or_default(),
    }
}

fn stations(subject: &ViewsSubject, check: Option<&CheckPlan>) -> Vec<description::Station> {
    let station = |(index, station): (usize, &Station)| description::Station {
        name: station.name.clone(),
        centre: station.pose.centre.coords.into(),
        // A camera looks along its -z.
        sight: (-station.pose.rotation.row(2).transpose()).into(),
        second_step: check.is_some_and(|check| check.views.contains(&index))
            || subject.study.transfer().is_some_and(|transfer| transfer.stations.contains(&index)),
    };
    subject.stations.iter().enumerate().map(station).collect()
}

fn targets(subject: &ViewsSubject, check: Option<&CheckPlan>) -> Vec<Target> {
    let transfer = subject.study.transfer();
    let role = |index: &usize| match check {
        None if transfer.is_some_and(|transfer| transfer.control.contains(index)) => Some(Role::Control),
        None if transfer.is_some_and(|transfer| transfer.check.contains(index)) => Some(Role::Check),
        Some(check) if check.control.contains(index) => Some(Role::Control),
        Some(check) if check.points.contains(index) => Some(Role::Check),
        _ => None,
    };
    let target = |(index, target): (usize, &calibench_model::ObjectTarget)| Target {
        id: target.id.clone(),
        kind: target.kind.name().to_owned(),
        surveyed: target.surveyed.coords.into(),
        role: role(&index),
    };
    subject.field.targets.iter().enumerate().map(target).collect()
}
