//! Images of a twin, and what they look like.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use calibench_cameras::camera_bytes;
use calibench_cameras::for_file::for_file;
use calibench_exchange::write_board_corners;
use calibench_measure::Registry;
use calibench_model::camera::CameraModel;
use calibench_project::ProjectError;
use calibench_random::Key;
use calibench_run::prepared::Prepared;
use calibench_run::shots::{Shot, shots};
use calibench_scenario::{Scenario, Subject, parse};
use calibench_twin::{Design, Geometry, Look, Scene, ViewLook, written};
use rayon::prelude::*;
use tempfile::TempDir;

use super::modelled::Modelled;
use crate::failure::{Failure, project_failure};

/// The scenario's file.
pub const SCENARIO: &str = "twin.toml";
/// The camera's file.
pub const CAMERA: &str = "camera.json";
/// The board's file.
pub const BOARD: &str = "board.csv";
/// The folder of the images.
pub const IMAGES: &str = "images";

/// The files of camera and board that a twin's scenario names.
pub fn files(modelled: &Modelled) -> Result<[(&'static str, Vec<u8>); 2], Failure> {
    let made = for_file(Path::new(CAMERA), &modelled.camera, None).map_err(|error| Failure::input(error.to_string()))?;
    let camera = camera_bytes(made.format, &[made.camera]).map_err(|error| Failure::input(error.to_string()))?;
    let mut board = Vec::new();
    write_board_corners(&mut board, &modelled.corners)?;
    Ok([(CAMERA, camera), (BOARD, board)])
}

/// What makes images of a twin, in a folder of its own that passes.
pub struct Studio<'a> {
    folder: Arc<TempDir>,
    geometry: &'a Geometry,
    scene: Scene,
    registry: &'a Registry,
}

impl<'a> Studio<'a> {
    /// With the files of camera and board.
    pub fn new(modelled: &Modelled, geometry: &'a Geometry, scene: Scene, registry: &'a Registry) -> Result<Self, Failure> {
        let folder = tempfile::tempdir()?;
        for (name, content) in files(modelled)? {
            fs::write(folder.path().join(name), content)?;
        }
        Ok(Self { folder: folder.into(), geometry, scene, registry })
    }

    /// That every station pictures the board with this camera, whatever the light is.
    ///
    /// # Errors
    /// In words: a camera that folds within its frame.
    pub fn pictures_all(&self) -> Result<(), String> {
        let scenario = self.scenario(&self.text(&Design::widest(self.scene.stations.len()))).map_err(|failure| match failure {
            Failure::Input(why) | Failure::Picture(why) => why,
            Failure::Gate | Failure::Doubt => String::new(),
        })?;
        let Subject::Views(views) = &scenario.subject else { return Ok(()) };
        let key = Key { seed: scenario.seed, of: &scenario.drawn, trial: 0, view: "", target: "" };
        Prepared::new(views, key).map(|_| ()).map_err(|error| error.to_string())
    }

    /// The same without what a camera does to its raw pixels: no JPEG.
    pub fn raw(&self) -> Self {
        Self { folder: self.folder.clone(), scene: Scene { tables: None, ..self.scene.clone() }, ..*self }
    }

    /// The text of a design's scenario.
    pub fn text(&self, design: &Design) -> String {
        written(&self.scene, design)
    }

    /// A scenario whose files are those of the folder.
    pub fn scenario(&self, text: &str) -> Result<Scenario, Failure> {
        let file = self.folder.path().join(SCENARIO);
        let parsed = parse("twin", &file.display().to_string(), text, self.registry);
        parsed.map_err(|problems| project_failure(ProjectError::Problems(problems)))
    }

    /// Whether the images have more than 8 bits.
    pub const fn is_deep(&self) -> bool {
        self.scene.bits > 8
    }

    /// The names of the stations, in their order.
    fn names(&self) -> impl Iterator<Item = &String> {
        self.scene.stations.iter().map(|(name, _)| name)
    }

    /// What the images of a design look like.
    pub fn look(&self, design: &Design, trial: u64) -> Result<Option<Look>, Failure> {
        let scenario = self.scenario(&self.text(design))?;
        let looks = self.each(&scenario, trial, |shot| {
            let pose = shot.camera.map(|(_, pose)| pose);
            pose.map_or_else(ViewLook::default, |pose| ViewLook::of(&shot.image, self.geometry, &pose))
        })?;
        Ok(self.look_of(&looks))
    }

    /// What views that look so look like together.
    pub fn look_of(&self, looks: &[ViewLook]) -> Option<Look> {
        let size = self.geometry.camera.size();
        Look::of(looks, [f64::from(size.width), f64::from(size.height)], &self.sides())
    }

    /// The median side of squares by view, px.
    pub fn sides(&self) -> Vec<f64> {
        self.scene.stations.iter().map(|(_, pose)| self.geometry.side(pose)).collect()
    }

    /// What is asked of each image of a trial, in the order of the stations: no more than as many as threads are in memory.
    pub fn each<T: Send>(&self, scenario: &Scenario, trial: u64, ask: impl Fn(&Shot) -> T + Sync) -> Result<Vec<T>, Failure> {
        let one = |name: &String| {
            let shot = shots(scenario, self.scene.seed, trial, std::slice::from_ref(name))?;
            shot.first().map(&ask).ok_or_else(|| Failure::input(format!("the twin has no view {name}")))
        };
        self.names().collect::<Vec<_>>().into_par_iter().map(one).collect()
    }
}
