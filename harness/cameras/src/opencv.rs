//! OpenCV's cameras in its FileStorage: what YAML and XML share.
//!
//! `camera_matrix`, `distortion_coefficients`, `image_width`, `image_height`, as OpenCV's calibration sample writes them, and the capitalised
//! names of Metashape's export. The fisheye camera is told by the sample's own `fisheye_model: 1` and the names that people give to it; without one four coefficients
//! are a pinhole camera's, for nothing else in the file tells them apart. With `xi` it is the camera of cv2.omnidir, which is Mei's.

use calibench_model::camera::{Camera, CameraModel, ImageSize, Omni, OpenCv, OpenCvFisheye};
use calibench_model::named_camera::{Pose, PoseFrame};
use nalgebra::{DMatrix, DVector};

use super::number::pixels;
use super::opencv_model::{self, Kind, kind};
use super::opencv_names::{Pair, chosen, pairs};
use super::opencv_storage::Matrix;
use super::pose::of_rt;
use super::tree::{Entry, Value};
use super::{CameraFileError, CameraFormat, NamedCamera, ParameterCovariance, ReadOptions};

const CAMERA_MATRIX: [&str; 4] = ["camera_matrix", "Camera_Matrix", "cameraMatrix", "Camera_matrix"];
const DISTORTION: [&str; 5] = ["distortion_coefficients", "Distortion_Coefficients", "distCoeffs", "dist_coeffs", "distortionCoefficients"];
const WIDTH: [&str; 6] = ["image_width", "image_Width", "Image_Width", "imageWidth", "img_width", "width"];
const HEIGHT: [&str; 6] = ["image_height", "image_Height", "Image_Height", "imageHeight", "img_height", "height"];
/// Columns and rows in one value, as OpenCV's interactive calibration writes them, and others.
const SIZE: [&str; 7] = ["cameraResolution", "calibImageSize", "image_size", "imageSize", "img_size", "Image_Size", "resolution"];
const XI: [&str; 1] = ["xi"];
/// Standard deviations, as OpenCV's interactive calibration writes them: of fx, fy, cx, cy and of the coefficients; and, here alone, of xi.
const SPREADS: [&str; 3] = ["cameraMatrix_std_dev", "dist_coeffs_std_dev", "xi_std_dev"];
const NAME: [&str; 1] = ["camera_name"];
/// How the calibration was made, as the samples of OpenCV and Metashape say it: nothing of the camera.
const ABOUT: [&str; 18] = [
    "rms",
    "reprojection_error",
    "calibration_time",
    "calibration_Time",
    "calibrationDate",
    "nr_of_frames",
    "nframes",
    "nFrames",
    "framesCount",
    "board_width",
    "board_height",
    "square_size",
    "marker_size",
    "aspectRatio",
    "fix_aspect_ratio",
    "flags",
    "avg_reprojection_error",
    "per_view_reprojection_errors",
];

/// Of two cameras: the second against the first, and what follows from that and is no more than the cameras say.
const OF_PAIR: [&str; 11] = ["R", "T", "E", "F", "R1", "R2", "P1", "P2", "Q", "validRoi1", "validRoi2"];

/// The cameras of a FileStorage: one under the usual names, or as many as [`pairs`] finds, each called as its matrix is.
pub(super) fn read(root: &Entry, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let usual = (root.get(&CAMERA_MATRIX)?, root.get(&DISTORTION)?);
    let none = without_distortion();
    let chosen = chosen(root, options, [usual.0, usual.1], &none)?;
    let is_usual = usual.0.is_some_and(|(name, _)| chosen.is_none_or(|[(matrix, _), _]| matrix == name));
    let pairs = match (chosen, usual) {
        (Some(pair), _) => vec![pair],
        (None, (Some(matrix), Some(distortion))) => vec![[matrix, distortion]],
        (None, (Some(_), None)) => pairs(root, DISTORTION[0])?,
        (None, (None, _)) => pairs(root, CAMERA_MATRIX[0])?,
    };
    let size = options.size_or(stated_size(root)?)?;
    let kind = kind(root, options)?;
    let usual = [&CAMERA_MATRIX[..], &DISTORTION, &WIDTH, &HEIGHT, &SIZE, &XI, &NAME, &SPREADS, &ABOUT].concat();
    let mut known: Vec<&str> = pairs.iter().flatten().map(|pair| pair.0).collect();
    usual.into_iter().chain(opencv_model::keys()).for_each(|name| known.push(name));
    let between = if pairs.len() == 2 { between(root)? } else { None };
    if between.is_some() {
        known.extend(OF_PAIR);
    }
    let notes = root.of_file(&known, options)?;
    let name = root.get(&NAME)?.map(|(_, entry)| entry.text()).transpose()?;
    let one = |pair: &Pair<'_>| {
        let (camera, note) = camera(root, pair, size, kind)?;
        let mut notes: Vec<String> = notes.iter().cloned().chain(note).collect();
        let own = if is_usual { "" } else { pair[0].0 };
        let covariance = if is_usual { spreads(root, &camera, &mut notes)? } else { None };
        Ok(NamedCamera { covariance, notes, ..NamedCamera::new(name.unwrap_or(own), camera) })
    };
    let mut cameras: Vec<NamedCamera> = pairs.iter().map(one).collect::<Result<_, _>>()?;
    if let (Some(pose), [first, second]) = (between, &mut cameras[..]) {
        (first.pose, second.pose) = (Some(Pose::IDENTITY), Some(pose));
        (first.pose_frame, second.pose_frame) = (PoseFrame::FirstCamera, PoseFrame::FirstCamera);
    }
    Ok(cameras)
}

