//! Programs of others.

use calibench_model::camera::{CameraModel, ImageSize, Ray};
use calibench_model::{Covariance, NamedCamera, escape};
use calibench_plugins::{CalibratorProgram, Unanswered};
use nalgebra::{DMatrix, Point3, Vector3};
use serde::Deserialize;

use crate::answer::{Lens, Precision, Scaled};
use crate::{Answer, Calibrated, Calibrator, Listed, Status, Task};

/// Messages that are kept of an answer.
const MOST_MESSAGES: usize = 8;
/// Characters that are kept of each.
const LONGEST_MESSAGE: usize = 300;
/// How far a covariance may be from a symmetric one, as a correlation: digits that were written.
const ASYMMETRY: f64 = 1e-3;
/// Reads the text of a camera file of images of this size; why it cannot be read, in words.
pub type ReadCamera = fn(&str, ImageSize) -> Result<NamedCamera, String>;

/// Declared calibrators, as ours are listed; `read_camera` reads what they answer.
pub fn programs(declared: Vec<CalibratorProgram>, read_camera: ReadCamera) -> Vec<Listed> {
    let listed = |program: CalibratorProgram| {
        let declaration = &program.declaration;
        Listed {
            name: declaration.program.name.clone(),
            system: declaration.system.clone(),
            about: declaration.program.about.clone(),
            source: declaration.program.source.clone(),
            identity: format!("{} {}", declaration.program.command.join(" "), program.files()),
            models: declaration.models.clone(),
            start: declaration.start,
            calibrator: Box::new(Program { program, read_camera }),
        }
    };
    declared.into_iter().map(listed).collect()
}

struct Program {
    program: CalibratorProgram,
    read_camera: ReadCamera,
}

impl Calibrator for Program {
    fn version(&self) -> Result<String, String> {
        self.program.version()
    }

