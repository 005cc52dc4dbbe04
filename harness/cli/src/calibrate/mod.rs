//! `calibench calibrate`: a camera from measured points and control, or from photographs of a chessboard.

use std::path::PathBuf;

use calibench_calibrate::{
    BoardShape, Calibration, CalibrationError, DatumChoice, Discs, GrossErrors, MOST_TRIED, Optics, Risk, Settings, Suspected, calibrate,
    prepare, prepare_free, suspected,
};
use calibench_cameras::inputs_of;
use calibench_exchange::{PointFile, read_control, read_distances, read_observed_stations};
use calibench_files::{Inputs, OutputFile, OutputFolder};
use calibench_images::Reading;
use calibench_model::boards::Board;
use calibench_model::camera::ImageSize;
use calibench_model::{ControlRow, CornerPoint, LostRows, Points};
use calibench_photographs::{Corners, Photo, Reader};
use calibench_report::calibration::{Pictured, scene_ply, summary, write_report};
use calibench_report::json::CalibrationAnswer;
use clap::Args;

use super::context::{Context, finder};
use super::convert::positive;
use super::frames::{Frames, Taken, Wanted};
use super::photos::AsRead;
use super::reading::Origin;
use super::{inputs, output, reading};
use crate::board::{HELP, board_of};
use crate::deliver::{As, answer, print};
use crate::failure::Failure;

mod board;
mod camera_file;
mod cameras;
pub mod certificate;
mod photographs;
mod reconstruction;
mod rig;
mod splined;

use board::BoardArguments;
use cameras::Cameras;
use certificate::Asked;
pub use photographs::corners;
pub use rig::{patterns, places, rig_names};

