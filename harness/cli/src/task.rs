//! `calibench task`: what something costs that a camera is to measure.

use std::path::{Path, PathBuf};

use calibench_cameras::{ReadOptions, inputs_of};
use calibench_exchange::read_control;
use calibench_files::bounded;
use calibench_model::boards::Board;
use calibench_model::camera::ImageSize;
use calibench_model::{ControlRow, NamedCamera};
use calibench_project::ProjectError;
use calibench_report::calibration::{CAMERAS_FILE, CalibratedCameras};
use calibench_report::json::TaskAnswer;
use calibench_report::task::{doubts, maps, of_task};
use calibench_task::{Budget, KnownCamera, Map, Task as Parsed, map, parse};
use clap::{ArgGroup, Args};

use super::context::finder;
use super::convert::positive;
use super::reading::shown;
use super::{inputs, output, reading};
use crate::board::board_of;
use crate::deliver::{As, answer, print};
use crate::failure::{Failure, project_failure};

/// Planes of a map at most.
const MOST_SLICES: usize = 6;

#[derive(Args)]
#[expect(clippy::struct_field_names, reason = "the file is one of a task")]
#[command(group(ArgGroup::new("known").required(true).args(["camera", "calibration"])))]
pub struct Task {
    /// What is measured, and from where: TOML with sigma (px), [measure] with length, point, angle, plane or rotation, [[image]] with centre and angles or target, and [known_plane] for a single image
    #[arg(value_name = "TASK")]
    task: PathBuf,
    /// A camera file of any known format, with the covariance of its parameters
    #[arg(long, value_name = "FILE")]
    camera: Option<PathBuf>,
    /// The folder that `calibrate --report` wrote: its camera with the whole covariance, what leaving photographs out shows of its model, and what is in doubt
    #[arg(long, value_name = "DIR")]
    calibration: Option<PathBuf>,
    /// Which of several cameras of the calibration
    #[arg(long, value_name = "NAME", requires = "calibration")]
    camera_name: Option<String>,
    /// Size of the images, for camera files that do not state it
    #[arg(long, value_name = "WxH", value_parser = reading::size, conflicts_with = "calibration")]
    size: Option<ImageSize>,
    /// By how many times cameras of halves of the photographs differ more than their covariances say, as `judge` tells it: the camera's model error [default: as leaving photographs out shows it, of --calibration]
    #[arg(long, value_name = "TIMES", value_parser = positive, allow_negative_numbers = true)]
    halves: Option<f64>,
    /// Control points that every image shows as well: CSV with target,X,Y,Z and, if known, sX,sY,sZ. Poses are those that these give, with the same camera, in place of stated ones
    #[arg(long, value_name = "CSV", conflicts_with = "board")]
    control: Option<PathBuf>,
    /// The same of a board that every image shows, as in 9x6:25, in the plane Z = 0
    #[arg(long, value_name = "BOARD", value_parser = board_of)]
    board: Option<Board>,
    /// Draw the interval over the volume, and what makes the most of it, as PNG, SVG or PDF by the ending
    #[arg(long, value_name = "PICTURE")]
    map: Option<PathBuf>,
    /// Planes of the map: how far from what is measured along the axis of the line of sight, object units, as in -200,0,200 [default: 0]
    #[arg(long, value_name = "OFFSETS", value_delimiter = ',', allow_hyphen_values = true, requires = "map")]
    slices: Vec<f64>,
    #[command(flatten)]
    answered: As,
}

/// A camera, what halves show of it, and what is in doubt of its calibration.
struct Known {
    named: NamedCamera,
    halves: Option<f64>,
    doubts: Vec<String>,
}

impl Task {
    pub fn run(&self) -> Result<(), Failure> {
        let cameras = self.calibration.as_ref().map(|folder| folder.join(CAMERAS_FILE));
        let read = [Some(&self.task), self.camera.as_ref(), cameras.as_ref(), self.control.as_ref()];
        let inputs = inputs_of(read.into_iter().flatten());
        let picture = self.map.as_deref().map(|path| output::picture("--map", path, &inputs)).transpose()?;
        let text = bounded::text(&self.task).map_err(|error| Failure::input(format!("{}: {error}", shown(&self.task))))?;
        let parsed = parse(&self.task.display().to_string(), &text);
        let task = parsed.map_err(|problems| project_failure(ProjectError::Problems(problems)))?;
        let slices = self.slices(&task)?;
        let known = self.known(cameras.as_deref())?;
        let control = self.control()?;
        let camera = KnownCamera { halves: self.halves.or(known.halves), ..KnownCamera::of(&known.named) };
        let refused = |error: calibench_task::TaskError| Failure::input(format!("{}: {error}", shown(&self.task)));
        let budget = Budget::of(&task, &camera, control.as_deref()).map_err(refused)?;
        let of_slice = |offset: &f64| map(&task, &camera, control.as_deref(), *offset).map_err(refused);
        let planes = slices.iter().map(of_slice).collect::<Result<Vec<Map>, Failure>>()?;
        let doubts = doubts(&budget, camera.covariance.is_some(), &known.doubts);
        if self.answered.json {
            answer(&TaskAnswer::new(&task, &budget, doubts.clone(), camera.halves, &planes))?;
        } else {
            print(&of_task(&task, &budget))?;
        }
        if let Some(picture) = picture {
            maps(&task, &budget, &planes).write(&picture)?;
        }
        doubts.iter().for_each(|doubt| say!("in doubt: {doubt}"));
        if doubts.is_empty() { Ok(()) } else { Err(Failure::Doubt) }
    }

    /// Offsets of the planes of the map; none without one.
    fn slices(&self, task: &Parsed) -> Result<Vec<f64>, Failure> {
        if self.map.is_none() {
            return Ok(Vec::new());
        }
        if self.slices.is_empty() {
            return Ok(vec![0.0]);
        }
        if task.plane.is_some() {
            return Err(Failure::input("--slices: the task has a known plane, and its map is that of this plane; leave them out"));
        }
        if self.slices.len() > MOST_SLICES || self.slices.iter().any(|offset| !offset.is_finite()) {
            return Err(Failure::input(format!("--slices: expected {MOST_SLICES} finite numbers at most, as in -200,0,200")));
        }
        Ok(self.slices.clone())
    }

    fn control(&self) -> Result<Option<Vec<ControlRow>>, Failure> {
        if let Some(board) = self.board {
            return Ok(Some(finder(board)?.control()));
        }
        Ok(self.control.as_deref().map(read_control).transpose()?)
    }

    fn known(&self, cameras: Option<&Path>) -> Result<Known, Failure> {
        match (&self.camera, cameras) {
            (Some(file), _) => Ok(Known {
                named: inputs::first(file, &ReadOptions { size: self.size, ..ReadOptions::default() })?,
                halves: None,
                doubts: Vec::new(),
            }),
            (None, Some(file)) => self.of_calibration(file),
            (None, None) => Err(Failure::input("expected --camera or --calibration")),
        }
    }

    fn of_calibration(&self, file: &Path) -> Result<Known, Failure> {
        let what = "is no file that `calibench calibrate --report` wrote; calibrate once more with this version";
        let text = bounded::text(file).map_err(|error| Failure::input(format!("{}: {error}; {what}", shown(file))))?;
        let found = CalibratedCameras::parse(&text).map_err(|error| Failure::input(format!("{}: {what} ({error})", shown(file))))?;
        let chosen = found.choose(self.camera_name.as_deref()).map_err(|why| Failure::input(format!("{}: {why}", shown(file))))?;
        Ok(Known { halves: chosen.halves(), named: chosen.named.clone(), doubts: found.doubts.clone() })
    }
}
