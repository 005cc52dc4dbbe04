//! `calibench judge`: which operator and which camera model to trust on a folder of photographs.

use std::path::{Path, PathBuf};

use calibench_calibrate::choice::{HALF, ModelChoice};
use calibench_exchange::{Inputs, NewFolder, read_photo};
use calibench_judge::{JudgementError, Material, Options, judge, published_camera, stated_sigma};
use calibench_measure::{BoardDetector, Configured};
use calibench_model::camera::ImageSize;
use calibench_photographs::names::{names, once};
use calibench_photographs::{Chessboard, measured_board};
use calibench_records::judgement::{InUse, JUDGEMENT, Row, StillHolds, Summary, Trusted, write_rows};
use calibench_records::points::RunInfo;
use calibench_records::results::{MethodInfo, Trial};
use calibench_report::judgement::{in_use as in_words, section, verdict};
use clap::Args;
use rayon::prelude::*;

use super::context::Context;
use super::convert::positive;
use super::output;
use super::photos::{one_size, say_turns};
use super::progress::Progress;
use crate::deliver::print;
use crate::failure::Failure;

/// What makes sense on a chessboard's corners.
const METHODS: [&str; 9] = [
    "pixel",
    "forstner:window=11",
    "forstner:window=11,iterations=20",
    "saddle:window=7",
    "harris_paraboloid:window=11",
    "opencv_subpix:window=11",
    "parametric_corner:window=15",
    "lsm:window=15,shape=2,sharpness=1",
    "chess_corners",
];

/// What measures when a calibration in use is checked.
const OF_CAMERA: &str = "parametric_corner:window=15";

/// From too poor to too rich, on a flat board and on one that may be bent.
const MODELS: [&str; 13] = [
    "opencv4:fx,fy,cx,cy",
    "opencv4:fx,fy,cx,cy,k1",
    "opencv4:fx,fy,cx,cy,k1,k2",
    "opencv5:fx,fy,cx,cy,k1,k2,k3",
    "opencv4",
    "opencv5",
    "opencv8",
    "opencv-fisheye",
    "photogrammetric",
    "opencv4+bent",
    "opencv5+bent",
    "opencv8+bent",
    "opencv-fisheye+bent",
];

#[derive(Args)]
pub struct Judge {
    /// Photographs of a chessboard, all by one camera: at least six
    #[arg(required = true, value_name = "PHOTO")]
    photos: Vec<PathBuf>,
    /// The chessboard's inner corners and the side of a square in object units, as in 9x6:25
    #[arg(long, value_name = "COLUMNSxROWS:SIDE")]
    chessboard: Chessboard,
    /// Methods to compare, as in forstner:window=15 [default: all that make sense on chess corners; with --camera parametric_corner:window=15]
    #[arg(short, long = "method", value_name = "METHOD")]
    methods: Vec<String>,
    /// Camera models to compare, as in opencv5, opencv4:fx,fy,cx,cy with some of its parameters only, or opencv5+bent on a board that may be bent [default: thirteen
    /// from too poor to too rich]
    #[arg(long = "model", value_name = "MODEL")]
    models: Vec<String>,
    /// Pixel pitch, um, for models in mm; no figure in px depends on it [default: 10]
    #[arg(long, value_name = "UM", value_parser = positive, allow_negative_numbers = true)]
    pitch: Option<f64>,
    /// A camera file to compare with: a calibration that somebody made before
    #[arg(long, value_name = "FILE")]
    published: Option<PathBuf>,
    /// A camera file in use: does it still hold on these photographs? Exit code 0 if it holds, 1 if it has moved, 3 if they cannot tell
    #[arg(long, value_name = "FILE", conflicts_with = "published")]
    camera: Option<PathBuf>,
    /// Difference over the frame, px RMS, up to which --camera holds
    #[arg(long, value_name = "PX", default_value_t = 1.0, requires = "camera", value_parser = positive, allow_negative_numbers = true)]
    margin: f64,
    /// How often the photographs are split into halves
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..=1000))]
    splits: u64,
    /// Seed of the splits
    #[arg(long, value_name = "S", default_value_t = 0, value_parser = clap::value_parser!(u64).range(..=i64::MAX as u64))]
    seed: u64,
    /// Folder for the page with its pictures and its numbers as CSV; of one that is there, only what calibench wrote is replaced, and if it holds anything else it is refused
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
}

