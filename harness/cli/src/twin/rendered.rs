//! Images of a twin, and what they look like.

use std::path::Path;

use calibench_cameras::camera_bytes;
use calibench_cameras::for_file::for_file;
use calibench_exchange::write_board_corners;
use calibench_files::NewFolder;
use calibench_measure::Registry;
use calibench_model::camera::CameraModel;
use calibench_project::ProjectError;
use calibench_run::shots::{Shot, shots};
use calibench_scenario::{Scenario, parse};
use calibench_twin::{Design, Geometry, Look, Scene, ViewLook, written};
use rayon::prelude::*;

use super::modelled::Modelled;
use crate::failure::{Failure, project_failure};

/// The scenario's file.
pub const SCENARIO: &str = "twin.toml";
/// The camera's file.
pub const CAMERA: &str = "camera.toml";
/// The board's file.
pub const BOARD: &str = "board.csv";
/// The folder of the images.
pub const IMAGES: &str = "images";

/// What makes images of a twin.
pub struct Studio<'a> {
    folder: &'a Path,
    geometry: &'a Geometry,
    scene: Scene,
    registry: &'a Registry,
}

impl<'a> Studio<'a> {
    /// With the files of camera and board, written to `folder`.
    pub fn new(folder: &'a NewFolder, modelled: &Modelled, geometry: &'a Geometry, scene: Scene, registry: &'a Registry) -> Result<Self, Failure> {
        let made = for_file(Path::new(CAMERA), &modelled.camera, None).map_err(|error| Failure::input(error.to_string()))?;
        let bytes = camera_bytes(made.format, &[made.camera]).map_err(|error| Failure::input(error.to_string()))?;
        folder.write::<Failure>(CAMERA, |file| Ok(file.write_all(&bytes)?))?;
        folder.write::<Failure>(BOARD, |file| Ok(write_board_corners(file, &modelled.corners)?))?;
        Ok(Self { folder: folder.path(), geometry, scene, registry })
    }

    /// The same without what a camera does to its raw pixels: no JPEG.
    pub fn raw(&self) -> Self {
        let scene = Scene { tables: None, ..self.scene.clone() };
        Self { scene, ..*self }
    }

    /// The text of a design's scenario.
    pub fn text(&self, design: &Design) -> String {
        let text = written(&self.scene, design); // TEMP
        text.lines().filter(|line| !["corners", "ragged", "ink_spread"].iter().any(|key| line.starts_with(key))).map(|line| format!("{line}\n")).collect()
    }

    /// A scenario whose files are those of the folder.
    pub fn scenario(&self, text: &str) -> Result<Scenario, Failure> {
        let file = self.folder.join(SCENARIO);
        parse("twin", &file.display().to_string(), text, self.registry).map_err(|problems| project_failure(ProjectError::Problems(problems)))
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
