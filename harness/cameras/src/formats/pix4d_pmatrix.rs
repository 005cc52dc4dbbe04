//! Pix4D's pmatrix.txt: a 3 x 4 projection matrix for each image, without distortion; and its offset.xyz.

use std::path::Path;

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, Pix4d, TangentialOrder};
use calibench_model::named_camera::Pose;

use super::PLAIN;
use crate::number::numbers;
use crate::source::{self, Source};
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "pix4d-pmatrix",
    tool: "Pix4D",
    versions: "pmatrix.txt",
    extension: "txt",
    verified: Some("decomposed, they give the camera matrix, position and rotation that Pix4D wrote, to what six decimals allow"),
    many: true,
    states_size: false,
    recognise,
    read,
    write: None,
    ..PLAIN
};

/// How far the length of a rotation's row may be from one: Pix4D prints six decimals.
const UNIT: f64 = 1e-5;

fn recognise(source: &Source<'_>) -> Result<(), String> {
    let (_, first) = source.lines().next().unwrap_or_default();
    let matrix = row(first).map_err(|_| "the first line is not a name and 12 numbers".to_owned())?.matrix;
    // Twelve numbers after some words have others, too; the third row of K R is that of R.
    let length = norm([matrix[2][0], matrix[2][1], matrix[2][2]]);
    if (length - 1.0).abs() <= UNIT { Ok(()) } else { Err("the matrix of the first line has no rotation in its third row".into()) }
}

/// A projection matrix: homogeneous px, from the outer corner of the first pixel and without distortion, of a homogeneous world point.
#[derive(Clone, Debug, PartialEq)]
pub struct PMatrix {
    /// The image.
    pub name: String,
    /// 3 x 4, row by row.
    pub matrix: [[f64; 4]; 3],
}

impl PMatrix {
    /// `K [R, -R t]` of the camera matrix `k`, 3 x 3, row by row, px from the outer corner of the first pixel, and R and t of `pose`.
    pub fn new(name: impl Into<String>, k: &[[f64; 3]; 3], pose: &Pose) -> Self {
        let r = &pose.camera_from_world;
        let kr: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|m| k[i][m] * r[m][j]).sum()));
        let matrix = std::array::from_fn(|i| {
            let t = -(0..3).map(|j| kr[i][j] * pose.position[j]).sum::<f64>();
            [kr[i][0], kr[i][1], kr[i][2], t]
        });
        Self { name: name.into(), matrix }
    }

    /// The camera matrix (px, row by row), with 1 at its lower right, and the pose: RQ decomposition of the left 3 x 3. `None` if it is singular.
    pub fn decompose(&self) -> Option<([[f64; 3]; 3], Pose)> {
        let m: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| self.matrix[i][j]));
        let scale = norm(m[2]);
        // Rows from below: each new row of R is orthogonal to those below it.
        let r3 = m[2].map(|v| v / scale);
        let cy = dot(m[1], r3);
        let (fy, r2) = unit(without(m[1], cy, r3))?;
        let (cx, s) = (dot(m[0], r3), dot(m[0], r2));
        let (fx, r1) = unit(without(without(m[0], cx, r3), s, r2))?;
        let k = [[fx, s, cx], [0.0, fy, cy], [0.0, 0.0, scale]].map(|row| row.map(|v| v / scale));
        let camera_from_world = [r1, r2, r3];
        // K R t = -last column, solved from below.
        let last = self.matrix.map(|row| -row[3] / scale);
        let z = last[2];
        let y = (last[1] - k[1][2] * z) / k[1][1];
        let x = (last[0] - k[0][1] * y - k[0][2] * z) / k[0][0];
        let position = std::array::from_fn(|j| x * r1[j] + y * r2[j] + z * r3[j]);
        let finite = k.as_flattened().iter().chain(&position).all(|v: &f64| v.is_finite());
        finite.then_some((k, Pose { camera_from_world, position }))
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// `a - share * b`.
fn without(a: [f64; 3], share: f64, b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - share * b[i])
}

/// Length and direction.
fn unit(a: [f64; 3]) -> Option<(f64, [f64; 3])> {
    let length = norm(a);
    (length > 0.0 && length.is_finite()).then(|| (length, a.map(|v| v / length)))
}

fn row(line: &str) -> Result<PMatrix, CameraFileError> {
    // A name may hold spaces: the numbers are the last twelve words.
    let words: Vec<&str> = line.split_whitespace().collect();
    let split = words.len().checked_sub(12).filter(|&names| names > 0);
    let split = split.ok_or_else(|| CameraFileError::new(format!("expected a name and 12 numbers, found {} words", words.len())))?;
    let p: [f64; 12] = numbers(&words[split..].join(" "))?;
    Ok(PMatrix { name: words[..split].join(" "), matrix: std::array::from_fn(|i| std::array::from_fn(|j| p[4 * i + j])) })
}

/// Reads the projection matrices of a pmatrix.txt.
///
/// # Errors
/// The first line that is not a name and 12 finite numbers.
pub fn read_pmatrices(path: &Path) -> Result<Vec<PMatrix>, CameraFileError> {
    let file = path.display().to_string();
    let read = || {
        let bytes = source::read(path)?;
        rows(&Source::new(&bytes)?)
    };
    read().map_err(|error| error.in_file(&file))
}

fn rows(source: &Source<'_>) -> Result<Vec<PMatrix>, CameraFileError> {
    source.lines().map(|(line, text)| row(text).map_err(|error| error.on_line(line))).collect()
}

/// The text of a pmatrix.txt, with Pix4D's six decimals.
pub fn pmatrix_text(matrices: &[PMatrix]) -> String {
    let row = |p: &PMatrix| p.matrix.as_flattened().iter().map(|value| format!("{value:.6} ")).collect::<String>();
    matrices.iter().map(|p| format!("{} {}\n", p.name, row(p))).collect()
}

/// Reads an offset.xyz: what Pix4D subtracted from the world's coordinates, in their unit.
///
/// # Errors
/// A file that does not hold three finite numbers.
pub fn read_offset(path: &Path) -> Result<[f64; 3], CameraFileError> {
    let read = || {
        let bytes = source::read(path)?;
        numbers(Source::new(&bytes)?.text)
    };
    read().map_err(|error| error.in_file(&path.display().to_string()))
}

/// Cameras without distortion. The mean of both focal lengths is taken; the six decimals of the file let them differ.
fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let size = options.size_or(None)?;
    rows(source)?
        .into_iter()
        .map(|p| {
            let singular = || CameraFileError::new("its left 3 x 3 is singular: no camera").of(&p.name);
            let (k, pose) = p.decompose().ok_or_else(singular)?;
            let camera = Pix4d {
                size,
                sensor_width_mm: 0.0,
                f_px: (k[0][0] + k[1][1]) / 2.0,
                px: k[0][2],
                py: k[1][2],
                r: [0.0; 3],
                t: [0.0; 2],
                order: TangentialOrder::OpenCv,
            };
            let notes = vec!["a P-matrix says nothing of the distortion: it is zero here, not in the camera".to_owned()];
            Ok(NamedCamera { pose: Some(pose), notes, ..NamedCamera::new(&p.name, Camera::Pix4d(camera)) })
        })
        .collect()
}
