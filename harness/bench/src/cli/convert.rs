//! `calibench convert` and `calibench diff`: cameras from one convention to another, and how far two differ.

use std::path::{Path, PathBuf};

use calibench_exchange::camera::{NamedCamera, ParameterCovariance, camera_text, write_camera};
use calibench_model::camera::{Camera, CameraModel, ImageSize, fold};
use calibench_model::convert::{
    Conversion, ConvertError, ConvertOptions, DifferenceOptions, Method, Region, Spread, Tangential, Vector, Verdict, convert, difference,
    naive,
};
use clap::Args;

use super::camera::Reading;
use super::context::Context;
use super::target::{Given, goal};
use super::{Failure, print};
use crate::report::{Field, plain};

#[derive(Args)]
pub struct Convert {
    /// A camera file of any known format, found by content
    file: PathBuf,
    /// Convention to convert to; `list conventions` lists them
    #[arg(long, value_name = "CONVENTION")]
    to: String,
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
    #[arg(long, conflicts_with_all = ["radius", "rotation", "accept"])]
    naive: bool,
    /// Draw the residuals over the frame
    #[arg(long, value_name = "PNG")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    reading: Reading,
}

fn positive(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|v: &f64| v.is_finite() && *v > 0.0).ok_or_else(|| "expected a positive number".into())
}

fn region(radius: Option<f64>) -> Region {
    radius.map_or(Region::Frame, |px| Region::Radius { px })
}

impl Convert {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let source = self.reading.one(&self.file)?;
        let given = Given {
            source: &source,
            pitch_um: self.pitch,
            base_mm: self.base,
            order: self.reading.order(),
            output: self.output.as_deref(),
        };
        let goal = goal(&self.to, &given)?;
        let pitch_um = self.pitch.or(source.pitch_um);
        let (camera, covariance) = if self.naive {
            (self.naive(&source, pitch_um, context.quiet)?, None)
        } else {
            let options = ConvertOptions {
                region: region(self.radius),
                rotation: self.rotation,
                accept: self.accept,
                covariance: source.covariance.as_ref().map(|covariance| whole(&source.camera, covariance)).transpose()?,
                ..ConvertOptions::default()
            };
            let conversion = convert(&source.camera, goal.target, &options).map_err(|error| advise(&error))?;
            if !context.quiet {
                eprint!("{}", summary(&conversion));
            }
            if let Some(fold) = fold(&conversion.camera).filter(|_| conversion.region == Region::Frame) {
                // An exact conversion takes a fold along; it is no truth beyond it in any convention.
                let (radius, share) = (plain(fold.radius_px), 100.0 * fold.share);
                eprintln!("warning: the camera folds over {radius} px from the image of the axis: {share:.2} % of the frame have no ray");
            }
            self.draw(&conversion)?;
            let covariance = conversion.covariance.as_ref().map(|q| named(&conversion.camera, q)).transpose()?;
            (conversion.camera, covariance)
        };
        if camera.convention() != source.camera.convention() {
            self.reading.warn(&camera);
        }
        let result = NamedCamera { name: source.name.clone(), pitch_um, covariance, ..NamedCamera::new("", camera) };
        match &self.output {
            Some(path) => Ok(write_camera(path, goal.format, &[result])?),
            None => print(&camera_text(goal.format, &[result])?),
        }
    }

    fn naive(&self, source: &NamedCamera, pitch_um: Option<f64>, quiet: bool) -> Result<Camera, Failure> {
        if self.to != "photogrammetric" {
            return Err(Failure::input("--naive converts to photogrammetric only"));
        }
        let pitch = pitch_um.ok_or_else(|| Failure::input("--naive needs the pixel pitch: give it with --pitch UM"))?;
        let camera: Camera = naive(&source.camera, pitch, Tangential::Converted)?.into();
        let cost = difference(&source.camera, &camera, &DifferenceOptions::default())?;
        if !quiet {
            eprintln!("naive: {} from the source after the best rotation", size_of(&cost.spread));
        }
        if let Some(path) = &self.plot {
            field("Naive conversion: from the source to the result", &source.camera, &cost.vectors).write(path)?;
        }
        Ok(camera)
    }

    fn draw(&self, conversion: &Conversion) -> Result<(), Failure> {
        let Some(path) = &self.plot else { return Ok(()) };
        let title =
            if conversion.method == Method::Exact { "Exact conversion: no residuals" } else { "Residuals of the fitted conversion" };
        Ok(field(title, &conversion.camera, &conversion.residuals).write(path)?)
    }
}

/// An error with the flag that helps.
fn advise(error: &ConvertError) -> Failure {
    let flag = match error {
        ConvertError::Residual { .. } => " (--accept takes it, --radius PX restricts it, a richer target fits better)",
        ConvertError::Fold { .. } => " (--radius PX restricts it)",
        _ => "",
    };
    Failure::input(format!("{error}{flag}"))
}

fn size_of(spread: &Spread) -> String {
    format!("{} px RMS, {} px at most, at ({:.0}, {:.0})", plain(spread.rms_px), plain(spread.max_px), spread.at.x, spread.at.y)
}

