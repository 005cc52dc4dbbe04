//! `calibench camera`: what is in a camera file.

use std::path::PathBuf;

use calibench_exchange::camera::{CameraFile, NamedCamera, ReadOptions, read_camera_with};
use calibench_model::PixelPoint;
use calibench_model::camera::{AgisoftVersion, Camera, CameraModel, ImageSize, Ray, TangentialOrder, Verification, fold};
use calibench_model::convert::without_distortion;
use clap::{Args, ValueEnum};

use super::{Failure, print};
use crate::report::plain;

/// What a camera file may leave open.
#[derive(Args)]
pub struct Reading {
    /// Size of the images, for files that do not state it
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<ImageSize>,
    /// The file's OpenCV camera is the fisheye, though it does not say so
    #[arg(long)]
    fisheye: bool,
    /// Order of the decentring coefficients of Pix4D, PhotoScan before 1.2 and Lens, which public sources do not settle [default: opencv]
    #[arg(long, value_enum, value_name = "ORDER")]
    order: Option<Order>,
    /// What (0, 0) is in files of PhotoScan before 1.2 and of Lens, which public sources do not settle [default: corner]
    #[arg(long, value_enum, value_name = "ORIGIN")]
    origin: Option<Origin>,
    /// Which camera of a file that holds several [default: the first]
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
}

/// Which of two decentring coefficients multiplies r^2 + 2 x^2.
#[derive(Clone, Copy, ValueEnum)]
pub enum Order {
    /// The first: Brown's
    Brown,
    /// The second: OpenCV's
    Opencv,
}

/// What the position (0, 0) is.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Origin {
    /// The outer corner of the first pixel
    Corner,
    /// The centre of the first pixel
    Centre,
}

impl Reading {
    /// Applies what the user decided of points that a file's convention leaves open.
    fn decide(&self, camera: &mut Camera) {
        match camera {
            Camera::Pix4d(pix4d) => pix4d.order = self.order(),
            Camera::Agisoft(agisoft) if agisoft.version != AgisoftVersion::Metashape => {
                if self.order() == TangentialOrder::Brown {
                    agisoft.p.swap(0, 1);
                }
                if self.origin == Some(Origin::Centre) {
                    let corner = PixelPoint::new(agisoft.cx, agisoft.cy).to_corner();
                    (agisoft.cx, agisoft.cy) = (corner.x, corner.y);
                }
            }
            _ => {}
        }
    }

    /// The order that the user decided on, or the one that is assumed.
    pub fn order(&self) -> TangentialOrder {
        match self.order {
            Some(Order::Brown) => TangentialOrder::Brown,
            _ => TangentialOrder::OpenCv,
        }
    }

    /// Says what of a camera's convention is not confirmed by numbers of its tool, and which flag decides it.
    pub fn warn(&self, camera: &Camera) {
        if let Verification::Unverified(open) = camera.convention().verification {
            let flag = match camera {
                Camera::Pix4d(_) if self.order.is_none() => "; --order brown or --order opencv decides the order of T1 and T2",
                Camera::Agisoft(_) if self.order.is_none() || self.origin.is_none() => "; --order and --origin decide",
                _ => "",
            };
            eprintln!("unverified: {}: {open}{flag}", camera.convention().name);
        }
    }

    pub fn file(&self, path: &std::path::Path) -> Result<CameraFile, Failure> {
        let options = ReadOptions { size: self.size, fisheye: self.fisheye.then_some(true) };
        Ok(read_camera_with(path, &options)?)
    }

    /// The camera that is meant, with a word on standard error about what was assumed and left out.
    pub fn one(&self, path: &std::path::Path) -> Result<NamedCamera, Failure> {
        let file = self.file(path)?;
        let count = file.cameras.len();
        let chosen = match &self.camera {
            None => file.cameras.into_iter().next(),
            Some(name) => file.cameras.into_iter().find(|camera| camera.name == *name),
        };
        let chosen = chosen
            .ok_or_else(|| Failure::input(format!("{}: no camera is called {}", path.display(), self.camera.as_deref().unwrap_or(""))))?;
        if count > 1 && self.camera.is_none() {
            eprintln!("{}: the first of {count} cameras, `{}`; choose with --camera NAME", path.display(), chosen.name);
        }
        let mut chosen = chosen;
        self.decide(&mut chosen.camera);
        self.warn(&chosen.camera);
        for note in &chosen.notes {
            eprintln!("{}: {note}", path.display());
        }
        Ok(chosen)
    }
}