/// Four coefficients of zero, which every model has.
fn without_distortion() -> Entry {
    let scalar = |text: &str| Entry { line: 0, value: Value::Scalar(text.to_owned()) };
    let parts = [("rows", "1"), ("cols", "4"), ("dt", "d"), ("data", "0 0 0 0")];
    Entry { line: 0, value: Value::Map(parts.iter().map(|(name, text)| ((*name).to_owned(), scalar(text))).collect()) }
}

/// The second of two cameras against the first, where the file says it as OpenCV's stereo sample does. Matrices of these names that are something else are
/// passed over.
fn between(root: &Entry) -> Result<Option<Pose>, CameraFileError> {
    let (Some(r), Some(t)) = (root.key(OF_PAIR[0])?, root.key(OF_PAIR[1])?) else { return Ok(None) };
    let of = |entry: &Entry| entry.matrix(9).map(|found| found.data).unwrap_or_default();
    let (rotation, t) = (of(r), of(t));
    if rotation.len() != 9 || t.len() != 3 {
        return Ok(None);
    }
    let rotation = std::array::from_fn(|i| std::array::from_fn(|j| rotation[3 * i + j]));
    Ok(of_rt(rotation, [t[0], t[1], t[2]]).ok())
}

/// The camera of a matrix and coefficients, and what was assumed of it.
fn camera(root: &Entry, pair: &Pair<'_>, size: ImageSize, kind: Option<Kind>) -> Result<(Camera, Option<String>), CameraFileError> {
    let [(matrix, at_matrix), (name, entry)] = *pair;
    let k = at_matrix.matrix(9).and_then(|found| camera_matrix(&found)).map_err(|error| placed(error, matrix, at_matrix))?;
    let distortion = entry.matrix(14).and_then(|found| vector(&found)).map_err(|error| placed(error, name, entry))?;
    let camera = match (mirror(root)?, kind) {
        (Some((_, at)), Some(Kind::Fisheye)) => {
            return Err(at.wrong("is cv2.omnidir's: no camera has it and is a fisheye of cv2's both").of(XI[0]));
        }
        (Some((xi, _)), _) => omnidirectional(size, &k, xi, &distortion),
        (None, Some(Kind::Omnidirectional)) => {
            return Err(root.wrong("has no `xi`, without which it is no camera of cv2.omnidir").of(XI[0]));
        }
        (None, Some(Kind::Fisheye)) => fisheye_camera(size, &k, &distortion),
        (None, _) => pinhole(size, &k, &distortion),
    };
    let is_open =
        kind.is_none() && distortion.len() == 4 && distortion.iter().any(|k| *k != 0.0) && matches!(camera, Ok(Camera::OpenCv(_)));
    let note = is_open.then(|| "four coefficients without `fisheye_model`: read as the pinhole camera's k1, k2, p1, p2".to_owned());
    Ok((camera.map_err(|error| placed(error, name, entry))?, note))
}

/// The parameters whose standard deviations stand in each of [`SPREADS`], in its order.
fn spread_names(camera: &Camera) -> [Vec<&'static str>; 3] {
    let all: Vec<&'static str> = camera.parameters().iter().map(|p| p.name).collect();
    let lens = all[4..].iter().copied().filter(|name| !["skew", "xi"].contains(name)).collect();
    [all[..4].to_vec(), lens, XI.to_vec()]
}

