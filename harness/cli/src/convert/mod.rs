//! `calibench convert`: cameras from one convention, or one tool's file, to another.

mod file;
mod images;
mod list;
mod said;
mod several;

use std::path::PathBuf;

use calibench_cameras::conversion::{ConversionError, Converted, converted, unchanged};
use calibench_cameras::fit::{FitError, calibrated_models, losses};
use calibench_cameras::target::{Given, TargetError, goal};
use calibench_cameras::{CameraFormat, format_named, inputs_of};
use calibench_diagnostics::nearest;
use calibench_files::{Inputs, OutputFile};
use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, CameraModel, ImageSize, fold};
use calibench_model::convert::{
    Conversion, ConvertError, ConvertOptions, DifferenceOptions, Method, Region, Spread, Tangential, Vector, Verdict, difference, naive,
};
use calibench_model::escape;
use calibench_model::reframing::Reframing;
use calibench_report::json::{CameraAnswer, ConversionAnswer, ConvertedCamera};
use calibench_report::{Field, Hull, plain};
use clap::Args;
use rayon::prelude::*;

use super::context::Context;
use super::output;
use super::reading::Reading;
use crate::deliver::{As, answer};
use crate::failure::Failure;
use file::CamerasFile;
use images::{InOtherImages, OtherImages};
use said::Said;

/// The help of `--size`, which is more here than for other commands.
pub const SIZE: &str = "The same camera in images of this size, resampled; of a file that does not state the size of its images, that size";

#[derive(Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of the command line")]
pub struct Convert {
    /// Camera files of any known format, found by content; the cameras of several become one file, or the folder that -o names
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Convention or tool to convert to; `list conventions` lists them [default, in other images: that of the file]
    #[arg(long, value_name = "CONVENTION", required_unless_present_any = ["crop", "size", "scale", "binned", "turn"])]
    to: Option<String>,
    /// Model of the tool, where it has several [default: the first that holds the camera exactly, or else the one that fits best]
    #[arg(long, value_name = "MODEL", requires = "to")]
    model: Option<String>,
    #[command(flatten)]
    images: OtherImages,
    /// Convert all cameras of the file: into one file where the format holds several, or else into the folder that -o names
    #[arg(long, conflicts_with_all = ["naive", "plot"])]
    all: bool,
    /// The new camera file [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Pixel pitch, um, for conventions in mm, where the file does not state it
    #[arg(long, value_name = "UM", value_parser = positive, allow_negative_numbers = true)]
    pitch: Option<f64>,
    /// Spacing of Ebner's grid, mm
    #[arg(long, value_name = "MM", value_parser = positive, allow_negative_numbers = true)]
    base: Option<f64>,
    /// Fit and hold only within this radius from the image of the axis, px
    #[arg(long, value_name = "PX", value_parser = positive, allow_negative_numbers = true)]
    radius: Option<f64>,
    /// Let the fit rotate the camera; the rotation is reported
    #[arg(long)]
    rotation: bool,
    /// Take the result even if its residuals are above 0.5 px
    #[arg(long)]
    accept: bool,
    /// Convert by `k_i = K_i / c^(2i)`, `p = P / c`, as the Canon paper's Table 2 does: wrong beyond first order, and said to be
    #[arg(long, requires = "to", conflicts_with_all = ["radius", "rotation", "accept"])]
    naive: bool,
    /// Draw the residuals over the frame, as PNG, SVG or PDF by the ending
    #[arg(long, value_name = "PICTURE")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    answered: As,
}

pub fn positive(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|v: &f64| v.is_finite() && *v > 0.0).ok_or_else(|| "expected a positive number".into())
}

pub fn region(radius: Option<f64>) -> Region {
    radius.map_or(Region::Frame, |px| Region::Radius { px })
}

