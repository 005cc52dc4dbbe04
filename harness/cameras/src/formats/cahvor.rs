//! JPL's CAHV and CAHVOR: a camera as vectors in the world, in `.cahvor` files and in labels of PDS and VICAR.
//!
//! C is the centre, A the axis of the image plane, H and V make columns and rows of a point, O is the axis of the lens and R its polynomial. A lens whose axis is not that
//! of the image plane is one with a tilted sensor: OpenCV's model of 14 coefficients holds it.

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv, tool_conventions};
use calibench_model::convert::Target;
use calibench_model::named_camera::Pose;
use nalgebra::{Matrix3, Rotation3, Vector3};

use super::PLAIN;
use crate::brown::Brown;
use crate::format::{Keeps, KeptPose, Model};
use crate::number::{finite, pixels, shortened, shortest};
use crate::source::Source;
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "cahvor",
    tool: "JPL's CAHVOR: mrcal, VICAR, PDS labels",
    versions: ".cahvor; GEOMETRIC_CAMERA_MODEL of PDS3 and VICAR labels",
    extension: "cahvor",
    words: "Model CAHV CAHVOR Dimensions C A H V O R Hs Hc Vs Vc Theta MODEL_TYPE MODEL_COMPONENT_1 GEOMETRIC_CAMERA_MODEL",
    verified: Some("mrcal 2.2 reads what is written and pictures alike, to 1e-6 px, lenses with another axis than the image plane's too"),
    recognise,
    read,
    write: Some(write),
    convention: Some(&tool_conventions::CAHVOR),
    models: |_| {
        use calibench_model::camera::AgisoftVersion::Metashape;
        vec![Model { name: "CAHVOR", target: Target::Agisoft { version: Metashape, radial: 2, tangential: 0, affinity: true } }]
    },
    keeps: Keeps { pose: KeptPose::InWorld, ..PLAIN.keeps },
    ..PLAIN
};

/// The vectors in the order of the labels' components.
const VECTORS: [&str; 6] = ["C", "A", "H", "V", "O", "R"];
/// What follows from the vectors, and their covariance.
const BESIDE: [&str; 9] = ["Model", "Dimensions", "Hs", "Hc", "Vs", "Vc", "Theta", "S", "VALID_INTRINSICS_REGION"];
/// Below this, radians, the axes of lens and image plane are one, and H' and V' perpendicular.
const ROUNDING: f64 = 1e-13;
/// A skew that moves no pixel of the frame by more is one of rounded numbers, px.
const LEAST_SKEW: f64 = 1e-6;
/// One beside a lens with an axis of its own is left out, and said, if it moves none by more, px.
const MOST_SKEW: f64 = 0.01;

/// Line, name and value of a statement.
type Statement<'a> = (usize, &'a str, String);

/// `name = value`, over several lines where a parenthesis is open.
fn statements<'a>(source: &Source<'a>) -> Vec<Statement<'a>> {
    let mut found: Vec<Statement<'a>> = Vec::new();
    for (number, line) in source.lines().filter(|(_, line)| !line.starts_with('#')) {
        match found.last_mut() {
            Some((.., value)) if value.starts_with('(') && !value.contains(')') => {
                value.push(' ');
                value.push_str(line);
            }
            _ => {
                if let Some((name, value)) = line.split_once('=') {
                    found.push((number, name.trim(), value.trim().to_owned()));
                }
            }
        }
    }
    found
}

/// Whether a statement's name is that of a vector: its letter, or its number in a label.
fn is_vector(name: &str, index: usize) -> bool {
    name == VECTORS[index] || name.strip_prefix("MODEL_COMPONENT_").is_some_and(|number| number.parse() == Ok(index + 1))
}

