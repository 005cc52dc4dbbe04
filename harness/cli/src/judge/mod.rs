//! `calibench judge`: which operator, or which file of measured corners, and which camera model to trust.

use std::path::{Path, PathBuf};

use calibench_calibrate::choice::ModelChoice;
use calibench_calibrate::usual_limit_px;
use calibench_cameras::{first_camera, inputs_of};
use calibench_exchange::{read_board_corners, read_control};
use calibench_images::Reading;
use calibench_judge::{BENT, CornerFile, Field, Material, Options, field_of as field, judge, stated_sigma, usual_models, with_board};
use calibench_model::NamedCamera;
use calibench_model::boards::Board;
use calibench_model::camera::ImageSize;
use calibench_records::judgement::{InUse, StillHolds, Summary, Trusted};
use calibench_report::json::JudgementAnswer;
use calibench_report::judgement::{in_use as in_words, section, verdict};
use clap::Args;

use super::context::Context;
use super::convert::positive;
use super::frames::{Frames, Wanted};
use super::photos::AsRead;
use super::{output, reading};
use crate::board::{HELP, board_of};
use crate::deliver::{As, answer, print};
use crate::failure::Failure;
use crate::same_camera::for_images;

mod files;
mod page;
mod photographs;
mod rig;

use files::corner_file;

/// How far a camera in use may be off, px RMS over the frame, where nothing else is said.
const MARGIN: f64 = 1.0;

#[derive(Args)]
pub struct Judge {
    /// Photographs of a board, a folder of them, or a video, all by one camera: at least six
    #[arg(value_name = "PHOTO", required_unless_present = "points")]
    photos: Vec<PathBuf>,
    /// Points that were measured beforehand, in place of photographs: CSV with image,target,x,y; of a chessboard targets r1c1, r1c2, ... as `detect` and `control` name
    /// them, of --control its own. Each file stands for an operator, called as the file without its ending, or NAME; may be repeated, to compare files of the same images. Covariances are not used
    #[arg(long, value_name = "[NAME=]CSV", value_parser = corner_file, conflicts_with = "photos", requires = "size")]
    points: Vec<CornerFile>,
    /// Size of the images that --points are of, px
    #[arg(long, value_name = "WxH", value_parser = reading::size, requires = "points", conflicts_with = "photos")]
    size: Option<ImageSize>,
    #[arg(long, visible_alias = "chessboard", value_name = "BOARD", value_parser = board_of, help = HELP,
          required_unless_present = "control", conflicts_with = "control")]
    board: Option<Board>,
    /// The board's own corners, as `calibrate --save-board` writes them, in place of nominal ones; taken as exact
    #[arg(long, value_name = "CSV", requires = "board")]
    board_file: Option<PathBuf>,
    /// Each of several such boards in a photograph, from the left: each is a view, PHOTO#1, PHOTO#2, ..., with a pose of its own
    #[arg(long, requires = "photos")]
    all: bool,
    /// In place of a board: points of known object coordinates, as of a house, whose names the files of --points use: CSV with target,X,Y,Z and, if known, sX,sY,sZ
    #[arg(long, value_name = "CSV", requires = "points")]
    control: Option<PathBuf>,
    #[command(flatten)]
    read: AsRead,
    /// Leave out photographs of another size, px
    #[arg(long, value_name = "WxH", value_parser = reading::size, conflicts_with = "points")]
    only_size: Option<ImageSize>,
    #[command(flatten)]
    frames: Frames,
    /// Methods to compare, as in forstner:window=15 [default: all that make sense on chess corners; with --camera parametric_corner:window=15]
    #[arg(short, long = "method", value_name = "METHOD", conflicts_with = "points")]
    methods: Vec<String>,
    /// Camera models to compare, as in opencv5, opencv4:fx,fy,cx,cy with some of its parameters only, or opencv5+bent on a board that may be bent [default: fourteen
    /// from too poor to too rich]
    #[arg(long = "model", value_name = "MODEL")]
    models: Vec<String>,
    /// Pixel pitch, um, for models in mm; no figure in px depends on it [default: 10]
    #[arg(long, value_name = "UM", value_parser = positive, allow_negative_numbers = true)]
    pitch: Option<f64>,
    /// A camera file to compare with: a calibration that somebody made before
    #[arg(long, value_name = "FILE")]
    published: Option<PathBuf>,
    /// A camera file in use (with --rig that of a rig, as Kalibr's chain or OpenCV's stereo file): does it still hold on these photographs or points? Exit code 0 if it holds, 1 if it has moved, 3 if they cannot tell
    #[arg(long, value_name = "FILE", conflicts_with = "published")]
    camera: Option<PathBuf>,
    /// The camera of --camera or --published took the images, too, if they have the same aspect and another size: it is taken as it is in theirs
    #[arg(long)]
    same_camera: bool,
    /// Difference over the frame, px RMS, up to which --camera holds [default: that of --limit, or else 1]
    #[arg(long, value_name = "PX", requires = "camera", value_parser = positive, allow_negative_numbers = true)]
    margin: Option<f64>,
    /// How well the camera must be known over the frame, px: the standard deviation of the image of a point far away, RMS; beyond it the exit code is 3 [default: 1 % of the longer side, 5 px at most]. With --camera and without --margin: the difference up to which that camera holds, as for `diff`
    #[arg(long, value_name = "PX", value_parser = positive, allow_negative_numbers = true)]
    limit: Option<f64>,
    /// How often the photographs are split into halves
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..=1000))]
    splits: u64,
    /// Seed of the splits
    #[arg(long, value_name = "S", default_value_t = 0, value_parser = clap::value_parser!(u64).range(..=i64::MAX as u64))]
    seed: u64,
    #[command(flatten)]
    rig: rig::RigArguments,
    /// Folder for the page with its pictures and its numbers as CSV; of one that is there, only what calibench wrote is replaced, and if it holds anything else it is refused
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    #[command(flatten)]
    answered: As,
}

