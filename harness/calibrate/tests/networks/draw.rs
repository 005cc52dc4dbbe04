//! Networks drawn at random, by class: what is photographed, from where, with which lens.

use calibench_exchange::points::parse_points;
use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv, OpenCvFisheye, fold};
use calibench_model::{ControlRow, Points, Pose};
use calibench_random::{Key, Purpose, stream};
use nalgebra::{Point3, Vector3};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;

/// What is drawn: the object, and the lens with the model that is fitted, which is the truth's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Class {
    pub object: Object,
    pub model: &'static str,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Object {
    /// A chessboard from all sides.
    Board,
    /// A chessboard, held always the same way, moved and turned in its plane alone; tilted against the image.
    Slider,
    /// Control with depth, from stations around it.
    Wall,
    /// Boards and a wall in one frame.
    Mixed,
}

/// All classes; what is drawn of them by [`Drawn::network`].
pub const CLASSES: [Class; 7] = [
    Class { object: Object::Board, model: "opencv5" },
    Class { object: Object::Slider, model: "opencv5" },
    Class { object: Object::Wall, model: "opencv5" },
    Class { object: Object::Mixed, model: "opencv5" },
    Class { object: Object::Board, model: "opencv-fisheye" },
    Class { object: Object::Wall, model: "opencv-fisheye" },
    Class { object: Object::Board, model: "opencv4" },
];

/// A network and its truth.
pub struct Drawn {
    pub camera: Camera,
    pub poses: Vec<Pose>,
    pub points: Points,
    pub control: Vec<ControlRow>,
    pub sigma: f64,
}

struct Chance(ChaCha8Rng);

