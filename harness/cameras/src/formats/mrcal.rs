//! mrcal's .cameramodel: a Python dictionary. A splined model is fitted by one that other tools have, and its residual is said.

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, CameraModel, Eucm, ImageSize, OpenCv, Splined, tool_conventions};
use calibench_model::convert::Target;
use calibench_model::named_camera::{Pose, Splines};

use super::PLAIN;
use crate::brown::positive;
use crate::format::{Keeps, KeptPose, Model};
use crate::number::{row, shortened};
use crate::pose::{of_rotation_vector, of_rt, rotation_vector};
use crate::source::Source;
use crate::splines::nearest;
use crate::tree::Entry;
use crate::{CameraFileError, CameraFormat, ReadOptions, json};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "mrcal",
    tool: "mrcal",
    versions: ".cameramodel of 1 and 2, to 2.5",
    extension: "cameramodel",
    words: "lensmodel intrinsics extrinsics rt_cam_ref imagersize valid_intrinsics_region optimization_inputs",
    verified: Some("mrcal 2.2 reads what is written and projects alike, models to 1e-8 px and splines to 1e-6 px"),
    recognise: |source| {
        let first = source.lines().find(|(_, line)| !line.starts_with('#')).map_or("", |(_, line)| line);
        if first.starts_with('{') && source.text.contains(PREFIX) { Ok(()) } else { Err("no `LENSMODEL_`".into()) }
    },
    read,
    write: Some(write),
    convention: Some(&tool_conventions::MRCAL),
    models: |_| {
        let opencv = |name, coefficients| Model { name, target: Target::OpenCv { coefficients } };
        vec![
            opencv("LENSMODEL_OPENCV4", 4),
            opencv("LENSMODEL_OPENCV5", 5),
            opencv("LENSMODEL_OPENCV8", 8),
            opencv("LENSMODEL_OPENCV12", 12),
        ]
    },
    keeps: Keeps { splines: true, pose: KeptPose::InWorld, ..PLAIN.keeps },
    ..PLAIN
};

const PREFIX: &str = "LENSMODEL_";
const SPLINED: &str = "SPLINED_STEREOGRAPHIC_";
const KNOWN: [&str; 6] = ["lensmodel", "lens_model", "intrinsics", "extrinsics", "rt_cam_ref", "imagersize"];
/// Control points at most: each takes memory and time.
const MOST_POINTS: usize = 100_000;

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let root = json::python(source.text)?;
    let size = options.size_or(Some(root.size_in("imagersize")?))?;
    let Some((key, entry)) = root.get(&["lensmodel", "lens_model"])? else { return Err(root.wrong("has no `lensmodel`")) };
    let model = entry.text()?.strip_prefix(PREFIX).unwrap_or("");
    let intrinsics = root.required("intrinsics")?;
    let v = intrinsics.row().map_err(|error| error.of("intrinsics"))?;
    let at = |error: CameraFileError| error.on_line(intrinsics.line).of("intrinsics");
    let (mut notes, mut splines) = (root.of_file(&KNOWN, options)?, None);
    let camera = match model.strip_prefix(SPLINED) {
        Some(shape) => {
            let spline = splined(shape, size, &v).map_err(|error| error.on_line(entry.line).of(key))?;
            if options.splines_alone {
                return Ok(vec![NamedCamera { pose: pose(&root)?, notes, ..NamedCamera::splined("", spline) }]);
            }
            let (camera, kept, note) = nearest(spline).map_err(|problem| CameraFileError::new(problem).on_line(entry.line).of(key))?;
            notes.push(note);
            splines = Some(Box::new(kept));
            camera
        }
        None => parametric(model, size, &v).map_err(|error| if error.element.is_none() { at(error) } else { error.on_line(entry.line) })?,
    };
    let pose = pose(&root)?;
    Ok(vec![NamedCamera { splines, pose, notes, ..NamedCamera::new("", camera) }])
}

fn pose(root: &Entry) -> Result<Option<Pose>, CameraFileError> {
    // 2.5 writes the older name beside its own.
    let (new, old) =
        (root.key("rt_cam_ref")?.map(|entry| ("rt_cam_ref", entry)), root.key("extrinsics")?.map(|entry| ("extrinsics", entry)));
    let Some((name, entry)) = new.or(old) else { return Ok(None) };
    let [a, b, c, x, y, z] = root.row_of(name)?;
    if let (Some(_), Some((other, at))) = (new, old)
        && root.row_of(other)? != [a, b, c, x, y, z]
    {
        return Err(at.wrong(&format!("says another pose than `{name}`")).of(other));
    }
    of_rt(of_rotation_vector([a, b, c]), [x, y, z]).map(Some).map_err(|error| error.on_line(entry.line).of(name))
}

