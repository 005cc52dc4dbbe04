//! The .cam that Pix4D writes for INPHO.
//!
//! With `s` = sensor width / W: `f = FOCAL / s`, `cx = W/2 - XPOFF`, `cy = H/2 - YPOFF` (in px), `R_i = SYM_DIST_i FOCAL^(2i+1)`,
//! `T_i = DEC_DIST_i FOCAL^2`: confirmed by the camera matrix and the coefficients that Pix4D wrote of the same project. The sizes of sensor and
//! image stand in its comments, so a .cam of INPHO's own, without them, is refused.

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, ImageSize, Pix4d, TangentialOrder};

use super::PLAIN;
use super::pix4d_cam::{camera, sensor, width_of_sensor};
use crate::format::{Keeps, KeptCovariance, KeptPose};
use crate::number::{finite, fixed, pixels, shortened};
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "pix4d-inpho",
    tool: "Pix4D, for INPHO",
    versions: "calibrated_internal_camera_parameters.cam",
    extension: "cam",
    words: "camera_calibration_file FOCAL XPOFF YPOFF SYM_DIST DEC_DIST",
    verified: Some(
        "Pix4D's camera matrix and coefficients of the same project, to their printed digits (order and signs of T1, T2 in use: unverified)",
    ),
    many: false,
    states_size: true,
    recognise: |source| {
        let first = source.lines().next().map_or("", |(_, line)| line);
        if first.starts_with(HEADER) { Ok(()) } else { Err(format!("the first line does not begin with `{HEADER}`")) }
    },
    read,
    write: Some(write),
    keeps: Keeps { splines: false, name: false, pitch: true, pose: KeptPose::None, covariance: KeptCovariance::None },
    ..PLAIN
};

const HEADER: &str = "camera_calibration_file";
/// Keys without meaning for the camera; after `FID_PAIRS` and `DIST_PAIRS` come lines of numbers.
const IGNORED: [&str; 5] = ["NUM_FIDS", "DATA_STRIP_SIDE", "FID_PAIRS", "NUM_DIST_PAIRS", "DIST_PAIRS"];

/// The unit and sign of an XPOFF, YPOFF, as the comment above it says.
#[derive(Clone, Copy, PartialEq)]
enum Unit {
    Pixel,
    Mm,
    Inpho,
}

#[derive(Default)]
struct Parts {
    sensor: Option<(f64, f64)>,
    size: Option<ImageSize>,
    focal: Option<f64>,
    /// Unit, x, y: as many as the file has.
    offsets: Vec<(Option<Unit>, bool, f64)>,
    radial: Option<[f64; 4]>,
    decentring: Option<[f64; 3]>,
    unit: Option<Unit>,
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let mut parts = Parts::default();
    for (line, text) in source.lines().skip(1) {
        parts.take(text).map_err(|error| error.on_line(line))?;
    }
    parts.camera(options).map(|camera| vec![camera])
}

/// Puts `value` where nothing was.
fn once<T>(slot: &mut Option<T>, value: T, key: &str) -> Result<(), CameraFileError> {
    match slot.replace(value) {
        Some(_) => Err(CameraFileError::new("stands twice; expected once").of(key)),
        None => Ok(()),
    }
}

impl Parts {
    fn take(&mut self, text: &str) -> Result<(), CameraFileError> {
        if let Some(comment) = text.strip_prefix('#') {
            return self.comment(comment);
        }
        let (key, value) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let located = |error: CameraFileError| error.of(key);
        match key {
            "FOCAL" => once(&mut self.focal, finite(value).map_err(located)?, key),
            "XPOFF" | "YPOFF" => {
                self.offsets.push((self.unit, key == "XPOFF", finite(value).map_err(located)?));
                Ok(())
            }
            "SYM_DIST" => once(&mut self.radial, crate::number::numbers(value).map_err(located)?, key),
            "DEC_DIST" => once(&mut self.decentring, crate::number::numbers(value).map_err(located)?, key),
            key if IGNORED.contains(&key) || finite(key).is_ok() => Ok(()),
            key => Err(CameraFileError::new("unknown; expected FOCAL, XPOFF, YPOFF, SYM_DIST, DEC_DIST, fiducials").of(shortened(key))),
        }
    }

    fn comment(&mut self, comment: &str) -> Result<(), CameraFileError> {
        if let Some((_, size)) = comment.split_once("assuming a sensor width of") {
            once(&mut self.sensor, sensor(size)?, "#Focal Length")?;
        } else if let Some(size) = comment.strip_prefix("Image size") {
            let size = size.trim().trim_end_matches("pixel").trim();
            let (width, height) =
                size.split_once('x').ok_or_else(|| CameraFileError::new("expected a size as in 5472x3648").of("#Image size"))?;
            once(&mut self.size, ImageSize { width: pixels(width)?, height: pixels(height)? }, "#Image size")?;
        } else if comment.starts_with("Principal Point") {
            self.unit = match comment {
                c if c.contains("in pixel") => Some(Unit::Pixel),
                c if c.contains("(Inpho)") => Some(Unit::Inpho),
                c if c.contains("in mm") => Some(Unit::Mm),
                _ => None,
            };
        }
        Ok(())
    }

