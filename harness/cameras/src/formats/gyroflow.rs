//! Gyroflow's lens profiles: OpenCV's fisheye or its pinhole camera, or poly3, poly5, ptlens in units of the focal length.

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, CameraModel, ImageSize, LensProjection, OpenCv, PtLens, tool_conventions};
use calibench_model::convert::Target;

use super::PLAIN;
use crate::brown::Brown;
use crate::format::{Keeps, Model};
use crate::json::{self, quoted};
use crate::number::{row, shortened};
use crate::opencv;
use crate::opencv_storage::Matrix;
use crate::source::Source;
use crate::tree::{Entry, Value, all_left_out};
use crate::{CameraFileError, CameraFormat, ReadOptions};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "gyroflow",
    tool: "Gyroflow",
    versions: "lens profiles of Gyroflow 1",
    extension: "json",
    words: "calibrated_by camera_brand camera_model lens_model calib_dimension orig_dimension fisheye_params camera_matrix distortion_coeffs distortion_model calibrator_version",
    recognise: |source| {
        let found = source.text.trim_start().starts_with('{') && source.text.contains("\"fisheye_params\"");
        if found { Ok(()) } else { Err("no JSON with `fisheye_params`".into()) }
    },
    read,
    write: Some(write),
    convention: Some(&tool_conventions::GYROFLOW),
    models: |_| {
        vec![
            Model { name: "opencv_fisheye", target: Target::OpenCvFisheye },
            Model { name: "opencv_standard", target: Target::OpenCv { coefficients: 5 } },
            Model { name: "opencv_standard", target: Target::OpenCv { coefficients: 12 } },
            Model { name: "ptlens", target: Target::PtLens { projection: LensProjection::Rectilinear } },
        ]
    },
    keeps: Keeps { name: true, ..PLAIN.keeps },
    origin_is_open: true,
    half_space: true,
    ..PLAIN
};

/// What is said of the lens besides its numbers.
const NAMES: [&str; 3] = ["camera_brand", "camera_model", "lens_model"];
const LENS: [&str; 7] = [
    "calib_dimension",
    "fisheye_params",
    "distortion_model",
    "asymmetrical",
    "input_horizontal_stretch",
    "input_vertical_stretch",
    "digital_lens",
];
/// How the lens was calibrated, and how pictures are made.
const ABOUT: [&str; 24] = [
    "name",
    "note",
    "calibrated_by",
    "camera_setting",
    "orig_dimension",
    "output_dimension",
    "frame_readout_time",
    "frame_readout_direction",
    "gyro_lpf",
    "num_images",
    "fps",
    "crop",
    "official",
    "identifier",
    "calibrator_version",
    "date",
    "compatible_settings",
    "sync_settings",
    "digital_lens_params",
    "interpolations",
    "focal_length",
    "crop_factor",
    "global_shutter",
    "use_opencv_fisheye",
];

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let root = json::json(source.text)?;
    let dimension = root.required("calib_dimension")?;
    let size = options.size_or(Some(dimension.size_of("w", "h").map_err(|error| error.in_key("calib_dimension"))?))?;
    let lens = root.required("fisheye_params")?;
    let at = |error: CameraFileError| error.in_key("fisheye_params");
    let matrix = lens.required("camera_matrix").map_err(at)?;
    let placed = |error: CameraFileError, entry: &Entry, key: &str| {
        let line = error.line.map_or(entry.line, |line| line as usize);
        error.on_line(line).of(format!("fisheye_params.{key}"))
    };
    let rows = matrix.rows().map_err(|error| placed(error, matrix, "camera_matrix"))?;
    let found = Matrix { rows: rows.len(), columns: rows.first().map_or(0, Vec::len), data: rows.concat() };
    let mut k = opencv::camera_matrix(&found).map_err(|error| placed(error, matrix, "camera_matrix"))?;
    // Without this switch Gyroflow takes the middle.
    let asymmetrical = is(root.key("asymmetrical")?, "true");
    if !asymmetrical {
        (k[2], k[5]) = (f64::from(size.width) / 2.0, f64::from(size.height) / 2.0);
    }
    let entry = lens.required("distortion_coeffs").map_err(at)?;
    let d = entry.row().map_err(|error| placed(error, entry, "distortion_coeffs"))?;
    let model = root.key("distortion_model")?.map_or(Ok("opencv_fisheye"), Entry::text)?;
    let camera = camera(model, size, &k, &d).map_err(|error| placed(error, entry, "distortion_coeffs"))?;
    let camera = camera.ok_or_else(|| {
        let problem = format!("`{}` is no model here; expected opencv_fisheye, opencv_standard, poly3, poly5 or ptlens", shortened(model));
        root.wrong(&problem).of("distortion_model")
    })?;
    refuse_warped(&root, options)?;
    let mut notes = root.of_file(&[&NAMES[..], &LENS, &ABOUT].concat(), options)?;
    notes.extend(lens.of_lens(&["RMS_error", "camera_matrix", "distortion_coeffs", "radial_distortion_limit"], options).map_err(at)?);
    if !asymmetrical {
        notes.push("`asymmetrical` is not set: the principal point is the middle of the frame, as Gyroflow takes it, whatever the camera matrix says".into());
    }
    notes.extend(all_left_out(root.key("interpolations")?.filter(|entry| !is_null(entry)).map(|_| "interpolations").into_iter()));
    let words: Vec<&str> = NAMES.iter().filter_map(|name| root.key(name).ok()??.text().ok()).filter(|word| !word.is_empty()).collect();
    let name = if words.is_empty() { root.key("name")?.map_or(Ok(""), Entry::text)?.to_owned() } else { words.join(" ") };
    Ok(vec![NamedCamera { notes, ..NamedCamera::new(name, camera) }])
}