/// The variances of a camera's parameters, where the file has standard deviations; a zero is one that was held fixed.
fn spreads(root: &Entry, camera: &Camera, notes: &mut Vec<String>) -> Result<Option<ParameterCovariance>, CameraFileError> {
    let (mut names, mut variances, mut any, mut tied) = (Vec::new(), Vec::new(), false, None);
    for (key, parameters) in SPREADS.iter().zip(spread_names(camera)) {
        let Some((key, entry)) = root.get(&[key])? else { continue };
        let wrong = |problem: String| placed(CameraFileError::new(problem), key, entry);
        let sigmas = match entry.value {
            Value::Scalar(_) => entry.number().map(|sigma| vec![sigma]),
            _ => entry.matrix(14).and_then(|matrix| vector(&matrix)),
        };
        let sigmas = sigmas.map_err(|error| placed(error, key, entry))?;
        any = true;
        if let Some(least) = sigmas.iter().find(|sigma| **sigma < 0.0) {
            return Err(wrong(format!("expected standard deviations from 0, found {least}")));
        }
        if sigmas.iter().skip(parameters.len()).any(|sigma| *sigma > 0.0) {
            return Err(wrong(format!("has {} standard deviations, the camera {} such parameters", sigmas.len(), parameters.len())));
        }
        if parameters[0] == "fx" && matches!(sigmas[..], [0.0, fy, ..] if fy > 0.0) {
            match tied_focal(root, camera, sigmas[1])? {
                Some(sigma) => tied = Some((sigma, sigmas[1])),
                None => notes.push("fx has no standard deviation, and the flags do not tie it to fy: it is taken to have been held".into()),
            }
        }
        for (name, sigma) in parameters.into_iter().zip(sigmas).filter(|(_, sigma)| *sigma > 0.0) {
            names.push(name.to_owned());
            variances.push(sigma * sigma);
        }
    }
    let mut q = DMatrix::from_diagonal(&DVector::from_vec(variances));
    if let Some((fx, fy)) = tied {
        // Of a ratio that was held the two are one parameter; fy is the first that is named.
        names.insert(0, "fx".to_owned());
        q = q.insert_row(0, 0.0).insert_column(0, 0.0);
        (q[(0, 0)], q[(0, 1)], q[(1, 0)]) = (fx * fx, fx * fy, fx * fy);
        notes.push("fx has no standard deviation of its own: it was tied to fy, and has fy's times their ratio".into());
    }
    let covariance = any.then(|| ParameterCovariance::named(names, &q)).transpose();
    covariance.map_err(|problem| CameraFileError::new(problem).of(SPREADS[0]))
}

/// The standard deviation of an fx whose own is zero, for that of fy: by the ratio that was held, as a file says that has `fix_aspect_ratio`, `aspectRatio` or the flag
/// 2 of `calibrateCamera`, and as it is in one without flags, since nothing else of OpenCV's leaves fy alone free. `None` where flags say otherwise.
fn tied_focal(root: &Entry, camera: &Camera, fy_sigma: f64) -> Result<Option<f64>, CameraFileError> {
    const FIX_ASPECT_RATIO: u32 = 2;
    let Camera::OpenCv(OpenCv { fx, fy, .. }) = *camera else { return Ok(None) };
    let holds = |name: &str| Ok::<_, CameraFileError>(root.key(name)?.and_then(|entry| entry.number().ok()));
    let stated = holds("fix_aspect_ratio")?.or(holds("aspectRatio")?).is_some_and(|ratio| ratio > 0.0);
    let by_flags = holds("flags")?.is_none_or(|flags| flags as u32 & FIX_ASPECT_RATIO != 0);
    Ok((stated || by_flags).then_some(fy_sigma * fx / fy))
}