fn parametric(model: &str, size: ImageSize, v: &[f64]) -> Result<Camera, CameraFileError> {
    let count = match model {
        "PINHOLE" | "STEREOGRAPHIC" => 4,
        "OPENCV4" => 8,
        "OPENCV5" => 9,
        "OPENCV8" => 12,
        "OPENCV12" => 16,
        _ => {
            let known = "LENSMODEL_PINHOLE, STEREOGRAPHIC, OPENCV4, 5, 8, 12 and SPLINED_STEREOGRAPHIC_...";
            return Err(CameraFileError::new(format!("`{PREFIX}{}` is not known; expected {known}", shortened(model))).of("lensmodel"));
        }
    };
    if v.len() != count {
        return Err(CameraFileError::new(format!("expected {count} numbers for {model}, found {}", v.len())));
    }
    let (fx, fy, cx, cy) = (positive("intrinsics", v[0])?, positive("intrinsics", v[1])?, v[2], v[3]);
    if model == "STEREOGRAPHIC" {
        return Ok(Eucm { size, fx, fy, cx, cy, alpha: 0.5, beta: 1.0 }.into());
    }
    let mut distortion = [0.0; 14];
    distortion[..count - 4].copy_from_slice(&v[4..]);
    Ok(OpenCv { size, fx, fy, cx, cy, distortion, coefficients: (count - 4).max(4) }.into())
}

/// Of `order=3_Nx=16_Ny=11_fov_x_deg=120`.
pub(crate) fn splined(shape: &str, size: ImageSize, v: &[f64]) -> Result<Splined, CameraFileError> {
    let wrong = || CameraFileError::new(format!("expected order=3_Nx=16_Ny=11_fov_x_deg=120 or alike, found `{}`", shortened(shape)));
    let number = |name: &str| {
        let text = shape.split_once(&format!("{name}=")).map_or("", |(_, rest)| rest);
        let digits: String = text.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
        digits.parse::<f64>().map_err(|_| wrong())
    };
    let (order, columns, rows) = (number("order")? as usize, number("Nx")? as usize, number("Ny")? as usize);
    let count = columns.checked_mul(rows).filter(|&count| count <= MOST_POINTS).ok_or_else(wrong)?;
    if v.len() != 4 + 2 * count {
        return Err(CameraFileError::new(format!("expected {} intrinsics, found {}", 4 + 2 * count, v.len())));
    }
    let control = v[4..].chunks(2).map(|pair| [pair[0], pair[1]]).collect();
    let spline = Splined { size, core: [v[0], v[1], v[2], v[3]], order, columns, rows, fov_x_deg: number("fov_x_deg")?, control };
    spline.check().map_err(CameraFileError::new)?;
    positive("intrinsics", v[0])?;
    positive("intrinsics", v[1])?;
    Ok(spline)
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let named = &cameras[0];
    let size = named.camera.size();
    let other = || FORMAT.other_model("a camera of PINHOLE, STEREOGRAPHIC and OPENCV4 to 12");
    let (model, values) = match &named.splines {
        Some(splines) => of_splines(splines),
        None => parts(&named.camera).ok_or_else(other)?,
    };
    let pose = named.pose.unwrap_or(Pose::IDENTITY);
    let rt = [rotation_vector(pose.camera_from_world), pose.t()].concat();
    Ok(format!(
        "{{\n    'lensmodel':  '{PREFIX}{model}',\n\n    # intrinsics are fx,fy,cx,cy,distortion0,distortion1,....\n    'intrinsics': [ {} ],\n\n    \
         # extrinsics are rt_fromref\n    'extrinsics': [ {} ],\n\n    'imagersize': [ {}, {} ]\n}}\n",
        row(&values),
        row(&rt),
        size.width,
        size.height
    ))
}

fn of_splines(splines: &Splines) -> (String, Vec<f64>) {
    let Splined { core, order, columns, rows, fov_x_deg, control, .. } = &splines.model;
    let model = format!("{SPLINED}order={order}_Nx={columns}_Ny={rows}_fov_x_deg={fov_x_deg}");
    (model, core.iter().chain(control.iter().flatten()).copied().collect())
}

fn parts(camera: &Camera) -> Option<(String, Vec<f64>)> {
    match *camera {
        Camera::Eucm(Eucm { fx, fy, cx, cy, alpha: 0.5, beta: 1.0, .. }) => Some(("STEREOGRAPHIC".into(), vec![fx, fy, cx, cy])),
        Camera::OpenCv(OpenCv { fx, fy, cx, cy, distortion, coefficients, .. }) if [4, 5, 8, 12].contains(&coefficients) => {
            Some((format!("OPENCV{coefficients}"), [&[fx, fy, cx, cy][..], &distortion[..coefficients]].concat()))
        }
        _ => None,
    }
}