fn size(text: &str) -> Result<ImageSize, String> {
    let side = |text: &str| text.parse().ok().filter(|n| *n > 0);
    let size = text.split_once(['x', 'X']).and_then(|(w, h)| Some(ImageSize { width: side(w)?, height: side(h)? }));
    size.ok_or_else(|| "expected columns x rows, as in 4272x2848".into())
}

#[derive(Args)]
pub struct CameraCommand {
    /// A camera file of any known format
    file: PathBuf,
    #[command(flatten)]
    reading: Reading,
}

impl CameraCommand {
    pub fn run(&self) -> Result<(), Failure> {
        let file = self.reading.file(&self.file)?;
        let (format, count) = (file.format, file.cameras.len());
        let camera = self.reading.one(&self.file)?;
        let verified = format.verified.map_or("unverified".to_owned(), |proof| format!("verified: {proof}"));
        let cameras = if count == 1 { "1 camera".to_owned() } else { format!("{count} cameras") };
        let mut text = format!(
            "{}\n  format      {} ({}, {}), {verified}\n  holds       {cameras}\n",
            self.file.display(),
            format.name,
            format.tool,
            format.versions
        );
        text.push_str(&card(&camera));
        print(&text)
    }
}

/// A readable card of a camera.
pub fn card(named: &NamedCamera) -> String {
    let camera = &named.camera;
    let size = camera.size();
    let mut text = String::new();
    let mut line = |name: &str, value: String| text.push_str(&format!("  {name:<11} {value}\n"));
    if !named.name.is_empty() {
        line("name", named.name.clone());
    }
    let convention = camera.convention();
    line("convention", format!("{}: {}", convention.name, convention.about));
    line("size", format!("{} x {} px", size.width, size.height));
    if let Some(pitch) = named.pitch_um {
        line(
            "pitch",
            format!(
                "{} um, so the sensor is {} x {} mm",
                plain(pitch),
                plain(f64::from(size.width) * pitch * 1e-3),
                plain(f64::from(size.height) * pitch * 1e-3)
            ),
        );
    }
    for parameter in camera.parameters() {
        line(parameter.name, format!("{} {}", parameter.value, parameter.unit).trim_end().to_owned());
    }
    line("view", view(camera));
    line("distortion", distortion(camera));
    line("one to one", one_to_one(camera));
    if let Some(covariance) = &named.covariance {
        line("covariance", format!("of {}", covariance.parameters.join(", ")));
    }
    for note in &named.notes {
        line("note", note.clone());
    }
    text
}

fn middles(size: ImageSize) -> (f64, f64) {
    (f64::from(size.width - 1) / 2.0, f64::from(size.height - 1) / 2.0)
}

/// Angles between the rays of opposite sides and corners.
fn view(camera: &Camera) -> String {
    let size = camera.size();
    let ((mx, my), (right, down)) = (middles(size), (f64::from(size.width - 1), f64::from(size.height - 1)));
    let angle = |a: (f64, f64), b: (f64, f64)| {
        let ray = |(x, y)| camera.unproject(PixelPoint::new(x, y)).ok();
        ray(a).zip(ray(b)).map_or("no ray".to_owned(), |(a, b)| format!("{:.2}\u{b0}", a.angle_to(b).to_degrees()))
    };
    format!(
        "{} wide, {} high, {} from corner to corner",
        angle((0.0, my), (right, my)),
        angle((mx, 0.0), (mx, down)),
        angle((0.0, 0.0), (right, down))
    )
}

/// How far the corners are from where the same camera without distortion pictures their rays.
fn distortion(camera: &Camera) -> String {
    let size = camera.size();
    let Some(ideal) = without_distortion(camera) else {
        return "not known: no camera without distortion agrees with it on its axis".into();
    };
    let (right, down) = (f64::from(size.width - 1), f64::from(size.height - 1));
    let corner = |x: f64, y: f64| {
        let at = PixelPoint::new(x, y);
        let there = camera.unproject(at).and_then(|ray| ideal.project(ray));
        there.map_or("no ray".to_owned(), |ideal| format!("{} px", plain(ideal.distance(at))))
    };
    format!(
        "{}, {}, {}, {} in the corners (clockwise from top left)",
        corner(0.0, 0.0),
        corner(right, 0.0),
        corner(right, down),
        corner(0.0, down)
    )
}

fn one_to_one(camera: &Camera) -> String {
    let axis = camera.project(Ray::from_tangent(0.0, 0.0)).ok();
    match (fold(camera), axis) {
        (None, _) => "over the whole frame".into(),
        (Some(fold), _) => format!(
            "only to {} px from the image of the axis: there the distortion folds over; {:.2} % of the frame have no ray",
            plain(fold.radius_px),
            100.0 * fold.share
        ),
    }
}
