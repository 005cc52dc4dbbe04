//! `calibench judge`: which operator and which camera model to trust on a folder of photographs.

use std::path::{Path, PathBuf};

use calibench_calibrate::choice::{HALF, ModelChoice};
use calibench_exchange::{Inputs, NewFolder, read_photo};
use calibench_judge::{JudgementError, Material, Options, judge, published_camera};
use calibench_measure::{BoardDetector, Configured};
use calibench_model::camera::ImageSize;
use calibench_photographs::names::{names, once};
use calibench_photographs::{Chessboard, measured_board};
use calibench_records::judgement::{JUDGEMENT, Row, Summary, write_rows};
use calibench_records::points::RunInfo;
use calibench_records::results::{MethodInfo, Trial};
use calibench_report::judgement::{section, verdict};
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

/// From too poor to too rich.
const MODELS: [&str; 7] = [
    "opencv4:fx,fy,cx,cy",
    "photogrammetric:c,x0,y0,k1",
    "photogrammetric:c,x0,y0,k1,k2",
    "photogrammetric",
    "opencv4",
    "opencv5",
    "opencv8",
];

#[derive(Args)]
pub struct Judge {
    /// Photographs of a chessboard, all by one camera: at least six
    #[arg(required = true, value_name = "PHOTO")]
    photos: Vec<PathBuf>,
    /// The chessboard's inner corners and the side of a square in object units, as in 9x6:25
    #[arg(long, value_name = "COLUMNSxROWS:SIDE")]
    chessboard: Chessboard,
    /// Methods to compare, as in forstner:window=15 [default: all that make sense on chess corners]
    #[arg(short, long = "method", value_name = "METHOD")]
    methods: Vec<String>,
    /// Camera models to compare, as in opencv5 or, with some of its parameters only, opencv4:fx,fy,cx,cy [default: seven from too poor to too rich]
    #[arg(long = "model", value_name = "MODEL")]
    models: Vec<String>,
    /// Pixel pitch, um, for models in mm; no figure in px depends on it [default: 10]
    #[arg(long, value_name = "UM", value_parser = positive, allow_negative_numbers = true)]
    pitch: Option<f64>,
    /// A camera file to compare with: a calibration that somebody made before
    #[arg(long, value_name = "FILE")]
    published: Option<PathBuf>,
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
        let inputs = Inputs::new(self.photos.iter().chain(&self.published));
        let folder = self.report.as_deref().map(|path| output::folder("--report", path, &inputs)).transpose()?;
        let (trial, size) = self.measure(context, &methods)?;
        let infos: Vec<MethodInfo> = methods.iter().map(info).collect();
        let material = Material::new(&trial, &infos, self.chessboard.board, self.chessboard.side, size);
        let published =
            self.published.as_deref().map(|path| published_camera(path, &path.display().to_string(), size).map_err(Failure::input));
        let published = published.transpose()?;
        let options = Options { models, pitch_um: self.pitch, splits: self.splits, seed: self.seed, name: "judge".into(), published };
        let rows = judge(&material, &options)?;
        let summary = Summary::new(&rows, self.seed);
        if let Some(folder) = folder {
            folder.replace(|folder| self.write(folder, &rows, &summary))?;
        }
        match summary.trusted() {
            Some(trusted) => print(&verdict(&summary, &trusted)),
            None => Err(Failure::input(section(&summary).0)),
        }
    }

    fn models(&self) -> Result<Vec<ModelChoice>, Failure> {
        let texts: Vec<String> = if self.models.is_empty() { MODELS.map(str::to_owned).to_vec() } else { self.models.clone() };
        ModelChoice::parse_all(&texts).map_err(|(place, error)| Failure::input(format!("--model {}: {error}", texts[place])))
    }

    fn methods(&self, context: &Context<'_>) -> Result<Vec<Configured>, Failure> {
        let texts: Vec<String> = if self.methods.is_empty() { METHODS.map(str::to_owned).to_vec() } else { self.methods.clone() };
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
        for (name, picture) in &pictures {
            folder.write(name, |file| picture.encode(file))?;
        }
        let (board, side) = (self.chessboard.board, self.chessboard.side);
        let text = format!(
            "# Which operator and which model to trust on these photographs\n\nMade by `calibench judge` from {} photographs of a chessboard of {} x {} inner \
             corners, squares of {side}. Everything here is in `{JUDGEMENT}`, a row for each figure.\n\n{}\n",
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
