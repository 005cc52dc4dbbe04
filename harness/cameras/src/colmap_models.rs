//! COLMAP's camera models as names and numbers, which kapture has too: the corner of the first pixel is (0, 0).

use calibench_model::camera::{AgisoftVersion, Camera, Eucm, Fov, ImageSize, OpenCv, OpenCvFisheye, PrismFisheye, RadTanPrismFisheye};
use calibench_model::convert::Target;
use calibench_model::{CornerPoint, PixelPoint};

use super::brown::{Brown, positive};
use super::format::Model;
use super::number::shortened;
use super::{CameraFileError, CameraFormat};

/// Names and how many numbers they have, in the order of COLMAP's own numbers for them, which count from 0.
pub(super) const MODELS: [(&str, usize); 18] = [
    ("SIMPLE_PINHOLE", 3),
    ("PINHOLE", 4),
    ("SIMPLE_RADIAL", 4),
    ("RADIAL", 5),
    ("OPENCV", 8),
    ("OPENCV_FISHEYE", 8),
    ("FULL_OPENCV", 12),
    ("FOV", 5),
    ("SIMPLE_RADIAL_FISHEYE", 4),
    ("RADIAL_FISHEYE", 5),
    ("THIN_PRISM_FISHEYE", 12),
    ("RAD_TAN_THIN_PRISM_FISHEYE", 16),
    ("SIMPLE_DIVISION", 4),
    ("DIVISION", 5),
    ("SIMPLE_FISHEYE", 3),
    ("FISHEYE", 4),
    ("EUCM", 6),
    ("EQUIRECTANGULAR", 2),
];

/// How many of them COLMAP 3 has, and kapture.
const CLASSIC: usize = 11;

/// What can be fitted, the leanest first, and last what only COLMAP 4 reads.
pub(super) fn models(pitch_um: Option<f64>) -> Vec<Model> {
    let newer = [
        Model { name: "DIVISION", target: Target::Division },
        Model { name: "EUCM", target: Target::Eucm },
        Model { name: "RAD_TAN_THIN_PRISM_FISHEYE", target: Target::RadTanPrismFisheye },
    ];
    [classic_models(pitch_um), newer.into()].concat()
}

/// What can be fitted and COLMAP 3 and kapture hold, the leanest first.
pub(super) fn classic_models(_pitch_um: Option<f64>) -> Vec<Model> {
    let radial = |radial| Target::Agisoft { version: AgisoftVersion::Metashape, radial, tangential: 0, affinity: false };
    vec![
        Model { name: "SIMPLE_RADIAL", target: radial(1) },
        Model { name: "RADIAL", target: radial(2) },
        Model { name: "OPENCV", target: Target::OpenCv { coefficients: 4 } },
        Model { name: "OPENCV_FISHEYE", target: Target::OpenCvFisheye },
        Model { name: "FOV", target: Target::Fov },
        Model { name: "FULL_OPENCV", target: Target::OpenCv { coefficients: 8 } },
        Model { name: "THIN_PRISM_FISHEYE", target: Target::PrismFisheye },
    ]
}

/// The camera of a model's name and its numbers.
pub(super) fn camera(name: &str, size: ImageSize, v: &[f64]) -> Result<Camera, CameraFileError> {
    let Some((_, count)) = MODELS.iter().find(|(known, _)| *known == name) else {
        let known = MODELS.map(|(name, _)| name).join(", ");
        return Err(CameraFileError::new(format!("model `{}` is not known; expected {known}", shortened(name))));
    };
    if v.len() != *count {
        return Err(CameraFileError::new(format!("expected {count} numbers for {name}, found {}", v.len())));
    }
    if name == "EQUIRECTANGULAR" {
        return Err(CameraFileError::new(
            "a whole panorama, which has no interior orientation to convert; remove this camera from the list",
        ));
    }
    let one_focal = name.starts_with("SIMPLE_") || matches!(name, "RADIAL" | "RADIAL_FISHEYE");
    let (fx, fy, rest) = if one_focal { (v[0], v[0], &v[1..]) } else { (v[0], v[1], &v[2..]) };
    positive("f", fx)?;
    positive("f", fy)?;
    let (PixelPoint { x: cx, y: cy }, d) = (CornerPoint { x: rest[0], y: rest[1] }.to_pixel(), &rest[2..]);
    let plain = Brown::plain(size, [fx, fy, cx, cy]);
    let at = |i: usize| d.get(i).copied().unwrap_or(0.0);
    Ok(match name {
        "OPENCV" => Brown { k: [d[0], d[1], 0.0, 0.0], p1: d[2], p2: d[3], ..plain }.camera(),
        "FULL_OPENCV" => {
            let mut distortion = [0.0; 14];
            distortion[..8].copy_from_slice(d);
            OpenCv { size, fx, fy, cx, cy, distortion, coefficients: 8 }.into()
        }
        "OPENCV_FISHEYE" | "SIMPLE_RADIAL_FISHEYE" | "RADIAL_FISHEYE" | "SIMPLE_FISHEYE" | "FISHEYE" => {
            OpenCvFisheye { size, fx, fy, cx, cy, skew: 0.0, k: std::array::from_fn(at) }.into()
        }
        "FOV" => Fov { size, fx, fy, cx, cy, w: d[0] }.into(),
        "THIN_PRISM_FISHEYE" => PrismFisheye { size, fx, fy, cx, cy, k: [d[0], d[1], d[4], d[5]], p: [d[2], d[3]], s: [d[6], d[7]] }.into(),
        "RAD_TAN_THIN_PRISM_FISHEYE" => {
            let (k, p, s) = (std::array::from_fn(at), [d[6], d[7]], [d[8], d[9], d[10], d[11]]);
            RadTanPrismFisheye { size, fx, fy, cx, cy, k, p, s }.into()
        }
        "SIMPLE_DIVISION" | "DIVISION" => Eucm { size, fx, fy, cx, cy, alpha: 0.5, beta: -4.0 * d[0] }.into(),
        "EUCM" => {
            positive("beta", d[1])?;
            if !(0.0..=1.0).contains(&d[0]) {
                return Err(CameraFileError::new(format!("expected alpha from 0 to 1, found {}", d[0])));
            }
            Eucm { size, fx, fy, cx, cy, alpha: d[0], beta: d[1] }.into()
        }
        _ => Brown { k: [at(0), at(1), 0.0, 0.0], ..plain }.camera(),
    })
}

