//! Theia's calibration JSON: `priors`, one for each image.

use calibench_model::NamedCamera;
use calibench_model::camera::{AgisoftVersion, Camera, CameraModel, Fov, ImageSize, OpenCvFisheye, tool_conventions};
use calibench_model::convert::Target;

use super::PLAIN;
use crate::brown::{Brown, positive};
use crate::format::{Keeps, Model};
use crate::json::{self, quoted};
use crate::number::{row, shortened, shortest};
use crate::source::Source;
use crate::tree::Entry;
use crate::{CameraFileError, CameraFormat, ReadOptions, noted};

pub(super) static FORMAT: CameraFormat = CameraFormat {
    name: "theia",
    tool: "Theia",
    versions: "calibration JSON of 0.8 and later",
    extension: "json",
    words: "priors CameraIntrinsicsPrior image_name focal_length principal_point radial_distortion_coeffs camera_intrinsics_type tangential_distortion_coeffs",
    many: true,
    recognise: |source| {
        let found = source.text.trim_start().starts_with('{') && source.text.contains("\"CameraIntrinsicsPrior\"");
        if found { Ok(()) } else { Err("no JSON with `CameraIntrinsicsPrior`".into()) }
    },
    read,
    write: Some(write),
    convention: Some(&tool_conventions::THEIA),
    models: |_| {
        let full = Target::Agisoft { version: AgisoftVersion::Metashape, radial: 3, tangential: 2, affinity: true };
        let lean = Target::Agisoft { version: AgisoftVersion::Metashape, radial: 2, tangential: 0, affinity: true };
        vec![
            Model { name: "PINHOLE", target: lean },
            Model { name: "PINHOLE_RADIAL_TANGENTIAL", target: full },
            Model { name: "FISHEYE", target: Target::OpenCvFisheye },
            Model { name: "FOV", target: Target::Fov },
        ]
    },
    keeps: Keeps { name: true, ..PLAIN.keeps },
    origin_is_open: true,
    ..PLAIN
};

const KNOWN: [&str; 10] = [
    "image_name",
    "width",
    "height",
    "focal_length",
    "principal_point",
    "aspect_ratio",
    "skew",
    "radial_distortion_coeffs",
    "tangential_distortion_coeffs",
    "camera_intrinsics_type",
];

fn read(source: &Source<'_>, options: &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError> {
    let root = json::json(source.text)?;
    let priors = root.required("priors")?.items()?.iter().enumerate();
    let camera = |(index, prior): (usize, &Entry)| {
        camera(prior.required("CameraIntrinsicsPrior")?, options).map_err(|error| error.in_key(&format!("priors[{index}]")))
    };
    let cameras = priors.map(camera).collect::<Result<_, _>>()?;
    Ok(noted(cameras, &root.of_file(&["priors"], options)?))
}

fn camera(prior: &Entry, options: &ReadOptions) -> Result<NamedCamera, CameraFileError> {
    let stated = if prior.key("width")?.is_some() { Some(prior.size_of("width", "height")?) } else { None };
    let size = options.size_or(stated).map_err(|error| error.on_line(prior.line))?;
    let fx = positive("focal_length", prior.number_of("focal_length")?).map_err(|error| error.on_line(prior.line))?;
    let aspect = if prior.key("aspect_ratio")?.is_some() { prior.number_of("aspect_ratio")? } else { 1.0 };
    let fy = fx * positive("aspect_ratio", aspect).map_err(|error| error.on_line(prior.line))?;
    let (skew, [cx, cy]) = (prior.number_or_zero("skew")?, prior.row_of("principal_point")?);
    let coefficients = |name: &str| prior.key(name)?.map_or(Ok(Vec::new()), |entry| entry.row().map_err(|error| error.of(name)));
    let (radial, tangential) = (coefficients("radial_distortion_coeffs")?, coefficients("tangential_distortion_coeffs")?);
    let kind = prior.key("camera_intrinsics_type")?.map_or(Ok("PINHOLE"), Entry::text)?;
    let (most, decentred) = match kind {
        "PINHOLE" => (2, false),
        "PINHOLE_RADIAL_TANGENTIAL" => (3, true),
        "FISHEYE" => (4, false),
        "FOV" => (1, false),
        _ => {
            let known = "PINHOLE, PINHOLE_RADIAL_TANGENTIAL, FISHEYE or FOV";
            let problem = format!("`{}` is not known; expected {known}", shortened(kind));
            return Err(prior.required("camera_intrinsics_type")?.wrong(&problem).of("camera_intrinsics_type"));
        }
    };
    let unused = radial.iter().skip(most).chain(tangential.iter().filter(|_| !decentred)).any(|&v| v != 0.0) || tangential.len() > 2;
    if unused {
        return Err(prior.wrong(&format!("has more coefficients than {kind}")));
    }
    let k: [f64; 4] = std::array::from_fn(|i| radial.get(i).copied().unwrap_or(0.0));
    let p = |i: usize| tangential.get(i).copied().unwrap_or(0.0);
    let camera: Camera = match kind {
        "FISHEYE" => OpenCvFisheye { size, fx, fy, cx, cy, skew: skew / fx, k }.into(),
        "FOV" if skew == 0.0 => Fov { size, fx, fy, cx, cy, w: k[0] }.into(),
        "FOV" => return Err(prior.wrong("has a skew, which is not known here for FOV").of("skew")),
        _ => Brown { skew, k, p1: p(0), p2: p(1), ..Brown::plain(size, [fx, fy, cx, cy]) }.camera(),
    };
    let name = prior.key("image_name")?.map_or(Ok(""), Entry::text)?;
    Ok(NamedCamera { notes: prior.of_lens(&KNOWN, options)?, ..NamedCamera::new(name, camera) })
}

