//! Images of another size than a camera's: whether they may be the same camera's, and how.

use std::fmt;

use super::{Crop, FrameChange, Reframing, ReframingError, SIMPLE, Scaling, factor};
use crate::NamedCamera;
use crate::camera::{CameraModel, ImageSize, Resampling};

/// By what share sides differ at least of images that are scaled and whose aspect is not quite the same.
const NEAR: f64 = 0.05;

/// How images of one size may come from those of another. Sizes alone prove nothing: that it is the same camera somebody has to say.
#[derive(Clone, Debug, PartialEq)]
pub enum OtherSize {
    /// It is no other one.
    Same,
    /// The whole frame, larger or smaller, in the same aspect.
    Scaled(Reframing),
    /// Portrait and landscape, and scaled so: which side is up they do not say.
    Turned(f64),
    /// Another aspect: parts that video modes may have cut out of the middle, the largest first.
    Part(Vec<FrameChange>),
}

impl OtherSize {
    /// How images of the size `images` may come from a camera of images of the size `camera`.
    pub fn of(camera: ImageSize, images: ImageSize) -> Self {
        if camera == images {
            return Self::Same;
        }
        if let Some(scale) = common_scale(camera, images) {
            let resampling = Resampling { scale: [scale; 2], size: images, ..Resampling::none(camera) };
            return Self::Scaled(Reframing { resampling, turn: None });
        }
        let upright = ImageSize { width: images.height, height: images.width };
        if let Some(scale) = common_scale(camera, upright) {
            return Self::Turned(scale);
        }
        Self::Part(parts(camera, images))
    }
}

/// The factor that leads from one size to another, sides rounded up or down: that of the sides if they have but one, or else the simplest.
fn common_scale(from: ImageSize, to: ImageSize) -> Option<f64> {
    let [[width, height], [columns, rows]] = [from, to].map(|size| [size.width, size.height].map(f64::from));
    let leads = |scale: &f64| (scale * width - columns).abs() < 1.0 && (scale * height - rows).abs() < 1.0;
    if columns * height == rows * width {
        return Some(columns / width);
    }
    // A few columns or rows more or less were cut off or added.
    if (columns / width - 1.0).abs() < NEAR {
        return None;
    }
    let simple = (1..=SIMPLE).map(|q| (columns / width * f64::from(q)).round() / f64::from(q)).filter(|scale| *scale > 0.0);
    simple.chain([columns / width, rows / height]).find(leads)
}

/// Parts of the middle: the largest of the aspect of the new images, and one of their size.
fn parts(camera: ImageSize, images: ImageSize) -> Vec<FrameChange> {
    let [[width, height], [columns, rows]] = [camera, images].map(|size| [size.width, size.height].map(f64::from));
    let scale = (columns / width).max(rows / height);
    let side = |new: f64, all: u32| ((new / scale).round() as u32).clamp(1, all);
    let middle = |size: ImageSize| Crop { x: (camera.width - size.width) / 2, y: (camera.height - size.height) / 2, size };
    let largest = middle(ImageSize { width: side(columns, camera.width), height: side(rows, camera.height) });
    let scaling = (largest.size != images).then_some(Scaling::Size(images));
    let mut parts = vec![FrameChange { crop: Some(largest), scaling, turn: None }];
    if scaling.is_some() && images.width <= camera.width && images.height <= camera.height {
        parts.push(FrameChange { crop: Some(middle(images)), ..FrameChange::default() });
    }
    parts
}

/// A camera that is of images of another size.
#[derive(Clone, Debug, PartialEq)]
pub enum OtherImages {
    /// Nobody said that it is the same camera, or the sizes do not say how it would be.
    Size {
        /// Of the camera's images.
        camera: ImageSize,
        /// Of those that there are.
        images: ImageSize,
        /// How these may come from those.
        how: OtherSize,
    },
    /// The same camera, which its model does not hold in images of that size.
    Refused(ReframingError),
}

impl fmt::Display for OtherImages {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { camera, images, how } => {
                write!(
                    f,
                    "is of images of {} x {} px, and these have {} x {} px",
                    camera.width, camera.height, images.width, images.height
                )?;
                match how {
                    OtherSize::Same => Ok(()),
                    OtherSize::Scaled(by) => write!(f, ": perhaps the same camera, its images times {}", factor(by.resampling.scale[0])),
                    OtherSize::Turned(scale) if *scale == 1.0 => write!(f, ": perhaps the same camera, turned by 90 or 270 degrees"),
                    OtherSize::Turned(scale) => {
                        write!(f, ": perhaps the same camera, turned by 90 or 270 degrees, and times {}", factor(*scale))
                    }
                    OtherSize::Part(_) => write!(f, ": perhaps the same camera, of whose images a video mode cuts a part out"),
                }
            }
            Self::Refused(why) => fmt::Display::fmt(why, f),
        }
    }
}

impl OtherImages {
    /// The same words, with what takes the camera: `flag`, or of the camera file `file` the command that makes a camera of such images.
    pub fn advice(&self, flag: &str, file: &str) -> String {
        let Self::Size { images, how, .. } = self else { return self.to_string() };
        let to = |change: &FrameChange| {
            let crop = change.crop.map_or(String::new(), |Crop { x, y, size }| format!(" --crop {x},{y},{},{}", size.width, size.height));
            let size = change.scaling.map_or(String::new(), |_| format!(" --size {}x{}", images.width, images.height));
            format!("`calibench convert {file}{crop}{size}`")
        };
        match how {
            OtherSize::Same => self.to_string(),
            OtherSize::Scaled(_) => format!("{self}; {flag} takes it so"),
            OtherSize::Turned(scale) => {
                let scale = if *scale == 1.0 { String::new() } else { format!(" --size {}x{}", images.height, images.width) };
                format!("{self}; `calibench convert {file}{scale} --turn 90` (or 270) makes one of such images")
            }
            OtherSize::Part(parts) => {
                let parts: Vec<String> = parts.iter().map(to).collect();
                format!("{self}; if it is so, and the part is the middle, {} makes one of such images", parts.join(" or, not resampled, "))
            }
        }
    }
}

/// `named` as the camera of images of a size. One of another size is taken where `is_same` says that it is the same camera and the aspect is the same; with it come
/// words on what was made of it.
///
/// # Errors
/// A camera of images of another size.
pub fn same_camera(named: &NamedCamera, images: ImageSize, is_same: bool) -> Result<(NamedCamera, Vec<String>), OtherImages> {
    let camera = named.camera.size();
    match OtherSize::of(camera, images) {
        OtherSize::Same => Ok((named.clone(), Vec::new())),
        OtherSize::Scaled(by) if is_same => {
            let (taken, dropped) = by.named(named).map_err(OtherImages::Refused)?;
            let mut words = vec![format!("taken as the same camera in another size: {by}{}", remainder(&by.resampling))];
            words.extend(dropped.into_iter().map(|what| format!("dropped: {what}")));
            Ok((taken, words))
        }
        how => Err(OtherImages::Size { camera, images, how }),
    }
}

/// What is said of sides that are no whole multiples: at the last of them it is a part of a pixel whether the rest was cut off or squeezed in.
fn remainder(by: &Resampling) -> String {
    let rest = |before: u32, after: u32| (by.scale[0] * f64::from(before) - f64::from(after)).abs();
    let most = rest(by.from.width, by.size.width).max(rest(by.from.height, by.size.height));
    if most < 1e-6 {
        return String::new();
    }
    format!(", the rest of {most:.2} px at the last side cut off or added; `convert --size` squeezes it in")
}
