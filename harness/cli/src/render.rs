//! `calibench render`.

use std::path::PathBuf;

use calibench_exchange::{NewFolder, Points, encode_png};
use calibench_model::Start;
use calibench_model::camera::CameraModel;
use calibench_random::Key;
use calibench_records::names::kept_image_name;
use calibench_run::views::{self, Prepared, PreparedView};
use calibench_run::{RunError, VIEW, starts, trial_picture, trial_truth, truth};
use calibench_scenario::stations::{LOCAL_DISTORTION, NOISE_FREE};
use calibench_scenario::{Scenario, SceneSubject, Subject, ViewsSubject};
use calibench_synth::local::LocalDesign;
use calibench_synth::stations::Station;
use clap::Args;
use rayon::prelude::*;

use super::context::Context;
use super::output;
use super::progress::Progress;
use crate::deliver::print;
use crate::failure::Failure;

/// Writes a scenario's images with the truth about every target, the camera and the poses.
#[derive(Args)]
pub struct Render {
    /// Name of a scenario, or a TOML file
    scenario: String,
    /// The folder; of one that is there, only what calibench wrote is replaced, and if it holds anything else it is refused
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Which trial, counted from 0
    #[arg(long, value_name = "N", default_value_t = 0)]
    trial: u64,
    /// Seed in place of the scenario's
    #[arg(long, value_name = "S", value_parser = clap::value_parser!(u64).range(..=i64::MAX as u64))]
    seed: Option<u64>,
    /// Also each image before the sensor: without noise, 16 bit
    #[arg(long)]
    noise_free: bool,
    /// Only this station's image; may be repeated
    #[arg(long = "station", value_name = "NAME")]
    stations: Vec<String>,
}

/// What is said of an image that was drawn.
struct Drawn<'p> {
    name: &'p str,
    row: truth::StationRow<'p>,
    starts: Vec<(&'p str, Start)>,
    notes: Vec<String>,
}

