//! Networks with a known truth.
#![allow(dead_code)]

use calibench_adjust::{Datum, Exterior, ImageObservation, Interior, Network, ObjectPoint, Status};
use calibench_model::camera::{
    Agisoft, AgisoftVersion, Camera, CameraModel, Ebner, ImageSize, OpenCv, OpenCvFisheye, Photogrammetric, Pix4d, TangentialOrder,
};
use calibench_model::{PixelPoint, Pose};
use nalgebra::{Point3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

pub const FIVE: [&str; 9] = ["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"];

pub fn opencv() -> Camera {
    let mut distortion = [0.0; 14];
    distortion[..5].copy_from_slice(&[-0.28, 0.09, 2e-4, -3e-4, -0.012]);
    let size = ImageSize { width: 1280, height: 960 };
    OpenCv { size, fx: 1070.0, fy: 1072.0, cx: 644.3, cy: 471.8, distortion, coefficients: 5 }.into()
}

pub fn photogrammetric() -> Camera {
    let size = ImageSize { width: 3000, height: 2000 };
    let (k, p, b) = ([-1.2e-4, 1.5e-7, 0.0], [1e-5, -2e-5], [0.0; 2]);
    Photogrammetric { size, pitch_um: 7.8, c: 24.3, x0: 0.06, y0: -0.11, k, p, b }.into()
}

/// [`photogrammetric`] without distortion.
pub fn ideal() -> Camera {
    let size = ImageSize { width: 3000, height: 2000 };
    Photogrammetric { size, pitch_um: 7.8, c: 24.3, x0: 0.06, y0: -0.11, k: [0.0; 3], p: [0.0; 2], b: [0.0; 2] }.into()
}

pub fn random(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

pub fn normal(random: &mut ChaCha8Rng) -> f64 {
    random.sample(StandardNormal)
}

/// What `pose` pictures of `point` inside the frame.
pub fn seen(camera: &Camera, pose: &Pose, point: &Point3<f64>) -> Option<PixelPoint> {
    let (pixel, size) = (camera.project(pose.ray(point)).ok()?, camera.size());
    let inside = pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x <= f64::from(size.width - 1) && pixel.y <= f64::from(size.height - 1);
    inside.then_some(pixel)
}

/// Observations of all points that the images picture, without noise.
pub fn observe(network: &mut Network, sigma: f64) {
    network.observations.clear();
    for (i, image) in network.images.iter().enumerate() {
        for (k, point) in network.points.iter().enumerate() {
            if let Some(pixel) = seen(&network.cameras[image.camera].camera, &image.pose, &point.position) {
                network.observations.push(ImageObservation::new(i, k, pixel, sigma));
            }
        }
    }
}

pub fn shake_pixels(network: &mut Network, sigma: f64, random: &mut ChaCha8Rng) {
    for o in &mut network.observations {
        o.position.x += sigma * normal(random);
        o.position.y += sigma * normal(random);
    }
}

/// Start values off the truth: `shift` of centres (object units), `turn` of rotations (radians), `share` of the first parameter.
pub fn shake_poses(network: &mut Network, shift: f64, turn: f64, random: &mut ChaCha8Rng) {
    for image in &mut network.images {
        let mut three = |size: f64| Vector3::from_fn(|_, _| size * normal(random));
        image.pose.centre += three(shift);
        image.pose.rotation = *nalgebra::Rotation3::new(three(turn)).matrix() * image.pose.rotation;
    }
}

/// Views of a board of 9 x 6 corners, 25 mm apart, all inside the frame.
pub fn board(camera: Camera, views: usize, seed: u64) -> Network {
    let mut random = random(seed);
    let corner = |i: usize| Point3::new((i % 9) as f64 * 25.0, (i / 9) as f64 * 25.0, 0.0);
    let points: Vec<ObjectPoint> = (0..54).map(|i| ObjectPoint::fixed(format!("{i}"), corner(i))).collect();
    let mut images = Vec::new();
    while images.len() < views {
        let mut uniform = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
        let target = Point3::new(uniform(40.0, 160.0), uniform(20.0, 105.0), 0.0);
        let (height, east, north) = (uniform(230.0, 420.0), uniform(-230.0, 230.0), uniform(-230.0, 230.0));
        let centre = target + Vector3::new(east, north, height);
        let Some(pose) = Pose::looking_at(centre, target, Vector3::y(), uniform(-3.1, 3.1)) else { continue };
        if points.iter().all(|point| seen(&camera, &pose, &point.position).is_some()) {
            images.push(Exterior::free(format!("{}", images.len()), 0, pose));
        }
    }
    let mut network = Network { cameras: vec![Interior::fixed("camera", camera)], images, points, ..Network::default() };
    observe(&mut network, 1.0);
    network
}

/// `images` convergent, rolled images around a field of `points` points with depth, from `distance` on; all points free.
pub fn ring_from(camera: Camera, distance: f64, images: usize, points: usize, seed: u64) -> Network {
    let mut random = random(seed);
    let mut uniform = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    let points = (0..points)
        .map(|i| ObjectPoint::free(format!("P{i}"), Point3::new(uniform(-2.0, 2.0), uniform(-1.6, 1.6), uniform(-0.6, 0.6))))
        .collect();
    let exterior = |i: usize| {
        let around = i as f64 * 2.399_963;
        let tilt = 0.25 + 0.55 * ((i as f64 * 0.618_034).fract());
        let distance = distance + (i as f64 * 0.414_213).fract();
        let centre = Point3::new(tilt.sin() * around.cos(), tilt.sin() * around.sin(), tilt.cos()) * distance;
        let roll = (i % 4) as f64 * std::f64::consts::FRAC_PI_2;
        Some(Exterior::free(format!("I{i}"), 0, Pose::looking_at(centre, Point3::origin(), Vector3::y(), roll)?))
    };
    let images = (0..images).filter_map(exterior).collect();
    let mut network = Network { cameras: vec![Interior::fixed("camera", camera)], images, points, ..Network::default() };
    observe(&mut network, 1.0);
    network
}

/// A flight of 10 strips of 20 images over 100 x 50 points: about ten images see a point.
pub fn flight(camera: Camera, seed: u64) -> Network {
    block(camera, [20, 10], [100, 50], seed)
}

/// Aerial images along strips and by their number, and ground points on a grid of so many.
pub fn block(camera: Camera, [per_strip, strips]: [u32; 2], [columns, rows]: [u32; 2], seed: u64) -> Network {
    let mut random = random(seed);
    let height = 100.0;
    let mut uniform = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    // The frame on the ground is about 110 x 82 units.
    let (east, north) = (24.0, 27.0);
    let part = |i: u32, of: u32| f64::from(i) / f64::from(of - 1);
    let points = (0..columns * rows)
        .map(|i| {
            let position = Point3::new(
                part(i % columns, columns) * f64::from(per_strip - 1) * east + uniform(-2.0, 2.0),
                part(i / columns, rows) * f64::from(strips - 1) * north + uniform(-2.0, 2.0),
                uniform(-10.0, 10.0),
            );
            ObjectPoint::free(format!("P{i}"), position)
        })
        .collect();
    let mut images = Vec::new();
    for i in 0..strips * per_strip {
        let ground = Point3::new(f64::from(i % per_strip) * east, f64::from(i / per_strip) * north, 0.0);
        let centre = ground + Vector3::new(uniform(-3.0, 3.0), uniform(-3.0, 3.0), height + uniform(-5.0, 5.0));
        let roll = if i / per_strip % 2 == 0 { 0.0 } else { std::f64::consts::PI } + uniform(-0.1, 0.1);
        let target = ground + Vector3::new(uniform(-6.0, 6.0), uniform(-6.0, 6.0), 0.0);
        if let Some(pose) = Pose::looking_at(centre, target, Vector3::y(), roll) {
            images.push(Exterior::free(format!("I{i}"), 0, pose));
        }
    }
    let mut network = Network { cameras: vec![Interior::fixed("camera", camera)], images, points, ..Network::default() };
    observe(&mut network, 1.0);
    network
}

/// Makes every `step`th point weighted control.
pub fn control(network: &mut Network, step: usize, sigma: f64) {
    for point in network.points.iter_mut().step_by(step) {
        *point = ObjectPoint::observed(point.name.clone(), point.position, [sigma; 3]);
    }
    network.datum = Datum::Control;
}

/// Makes the parameters `names` of the first camera free.
pub fn free(network: &mut Network, names: &[&str]) {
    let interior = network.cameras.remove(0);
    network.cameras.insert(0, interior.free(names).expect("parameters of the camera"));
}

/// Start values off the truth, as closed forms give them.
pub fn shake_start(network: &mut Network, shift: f64, turn: f64, seed: u64) {
    let mut random = random(seed);
    shake_poses(network, shift, turn, &mut random);
    for point in &mut network.points {
        for axis in 0..3 {
            if point.coordinates[axis] != Status::Fixed {
                point.position[axis] += shift * normal(&mut random);
            }
        }
    }
    for interior in &mut network.cameras {
        let values: Vec<f64> = interior
            .camera
            .parameters()
            .iter()
            .zip(&interior.parameters)
            .map(|(p, status)| match (status, p.name) {
                (Status::Fixed, _) | (_, "cx" | "cy" | "Px" | "Py" | "x0" | "y0") => p.value,
                (_, "c" | "f" | "F" | "fx" | "fy") => 1.01 * p.value,
                _ => 0.0,
            })
            .collect();
        interior.camera = interior.camera.with_parameters(&values);
    }
}

/// Every model, as a camera of 1280 x 960 px or so, and which of its parameters a good network determines.
pub fn cameras() -> Vec<(Camera, Vec<&'static str>)> {
    let size = ImageSize { width: 1280, height: 960 };
    let base =
        Photogrammetric { size, pitch_um: 5.0, c: 5.4, x0: 0.02, y0: -0.03, k: [-3e-3, 4e-5, 0.0], p: [1e-4, -2e-4], b: [2e-4, -1e-4] };
    let mut eight = [0.0; 14];
    eight[..8].copy_from_slice(&[-0.1, 0.05, 2e-4, -3e-4, 0.01, 0.15, 0.02, 0.01]);
    let eight = OpenCv { size, fx: 1070.0, fy: 1072.0, cx: 644.3, cy: 471.8, distortion: eight, coefficients: 8 };
    let fisheye = OpenCvFisheye { size, fx: 800.0, fy: 801.0, cx: 641.0, cy: 478.0, skew: 1e-4, k: [-0.02, 0.006, -0.004, 5e-4] };
    let (k, p) = ([-0.09, 0.08, -0.01, 0.0], [1.7e-4, -8.7e-4, 0.0, 0.0]);
    let agisoft = |version, cx, cy| Agisoft { size, version, f: 1071.0, cx, cy, b1: 0.7, b2: -1.2, k, p };
    let (r, t) = ([-0.05, 0.015, -0.02], [-0.0029, 0.002]);
    let pix4d = Pix4d { size, sensor_width_mm: 6.4, f_px: 1070.0, px: 650.0, py: 470.0, r, t, order: TangentialOrder::OpenCv };
    let parameters = [1e-4, -2e-4, 1e-5, -2e-5, 3e-5, 1e-5, 2e-6, -3e-6, 1e-6, 2e-6, -1e-7, 2e-7];
    let ebner = Ebner { base: Photogrammetric { k: [0.0; 3], p: [0.0; 2], b: [0.0; 2], ..base }, b_mm: 2.4, parameters };
    let twelve = vec!["e1", "e2", "e3", "e4", "e5", "e6", "e7", "e8", "e9", "e10", "e11", "e12"];
    let old = vec!["f", "cx", "cy", "b1", "b2", "k1", "k2", "k3", "p1", "p2"];
    vec![
        (opencv(), FIVE.to_vec()),
        (eight.into(), vec!["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"]),
        (base.into(), vec!["c", "x0", "y0", "k1", "k2", "p1", "p2", "b1", "b2"]),
        (ebner.into(), twelve),
        (fisheye.into(), vec!["fx", "fy", "cx", "cy", "skew", "k1", "k2"]),
        (agisoft(AgisoftVersion::Metashape, 7.7, -6.0).into(), old.clone()),
        (agisoft(AgisoftVersion::Lens, 644.0, 470.0).into(), old),
        (pix4d.into(), vec!["F", "Px", "Py", "R1", "R2", "R3", "T1", "T2"]),
    ]
}

/// A network like Vosselman and Förstner's: 32 images of a plane field of 32 circles, tilted by 30 and 45 degrees, turned to four sides, the camera rolled
/// four times; for each tilt and roll a camera with Ebner's parameters; two horizontal and three vertical control points.
pub fn vosselman_foerstner() -> Network {
    let size = ImageSize { width: 500, height: 500 };
    let base = Photogrammetric { size, pitch_um: 27.0, c: 35.0, x0: 0.0, y0: 0.0, k: [0.0; 3], p: [0.0; 2], b: [0.0; 2] };
    let names = ["e1", "e2", "e3", "e4", "e5", "e6", "e7", "e8", "e9", "e10", "e11", "e12"];
    let circle = |i: usize| Point3::new((i % 6) as f64 * 0.25 - 0.6, (i / 6) as f64 * 0.25 - 0.6, 0.0);
    let points = (0..32).map(|i| ObjectPoint::free(format!("{i}"), circle(i))).collect();
    let mut network = Network { points, ..Network::default() };
    for group in 0..8 {
        let parameters = std::array::from_fn(|i| {
            1e-5 * ((group + i) % 5) as f64 / [1.0, 1.0, 5.0, 5.0, 5.0, 5.0, 25.0, 25.0, 25.0, 25.0, 125.0, 125.0][i]
        });
        let camera = Ebner { base, b_mm: 5.0, parameters };
        network.cameras.push(Interior::fixed(format!("group {group}"), camera).free(&names).expect("Ebner's parameters"));
        let (tilt, roll) = ([30.0_f64, 45.0][group / 4].to_radians(), (group % 4) as f64 * std::f64::consts::FRAC_PI_2);
        for side in 0..4 {
            let around = f64::from(side) * std::f64::consts::FRAC_PI_2;
            let centre = Point3::new(tilt.sin() * around.cos(), tilt.sin() * around.sin(), tilt.cos()) * 4.7;
            let pose = Pose::looking_at(centre, Point3::origin(), Vector3::new(-around.cos(), -around.sin(), 1.0), roll).expect("a pose");
            network.images.push(Exterior::free(format!("{group}.{side}"), group, pose));
        }
    }
    network.datum = Datum::Minimal { horizontal: [0, 31], vertical: [0, 5, 30] };
    observe(&mut network, 1.0);
    network
}

/// A long strip of `images` images, 70 % overlap, rolled by turns: its reduced normal equations are a band.
pub fn strip(camera: Camera, images: usize, seed: u64) -> Network {
    let mut random = random(seed);
    let mut uniform = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    let length = (images - 1) as f64 * 26.0;
    let points = (0..images * 12)
        .map(|i| {
            let along = length * (i / 4) as f64 / (3 * images - 1) as f64;
            ObjectPoint::free(
                format!("P{i}"),
                Point3::new(along + uniform(-2.0, 2.0), (i % 4) as f64 * 10.0 - 15.0 + uniform(-3.0, 3.0), uniform(0.0, 20.0)),
            )
        })
        .collect();
    let image = |i: usize| {
        let ground = Point3::new(i as f64 * 26.0, 0.0, 0.0);
        let target = ground + Vector3::new([6.0, -6.0, 0.0][i % 3], [3.0, -3.0][i % 2], 0.0);
        let pose = Pose::looking_at(ground + Vector3::new(0.0, 0.0, 100.0), target, Vector3::y(), (i % 2) as f64 * std::f64::consts::PI)?;
        Some(Exterior::free(format!("I{i}"), 0, pose))
    };
    let images = (0..images).filter_map(image).collect();
    let mut network = Network { cameras: vec![Interior::fixed("camera", camera)], images, points, ..Network::default() };
    observe(&mut network, 1.0);
    network
}

/// [`ring_from`] a distance at which all points are in the frame.
pub fn ring(camera: Camera, images: usize, points: usize, seed: u64) -> Network {
    ring_from(camera, 7.0, images, points, seed)
}
