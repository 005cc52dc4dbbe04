//! `calibench show`.

use std::fmt::Write;
use std::path::PathBuf;

use calibench_images::read_photo;
use calibench_measure::Setting;
use calibench_measure::registry::KINDS;
use calibench_model::camera::CameraModel;
use calibench_model::{Image, PixelPoint, TargetKind};
use calibench_random::Key;
use calibench_report::preview;
use calibench_run::prepared::{Prepared, is_pointed_at};
use calibench_run::{trial_picture, trial_truth};
use calibench_scenario::camera::LocalPlan;
use calibench_scenario::studies::printed::{Column, Printed};
use calibench_scenario::{Detector, Phase, Pixels, Scenario, SceneSubject, Starts, StudyPlan, Subject, Transfer, ViewsSubject};
use calibench_synth::stations::sees;
use clap::Args;

use super::context::Context;
use super::output;
use super::photos::say_turns;
use crate::deliver::print;
use crate::failure::Failure;

#[derive(Args)]
pub struct Show {
    /// Name of a scenario, or a TOML file
    scenario: String,
    /// The preview, as PNG, SVG or PDF by its ending [default: the scenario's name with .png, in the current folder]
    #[arg(short, long, value_name = "PICTURE")]
    output: Option<PathBuf>,
}

impl Show {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let scenario = context.scenario(&self.scenario)?;
        let path = self.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}.png", scenario.name.replace('/', "-"))));
        let output = output::picture("-o", &path, &context.inputs(&self.scenario, &scenario))?;
        let mut text = card(&scenario);
        match picture(context, &scenario)? {
            Ok((image, targets)) => {
                preview(&image, &targets).write(&output)?;
                let _ = writeln!(text, "\n# preview: {}", path.display());
            }
            Err(why) => {
                let _ = writeln!(text, "\n# no preview, unavailable: {why}");
            }
        }
        print(&text)
    }
}

/// The resolved scenario, defaults and all, as TOML without its polygons.
fn card(scenario: &Scenario) -> String {
    let quoted = |text: &str| toml::Value::from(text.split_whitespace().collect::<Vec<_>>().join(" ")).to_string();
    let mut text = format!("# {}\n", scenario.name);
    // Writing to a String cannot fail.
    let _ = writeln!(text, "why = {}\nsource = {}", quoted(&scenario.why), quoted(&scenario.source));
    let _ = writeln!(text, "seed = {}\ntrials = {}", scenario.seed, scenario.trials);
    if let Some(sweep) = &scenario.sweep {
        let _ = writeln!(text, "\n[sweep] # {} cells; what follows is the first", sweep.cells());
        for axis in &sweep.axes {
            let values: Vec<&str> = axis.values.iter().map(|value| value.text.as_str()).collect();
            let _ = writeln!(text, "\"{}\" = [{}]", axis.path, values.join(", "));
        }
    }
    match &scenario.subject {
        Subject::Scene(subject) => scene(&mut text, subject),
        Subject::Views(subject) => {
            if let Some(plan) = subject.study.transfer() {
                transfer(&mut text, plan);
            }
            views(&mut text, subject);
        }
        Subject::Photographs(subject) => {
            let _ = writeln!(text, "\n[photographs]\nfolder = {}\nfiles = {:?}", quoted(&subject.folder), subject.files);
            let _ = writeln!(text, "board = \"{}x{}\"", subject.board.columns, subject.board.rows);
        }
        Subject::Printed(subject) => printed(&mut text, subject),
    }
    for method in &scenario.methods {
        let name = method.label.split(':').next().unwrap_or_default();
        let _ = writeln!(text, "\n[[method]] # {}, version {}\nname = \"{name}\"", method.label, method.version);
        for (key, setting) in method.settings.written() {
            let _ = match setting {
                Setting::Number(value) => writeln!(text, "{key} = {value}"),
                Setting::Name(name) => writeln!(text, "{key} = {}", quoted(&name)),
            };
        }
        if let Some(kinds) = &method.kinds {
            let _ = writeln!(text, "{KINDS} = {:?}", kinds.iter().map(TargetKind::name).collect::<Vec<_>>());
        }
        if let Err(why) = &method.operator {
            let _ = writeln!(text, "# unavailable: {why}");
        }
    }
    text
}

