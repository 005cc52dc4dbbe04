//! Cameras of a FileStorage whose matrices have names of one's own: K and D, M1 and D1, cam_int and cam_dist.

use super::keys::words;
use super::number::shortened;
use super::tree::{Entry, Value};
use super::{CameraFileError, ReadOptions};

/// What the coefficients of a camera without distortion are called.
pub(super) const NO_DISTORTION: &str = "none";

/// Words that say no more than that a matrix is a camera's.
const OF_CAMERA: [&str; 13] =
    ["k", "m", "a", "mtx", "mat", "matrix", "camera", "intrinsic", "intrinsics", "int", "internal", "cameramatrix", "calibration"];
/// Words that say no more than that numbers are coefficients of distortion.
const OF_DISTORTION: [&str; 14] = [
    "d",
    "dist",
    "distort",
    "distortion",
    "distortions",
    "coeff",
    "coeffs",
    "coef",
    "coefs",
    "coefficient",
    "coefficients",
    "distcoeffs",
    "vector",
    "vec",
];
/// Counts of coefficients that OpenCV has.
const COUNTS: [usize; 5] = [4, 5, 8, 12, 14];
/// A focal length below this, px, is that of no camera: unit and rotation matrices have it.
const SHORTEST: f64 = 2.0;

/// A camera matrix and its coefficients, each with its name.
pub(super) type Pair<'a> = [(&'a str, &'a Entry); 2];

/// Which camera a matrix is of, by the words of its name that do not say what it is.
fn owner(name: &str, plain: &[&str]) -> Option<Vec<String>> {
    let all = words(name);
    let own: Vec<String> = all.iter().filter(|word| !plain.contains(&word.as_str())).cloned().collect();
    (own.len() < all.len()).then_some(own)
}

fn is_camera_matrix(entry: &Entry) -> bool {
    entry.matrix(9).is_ok_and(|found| match found.data[..] {
        [fx, _, _, zero, fy, _, a, b, c] => found.rows == 3 && fx >= SHORTEST && fy >= SHORTEST && [zero, a, b, c] == [0.0, 0.0, 0.0, 1.0],
        _ => false,
    })
}

fn is_distortion(entry: &Entry) -> bool {
    entry.matrix(14).is_ok_and(|found| (found.rows == 1 || found.columns == 1) && COUNTS.contains(&found.data.len()))
}

/// Whether one of the matrices may be a camera's.
pub(super) fn has_camera_matrix(root: &Entry) -> bool {
    root.entries().is_ok_and(|entries| entries.iter().any(|(_, entry)| is_camera_matrix(entry)))
}

/// The cameras of a storage by what its matrices are, in the file's order. A matrix and coefficients belong together whose names say the same beside what they are; where
/// there is one of each they do whatever they are called.
///
/// # Errors
/// A storage without such a pair: it names what is `missing`, and the matrices that are there.
pub(super) fn pairs<'a>(root: &'a Entry, missing: &str) -> Result<Vec<Pair<'a>>, CameraFileError> {
    let entries = root.entries()?.iter().map(|(name, entry)| (name.as_str(), entry));
    let (matrices, others): (Vec<_>, Vec<_>) = entries.partition(|(_, entry)| is_camera_matrix(entry));
    let named = |(name, entry): &(&str, &Entry)| is_distortion(entry) && owner(name, &OF_DISTORTION).is_some();
    let coefficients: Vec<(&str, &Entry)> = others.iter().copied().filter(named).collect();
    if let ([matrix], [own]) = (&matrices[..], &coefficients[..]) {
        return Ok(vec![[*matrix, *own]]);
    }
    let mut found = Vec::new();
    for matrix in &matrices {
        let Some(whose) = owner(matrix.0, &OF_CAMERA) else { continue };
        let mut own = coefficients.iter().filter(|(name, _)| owner(name, &OF_DISTORTION).as_ref() == Some(&whose));
        if let (Some(first), None) = (own.next(), own.next()) {
            found.push([*matrix, *first]);
        }
    }
    if found.is_empty() { Err(none(root, missing, &matrices, &others)) } else { Ok(found) }
}

/// The camera whose matrix or coefficients the user names, if either is named; the other one is that of the usual names, or the only one that there is. Coefficients
/// called [`NO_DISTORTION`] are `none`.
///
/// # Errors
/// A name that is not there: it lists those that are; another one that is not given where there are several.
pub(super) fn chosen<'a>(
    root: &'a Entry,
    options: &ReadOptions,
    [usual_matrix, usual_distortion]: [Option<(&'a str, &'a Entry)>; 2],
    none: &'a Entry,
) -> Result<Option<Pair<'a>>, CameraFileError> {
    if options.matrix.is_none() && options.distortion.is_none() {
        return Ok(None);
    }
    let called = |name: &str| root.get(&[name])?.ok_or_else(|| root.wrong(&format!("is not there; there are {}", all(root))).of(name));
    let only = |is: fn(&Entry) -> bool, option: &str| {
        let mut all = root.entries()?.iter().filter(|(_, entry)| is(entry)).map(|(name, entry)| (name.as_str(), entry));
        match (all.next(), all.next()) {
            (Some(one), None) => Ok(one),
            _ => Err(root.wrong(&format!("which one belongs to it? Name it with {option}; there are {}", self::all(root)))),
        }
    };
    let matrix = match &options.matrix {
        Some(name) => called(name)?,
        None => usual_matrix.map_or_else(|| only(is_camera_matrix, "--matrix"), Ok)?,
    };
    let distortion = match options.distortion.as_deref() {
        Some(NO_DISTORTION) => (NO_DISTORTION, none),
        Some(name) => called(name)?,
        None => usual_distortion.map_or_else(|| only(is_distortion, "--distortion"), Ok)?,
    };
    Ok(Some([matrix, distortion]))
}

/// All names with the shapes of what is a matrix.
fn all(root: &Entry) -> String {
    const MOST: usize = 30;
    let entries = root.entries().unwrap_or_default();
    let shape = |entry: &Entry| match (&entry.value, entry.matrix(1 << 12)) {
        (Value::Scalar(_), _) => String::new(),
        (_, Ok(matrix)) => format!(" ({} x {})", matrix.rows, matrix.columns),
        _ => " (no matrix)".to_owned(),
    };
    let names: Vec<String> = entries.iter().take(MOST).map(|(name, entry)| format!("`{}`{}", shortened(name), shape(entry))).collect();
    let more = entries.len().checked_sub(MOST).filter(|more| *more > 0).map_or(String::new(), |more| format!(" and {more} more"));
    if names.is_empty() { "no names".to_owned() } else { names.join(", ") + &more }
}

fn none(root: &Entry, missing: &str, matrices: &[(&str, &Entry)], others: &[(&str, &Entry)]) -> CameraFileError {
    let others: Vec<_> = others.iter().copied().filter(|(_, entry)| is_distortion(entry)).collect();
    let names = |list: &[(&str, &Entry)], none: &str| match list {
        [] => none.to_owned(),
        _ => list.iter().map(|(name, _)| format!("`{}`", shortened(name))).collect::<Vec<_>>().join(", "),
    };
    root.wrong(&format!(
        "has no `{missing}`; matrices that may be a camera's are {}, coefficients {}: give those that belong together \
         these names, or names that differ in K and D alone, as K1 and D1; or say them: --matrix NAME --distortion NAME",
        names(matrices, "none"),
        names(&others, "none")
    ))
}
