//! What a convention is called: its model, its shape, and the file format that holds it.

use std::path::Path;

use calibench_model::camera::{AgisoftVersion, CameraModel, FisheyeProjection, TangentialOrder};
use calibench_model::convert::Target;
use thiserror::Error;

use super::format::Model;
use super::{CameraFormat, FORMATS, NamedCamera, format_named};

/// The names of conventions, besides those of formats with models of their own, with what they mean.
pub const TARGETS: [(&str, &str); 17] = [
    ("photogrammetric", "c, x0, y0, k1 to k3, p1, p2, b1, b2 in mm, y up (needs the pixel pitch)"),
    ("ebner", "Ebner's twelve parameters (needs the pixel pitch and --base)"),
    ("opencv", "OpenCV with the fewest coefficients that are exact, or that fit best; also opencv4, opencv5, opencv8, opencv12, opencv14"),
    ("opencv4", "k1, k2, p1, p2"),
    ("opencv8", "rational: k4 to k6 as well"),
    ("opencv12", "thin prism: s1 to s4 as well"),
    ("opencv14", "tilt as well"),
    ("opencv-fisheye", "OpenCV's fisheye"),
    ("opencv-omnidir", "cv2.omnidir's camera of Mei: xi, k1, k2, p1, p2"),
    ("metashape", "Metashape, PhotoScan from 1.2: a frame camera, with k4, p3, p4 where it needs them, or a fisheye"),
    ("metashape-cameras", "the same as camera XML, which holds several"),
    ("metashape-fisheye", "Metashape's equidistant fisheye"),
    ("photoscan", "PhotoScan before 1.2: cameras XML with fx, fy, cx, cy, skew"),
    ("agisoft-lens", "Agisoft Lens: calibration XML with fx, fy, cx, cy, skew"),
    ("pix4d", "Pix4D's .cam (needs the pixel pitch)"),
    ("pix4d-inpho", "Pix4D's .cam for INPHO (needs the pixel pitch)"),
    ("pix4d-parameters", "Pix4D's calibrated_camera_parameters.txt, of cameras with poses"),
];

/// How a format's model is chosen.
pub enum Way {
    /// The convention and its shape.
    One(Target),
    /// The first of these that holds the camera exactly, or else the one that fits best.
    AnyOf(Vec<Model>),
    /// The same of the format's own models.
    Best,
}

/// A target and the format of its file.
pub struct Goal {
    /// The model.
    pub way: Way,
    /// The file format.
    pub format: &'static CameraFormat,
}

/// What decides a target besides its name.
pub struct Given<'a> {
    /// The camera to be converted.
    pub source: &'a NamedCamera,
    /// Pixel pitch, um, if the user gave it.
    pub pitch_um: Option<f64>,
    /// Spacing of Ebner's grid, mm, if given.
    pub base_mm: Option<f64>,
    /// Order of Pix4D's T1 and T2.
    pub order: TangentialOrder,
    /// Where the file goes: its ending decides between YAML, XML, JSON and NumPy's archive.
    pub output: Option<&'a Path>,
}

impl Given<'_> {
    fn pitch(&self, name: &str) -> Result<f64, TargetError> {
        self.pitch_um.or(self.source.pitch_um).ok_or_else(|| TargetError::NoPitch(name.to_owned()))
    }
}

impl Goal {
    /// The models that may be chosen, for a pixel pitch in um if one is known.
    pub(super) fn targets(&self, pitch_um: Option<f64>) -> Vec<Target> {
        match &self.way {
            Way::One(target) => vec![*target],
            Way::AnyOf(models) => models.iter().map(|model| model.target).collect(),
            Way::Best => self.format.models(pitch_um).iter().map(|model| model.target).collect(),
        }
    }
}

