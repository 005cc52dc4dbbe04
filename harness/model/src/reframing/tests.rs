//! Every model in other images, and what is refused.

use super::*;
use crate::NamedCamera;
use crate::camera::{
    Agisoft, AgisoftFisheye, AgisoftVersion, CameraModel, DoubleSphere, Ebner, Eucm, FisheyeProjection, Fov, LensProjection, MicMac, Ocam,
    Omni, OpenCv, OpenCvFisheye, Photogrammetric, Pix4d, PrismFisheye, PtLens, RadTanPrismFisheye, SixPrismFisheye, TangentialOrder,
};
use crate::named_camera::{ParameterCovariance, Pose};

const SIZE: ImageSize = ImageSize { width: 1201, height: 900 };
/// How many models there are: [`place`] names them.
const MODELS: usize = 17;

/// The place of a model. A new one has to be named here, and then to stand among [`all`].
fn place(camera: &Camera) -> usize {
    match camera {
        Camera::Photogrammetric(_) => 0,
        Camera::Ebner(_) => 1,
        Camera::OpenCv(_) => 2,
        Camera::OpenCvFisheye(_) => 3,
        Camera::Agisoft(_) => 4,
        Camera::AgisoftFisheye(_) => 5,
        Camera::Pix4d(_) => 6,
        Camera::DoubleSphere(_) => 7,
        Camera::Eucm(_) => 8,
        Camera::Omni(_) => 9,
        Camera::Fov(_) => 10,
        Camera::PrismFisheye(_) => 11,
        Camera::RadTanPrismFisheye(_) => 12,
        Camera::MicMac(_) => 13,
        Camera::PtLens(_) => 14,
        Camera::SixPrismFisheye(_) => 15,
        Camera::Ocam(_) => 16,
    }
}

/// A camera of each model with all its terms, but for those that no turned camera has.
fn all() -> Vec<Camera> {
    let (size, fx, fy, cx, cy) = (SIZE, 700.0, 703.0, 605.0, 445.0);
    let distortion = [-0.08, 0.02, 3e-4, -6e-4, -0.002, 0.01, -0.002, 1e-3, 1e-4, 2e-5, -1e-4, 1e-5, 0.0, -0.02];
    let (k, p) = ([-0.02, 0.003, -0.001, 1e-4], [2e-4, 1e-4]);
    let base =
        Photogrammetric { size, pitch_um: 5.0, c: 7.0, x0: 0.03, y0: -0.02, k: [-1e-3, 5e-6, 1e-8], p: [1e-4, -2e-4], b: [3e-3, 0.0] };
    let ebner = [1e-4, -2e-4, 1e-4, -2e-4, 3e-5, 1e-5, 2e-6, -3e-6, 1e-6, 2e-6, -1e-6, 2e-6];
    let agisoft =
        |version, cx, cy, p| Agisoft { size, version, f: 1400.0, cx, cy, b1: 1.5, b2: 0.0, k: [-0.08, 0.02, 1e-3, 0.0], p }.into();
    let (projection, pix4d) = (FisheyeProjection::Equisolid, |order| {
        Pix4d { size, sensor_width_mm: 6.0, f_px: 1400.0, px: 610.0, py: 440.0, r: [-0.08, 0.02, 0.0], t: [2e-4, 1e-4], order }.into()
    });
    vec![
        base.into(),
        Ebner { base, b_mm: 2.0, parameters: ebner }.into(),
        OpenCv { size, fx: 1400.0, fy: 1403.0, cx, cy, distortion, coefficients: 14 }.into(),
        OpenCvFisheye { size, fx: 420.0, fy: 421.0, cx, cy, skew: 0.0, k }.into(),
        agisoft(AgisoftVersion::Metashape, 7.0, -3.0, [2e-4, 1e-4, 0.1, 0.02]),
        agisoft(AgisoftVersion::PhotoScan, 610.0, 440.0, [2e-4, 1e-4, 0.0, 0.0]),
        AgisoftFisheye { size, projection, f: 420.0, cx: 7.0, cy: -3.0, b1: 1.0, b2: 0.0, k, p }.into(),
        pix4d(TangentialOrder::OpenCv),
        pix4d(TangentialOrder::Brown),
        DoubleSphere { size, fx: 400.0, fy: 401.0, cx, cy, xi: -0.2, alpha: 0.58 }.into(),
        Eucm { size, fx: 450.0, fy: 451.0, cx, cy, alpha: 0.6, beta: 1.1 }.into(),
        Omni { size, fx: 1100.0, fy: 1101.0, cx, cy, xi: 1.3, k: [-0.1, 0.02], p }.into(),
        Fov { size, fx, fy, cx, cy, w: 0.8 }.into(),
        PtLens { size, projection: LensProjection::Stereographic, f: 700.0, cx, cy, a: 0.01, b: -0.03, c: -0.005 }.into(),
        SixPrismFisheye {
            size,
            fx: 420.0,
            fy: 421.0,
            cx,
            cy,
            k: [-0.02, 0.003, -0.001, 1e-4, 1e-5, -1e-6],
            p,
            s: [1e-4, -2e-4, 2e-4, 1e-4],
        }
        .into(),
        PrismFisheye { size, fx, fy, cx, cy, k, p, s: [1e-4, -2e-4] }.into(),
        RadTanPrismFisheye { size, fx, fy, cx, cy, k: [-0.01, 0.002, 0.0, 0.0, 1e-4, 0.0], p, s: [1e-4, -2e-4, 2e-4, 1e-4] }.into(),
        Ocam { size, cx, cy, c: 1.01, d: 0.004, e: -0.003, a: [-420.0, 0.01, 7e-4, -1e-7, 4e-10, 1e-13, -1e-16] }.into(),
        MicMac {
            size,
            f: 1400.0,
            pp: [610.0, 440.0],
            offset: [5.0, -3.0],
            k: [-4e-8, 5e-15, 0.0, 0.0, 1e-36],
            p: [1e-7, -2e-7],
            b: [0.0; 2],
        }
        .into(),
    ]
}