impl Chance {
    fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Normal, by Box and Muller (1958).
    fn normal(&mut self) -> f64 {
        let (u, v) = (1.0 - self.unit(), self.unit());
        (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    }

    fn direction(&mut self) -> Vector3<f64> {
        Vector3::new(self.normal(), self.normal(), self.normal()).normalize()
    }
}

impl Drawn {
    /// The network `number` of a class, by a seed: 5 to 60 images, noise of 0.05 to 1 px, fields of 10 to 140 degrees across the longer side (fisheye: 100
    /// to 220).
    pub fn network(class: Class, seed: u64, number: u64) -> Self {
        let key = Key { seed, of: class.model, trial: number, view: "", target: "" };
        let mut chance = Chance(stream(key, Purpose::Layout));
        (0..class.object as u64 * 8).for_each(|_| _ = chance.unit());
        let size = [(640, 480), (1280, 1024), (1920, 1080), (4000, 3000), (2448, 2048)][(chance.unit() * 5.0) as usize];
        let size = ImageSize { width: size.0, height: size.1 };
        let fisheye = class.model == "opencv-fisheye";
        let camera = if fisheye { wide(&mut chance, size) } else { brown(&mut chance, size, class.model) };
        let sigma = 0.05 * 20.0_f64.powf(chance.unit());
        let images = 5 + (56.0 * chance.unit().powi(2)) as usize;
        let targets = targets(&mut chance, class.object);
        let poses = (0..images).map(|_| pose(&mut chance, class.object, &camera, &targets)).collect::<Vec<_>>();
        let mut text = String::from("image,target,x,y\n");
        for (image, pose) in poses.iter().enumerate() {
            for (target, object) in targets.iter().enumerate() {
                let Some(seen) = pictured(&camera, pose, object) else { continue };
                text += &format!("i{image},t{target},{},{}\n", seen[0] + sigma * chance.normal(), seen[1] + sigma * chance.normal());
            }
        }
        let row = |(target, p): (usize, &Point3<f64>)| ControlRow::new(format!("t{target}"), [p.x, p.y, p.z]);
        let control = targets.iter().enumerate().map(row).collect();
        Self { camera, poses, points: parse_points("points.csv", text.as_bytes()).unwrap().points, control, sigma }
    }
}

/// Where a point is seen: before the camera, inside the frame, and with that as its ray.
fn pictured(camera: &Camera, pose: &Pose, object: &Point3<f64>) -> Option<[f64; 2]> {
    let seen = camera.project(pose.ray(object)).ok()?;
    let ImageSize { width, height } = camera.size();
    let inside = seen.x > 0.0 && seen.y > 0.0 && seen.x < f64::from(width - 1) && seen.y < f64::from(height - 1);
    (inside && camera.unproject(seen).is_ok()).then_some([seen.x, seen.y])
}

fn centre(chance: &mut Chance, size: ImageSize) -> [f64; 2] {
    [size.width, size.height].map(|side| f64::from(side) * (0.5 + 0.04 * chance.normal().clamp(-2.0, 2.0)) - 0.5)
}

/// Brown's distortion without a fold, drawn by what it does at the corner: up to 5 % of the radius there for the narrowest fields, 45 % for the widest.
fn brown(chance: &mut Chance, size: ImageSize, model: &str) -> Camera {
    let (w, h) = (f64::from(size.width), f64::from(size.height));
    loop {
        let field = chance.within(10.0, 140.0);
        let tangent = (0.5 * field.to_radians()).tan();
        let corner = tangent * (1.0 + (h / w).powi(2)).sqrt();
        let most = 0.02 + 0.43 * field / 140.0;
        let [a, b, c] = [chance.within(-most, 0.3 * most), chance.within(-0.2, 0.4) * most, chance.within(-0.1, 0.1) * most];
        let edge = 1.0 + a * (tangent / corner).powi(2);
        let f = 0.5 * w / (tangent * edge.max(0.3));
        let mut distortion = [0.0; 14];
        let terms = [a / corner.powi(2), b / corner.powi(4), 1e-3 * chance.normal(), 1e-3 * chance.normal(), c / corner.powi(6)];
        let count = if model == "opencv4" { 4 } else { 5 };
        distortion[..count].copy_from_slice(&terms[..count]);
        let [cx, cy] = centre(chance, size);
        let fy = f * (1.0 + 0.003 * chance.normal());
        let camera: Camera = OpenCv { size, fx: f, fy, cx, cy, distortion, coefficients: if count == 4 { 4 } else { 5 } }.into();
        if fold(&camera).is_none() {
            return camera;
        }
    }
}

fn wide(chance: &mut Chance, size: ImageSize) -> Camera {
    loop {
        let field = chance.within(100.0, 220.0);
        let f = 0.5 * f64::from(size.width) / (0.5 * field.to_radians());
        let k = [0.05, 0.01, 0.004, 0.001].map(|scale| scale * chance.normal());
        let [cx, cy] = centre(chance, size);
        let fy = f * (1.0 + 0.003 * chance.normal());
        let camera: Camera = OpenCvFisheye { size, fx: f, fy, cx, cy, skew: 0.0, k }.into();
        if fold(&camera).is_none_or(|fold| fold.share < 0.3) {
            return camera;
        }
    }
}

/// In mm, about the origin.
fn targets(chance: &mut Chance, object: Object) -> Vec<Point3<f64>> {
    let (columns, rows) = (6 + (7.0 * chance.unit()) as usize, 5 + (5.0 * chance.unit()) as usize);
    let pitch = 30.0;
    let middle = [0.5 * pitch * (columns - 1) as f64, 0.5 * pitch * (rows - 1) as f64];
    let board =
        (0..columns * rows).map(|i| Point3::new(pitch * (i % columns) as f64 - middle[0], pitch * (i / columns) as f64 - middle[1], 0.0));
    let mut all: Vec<Point3<f64>> = board.collect();
    if matches!(object, Object::Wall | Object::Mixed) {
        let depth = chance.within(30.0, 150.0);
        let mut spread = |low: f64, high: f64| chance.within(low, high);
        let spatial = (0..40).map(|_| Point3::new(spread(-150.0, 150.0), spread(-110.0, 110.0), spread(-depth, depth))).collect::<Vec<_>>();
        if object == Object::Wall { all = spatial } else { all.extend(spatial) }
    }
    all
}

/// A station that sees a good part of the targets: the extent of the object fills between a third and all of the frame.
fn pose(chance: &mut Chance, object: Object, camera: &Camera, targets: &[Point3<f64>]) -> Pose {
    let extent = targets.iter().map(|target| target.coords.norm()).fold(0.0, f64::max);
    let ImageSize { width, height } = camera.size();
    let edge = calibench_model::PixelPoint::new(f64::from(width) * 0.98, 0.5 * f64::from(height));
    let half = camera.unproject(edge).map_or(1.2, |ray| ray.x.hypot(ray.y).atan2(-ray.z)).min(1.2);
    for attempt in 0.. {
        let fill = chance.within(0.4, 1.3);
        let distance = extent / (fill * half).min(1.3).tan().max(0.05) + 0.2 * extent;
        let tilt = if object == Object::Slider { Vector3::new(0.45, 0.2, 1.0) } else { chance.direction() + Vector3::new(0.0, 0.0, 1.3) };
        let from = tilt.normalize() * distance.max(if attempt > 50 { 2.0 * extent } else { 0.0 });
        let off = Vector3::new(chance.normal(), chance.normal(), 0.0) * (0.25 * extent);
        let roll = if object == Object::Slider { 0.0 } else { chance.within(-3.1, 3.1) };
        let aim = Point3::from(off);
        let Some(pose) = Pose::looking_at(aim + from, aim, Vector3::y(), roll) else { continue };
        let seen = targets.iter().filter(|target| pictured(camera, &pose, target).is_some()).count();
        if 2 * seen >= targets.len() || (attempt > 200 && seen >= 8) {
            return pose;
        }
    }
    unreachable!("some station sees enough")
}