impl Judge {
    pub fn run(mut self, context: &Context<'_>) -> Result<(), Failure> {
        let board = self.board.filter(|_| !self.rig.is_asked());
        let wanted = Wanted { command: "judge", board, each: self.all, read: &self.read, only_size: self.only_size };
        let taken = self.frames.taken(&self.photos, &wanted, context)?;
        self.photos.clone_from(&taken.photos);
        if self.rig.is_asked() {
            return self.run_rig(context);
        }
        let models = self.models()?;
        let files = self.points.iter().map(|file| &file.path);
        let inputs = inputs_of(
            self.photos.iter().chain(files).chain(&self.published).chain(&self.camera).chain(&self.control).chain(&self.board_file),
        );
        let folder = self.report.as_deref().map(|path| output::folder("--report", path, &inputs, ("judge", None))).transpose()?;
        let (material, mut doubts, reading) = self.material(context)?;
        taken.doubts.iter().for_each(|doubt| say!("in doubt: {doubt}"));
        doubts.extend(taken.doubts.iter().cloned());
        let size = material.size;
        let published = self.camera.as_deref().or(self.published.as_deref());
        let published = published.map(|path| self.known_camera(path, size)).transpose()?;
        let options = Options {
            models,
            pitch_um: self.pitch,
            splits: self.splits,
            seed: self.seed,
            name: "judge".into(),
            published: published.as_ref().map(|named| named.camera),
            published_sigma: published.as_ref().and_then(stated_sigma),
        };
        let rows = judge(&material, &options)?;
        // Of a camera in use it is asked whether it holds, and nothing of the board.
        let of_board = self.board.is_some() && self.camera.is_none();
        let rows = if of_board { with_board(rows, &material, &options) } else { rows };
        // With a camera in use, which may differ by so much, --limit is of that unless --margin is.
        let is_of_use = self.camera.is_some() && self.margin.is_none();
        let limit_px = Some(self.limit.filter(|_| !is_of_use).unwrap_or_else(|| usual_limit_px(size)));
        let summary = Summary { limit_px, ..Summary::new(&rows, self.seed) };
        if let Some(folder) = folder {
            folder.replace(|folder| self.write(folder, (&material, &options, &doubts, reading), &rows, &summary))?;
        }
        let Some(trusted) = summary.trusted() else { return Err(Failure::input(section(&summary).0)) };
        let in_use = self.in_use(&trusted);
        if self.answered.json {
            answer(&JudgementAnswer::new(&summary, &trusted, in_use.as_ref(), &doubts))?;
        } else {
            in_use.iter().try_for_each(|found| print(&format!("- {}\n", in_words(found))))?;
            print(&verdict(&summary, &trusted))?;
        }
        let is_in_doubt = trusted.doubt().is_some() || !doubts.is_empty();
        match in_use.map(|found| found.verdict) {
            Some(StillHolds::Moved) => Err(Failure::Gate),
            Some(StillHolds::CannotTell) => Err(Failure::Doubt),
            None if is_in_doubt => Err(Failure::Doubt),
            // Of a camera in use the verdict allows for what is in doubt of the calibration, and not for a board that was found in the wrong place.
            Some(StillHolds::Holds) if !doubts.is_empty() => Err(Failure::Doubt),
            Some(StillHolds::Holds) | None => Ok(()),
        }
    }

