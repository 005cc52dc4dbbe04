//! OCamCalib's calib_results.txt: a polynomial of the distance from the centre, another one back, centre, three affine numbers.

use calibench_model::NamedCamera;
use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, ImageSize, Ocam, ocam};
use calibench_model::convert::Target;
use nalgebra::{DMatrix, DVector};

use super::PLAIN;
use crate::format::Model;
use crate::number::{finite, pixels, row, scientific, shortest};
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "ocam",
    tool: "OCamCalib",
    versions: "calib_results.txt of version 3",
    extension: "txt",
    words: "polynomial coefficients DIRECT inverse mapping function ocam_model ss invpol cam2world world2cam center row column affine parameters",
    recognise,
    read,
    write: Some(write),
    convention: Some(&ocam::CONVENTION),
    models: |_| {
        vec![Model { name: "degree 4", target: Target::Ocam { degree: 4 } }, Model { name: "degree 6", target: Target::Ocam { degree: 6 } }]
    },
    ..PLAIN
};

/// Comments of the toolbox, in the order of its file.
const SECTIONS: [&str; 5] = [
    "polynomial coefficients for the DIRECT mapping function (ocam_model.ss in MATLAB). These are used by cam2world",
    "polynomial coefficients for the inverse mapping function (ocam_model.invpol in MATLAB). These are used by world2cam",
    "center: \"row\" and \"column\", starting from 0 (C convention)",
    "affine parameters \"c\", \"d\", \"e\"",
    "image size: \"height\" and \"width\"",
];
/// Names of the five lines, for errors.
const NAMES: [&str; 5] = ["ss", "invpol", "center", "affine parameters", "image size"];
/// Degree of the polynomial back, and places from which it is made.
const BACK: usize = 15;
const PLACES: usize = 200;
/// Largest difference of the two polynomials that passes without a word, px.
const AGREE: f64 = 0.1;

fn recognise(source: &Source<'_>) -> Result<(), String> {
    let has = |word: &str| source.text.lines().any(|line| line.starts_with('#') && line.contains(word));
    let found = source.xml.is_none() && (has("ocam_model") || (has("cam2world") && has("world2cam")));
    if found { Ok(()) } else { Err("no `#polynomial coefficients ... ocam_model`".into()) }
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let mut lines = source.lines().filter(|(_, line)| !line.starts_with('#'));
    let mut next = |name: &'static str| -> Result<(usize, Vec<f64>), CameraFileError> {
        let (line, text) = lines
            .next()
            .ok_or_else(|| CameraFileError::new("missing: the file ends before it").on_line(source.text.lines().count()).of(name))?;
        let found = text.split_whitespace().map(finite).collect::<Result<_, _>>();
        found.map(|values| (line, values)).map_err(|error| error.on_line(line).of(name))
    };
    let ((line, direct), (back_line, back)) = (next(NAMES[0])?, next(NAMES[1])?);
    let a = counted(&direct).and_then(coefficients).map_err(|error| error.on_line(line).of(NAMES[0]))?;
    let back = counted(&back).map_err(|error| error.on_line(back_line).of(NAMES[1]))?;
    let mut fixed = |name: &'static str, count: usize| {
        let (line, values) = next(name)?;
        let wrong = || CameraFileError::new(format!("expected {count} numbers, found {}", values.len())).on_line(line).of(name);
        if values.len() == count { Ok((line, values)) } else { Err(wrong()) }
    };
    let ((_, centre), (affine_line, affine), (size_line, sides)) = (fixed(NAMES[2], 2)?, fixed(NAMES[3], 3)?, fixed(NAMES[4], 2)?);
    let side = |index: usize| pixels(&sides[index].to_string()).map_err(|error| error.on_line(size_line).of(NAMES[4]));
    let size =
        options.size_or(Some(ImageSize { width: side(1)?, height: side(0)? })).map_err(|error| error.on_line(size_line).of(NAMES[4]))?;
    let [c, d, e] = [affine[0], affine[1], affine[2]];
    if !(c > 0.0 && c - d * e > 0.0) {
        return Err(CameraFileError::new("expected c above zero and above d e").on_line(affine_line).of(NAMES[3]));
    }
    let camera = Ocam { size, cx: centre[1], cy: centre[0], c, d, e, a };
    let notes = apart(&camera, back).filter(|(off, _)| *off > AGREE).map(|(off, at)| {
        format!("the polynomial back, which world2cam takes, is up to {off:.2} px off, at ({:.0}, {:.0}): the direct one is taken, and inverted exactly", at.x, at.y)
    });
    Ok(vec![NamedCamera { notes: notes.into_iter().collect(), ..NamedCamera::new("", camera.into()) }])
}

/// The numbers after their count.
fn counted(values: &[f64]) -> Result<&[f64], CameraFileError> {
    let wrong = || CameraFileError::new(format!("expected the number of coefficients and as many, found {} numbers", values.len()));
    let (count, rest) = values.split_first().ok_or_else(wrong)?;
    if *count == rest.len() as f64 && !rest.is_empty() { Ok(rest) } else { Err(wrong()) }
}