fn write(cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let priors = cameras.iter().map(|named| {
        let parts =
            parts(&named.camera).ok_or_else(|| FORMAT.other_model("cameras of PINHOLE, PINHOLE_RADIAL_TANGENTIAL, FISHEYE and FOV"))?;
        let (ImageSize { width, height }, [fx, fy, cx, cy]) = (named.camera.size(), parts.focal);
        let mut lines = vec![
            format!("\"image_name\": {}", quoted(&named.name)),
            format!("\"width\": {width}"),
            format!("\"height\": {height}"),
            format!("\"focal_length\": {}", shortest(fx)),
            format!("\"principal_point\": [{}]", row(&[cx, cy])),
            format!("\"aspect_ratio\": {}", shortest(fy / fx)),
            format!("\"skew\": {}", shortest(parts.skew)),
            format!("\"radial_distortion_coeffs\": [{}]", row(&parts.radial)),
        ];
        if let Some(p) = parts.tangential {
            lines.push(format!("\"tangential_distortion_coeffs\": [{}]", row(&p)));
        }
        lines.push(format!("\"camera_intrinsics_type\": \"{}\"", parts.kind));
        Ok(format!("    {{\"CameraIntrinsicsPrior\": {{\n      {}\n    }}}}", lines.join(",\n      ")))
    });
    let priors = priors.collect::<Result<Vec<_>, CameraFileError>>()?;
    Ok(format!("{{\n  \"priors\": [\n{}\n  ]\n}}\n", priors.join(",\n")))
}

struct Parts {
    kind: &'static str,
    focal: [f64; 4],
    skew: f64,
    radial: Vec<f64>,
    tangential: Option<[f64; 2]>,
}

fn parts(camera: &Camera) -> Option<Parts> {
    match *camera {
        Camera::OpenCvFisheye(OpenCvFisheye { fx, fy, cx, cy, skew, k, .. }) => {
            Some(Parts { kind: "FISHEYE", focal: [fx, fy, cx, cy], skew: fx * skew, radial: k.to_vec(), tangential: None })
        }
        Camera::Fov(Fov { fx, fy, cx, cy, w, .. }) => {
            Some(Parts { kind: "FOV", focal: [fx, fy, cx, cy], skew: 0.0, radial: vec![w], tangential: None })
        }
        _ => {
            let brown = Brown::of(camera).filter(|brown| brown.k[3] == 0.0)?;
            let Brown { fx, fy, cx, cy, skew, k, p1, p2, .. } = brown;
            let lean = brown.radial() <= 2 && !brown.has_tangential();
            let (kind, radial) = if lean { ("PINHOLE", &k[..2]) } else { ("PINHOLE_RADIAL_TANGENTIAL", &k[..3]) };
            Some(Parts { kind, focal: [fx, fy, cx, cy], skew, radial: radial.to_vec(), tangential: (!lean).then_some([p1, p2]) })
        }
    }
}