/// The statement of a vector.
fn vector(all: &[Statement<'_>], index: usize) -> Result<Option<Vector3<f64>>, CameraFileError> {
    let mut found = all.iter().filter(|(_, name, _)| is_vector(name, index));
    let Some((line, name, value)) = found.next() else { return Ok(None) };
    let at = |error: CameraFileError| error.on_line(*line).of(*name);
    if let Some((second, ..)) = found.find(|(.., other)| other != value) {
        return Err(CameraFileError::new(format!("stands twice, first on line {line}")).on_line(*second).of(*name));
    }
    let words = value.trim_matches(['(', ')', ' ']).split([',', ' ', '\t']).filter(|word| !word.is_empty());
    let numbers: Vec<f64> = words.map(finite).collect::<Result<_, _>>().map_err(at)?;
    match numbers[..] {
        [x, y, z] => Ok(Some(Vector3::new(x, y, z))),
        _ => Err(at(CameraFileError::new(format!("expected 3 numbers, found {}", numbers.len())))),
    }
}

fn recognise(source: &Source<'_>) -> Result<(), String> {
    let all = if source.xml.is_none() { statements(source) } else { Vec::new() };
    let has = |name: &str| all.iter().any(|(_, found, _)| *found == name);
    if ["C", "A", "H", "V"].iter().all(|name| has(name)) || (1..=4).all(|i| has(&format!("MODEL_COMPONENT_{i}"))) {
        return Ok(());
    }
    Err("no `C = `, `A = `, `H = `, `V = `, nor `MODEL_COMPONENT_1 = ` to 4".into())
}

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let all = statements(source);
    let text = |name: &str| all.iter().find(|(_, found, _)| *found == name).map(|(line, _, value)| (*line, value.as_str()));
    if let Some((line, kind)) = text("MODEL_TYPE").or_else(|| text("Model")) {
        let kind = kind.split(['=', ' ', ',']).next().unwrap_or("").trim_matches('"');
        if !["CAHV", "CAHVOR", ""].contains(&kind) {
            let problem = format!("`{}` is no camera model here; expected CAHV or CAHVOR", shortened(kind));
            return Err(CameraFileError::new(problem).on_line(line).of("Model"));
        }
    }
    let stated = text("Dimensions").map(|(line, sides)| {
        let at = |error: CameraFileError| error.on_line(line).of("Dimensions");
        match sides.split_whitespace().collect::<Vec<_>>()[..] {
            [width, height] => Ok(ImageSize { width: pixels(width).map_err(at)?, height: pixels(height).map_err(at)? }),
            _ => Err(at(CameraFileError::new("expected columns and rows"))),
        }
    });
    let size = options.size_or(stated.transpose()?)?;
    // mrcal writes its own lenses beside the vectors.
    if let Some((line, name, _)) =
        all.iter().find(|(_, name, _)| name.starts_with("LENSMODEL") || name.starts_with("DISTORTION") || *name == "E")
    {
        return Err(CameraFileError::new("is no part of CAHVOR; expected C, A, H, V, O, R").on_line(*line).of(*name));
    }
    let one = |index: usize| vector(&all, index)?.ok_or_else(|| CameraFileError::new("missing").of(VECTORS[index]));
    let (c, a, h, v) = (one(0)?, one(1)?, one(2)?, one(3)?);
    let (o, r) = (vector(&all, 4)?.unwrap_or(a), vector(&all, 5)?.unwrap_or_default());
    let placed = |error: CameraFileError| {
        let index = VECTORS.iter().position(|name| error.element.as_deref() == Some(name));
        let line = index.and_then(|index| all.iter().find(|(_, name, _)| is_vector(name, index))).or(all.first());
        error.on_line(line.map_or(1, |(line, ..)| *line))
    };
    let (camera, rotation, note) = camera(size, [a, h, v, o], [r.x, r.y, r.z]).map_err(placed)?;
    let mut notes = Vec::new();
    if text("C").is_some() {
        // A label has many other things.
        let unknown = all.iter().filter(|(_, name, _)| !VECTORS.contains(name) && !BESIDE.contains(name));
        notes = options.of_file(unknown.map(|(line, name, _)| (*name, *line)), |line, error| error.on_line(line))?;
    }
    notes.extend(note);
    let pose = Pose { camera_from_world: std::array::from_fn(|i| std::array::from_fn(|j| rotation[(i, j)])), position: [c.x, c.y, c.z] };
    Ok(vec![NamedCamera { pose: Some(pose), notes, ..NamedCamera::new("", camera) }])
}

