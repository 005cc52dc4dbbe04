//! What is given, and what is made of it.

use std::path::Path;

use calibench_cameras::conversion::converted;
use calibench_cameras::target::{Given, goal};
use calibench_cameras::{ReadOptions, camera_bytes};
use calibench_files::NewFolder;
use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, CameraModel, ImageSize, TangentialOrder};
use calibench_model::convert::ConvertOptions;
use calibench_report::plain;
use calibench_undistort::{Fields, Map, Target, View, fields, framed, kept};

use super::{Frame, Undistort};
use crate::convert::no_target;
use crate::failure::Failure;
use crate::inputs;
use crate::same_camera::for_images;

/// What --to names beside files.
pub(super) const NAMES: [&str; 2] = ["pinhole", "equirectangular"];
/// Where the photographs move by so many px from one pixel to the next, kernels of few pixels pass by some of them.
const SHRUNK: f64 = 1.5;

/// The views of photographs and of new pictures; which of them is given depends on the direction.
pub(super) struct Views {
    pub(super) given: View,
    pub(super) made: View,
}

impl Views {
    pub(super) fn of(command: &Undistort) -> Result<Self, Failure> {
        if command.redistort && command.same_camera && command.target_file().is_none() {
            return Err(Failure::input(
                "--same-camera: pictures of a new view have the size that --frame gives them; with --redistort it is for --to FILE",
            ));
        }
        let given = command.given_size()?;
        let (of_camera, of_target) = if command.redistort { (None, given) } else { (given, None) };
        let camera = taken(&command.camera, command.size.or(of_camera), of_camera, command)?;
        let photograph = View::of(&camera);
        let new = match (command.target_file(), command.to.as_str()) {
            (Some(file), _) => {
                if !matches!(command.frame, Frame::Keep) || command.scale != 1.0 {
                    return Err(Failure::input(format!(
                        "--to {}: the camera of a file has its own frame: no --frame and no --scale",
                        command.to
                    )));
                }
                if !file.exists() {
                    return Err(Failure::input(format!(
                        "--to {}: no such file; expected {} or a camera file",
                        command.to,
                        NAMES.join(", ")
                    )));
                }
                View::of(&taken(&file, of_target.or(command.size), of_target, command)?)
            }
            (None, name) => {
                let target = if name == NAMES[0] { Target::Pinhole } else { Target::Equirectangular };
                framed(&photograph, target, command.frame.of(), command.scale)?
            }
        };
        Ok(if command.redistort { Self { given: new, made: photograph } } else { Self { given: photograph, made: new } })
    }

    /// The map from new pictures to those that are given.
    pub(super) fn map(&self) -> Result<Map, Failure> {
        let map = Map::between(&self.given, &self.made);
        if map.covered() == 0 {
            return Err(calibench_undistort::FrameError::Nothing.into());
        }
        Ok(map)
    }

    /// Says what new pictures show.
    pub(super) fn say(&self, map: &Map, is_area: bool) {
        let kept = kept(&self.given, &self.made);
        say!("given: {}", sized(&self.given));
        say!("new: {}", sized(&self.made));
        say!(
            "kept: {:.2} % of the area of what is given; {:.2} % of the new pictures is empty",
            100.0 * kept.shown,
            100.0 * (1.0 - map.coverage())
        );
        if kept.with_ray < 1.0 {
            say!(
                "warning: {:.2} % of the area of what is given has no ray: the camera folds, or sees nothing there",
                100.0 * (1.0 - kept.with_ray)
            );
        }
        if map.shrinks() > SHRUNK && !is_area {
            say!("warning: the picture shrinks up to {:.1} times: fine patterns become others; --kernel area takes means", map.shrinks());
        }
        if let View::Equirectangular(sphere) = &self.made {
            let (scale, axis) = (plain(sphere.scale.to_radians()), sphere.axis);
            say!(
                "its sphere: {scale} px a degree, axis at ({:.6}, {:.6}) from the centre of the first pixel; no camera file holds it",
                axis.x,
                axis.y
            );
        }
    }

