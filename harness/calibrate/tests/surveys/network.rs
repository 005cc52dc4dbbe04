//! Networks with a known truth: targets, stations and a camera, projected by the model itself.

use calibench_calibrate::{Calibration, CalibrationError, Optics, Prepared, Settings, prepare};
use calibench_exchange::control::parse_control;
use calibench_exchange::points::parse_points;
use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv};
use calibench_model::{ControlRow, Points, Pose};
use nalgebra::{Point3, Vector3};

pub const SIZE: ImageSize = ImageSize { width: 1600, height: 1200 };

/// What is pictured, from where.
pub struct Scene {
    pub camera: Camera,
    pub poses: Vec<Pose>,
    pub targets: Vec<Point3<f64>>,
    /// How many of the targets, the first ones, are control.
    pub control: usize,
    /// Of the noise of an image coordinate, px.
    pub sigma: f64,
    /// Of the same.
    pub seed: u64,
}

/// A lens with distortion.
pub fn lens() -> Camera {
    let mut distortion = [0.0; 14];
    distortion[..5].copy_from_slice(&[-0.11, 0.07, 4e-4, -6e-4, -0.012]);
    OpenCv { size: SIZE, fx: 1450.0, fy: 1446.0, cx: 812.0, cy: 590.0, distortion, coefficients: 5 }.into()
}

/// A board of 9 x 7 corners, 30 mm apart, from six sides.
pub fn board(camera: Camera) -> Scene {
    let targets = (0..63).map(|i| Point3::new(30.0 * f64::from(i % 9), 30.0 * f64::from(i / 9), 0.0)).collect();
    let middle = Point3::new(120.0, 90.0, 0.0);
    let sides = [(0.0, 0.0), (250.0, 40.0), (-220.0, 90.0), (30.0, 240.0), (-60.0, -230.0), (180.0, -190.0), (10.0, 5.0)];
    let station = |(i, (x, y)): (usize, (f64, f64))| {
        Pose::looking_at(middle + Vector3::new(x, y, 330.0 + 12.0 * i as f64), middle, Vector3::y(), 0.8 * i as f64).unwrap()
    };
    Scene { camera, poses: sides.into_iter().enumerate().map(station).collect(), targets, control: 63, sigma: 0.0, seed: 7 }
}

/// A wall with depth: 48 targets, mm, from five stations.
pub fn wall(camera: Camera) -> Scene {
    let target = |i: u32| Point3::new(400.0 * f64::from(i % 8), 400.0 * f64::from(i / 8), 300.0 * f64::from(i * 7 % 5));
    let middle = Point3::new(1400.0, 1000.0, 500.0);
    let station = |i: usize| {
        let centre = middle + Vector3::new(900.0 * (i as f64 - 2.0), 500.0 * (i as f64 * 2.4).sin(), 4200.0 - 150.0 * i as f64);
        Pose::looking_at(centre, middle, Vector3::y(), 1.3 * i as f64).unwrap()
    };
    Scene { camera, poses: (0..5).map(station).collect(), targets: (0..48).map(target).collect(), control: 48, sigma: 0.0, seed: 7 }
}

/// Normal noise from sums of uniform numbers of a linear congruence (Knuth): small, and the same everywhere.
pub fn noise(state: &mut u64) -> f64 {
    let mut uniform = || {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..12).map(|_| uniform()).sum::<f64>() - 6.0
}

impl Scene {
    /// The image points inside the frame, `image_I.png` of target `tT`.
    pub fn points(&self) -> Points {
        let (mut text, mut state) = (String::from("image,target,x,y\n"), self.seed);
        for (image, pose) in self.poses.iter().enumerate() {
            for (target, position) in self.targets.iter().enumerate() {
                let Ok(seen) = self.camera.project(pose.ray(position)) else { continue };
                let (x, y) = (seen.x + self.sigma * noise(&mut state), seen.y + self.sigma * noise(&mut state));
                if (0.0..f64::from(SIZE.width - 1)).contains(&x) && (0.0..f64::from(SIZE.height - 1)).contains(&y) {
                    text += &format!("image_{image}.png,t{target},{x},{y}\n");
                }
            }
        }
        parse_points("points.csv", text.as_bytes()).unwrap().points
    }

    pub fn known(&self) -> Vec<ControlRow> {
        let row = |(target, p): (usize, &Point3<f64>)| format!("t{target},{},{},{}\n", p.x, p.y, p.z);
        let rows: String = self.targets[..self.control].iter().enumerate().map(row).collect();
        parse_control("control.csv", format!("target,X,Y,Z\n{rows}").as_bytes()).unwrap()
    }

    pub fn prepared(&self, settings: &Settings) -> Result<Prepared, CalibrationError> {
        prepare(self.points(), &self.known(), settings)
    }
}

/// One camera of a model.
pub fn optics(model: &str) -> Optics {
    Optics { model: Some(model.into()), pitch_um: Some(5.0), ..Optics::new(SIZE) }
}

pub fn settings(model: &str) -> Settings {
    Settings::new(vec![optics(model)])
}

/// Parameters of a calibrated camera against those of the truth, relative to its focal length.
pub fn agrees(found: &Calibration<'_>, truth: &Camera, within: f64) {
    let (found, truth) = (found.camera(0).parameters(), truth.parameters());
    let focal = truth[0].value;
    for (found, truth) in found.iter().zip(&truth) {
        assert_eq!(found.name, truth.name);
        let scale = if truth.value.abs() > 10.0 { focal } else { 1.0 };
        assert!((found.value - truth.value).abs() < within * scale, "{}: {} for {}", found.name, found.value, truth.value);
    }
}