/// The camera in the axes of its lens, the rotation to them, and what was left out.
fn camera(
    size: ImageSize,
    [a, h, v, o]: [Vector3<f64>; 4],
    [r0, r1, r2]: [f64; 3],
) -> Result<(Camera, Matrix3<f64>, Option<String>), CameraFileError> {
    let scale = 1.0 + r0;
    let (Some(axis), true) = (o.try_normalize(1e-9), scale > 0.0) else {
        return Err(CameraFileError::new("expected an axis O and a factor 1 + R[0] above zero").of("O"));
    };
    let Some(right) = (h - axis * h.dot(&axis)).try_normalize(1e-9) else {
        return Err(CameraFileError::new("lies along the axis of the lens: no pixel has a ray").of("H"));
    };
    let frame = Matrix3::from_rows(&[right.transpose(), axis.cross(&right).transpose(), axis.transpose()]);
    // From the distorted direction before the lens to columns and rows.
    let to_image = Matrix3::from_rows(&[h.transpose(), v.transpose(), a.transpose()])
        * frame.transpose()
        * Matrix3::from_diagonal(&Vector3::new(scale, scale, 1.0));
    let n = to_image / to_image.row(2).norm();
    if !(n[(2, 2)] > 1e-6 && n.iter().all(|value| value.is_finite())) {
        return Err(CameraFileError::new("looks away from the axis of the lens, O").of("A"));
    }
    let (cx, cy) = (n[(0, 2)] / n[(2, 2)], n[(1, 2)] / n[(2, 2)]);
    let flat = |row: usize, centre: f64| [n[(row, 0)] - centre * n[(2, 0)], n[(row, 1)] - centre * n[(2, 1)]];
    let (first, second) = (flat(0, cx), flat(1, cy));
    // OpenCV's tilt leaves the first row along x: the lens, which is round, is turned so.
    let phi = (-first[1]).atan2(first[0]);
    let (sin, cos) = phi.sin_cos();
    let turned = |[x, y]: [f64; 2]| [x * cos - y * sin, x * sin + y * cos];
    let ([along, _], [shear, down], [p, q]) = (turned(first), turned(second), turned([n[(2, 0)], n[(2, 1)]]));
    let ty = p.asin();
    let tx = (-q / ty.cos()).clamp(-1.0, 1.0).asin();
    let (tx, ty) = if tx.hypot(ty) < ROUNDING { (0.0, 0.0) } else { (tx, ty) };
    let (fx, fy) = (along / tx.cos(), down / ty.cos());
    if !(fx > 0.0 && fy > 0.0) {
        return Err(CameraFileError::new("makes the image a mirror image: columns run right and rows down").of("V"));
    }
    let rotation = Rotation3::from_axis_angle(&Vector3::z_axis(), phi).matrix() * frame;
    // What is left of the second row is a skew: of rounded numbers, or of a sensor that no tilt explains.
    let skew = shear + fy * tx.sin() * ty.sin();
    let moves = skew.abs() * f64::from(size.width.max(size.height)) / fx;
    let [k1, k2] = [r1 / scale, r2 / scale];
    let plain = Brown { k: [k1, k2, 0.0, 0.0], ..Brown::plain(size, [fx, fy, cx, cy]) };
    let tilted = || {
        let mut distortion = [0.0; 14];
        [distortion[0], distortion[1], distortion[12], distortion[13]] = [k1, k2, tx, ty];
        Camera::from(OpenCv { size, fx, fy, cx, cy, distortion, coefficients: 14 })
    };
    let mut note = None;
    let camera = match (moves > LEAST_SKEW, tx == 0.0 && ty == 0.0) {
        (false, true) => plain.camera(),
        (false, false) => tilted(),
        (true, true) => {
            let (camera, rotation) = skewed(plain, skew, rotation);
            return Ok((camera, rotation, None));
        }
        (true, false) if moves > MOST_SKEW => {
            let problem = format!(
                "is not perpendicular to V, by up to {moves:.2} px in the frame, and the lens has an axis of its own: no model here holds both"
            );
            return Err(CameraFileError::new(problem).of("H"));
        }
        (true, false) => {
            note = Some(format!(
                "columns and rows, which R[0] shears before a tilted sensor, are taken to be perpendicular: up to {moves:.1e} px off"
            ));
            tilted()
        }
    };
    Ok((camera, rotation, note))
}