    /// The camera of new pictures as a file's name and bytes, if there is one.
    pub(super) fn camera_file(&self, convention: &str, pitch_um: Option<f64>) -> Result<Option<(String, Vec<u8>)>, Failure> {
        let source = match &self.made {
            View::Camera(camera) => NamedCamera::new("", least(*camera)),
            View::Splined(splines) => NamedCamera::splined("", splines.as_ref().clone()),
            View::Equirectangular(_) => return Ok(None),
        };
        let given = Given { source: &source, pitch_um, base_mm: None, order: TangentialOrder::OpenCv, output: None };
        let goal = goal(convention, &given).map_err(|error| match no_target(error) {
            Failure::Input(message) => Failure::Input(message.replace("--to", "--camera-format")),
            other => other,
        })?;
        let converted = converted(&source, &goal, None, pitch_um, &ConvertOptions::default());
        let converted = converted.map_err(|error| Failure::input(format!("--camera-format {convention}: {error}")))?;
        let bytes = camera_bytes(goal.format, &[converted.camera])?;
        Ok(Some((format!("camera.{}", goal.format.extension), bytes)))
    }

    /// Writes the camera of new pictures.
    pub(super) fn write_camera(file: Option<&(String, Vec<u8>)>, folder: &NewFolder) -> Result<(), Failure> {
        let Some((name, bytes)) = file else { return Ok(()) };
        folder.write(name, |file| file.write_all(bytes))?;
        Ok(())
    }
}

/// The first camera of a file, which is of images of the size `stated` if it does not say it, for images of the size `given`, where that is known.
fn taken(path: &Path, stated: Option<ImageSize>, given: Option<ImageSize>, command: &Undistort) -> Result<NamedCamera, Failure> {
    // Beside photographs, whose size is known, a size that the user states is that of the camera.
    let other_size = command.size.is_none() || given.is_none_or(|given| Some(given) == command.size);
    let named = inputs::first(path, &ReadOptions { size: stated, other_size, splines_alone: true, ..ReadOptions::default() })?;
    let ImageSize { width, height } = named.camera.size();
    match given {
        // Of a photograph that is turned more is said where all photographs are looked at.
        Some(given) if (given.width, given.height) != (height, width) => for_images(path, &named, given, command.same_camera),
        _ => Ok(named),
    }
}

/// The same camera with as few coefficients as it needs.
fn least(camera: Camera) -> Camera {
    match camera {
        Camera::OpenCv(camera) if camera.distortion == [0.0; 14] => calibench_model::camera::OpenCv { coefficients: 4, ..camera }.into(),
        other => other,
    }
}

fn sized(view: &View) -> String {
    let ImageSize { width, height } = view.size();
    let what = match view {
        View::Camera(camera) => {
            let named = camera.convention().name;
            let parameters = camera.parameters();
            let is_plain = named == "opencv" && parameters.iter().all(|p| ["fx", "fy", "cx", "cy"].contains(&p.name) || p.value == 0.0);
            if is_plain { "pinhole" } else { named }
        }
        View::Splined(_) => "splined",
        View::Equirectangular(_) => "equirectangular",
    };
    let Some(Fields { horizontal, vertical, diagonal }) = fields(view) else { return format!("{width} x {height} px, {what}") };
    let [across, down, corner] = [horizontal, vertical, diagonal].map(|angle| format!("{:.2}\u{b0}", angle.to_degrees()));
    format!("{width} x {height} px, {what}, field of view {across} x {down}, {corner} from corner to corner")
}

impl Frame {
    fn of(self) -> calibench_undistort::Frame {
        match self {
            Self::Keep => calibench_undistort::Frame::Keep,
            Self::All => calibench_undistort::Frame::All,
            Self::Crop => calibench_undistort::Frame::Crop,
        }
    }
}
