//! Every observation equation against differences.

use calibench_model::camera::{
    Agisoft, AgisoftVersion, Camera, Ebner, ImageSize, OpenCv, OpenCvFisheye, Photogrammetric, Pix4d, TangentialOrder,
};
use calibench_model::{Covariance, PixelPoint, Pose};
use nalgebra::{Point3, Rotation3, Vector3};

use super::{Loss, Normals, Rows, Scratch, linearise};
use crate::network::{Attitude, Centre, Exterior, ImageObservation, Interior, Layout, Network, ObjectPoint, Precision, Status};
use crate::state::{State, Step};

fn cameras() -> Vec<Camera> {
    let size = ImageSize { width: 1280, height: 960 };
    let base =
        Photogrammetric { size, pitch_um: 5.0, c: 5.4, x0: 0.02, y0: -0.03, k: [-3e-3, 4e-5, 1e-7], p: [1e-4, -2e-4], b: [2e-4, -1e-4] };
    let parameters = [1e-4, -2e-4, 1e-5, -2e-5, 3e-5, 1e-5, 2e-6, -3e-6, 1e-6, 2e-6, -1e-7, 2e-7];
    let opencv = |distortion: &[f64]| {
        let mut all = [0.0; 14];
        all[..distortion.len()].copy_from_slice(distortion);
        Camera::from(OpenCv { size, fx: 1070.0, fy: 1072.0, cx: 644.3, cy: 471.8, distortion: all, coefficients: distortion.len() })
    };
    let (k, p) = ([-0.09, 0.08, -0.01, 0.002], [1.7e-4, -8.7e-4, 0.1, -0.2]);
    let agisoft = |version, cx, cy| Camera::from(Agisoft { size, version, f: 1071.0, cx, cy, b1: 0.7, b2: -1.2, k, p });
    let (r, t) = ([-0.05, 0.015, -0.02], [-0.0029, 0.002]);
    let all = [-0.1, 0.05, 2e-4, -3e-4, 0.01, 0.15, 0.02, 0.01, 1e-4, 2e-4, -1e-4, 3e-4, 0.01, -0.02];
    let mut cameras: Vec<Camera> = [4, 5, 8, 12, 14].into_iter().map(|n| opencv(&all[..n])).collect();
    cameras.push(base.into());
    cameras.push(Ebner { base, b_mm: 2.4, parameters }.into());
    cameras.push(OpenCvFisheye { size, fx: 800.0, fy: 801.0, cx: 641.0, cy: 478.0, skew: 1e-3, k: [-0.02, 0.006, -0.004, 5e-4] }.into());
    cameras.push(agisoft(AgisoftVersion::Metashape, 7.7, -6.0));
    cameras.push(agisoft(AgisoftVersion::PhotoScan, 644.0, 470.0));
    cameras.push(Pix4d { size, sensor_width_mm: 6.4, f_px: 1070.0, px: 650.0, py: 470.0, r, t, order: TangentialOrder::OpenCv }.into());
    cameras
}

/// One image of eleven points (a block of eight and a part of one), all observed as far as can be, nothing at its observed value.
fn network(camera: Camera) -> Network {
    let mut interior = Interior::fixed("camera", camera);
    interior.parameters.fill(Status::Free);
    interior.parameters[0] = Status::Observed { value: 5.0, sigma: 3.0 };
    let pose = Pose::from_angles(Point3::new(0.4, -0.3, 6.0), [0.1, -0.15, 0.7]);
    let turned = *Rotation3::new(Vector3::new(0.2, -0.1, 0.3)).matrix() * pose.rotation;
    let image = Exterior {
        centre: Centre::Observed { value: Point3::new(0.5, -0.2, 6.1), sigma: [0.1, 0.2, 0.3] },
        attitude: Attitude::Observed { value: turned, sigma: [0.1, 0.2, 0.3] },
        ..Exterior::free("image", 0, pose)
    };
    let at = |i: usize| Point3::new((i % 4) as f64 - 1.5, (i / 4) as f64 - 1.0, 0.2 * (i % 3) as f64);
    let mut points: Vec<ObjectPoint> = (0..11).map(|i| ObjectPoint::free(format!("{i}"), at(i))).collect();
    points[2] = ObjectPoint::observed("2", at(2), [0.1, 0.2, 0.3]);
    points[2].position.x += 0.05;
    let precision = Precision::Covariance(Covariance { sxx: 0.5, sxy: 0.2, syy: 0.8 });
    let measured = |point: usize| ImageObservation {
        image: 0,
        point,
        position: PixelPoint::new(640.0 + point as f64, 480.0),
        precision,
        behind: false,
    };
    Network { cameras: vec![interior], images: vec![image], observations: (0..11).map(measured).collect(), points, ..Network::default() }
}