/// The leanest model of COLMAP 3 that holds `camera`, and its numbers.
pub(super) fn written_classic(camera: &Camera, format: &CameraFormat) -> Result<(&'static str, Vec<f64>), CameraFileError> {
    let (name, numbers) = written(camera, format)?;
    let is_classic = MODELS[..CLASSIC].iter().any(|(known, _)| *known == name);
    if is_classic { Ok((name, numbers)) } else { Err(format.other_model("cameras of COLMAP 3's models")) }
}

/// The leanest model that holds `camera`, and its numbers; one of COLMAP 3 where it has one, which COLMAP 4 reads too.
pub(super) fn written(camera: &Camera, format: &CameraFormat) -> Result<(&'static str, Vec<f64>), CameraFileError> {
    let head = |fx: f64, fy: f64, cx: f64, cy: f64| {
        let corner = PixelPoint::new(cx, cy).to_corner();
        vec![fx, fy, corner.x, corner.y]
    };
    let with = |head: Vec<f64>, rest: &[f64]| [head.as_slice(), rest].concat();
    match *camera {
        Camera::OpenCvFisheye(OpenCvFisheye { fx, fy, cx, cy, skew: 0.0, k, .. }) => {
            let head = head(fx, fy, cx, cy);
            let lean = |name, n: usize| Ok((name, [&head[1..], &k[..n]].concat()));
            match k {
                [_, 0.0, 0.0, 0.0] if fx == fy => lean("SIMPLE_RADIAL_FISHEYE", 1),
                [_, _, 0.0, 0.0] if fx == fy => lean("RADIAL_FISHEYE", 2),
                _ => Ok(("OPENCV_FISHEYE", with(head, &k))),
            }
        }
        Camera::Fov(Fov { fx, fy, cx, cy, w, .. }) => Ok(("FOV", with(head(fx, fy, cx, cy), &[w]))),
        Camera::PrismFisheye(PrismFisheye { fx, fy, cx, cy, k, p, s, .. }) => {
            Ok(("THIN_PRISM_FISHEYE", with(head(fx, fy, cx, cy), &[k[0], k[1], p[0], p[1], k[2], k[3], s[0], s[1]])))
        }
        Camera::RadTanPrismFisheye(RadTanPrismFisheye { fx, fy, cx, cy, k, p, s, .. }) => {
            Ok(("RAD_TAN_THIN_PRISM_FISHEYE", with(head(fx, fy, cx, cy), &[&k[..], &p[..], &s[..]].concat())))
        }
        Camera::Eucm(Eucm { fx, fy, cx, cy, alpha: 0.5, beta, .. }) => {
            let (head, k) = (head(fx, fy, cx, cy), 0.0 - 0.25 * beta);
            Ok(if fx == fy { ("SIMPLE_DIVISION", with(head[1..].to_vec(), &[k])) } else { ("DIVISION", with(head, &[k])) })
        }
        Camera::Eucm(Eucm { fx, fy, cx, cy, alpha, beta, .. }) => Ok(("EUCM", with(head(fx, fy, cx, cy), &[alpha, beta]))),
        Camera::OpenCv(OpenCv { fx, fy, cx, cy, distortion: d, coefficients, .. })
            if d[8..].iter().all(|&v| v == 0.0) && (coefficients >= 8 || d[4] != 0.0) =>
        {
            Ok(("FULL_OPENCV", with(head(fx, fy, cx, cy), &d[..8])))
        }
        _ => brown(camera).ok_or_else(|| format.other_model("cameras of COLMAP's models")),
    }
}

fn brown(camera: &Camera) -> Option<(&'static str, Vec<f64>)> {
    let brown = Brown::of(camera).filter(|brown| brown.skew == 0.0 && brown.k[3] == 0.0)?;
    let (corner, [k1, k2, k3, _]) = (brown.corner(), brown.k);
    let two = [brown.fx, brown.fy, corner.x, corner.y];
    let radial = brown.radial();
    Some(match (brown.has_one_focal() && !brown.has_tangential(), radial) {
        (_, 3) => ("FULL_OPENCV", [&two[..], &[k1, k2, brown.p1, brown.p2, k3, 0.0, 0.0, 0.0]].concat()),
        (true, 0) => ("SIMPLE_PINHOLE", two[1..].to_vec()),
        (true, 1) => ("SIMPLE_RADIAL", [&two[1..], &[k1]].concat()),
        (true, _) => ("RADIAL", [&two[1..], &[k1, k2]].concat()),
        (false, 0) if !brown.has_tangential() => ("PINHOLE", two.to_vec()),
        (false, _) => ("OPENCV", [&two[..], &[k1, k2, brown.p1, brown.p2]].concat()),
    })
}