const CROP: Option<Crop> = Some(Crop { x: 101, y: 50, size: ImageSize { width: 1000, height: 750 } });

fn changes() -> Vec<FrameChange> {
    let plain = FrameChange::default();
    let scalings = [
        Scaling::Size(ImageSize { width: 600, height: 450 }),
        Scaling::Times(0.37),
        Scaling::Times(3.0),
        Scaling::Binned(2),
        Scaling::Size(ImageSize { width: 640, height: 640 }),
    ];
    let mut all = vec![FrameChange { crop: CROP, ..plain }];
    for crop in [None, CROP] {
        all.extend(scalings.map(|scaling| FrameChange { crop, scaling: Some(scaling), turn: None }));
        all.extend(Turn::ALL.map(|turn| FrameChange { crop, scaling: None, turn: Some(turn) }));
        all.extend(Turn::ALL.map(|turn| FrameChange { crop, scaling: Some(Scaling::Binned(4)), turn: Some(turn) }));
    }
    all
}

/// Rays of a grid over the frame with their images.
fn sights(camera: &Camera) -> Vec<(Ray, PixelPoint)> {
    let ImageSize { width, height } = camera.size();
    let places = (0..=12).flat_map(|i| (0..=9).map(move |j| (i, j)));
    let found = places.filter_map(|(i, j)| {
        let at = PixelPoint::new(f64::from(width - 1) * f64::from(i) / 12.0, f64::from(height - 1) * f64::from(j) / 9.0);
        Some((camera.unproject(at).ok()?, at))
    });
    let found: Vec<_> = found.collect();
    assert!(found.len() > 100, "{camera:?}");
    found
}