fn coefficients(found: &[f64]) -> Result<[f64; 7], CameraFileError> {
    let mut a = [0.0; 7];
    if found.len() > a.len() {
        return Err(CameraFileError::new(format!("has {} coefficients; expected at most {}, degree 6", found.len(), a.len())));
    }
    a[..found.len()].copy_from_slice(found);
    if a[0] < 0.0 {
        Ok(a)
    } else {
        Err(CameraFileError::new(format!("begins with {}; expected a number below zero: the camera looks along -z", a[0])))
    }
}

/// Corners of the frame and the middles of its sides: how far `back` leads from the farthest off of those that have a ray, px, and which it is.
fn apart(camera: &Ocam, back: &[f64]) -> Option<(f64, PixelPoint)> {
    let ImageSize { width, height } = camera.size;
    let [right, down] = [width, height].map(|side| f64::from(side - 1));
    let at = [0.0, 0.25, 0.5, 0.75, 1.0];
    let places = at.into_iter().flat_map(|x| at.map(|y| PixelPoint::new(x * right, y * down)));
    let off = |at: PixelPoint| {
        let ray = camera.unproject(at).ok()?;
        let norm = ray.x.hypot(ray.y);
        let theta = (ray.z / norm).atan();
        let rho = back.iter().rev().fold(0.0, |sum, b| sum * theta + b);
        let [x, y] = [rho * ray.x / norm, -rho * ray.y / norm];
        let there = PixelPoint::new(camera.cx + x + camera.e * y, camera.cy + camera.d * x + camera.c * y);
        (norm > 0.0).then(|| (there.distance(at), at))
    };
    places.filter_map(off).max_by(|a, b| a.0.total_cmp(&b.0))
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let Camera::Ocam(camera) = cameras[0].camera else { return Err(FORMAT.other_model("a camera of OCamCalib's polynomial")) };
    let Ocam { size, cx, cy, c, d, e, a } = camera;
    let last = a.iter().rposition(|&value| value != 0.0).map_or(5, |last| last.max(4) + 1);
    let spaced = |values: &[f64]| values.iter().map(|&value| scientific(value)).collect::<Vec<_>>().join(" ");
    let back = back(&camera)?;
    let lines = [
        format!("{last} {}", spaced(&a[..last])),
        format!("{} {}", back.len(), spaced(&back)),
        format!("{} {}", shortest(cy), shortest(cx)),
        row(&[c, d, e]).replace(',', ""),
        format!("{} {}", size.height, size.width),
    ];
    Ok(SECTIONS.iter().zip(lines).map(|(section, line)| format!("#{section}\n\n{line}\n\n")).collect())
}

/// The polynomial back, of the angle `atan(z / norm)`, by least squares over what the frame shows.
fn back(camera: &Ocam) -> Result<Vec<f64>, CameraFileError> {
    let ImageSize { width, height } = camera.size;
    let corners =
        [(0, 0), (width - 1, 0), (0, height - 1), (width - 1, height - 1)].map(|(x, y)| PixelPoint::new(f64::from(x), f64::from(y)));
    let round = Ocam { c: 1.0, d: 0.0, e: 0.0, ..*camera };
    let farthest =
        corners.iter().map(|at| at.distance(PixelPoint::new(camera.cx, camera.cy))).fold(0.0, f64::max) * camera.c.max(1.0 / camera.c);
    let places: Vec<(f64, f64)> = (1..=PLACES)
        .filter_map(|i| {
            let rho = farthest * i as f64 / PLACES as f64;
            let ray = round.unproject(PixelPoint::new(round.cx + rho, round.cy)).ok()?;
            Some(((ray.z / ray.x).atan(), rho))
        })
        .collect();
    // Powers of an angle that runs from -1 to 1 are told apart; those of the angle itself follow.
    let theta = |index: usize| places.get(index).map_or(0.0, |place| place.0);
    let (low, high) = (-std::f64::consts::FRAC_PI_2, theta(places.len().saturating_sub(1)));
    let (middle, half) = (f64::midpoint(low, high), 0.5 * (high - low));
    let n = (BACK + 1).min(places.len());
    let design = DMatrix::from_fn(places.len(), n, |i, j| ((places[i].0 - middle) / half).powi(j as i32));
    let right = DVector::from_iterator(places.len(), places.iter().map(|place| place.1));
    let found =
        design.svd(true, true).solve(&right, 1e-14).map_err(|_| CameraFileError::new("has no polynomial back: no pixel has a ray"))?;
    let mut back = vec![0.0; n];
    // (theta - middle) / half as a polynomial, by Horner's scheme.
    for b in found.iter().rev() {
        let mut next = vec![0.0; n];
        for (power, value) in back.iter().enumerate() {
            next[power] -= value * middle / half;
            if power + 1 < n {
                next[power + 1] += value / half;
            }
        }
        next[0] += b;
        back = next;
    }
    Ok(back)
}
