//! `calibench point`: a page to point at targets in a user's own photographs.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use calibench_cameras::inputs_of;
use calibench_exchange::points::parse_points;
use calibench_exchange::read_control;
use calibench_files::{OutputFile, bounded};
use calibench_model::{ControlRow, TargetKind};
use calibench_photographs::PhotographsError;
use calibench_photographs::names::{names, once};
use calibench_point::{Content, Loaded, write_page};
use clap::Args;

use crate::camera_files::ImagesFile;
use crate::context::Context;
use crate::failure::Failure;
use crate::output;
use crate::photos::{say_turns, with_folders};
use crate::progress::Progress;

mod serve;

/// Minutes after which a server ends.
const IDLE: f64 = 30.0;
/// What keeps points beside the photographs.
const POINTED: &str = "pointed.csv";
/// A page that is larger takes long to open, MB.
const LARGE: f64 = 150.0;

#[derive(Args)]
pub struct Point {
    /// Photographs, or a folder of them: PNG, JPEG, TIFF, PNM, BMP or WebP
    #[arg(required = true, value_name = "PHOTO")]
    photos: Vec<PathBuf>,
    /// Control points: CSV with target,X,Y,Z; their names are offered in this order, and with --serve predicted where they must be
    #[arg(long, value_name = "CSV")]
    control: Option<PathBuf>,
    /// Points that are shown, as `measure` writes them: with ellipses, and the reasons of those that were rejected; may be repeated
    #[arg(long, value_name = "CSV")]
    measured: Vec<PathBuf>,
    /// What the targets are, for methods that must know: a column of the points that the page saves
    #[arg(long, value_name = "KIND")]
    kind: Option<TargetKind>,
    /// The page: one file, which holds the photographs and asks for nothing
    #[arg(short, long, value_name = "HTML", required_unless_present = "serve", conflicts_with = "serve")]
    output: Option<PathBuf>,
    /// Instead of a file, serve the page to browsers on this machine alone, at an address that is printed, and measure what is pointed at; ends by Ctrl-C, or when nobody uses the page
    #[arg(long)]
    serve: bool,
    /// With --serve: the method, as in forstner:window=15 [default: forstner]
    #[arg(short, long, value_name = "METHOD")]
    method: Option<String>,
    /// With --serve: a camera for the predictions, a file of any known format; of several cameras IMAGES=FILE, as in left*=left.yaml
    #[arg(long = "camera", value_name = "[IMAGES=]FILE")]
    cameras: Vec<ImagesFile>,
    /// With --serve: the camera of a file took the photographs, too, if they have the same aspect and another size: it is taken as it is in theirs
    #[arg(long)]
    same_camera: bool,
    /// With --serve: the table that keeps what is pointed at; what is in it is shown, and changes are merged into it by target [default: pointed.csv beside the first photograph]
    #[arg(long, value_name = "CSV")]
    points: Option<PathBuf>,
    /// With --serve: end after so many minutes in which nobody used the page [default: 30]
    #[arg(long, value_name = "MINUTES", value_parser = minutes, allow_negative_numbers = true)]
    idle: Option<f64>,
}

fn minutes(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|minutes| (0.01..=1e5).contains(minutes)).ok_or_else(|| "expected minutes, from 0.01 to 100000".to_owned())
}

impl Point {
    pub fn run(mut self, context: &Context<'_>) -> Result<(), Failure> {
        self.photos = with_folders(&self.photos)?;
        // clap does not say that an option needs another one where both exclude a third.
        let given = [
            ("-m", self.method.is_some()),
            ("--camera", !self.cameras.is_empty()),
            ("--same-camera", self.same_camera),
            ("--points", self.points.is_some()),
            ("--idle", self.idle.is_some()),
        ];
        if let Some((option, _)) = given.iter().find(|(_, given)| *given && !self.serve) {
            return Err(Failure::input(format!("{option}: is of the server; give --serve in place of -o")));
        }
        if self.same_camera && self.cameras.is_empty() {
            return Err(Failure::input("--same-camera: says whose photographs these are; give its file with --camera"));
        }
        let cameras = self.cameras.iter().map(ImagesFile::path);
        let inputs = inputs_of(self.photos.iter().chain(&self.control).chain(&self.measured).chain(cameras));
        let output = self.output.as_deref().map(|path| output::page("-o", path, &inputs)).transpose()?;
        let names = self.names()?;
        let control = self.control.as_deref().map(read_control).transpose()?.unwrap_or_default();
        let content = self.content(&names, &control)?;
        say_turns(&self.photos)?;
        let photos: Vec<(String, &Path)> = names.into_iter().zip(self.photos.iter().map(PathBuf::as_path)).collect();
        match output {
            Some(output) => write(&output, &content, &photos, context.quiet),
            None => self.serve(context, &content, photos, &control, &inputs),
        }
    }

    /// What points call the photographs, as `measure` reads it.
    fn names(&self) -> Result<Vec<String>, Failure> {
        once(&self.photos)?;
        let names = names(&self.photos);
        let mut seen = HashSet::new();
        for (name, path) in names.iter().zip(&self.photos) {
            if !seen.insert(name) {
                return Err(PhotographsError::Twice(path.clone()).into());
            }
            // Cells of a point file are read without the spaces around them.
            if name.trim() != name {
                return Err(Failure::input(format!(
                    "{}: its name begins or ends with a space, which point files lose; rename it",
                    path.display()
                )));
            }
        }
        Ok(names)
    }

    fn content(&self, names: &[String], control: &[ControlRow]) -> Result<Content, Failure> {
        let loaded = |path: &PathBuf| {
            let name = path.display().to_string();
            let text = bounded::text(path).map_err(|error| Failure::input(format!("{name}: {error}")))?;
            let points = parse_points(&name, text.as_bytes())?;
            let images: Vec<&str> = points.points.images().iter().collect();
            if let Some(first) = images.first().filter(|_| !images.iter().any(|image| is_named(names, image))) {
                say!("{}: shows nothing: it is of other photographs, the first is `{first}`", path.display());
            }
            Ok(Loaded { name, text })
        };
        Ok(Content {
            targets: control.iter().map(|row| row.target.clone()).collect(),
            measured: self.measured.iter().map(loaded).collect::<Result<_, Failure>>()?,
            kind: self.kind.map(TargetKind::name),
        })
    }
}

/// Whether points that call their image so are of one of the photographs.
fn is_named(names: &[String], image: &str) -> bool {
    let short = |name: &str| name.rsplit(['/', '\\']).next().unwrap_or_default().to_owned();
    names.iter().any(|name| name == image || short(name) == short(image))
}

fn write(output: &OutputFile, content: &Content, photos: &[(String, &Path)], quiet: bool) -> Result<(), Failure> {
    let progress = Progress::start("point", photos.len() as u64, quiet);
    output.write(|file| write_page(file, content, photos, &|| progress.step()))?;
    let size = fs::metadata(output.path()).map_or(0.0, |about| about.len() as f64 / 1e6);
    let noun = if photos.len() == 1 { "photograph" } else { "photographs" };
    progress.finish(&format!("{}: {} {noun}, {size:.1} MB; open it in a browser", output.path().display(), photos.len()));
    if size > LARGE {
        say!("{}: {size:.0} MB take long to open; --serve sends what is looked at alone", output.path().display());
    }
    Ok(())
}
