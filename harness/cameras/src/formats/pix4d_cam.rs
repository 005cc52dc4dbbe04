//! Pix4D's own .cam: F, Px, Py in mm, K1 to K3, T1, T2 as numbers.
//!
//! The file states the sensor's size in mm but not the image's in px: that must be given. Px and Py count from the upper left corner.

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, Pix4d, TangentialOrder};

use super::PLAIN;
use crate::format::{Keeps, KeptCovariance, KeptPose};
use crate::number::{finite, fixed, shortened};
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "pix4d",
    tool: "Pix4D",
    versions: "pix4d_calibrated_internal_camera_parameters.cam, perspective lens",
    extension: "cam",
    words: "Pix4D camera calibration file Focal Px Py F K1 K2 K3 T1 T2",
    verified: None,
    many: true,
    states_size: false,
    recognise: |source| {
        let first = source.lines().next().map_or("", |(_, line)| line);
        if first.starts_with(HEADER) { Ok(()) } else { Err(format!("the first line does not begin with `{HEADER}`")) }
    },
    read,
    write: Some(write),
    keeps: Keeps { splines: false, name: true, pitch: true, pose: KeptPose::None, covariance: KeptCovariance::None },
    ..PLAIN
};

const HEADER: &str = "Pix4D camera calibration file";
const SENSOR: &str = "assuming a sensor width of";
const KEYS: [&str; 8] = ["F", "Px", "Py", "K1", "K2", "K3", "T1", "T2"];

/// One camera of the file.
struct Section {
    name: String,
    line: usize,
    sensor_width_mm: Option<f64>,
    values: [Option<f64>; 8],
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let mut sections: Vec<Section> = Vec::new();
    for (line, text) in source.lines() {
        if let Some(name) = text.strip_prefix(HEADER) {
            sections.push(Section { name: name.trim().to_owned(), line, sensor_width_mm: None, values: [None; 8] });
        } else if let Some(section) = sections.last_mut() {
            section.take(text).map_err(|error| error.on_line(line))?;
        }
    }
    sections.iter().map(|section| section.camera(options).map_err(|error| error.on_line(section.line))).collect()
}

impl Section {
    fn take(&mut self, text: &str) -> Result<(), CameraFileError> {
        if text.starts_with('#') {
            if let Some((_, size)) = text.split_once(SENSOR) {
                self.sensor_width_mm = Some(sensor(size)?.0);
            }
            return Ok(());
        }
        let (key, value) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let Some(index) = KEYS.iter().position(|&known| known == key) else {
            let problem = format!("unknown; expected {} of a perspective lens", KEYS.join(", "));
            return Err(CameraFileError::new(problem).of(shortened(key)));
        };
        let value = finite(value).map_err(|error| error.of(key))?;
        match self.values[index].replace(value) {
            Some(_) => Err(CameraFileError::new("stands twice; expected once").of(key)),
            None => Ok(()),
        }
    }

    fn camera(&self, options: &ReadOptions) -> Result<NamedCamera, CameraFileError> {
        let value = |index: usize| self.values[index].ok_or_else(|| CameraFileError::new("missing").of(KEYS[index]));
        let size = options.size_or(None)?;
        let width = self.sensor_width_mm;
        let sensor_width_mm =
            width.ok_or_else(|| CameraFileError::new(format!("has no comment `{SENSOR} ... mm`: mm cannot become px")))?;
        let per_mm = f64::from(size.width) / sensor_width_mm;
        let f_px = value(0)? * per_mm;
        if f_px <= 0.0 {
            return Err(CameraFileError::new("expected a focal length above zero").of("F"));
        }
        let (px, py) = (value(1)? * per_mm, value(2)? * per_mm);
        let (r, t) = ([value(3)?, value(4)?, value(5)?], [value(6)?, value(7)?]);
        let camera = Pix4d { size, sensor_width_mm, f_px, px, py, r, t, order: TangentialOrder::OpenCv };
        Ok(NamedCamera { pitch_um: Some(1e3 / per_mm), ..NamedCamera::new(&self.name, Camera::Pix4d(camera)) })
    }
}

/// Width and height in a text as `12.825x8.55mm`.
pub(super) fn sensor(text: &str) -> Result<(f64, f64), CameraFileError> {
    let wrong = || CameraFileError::new(format!("expected a size as in 12.825x8.55, found `{}`", shortened(text)));
    let text = text.trim().trim_end_matches(|c: char| c.is_alphabetic()).trim();
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    let side = |text| finite(text).ok().filter(|&side| side > 0.0).ok_or_else(wrong);
    Ok((side(width)?, side(height)?))
}

/// Pix4D's camera for one of its files that state mm.
pub(super) fn camera<'a>(named: &'a NamedCamera, format: &CameraFormat) -> Result<&'a Pix4d, CameraFileError> {
    match &named.camera {
        Camera::Pix4d(camera) if camera.order == TangentialOrder::OpenCv => Ok(camera),
        Camera::Pix4d(_) => Err(CameraFileError::new(format!("{} holds T1 and T2 in OpenCV's order", format.name))),
        _ => Err(format.other_model("a camera of Pix4D's model")),
    }
}

/// The width of the sensor, which files in mm need.
pub(super) fn width_of_sensor(camera: &Pix4d) -> Result<f64, CameraFileError> {
    let known = Some(camera.sensor_width_mm).filter(|&width| width > 0.0 && width.is_finite());
    known.ok_or_else(|| CameraFileError::new("the width of the sensor is not known: px cannot become mm"))
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let mut out = String::new();
    for (index, named) in cameras.iter().enumerate() {
        let Pix4d { size, sensor_width_mm, f_px, px, py, r, t, .. } = *camera(named, &FORMAT)?;
        width_of_sensor(camera(named, &FORMAT)?)?;
        let mm = sensor_width_mm / f64::from(size.width);
        let height = mm * f64::from(size.height);
        let name = if named.name.is_empty() { index.to_string() } else { named.name.replace(['\n', '\r'], " ") };
        out.push_str(&format!("{HEADER} {name}\n#Focal Length mm {SENSOR} {}x{}mm\n", fixed(sensor_width_mm), fixed(height)));
        out.push_str(&format!("F {}\n#Principal Point mm\nPx {}\nPy {}\n", fixed(f_px * mm), fixed(px * mm), fixed(py * mm)));
        out.push_str(&format!("#Symmetrical Lens Distortion Coeffs\nK1 {}\nK2 {}\nK3 {}\n", fixed(r[0]), fixed(r[1]), fixed(r[2])));
        out.push_str(&format!("#Tangential Lens Distortion Coeffs\nT1 {}\nT2 {}\n\n", fixed(t[0]), fixed(t[1])));
    }
    Ok(out)
}
