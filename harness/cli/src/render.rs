//! `calibench render`.

use std::path::PathBuf;

use calibench_exchange::{Fingerprint, RENDERED, RenderedImage, write_rendered};
use calibench_files::NewFolder;
use calibench_images::encode_png;
use calibench_model::camera::CameraModel;
use calibench_model::{Image, Points, Start};
use calibench_random::Key;
use calibench_records::names::kept_image_name;
use calibench_run::prepared::{self, Prepared, PreparedView};
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
    /// The first N trials in place of one; the names of images and what is written of each say the trial
    #[arg(long, value_name = "N", conflicts_with = "trial", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    trials: Option<u64>,
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
    row: truth::StationRow,
    starts: Vec<(&'p str, Start)>,
    listed: RenderedImage,
    notes: Vec<String>,
}

/// What is written of all trials together.
#[derive(Default)]
struct Lists {
    images: Vec<RenderedImage>,
    starts: Points,
    notes: Vec<String>,
}

impl Render {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let scenario = context.scenario(&self.scenario)?;
        if self.trials.is_some_and(|trials| trials > 1) && scenario.is_deterministic() {
            let message = format!("--trials: nothing is random in `{}`, every trial would be the same; expected 1", scenario.name);
            return Err(Failure::input(message));
        }
        let project = context.folder()?;
        let output = output::folder("-o", &self.output, &context.inputs(&self.scenario, &scenario), ("render", project.as_deref()))?;
        let seed = self.seed.unwrap_or(scenario.seed);
        let key = |trial| Key { seed, of: &scenario.drawn, trial, view: "", target: "" };
        let trials = self.trials.map_or(self.trial..self.trial + 1, |trials| 0..trials);
        let mut lists = Lists::default();
        output.replace::<RunError>(|folder| {
            match &scenario.subject {
                Subject::Views(subject) => self.views(context, &scenario, subject, trials.map(key), folder, &mut lists)?,
                Subject::Scene(subject) => {
                    trials.map(key).try_for_each(|key| self.scene(&scenario.name, subject, key, folder, &mut lists))?;
                }
                Subject::Photographs(_) | Subject::Printed(_) => return Err(RunError::NothingToRender),
            }
            truth::write_starts(folder, "starts.csv", &lists.starts)?;
            Ok(folder.write(RENDERED, |file| write_rendered(file, &lists.images))?)
        })?;
        let mut notes = lists.notes;
        if let Some(sweep) = &scenario.sweep {
            notes.insert(0, format!("of the sweep's {} cells the first: {}", sweep.cells(), sweep.label(0)));
        }
        print(&format!("{}\n{}", self.output.display(), notes.iter().map(|note| format!("  {note}\n")).collect::<String>()))
    }

    /// What is written of `view` is called so.
    fn name(&self, view: &str, key: Key<'_>) -> String {
        if self.trials.is_some() { format!("{view}-trial-{:04}", key.trial) } else { view.to_owned() }
    }

    /// An image in the list of images of a scenario.
    fn listed(&self, scenario: &str, view: &str, (image, deep): (&Image, bool), key: Key<'_>) -> RenderedImage {
        RenderedImage {
            image: kept_image_name(&self.name(view, key)),
            scenario: scenario.to_owned(),
            seed: key.seed,
            trial: key.trial,
            view: view.to_owned(),
            fingerprint: Fingerprint::of(image, deep),
        }
    }

    /// Draws the image of one station.
    fn station<'p>(
        &self,
        scenario: &str,
        prepared: &'p Prepared<'_>,
        view: &'p PreparedView<'_>,
        key: Key<'_>,
        folder: &NewFolder,
    ) -> Result<Drawn<'p>, RunError> {
        let name = self.name(&view.station.name, key);
        let (exposure, deep) = (prepared.image(view, key)?, prepared.is_deep());
        let (written, (starts, listed)) = rayon::join(
            || folder.write(&kept_image_name(&name), |file| encode_png(file, &exposure.image, deep)),
            || {
                (
                    prepared::starts(prepared, view, &exposure.image, key),
                    self.listed(scenario, &view.station.name, (&exposure.image, deep), key),
                )
            },
        );
        written?;
        if self.noise_free {
            folder.write(&format!("{name}{NOISE_FREE}.png"), |file| encode_png(file, &prepared.irradiance(view), true))?;
        }
        truth::write_view(folder, &name, prepared.subject, view)?;
        let clipped = truth::clipping_note(&name, exposure.clipped, exposure.image.grey().len());
        Ok(Drawn {
            row: truth::StationRow::new(view.station, &name, exposure.clipped),
            starts,
            listed,
            notes: clipped.into_iter().chain(truth::warnings(view, &name)).collect(),
        })
    }

    fn scene(&self, scenario: &str, subject: &SceneSubject, key: Key<'_>, folder: &NewFolder, lists: &mut Lists) -> Result<(), RunError> {
        if let Some(name) = self.stations.iter().find(|name| *name != VIEW) {
            return Err(RunError::NoStation { name: name.clone(), known: VIEW.into() });
        }
        let (key, name) = (Key { view: VIEW, ..key }, self.name(VIEW, key));
        let scene = trial_truth(subject, key);
        let renderer = subject.renderer()?;
        let exposure = trial_picture(subject, &renderer, &scene, key)?;
        folder.write(&kept_image_name(&name), |file| encode_png(file, &exposure.image, subject.is_deep()))?;
        if self.noise_free {
            let picture = calibench_synth::raster::Picture::from(&scene);
            let noise_free = renderer.render(&picture, &[]);
            folder.write(&format!("{name}{NOISE_FREE}.png"), |file| encode_png(file, &noise_free, true))?;
        }
        truth::write_scene(folder, &name, &scene)?;
        for (target, start) in scene.targets.iter().zip(starts(subject, &exposure.image, &scene, key)) {
            start.into_iter().for_each(|start| lists.starts.push(&kept_image_name(&name), &target.id, start));
        }
        lists.images.push(self.listed(scenario, VIEW, (&exposure.image, subject.is_deep()), key));
        lists.notes.extend(truth::clipping_note(&name, exposure.clipped, exposure.image.grey().len()));
        Ok(())
    }

    fn views<'k>(
        &self,
        context: &Context<'_>,
        scenario: &Scenario,
        subject: &ViewsSubject,
        trials: impl Iterator<Item = Key<'k>>,
        folder: &NewFolder,
        lists: &mut Lists,
    ) -> Result<(), RunError> {
        let mut rows = Vec::new();
        for key in trials {
            rows.extend(self.trial(context, scenario, subject, key, folder, lists)?);
        }
        truth::write_stations(folder, "stations.csv", &rows)?;
        truth::write_control(folder, "control.csv", subject)?;
        Ok(truth::write_camera(folder, "camera", &subject.camera)?)
    }

    /// Draws the images of one trial: the rows of its stations.
    fn trial(
        &self,
        context: &Context<'_>,
        scenario: &Scenario,
        subject: &ViewsSubject,
        key: Key<'_>,
        folder: &NewFolder,
        lists: &mut Lists,
    ) -> Result<Vec<truth::StationRow>, RunError> {
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
            let drawn = self.station(&scenario.name, &prepared, view, key, folder);
            progress.step();
            drawn
        };
        let mut rows = Vec::new();
        // In batches: as many images as threads are in memory, and a thread that waits for the bands of its image does not begin with another one.
        for batch in prepared.views.chunks(rayon::current_num_threads()) {
            let drawn = batch.par_iter().map(draw).collect::<Vec<Result<Drawn<'_>, RunError>>>();
            for one in drawn {
                let one = one?;
                one.starts.into_iter().for_each(|(target, start)| lists.starts.push(&one.listed.image, target, start));
                lists.notes.extend(one.notes);
                lists.images.push(one.listed);
                rows.push(one.row);
            }
        }
        if let Some(local) = subject.local_of(key)? {
            let name = format!("{}.csv", self.name(LOCAL_DISTORTION, key));
            truth::write_local(folder, &name, &local, subject.camera.size())?;
            let LocalDesign { sigma, correlation } = local.design();
            lists.notes.push(format!(
                "the camera's local distortion ({sigma} px, correlation {correlation} px) is in {name} and in no camera file"
            ));
        }
        progress.finish(&format!("{} images", stations.len()));
        Ok(rows)
    }
}