    /// XPOFF and YPOFF in px: from the line in px, with which the others must agree, or else from INPHO's.
    fn offset(&self, axis_is_x: bool, mm: f64) -> Result<f64, CameraFileError> {
        let key = if axis_is_x { "XPOFF" } else { "YPOFF" };
        let in_px = |&(unit, _, value): &(Option<Unit>, bool, f64)| match unit {
            Some(Unit::Pixel) => Some(value),
            Some(Unit::Mm) => Some(value / mm),
            // INPHO's x points the other way.
            Some(Unit::Inpho) => Some(if axis_is_x { -value / mm } else { value / mm }),
            None => None,
        };
        let own: Vec<_> = self.offsets.iter().filter(|offset| offset.1 == axis_is_x).collect();
        let best = own.iter().find(|offset| offset.0 == Some(Unit::Pixel)).or_else(|| own.iter().find(|offset| offset.0.is_some()));
        let missing = || CameraFileError::new("missing below a comment `#Principal Point Offset` that says its unit").of(key);
        let value = best.copied().and_then(in_px).ok_or_else(missing)?;
        match own.iter().filter_map(|offset| in_px(offset)).find(|other| (other - value).abs() > 1e-6) {
            Some(other) => Err(CameraFileError::new(format!("is {value} px and {other} px; expected the same in all units")).of(key)),
            None => Ok(value),
        }
    }

    fn camera(&self, options: &ReadOptions) -> Result<NamedCamera, CameraFileError> {
        let missing = |what: &str| CameraFileError::new("missing; only the .cam that Pix4D writes is understood").of(what);
        let (sensor_width_mm, _) = self.sensor.ok_or_else(|| missing("#Focal Length (mm) assuming a sensor width of"))?;
        let size = options.size_or(Some(self.size.ok_or_else(|| missing("#Image size"))?))?;
        let focal = self.focal.filter(|&focal| focal > 0.0);
        let focal = focal.ok_or_else(|| CameraFileError::new("expected a focal length above zero").of("FOCAL"))?;
        let [k0, k1, k2, k3] = self.radial.ok_or_else(|| missing("SYM_DIST"))?;
        let [p1, p2, p3] = self.decentring.ok_or_else(|| missing("DEC_DIST"))?;
        for (value, key) in [(k0, "SYM_DIST"), (p3, "DEC_DIST")] {
            if value != 0.0 {
                return Err(CameraFileError::new(format!("K0 or p3 is {value}; Pix4D's model has neither")).of(key));
            }
        }
        let mm = sensor_width_mm / f64::from(size.width);
        let (px, py) = (f64::from(size.width) / 2.0 - self.offset(true, mm)?, f64::from(size.height) / 2.0 - self.offset(false, mm)?);
        let r = [k1 * focal.powi(3), k2 * focal.powi(5), k3 * focal.powi(7)];
        let t = [p1 * focal.powi(2), p2 * focal.powi(2)];
        let camera = Pix4d { size, sensor_width_mm, f_px: focal / mm, px, py, r, t, order: TangentialOrder::OpenCv };
        Ok(NamedCamera { pitch_um: Some(mm * 1e3), ..NamedCamera::new("", Camera::Pix4d(camera)) })
    }
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let camera = *camera(&cameras[0], &FORMAT)?;
    let width_mm = width_of_sensor(&camera)?;
    let (width, height) = (f64::from(camera.size.width), f64::from(camera.size.height));
    let mm = width_mm / width;
    let (focal, height_mm) = (camera.f_px * mm, height * mm);
    let (x, y) = (width / 2.0 - camera.px, height / 2.0 - camera.py);
    let mut out = format!("{HEADER} 0\n#Focal Length (mm) assuming a sensor width of {}x{}mm\n", fixed(width_mm), fixed(height_mm));
    out.push_str(&format!("#Image size {width:.20}x{height:.20} pixel\nFOCAL {}\n\n", fixed(focal)));
    let mut offset = |unit: &str, x: f64, y: f64| {
        out.push_str(&format!("#Principal Point Offset xpoff ypoff in {unit}\nXPOFF {}\nYPOFF {}\n", fixed(x), fixed(y)));
    };
    offset("mm (Inpho)", -x * mm, y * mm);
    offset("mm ", x * mm, y * mm);
    offset("pixel ", x, y);
    out.push_str("\n#How many fiducial pairs (max 8):\nNUM_FIDS 4 \n\n#Fiducials position\nDATA_STRIP_SIDE left\n\n#Fiducial x,y pairs in mm:\nFID_PAIRS\n");
    for (sx, sy) in [(0.5, -0.5), (-0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)] {
        out.push_str(&format!("    {} {}\n", fixed(sx * width_mm), fixed(sy * height_mm)));
    }
    let k: Vec<String> = camera.r.iter().zip([3, 5, 7]).map(|(r, power)| fixed(r / focal.powi(power))).collect();
    let p: Vec<String> = camera.t.iter().map(|t| fixed(t / focal.powi(2))).collect();
    out.push_str(&format!("\n#Symmetrical Lens Distortion Odd-order Poly Coeffs:K0,K1,K2,K3\nSYM_DIST 0 {}\n", k.join(" ")));
    out.push_str(&format!("\n#Decentering Lens Coeffs p1,p2,p3\nDEC_DIST {} 0\n", p.join(" ")));
    Ok(out)
}