fn is(entry: Option<&Entry>, word: &str) -> bool {
    matches!(entry.map(|entry| &entry.value), Some(Value::Scalar(text)) if text == word)
}

fn is_null(entry: &Entry) -> bool {
    is(Some(entry), "null")
}

/// Pictures that the camera warped after the lens are no lens's.
fn refuse_warped(root: &Entry, options: &ReadOptions) -> Result<(), CameraFileError> {
    let ignored = |key: &str| options.ignore.iter().any(|ignored| ignored == key);
    let digital = root.key("digital_lens")?.filter(|entry| !is_null(entry) && !is(Some(*entry), "") && !ignored("digital_lens"));
    if let Some(digital) = digital {
        let problem =
            "the camera warps its pictures after the lens, which no camera here does; `--ignore-key digital_lens` reads the lens alone";
        return Err(digital.wrong(problem).of("digital_lens"));
    }
    for key in ["input_horizontal_stretch", "input_vertical_stretch"] {
        if let Some(stretch) = root.key(key)?.filter(|_| !ignored(key)) {
            let factor = stretch.number().map_err(|error| error.of(key))?;
            if factor != 1.0 && factor > 0.01 {
                let problem = format!(
                    "the pictures are stretched {factor} times before the lens is meant; `--ignore-key {key}` reads the lens of the stretched ones"
                );
                return Err(stretch.wrong(&problem).of(key));
            }
        }
    }
    Ok(())
}

/// The camera of a model's coefficients; `None` for a model that is not known.
fn camera(model: &str, size: ImageSize, k: &[f64; 9], d: &[f64]) -> Result<Option<Camera>, CameraFileError> {
    let [f, _, cx, _, fy, cy, ..] = *k;
    let needs = |count: usize| match d.len() {
        found if found >= count && d[count..].iter().all(|value| *value == 0.0) => Ok(()),
        found => Err(CameraFileError::new(format!("expected {count} coefficients of {model}, found {found}"))),
    };
    let lens = |a, b, c| {
        if f != fy {
            return Err(CameraFileError::new(format!("two focal lengths, {f} and {fy}, with {model}; expected one")));
        }
        Ok(Some(PtLens { size, projection: LensProjection::Rectilinear, f, cx, cy, a, b, c }.into()))
    };
    match model {
        "opencv_fisheye" => opencv::fisheye_camera(size, k, d).map(Some),
        "opencv_standard" => opencv::pinhole(size, k, d).map(Some),
        "poly3" => {
            needs(1)?;
            lens(0.0, d[0], 0.0)
        }
        "poly5" => {
            needs(2)?;
            Ok(Some(Brown { k: [d[0], d[1], 0.0, 0.0], ..Brown::plain(size, [f, fy, cx, cy]) }.camera()))
        }
        "ptlens" => {
            needs(3)?;
            lens(d[0], d[1], d[2])
        }
        _ => Ok(None),
    }
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let named = &cameras[0];
    let wrong = || FORMAT.other_model("OpenCV's fisheye, its pinhole camera of up to 12 coefficients, or a rectilinear lens of a, b, c");
    let (model, matrix, d) = match named.camera {
        Camera::PtLens(PtLens { projection: LensProjection::Rectilinear, f, cx, cy, a, b, c, .. }) => {
            ("ptlens", [f, 0.0, cx, 0.0, f, cy, 0.0, 0.0, 1.0], vec![a, b, c])
        }
        Camera::OpenCv(OpenCv { coefficients: 14, .. }) | Camera::Omni(_) => return Err(wrong()),
        _ => {
            let written = opencv::written(&named.camera, &FORMAT).map_err(|_| wrong())?;
            if written.fisheye && written.matrix[1] != 0.0 {
                return Err(wrong());
            }
            (if written.fisheye { "opencv_fisheye" } else { "opencv_standard" }, written.matrix, written.distortion)
        }
    };
    let ImageSize { width, height } = named.camera.size();
    let dimension = format!("{{ \"w\": {width}, \"h\": {height} }}");
    let rows: Vec<String> = matrix.chunks(3).map(|values| format!("[{}]", row(values))).collect();
    Ok(format!(
        "{{\n  \"name\": {name},\n  \"note\": \"\",\n  \"calibrated_by\": \"\",\n  \"camera_brand\": \"\",\n  \"camera_model\": {name},\n  \"lens_model\": \"\",\n  \
         \"camera_setting\": \"\",\n  \"calib_dimension\": {dimension},\n  \"orig_dimension\": {dimension},\n  \"input_horizontal_stretch\": 1.0,\n  \
         \"input_vertical_stretch\": 1.0,\n  \"num_images\": 0,\n  \"fps\": 0.0,\n  \"asymmetrical\": true,\n  \"distortion_model\": \"{model}\",\n  \"fisheye_params\": {{\n    \
         \"RMS_error\": 0.0,\n    \"camera_matrix\": [{}],\n    \"distortion_coeffs\": [{}]\n  }},\n  \"calibrator_version\": \"calibench\"\n}}\n",
        rows.join(", "),
        row(&d),
        name = quoted(&named.name)
    ))
}