/// What is calibrated and applied.
fn transfer(text: &mut String, plan: &Transfer) {
    let (control, check, stations) = (plan.control.len(), plan.check.len(), plan.stations.len());
    let _ = writeln!(
        text,
        "\n[transfer] # {control} control points, {check} check points, {stations} stations: what follows is where they are"
    );
    let _ = writeln!(text, "sigma_px = {}\nsurvey_sigma = {}\npitch = {}", plan.sigma_px, plan.survey_sigma, plan.pitch_um);
    let _ = writeln!(text, "poses_of = \"{}\"", plan.methods[plan.poses_of].name);
    if let Some(board) = &plan.board {
        let _ = writeln!(text, "# {} views of a board of {} corners", board.views.count, board.field.targets.len());
    }
    for method in &plan.methods {
        let _ = writeln!(text, "# method `{}`: {}", method.name, method.parameters.join(", "));
    }
    for name in plan.sets() {
        let _ = writeln!(text, "# figures `{name}`");
    }
}

fn printed(text: &mut String, subject: &Printed) {
    let (points, variants) = (subject.points.len(), subject.variants.len());
    let _ =
        writeln!(text, "\n[printed] # {} pitches, {points} points, {variants} variants, in {}", subject.pitches.len(), subject.unit.name());
    for Column { name, camera, .. } in &subject.cameras {
        let values: Vec<String> = camera.parameters().iter().map(|parameter| format!("{} {}", parameter.name, parameter.value)).collect();
        let _ = writeln!(text, "# {name}: {}", values.join(", "));
    }
    for grid in &subject.grids {
        let _ = writeln!(text, "# a grid: {}", grid.name);
    }
    if let Some(network) = &subject.network {
        let fitted: Vec<&str> = network.fitted.iter().map(|&column| subject.cameras[column].name.as_str()).collect();
        let _ = writeln!(text, "# network of {} stations, fitted to {}", network.stations, fitted.join(", "));
    }
}

fn scene(text: &mut String, subject: &SceneSubject) {
    let scene = &subject.scene;
    let pixels = if subject.pixels == Pixels::Area { "area" } else { "centre" };
    let phase = if subject.phase == Phase::Fixed { "fixed" } else { "uniform" };
    let _ = writeln!(text, "\n[scene] # {} polygons, {} targets", scene.polygons.len(), scene.targets.len());
    let _ = writeln!(text, "width = {}\nheight = {}\nbackground = {}", scene.width, scene.height, scene.background);
    let _ = writeln!(text, "pixels = \"{pixels}\"\nphase = \"{phase}\"\ngrey_noise = {}", subject.grey_noise);
    match subject.bits {
        Some(bits) => writeln!(text, "bits = {bits}"),
        None => writeln!(text, "# bits: not quantised"),
    }
    .unwrap_or_default();
    if let Starts::Pointed(hand) = &subject.starts {
        let _ = writeln!(text, "pointing = {{ sigma = {}, whole_pixels = {} }}", hand.sigma, hand.whole_pixels);
    }
    if let Starts::Detected(detector) = &subject.starts {
        let _ = writeln!(text, "pointing = {{ detector = \"harris\", within = {} }}", detector.within);
    }
    for (index, target) in scene.targets.iter().enumerate() {
        let _ = write!(text, "# target {} ({}) at ({}, {})", target.id, target.kind, target.at.x, target.at.y);
        let _ = match &subject.starts {
            Starts::Given(starts) => writeln!(text, ", start ({}, {})", starts[index].x, starts[index].y),
            Starts::Pointed(_) | Starts::Detected(_) => writeln!(text),
        };
    }
}