#[test]
fn every_model_pictures_rays_where_their_images_come_to() {
    let cameras = all();
    for model in 0..MODELS {
        assert!(cameras.iter().any(|camera| place(camera) == model), "model {model} stands not among those that are tested");
    }
    for (camera, change) in cameras.iter().flat_map(|camera| changes().into_iter().map(move |change| (camera, change))) {
        let by = change.of(SIZE).unwrap();
        let made = match by.camera(camera) {
            Ok(made) => made,
            Err(ReframingError::OneScale { .. }) if !by.resampling.is_isotropic() && !camera.has_two_scales() => continue,
            Err(error) => panic!("{change:?}: {error}: {camera:?}"),
        };
        assert_eq!(made.size(), by.size());
        for (ray, at) in sights(camera) {
            let off = made.project(by.ray(ray)).unwrap().distance(by.point(at));
            assert!(off < 1e-9, "{change:?}: {at:?} is {off:e} px off: {camera:?}");
        }
    }
}

/// Whether a place is beyond where a camera is followed at all: Scaramuzza's polynomial is, in its own plane, to three times the extent of its frame from its centre; what
/// pictures the whole of a frame may not picture all of it from a small part near the centre.
fn is_beyond(at: PixelPoint, camera: &Camera) -> bool {
    let Camera::Ocam(Ocam { size: ImageSize { width, height }, cx, cy, c, d, e, .. }) = camera else { return false };
    let distance = |x: f64, y: f64| {
        let (u, v) = (x - cx, y - cy);
        ((c * u - e * v) / (c - d * e)).hypot((v - d * u) / (c - d * e))
    };
    let corners = [0.0, f64::from(*width)].map(|x| [0.0, f64::from(*height)].map(|y| distance(x, y)));
    distance(at.x, at.y) >= (3.0 - 1e-9) * corners.as_flattened().iter().copied().fold(0.0, f64::max)
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(60))]
    #[test]
    fn any_part_of_any_size_turned_or_not_is_the_same_camera(
        (x, y, width, height) in (0u32..600, 0u32..400, 50u32..600, 50u32..500),
        (along, down, is_squeezed) in (0.05..4.0f64, 0.05..4.0f64, proptest::bool::ANY),
        turn in 0usize..4,
        (u, v) in (0.0..1.0f64, 0.0..1.0f64),
    ) {
        let crop = Some(Crop { x, y, size: ImageSize { width, height } });
        let side = |times: f64, side: u32| (times * f64::from(side)).ceil() as u32;
        let squeezed = Scaling::Size(ImageSize { width: side(along, width), height: side(down, height) });
        let scaling = Some(if is_squeezed { squeezed } else { Scaling::Times(along) });
        let by = FrameChange { crop, scaling, turn: Turn::ALL.get(turn).copied() }.of(SIZE).unwrap();
        let at = PixelPoint::new(u * f64::from(SIZE.width) - 0.5, v * f64::from(SIZE.height) - 0.5);
        for camera in all() {
            let Ok(ray) = camera.unproject(at) else { continue };
            match by.camera(&camera) {
                Ok(made) => {
                    let place = by.point(at);
                    match made.project(by.ray(ray)) {
                        Ok(found) => proptest::prop_assert!(found.distance(place) < 1e-9, "{found:?} for {place:?}, {by}: {camera:?}"),
                        Err(why) => proptest::prop_assert!(is_beyond(place, &made), "{why}: {place:?}, {by}: {made:?}"),
                    }
                }
                Err(error) => proptest::prop_assert!(is_squeezed && !camera.has_two_scales(), "{error}"),
            }
        }
    }
}