fn summary(conversion: &Conversion) -> String {
    let region = match conversion.region {
        Region::Frame => "the whole frame".to_owned(),
        Region::Radius { px } => format!("{} px around the image of the axis", plain(px)),
    };
    if conversion.method == Method::Exact {
        return "exact: the same camera in other units\n".into();
    }
    let word = match conversion.verdict {
        Verdict::Good => "fitted",
        Verdict::Warning => "warning: fitted with residuals above 0.01 px",
        Verdict::Accepted => "warning: fitted with residuals above 0.5 px, accepted",
    };
    let angle = conversion.rotation.angle().to_degrees();
    let rotation = if angle > 0.0 { format!(", rotated by {angle:.6}\u{b0}") } else { String::new() };
    format!("{word}: residuals {}, over {region}{rotation}\n", size_of(&conversion.residual))
}

/// The covariance over all parameters of a camera; those that the file held fixed have none.
fn whole(camera: &Camera, covariance: &ParameterCovariance) -> Result<nalgebra::DMatrix<f64>, Failure> {
    let parameters = camera.parameters();
    let place = |name: &String| parameters.iter().position(|p| p.name == name);
    let places: Option<Vec<usize>> = covariance.parameters.iter().map(place).collect();
    let places = places.ok_or_else(|| Failure::input("the file's covariance names a parameter that its camera does not have"))?;
    let n = covariance.parameters.len();
    let mut q = nalgebra::DMatrix::zeros(parameters.len(), parameters.len());
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        q[(places[i], places[j])] = covariance.values[i * n + j];
    }
    Ok(q)
}

fn named(camera: &Camera, q: &nalgebra::DMatrix<f64>) -> Result<ParameterCovariance, Failure> {
    let names = camera.parameters().iter().map(|p| p.name.to_owned()).collect();
    let symmetric = |i: usize, j: usize| f64::midpoint(q[(i, j)], q[(j, i)]);
    let values = (0..q.nrows()).flat_map(|i| (0..q.ncols()).map(move |j| symmetric(i, j))).collect();
    ParameterCovariance::new(names, values).map_err(Failure::Input)
}

/// Vectors on a regular grid as a picture.
pub fn field(title: &str, camera: &Camera, vectors: &[Vector]) -> crate::report::Canvas {
    let ImageSize { width, height } = camera.size();
    Field::of(title, (width, height), vectors.iter().map(|v| (v.at, (v.dx, v.dy)))).picture()
}

#[derive(Args)]
pub struct Diff {
    /// A camera file
    first: PathBuf,
    /// Another one, for images of the same size
    second: PathBuf,
    /// Draw the difference over the frame
    #[arg(long, value_name = "PNG")]
    plot: Option<PathBuf>,
    /// Compare without the best rotation
    #[arg(long)]
    no_rotation: bool,
    /// Compare only within this radius from the image of the axis, px
    #[arg(long, value_name = "PX", value_parser = positive, allow_negative_numbers = true)]
    radius: Option<f64>,
    /// Say what the difference is on an object at this distance, in its unit
    #[arg(long, value_name = "D", value_parser = positive, allow_negative_numbers = true)]
    distance: Option<f64>,
    #[command(flatten)]
    reading: Reading,
}

impl Diff {
    pub fn run(&self) -> Result<(), Failure> {
        let camera = |path: &Path| self.reading.one(path).map(|named| named.camera);
        let (first, second) = (camera(&self.first)?, camera(&self.second)?);
        let (a, b) = (first.size(), second.size());
        if a != b {
            let sizes = format!("{} x {} px and {} x {} px", a.width, a.height, b.width, b.height);
            return Err(Failure::input(format!("the images of the two cameras differ in size: {sizes}; expected the same")));
        }
        let options = DifferenceOptions {
            region: region(self.radius),
            rotation: !self.no_rotation,
            compensation: true,
            ..DifferenceOptions::default()
        };
        let found = difference(&first, &second, &options).map_err(|error| advise(&error))?;
        let after = if self.no_rotation {
            "without a rotation".to_owned()
        } else {
            format!("after a rotation of {:.6}\u{b0}", found.rotation.angle().to_degrees())
        };
        let mut text = format!("difference  {}, {after}\n", size_of(&found.spread));
        if let Some(compensated) = &found.compensated {
            let [dx, dy] = compensated.shift;
            text.push_str(&format!(
                "of these    {} remain after the best change of the principal distance ({:+.6} %) and point ({dx:+.3}, {dy:+.3} px)\n",
                size_of(&compensated.spread),
                100.0 * compensated.scale
            ));
        }
        if found.not_comparable > 0.0 {
            text.push_str(&format!(
                "left out    {:.2} % of the region, which one of the cameras does not picture\n",
                100.0 * found.not_comparable
            ));
        }
        if let Some(distance) = self.distance {
            let on = |px| plain(found.on_object(px, distance));
            text.push_str(&format!(
                "on object   {} RMS, {} at most, at a distance of {distance}\n",
                on(found.spread.rms_px),
                on(found.spread.max_px)
            ));
        }
        print(&text)?;
        let Some(path) = &self.plot else { return Ok(()) };
        let title = format!("From {} to {}", stem(&self.first), stem(&self.second));
        Ok(field(&title, &first, &found.vectors).write(path)?)
    }
}

fn stem(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