impl Render {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let scenario = context.scenario(&self.scenario)?;
        let output = output::folder("-o", &self.output, &context.inputs(&self.scenario, &scenario))?;
        let key = Key { seed: self.seed.unwrap_or(scenario.seed), scenario: &scenario.name, trial: self.trial, view: "", target: "" };
        let mut notes = Vec::new();
        output.replace::<RunError>(|folder| {
            notes = match &scenario.subject {
                Subject::Views(subject) => self.views(context, &scenario, subject, key, folder)?,
                Subject::Scene(subject) => self.scene(subject, key, folder)?,
                Subject::Photographs(_) | Subject::Printed(_) => return Err(RunError::NothingToRender),
            };
            Ok(())
        })?;
        if let Some(sweep) = &scenario.sweep {
            notes.insert(0, format!("of the sweep's {} cells the first: {}", sweep.cells(), sweep.label(0)));
        }
        print(&format!("{}\n{}", self.output.display(), notes.iter().map(|note| format!("  {note}\n")).collect::<String>()))
    }

    /// Draws the image of one station.
    fn station<'p>(
        &self,
        subject: &ViewsSubject,
        prepared: &'p Prepared<'_>,
        view: &'p PreparedView<'_>,
        key: Key<'_>,
        folder: &NewFolder,
    ) -> Result<Drawn<'p>, RunError> {
        let name = &view.station.name;
        let exposure = prepared.image(view, key)?;
        folder.write(&kept_image_name(name), |file| encode_png(file, &exposure.image, prepared.is_deep()))?;
        if self.noise_free {
            folder.write(&format!("{name}{NOISE_FREE}.png"), |file| encode_png(file, &prepared.irradiance(view), true))?;
        }
        truth::write_view(folder, &format!("{name}.csv"), subject, view)?;
        let clipped = truth::clipping_note(name, exposure.clipped, exposure.image.grey().len());
        Ok(Drawn {
            name,
            row: truth::StationRow::new(view.station, exposure.clipped),
            starts: views::starts(prepared, view, &exposure.image, key),
            notes: clipped.into_iter().chain(truth::warnings(subject, view)).collect(),
        })
    }

    fn scene(&self, subject: &SceneSubject, key: Key<'_>, folder: &NewFolder) -> Result<Vec<String>, RunError> {
        if let Some(name) = self.stations.iter().find(|name| *name != VIEW) {
            return Err(RunError::NoStation { name: name.clone(), known: VIEW.into() });
        }
        let key = Key { view: VIEW, ..key };
        let scene = trial_truth(subject, key);
        let renderer = subject.renderer()?;
        let exposure = trial_picture(subject, &renderer, &scene, key)?;
        folder.write(&kept_image_name(VIEW), |file| encode_png(file, &exposure.image, subject.is_deep()))?;
        if self.noise_free {
            let picture = calibench_synth::raster::Picture::from(&scene);
            let noise_free = renderer.render(&picture, &[]);
            folder.write(&format!("{VIEW}{NOISE_FREE}.png"), |file| encode_png(file, &noise_free, true))?;
        }
        truth::write_scene(folder, &format!("{VIEW}.csv"), &scene)?;
        let mut points = Points::default();
        for (target, start) in scene.targets.iter().zip(starts(subject, &exposure.image, &scene, key)) {
            start.into_iter().for_each(|start| points.push(&kept_image_name(VIEW), &target.id, start));
        }
        truth::write_starts(folder, "starts.csv", &points)?;
        Ok(truth::clipping_note(VIEW, exposure.clipped, exposure.image.grey().len()).into_iter().collect())
    }

    fn views(
        &self,
        context: &Context<'_>,
        scenario: &Scenario,
        subject: &ViewsSubject,
        key: Key<'_>,
        folder: &NewFolder,
    ) -> Result<Vec<String>, RunError> {
        let drawn = subject.stations_of(key)?;
        if let Some(unknown) = self.stations.iter().find(|name| drawn.iter().all(|station| station.name != **name)) {
            let known: Vec<&str> = drawn.iter().map(|station| station.name.as_str()).collect();
            return Err(RunError::NoStation { name: unknown.clone(), known: known.join(", ") });
        }
        let chosen = |station: &&Station| self.stations.is_empty() || self.stations.contains(&station.name);
        let stations: Vec<Station> = drawn.iter().filter(chosen).cloned().collect();
        let prepared = Prepared::of(subject, &stations, key)?;
        let progress = Progress::start(&scenario.name, stations.len() as u64, context.quiet);
        let draw = |view| {
            let drawn = self.station(subject, &prepared, view, key, folder);
            progress.step();
            drawn
        };
        let (mut notes, mut rows, mut points) = (Vec::new(), Vec::new(), Points::default());
        // In batches: as many images as threads are in memory, and a thread that waits for the bands of its image does not begin with another one.
        for batch in prepared.views.chunks(rayon::current_num_threads()) {
            let drawn = batch.par_iter().map(draw).collect::<Vec<Result<Drawn<'_>, RunError>>>();
            for one in drawn {
                let one = one?;
                one.starts.into_iter().for_each(|(target, start)| points.push(&kept_image_name(one.name), target, start));
                notes.extend(one.notes);
                rows.push(one.row);
            }
        }
        truth::write_stations(folder, "stations.csv", &rows)?;
        truth::write_starts(folder, "starts.csv", &points)?;
        truth::write_control(folder, "control.csv", subject)?;
        truth::write_camera(folder, "camera", &subject.camera)?;
        if let Some(local) = subject.local_of(key)? {
            let name = format!("{LOCAL_DISTORTION}.csv");
            truth::write_local(folder, &name, &local, subject.camera.size())?;
            let LocalDesign { sigma, correlation } = local.design();
            notes.push(format!(
                "the camera's local distortion ({sigma} px, correlation {correlation} px) is in {name} and in no camera file"
            ));
        }
        progress.finish(&format!("{} images", stations.len()));
        Ok(notes)
    }
}
