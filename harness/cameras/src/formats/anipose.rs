//! anipose's calibration.toml, and what is written after it: a table a camera, OpenCV's models, rotation vector and translation.

use calibench_model::NamedCamera;
use calibench_model::camera::Camera;
use calibench_model::convert::Target;
use calibench_model::named_camera::Pose;

use super::PLAIN;
use super::opencv_yaml::quoted;
use crate::format::{Keeps, KeptPose, Model};
use crate::number::{row, shortened};
use crate::opencv_storage::Matrix;
use crate::pose::{of_rotation_vector, of_rt, rotation_vector};
use crate::source::Source;
use crate::tree::{Entry, Value};
use crate::{CameraFileError, CameraFormat, ReadOptions, noted, opencv, toml_tree};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "anipose",
    tool: "anipose, pose2sim, caliscope",
    versions: "calibration TOML of aniposelib 0.8, pose2sim 0.10, caliscope 0.11",
    extension: "toml",
    words: "name size matrix distortions rotation translation fisheye metadata adjusted error",
    verified: Some("aniposelib 0.8.0 loads what is written and projects alike to 1e-8 px, and what it dumps is read so"),
    many: true,
    recognise: |source| {
        let has = |key: &str| source.lines().any(|(_, line)| line.strip_prefix(key).is_some_and(|rest| rest.trim_start().starts_with('=')));
        let found = source.xml.is_none() && has("matrix") && has("distortions");
        if found { Ok(()) } else { Err("no TOML with `matrix =` and `distortions =`".into()) }
    },
    read,
    write: Some(write),
    models: |_| {
        let pinhole = |(coefficients, name)| Model { name, target: Target::OpenCv { coefficients } };
        let mut models: Vec<Model> =
            [(4, "opencv4"), (5, "opencv5"), (8, "opencv8"), (12, "opencv12"), (14, "opencv14")].map(pinhole).into();
        models.push(Model { name: "opencv-fisheye", target: Target::OpenCvFisheye });
        models
    },
    keeps: Keeps { name: true, pose: KeptPose::InWorld, ..PLAIN.keeps },
    half_space: true,
    ..PLAIN
};

/// Tables that are no cameras.
const OTHERS: [&str; 4] = ["metadata", "capture_volume", "charuco", "checkerboard"];
/// What is read of a camera.
const LENS: [&str; 7] = ["name", "size", "matrix", "distortions", "rotation", "translation", "fisheye"];
/// How it was calibrated.
const ABOUT: [&str; 8] = ["cam_id", "port", "error", "exposure", "grid_count", "ignore", "verified_resolutions", "rotation_count"];

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let root = toml_tree::tree(source.text)?;
    // caliscope's own file holds them one level deeper.
    let tables = match root.key("cameras")? {
        Some(cameras) if matches!(cameras.value, Value::Map(_)) => cameras,
        _ => &root,
    };
    let (mut cameras, mut notes) = (Vec::new(), Vec::new());
    let is_table = |entry: &Entry| matches!(entry.value, Value::Map(_));
    for (section, entry) in tables.entries()?.iter().filter(|(name, entry)| is_table(entry) && !OTHERS.contains(&name.as_str())) {
        if entry.key("matrix")?.is_none() && entry.key("distortions")?.is_none() {
            notes.push(format!("`{}` has no `matrix`: left out", shortened(section)));
            continue;
        }
        cameras.push(camera(section, entry, options).map_err(|error| error.in_key(&shortened(section)))?);
    }
    let others = root.entries()?.iter().filter(|(name, entry)| !is_table(entry) && name != "fisheye");
    notes.extend(options.of_file(others.map(|(name, entry)| (name.as_str(), entry.line)), |line, error| error.on_line(line))?);
    // Without a pose these tools write a pose of nothing.
    if cameras.iter().all(|named| named.pose == Some(Pose::IDENTITY)) {
        cameras.iter_mut().for_each(|named| named.pose = None);
    }
    Ok(noted(cameras, &notes))
}

