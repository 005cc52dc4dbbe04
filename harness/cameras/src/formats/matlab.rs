//! MATLAB's cameraIntrinsics and cameraParameters, as jsonencode writes them: the first pixel's centre is (1, 1).

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, CameraModel, ImageSize, tool_conventions};
use calibench_model::convert::Target;

use super::PLAIN;
use crate::brown::{Brown, positive};
use crate::format::Model;
use crate::json::json;
use crate::number::{pixels, row};
use crate::source::Source;
use crate::tree::{Entry, Value};
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "matlab",
    tool: "MATLAB, Computer Vision Toolbox",
    versions: "jsonencode of a struct of cameraIntrinsics or cameraParameters",
    extension: "json",
    words: "FocalLength PrincipalPoint ImageSize RadialDistortion TangentialDistortion Skew K IntrinsicMatrix Intrinsics WorldUnits NumPatterns",
    recognise: |source| {
        let has = |key: &str| source.text.contains(&format!("\"{key}\""));
        let found = source.text.trim_start().starts_with('{')
            && has("RadialDistortion")
            && (has("FocalLength") || has("IntrinsicMatrix") || has("K"));
        if found { Ok(()) } else { Err("no JSON with `RadialDistortion` and `FocalLength`".into()) }
    },
    read,
    write: Some(write),
    convention: Some(&tool_conventions::MATLAB),
    models: |_| vec![Model { name: "cameraIntrinsics", target: Target::OpenCv { coefficients: 5 } }],
    ..PLAIN
};

const LENS: [&str; 9] = [
    "FocalLength",
    "PrincipalPoint",
    "ImageSize",
    "RadialDistortion",
    "TangentialDistortion",
    "Skew",
    "K",
    "IntrinsicMatrix",
    "Intrinsics",
];
/// How it was calibrated.
const ABOUT: [&str; 15] = [
    "Version",
    "WorldPoints",
    "WorldUnits",
    "EstimateSkew",
    "NumRadialDistortionCoefficients",
    "EstimateTangentialDistortion",
    "NumPatterns",
    "TranslationVectors",
    "ReprojectionErrors",
    "DetectedKeypoints",
    "RotationVectors",
    "ReprojectedPoints",
    "MeanReprojectionError",
    "PatternExtrinsics",
    "RotationMatrices",
];

/// The first pixel's centre.
const ORIGIN: f64 = 1.0;

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let root = json(source.text)?;
    // Of cameraParameters the lens may be a part.
    let lens = match root.key("Intrinsics")? {
        Some(inner) if matches!(inner.value, Value::Map(_)) => inner,
        _ => &root,
    };
    let size = options.size_or(size(lens, &root)?)?;
    let skew = lens.number_or_zero("Skew")?;
    let (fx, fy, cx, cy, skew) = match lens.key("FocalLength")? {
        Some(_) => {
            let ([fx, fy], [cx, cy]) = (lens.row_of("FocalLength")?, lens.row_of("PrincipalPoint")?);
            (fx, fy, cx, cy, skew)
        }
        None => of_matrix(lens)?,
    };
    let at = |error: CameraFileError| error.on_line(lens.line);
    positive("FocalLength", fx).and(positive("FocalLength", fy)).map_err(at)?;
    let entry = lens.required("RadialDistortion")?;
    let radial = entry.row().map_err(|error| error.of("RadialDistortion"))?;
    if radial.len() > 3 {
        return Err(entry.wrong(&format!("expected 2 or 3 numbers, found {}", radial.len())).of("RadialDistortion"));
    }
    let mut k = [0.0; 4];
    k[..radial.len()].copy_from_slice(&radial);
    let [p1, p2] = if lens.key("TangentialDistortion")?.is_some() { lens.row_of("TangentialDistortion")? } else { [0.0; 2] };
    let camera = Brown { skew, k, p1, p2, ..Brown::plain(size, [fx, fy, cx - ORIGIN, cy - ORIGIN]) }.camera();
    let known = [&LENS[..], &ABOUT].concat();
    let mut notes = lens.of_lens(&known, options)?;
    if !std::ptr::eq(lens, &raw const root) {
        notes.extend(root.of_file(&known, options)?);
    }
    Ok(vec![NamedCamera { notes, ..NamedCamera::new("", camera) }])
}

/// Rows and columns; what was not known when the camera was calibrated is an empty list.
fn size(lens: &Entry, root: &Entry) -> Result<Option<ImageSize>, CameraFileError> {
    let Some(entry) = lens.key("ImageSize")?.or(root.key("ImageSize")?) else { return Ok(None) };
    let side = |side: &Entry| pixels(side.text()?).map_err(|error| error.on_line(side.line).of("ImageSize"));
    match entry.items()? {
        [] => Ok(None),
        [height, width] => Ok(Some(ImageSize { width: side(width)?, height: side(height)? })),
        other => Err(entry.wrong(&format!("expected rows and columns, found {} values", other.len())).of("ImageSize")),
    }
}

/// fx, fy, cx, cy and the skew of `K`, or of `IntrinsicMatrix`, which is its transpose.
fn of_matrix(lens: &Entry) -> Result<(f64, f64, f64, f64, f64), CameraFileError> {
    let (name, transposed) = if lens.key("K")?.is_some() { ("K", false) } else { ("IntrinsicMatrix", true) };
    let entry = lens.required(name)?;
    let rows = entry.rows().map_err(|error| error.of(name))?;
    let square = rows.len() == 3 && rows.iter().all(|row| row.len() == 3);
    if !square {
        return Err(entry.wrong("expected 3 x 3 numbers").of(name));
    }
    let at = |i: usize, j: usize| if transposed { rows[j][i] } else { rows[i][j] };
    let below = [at(1, 0), at(2, 0), at(2, 1)] == [0.0; 3] && at(2, 2) == 1.0;
    if !below {
        let expected = if transposed { "fx, 0, 0; s, fy, 0; cx, cy, 1" } else { "fx, s, cx; 0, fy, cy; 0, 0, 1" };
        return Err(entry.wrong(&format!("expected {expected}")).of(name));
    }
    Ok((at(0, 0), at(1, 1), at(0, 2), at(1, 2), at(0, 1)))
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let camera: &Camera = &cameras[0].camera;
    let brown = Brown::of(camera).filter(|brown| brown.k[3] == 0.0);
    let brown = brown.ok_or_else(|| FORMAT.other_model("a camera of k1, k2, k3, p1, p2 and a skew"))?;
    let Brown { fx, fy, skew, cx, cy, k: [k1, k2, k3, _], p1, p2, .. } = brown;
    let ImageSize { width, height } = camera.size();
    Ok(format!(
        "{{\n  \"FocalLength\": [{}],\n  \"PrincipalPoint\": [{}],\n  \"ImageSize\": [{height}, {width}],\n  \"RadialDistortion\": [{}],\n  \
         \"TangentialDistortion\": [{}],\n  \"Skew\": {}\n}}\n",
        row(&[fx, fy]),
        row(&[cx + ORIGIN, cy + ORIGIN]),
        row(&[k1, k2, k3]),
        row(&[p1, p2]),
        row(&[skew])
    ))
}
