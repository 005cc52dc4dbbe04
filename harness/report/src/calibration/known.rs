//! The cameras of a calibration with what is known of them, as a file of its folder: for what is to be measured with them.

use std::io;

use calibench_calibrate::{Calibration, few};
use calibench_files::NewFolder;
use calibench_model::{NamedCamera, escape};
use serde::{Deserialize, Serialize};

/// The file's name in the folder.
pub const CAMERAS_FILE: &str = "cameras.json";

/// The cameras of a calibration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CalibratedCameras {
    /// Version of the program that wrote it.
    pub calibench: String,
    /// Why the calibration is in doubt.
    pub doubts: Vec<String>,
    /// Its cameras.
    pub cameras: Vec<CalibratedCamera>,
}

/// A camera of a calibration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CalibratedCamera {
    /// The camera with the covariance of what was solved for.
    pub named: NamedCamera,
    /// How well it is known over its frame as the covariance has it, px; `None` where that cannot be said.
    pub formal_px: Option<f64>,
    /// The same as leaving images out has it, px; `None` where that could not be done.
    pub by_images_px: Option<f64>,
}

impl CalibratedCamera {
    /// By how many times the camera errs more than its covariance says, as leaving images out shows it.
    pub fn halves(&self) -> Option<f64> {
        Some(self.by_images_px? / self.formal_px?).filter(|times| times.is_finite())
    }
}

impl CalibratedCameras {
    /// From the text of the file.
    ///
    /// # Errors
    /// What is wrong with it, with line and column.
    pub fn parse(text: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(text)
    }

    /// The camera called `name`, or the only one.
    ///
    /// # Errors
    /// In words: no camera of this name, several without one.
    pub fn choose(&self, name: Option<&str>) -> Result<&CalibratedCamera, String> {
        let names = || few(&self.cameras.iter().map(|camera| escape::name(&camera.named.name).into_owned()).collect::<Vec<_>>());
        match (name, &self.cameras[..]) {
            (Some(name), cameras) => cameras
                .iter()
                .find(|camera| camera.named.name == name)
                .ok_or_else(|| format!("no camera is called {}; expected one of {}", escape::name(name), names())),
            (None, [only]) => Ok(only),
            (None, []) => Err("holds no camera".to_owned()),
            (None, _) => Err(format!("has several cameras; choose one of {} with --camera-name", names())),
        }
    }
}

/// Writes the file; `before` are doubts about photographs that others had.
pub(super) fn write(calibration: &Calibration<'_>, before: &[String], folder: &NewFolder) -> io::Result<()> {
    let camera = |index: usize| {
        let known = calibration.over_frame.get(index).copied().flatten();
        Ok(CalibratedCamera {
            named: calibration.named_camera(index).map_err(io::Error::other)?,
            formal_px: known.map(|known| known.formal_px).filter(|px| px.is_finite()),
            by_images_px: known.and_then(|known| known.by_images_px).filter(|px| px.is_finite()),
        })
    };
    let cameras = CalibratedCameras {
        calibench: env!("CARGO_PKG_VERSION").to_owned(),
        doubts: before.iter().cloned().chain(calibration.doubts().iter().map(ToString::to_string)).collect(),
        cameras: (0..calibration.cameras()).map(camera).collect::<io::Result<_>>()?,
    };
    let mut text = serde_json::to_vec_pretty(&cameras)?;
    text.push(b'\n');
    folder.write(CAMERAS_FILE, |file| file.write_all(&text))
}
