//! A camera that a format wrote goes to that format again without loss, whatever its model.

use calibench_model::camera::{
    Agisoft, AgisoftVersion, Camera, CameraModel, ImageSize, MicMac, OpenCv, OpenCvFisheye, Pix4d, TangentialOrder,
};
use calibench_model::convert::{ConvertOptions, Method};

use super::super::conversion::converted;
use super::super::target::{Given, TargetError, goal};
use super::super::{CameraFormat, FORMATS, NamedCamera, ReadOptions, camera_bytes, parse_camera};
use super::any_model::all_models;

const SIZE: ImageSize = ImageSize { width: 1200, height: 900 };

/// Beside one camera of each model those with all their terms, and those with few.
fn cameras() -> Vec<Camera> {
    let opencv = |coefficients: usize| {
        const ALL: [f64; 14] = [-0.08, 0.02, 3e-4, -6e-4, -0.002, 0.01, -0.002, 1e-3, 1e-4, 2e-5, -1e-4, 1e-5, 0.01, -0.02];
        let mut distortion = [0.0; 14];
        distortion[..coefficients].copy_from_slice(&ALL[..coefficients]);
        Camera::from(OpenCv { size: SIZE, fx: 1400.0, fy: 1403.0, cx: 610.0, cy: 440.0, distortion, coefficients })
    };
    let agisoft = |version, k, p| Camera::from(Agisoft { size: SIZE, version, f: 1400.0, cx: 7.0, cy: -3.0, b1: 1.0, b2: 0.5, k, p });
    let micmac = |offset, k, p, b| Camera::from(MicMac { size: SIZE, f: 1400.0, pp: [610.0, 440.0], offset, k, p, b });
    let (five, two) = ([-4e-8, 5e-15, 1e-22, -2e-28, 1e-35], [-4e-8, 5e-15, 0.0, 0.0, 0.0]);
    let pix4d = |order| Pix4d {
        size: SIZE,
        sensor_width_mm: 6.0,
        f_px: 1400.0,
        px: 610.0,
        py: 440.0,
        r: [-0.08, 0.02, 1e-3],
        t: [2e-4, 1e-4],
        order,
    };
    let fisheye = |skew| OpenCvFisheye { size: SIZE, fx: 420.0, fy: 421.0, cx: 605.0, cy: 445.0, skew, k: [-0.02, 0.003, -0.001, 1e-4] };
    let mut all = all_models();
    all.extend([4, 5, 8, 12, 14].map(opencv));
    all.extend([
        agisoft(AgisoftVersion::Metashape, [-0.08, 0.02, 0.001, -5e-4], [2e-4, 1e-4, 0.1, -0.2]),
        agisoft(AgisoftVersion::Metashape, [-0.08, 0.02, 0.001, 0.0], [2e-4, 1e-4, 0.0, -0.2]),
        agisoft(AgisoftVersion::Metashape, [0.0; 4], [0.0; 4]),
        micmac([5.0, -4.0], five, [1e-7, -2e-7], [1e-3, -2e-4]),
        micmac([0.0; 2], two, [0.0; 2], [1e-3, 0.0]),
        micmac([5.0, -4.0], two, [0.0; 2], [0.0; 2]),
        pix4d(TangentialOrder::Brown).into(),
        fisheye(0.0).into(),
        fisheye(0.002).into(),
    ]);
    all
}

fn read(format: &'static CameraFormat, camera: &NamedCamera) -> Option<NamedCamera> {
    let bytes = camera_bytes(format, std::slice::from_ref(camera)).ok()?;
    Some(
        parse_camera("f", &bytes, &ReadOptions { from: Some(format), ..ReadOptions::of_written(format, SIZE) })
            .unwrap_or_else(|error| panic!("{}: {error}", format.name))
            .cameras
            .remove(0),
    )
}

/// The target by which a camera of a format is asked for in that format again.
fn target(format: &CameraFormat, camera: &Camera) -> Option<&'static str> {
    match (format.name, camera) {
        ("opencv-yaml" | "opencv-xml", Camera::OpenCvFisheye(_)) => Some("opencv-fisheye"),
        ("opencv-yaml" | "opencv-xml", Camera::OpenCv(_)) => Some("opencv"),
        ("opencv-yaml" | "opencv-xml", Camera::Omni(_)) => Some("opencv-omnidir"),
        ("metashape", Camera::Agisoft(camera)) if camera.version == AgisoftVersion::Lens => Some("agisoft-lens"),
        ("photoscan-cameras", _) => Some("photoscan"),
        ("metashape" | "pix4d" | "pix4d-inpho", _) => Some(format.name),
        _ => (!format.models(None).is_empty()).then_some(format.name),
    }
}

#[test]
fn what_a_format_holds_it_holds_again() {
    let (mut exact, mut lost, mut formats) = (0, Vec::new(), std::collections::BTreeSet::new());
    for format in FORMATS.iter().copied().filter(|format| format.is_written()) {
        for camera in cameras() {
            let named = NamedCamera { pitch_um: Some(5.0), ..NamedCamera::new("7", camera) };
            let Some(own) = read(format, &named) else { continue };
            let Some(to) = target(format, &own.camera) else { continue };
            let order = if let Camera::Pix4d(camera) = own.camera { camera.order } else { TangentialOrder::OpenCv };
            let given = Given { source: &own, pitch_um: Some(5.0), base_mm: None, order, output: None };
            let goal = match goal(to, &given) {
                Ok(goal) => goal,
                Err(error @ TargetError::Unknown { .. }) => panic!("{error}"),
                Err(_) => continue,
            };
            let found = converted(&own, &goal, None, Some(5.0), &ConvertOptions::default());
            let Some(found) = found.ok().filter(|found| found.conversion.method == Method::Exact) else {
                lost.push(format!("{} to {to}: {:?}", format.name, own.camera));
                continue;
            };
            let again = read(goal.format, &found.camera).unwrap_or_else(|| panic!("{to}: {:?}", found.camera));
            let off = super::any_model::apart(&own.camera, &again.camera);
            assert!(
                off < 1e-9 * f64::from(own.camera.size().width),
                "{} to {to}: {off} px\n{:?}\n{:?}",
                format.name,
                own.camera,
                again.camera
            );
            exact += 1;
            formats.insert(format.name);
        }
    }
    assert!(lost.is_empty(), "{exact} exact, not these: {lost:#?}");
    assert!(exact > 120 && formats.len() > 20, "{exact}: {formats:?}");
}