/// A name that is no target, or not with what is given.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum TargetError {
    /// The convention is in mm.
    #[error("{0} is in mm and the file states no pixel pitch: expected it (um; width of the sensor over columns)")]
    NoPitch(String),
    /// Ebner's parameters belong to a grid.
    #[error("ebner needs the spacing of its grid, mm")]
    NoBase,
    /// There is no such target.
    #[error("{name}: no such target; known are {}", known.join(", "))]
    Unknown {
        /// What was asked for.
        name: String,
        /// The names that there are.
        known: Vec<&'static str>,
    },
}

/// The first of `exact` that holds the camera by formula, alone, or else those to be fitted.
fn held_or_fitted(source: &NamedCamera, exact: Vec<Model>, fitted: Vec<Model>) -> Vec<Model> {
    let held = exact.into_iter().find(|model| source.splines.is_none() && model.target.is_exact_for(&source.camera));
    held.map_or(fitted, |model| vec![model])
}

/// OpenCV's pinhole models, the one with the fewest coefficients first.
fn of_opencv(source: &NamedCamera) -> Vec<Model> {
    let named = |(coefficients, name)| Model { name, target: Target::OpenCv { coefficients } };
    let all = [(4, "opencv4"), (5, "opencv5"), (8, "opencv8"), (12, "opencv12"), (14, "opencv14")].map(named);
    // Five hold what four do, and no fit has a use for fewer.
    held_or_fitted(source, all.into(), all[1..].into())
}

/// Metashape's model with the fewest of K4, P3, P4, or its fisheye.
fn of_metashape(source: &NamedCamera) -> Vec<Model> {
    let frame = |(radial, tangential)| {
        let target = Target::Agisoft { version: AgisoftVersion::Metashape, radial, tangential, affinity: true };
        Model { name: "frame", target }
    };
    let fisheye = |(name, projection)| Model { name, target: Target::MetashapeFisheye { projection } };
    let fisheyes = [("fisheye", FisheyeProjection::Equidistant), ("equisolid_fisheye", FisheyeProjection::Equisolid)].map(fisheye);
    let exact = [&[(3, 2), (4, 2), (3, 4), (4, 4)].map(frame)[..], &fisheyes].concat();
    held_or_fitted(source, exact, [&[(3, 2), (4, 4)].map(frame)[..], &fisheyes].concat())
}

/// The target called `name`.
///
/// # Errors
/// An unknown name; a pitch or a base that is needed and not given.
pub fn goal(name: &str, given: &Given<'_>) -> Result<Goal, TargetError> {
    let name = named_for(name, given.output);
    if let Some(format) = FORMATS.iter().copied().find(|format| format.name == name && !format.models(None).is_empty()) {
        return Ok(Goal { way: Way::Best, format });
    }
    let ends_in = |ending: &str| ends_in(given.output, ending);
    let endings = [("xml", "opencv-xml"), ("json", "opencv-json"), ("npz", "numpy")];
    let opencv = endings.into_iter().find(|(ending, _)| ends_in(ending)).map_or("opencv-yaml", |(_, format)| format);
    let sensor_width = |pitch_um: f64| f64::from(given.source.camera.size().width) * pitch_um * 1e-3;
    let (target, format) = match name {
        "photogrammetric" => (Target::photogrammetric(given.pitch(name)?), "photogrammetric"),
        "ebner" => {
            let b_mm = given.base_mm.ok_or(TargetError::NoBase)?;
            (Target::Ebner { pitch_um: given.pitch(name)?, b_mm }, "photogrammetric")
        }
        "opencv-fisheye" => (Target::OpenCvFisheye, opencv),
        "opencv-omnidir" => (Target::Omni { distortion: true }, opencv),
        "metashape" | "metashape-cameras" => return any_of(of_metashape(given.source), name),
        "metashape-fisheye" => (Target::MetashapeFisheye { projection: FisheyeProjection::Equidistant }, "metashape"),
        "pix4d" | "pix4d-inpho" => (Target::Pix4d { sensor_width_mm: sensor_width(given.pitch(name)?), order: given.order }, name),
        // In px: the width of the sensor is not in the file.
        "pix4d-parameters" => {
            let pitch_um = given.pitch(name).unwrap_or(1.0);
            (Target::Pix4d { sensor_width_mm: sensor_width(pitch_um), order: given.order }, name)
        }
        "photoscan" => (older(AgisoftVersion::PhotoScan), "photoscan-cameras"),
        "agisoft-lens" => (older(AgisoftVersion::Lens), "metashape"),
        "opencv" => return any_of(of_opencv(given.source), opencv),
        _ => match name.strip_prefix("opencv").map(str::parse) {
            Some(Ok(coefficients @ (4 | 5 | 8 | 12 | 14))) => (Target::OpenCv { coefficients }, opencv),
            _ => return Err(unknown(name)),
        },
    };
    let format = format_named(format).ok_or_else(|| unknown(format))?;
    Ok(Goal { way: Way::One(target), format })
}

