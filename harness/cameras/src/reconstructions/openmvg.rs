//! OpenMVG's sfm_data.json with views, poses and structure.

use std::collections::HashMap;

use calibench_model::camera::Camera;
use calibench_model::named_camera::Pose;
use calibench_model::reconstruction::{OrientedImage, ReconstructedCamera, TiePoint, TieSight};
use calibench_model::{NamedCamera, PixelPoint, Reconstruction};
use nalgebra::Point3;

use super::lens::{one_focal, one_focal_brown, one_focal_fisheye};
use super::oriented;
use crate::brown::Brown;
use crate::formats::openmvg::intrinsics;
use crate::json;
use crate::pose::rotation;
use crate::tree::Entry;
use crate::{CameraFileError, ReadOptions};

pub(super) fn recognise(text: &str) -> bool {
    text.trim_start().starts_with('{') && text.contains("\"sfm_data_version\"")
}

/// Keys of views that have no pose or no intrinsics are 2^32 - 1.
const NONE: u64 = u32::MAX as u64;

pub(super) fn read(text: &str) -> Result<Reconstruction, CameraFileError> {
    let root = json::json(text)?;
    let mut out = Reconstruction::default();
    let mut cameras = HashMap::new();
    for (model, named) in intrinsics(&root, &ReadOptions::default())? {
        cameras.insert(named.name.parse().unwrap_or(NONE), out.cameras.len());
        out.cameras.push(reconstructed(&model, named));
    }
    let poses = poses(&root)?;
    let (mut images, mut without) = (HashMap::new(), 0);
    for view in root.required("views")?.items()? {
        let data = view.required("value")?.required("ptr_wrapper")?.required("data")?;
        let id = |name| whole(data.required(name)?).map_err(|error: CameraFileError| error.of(name));
        let (view, camera, pose) = (id("id_view")?, id("id_intrinsic")?, id("id_pose")?);
        let (Some(&camera), Some(pose)) = (cameras.get(&camera), poses.get(&pose)) else {
            without += 1;
            continue;
        };
        images.insert(view, out.images.len());
        let name = data.text_of("filename")?.to_owned();
        out.images.push(OrientedImage { name, camera, pose: oriented(pose) });
    }
    if without > 0 {
        out.notes.push(format!("{without} images that are not oriented were left out"));
    }
    for entry in root.required("structure")?.items()? {
        let (name, value) = (entry.text_of("key")?.to_owned(), entry.required("value")?);
        let point = out.points.len();
        out.points.push(TiePoint { name, position: Point3::from(value.row_of::<3>("X")?) });
        for seen in value.required("observations")?.items()? {
            let view = whole(seen.required("key")?)?;
            let [x, y] = seen.required("value")?.row_of("x")?;
            if let Some(&image) = images.get(&view) {
                out.sights.push(TieSight { image, point, position: PixelPoint::new(x, y) });
            }
        }
    }
    out.notes.push(ORIGIN.into());
    Ok(out)
}

/// What was assumed of image coordinates.
const ORIGIN: &str = "image points and principal points are taken as counted from the same place, the centre of the first pixel";

fn whole(entry: &Entry) -> Result<u64, CameraFileError> {
    entry.text()?.parse().map_err(|_| entry.wrong("expected a whole number"))
}

fn poses(root: &Entry) -> Result<HashMap<u64, Pose>, CameraFileError> {
    let mut poses = HashMap::new();
    for entry in root.required("extrinsics")?.items()? {
        let value = entry.required("value")?;
        let rows = value.required("rotation")?.rows()?;
        let square: Option<Vec<[f64; 3]>> = rows.iter().map(|row| row.as_slice().try_into().ok()).collect();
        let r: Option<[[f64; 3]; 3]> = square.and_then(|rows| rows.try_into().ok());
        let r = r.ok_or_else(|| value.wrong("expected 3 x 3 numbers").of("rotation"))?;
        let r = rotation(r).map_err(|error| error.on_line(value.line).of("rotation"))?;
        poses.insert(whole(entry.required("key")?)?, Pose { camera_from_world: r, position: value.row_of("center")? });
    }
    Ok(poses)
}

fn reconstructed(model: &str, named: NamedCamera) -> ReconstructedCamera {
    let name = named.name.clone();
    match (&named.camera, Brown::of(&named.camera)) {
        (Camera::OpenCvFisheye(fisheye), _) => one_focal_fisheye(&name, fisheye, 4),
        (_, Some(brown)) if model == "pinhole_brown_t2" => one_focal_brown(&name, &brown),
        (_, Some(brown)) => {
            let radial = match model {
                "pinhole_radial_k1" => 1,
                "pinhole_radial_k3" => 3,
                _ => 0,
            };
            one_focal(&name, brown.size, brown.fx, [brown.cx, brown.cy], brown.k, radial)
        }
        (_, None) => ReconstructedCamera { named, lens: Vec::new(), principal_point: Vec::new() },
    }
}