/// The standard deviations of a camera by their keys, one after another; that of an fx which is tied to fy is zero, as in OpenCV's files.
pub(super) fn written_spreads(named: &NamedCamera) -> Vec<(&'static str, Vec<f64>)> {
    let Some(covariance) = &named.covariance else { return Vec::new() };
    let n = covariance.parameters.len();
    let place = |name: &str| covariance.parameters.iter().position(|own| own == name);
    let is_tied = place("fx").zip(place("fy")).is_some_and(|(i, j)| {
        let [xx, xy, yy] = [(i, i), (i, j), (j, j)].map(|(row, column)| covariance.values[row * n + column]);
        xy > 0.0 && (xy * xy - xx * yy).abs() <= 1e-12 * xx * yy
    });
    let sigma = |name: &str| match place(name) {
        Some(place) if !(is_tied && name == "fx") => covariance.values[place * n + place].sqrt(),
        _ => 0.0,
    };
    let rows =
        SPREADS.into_iter().zip(spread_names(&named.camera)).map(|(key, names)| (key, names.into_iter().map(sigma).collect::<Vec<_>>()));
    rows.filter(|(key, sigmas)| *key != SPREADS[2] || sigmas[0] > 0.0).collect()
}

/// The error with the name of the matrix, and with its line if it has none of its own.
fn placed(error: CameraFileError, name: &str, entry: &Entry) -> CameraFileError {
    let line = error.line.unwrap_or(entry.line as u32);
    let inner = error.element.as_ref().map_or(String::new(), |inner| format!(".{inner}"));
    error.on_line(line as usize).of(format!("{name}{inner}"))
}

pub(super) fn camera_matrix(matrix: &Matrix) -> Result<[f64; 9], CameraFileError> {
    let k: [f64; 9] = match (matrix.rows, matrix.columns, <[f64; 9]>::try_from(matrix.data.as_slice())) {
        (3, 3, Ok(k)) => k,
        (rows, columns, _) => return Err(CameraFileError::new(format!("expected 3 x 3, found {rows} x {columns}"))),
    };
    if k[3] != 0.0 || k[6..] != [0.0, 0.0, 1.0] {
        return Err(CameraFileError::new("expected fx, s, cx; 0, fy, cy; 0, 0, 1"));
    }
    if k[0] <= 0.0 || k[4] <= 0.0 {
        return Err(CameraFileError::new(format!("expected focal lengths above zero, found {} and {}", k[0], k[4])));
    }
    Ok(k)
}

fn vector(matrix: &Matrix) -> Result<Vec<f64>, CameraFileError> {
    if matrix.rows == 1 || matrix.columns == 1 {
        return Ok(matrix.data.clone());
    }
    Err(CameraFileError::new(format!("expected one row or one column, found {} x {}", matrix.rows, matrix.columns)))
}

fn stated_size(root: &Entry) -> Result<Option<ImageSize>, CameraFileError> {
    let side = |names: &[&str]| {
        root.get(names)?.map(|(name, entry)| entry.text().and_then(pixels).map_err(|error| placed(error, name, entry))).transpose()
    };
    let sides = match (side(&WIDTH)?, side(&HEIGHT)?) {
        (Some(width), Some(height)) => Some(ImageSize { width, height }),
        (None, None) => None,
        _ => return Err(root.wrong("expected `image_width` and `image_height`, found one of them")),
    };
    let Some((name, entry)) = root.get(&SIZE)? else { return Ok(sides) };
    let whole = size_in_one(entry).map_err(|error| placed(error, name, entry))?;
    match sides {
        Some(sides) if sides != whole => {
            let ImageSize { width, height } = sides;
            Err(entry.wrong(&format!("says another size than `image_width` and `image_height`, {width} x {height} px")).of(name))
        }
        _ => Ok(Some(whole)),
    }
}

/// Columns and rows in a list, in a text as XML has them, or in a matrix.
fn size_in_one(entry: &Entry) -> Result<ImageSize, CameraFileError> {
    let words: Vec<&str> = match &entry.value {
        Value::Map(_) => {
            let numbers = entry.matrix(2)?.data;
            let side = |index: usize| pixels(&numbers.get(index).copied().unwrap_or(0.0).to_string());
            return Ok(ImageSize { width: side(0)?, height: side(1)? });
        }
        Value::List(items) => items.iter().map(Entry::text).collect::<Result<_, _>>()?,
        Value::Scalar(_) => entry.text()?.split_whitespace().collect(),
    };
    match words[..] {
        [width, height] => Ok(ImageSize { width: pixels(width)?, height: pixels(height)? }),
        _ => Err(entry.wrong(&format!("expected columns and rows, found {} values", words.len()))),
    }
}