/// A step of one unknown, counted over parameters, the pose and the points.
fn unit(layout: &Layout, k: usize, h: f64) -> Step {
    let mut step = Step::zero(layout.width, 1, layout.triple_free.len());
    match k.checked_sub(layout.width) {
        None => step.cameras[k] = h,
        Some(k @ 0..6) => step.poses[0][k] = h,
        Some(k) => step.points[(k - 6) / 3][(k - 6) % 3] = h,
    }
    step
}

fn normals(network: &Network, layout: &Layout, state: &State) -> Normals {
    let mut normals = Normals::default();
    linearise(network, layout, state, Loss::Squares, &mut Scratch::default(), &mut normals).unwrap();
    normals
}

/// Steps of a difference of fourth order, and the difference.
const STEPS: [f64; 4] = [2.0, 1.0, -1.0, -2.0];
fn difference([a, b, c, d]: [f64; 4], h: f64) -> f64 {
    (8.0 * (b - c) - (a - d)) / (12.0 * h)
}

#[test]
fn image_coordinates_by_every_unknown_of_every_model() {
    for camera in cameras() {
        let network = network(camera);
        let (layout, state) = (Layout::new(&network, &[], &[]).unwrap(), State::of(&network));
        let mut rows = Rows::default();
        rows.fill((&network, &layout), &state, Loss::Squares, (0, &[]), 0..layout.sights.len(), &mut Scratch::default()).unwrap();
        for k in 0..layout.width + 6 + 33 {
            // The column of point `own` of each row; other points do nothing.
            let of = |sight: usize| match k.checked_sub(layout.width + 6) {
                None => rows.of(sight)[k],
                Some(k) if k / 3 == sight => rows.of(sight)[layout.width + 6 + k % 3],
                Some(_) => [0.0; 2],
            };
            let size = (0..11).map(|sight| of(sight)[0].hypot(of(sight)[1])).fold(0.0, f64::max);
            let h = 0.01 / size.max(1.0);
            let moved = STEPS.map(|step| normals(&network, &layout, &state.moved(&layout, &unit(&layout, k, step * h))).residuals);
            for (sight, place) in layout.sights.iter().enumerate() {
                let [a, b, c] = place.observed(&network.observations).precision.whitening();
                let white = |v: [f64; 2]| [a * v[0], b * v[0] + c * v[1]];
                for axis in 0..2 {
                    let expected = difference([0, 1, 2, 3].map(|i| white(moved[i][sight].px)[axis]), h);
                    let found = of(sight)[axis];
                    assert!((found - expected).abs() < 1e-7 * size.max(1.0), "{camera:?}: unknown {k}, point {sight}: {found} {expected}");
                }
            }
        }
    }
}

#[test]
fn the_right_side_is_the_slope_of_the_sum_of_squares_of_all_observations() {
    for camera in cameras() {
        let network = network(camera);
        let (layout, state) = (Layout::new(&network, &[], &[]).unwrap(), State::of(&network));
        let here = normals(&network, &layout, &state);
        for k in 0..layout.width + 6 + 33 {
            let slope = -2.0 * here.along(&unit(&layout, k, 1.0));
            let curvature = match k.checked_sub(layout.width) {
                None => here.camera[0][k * (layout.width + 1)],
                Some(k @ 0..6) => here.pose[0][7 * k],
                Some(k) => here.point[(k - 6) / 3][4 * ((k - 6) % 3)],
            };
            let h = 0.01 / curvature.sqrt().max(1.0);
            let cost = |step: f64| normals(&network, &layout, &state.moved(&layout, &unit(&layout, k, step * h))).cost;
            let expected = difference(STEPS.map(cost), h);
            assert!((slope - expected).abs() < 1e-6 * here.cost.sqrt() * curvature.sqrt().max(1.0), "{camera:?}: {k}: {slope} {expected}");
        }
    }
}