#[derive(Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of the command line")]
pub struct Calibrate {
    /// Photographs of a board, a folder of them, or a video, in place of --points and --control
    #[arg(value_name = "PHOTO", requires = "board")]
    photos: Vec<PathBuf>,
    #[arg(long, visible_alias = "chessboard", value_name = "BOARD", value_parser = board_of, help = HELP, requires = "photos")]
    board: Option<Board>,
    /// Each of several such boards in a photograph, from the left: each is a view, PHOTO#1, PHOTO#2, ..., with a pose of its own
    #[arg(long, requires = "photos")]
    all: bool,
    /// The method that measures the board's points [default: parametric_corner; of circles and rings ellipse_edges, of corners of markers that stand alone parametric_junction]
    #[arg(short, long, value_name = "METHOD", requires = "photos")]
    method: Option<String>,
    #[command(flatten)]
    read: AsRead,
    /// Leave out photographs of another size, px
    #[arg(long, value_name = "WxH", value_parser = reading::size, requires = "photos")]
    only_size: Option<ImageSize>,
    #[command(flatten)]
    frames: Frames,
    /// Measured points: CSV with image,target,x,y, as `measure` writes it
    #[arg(long, value_name = "CSV", required_unless_present_any = ["photos", "reconstruction"], conflicts_with = "photos")]
    points: Option<PathBuf>,
    /// What (0, 0) is in the file of --points [default: centre]
    #[arg(long, value_enum, value_name = "ORIGIN", requires = "points")]
    origin: Option<Origin>,
    /// Control points: CSV with target,X,Y,Z, and optionally sX,sY,sZ; without them the network is free, and coordinates come from the images
    #[arg(long, value_name = "CSV", conflicts_with = "photos")]
    control: Option<PathBuf>,
    /// Coordinates near the true ones, of targets that are no control: CSV with target,X,Y,Z; start values of a free network
    #[arg(long, value_name = "CSV", conflicts_with_all = ["photos", "control"])]
    approx: Option<PathBuf>,
    /// Measured distances between targets, as of scale bars: CSV with target_a,target_b,distance,sigma, in object units
    #[arg(long, value_name = "CSV")]
    distances: Option<PathBuf>,
    /// The adjusted length between two targets with its standard deviation; may stand several times
    #[arg(long, value_name = "TARGET,TARGET", value_parser = ends)]
    length: Vec<[String; 2]>,
    #[command(flatten)]
    cameras: Cameras,
    #[command(flatten)]
    rig: rig::RigArguments,
    #[command(flatten)]
    splined: splined::SplinedArguments,
    #[command(flatten)]
    reconstruction: reconstruction::ReconstructionArguments,
    /// What fixes the object's frame: control (weighted where the file gives standard deviations), fixed, free, free:A,B,C,... (these targets stay closest to their start values), or minimal:A,B,C,D,E (X and Y of two, Z of three) [default: control; without --control free]
    #[arg(long, value_name = "DATUM")]
    datum: Option<DatumChoice>,
    /// Shape of a board of control points: tested (bent where the points say so), flat, bent (a surface of second order), bent-axes (mrcal's two parameters), or free (every point, as with --datum free) [default: tested]
    #[arg(long, value_name = "SHAPE")]
    board_shape: Option<BoardShape>,
    #[command(flatten)]
    known: BoardArguments,
    /// A-priori standard deviation of an image coordinate, px [default: 0.1, and the estimated one in tests]
    #[arg(long, value_name = "PX", value_parser = positive, allow_negative_numbers = true)]
    sigma: Option<f64>,
    /// How well a camera must be known over its frame, px: the standard deviation of the image of a point far away, RMS; beyond it the exit code is 3 [default: 1 % of the longer side, 5 px at most]
    #[arg(long, value_name = "PX", value_parser = positive, allow_negative_numbers = true)]
    limit: Option<f64>,
    /// Weigh image points by the covariances of the point file
    #[arg(long)]
    covariances: bool,
    /// Take the eccentricity of discs out, as the centre of a disc's picture is not the picture of its centre: their radius in object units, or `control` where the control file has the column radius. Planes are the control file's nX,nY,nZ, or those of each disc's neighbours
    #[arg(long, value_name = "RADIUS", conflicts_with = "photos")]
    eccentricity: Option<Discs>,
    /// Robust weights: bound in standard deviations of an image point, as the residuals show them, as in 2
    #[arg(long, value_name = "K", value_parser = positive, allow_negative_numbers = true)]
    huber: Option<f64>,
    /// Leave out all image points that Baarda's test rejects, one of a thousand good ones too [default: where residuals are not those of normal errors, points that are wrong for themselves]
    #[arg(long, conflicts_with = "huber")]
    snoop: bool,
    /// Keep all image points with equal weights, whatever their errors are
    #[arg(long, conflicts_with_all = ["huber", "snoop"])]
    plain: bool,
    /// Observed poses: a station file with sX0,sY0,sZ0 (object units) or sx_deg,sy_deg,sz_deg (about the camera's axes) or both
    #[arg(long, value_name = "CSV")]
    poses: Option<PathBuf>,
    /// Sets of parameters to compare, as in "c,x0,y0,k1;c,x0,y0,k1,k2": sigma0, tests, change of the camera
    #[arg(long, value_name = "SETS", value_delimiter = ';')]
    compare: Vec<String>,
    /// The camera file [default: none is written]; of several cameras, where the format holds one, a file for each: NAME-CAMERA.ENDING; of a rig a folder
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Convention or tool of the camera file, as for `convert` [default: by model and ending]
    #[arg(long, value_name = "CONVENTION", requires = "output")]
    to: Option<String>,
    /// Folder for a report with pictures and tables; of one that is there, only what calibench wrote is replaced, and if it holds anything else it is refused
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    /// The certificate of the camera as PDF: parameters, uncertainty budget, map, digests of all files
    #[arg(long, value_name = "PDF")]
    certificate: Option<PathBuf>,
    #[command(flatten)]
    said: certificate::Said,
    /// The network as a mesh (PLY) for other viewers: stations, object points and their error ellipsoids
    #[arg(long, value_name = "PLY")]
    scene: Option<PathBuf>,
    #[command(flatten)]
    answered: As,
}

/// Where results go.
struct Outputs {
    camera: Option<OutputFile>,
    scene: Option<OutputFile>,
    board: Option<OutputFile>,
    report: Option<OutputFolder>,
    certificate: Option<Asked>,
}

/// What is calibrated from.
struct Input {
    points: Points,
    /// Without a position.
    lost: LostRows,
    /// Where the points were measured here.
    photos: Vec<Photo>,
    /// How they were read.
    reading: Reading,
    control: Vec<ControlRow>,
    /// Nothing of the object is known but start values, where `control` has them.
    is_free: bool,
    /// What is in doubt of where a board was found.
    doubts: Vec<String>,
}