    /// The camera of a file, for images of `size`.
    fn known_camera(&self, path: &Path, size: ImageSize) -> Result<NamedCamera, Failure> {
        let named = first_camera(path, &path.display().to_string(), size).map_err(Failure::input)?;
        for_images(path, &named, size, self.same_camera)
    }

    fn in_use(&self, trusted: &Trusted<'_>) -> Option<InUse> {
        self.camera.as_ref()?;
        // Where the two cannot be compared over the frame the photographs cannot tell.
        let margin = self.margin.or(self.limit).unwrap_or(MARGIN);
        Some(trusted.in_use(margin).unwrap_or(InUse::unknown(margin)))
    }

    fn models(&self) -> Result<Vec<ModelChoice>, Failure> {
        let of_board = self.board.is_some();
        let bent = |text: &str| text.ends_with(BENT);
        if let Some(text) = self.models.iter().find(|text| !of_board && bent(text)) {
            return Err(Failure::input(format!(
                "--model {text}: a board that may be bent is asked for, and --control is none; leave `{BENT}` out"
            )));
        }
        let texts = if self.models.is_empty() { usual_models(of_board) } else { self.models.clone() };
        ModelChoice::parse_all(&texts).map_err(|(place, error)| Failure::input(format!("--model {}: {error}", texts[place])))
    }

    /// The corners to judge by, measured here or read, and what is in doubt of where a board was found.
    fn material(&self, context: &Context<'_>) -> Result<(Material, Vec<String>, Reading), Failure> {
        if self.size.is_some() {
            self.read.without_photographs()?;
        }
        let read = |field, size| Ok((files::material(&self.points, field, size)?, Vec::new(), Reading::default()));
        match (self.size, &self.control, self.board) {
            (Some(size), Some(control), _) => read(Field::Points(read_control(control)?), size),
            (Some(size), None, Some(board)) => read(self.field_of(board)?, size),
            (_, _, Some(board)) => self.measured(context, board),
            // The arguments' own rules leave nothing else.
            _ => Err(Failure::input("expected --board, or --control with --points and --size")),
        }
    }
    /// What is judged by: a chessboard, or points of known coordinates; with the corners of a file where one is given.
    fn field_of(&self, board: Board) -> Result<Field, Failure> {
        let field = field(&board).map_err(|error| Failure::input(error.to_string()))?;
        let Some(path) = &self.board_file else { return Ok(field) };
        let corners = read_board_corners(path)?;
        field.measured(&corners).map_err(|error| Failure::input(format!("{}: {error}", path.display())))
    }
}
