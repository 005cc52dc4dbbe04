//! Data with gross errors, and data that break what a calibration assumes, drawn anew with each seed: twenty photographs of a board of eighty corners.

use calibench_calibrate::{BoardShape, CalibrationError, GrossErrors, Risk, Settings, calibrate, prepare};
use calibench_model::camera::{Camera, CameraModel, OpenCv, OpenCvFisheye};
use calibench_model::convert::{DifferenceOptions, difference};
use calibench_model::{PixelPoint, Points, Pose};
use nalgebra::{Point3, Rotation3, Vector3};

use crate::network::{SIZE, Scene, lens, settings};
use crate::planted::Input;

/// Standard deviation of an image coordinate, px.
const SIGMA: f64 = 0.1;
const COLUMNS: usize = 10;
const ROWS: usize = 8;
const IMAGES: usize = 20;
/// Of squares, mm.
const STEP: f64 = 25.0;

/// A kind of data: its name, and that of a seed with the camera that took them.
pub type Kind = (&'static str, fn(u64) -> (Input, Camera));

/// Gross errors, and none.
pub const GROSS: [Kind; 9] = [
    ("none", |seed| spoilt(seed, |_, _, _| None)),
    ("2 % of the points", |seed| spoilt(seed, |_, _, chance| share(chance, 0.02))),
    ("10 % of the points", |seed| spoilt(seed, |_, _, chance| share(chance, 0.1))),
    ("30 % of the points", |seed| spoilt(seed, |_, _, chance| share(chance, 0.3))),
    ("40 % of the points at the border", |seed| spoilt(seed, |_, at, chance| share(chance, 0.4).filter(|_| is_at_border(at)))),
    ("10 % of the points, anywhere", |seed| spoilt(seed, |_, at, chance| share(chance, 0.1).map(|_| anywhere(chance, at)))),
    ("one point", |seed| spoilt(seed, |[image, target], _, chance| (image == 3 && target == 25).then(|| off(chance)))),
    ("all points of an image", |seed| spoilt(seed, |[image, _], _, chance| (image == 3).then(|| off(chance)))),
    ("names exchanged in six images", exchanged),
];

/// Assumptions that do not hold by little: the cameras are about as good as they say.
pub const STRAINED: [Kind; 2] =
    [("rolling shutter, 2 mrad", |seed| rolling(seed, 2e-3)), ("two cameras mixed, every fifth", |seed| mixed(seed, 5))];

/// Assumptions that do not hold.
pub const BROKEN: [Kind; 9] = [
    ("a board bent by 1 mm, held flat", |seed| bent(seed, 1.0, BoardShape::Flat)),
    ("a board bent by .3 mm, held flat", |seed| bent(seed, 0.3, BoardShape::Flat)),
    ("rolling shutter, 10 mrad", |seed| rolling(seed, 1e-2)),
    ("two cameras mixed, half and half", |seed| mixed(seed, 2)),
    ("a fisheye of 120 degrees as a pinhole", |seed| fisheye(seed, 120.0)),
    ("a fisheye of 160 degrees as a pinhole", |seed| fisheye(seed, 160.0)),
    ("names of two control points exchanged", misnamed),
    ("a board bent by 1 mm, held flat, and 2 % of the points", |seed| and_gross(bent(seed, 1.0, BoardShape::Flat), seed)),
    ("rolling shutter, 10 mrad, and 2 % of the points", |seed| and_gross(rolling(seed, 1e-2), seed)),
];

/// Random numbers of a seed (Knuth's congruence).
pub struct Chance(u64);

impl Chance {
    fn of(seed: u64) -> Self {
        let mut chance = Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x5DEE_CE66);
        (0..4).for_each(|_| _ = chance.unit());
        chance
    }

    /// From 0 to 1.
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

/// A shift of 3 to 30 px, anywhere.
fn off(chance: &mut Chance) -> [f64; 2] {
    let (length, angle) = (chance.within(3.0, 30.0), chance.within(0.0, std::f64::consts::TAU));
    [length * angle.cos(), length * angle.sin()]
}

fn share(chance: &mut Chance, share: f64) -> Option<[f64; 2]> {
    let (chosen, off) = (chance.unit() < share, off(chance));
    chosen.then_some(off)
}

/// Whether a place is in the outer seventh of the frame.
fn is_at_border(at: PixelPoint) -> bool {
    let [x, y] = [(at.x, SIZE.width), (at.y, SIZE.height)].map(|(at, length)| (at / f64::from(length - 1) - 0.5).abs());
    x.max(y) > 0.36
}

/// A shift to anywhere in the frame.
fn anywhere(chance: &mut Chance, from: PixelPoint) -> [f64; 2] {
    [chance.within(0.0, f64::from(SIZE.width - 1)) - from.x, chance.within(0.0, f64::from(SIZE.height - 1)) - from.y]
}

fn corner(k: usize) -> Point3<f64> {
    Point3::new(STEP * (k % COLUMNS) as f64, STEP * (k / COLUMNS) as f64, 0.0)
}

/// Stations from which all corners are seen, tilted by up to 40 degrees, the board anywhere in the frame.
fn scene(camera: Camera, seed: u64) -> Scene {
    let mut chance = Chance::of(seed);
    let targets: Vec<Point3<f64>> = (0..COLUMNS * ROWS).map(corner).collect();
    let middle = Point3::new(0.5 * STEP * (COLUMNS - 1) as f64, 0.5 * STEP * (ROWS - 1) as f64, 0.0);
    let inside = |pose: &Pose| {
        targets.iter().all(|target| {
            camera.project(pose.ray(target)).is_ok_and(|at| {
                (2.0..f64::from(SIZE.width) - 3.0).contains(&at.x)
                    && (2.0..f64::from(SIZE.height) - 3.0).contains(&at.y)
                    && camera.unproject(at).is_ok_and(|ray| {
                        let seen = pose.ray(target);
                        (ray.x * seen.z - ray.z * seen.x).abs() < 1e-3 * seen.z.abs()
                    })
            })
        })
    };
    // As near as fills a good part of the frame.
    let edge = camera.unproject(PixelPoint::new(0.9 * f64::from(SIZE.width), 0.5 * f64::from(SIZE.height))).unwrap();
    let half = edge.x.hypot(edge.y).atan2(-edge.z).min(1.0);
    let mut poses = Vec::new();
    while poses.len() < IMAGES {
        let (tilt, around) = (chance.within(0.0, 0.7), chance.within(0.0, std::f64::consts::TAU));
        let distance = chance.within(1.0, 1.8) * middle.coords.norm() / half.tan() + 40.0;
        let from = Vector3::new(tilt.sin() * around.cos(), tilt.sin() * around.sin(), tilt.cos()) * distance;
        let aside = Vector3::new(chance.within(-1.0, 1.0), chance.within(-1.0, 1.0), 0.0) * (0.45 * distance * half.tan());
        let aim = middle + aside;
        let pose = Pose::looking_at(aim + from, aim, Vector3::y(), chance.within(-3.1, 3.1));
        poses.extend(pose.filter(inside));
    }
    Scene { camera, poses, control: targets.len(), targets, sigma: SIGMA, seed: 1 + 1_000_003 * seed }
}

/// The points with others' places, by number of image and target.
fn moved(points: &Points, mut to: impl FnMut(usize, usize, PixelPoint) -> PixelPoint) -> Points {
    let mut changed = Points::default();
    for mut row in points.rows() {
        let image = row.image.trim_start_matches("image_").trim_end_matches(".png").parse().unwrap();
        let target = row.target[1..].parse().unwrap();
        row.start.position = to(image, target, row.start.position);
        changed.push(row.image, row.target, row.start);
    }
    changed
}

fn usual() -> Settings {
    Settings { shape: BoardShape::Tested, ..settings("opencv5") }
}

/// Shifts of image points: of a point's image and target, and its place.
type Shifts = fn([usize; 2], PixelPoint, &mut Chance) -> Option<[f64; 2]>;

fn shifted(points: &Points, seed: u64, by: Shifts) -> Points {
    let mut chance = Chance::of(seed + 77);
    moved(points, |image, target, at| {
        let [x, y] = by([image, target], at, &mut chance).unwrap_or_default();
        PixelPoint::new(at.x + x, at.y + y)
    })
}

fn spoilt(seed: u64, by: Shifts) -> (Input, Camera) {
    let scene = scene(lens(), seed);
    ((shifted(&scene.points(), seed, by), scene.known(), usual()), lens())
}

/// The same with gross errors beside.
fn and_gross(((points, control, settings), camera): (Input, Camera), seed: u64) -> (Input, Camera) {
    ((shifted(&points, seed, |_, _, chance| share(chance, 0.02)), control, settings), camera)
}

/// Two corners beside one another have each other's coordinates.
fn misnamed(seed: u64) -> (Input, Camera) {
    let ((points, mut control, settings), camera) = spoilt(seed, |_, _, _| None);
    let one = (seed as usize * 7) % (COLUMNS * ROWS - 1);
    let [a, b] = [control[one].position, control[one + 1].position];
    (control[one].position, control[one + 1].position) = (b, a);
    ((points, control, settings), camera)
}

/// The names of two corners beside one another exchanged in each of six images, of two far apart in two of them.
fn exchanged(seed: u64) -> (Input, Camera) {
    let (scene, mut chance) = (scene(lens(), seed), Chance::of(seed + 77));
    let points = scene.points();
    let pairs: Vec<[usize; 2]> = (0..6)
        .map(|k| {
            let one = (chance.unit() * (COLUMNS * ROWS) as f64) as usize;
            [one, (one + if k < 4 { 1 } else { 33 }) % (COLUMNS * ROWS)]
        })
        .collect();
    let at = |image: usize, target: usize| {
        let found = points.rows().find(|row| row.image == format!("image_{image}.png") && row.target == format!("t{target}"));
        found.unwrap().start.position
    };
    let swapped = moved(&points, |image, target, own| match pairs.get(image) {
        Some([a, b]) if *a == target => at(image, *b),
        Some([a, b]) if *b == target => at(image, *a),
        _ => own,
    });
    ((swapped, scene.known(), usual()), lens())
}

fn bent(seed: u64, by: f64, shape: BoardShape) -> (Input, Camera) {
    let flat = scene(lens(), seed);
    let bend = |at: &Point3<f64>| {
        let [u, v] = [(at.x, COLUMNS), (at.y, ROWS)].map(|(at, count)| 2.0 * at / (STEP * (count - 1) as f64) - 1.0);
        at + Vector3::z() * by * (1.0 - u * u + 0.5 * (1.0 - v * v))
    };
    let known = flat.known();
    let bent = Scene { targets: flat.targets.iter().map(bend).collect(), ..flat };
    ((bent.points(), known, Settings { shape, ..usual() }), lens())
}

/// Rows are exposed one after the other while the camera turns, by `turn` rad or less from the first row to the last, in every image otherwise.
fn rolling(seed: u64, turn: f64) -> (Input, Camera) {
    let still = scene(lens(), seed);
    let mut chance = Chance::of(seed + 78);
    let axes: Vec<Vector3<f64>> =
        still.poses.iter().map(|_| Vector3::new(chance.within(-1.0, 1.0), chance.within(-1.0, 1.0), chance.within(-0.3, 0.3))).collect();
    let points = moved(&still.points(), |image, target, at| {
        let (pose, place) = (&still.poses[image], &still.targets[target]);
        let still_at = still.camera.project(pose.ray(place)).unwrap();
        let mut seen = still_at;
        // The row in which it is seen tells when.
        for _ in 0..4 {
            let part = seen.y / f64::from(SIZE.height) - 0.5;
            let rotation = Rotation3::from_scaled_axis(part * turn * axes[image]).into_inner() * pose.rotation;
            seen = still.camera.project(Pose { rotation, ..*pose }.ray(place)).unwrap();
        }
        PixelPoint::new(at.x + seen.x - still_at.x, at.y + seen.y - still_at.y)
    });
    ((points, still.known(), usual()), lens())
}

/// Every image of so many is another camera's, of the same make: its focal length is up to 5 % another, its principal point up to 30 px, its distortion a fifth.
fn mixed(seed: u64, every: usize) -> (Input, Camera) {
    let one = scene(lens(), seed);
    let mut chance = Chance::of(seed + 79);
    let Camera::OpenCv(first) = lens() else { panic!("OpenCV's model") };
    let mut distortion = first.distortion;
    distortion.iter_mut().for_each(|k| *k *= 1.2);
    let f = 1.0 + chance.within(0.015, 0.05);
    let second: Camera = OpenCv {
        fx: f * first.fx,
        fy: f * first.fy,
        cx: first.cx - 30.0 * chance.unit(),
        cy: first.cy + 20.0 * chance.unit(),
        distortion,
        ..first
    }
    .into();
    let points = moved(&one.points(), |image, target, at| {
        if image % every > 0 {
            return at;
        }
        let ray = one.poses[image].ray(&one.targets[target]);
        let (a, b) = (one.camera.project(ray).unwrap(), second.project(ray).unwrap());
        PixelPoint::new(at.x + b.x - a.x, at.y + b.y - a.y)
    });
    ((points, one.known(), usual()), lens())
}

/// An equidistant lens of so many degrees across its frame.
fn fisheye(seed: u64, field: f64) -> (Input, Camera) {
    let f = 0.5 * f64::from(SIZE.width) / (0.5 * field).to_radians();
    let k = [0.02, -0.01, 0.003, 0.0];
    let camera: Camera = OpenCvFisheye { size: SIZE, fx: f, fy: f, cx: 793.0, cy: 606.0, skew: 0.0, k }.into();
    let one = scene(camera, seed);
    ((one.points(), one.known(), usual()), camera)
}

/// A lens that bends its border beyond what the model asked for pictures: a few corners of a few images are off by some standard deviations, the others hardly.
pub fn poor(seed: u64, k3: f64) -> (Input, Camera) {
    let Camera::OpenCv(usual) = lens() else { panic!("OpenCV's model") };
    let mut distortion = usual.distortion;
    distortion[..5].copy_from_slice(&[-0.2, 0.15, 4e-4, -6e-4, k3]);
    let camera: Camera = OpenCv { fx: 1330.0, fy: 1328.0, distortion, ..usual }.into();
    let one = Scene { sigma: 0.03, ..scene(camera, seed) };
    ((one.points(), one.known(), Settings { shape: BoardShape::Tested, ..settings("opencv4") }), camera)
}

/// What a calibration gives.
#[derive(Clone, Debug)]
pub struct Given {
    /// How far the camera is off over the frame, px (RMS after the best rotation); infinite where it cannot be compared.
    pub off_px: f64,
    /// What it states of that, px.
    pub stated_px: f64,
    pub left_out: usize,
    pub doubts: Vec<String>,
}

impl Given {
    /// Farther off than five of its stated standard deviations and 1 px, without a word.
    pub fn is_silent(&self) -> bool {
        self.doubts.is_empty() && self.off_px > 1.0 && self.off_px > 5.0 * self.stated_px
    }
}

/// The same without the image points that are elsewhere than in `sound`, which has the same ones in the same order; and how many these are.
pub fn without_gross((points, control, settings): &Input, sound: &Points) -> (Input, usize) {
    let mut right = Points::default();
    for (row, sound) in points.rows().zip(sound.rows()).filter(|(row, sound)| row.start.position == sound.start.position) {
        assert_eq!((row.image, row.target), (sound.image, sound.target));
        right.push(row.image, row.target, row.start);
    }
    let wrong = points.len() - right.len();
    ((right, control.clone(), settings.clone()), wrong)
}

/// The same with other settings.
pub fn with(input: &Input, gross: GrossErrors) -> Input {
    let (points, control, settings) = input.clone();
    (points, control, Settings { gross, ..settings })
}

pub const SNOOPED: GrossErrors = GrossErrors::Rejected(Risk::EachPoint);

pub fn given((points, control, settings): &Input, truth: &Camera) -> Result<Given, CalibrationError> {
    let prepared = prepare(points.clone(), control, settings)?;
    calibrate(&prepared, &[], |calibration| Given {
        off_px: difference(truth, calibration.camera(0), &DifferenceOptions::default()).map_or(f64::INFINITY, |found| found.spread.rms_px),
        stated_px: calibration.over_frame[0].map_or(f64::INFINITY, |known| known.px()),
        left_out: calibration.found.iter().filter(|found| found.left_out).count(),
        doubts: calibration.doubts().into_iter().map(|doubt| doubt.words).collect(),
    })
}