/// The name of a target as its file's name has it: COLMAP's list in `cameras.bin` is that of bytes, which alone COLMAP reads there.
pub fn named_for<'n>(name: &'n str, output: Option<&Path>) -> &'n str {
    if name == "colmap" && ends_in(output, "bin") { "colmap-bin" } else { name }
}

fn ends_in(path: Option<&Path>, ending: &str) -> bool {
    path.and_then(Path::extension).is_some_and(|extension| extension.eq_ignore_ascii_case(ending))
}

fn any_of(models: Vec<Model>, format: &str) -> Result<Goal, TargetError> {
    let format = format_named(format).ok_or_else(|| unknown(format))?;
    Ok(Goal { way: Way::AnyOf(models), format })
}

/// PhotoScan before 1.2 and Lens: three radial and two decentring coefficients, two focal lengths and a skew.
fn older(version: AgisoftVersion) -> Target {
    Target::Agisoft { version, radial: 3, tangential: 2, affinity: true }
}

fn unknown(name: &str) -> TargetError {
    let formats = FORMATS.iter().filter(|format| !format.models(None).is_empty()).map(|format| format.name);
    TargetError::Unknown { name: name.to_owned(), known: TARGETS.iter().map(|(name, _)| *name).chain(formats).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_model::camera::{ImageSize, OpenCv};

    #[test]
    fn a_list_of_colmap_is_of_the_kind_that_its_name_says() {
        let named = |path: &str| named_for("colmap", Some(Path::new(path)));
        assert_eq!(["a/cameras.bin", "CAMERAS.BIN", "cameras.txt", "bin"].map(named), ["colmap-bin", "colmap-bin", "colmap", "colmap"]);
        assert_eq!((named_for("colmap", None), named_for("kapture", Some(Path::new("sensors.bin")))), ("colmap", "kapture"));
    }

    #[test]
    fn every_format_that_is_written_is_a_target() {
        let size = ImageSize { width: 640, height: 480 };
        let camera = OpenCv { size, fx: 500.0, fy: 500.0, cx: 320.0, cy: 240.0, distortion: [0.0; 14], coefficients: 5 };
        let source = NamedCamera::new("", camera.into());
        let names = TARGETS.iter().map(|(name, _)| *name).chain(FORMATS.iter().map(|format| format.name));
        let mut reached: Vec<&str> = Vec::new();
        for name in names {
            for output in [None, Some(Path::new("c.xml")), Some(Path::new("c.json"))] {
                let given = Given { source: &source, pitch_um: Some(4.0), base_mm: Some(2.0), order: TangentialOrder::OpenCv, output };
                reached.extend(goal(name, &given).ok().map(|goal| goal.format.name));
            }
        }
        for format in FORMATS.iter().filter(|format| format.is_written()) {
            assert!(reached.contains(&format.name), "{}", format.name);
        }
        let given = Given { source: &source, pitch_um: None, base_mm: None, order: TangentialOrder::OpenCv, output: None };
        assert!(goal("pix4d-parameters", &given).is_ok() && goal("pix4d", &given).is_err());
    }
}