impl Judge {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let models = self.models()?;
        let methods = self.methods(context)?;
        let needed = 2 * HALF;
        if self.photos.len() < needed {
            return Err(JudgementError::TooFewViews { found: self.photos.len(), needed }.into());
        }
        once(&self.photos)?;
        let inputs = Inputs::new(self.photos.iter().chain(&self.published).chain(&self.camera));
        let folder = self.report.as_deref().map(|path| output::folder("--report", path, &inputs)).transpose()?;
        let (trial, size) = self.measure(context, &methods)?;
        let infos: Vec<MethodInfo> = methods.iter().map(info).collect();
        let material = Material::new(&trial, &infos, self.chessboard.board, self.chessboard.side, size);
        let published = self.camera.as_deref().or(self.published.as_deref());
        let published =
            published.map(|path| published_camera(path, &path.display().to_string(), size).map_err(Failure::input)).transpose()?;
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
        let summary = Summary::new(&rows, self.seed);
        if let Some(folder) = folder {
            folder.replace(|folder| self.write(folder, &rows, &summary))?;
        }
        let Some(trusted) = summary.trusted() else { return Err(Failure::input(section(&summary).0)) };
        let in_use = self.in_use(&trusted);
        in_use.iter().try_for_each(|found| print(&format!("- {}\n", in_words(found))))?;
        print(&verdict(&summary, &trusted))?;
        match in_use.map(|found| found.verdict) {
            Some(StillHolds::Moved) => Err(Failure::Gate),
            Some(StillHolds::CannotTell) => Err(Failure::Doubt),
            None if trusted.doubt().is_some() => Err(Failure::Doubt),
            Some(StillHolds::Holds) | None => Ok(()),
        }
    }

    fn in_use(&self, trusted: &Trusted<'_>) -> Option<InUse> {
        self.camera.as_ref()?;
        // Where the two cannot be compared over the frame the photographs cannot tell.
        let unknown = InUse { verdict: StillHolds::CannotTell, apart: f64::NAN, error: f64::INFINITY, margin: self.margin };
        Some(trusted.in_use(self.margin).unwrap_or(unknown))
    }

    fn models(&self) -> Result<Vec<ModelChoice>, Failure> {
        let texts: Vec<String> = if self.models.is_empty() { MODELS.map(str::to_owned).to_vec() } else { self.models.clone() };
        ModelChoice::parse_all(&texts).map_err(|(place, error)| Failure::input(format!("--model {}: {error}", texts[place])))
    }

    fn methods(&self, context: &Context<'_>) -> Result<Vec<Configured>, Failure> {
        let texts: Vec<String> = match (self.methods.is_empty(), &self.camera) {
            (false, _) => self.methods.clone(),
            (true, Some(_)) => vec![OF_CAMERA.to_owned()],
            (true, None) => METHODS.map(str::to_owned).to_vec(),
        };
        let methods = texts.iter().map(|text| context.method(text)).collect::<Result<Vec<_>, _>>()?;
        let twice = methods.iter().enumerate().find(|(i, method)| methods[..*i].iter().any(|earlier| earlier.label == method.label));
        match twice {
            Some((_, method)) => Err(Failure::input(format!("-m {}: asked for twice; expected each once", method.label))),
            None => Ok(methods),
        }
    }

    /// All corners of all photographs in the hands of all methods.
    fn measure(&self, context: &Context<'_>, methods: &[Configured]) -> Result<(Trial, ImageSize), Failure> {
        let detector = context.toolbox.detector.as_deref();
        let detector = detector.ok_or_else(|| Failure::input("this build has no chessboard detector (it is built without OpenCV)"))?;
        let progress = Progress::start("judge", self.photos.len() as u64, context.quiet);
        say_turns(&self.photos)?;
        let names = names(&self.photos);
        let one = |(path, name): (&PathBuf, &String)| {
            let found = self.one(path, name, detector, methods);
            progress.step();
            found
        };
        let found = self.photos.par_iter().zip(&names).map(one).collect::<Result<Vec<_>, Failure>>()?;
        let size = one_size(self.photos.iter().zip(found.iter().map(|(_, size)| *size)))?;
        let mut trial = Trial::default();
        for (view, _) in found {
            trial.points.extend(view.points);
            trial.missed_views.extend(view.missed_views);
        }
        let seen = self.photos.len() - trial.missed_views.len();
        progress.finish(&format!("the board was found in {seen} of {} photographs", self.photos.len()));
        for (view, why) in &trial.missed_views {
            say!("{view}: {why}");
        }
        Ok((trial, size))
    }

    fn one(&self, path: &Path, name: &str, detector: &dyn BoardDetector, methods: &[Configured]) -> Result<(Trial, ImageSize), Failure> {
        let image = read_photo(path)?.image;
        let trial = measured_board(&image, name, (detector, self.chessboard.board), methods);
        Ok((trial, ImageSize { width: image.width() as u32, height: image.height() as u32 }))
    }

    fn write(&self, folder: &NewFolder, rows: &[Row], summary: &Summary) -> std::io::Result<()> {
        let info = RunInfo { scenario: "judge".into(), seed: self.seed, revision: env!("CARGO_PKG_VERSION").into(), detector: None };
        folder.write(JUDGEMENT, |file| write_rows(file, &info, rows))?;
        let (text, pictures) = section(summary);
        let in_use = summary.trusted().and_then(|trusted| self.in_use(&trusted));
        let in_use = in_use.map_or_else(String::new, |found| format!("{}\n\n", in_words(&found)));
        for (name, picture) in &pictures {
            folder.write(name, |file| picture.encode(file))?;
        }
        let (board, side) = (self.chessboard.board, self.chessboard.side);
        let text = format!(
            "# Which operator and which model to trust on these photographs\n\nMade by `calibench judge` from {} photographs of a chessboard of {} x {} inner \
             corners, squares of {side}. Everything here is in `{JUDGEMENT}`, a row for each figure.\n\n{in_use}{}\n",
            self.photos.len(),
            board.columns,
            board.rows,
            text.trim_end()
        );
        folder.write("README.md", |file| file.write_all(text.as_bytes()))
    }
}

fn info(method: &Configured) -> MethodInfo {
    MethodInfo {
        label: method.label.as_str().into(),
        version: method.version.as_str().into(),
        unavailable: method.operator.as_ref().err().map(|why| (*why).to_owned()),
    }
}