/// `xi` of cv2.omnidir, a number or a matrix of one.
fn mirror(root: &Entry) -> Result<Option<(f64, &Entry)>, CameraFileError> {
    let Some((name, entry)) = root.get(&XI)? else { return Ok(None) };
    let value = match entry.value {
        Value::Map(_) => entry.matrix(1).map(|matrix| matrix.data[0]),
        _ => entry.number(),
    };
    let value = value.map_err(|error| placed(error, name, entry))?;
    if value < 0.0 {
        return Err(entry.wrong(&format!("expected a number from 0, found {value}")).of(name));
    }
    Ok(Some((value, entry)))
}

pub(super) fn pinhole(size: ImageSize, k: &[f64; 9], found: &[f64]) -> Result<Camera, CameraFileError> {
    if k[1] != 0.0 {
        return Err(CameraFileError::new(format!("the camera matrix has a skew of {}; OpenCV's pinhole camera has none", k[1])));
    }
    if ![4, 5, 8, 12, 14].contains(&found.len()) {
        return Err(CameraFileError::new(format!("expected 4, 5, 8, 12 or 14 coefficients, found {}", found.len())));
    }
    let mut distortion = [0.0; 14];
    distortion[..found.len()].copy_from_slice(found);
    Ok(Camera::OpenCv(OpenCv { size, fx: k[0], fy: k[4], cx: k[2], cy: k[5], distortion, coefficients: found.len() }))
}

/// cv2.omnidir's camera: the generalised focal lengths stand in the camera matrix.
fn omnidirectional(size: ImageSize, k: &[f64; 9], xi: f64, found: &[f64]) -> Result<Camera, CameraFileError> {
    if k[1] != 0.0 {
        return Err(CameraFileError::new(format!(
            "the camera matrix has a skew of {}, which is not known here beside `xi`; expected 0",
            k[1]
        )));
    }
    let [k1, k2, p1, p2] = <[f64; 4]>::try_from(found)
        .map_err(|_| CameraFileError::new(format!("expected 4 coefficients beside `xi`, k1, k2, p1, p2, found {}", found.len())))?;
    Ok(Omni { size, fx: k[0], fy: k[4], cx: k[2], cy: k[5], xi, k: [k1, k2], p: [p1, p2] }.into())
}

pub(super) fn fisheye_camera(size: ImageSize, k: &[f64; 9], found: &[f64]) -> Result<Camera, CameraFileError> {
    let Ok(coefficients) = <[f64; 4]>::try_from(found) else {
        return Err(CameraFileError::new(format!("expected 4 coefficients of the fisheye camera, found {}", found.len())));
    };
    let camera = OpenCvFisheye { size, fx: k[0], fy: k[4], cx: k[2], cy: k[5], skew: k[1] / k[0], k: coefficients };
    Ok(Camera::OpenCvFisheye(camera))
}

/// What both kinds of FileStorage write of a camera: the camera matrix, 3 x 3, row by row, px, and the coefficients in OpenCV's order.
pub(super) struct Written {
    pub size: ImageSize,
    pub fisheye: bool,
    /// Of cv2.omnidir's camera.
    pub xi: Option<f64>,
    pub matrix: [f64; 9],
    pub distortion: Vec<f64>,
}

/// The parts of a camera of OpenCV's.
pub(super) fn written(camera: &Camera, format: &CameraFormat) -> Result<Written, CameraFileError> {
    let matrix = |fx, skew, cx, fy, cy| [fx, skew, cx, 0.0, fy, cy, 0.0, 0.0, 1.0];
    match *camera {
        Camera::OpenCv(OpenCv { size, fx, fy, cx, cy, distortion, coefficients }) if [4, 5, 8, 12, 14].contains(&coefficients) => {
            let distortion = distortion[..coefficients].to_vec();
            Ok(Written { size, fisheye: false, xi: None, matrix: matrix(fx, 0.0, cx, fy, cy), distortion })
        }
        Camera::OpenCvFisheye(OpenCvFisheye { size, fx, fy, cx, cy, skew, k }) => {
            Ok(Written { size, fisheye: true, xi: None, matrix: matrix(fx, fx * skew, cx, fy, cy), distortion: k.to_vec() })
        }
        Camera::Omni(Omni { size, fx, fy, cx, cy, xi, k, p }) => {
            Ok(Written { size, fisheye: false, xi: Some(xi), matrix: matrix(fx, 0.0, cx, fy, cy), distortion: [k, p].concat() })
        }
        _ => Err(format.other_model("a camera of OpenCV's models")),
    }
}