#[test]
fn what_a_model_does_not_hold_is_refused_by_name() {
    let turned = |turn| FrameChange { turn: Some(turn), ..FrameChange::default() }.of(SIZE).unwrap();
    let squeezed = FrameChange { scaling: Some(Scaling::Size(ImageSize { width: 600, height: 600 })), ..FrameChange::default() };
    let one_scale: Vec<&str> = all()
        .iter()
        .filter_map(|camera| match squeezed.of(SIZE).unwrap().camera(camera) {
            Err(ReframingError::OneScale { model, .. }) => Some(model),
            _ => None,
        })
        .collect();
    assert_eq!(one_scale, ["photogrammetric", "ebner", "pix4d", "pix4d", "ptlens", "micmac"]);
    let with = |name: &str, value: f64, camera: &Camera| {
        let values: Vec<f64> = camera.parameters().iter().map(|p| if p.name == name { value } else { p.value }).collect();
        camera.with_parameters(&values)
    };
    let parameters = [("b2", 1e-3), ("skew", 1e-3), ("tx", 0.01), ("b1", 1e-3)];
    let mut refused = Vec::new();
    for (camera, (name, value)) in all().iter().flat_map(|camera| parameters.map(|parameter| (camera, parameter))) {
        let camera = with(name, value, camera);
        assert!(turned(Turn::Half).camera(&camera).is_ok(), "{camera:?}");
        let [quarter, three] = [Turn::Quarter, Turn::ThreeQuarters].map(|turn| turned(turn).camera(&camera).err());
        assert_eq!(quarter.is_some(), three.is_some());
        if let Some(ReframingError::Turned { model, parameter, degrees: 90 }) = quarter {
            refused.push((model, parameter));
        }
    }
    let expected = [
        ("photogrammetric", "b2"),
        ("ebner", "b2"),
        ("opencv", "tx and ty together"),
        ("opencv-fisheye", "skew"),
        ("metashape", "b2"),
        ("photoscan", "b2"),
        ("metashape-fisheye", "b2"),
        ("micmac", "b1 or b2"),
        ("micmac", "b1 or b2"),
    ];
    assert_eq!(refused, expected);
}

#[test]
fn a_part_beyond_the_images_and_images_without_a_pixel_are_refused() {
    let part = |x, y, width, height| FrameChange { crop: Some(Crop { x, y, size: ImageSize { width, height } }), ..FrameChange::default() };
    assert!(part(1, 0, 1200, 900).of(SIZE).is_ok());
    for wrong in [part(2, 0, 1200, 900), part(0, 1, 10, 900), part(0, 0, 0, 10), part(u32::MAX, 0, 2, 2)] {
        assert!(matches!(wrong.of(SIZE), Err(ReframingError::Beyond { .. })), "{wrong:?}");
    }
    for scaling in [Scaling::Binned(901), Scaling::Times(1e-4), Scaling::Times(1e9), Scaling::Times(f64::NAN)] {
        let change = FrameChange { scaling: Some(scaling), ..FrameChange::default() };
        assert!(matches!(change.of(SIZE), Err(ReframingError::NoImage { .. })), "{change:?}");
    }
}

#[test]
fn what_is_done_is_said() {
    let said = |change: FrameChange| change.of(ImageSize { width: 1600, height: 1200 }).unwrap().to_string();
    let crop = Some(Crop { x: 0, y: 150, size: ImageSize { width: 1600, height: 900 } });
    let plain = FrameChange::default();
    assert_eq!(
        said(FrameChange { crop, scaling: Some(Scaling::Size(ImageSize { width: 1280, height: 720 })), turn: Some(Turn::Quarter) }),
        "1600 x 1200 px, rows 150 to 1049, times 4/5, turned by 90 degrees clockwise: 720 x 1280 px"
    );
    assert_eq!(said(FrameChange { scaling: Some(Scaling::Binned(2)), ..plain }), "1600 x 1200 px, times 1/2: 800 x 600 px");
    assert_eq!(
        said(FrameChange { scaling: Some(Scaling::Size(ImageSize { width: 3200, height: 601 })), ..plain }),
        "1600 x 1200 px, columns times 2, rows times 0.500833: 3200 x 601 px"
    );
    assert_eq!(
        said(FrameChange { scaling: Some(Scaling::Binned(7)), ..plain }),
        "1600 x 1200 px, columns 0 to 1595, rows 0 to 1196, times 1/7: 228 x 171 px"
    );
    assert!(plain.is_none() && plain.of(SIZE).unwrap().is_none());
}