impl Calibrate {
    pub fn run(mut self, context: &Context<'_>) -> Result<(), Failure> {
        let taken = self.taken(context)?;
        self.photos.clone_from(&taken.photos);
        if let Some(grid) = self.spline_grid()? {
            return self.run_splined(grid, &taken.doubts, context);
        }
        self.splined.without_splines()?;
        if self.rig.is_asked() {
            return self.run_rig(context);
        }
        if let Some(path) = &self.reconstruction.path {
            return self.run_reconstruction(path, context);
        }
        let given = [&self.points, &self.control, &self.approx, &self.distances, &self.poses].into_iter().flatten().cloned();
        let inputs = inputs_of(self.photos.iter().cloned().chain(given).chain(self.known.inputs().cloned()).chain(self.cameras.starts()));
        let outputs = self.outputs(&inputs)?;
        let Input { points, lost, photos, reading, control, is_free, mut doubts } = self.input(context)?;
        taken.doubts.iter().for_each(|doubt| say!("in doubt: {doubt}"));
        doubts.extend(taken.doubts.iter().cloned());
        // A board of discs says how large they are: the centre of a disc's picture is not the picture of its centre.
        let of_discs = !photos.is_empty() && control.iter().any(|row| row.disc.is_some());
        let settings = self.settings(&photos, self.eccentricity.or(of_discs.then_some(Discs::Control)))?;
        let sets = sets(&self.compare)?;
        // What the inputs may be in truth is asked of few enough points.
        let given = (points.len() <= MOST_TRIED && !is_free).then(|| points.clone());
        let suspects = |found: Result<&Calibration<'_>, &CalibrationError>| {
            given.as_ref().map_or_else(Vec::new, |points| suspected(points, &control, &settings, found))
        };
        let explained = |error: CalibrationError| {
            let lines = suspects(Err(&error)).iter().map(|found| format!("\nsuspected: {}", found.words())).collect::<String>();
            Failure::input(format!("{error}{lines}"))
        };
        let prepared = if is_free { prepare_free(points, &control, &settings) } else { prepare(points, &control, &settings) };
        let mut prepared = prepared.map_err(explained)?;
        prepared.unmeasured = lost;
        calibrate(&prepared, &sets, |calibration| {
            let in_doubt = !(calibration.doubts().is_empty() && doubts.is_empty());
            let suspects = if in_doubt { suspects(Ok(calibration)) } else { Vec::new() };
            // What one place refuses is not lost for the others.
            let told = self.tell(calibration, &doubts, &suspects);
            let delivered = self.deliver(calibration, (&photos, reading, &doubts), &suspects, (&outputs, &control));
            let is_certified_in_doubt = told.and(delivered)?;
            if in_doubt || is_certified_in_doubt { Err(Failure::Doubt) } else { Ok(()) }
        })
        .map_err(explained)?
    }

    /// The photographs, or the frames in the place of them.
    fn taken(&self, context: &Context<'_>) -> Result<Taken, Failure> {
        let is_one = !self.cameras.are_several() && !self.rig.is_asked();
        let board = self.board.filter(|_| is_one);
        let wanted = Wanted { command: "calibrate", board, each: self.all, read: &self.read, only_size: self.only_size };
        let taken = self.frames.taken(&self.photos, &wanted, context)?;
        if taken.is_passing() && self.certificate.is_some() {
            return Err(Failure::input(
                "--certificate: has the digests of all photographs, and frames of a video pass; expected --save-frames DIR, which keeps them",
            ));
        }
        Ok(taken)
    }

    fn outputs(&self, inputs: &Inputs) -> Result<Outputs, Failure> {
        let report = self.report.as_deref().map(|path| output::folder("--report", path, inputs, ("calibrate", None))).transpose()?;
        let camera = self.output.as_deref().map(|path| output::camera("-o", path, self.to.is_some(), inputs)).transpose()?;
        let scene = self.scene.as_deref().map(|path| output::scene("--scene", path, inputs)).transpose()?;
        let certificate = self.certified(inputs)?;
        let board = self.known.output(inputs)?;
        output::distinct(("-o", camera.as_ref()), ("--save-board", board.as_ref()))?;
        Ok(Outputs { camera, scene, board, report, certificate })
    }

    fn input(&self, context: &Context<'_>) -> Result<Input, Failure> {
        let given = self.control.as_ref().or(self.approx.as_ref());
        match (&self.points, given, self.board) {
            (Some(points), control, _) => {
                self.read.without_photographs()?;
                let PointFile { mut points, lost } = inputs::measured(points)?;
                if let Some(Origin::Corner) = self.origin {
                    points.move_each(|at| CornerPoint { x: at.x, y: at.y }.to_pixel());
                }
                Ok(Input {
                    points,
                    lost,
                    photos: Vec::new(),
                    reading: Reading::default(),
                    control: control.map_or(Ok(Vec::new()), |path| read_control(path))?,
                    is_free: self.control.is_none(),
                    doubts: Vec::new(),
                })
            }
            (_, _, Some(board)) => {
                let finder = finder(board)?.of_each(self.all);
                let (Corners { points, lost, photos, doubts }, reading) =
                    corners(context, &finder, &|| self.reader(), self.method.as_deref())?;
                let (points, lost) = (points.iter().collect(), lost.into_iter().collect());
                Ok(Input { points, lost, photos, reading, control: self.known.corners(finder.control())?, is_free: false, doubts })
            }
            _ => Err(Failure::input("expected --points and --size, with --control or --distances, or photographs and --board")),
        }
    }

    /// What reads the photographs. Of several cameras each has its own size and orientation.
    fn reader(&self) -> Result<Reader, Failure> {
        if self.cameras.are_several() || self.rig.is_asked() {
            self.read.reader(&self.photos)
        } else {
            self.read.of_one_camera(&self.photos, self.only_size)
        }
    }

    fn settings(&self, photos: &[Photo], discs: Option<Discs>) -> Result<Settings, Failure> {
        self.settings_of(self.cameras.optics(photos)?, discs)
    }

    fn settings_of(&self, cameras: Vec<Optics>, discs: Option<Discs>) -> Result<Settings, Failure> {
        Ok(Settings {
            datum: self.datum(),
            distances: self.distances.as_deref().map(read_distances).transpose()?.unwrap_or_default(),
            lengths: self.length.clone(),
            shape: self.known.shape(self.board_shape)?,
            board: self.known.stated(),
            gross: self.gross(),
            sigma_px: self.sigma,
            limit_px: self.limit,
            covariances: self.covariances,
            discs,
            stations: self.poses.as_deref().map(read_observed_stations).transpose()?.unwrap_or_default(),
            ..Settings::new(cameras)
        })
    }

    /// Without control there is no frame but that of the targets themselves.
    fn datum(&self) -> DatumChoice {
        let is_free = self.reconstruction.path.is_some() || (self.points.is_some() && self.control.is_none());
        self.datum.clone().unwrap_or(if is_free { DatumChoice::Free } else { DatumChoice::Control })
    }

    fn gross(&self) -> GrossErrors {
        match self.huber {
            Some(bound) => GrossErrors::Weighted(bound),
            None if self.snoop => GrossErrors::Rejected(Risk::EachPoint),
            None if self.plain => GrossErrors::Kept,
            None => GrossErrors::Sought,
        }
    }

    fn tell(&self, calibration: &Calibration<'_>, doubts: &[String], suspects: &[Suspected]) -> Result<(), Failure> {
        if self.answered.json {
            answer(&CalibrationAnswer::new(calibration, doubts, suspects).map_err(Failure::Input)?)
        } else {
            let lines = suspects.iter().map(|found| format!("suspected: {}\n", found.words())).collect::<String>();
            print(&(summary(calibration) + &lines))
        }
    }

    fn deliver(
        &self,
        calibration: &Calibration<'_>,
        (photos, reading, doubts): (&[Photo], Reading, &[String]),
        suspects: &[Suspected],
        (outputs, control): (&Outputs, &[ControlRow]),
    ) -> Result<bool, Failure> {
        let (photos_measured, found) = (photos, doubts);
        let doubts: Vec<String> = doubts.iter().cloned().chain(suspects.iter().map(Suspected::words)).collect();
        let photos: Vec<Pictured<'_>> = photos.iter().map(|(name, path, _)| (name.as_str(), path.as_path(), reading)).collect();
        let camera = outputs.camera.as_ref().map_or(Ok(()), |output| camera_file::write(output, calibration, self.to.as_deref()));
        let scene = outputs.scene.as_ref().map_or(Ok(()), |output| output.write(|file| file.write_all(scene_ply(calibration).as_bytes())));
        let recorded = self.recorded(calibration, (photos_measured, found, suspects), outputs);
        let report = |folder: &OutputFolder| {
            folder.replace(|folder| {
                write_report(calibration, &photos, &doubts, folder)?;
                recorded.as_ref().ok().and_then(Option::as_ref).map_or(Ok(()), |recorded| recorded.put(folder))
            })
        };
        let report = outputs.report.as_ref().map_or(Ok(()), report);
        let board = BoardArguments::deliver(outputs.board.as_ref(), calibration, control);
        camera?;
        scene?;
        board?;
        report?;
        recorded?.zip(outputs.certificate.as_ref()).map_or(Ok(false), |(recorded, (output, fields))| recorded.write(fields, output))
    }
}

/// Two targets from `A,B`.
fn ends(text: &str) -> Result<[String; 2], String> {
    let names: Vec<String> = text.split(',').map(|name| name.trim().to_owned()).collect();
    match <[String; 2]>::try_from(names) {
        Ok(ends) if ends.iter().all(|name| !name.is_empty()) => Ok(ends),
        _ => Err(format!("`{text}` is no pair of targets: expected two names with a comma, as in 506,507")),
    }
}

/// Sets of parameters from their texts; a name that stands twice counts once.
fn sets(texts: &[String]) -> Result<Vec<Vec<String>>, Failure> {
    let set = |text: &String| {
        let mut names: Vec<String> = Vec::new();
        for name in text.split(',').map(str::trim) {
            if name.is_empty() {
                return Err(Failure::input(format!("--compare: `{text}` is no set of parameters: expected names, as in c,x0,y0,k1")));
            }
            if !names.iter().any(|known| known == name) {
                names.push(name.to_owned());
            }
        }
        Ok(names)
    };
    texts.iter().map(set).collect()
}