fn views(text: &mut String, subject: &ViewsSubject) {
    let (field, size) = (&subject.field, subject.camera.size());
    let _ = writeln!(text, "\n[camera] # {}, {} x {} px", subject.camera.convention().name, size.width, size.height);
    for parameter in subject.camera.parameters() {
        let _ = writeln!(text, "# {} = {} {}", parameter.name, parameter.value, parameter.unit);
    }
    if let Some(LocalPlan { design, each_trial }) = subject.local {
        let _ =
            writeln!(text, "\n[camera.local]\nsigma = {}\ncorrelation = {}\neach_trial = {each_trial}", design.sigma, design.correlation);
    }
    let (plates, targets, unit) = (field.plates.len(), field.targets.len(), subject.unit.name());
    let _ = writeln!(text, "\n[testfield] # {plates} plates, {targets} targets, in {unit}");
    if let Some([low, high]) = field.extent() {
        let _ = writeln!(text, "# from ({}, {}, {}) to ({}, {}, {})", low.x, low.y, low.z, high.x, high.y, high.z);
    }
    for station in &subject.stations {
        let (at, angles) = (station.pose.centre, station.pose.angles().map(f64::to_degrees));
        let seen = sees(&subject.camera, &station.pose, &station.field(field)) * targets as f64;
        let [omega, phi, kappa] = angles;
        let _ = writeln!(text, "\n[[station]]\nname = \"{}\" # sees {seen:.0} targets", station.name);
        let _ = writeln!(text, "at = [{}, {}, {}]\nangles = [{omega}, {phi}, {kappa}]", at.x, at.y, at.z);
        if let Some(bend) = station.bend {
            let across = bend.across.to_degrees();
            let _ = writeln!(
                text,
                "# the stand bends the field by {} {unit} over {}, across {across} degrees of its own",
                bend.peak, bend.reach
            );
        }
    }
    if let Some(detector) = &subject.detector {
        let (name, within) = match detector {
            Detector::Harris(harris) => ("harris", harris.within),
            Detector::Board(board) => ("board", board.within),
        };
        let _ = writeln!(text, "\n[pointing]\ndetector = \"{name}\"\nwithin = {within}");
        return;
    }
    let _ = writeln!(text, "\n[pointing]\nsigma = {}\nwhole_pixels = {}", subject.hand.sigma, subject.hand.whole_pixels);
    let _ = writeln!(text, "clipped = {}", subject.clipped);
}

type Picture = (Image<'static>, Vec<(String, PixelPoint)>);

/// The image of the first trial with its targets, or the first photograph with its corners; or why there is none.
fn picture(context: &Context<'_>, scenario: &Scenario) -> Result<Result<Picture, String>, Failure> {
    match &scenario.subject {
        Subject::Scene(subject) => {
            let key = Key { seed: scenario.seed, of: &scenario.drawn, trial: 0, view: calibench_run::VIEW, target: "" };
            let truth = trial_truth(subject, key);
            let image = trial_picture(subject, &subject.renderer()?, &truth, key)?.image;
            Ok(Ok((image, truth.targets.into_iter().map(|target| (target.id, target.at)).collect())))
        }
        Subject::Views(subject) => {
            let key = Key { seed: scenario.seed, of: &scenario.drawn, trial: 0, view: "", target: "" };
            let prepared = Prepared::new(subject, key)?;
            let Some(view) = prepared.views.first() else { return Ok(Err("the scenario has no station".into())) };
            let image = prepared.image(view, key)?.image;
            let seen = subject.field.targets.iter().zip(&view.truth).filter(|(_, truth)| is_pointed_at(subject, truth));
            Ok(Ok((image, seen.filter_map(|(target, truth)| Some((target.id.clone(), truth.at?))).collect())))
        }
        Subject::Printed(_) => Ok(Err("the scenario is of printed figures: there is no image".into())),
        Subject::Photographs(subject) => {
            let path = context.data()?.join(&subject.folder).join(&subject.files[0]);
            if !path.is_file() {
                return Ok(Err(format!("`{}` is not in `{}`", subject.files[0], subject.folder)));
            }
            say_turns(std::slice::from_ref(&path))?;
            let image = read_photo(&path)?.image;
            let corners = context.toolbox.detector.as_ref().and_then(|detector| detector.detect(&image, subject.board));
            let named = |(index, at): (usize, PixelPoint)| (subject.board.target(index), at);
            Ok(Ok((image, corners.unwrap_or_default().into_iter().enumerate().map(named).collect())))
        }
    }
}