/// The covariance of parameters that change by one chance number is that of what the new parameters change by.
#[test]
fn covariances_go_along() {
    for (camera, change) in all().iter().flat_map(|camera| changes().into_iter().map(move |change| (camera, change))) {
        let by = change.of(SIZE).unwrap();
        let Ok(made) = by.camera(camera) else { continue };
        let parameters = camera.parameters();
        // Those that have no place in turned images are held.
        let held = |name: &str| matches!(name, "b2" | "skew" | "tx") || (name == "b1" && matches!(camera, Camera::MicMac(_)));
        let share =
            |i: usize| if held(parameters[i].name) { 0.0 } else { 1e-7 * (1.0 + 0.1 * i as f64) * parameters[i].value.abs().max(1e-3) };
        let n = parameters.len();
        let values = (0..n * n).map(|k| share(k / n) * share(k % n)).collect();
        let stated = ParameterCovariance::new(parameters.iter().map(|p| p.name.to_owned()).collect(), values).unwrap();
        let named = NamedCamera { covariance: Some(stated), ..NamedCamera::new("", *camera) };
        let (found, _) = by.named(&named).unwrap();
        let moved: Vec<f64> = parameters.iter().enumerate().map(|(i, p)| p.value + share(i)).collect();
        let moved = by.camera(&camera.with_parameters(&moved)).unwrap();
        let change_of: Vec<(f64, f64)> =
            moved.parameters().iter().zip(made.parameters()).map(|(a, b)| (a.value - b.value, b.value)).collect();
        let q = found.covariance.unwrap();
        assert_eq!(q.parameters, made.parameters().iter().map(|p| p.name).collect::<Vec<_>>());
        for (i, (change, value)) in change_of.iter().enumerate() {
            let sigma = q.values[i * n + i].sqrt();
            // The difference of two numbers is known to their last digits.
            let tolerance = 1e-5 * change.abs() + 1e-15 * value.abs().max(1e3 * f64::from(u8::from(*value == 0.0 || value.abs() > 1e-2)));
            assert!((sigma - change.abs()).abs() <= tolerance, "{}: {sigma:e} {change:e}, {by}: {camera:?}", q.parameters[i]);
        }
    }
}

#[test]
fn poses_turn_with_the_axes_and_the_pitch_grows_with_the_pixels() {
    let camera = all()[2];
    let pose = Pose { camera_from_world: [[0.0, 1.0, 0.0], [-0.6, 0.0, 0.8], [0.8, 0.0, 0.6]], position: [1.0, 2.0, 3.0] };
    let named = NamedCamera { pose: Some(pose), pitch_um: Some(4.0), ..NamedCamera::new("a", camera) };
    let change = FrameChange { crop: CROP, scaling: Some(Scaling::Binned(2)), turn: Some(Turn::Quarter) };
    let by = change.of(SIZE).unwrap();
    let (made, dropped) = by.named(&named).unwrap();
    assert_eq!((made.pitch_um, dropped.len(), made.name.as_str()), (Some(8.0), 0, "a"));
    let image = |named: &NamedCamera, world: [f64; 3]| {
        let Pose { camera_from_world: r, position } = named.pose.unwrap();
        let [x, y, z]: [f64; 3] = std::array::from_fn(|row| (0..3).map(|k| r[row][k] * (world[k] - position[k])).sum());
        named.camera.project(Ray { x, y: -y, z: -z }).unwrap()
    };
    for world in [[1.8, 2.1, 3.7], [1.9, 1.8, 3.5], [1.7, 2.0, 3.4]] {
        let (before, after) = (image(&named, world), image(&made, world));
        assert!(after.distance(by.point(before)) < 1e-9, "{world:?}: {before:?} {after:?}");
    }
    let squeezed = FrameChange { scaling: Some(Scaling::Size(ImageSize { width: 600, height: 600 })), ..FrameChange::default() };
    let (made, dropped) = squeezed.of(SIZE).unwrap().named(&named).unwrap();
    assert!(made.pitch_um.is_none() && dropped[0].contains("the pixel pitch, 4 um"), "{dropped:?}");
}

