//! Reading `[calibration]`.

use calibench_diagnostics::Problem;
use calibench_measure::Configured;
use calibench_model::camera::{Camera, CameraModel, Photogrammetric};
use toml::Spanned;

use super::wire::{self, CalibrationWire, CheckWire};
use super::{Calibration, CheckPlan, POINTED, ParameterSet};
use crate::section::Section;
use crate::studies::acceptance::{Classes, read_classes};
use crate::studies::{Seen, places};

/// Reads the table of a scenario of `views`, and what its check points must keep; `methods` are those of the scenario.
pub fn read(
    mut section: Section<'_>,
    acceptance: Option<Section<'_>>,
    views: &Seen<'_>,
    methods: &[Configured],
    problems: &mut Vec<Problem>,
) -> Option<Calibration> {
    let (span, before) = (section.span.clone(), problems.len());
    let check = section.take_table("check", "[calibration.check]", problems);
    let wire: Option<CalibrationWire> = section.read(&["check"], problems);
    if let (Some(section), None) = (&acceptance, &check) {
        problems.push(Problem::new(section.span.clone(), "[acceptance] without [calibration.check]: expected check points that keep it"));
    }
    let classes = acceptance.and_then(|section| read_classes(section, problems));
    let check = check.map(|section| read_check(section, views, classes, problems));
    let wire = wire?;
    let Camera::Photogrammetric(truth) = *views.camera else {
        let problem = Problem::new(span, "[calibration] needs a camera of the photogrammetric model");
        problems.push(problem.help("write its `size`, `pitch` and `c` out, or convert its file"));
        return None;
    };
    if views.redrawn {
        problems
            .push(Problem::new(span.clone(), "[calibration] with stations that are drawn anew in each trial: expected the same in all"));
    }
    let sets = sets(&wire.sets, &truth, problems);
    let drawn = wire.drawn.as_ref().map(|drawn| drawn_sigmas(drawn, methods, problems));
    let survey_sigma = wire.survey_sigma.map_or(0.0, |sigma| sigma.0);
    if let (Some(once), true) = (views.survey_sigma, wire.survey_sigma.is_some()) {
        let message = format!("`survey_sigma` stands in [calibration] and, with {once}, in [testfield]: expected one survey");
        let help = "[testfield]'s errors are the same in all trials, [calibration]'s are drawn anew in each";
        problems.push(Problem::new(span, message).help(help));
    }
    if problems.len() > before {
        return None;
    }
    Some(Calibration {
        sets,
        start: Photogrammetric { c: wire.start_c.0, x0: 0.0, y0: 0.0, k: [0.0; 3], p: [0.0; 2], b: [0.0; 2], ..truth },
        sigma_px: wire.sigma_px.0,
        floor_px: wire.floor_px.map_or(0.0, |floor| floor.0),
        survey_sigma,
        control_sigma: wire.control_sigma.map_or(views.survey_sigma.unwrap_or(survey_sigma), |sigma| sigma.0),
        drawn,
        eccentricity: wire.eccentricity.unwrap_or(false),
        keep_points: wire.keep_points.unwrap_or(false),
        check: check.flatten(),
    })
}

/// The sets of parameters; each must be written once and name parameters of the camera.
fn sets(written: &Spanned<Vec<Spanned<String>>>, camera: &Photogrammetric, problems: &mut Vec<Problem>) -> Vec<ParameterSet> {
    let known: Vec<&str> = camera.parameters().iter().map(|parameter| parameter.name).collect();
    if written.get_ref().is_empty() {
        problems.push(Problem::new(written.span(), "`sets` is empty: expected at least one set of parameters, as in \"c,x0,y0,k1\""));
    }
    let mut sets: Vec<ParameterSet> = Vec::new();
    for set in written.get_ref() {
        let parameters: Vec<String> = set.get_ref().split(',').map(|name| name.trim().to_owned()).collect();
        for (index, name) in parameters.iter().enumerate() {
            if !known.contains(&name.as_str()) {
                let message = format!("the camera has no parameter `{name}`; expected some of {}", known.join(", "));
                problems.push(Problem::new(set.span(), message).nearest(name, known.iter().copied()));
            } else if parameters[..index].contains(name) {
                problems.push(Problem::new(set.span(), format!("`{name}` stands twice in a set: expected each parameter once")));
            }
        }
        let name = parameters.join(",");
        if sets.iter().any(|earlier| earlier.name == name) {
            problems.push(Problem::new(set.span(), format!("the set `{name}` is listed twice: expected each once")));
        }
        sets.push(ParameterSet { name, parameters });
    }
    sets
}

fn drawn_sigmas(
    written: &Spanned<std::collections::BTreeMap<String, wire::Error>>,
    methods: &[Configured],
    problems: &mut Vec<Problem>,
) -> Vec<(String, Option<f64>)> {
    let labels = || methods.iter().map(|method| method.label.as_str());
    for label in written.get_ref().keys() {
        if label == POINTED || !methods.iter().any(|method| method.is_called(label)) {
            let message =
                format!("`drawn` has `{label}`: expected labels of the scenario's methods, `{POINTED}` apart, whose hand is [pointing]'s");
            problems.push(Problem::new(written.span(), message).nearest(label, labels()));
        }
    }
    let sigma = |method: &Configured| {
        let label = method.label.as_str();
        let sigma = written.get_ref().iter().find(|(text, _)| method.is_called(text)).map(|(_, sigma)| sigma.0);
        if sigma.is_none() && label != POINTED {
            let message = format!("`drawn` has no standard deviation for `{label}`: expected one for each method");
            problems.push(Problem::new(written.span(), message));
        }
        (label.to_owned(), sigma)
    };
    methods.iter().map(sigma).collect()
}

/// The fewest control points of the second step: a resection takes as many.
const LEAST_CONTROL: usize = 4;

fn read_check(section: Section<'_>, views: &Seen<'_>, acceptance: Option<Classes>, problems: &mut Vec<Problem>) -> Option<CheckPlan> {
    let before = problems.len();
    let wire: CheckWire = section.read(&[], problems)?;
    let stations: Vec<&str> = views.stations.iter().map(|station| station.name.as_str()).collect();
    let targets: Vec<&str> = views.field.targets.iter().map(|target| target.id.as_str()).collect();
    let seen = places("station", wire.views.get_ref(), &stations, problems);
    let control = places("target", wire.control.get_ref(), &targets, problems);
    let points = match &wire.points {
        Some(points) => places("target", points, &targets, problems),
        None => (0..targets.len()).filter(|target| !control.contains(target)).collect(),
    };
    if wire.views.get_ref().len() < 2 {
        problems.push(Problem::new(wire.views.span(), "`views` of [calibration.check]: expected at least two stations"));
    }
    if wire.control.get_ref().len() < LEAST_CONTROL {
        let message =
            format!("`control` of [calibration.check]: expected at least {LEAST_CONTROL} targets, found {}", wire.control.get_ref().len());
        problems.push(Problem::new(wire.control.span(), message));
    }
    if let (Some(&both), Some(written)) = (points.iter().find(|point| control.contains(point)), &wire.points) {
        let at = written.iter().find(|name| name.get_ref() == targets[both]).map_or(wire.control.span(), Spanned::span);
        problems.push(Problem::new(at, format!("`{}` is a control point and a check point: expected one of them", targets[both])));
    }
    (problems.len() == before).then_some(CheckPlan { views: seen, control, points, acceptance })
}