    fn calibrate(&self, task: &Task) -> Result<Calibrated, String> {
        let task = &Task { seconds: self.program.declaration.program.seconds, ..task.clone() };
        match self.program.ask(|number| task.request(number)) {
            Ok((number, said)) => {
                let answer = Answer::read(&said.line, number, task, self.read_camera);
                Ok(Calibrated { answer, seconds: said.seconds, peak_mb: said.peak_mb })
            }
            Err(Unanswered::Unavailable(why)) => Err(why),
            Err(Unanswered::Failed(why)) => {
                Ok(Calibrated { answer: Answer::without(Status::Failed, why), seconds: f64::NAN, peak_mb: None })
            }
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Wire {
    task: u64,
    status: String,
    #[serde(default)]
    messages: Vec<String>,
    camera: Option<String>,
    rays: Option<Vec<Option<[f64; 3]>>>,
    covariance: Option<CovarianceWire>,
    sigmas: Option<std::collections::BTreeMap<String, f64>>,
    uncertainty: Option<Vec<Option<[f64; 3]>>>,
    scaled: Option<String>,
    rms_px: Option<f64>,
    iterations: Option<u64>,
    #[serde(default)]
    #[expect(dead_code, reason = "a part of the protocol that nothing is made of yet")]
    poses: std::collections::BTreeMap<String, [f64; 12]>,
    #[serde(default)]
    board_shape: Vec<[f64; 3]>,
    #[serde(default)]
    outliers: Vec<[usize; 2]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CovarianceWire {
    names: Vec<String>,
    matrix: Vec<Vec<f64>>,
}

impl Answer {
    /// That of a line of the protocol to question `number` about `task`: one that cannot be read has [`Status::Failed`], with the reason.
    pub fn read(line: &str, number: u64, task: &Task, read_camera: ReadCamera) -> Self {
        read(line, number, task, read_camera).unwrap_or_else(|why| Self::without(Status::Failed, format!("malformed: {why}")))
    }
}

/// Reads the answer to question `number` about `task`.
fn read(line: &str, number: u64, task: &Task, read_camera: ReadCamera) -> Result<Answer, String> {
    let wire: Wire = serde_json::from_str(line).map_err(|error| {
        let start: String = line.chars().take(80).collect();
        format!("expected a line of JSON as {{\"task\": 1, \"status\": \"calibrated\", ...}}, found `{start}`: {error}")
    })?;
    if wire.task != number {
        return Err("`task` must be that of the request, found another".to_owned());
    }
    let known = || Status::ALL.map(|(_, name)| name).join(", ");
    let status = Status::named(&wire.status).ok_or_else(|| format!("`status` is `{}`: expected one of {}", wire.status, known()))?;
    let lens = lens(&wire, task, read_camera)?;
    if lens.is_none() && matches!(status, Status::Calibrated | Status::Doubtful) {
        return Err(format!("`status` is `{}` and there is neither `camera` nor `rays`", wire.status));
    }
    let outside = |[image, point]: &&[usize; 2]| task.images.get(*image).is_none_or(|image| *point >= image.points.len());
    if let Some([image, point]) = wire.outliers.iter().find(outside) {
        return Err(format!("`outliers` has [{image}, {point}], of which there is none: expected places in `images` and in their points"));
    }
    let message = |text: &String| escape::name(text.trim()).chars().take(LONGEST_MESSAGE).collect();
    Ok(Answer {
        status,
        messages: wire.messages.iter().take(MOST_MESSAGES).map(message).collect(),
        precision: precision(&wire, lens.as_ref(), task)?,
        lens,
        rms_px: wire.rms_px,
        iterations: wire.iterations,
        shape: wire.board_shape.iter().map(|at| Point3::from(*at)).collect(),
        outliers: wire.outliers.iter().map(|[image, point]| (*image, *point)).collect(),
    })
}

fn lens(wire: &Wire, task: &Task, read_camera: ReadCamera) -> Result<Option<Lens>, String> {
    match (&wire.camera, &wire.rays) {
        (Some(_), Some(_)) => Err("`camera` and `rays`: expected one of them".to_owned()),
        (Some(text), None) => {
            let camera = read_camera(text, task.size)?;
            if camera.camera.size() != task.size {
                let size = camera.camera.size();
                return Err(format!("`camera` is of {} x {} px: expected that of the request", size.width, size.height));
            }
            Ok(Some(Lens::Camera(Box::new(camera))))
        }
        (None, Some(rays)) => {
            as_the_grid("rays", rays.len(), task)?;
            let ray = |ray: &Option<[f64; 3]>| {
                let ray = Vector3::from((*ray)?);
                let norm = ray.norm();
                (norm.is_finite() && norm > 0.0).then(|| Ray { x: ray.x / norm, y: -ray.y / norm, z: -ray.z / norm })
            };
            Ok(Some(Lens::Rays(rays.iter().map(ray).collect())))
        }
        (None, None) => Ok(None),
    }
}

fn as_the_grid(what: &str, found: usize, task: &Task) -> Result<(), String> {
    let expected = task.grid.len();
    if found == expected { Ok(()) } else { Err(format!("`{what}` has {found} entries, `grid` has {expected}: expected one for each")) }
}

fn precision(wire: &Wire, lens: Option<&Lens>, task: &Task) -> Result<Precision, String> {
    let own = |name: &String| match lens {
        Some(Lens::Camera(named)) => named.camera.parameters().iter().any(|parameter| parameter.name == *name),
        Some(Lens::Rays(_)) | None => false,
    };
    let unknown = |what: &str, name: &String| format!("`{what}` names `{name}`, which the camera does not have");
    let covariance = match &wire.covariance {
        None => None,
        Some(CovarianceWire { names, matrix }) => {
            if let Some(name) = names.iter().find(|name| !own(name)) {
                return Err(unknown("covariance", name));
            }
            let n = names.len();
            if matrix.len() != n || matrix.iter().any(|row| row.len() != n) {
                return Err(format!("`covariance` has {n} names: expected a matrix of {n} x {n}"));
            }
            let matrix = DMatrix::from_fn(n, n, |row, column| matrix[row][column]);
            let allowed = |row: usize, column: usize| ASYMMETRY * (matrix[(row, row)] * matrix[(column, column)]).sqrt();
            if let Some(name) = names.iter().enumerate().find_map(|(i, name)| (matrix[(i, i)] < 0.0).then_some(name)) {
                return Err(format!("`covariance` has a negative variance of `{name}`"));
            }
            if (0..n).any(|row| (0..row).any(|column| (matrix[(row, column)] - matrix[(column, row)]).abs() > allowed(row, column))) {
                return Err("`covariance` is not symmetric".to_owned());
            }
            Some((names.clone(), matrix))
        }
    };
    let sigmas: Vec<(String, f64)> = wire.sigmas.iter().flatten().map(|(name, sigma)| (name.clone(), *sigma)).collect();
    if let Some((name, _)) = sigmas.iter().find(|(name, _)| !own(name)) {
        return Err(unknown("sigmas", name));
    }
    let at_grid = wire.uncertainty.as_deref().unwrap_or_default();
    if wire.uncertainty.is_some() {
        as_the_grid("uncertainty", at_grid.len(), task)?;
    }
    let at = |own: &Option<[f64; 3]>| own.map(|[sxx, sxy, syy]| Covariance { sxx, sxy, syy }).filter(Covariance::is_valid);
    let scaled = wire
        .scaled
        .as_ref()
        .map(|word| Scaled::named(word).ok_or_else(|| format!("`scaled` is `{word}`: expected unit, stated or sigma0")));
    Ok(Precision { covariance, sigmas, at_grid: at_grid.iter().map(at).collect(), scaled: scaled.transpose()? })
}

#[cfg(test)]
mod tests {
    use calibench_model::PixelPoint;
    use calibench_model::camera::OpenCv;

    use super::*;
    use crate::TaskImage;

    const SIZE: ImageSize = ImageSize { width: 64, height: 48 };

    fn task() -> Task {
        let at = PixelPoint::new(3.0, 4.0);
        Task {
            model: "opencv4".into(),
            size: SIZE,
            sigma_px: None,
            unit: "mm".into(),
            board: None,
            points: vec![("a".into(), Point3::origin())],
            points_sigma: 0.0,
            images: vec![TaskImage { name: "one".into(), points: vec![(0, at)] }],
            start: None,
            grid: vec![at, at],
            seconds: 1.0,
        }
    }

    /// A camera of the width that the text says.
    fn width(text: &str, size: ImageSize) -> Result<NamedCamera, String> {
        let width = text.parse().map_err(|_| "no camera".to_owned())?;
        let size = ImageSize { width, ..size };
        Ok(NamedCamera::new("c", OpenCv { size, fx: 50.0, fy: 50.0, cx: 31.5, cy: 23.5, distortion: [0.0; 14], coefficients: 4 }.into()))
    }

    fn said(rest: &str) -> Result<Answer, String> {
        read(&format!("{{\"task\": 7, {rest}}}"), 7, &task(), width)
    }

    #[test]
    fn an_answer_is_read_with_all_that_it_says() {
        let answer = said(
            r#""status": "doubtful", "camera": "64", "messages": [" bent "], "covariance": {"names": ["fx"], "matrix": [[0.25]]},
            "scaled": "sigma0", "outliers": [[0, 0]], "rms_px": 0.5, "iterations": 9, "board_shape": [[1, 2, 3]]"#,
        )
        .unwrap();
        assert_eq!((answer.status, answer.messages, answer.outliers), (Status::Doubtful, vec!["bent".to_owned()], vec![(0, 0)]));
        assert_eq!(answer.precision.covariance, Some((vec!["fx".to_owned()], DMatrix::from_element(1, 1, 0.25))));
        assert_eq!((answer.precision.scaled, answer.rms_px, answer.iterations), (Some(Scaled::Sigma0), Some(0.5), Some(9)));
        assert_eq!(answer.shape, [Point3::new(1.0, 2.0, 3.0)]);
    }

    /// In files y is down and z forwards; ours has y up and z backwards.
    #[test]
    fn rays_are_of_any_length_and_in_our_frame() {
        let answer = said(r#""status": "calibrated", "rays": [[0, 3, 4], null]"#).unwrap();
        assert_eq!(answer.lens, Some(Lens::Rays(vec![Some(Ray { x: 0.0, y: -0.6, z: -0.8 }), None])));
    }

    #[test]
    fn an_answer_that_cannot_be_is_refused_with_what_was_expected() {
        for (rest, why) in [
            (r#""status": "calibrated""#, "neither `camera` nor `rays`"),
            (r#""status": "fine", "camera": "64""#, "expected one of calibrated, doubtful, refused, failed"),
            (r#""status": "calibrated", "camera": "64", "rays": []"#, "expected one of them"),
            (r#""status": "calibrated", "camera": "32""#, "is of 32 x 48 px"),
            (r#""status": "calibrated", "camera": "lens""#, "no camera"),
            (r#""status": "calibrated", "rays": [null]"#, "has 1 entries, `grid` has 2"),
            (r#""status": "calibrated", "camera": "64", "uncertainty": [null]"#, "`uncertainty` has 1 entries"),
            (r#""status": "calibrated", "camera": "64", "sigmas": {"c": 1}"#, "names `c`, which the camera does not have"),
            (r#""status": "calibrated", "camera": "64", "covariance": {"names": ["c"], "matrix": [[1]]}"#, "names `c`"),
            (r#""status": "calibrated", "camera": "64", "covariance": {"names": ["fx"], "matrix": [[1, 2]]}"#, "a matrix of 1 x 1"),
            (r#""status": "calibrated", "camera": "64", "covariance": {"names": ["fx"], "matrix": [[-1]]}"#, "a negative variance of `fx`"),
            (
                r#""status": "calibrated", "camera": "64", "covariance": {"names": ["fx", "fy"], "matrix": [[1, 0], [0.5, 1]]}"#,
                "is not symmetric",
            ),
            (r#""status": "calibrated", "camera": "64", "scaled": "px""#, "expected unit, stated or sigma0"),
            (r#""status": "calibrated", "camera": "64", "outliers": [[0, 1]]"#, "of which there is none"),
            (r#""status": "calibrated", "camera": "64", "lens": 1"#, "unknown field `lens`"),
        ] {
            let found = said(rest).unwrap_err();
            assert!(found.contains(why), "{rest}: {found}");
        }
        let other = read(r#"{"task": 8, "status": "refused"}"#, 7, &task(), width).unwrap_err();
        assert!(other.contains("`task` must be that of the request"), "{other}");
    }
}