#[test]
fn sizes_of_one_camera_are_told_apart() {
    let size = |width, height| ImageSize { width, height };
    let scale = |camera, images| match OtherSize::of(camera, images) {
        OtherSize::Scaled(by) => {
            assert_eq!((by.size(), by.resampling.offset), (images, [0.0; 2]));
            Some(by.resampling.scale[0])
        }
        _ => None,
    };
    assert_eq!(OtherSize::of(SIZE, SIZE), OtherSize::Same);
    for (camera, images, expected) in [
        (size(1600, 1200), size(800, 600), 0.5),
        (size(640, 480), size(1280, 960), 2.0),
        (size(1920, 1080), size(1280, 720), 2.0 / 3.0),
        (size(4032, 3024), size(640, 480), 10.0 / 63.0),
        // Rounded down, up, and both.
        (size(1362, 1021), size(681, 510), 0.5),
        (size(1362, 1021), size(681, 511), 0.5),
        (size(1361, 1021), size(680, 511), 0.5),
        (size(4272, 2848), size(160, 107), 160.0 / 4272.0),
    ] {
        assert_eq!(scale(camera, images), Some(expected), "{camera:?} {images:?}");
    }
    assert_eq!(OtherSize::of(size(1600, 1200), size(600, 800)), OtherSize::Turned(0.5));
    // One column more is no other scale.
    assert!(matches!(OtherSize::of(size(640, 480), size(641, 480)), OtherSize::Part(_)));
    let OtherSize::Part(parts) = OtherSize::of(size(1600, 1200), size(1280, 720)) else { panic!() };
    let crops: Vec<_> = parts.iter().map(|part| part.crop.unwrap()).collect();
    assert_eq!(crops, [Crop { x: 0, y: 150, size: size(1600, 900) }, Crop { x: 160, y: 240, size: size(1280, 720) }]);
    for part in parts {
        assert_eq!(part.of(size(1600, 1200)).unwrap().size(), size(1280, 720));
    }
}

#[test]
fn the_same_camera_is_taken_where_somebody_says_so() {
    let named = NamedCamera::new("", all()[2]);
    let half = ImageSize { width: 600, height: 450 };
    let error = same_camera(&named, half, false).unwrap_err();
    let advice = error.advice("--same-camera", "c.yaml");
    assert_eq!(
        advice,
        "is of images of 1201 x 900 px, and these have 600 x 450 px: perhaps the same camera, its images times 1/2; --same-camera takes it so"
    );
    let (taken, words) = same_camera(&named, half, true).unwrap();
    assert!(taken.camera.size() == half && words.len() == 1, "{words:?}");
    assert!(words[0].contains("1201 x 900 px") && words[0].contains("times 1/2: 600 x 450 px, the rest of 0.50 px"), "{words:?}");
    assert_eq!(same_camera(&named, SIZE, false).unwrap(), (named.clone(), Vec::new()));
    // What sizes do not settle is not taken.
    for (width, height, said) in [
        (450, 600, "`calibench convert c.yaml --size 600x450 --turn 90` (or 270)"),
        (900, 1201, "`calibench convert c.yaml --turn 90` (or 270)"),
        (1201, 676, "`calibench convert c.yaml --crop 0,112,1201,676` makes"),
        (
            800,
            450,
            "`calibench convert c.yaml --crop 0,112,1201,676 --size 800x450` or, not resampled, `calibench convert c.yaml --crop 200,225,800,450` makes",
        ),
    ] {
        let advice = same_camera(&named, ImageSize { width, height }, true).unwrap_err().advice("--same-camera", "c.yaml");
        assert!(advice.contains(said), "{advice}");
    }
    let squeezed = FrameChange { scaling: Some(Scaling::Size(ImageSize { width: 600, height: 600 })), ..FrameChange::default() };
    let error = squeezed.of(SIZE).unwrap().camera(&all()[0]).unwrap_err().to_string();
    assert!(error.contains("columns times 0.499584, rows times 2/3: `photogrammetric` has one focal length"), "{error}");
}
