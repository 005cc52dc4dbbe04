//! Reading `[[transfer.method]]`.

use calibench_diagnostics::Problem;
use calibench_measure::Registry;
use calibench_model::camera::{Camera, CameraModel};
use toml::Spanned;

use super::board::ReadBoard;
use super::wire::{MethodWire, Source, TransferWire};
use super::{Calibrates, Measuring, Method, Model, Solver, operator};
use crate::section::Section;
use crate::studies::filled;

/// What is told of all methods.
pub(super) struct Told<'a> {
    pub wire: &'a TransferWire,
    /// The camera that is true.
    pub camera: &'a Camera,
    pub board: Option<&'a ReadBoard>,
    pub registry: &'a Registry,
}

/// A method, which has another name than those `earlier`.
pub(super) fn method(section: Section<'_>, told: &Told<'_>, earlier: &[Method], problems: &mut Vec<Problem>) -> Option<Method> {
    let before = problems.len();
    let span = section.span.clone();
    let wire: MethodWire = section.read(&[], problems)?;
    let name = wire.name.get_ref().clone();
    if name.trim().is_empty() || earlier.iter().any(|other| other.name == name) {
        problems.push(Problem::new(wire.name.span(), format!("the name `{name}` is empty or taken: expected each once")));
    }
    let from = *wire.from.get_ref();
    let model = match (from, wire.model) {
        (Source::Nothing, _) => Model::Photogrammetric,
        (_, Some(model)) => model,
        (_, None) => {
            let problem = Problem::new(span, format!("method `{name}` calibrates and has no `model`"));
            problems.push(problem.help("expected `metashape`, `pix4d`, `opencv` or `photogrammetric`"));
            return None;
        }
    };
    only_of_a_board(&wire, from, problems);
    let measured_by = measured_by(&wire, told, &name, problems);
    let calibrates = calibrates(&wire, told, model, &name, problems)?;
    let start = model.start(told.camera.size(), told.wire.pitch.get_ref().0, told.wire.start_c.0)?;
    let parameters = parameters(&wire, from, model, &start, problems);
    (problems.len() == before).then_some(Method { name, calibrates, start, parameters, measured_by })
}

/// What is said of a board is said where there is one.
fn only_of_a_board(wire: &MethodWire, from: Source, problems: &mut Vec<Problem>) {
    if from == Source::Board {
        return;
    }
    let keys = [
        (wire.sigma_px.as_ref().map(Spanned::span), "sigma_px", "that of a board's corners"),
        (wire.measured_by.as_ref().map(Spanned::span), "measured_by", "what measures a board's corners"),
        (wire.solver.as_ref().map(Spanned::span), "solver", "what makes a camera of a board's corners"),
    ];
    for (span, key, what) in keys {
        if let Some(span) = span {
            problems.push(Problem::new(span, format!("`{key}` of a method is {what}: expected `from = \"board\"` beside it")));
        }
    }
}

/// What measures the board's corners: an operator where the images of `[transfer]` are measured, and none where they are drawn.
fn measured_by(wire: &MethodWire, told: &Told<'_>, name: &str, problems: &mut Vec<Problem>) -> Option<Measuring> {
    let rendered = told.wire.measured_by.is_some();
    match wire.measured_by.as_ref().filter(|_| *wire.from.get_ref() == Source::Board) {
        Some(text) if rendered => operator::read(text, wire.detected.unwrap_or(false), told.registry, problems),
        Some(text) => {
            let message =
                "`measured_by` of a method: expected one in [transfer] too, images are rendered and measured on both sides or on none";
            problems.push(Problem::new(text.span(), message));
            None
        }
        None if rendered && *wire.from.get_ref() == Source::Board => {
            let message = format!("method `{name}` calibrates from a board and has no `measured_by`: expected one as [transfer] has one");
            problems.push(Problem::new(wire.from.span(), message));
            None
        }
        None => None,
    }
}

fn calibrates(wire: &MethodWire, told: &Told<'_>, model: Model, name: &str, problems: &mut Vec<Problem>) -> Option<Calibrates> {
    let solver = wire.solver.as_ref().map_or(Solver::Own, |solver| *solver.get_ref());
    let asks_opencv = wire.solver.as_ref().filter(|_| solver == Solver::Opencv);
    if let Some(written) = asks_opencv.filter(|_| model != Model::Opencv || wire.parameters.is_some()) {
        let message =
            "`solver = \"opencv\"` solves for all nine parameters of its own model: expected `model = \"opencv\"` and no `parameters`";
        problems.push(Problem::new(written.span(), message));
    }
    let sigma = told.board.and_then(|board| board.sigma_px).or(wire.sigma_px.as_ref().map(|sigma| sigma.get_ref().0));
    let missing = match wire.from.get_ref() {
        Source::Control => return Some(Calibrates::FromControl),
        Source::Nothing => return Some(Calibrates::Never),
        Source::Board if told.board.is_none() => "calibrates from a board: there is no [transfer.board]",
        Source::Board => match sigma {
            Some(sigma_px) => return Some(Calibrates::FromBoard { sigma_px, solver }),
            None => "calibrates from a board and has no `sigma_px`",
        },
    };
    problems.push(Problem::new(wire.from.span(), format!("method `{name}` {missing}")));
    None
}

fn parameters(wire: &MethodWire, from: Source, model: Model, start: &Camera, problems: &mut Vec<Problem>) -> Vec<String> {
    let Some(written) = &wire.parameters else {
        let full = if from == Source::Nothing { &[] } else { model.full() };
        return full.iter().map(|name| (*name).to_owned()).collect();
    };
    filled("parameters", Some(written), problems);
    let known: Vec<&str> = start.parameters().iter().map(|parameter| parameter.name).collect();
    for name in written.get_ref() {
        if !known.contains(&name.get_ref().as_str()) {
            let message = format!(
                "the model {} has no parameter `{}`: expected some of {}",
                start.convention().name,
                name.get_ref(),
                known.join(", ")
            );
            problems.push(Problem::new(name.span(), message).nearest(name.get_ref(), known.iter().copied()));
        }
    }
    written.get_ref().iter().map(|name| name.get_ref().clone()).collect()
}