/// A skew that stands in the first row, where Metashape has it: the lens is turned until the second row has none.
fn skewed(plain: Brown, shear: f64, rotation: Matrix3<f64>) -> (Camera, Matrix3<f64>) {
    let psi = shear.atan2(plain.fy);
    let (sin, cos) = psi.sin_cos();
    // [fx 0; shear fy] times a rotation is [fx' skew; 0 fy'].
    let (fx, skew, fy) = (plain.fx * cos, plain.fx * sin, shear.hypot(plain.fy));
    let rotation = Rotation3::from_axis_angle(&Vector3::z_axis(), psi).matrix() * rotation;
    (Brown { fx, fy, skew, ..plain }.camera(), rotation)
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let (named, camera) = (&cameras[0], &cameras[0].camera);
    let other = || FORMAT.other_model("a camera of k1 and k2 alone, with a shear or a tilted sensor");
    let (k, [tx, ty], [fx, fy, skew, cx, cy]) = match *camera {
        Camera::OpenCv(OpenCv { fx, fy, cx, cy, distortion: [k1, k2, rest @ .., tx, ty], .. }) if rest == [0.0; 10] => {
            ([k1, k2], [tx, ty], [fx, fy, 0.0, cx, cy])
        }
        _ => {
            let brown = Brown::of(camera).filter(|brown| brown.radial() <= 2 && !brown.has_tangential()).ok_or_else(other)?;
            ([brown.k[0], brown.k[1]], [0.0; 2], [brown.fx, brown.fy, brown.skew, brown.cx, brown.cy])
        }
    };
    let about = |axis, angle: f64| Rotation3::from_axis_angle(&axis, -angle).into_inner();
    let tilt = about(Vector3::y_axis(), ty) * about(Vector3::x_axis(), tx);
    let plane = Matrix3::new(tilt[(2, 2)], 0.0, -tilt[(0, 2)], 0.0, tilt[(2, 2)], -tilt[(1, 2)], 0.0, 0.0, 1.0);
    let matrix = Matrix3::new(fx, skew, cx, 0.0, fy, cy, 0.0, 0.0, 1.0);
    let pose = named.pose.unwrap_or(Pose::IDENTITY);
    let rotation = Matrix3::from_fn(|i, j| pose.camera_from_world[i][j]);
    let rows = matrix * plane * tilt * rotation;
    let line = |name: &str, [x, y, z]: [f64; 3]| format!("{name} = {} {} {}\n", shortest(x), shortest(y), shortest(z));
    let row = |index: usize| [0, 1, 2].map(|j| rows[(index, j)]);
    let ImageSize { width, height } = camera.size();
    let vectors = [
        ("C", pose.position),
        ("A", row(2)),
        ("H", row(0)),
        ("V", row(1)),
        ("O", [0, 1, 2].map(|j| rotation[(2, j)])),
        ("R", [0.0, k[0], k[1]]),
    ];
    let lines: String = vectors.iter().map(|(name, vector)| line(name, *vector)).collect();
    Ok(format!("Model = CAHVOR = perspective, distortion\nDimensions = {width} {height}\n{lines}"))
}