impl Convert {
    pub fn run(mut self, context: &Context<'_>) -> Result<(), Failure> {
        self.reading.allow_other_size();
        let inputs = inputs_of(&self.files);
        let cameras_file = self.cameras_file(&inputs)?;
        let plot = self.plot.as_deref().map(|path| output::picture("--plot", path, &inputs)).transpose()?;
        // An answer tells every camera apart, and so has them all in memory.
        if !self.answered.json && self.in_pieces(&cameras_file, context.quiet)? {
            return Ok(());
        }
        let sources = self.sources(context.quiet)?;
        let many = sources.len() > 1;
        let one = |(index, (read, source)): (usize, (&'static CameraFormat, NamedCamera))| {
            if many {
                self.one_of_many(index, (read, &source), many, context.quiet)
            } else {
                self.converted((read, &source), None, plot.as_ref(), context.quiet)
            }
        };
        // The first that is refused is named, on any number of threads.
        let results: Vec<Result<Answer, Failure>> = sources.into_par_iter().enumerate().map(one).collect();
        let results: Vec<Answer> = results.into_iter().collect::<Result<_, _>>()?;
        let mut said = Said::default();
        results.iter().flat_map(|answer| &answer.said).for_each(|(label, text)| said.add(label.as_deref(), text));
        said.say();
        let doubtful = results.iter().any(|answer| answer.doubtful);
        let Some(&Answer { format, .. }) = results.first() else { return Err(Failure::input("the file holds no camera")) };
        let (mut cameras, found): (Vec<NamedCamera>, Vec<(Found, Option<Reframing>)>) =
            results.into_iter().map(|answer| (answer.camera, (answer.found, answer.by))).unzip();
        self.reading.open_points().written(format, &mut cameras);
        self.reading.warn_of_format(format);
        let mut words = Said::default();
        cameras.iter().flat_map(|camera| lost(format, camera)).for_each(|text| words.add(None, &text));
        words.say();
        if !self.answered.json || self.output.is_some() {
            cameras_file.write(format, &cameras)?;
        }
        if self.answered.json {
            self.answer(format, &cameras, found)?;
        }
        if doubtful { Err(Failure::Doubt) } else { Ok(()) }
    }

    fn answer(&self, format: &CameraFormat, cameras: &[NamedCamera], found: Vec<(Found, Option<Reframing>)>) -> Result<(), Failure> {
        answer(&ConversionAnswer {
            file: self.named_files(),
            to: format.name.to_owned(),
            unverified: self.reading.open_point(format),
            output: self.output.as_ref().map(|path| path.display().to_string()),
            cameras: cameras
                .iter()
                .zip(found)
                .map(|(camera, (found, by))| found.answer(camera, losses(format, camera)).in_other_images(by.as_ref()))
                .collect(),
        })
    }

    /// Where the cameras go: a name with the ending of a camera file is a file, any other one the folder of `--all`.
    fn cameras_file(&self, inputs: &Inputs) -> Result<CamerasFile, Failure> {
        Ok(match &self.output {
            None => CamerasFile::Standard,
            Some(path) if self.takes_all() && !output::is_camera_name(path) => {
                CamerasFile::Folder(output::folder("-o", path, inputs, ("convert", None))?)
            }
            Some(path) => CamerasFile::File(output::camera("-o", path, true, inputs)?),
        })
    }

    /// One of a file's cameras, which is named by what is said of it.
    fn one_of_many(
        &self,
        index: usize,
        (read, source): (&'static CameraFormat, &NamedCamera),
        many: bool,
        quiet: bool,
    ) -> Result<Answer, Failure> {
        let place = if source.name.is_empty() { format!("camera {}", index + 1) } else { source.name.clone() };
        self.converted((read, source), many.then_some(place.as_str()), None, quiet)
    }

    /// A camera in the new convention or in other images, and the format of its file, which was read from one of the format `read`.
    fn converted(
        &self,
        (read, source): (&'static CameraFormat, &NamedCamera),
        label: Option<&str>,
        plot: Option<&OutputFile>,
        quiet: bool,
    ) -> Result<Answer, Failure> {
        let doubtful = source.implausible;
        let whose = |failure| match (failure, label) {
            (Failure::Input(text), Some(label)) => Failure::Input(format!("{}: {text}", escape::name(label))),
            (failure, _) => failure,
        };
        let other = self.in_other_images(source).map_err(whose)?;
        let by = other.as_ref().map(|other| other.by);
        let mut said = Vec::new();
        if let Some(InOtherImages { by, dropped, .. }) = &other {
            said.extend((!quiet).then(|| (label.map(str::to_owned), format!("in other images: {by}"))));
            said.extend(dropped.iter().map(|what| (None, format!("warning: dropped: {what}"))));
        }
        let source = other.as_ref().map_or(source, |other| &other.camera);
        let Some(to) = &self.to else {
            let Converted { camera, conversion, .. } = unchanged(source);
            let format = self.kept_format(read, source, by)?;
            plot.map_or(Ok(()), |plot| drawn(&conversion).write(plot))?;
            return Ok(Answer { camera, format, said, doubtful, found: Found::Converted(Box::new(conversion), None), by });
        };
        let order = self.reading.open_points().order();
        let given = Given { source, pitch_um: self.pitch, base_mm: self.base, order, output: self.output.as_deref() };
        let goal = goal(to, &given).map_err(no_target)?;
        if self.naive {
            let pitch_um = self.pitch.or(source.pitch_um);
            let (camera, found) = self.naive(source, pitch_um, plot, quiet)?;
            let camera = NamedCamera { pitch_um, ..NamedCamera::new(source.name.clone(), camera) };
            return Ok(Answer { camera, format: goal.format, said, doubtful, found, by });
        }
        let options =
            ConvertOptions { region: region(self.radius), rotation: self.rotation, accept: self.accept, ..ConvertOptions::default() };
        let found = converted(source, &goal, self.model.as_deref(), self.pitch, &options);
        let Converted { camera, conversion, model, held_exactly } = found.map_err(|error| self.refused(&error, label))?;
        if !quiet {
            let model = model.map_or(String::new(), |model| format!("{model}: "));
            said.push((label.map(str::to_owned), format!("{model}{}{}", summary(&conversion), exact_for(held_exactly))));
        }
        if let Some(fold) = fold(&conversion.camera).filter(|_| conversion.region == Region::Frame) {
            // An exact conversion takes a fold along; it is no truth beyond it in any convention.
            let (radius, share) = (plain(fold.radius_px), 100.0 * fold.share);
            let text =
                format!("warning: the camera folds over {radius} px from the image of the axis: {share:.2} % of the frame have no ray");
            said.push((None, text));
        }
        plot.map_or(Ok(()), |plot| drawn(&conversion).write(plot))?;
        if goal.format.convention.is_none() && conversion.camera.convention() != source.camera.convention() {
            said.extend(self.reading.doubt(&conversion.camera).map(|doubt| (None, doubt)));
        }
        let model = model.map(str::to_owned);
        let found = Found::Converted(Box::new(Conversion { residuals: Vec::new(), ..conversion }), model);
        Ok(Answer { camera, format: goal.format, said, doubtful, found, by })
    }

    /// Why a camera is not converted, with its name where there are several.
    fn refused(&self, error: &ConversionError, label: Option<&str>) -> Failure {
        let name = label.map_or(String::new(), |label| format!("{}: ", escape::name(label)));
        match error {
            ConversionError::ModelNamed => {
                Failure::input(format!("--to {} names the model already: no --model", self.to.as_deref().unwrap_or_default()))
            }
            // Of the command, and not of a camera.
            ConversionError::Fit(FitError::NoModels { .. } | FitError::UnknownModel { .. }) => Failure::input(error.to_string()),
            ConversionError::Convert(error) => Failure::input(format!("{name}{error}{}", flag(error))),
            ConversionError::Fit(FitError::Refused { why, format }) => {
                let models = format_named(format).map_or(Vec::new(), calibrated_models);
                let held = if models.is_empty() { String::new() } else { exact_for(Some(models.join(", ").as_str())) };
                Failure::input(format!("{name}{error}{}{held}", flag(why)))
            }
            _ => Failure::input(format!("{name}{error}")),
        }
    }

    fn naive(
        &self,
        source: &NamedCamera,
        pitch_um: Option<f64>,
        plot: Option<&OutputFile>,
        quiet: bool,
    ) -> Result<(Camera, Found), Failure> {
        if self.to.as_deref() != Some("photogrammetric") {
            return Err(Failure::input("--naive converts to photogrammetric only"));
        }
        let pitch = pitch_um.ok_or_else(|| Failure::input("--naive needs the pixel pitch: give it with --pitch UM"))?;
        let camera: Camera = naive(&source.camera, pitch, Tangential::Converted)?.into();
        let cost = difference(&source.camera, &camera, &DifferenceOptions::default())?;
        if !quiet {
            say!("naive: {} from the source after the best rotation", size_of(&cost.spread));
        }
        if let Some(plot) = plot {
            field("Naive conversion: from the source to the result", &source.camera, &cost.vectors, Hull::default()).write(plot)?;
        }
        Ok((camera, Found::Naive(cost.spread, cost.rotation.angle().to_degrees())))
    }
}

/// The residuals of a conversion as a picture.
fn drawn(conversion: &Conversion) -> calibench_report::Canvas {
    let title = if conversion.method == Method::Exact { "Exact conversion: no residuals" } else { "Residuals of the fitted conversion" };
    field(title, &conversion.camera, &conversion.residuals, Hull::default())
}

/// A converted camera.
struct Answer {
    camera: NamedCamera,
    format: &'static CameraFormat,
    /// What the user is told, of this camera by its label or of all.
    said: Vec<(Option<String>, String)>,
    /// Whether no lens has the camera that was read.
    doubtful: bool,
    found: Found,
    /// The other images that it is in.
    by: Option<Reframing>,
}

/// How a camera was converted.
enum Found {
    /// Into a model, which has a name where there are several; without the vectors of its residuals.
    Converted(Box<Conversion>, Option<String>),
    /// By formulas that are wrong beyond first order: the difference after the best rotation, and the angle of that, degrees.
    Naive(Spread, f64),
}

impl Found {
    fn answer(self, camera: &NamedCamera, lost: Vec<String>) -> ConvertedCamera {
        let (fold, shown) = (fold(&camera.camera), CameraAnswer::new(camera));
        match self {
            Self::Converted(conversion, model) => ConvertedCamera::new(&conversion, model, fold, lost, shown),
            Self::Naive(cost, rotation_deg) => ConvertedCamera::naive(&cost, rotation_deg, fold, lost, shown),
        }
    }
}

/// What of a camera a format has no place for, as a warning.
fn lost(format: &CameraFormat, camera: &NamedCamera) -> impl Iterator<Item = String> {
    losses(format, camera).into_iter().map(|what| format!("warning: lost: {}", escape::name(&what)))
}

/// A target that is none, with the options that help.
pub fn no_target(error: TargetError) -> Failure {
    Failure::input(match error {
        TargetError::NoPitch(name) => {
            format!("--to {name} is in mm and the file states no pixel pitch: give it with --pitch UM (width of the sensor over columns)")
        }
        TargetError::NoBase => "--to ebner needs the spacing of the grid: give it with --base MM".into(),
        TargetError::Unknown { name, known } => {
            let near = nearest(&name, known.iter().copied()).map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            format!("--to {name}: no such target; known are {}{near}", known.join(", "))
        }
    })
}

/// An error with the flag that helps.
pub fn advise(error: &ConvertError) -> Failure {
    Failure::input(format!("{error}{}", flag(error)))
}

fn flag(error: &ConvertError) -> &'static str {
    match error {
        ConvertError::Residual { .. } => " (--accept takes it, --radius PX restricts it, a richer target fits better)",
        ConvertError::Fold { .. } => " (--radius PX restricts it)",
        _ => "",
    }
}

pub fn size_of(spread: &Spread) -> String {
    format!("{} px RMS, {} px at most, at ({:.0}, {:.0})", plain(spread.rms_px), plain(spread.max_px), spread.at.x, spread.at.y)
}

fn summary(conversion: &Conversion) -> String {
    let region = match conversion.region {
        Region::Frame => "the whole frame".to_owned(),
        Region::Radius { px } => format!("{} px around the image of the axis", plain(px)),
    };
    if conversion.method == Method::Exact {
        return "exact: the same camera in other units".into();
    }
    let word = match conversion.verdict {
        Verdict::Good => "fitted",
        Verdict::Warning => "warning: fitted with residuals above 0.01 px",
        Verdict::Accepted => "warning: fitted with residuals above 0.5 px, accepted",
    };
    let angle = conversion.rotation.angle().to_degrees();
    let rotation = if angle > 0.0 { format!(", rotated by {angle:.6}\u{b0}") } else { String::new() };
    format!("{word}: residuals {}, over {region}{rotation}", size_of(&conversion.residual))
}

/// With which model a calibration would be held exactly.
pub fn exact_for(model: Option<&str>) -> String {
    model.map_or(String::new(), |model| format!("; exact for a camera of `calibrate --model`: {model}"))
}

/// Vectors on a regular grid as a picture.
pub fn field(title: &str, camera: &Camera, vectors: &[Vector], measured: Hull) -> calibench_report::Canvas {
    let ImageSize { width, height } = camera.size();
    Field { measured, ..Field::of(title, (width, height), vectors.iter().map(|v| (v.at, (v.dx, v.dy)))) }.picture()
}