fn camera(section: &str, entry: &Entry, options: &ReadOptions) -> Result<NamedCamera, CameraFileError> {
    let size = options.size_or(Some(entry.size_in("size")?)).map_err(|error| error.on_line(entry.line))?;
    let placed = |at: &Entry, key: &str, error: CameraFileError| {
        let line = error.line.map_or(at.line, |line| line as usize);
        error.on_line(line).of(key)
    };
    let matrix = entry.required("matrix")?;
    let rows = matrix.rows().map_err(|error| placed(matrix, "matrix", error))?;
    let found = Matrix { rows: rows.len(), columns: rows.first().map_or(0, Vec::len), data: rows.concat() };
    let k = opencv::camera_matrix(&found).map_err(|error| placed(matrix, "matrix", error))?;
    let distortions = entry.required("distortions")?;
    // A column, as one of the tools has it, is a row.
    let flat = |item: &Entry| match item.value {
        Value::List(_) => item.row(),
        _ => Ok(vec![item.number()?]),
    };
    let d = distortions.items().and_then(|items| items.iter().map(flat).collect::<Result<Vec<_>, _>>());
    let d = d.map_err(|error| placed(distortions, "distortions", error))?.concat();
    let fisheye = match entry.key("fisheye")?.map(|fisheye| fisheye.text().map(|text| (text, fisheye))).transpose()? {
        None | Some(("false" | "0", _)) => false,
        Some(("true" | "1", _)) => true,
        Some((_, at)) => return Err(at.wrong("expected true or false").of("fisheye")),
    };
    let camera = if fisheye { opencv::fisheye_camera(size, &k, &d) } else { opencv::pinhole(size, &k, &d) };
    let camera: Camera = camera.map_err(|error| placed(distortions, "distortions", error))?;
    let mut notes = entry.of_lens(&[&LENS[..], &ABOUT].concat(), options)?;
    if entry.number_or_zero("rotation_count")? != 0.0 {
        notes.push(
            "`rotation_count` is not 0: its tool shows the images turned; the camera is that of the images as they are stored".into(),
        );
    }
    let name = entry.key("name")?.map_or(Ok(section), Entry::text)?;
    Ok(NamedCamera { pose: pose(entry)?, notes, ..NamedCamera::new(name, camera) })
}

/// Rotation vector, or a matrix, and translation; a camera may have neither.
fn pose(entry: &Entry) -> Result<Option<Pose>, CameraFileError> {
    let (Some(rotation), Some(_)) = (entry.key("rotation")?, entry.key("translation")?) else { return Ok(None) };
    let t: [f64; 3] = entry.row_of("translation")?;
    let r = if rotation.items()?.iter().all(|item| matches!(item.value, Value::List(_))) {
        let rows = rotation.rows().map_err(|error| error.of("rotation"))?;
        let square = rows.len() == 3 && rows.iter().all(|row| row.len() == 3);
        if !square {
            return Err(rotation.wrong("expected a rotation vector of 3 numbers, or 3 x 3").of("rotation"));
        }
        std::array::from_fn(|i| std::array::from_fn(|j| rows[i][j]))
    } else {
        of_rotation_vector(entry.row_of("rotation")?)
    };
    of_rt(r, t).map(Some).map_err(|error| error.on_line(rotation.line).of("rotation"))
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let mut out = String::new();
    // Readers take them in the order of their names.
    let digits = cameras.len().saturating_sub(1).to_string().len();
    for (index, named) in cameras.iter().enumerate() {
        let camera = opencv::written(&named.camera, &FORMAT)?;
        if camera.xi.is_some() || (camera.fisheye && camera.matrix[1] != 0.0) {
            return Err(FORMAT.other_model("cameras of OpenCV's pinhole models, and its fisheye without skew"));
        }
        let name = if named.name.is_empty() { format!("cam_{index}") } else { named.name.clone() };
        let k: Vec<String> = camera.matrix.chunks(3).map(|values| format!("[{}]", row(values))).collect();
        let pose = named.pose.unwrap_or(Pose::IDENTITY);
        out.push_str(&format!(
            "[cam_{index:0digits$}]\nname = {}\nsize = [{}, {}]\nmatrix = [{}]\ndistortions = [{}]\nrotation = [{}]\ntranslation = [{}]\nfisheye = {}\n\n",
            quoted(&name),
            camera.size.width,
            camera.size.height,
            k.join(", "),
            row(&camera.distortion),
            row(&rotation_vector(pose.camera_from_world)),
            row(&pose.t()),
            camera.fisheye
        ));
    }
    Ok(out + "[metadata]\nadjusted = false\nerror = 0.0\n")
}
