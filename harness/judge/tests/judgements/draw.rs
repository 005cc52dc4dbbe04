//! Sets of photographs drawn at random, by class: lens, board, shutter, where the board was held.

use std::sync::Arc;

use calibench_judge::{Corners, Field, Material};
use calibench_measure::Board;
use calibench_model::camera::{Camera, CameraModel, ImageSize, OpenCv, OpenCvFisheye, fold};
use calibench_model::{PixelPoint, Pose};
use calibench_random::{Key, Purpose, stream};
use nalgebra::{Point3, Rotation3, Vector3};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// The lens of a class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lens {
    /// Brown's radial distortion with so many terms.
    Radial(usize),
    /// Two radial terms and decentring.
    Decentred,
    /// OpenCV's rational model.
    Rational,
    /// An equidistant lens with two terms.
    Fisheye,
}

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Nothing.
    None,
    /// The board is bent.
    Bent,
    /// Rows are exposed one after the other, by a hand that moves.
    Rolling,
}

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Class {
    pub lens: Lens,
    pub fault: Fault,
}

const fn class(lens: Lens, fault: Fault) -> Class {
    Class { lens, fault }
}

/// All classes.
pub const CLASSES: [Class; 10] = [
    class(Lens::Radial(1), Fault::None),
    class(Lens::Radial(2), Fault::None),
    class(Lens::Radial(3), Fault::None),
    class(Lens::Decentred, Fault::None),
    class(Lens::Rational, Fault::None),
    class(Lens::Fisheye, Fault::None),
    class(Lens::Decentred, Fault::Bent),
    class(Lens::Radial(3), Fault::Bent),
    class(Lens::Radial(2), Fault::Rolling),
    class(Lens::Decentred, Fault::Rolling),
];

const BOARD: Board = Board { columns: 9, rows: 6 };
const SIDE: f64 = 25.0;

/// A set and its truth.
pub struct Drawn {
    pub camera: Camera,
    pub material: Material,
}

struct Chance(ChaCha8Rng);

impl Chance {
    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    /// Between `low` and `high`, of either sign.
    fn either(&mut self, low: f64, high: f64) -> f64 {
        let value = self.within(low, high);
        if self.0.random::<bool>() { value } else { -value }
    }
}

impl Drawn {
    /// The set `number` of a class, by a seed: 6 to 40 photographs, noise of 0.03 to 0.3 px, a board of 9 x 6 corners that was held everywhere or only in
    /// the middle of the frame.
    pub fn set(class: Class, seed: u64, number: u64) -> Self {
        let scenario = format!("{class:?}");
        let mut chance = Chance(stream(Key { seed, of: &scenario, trial: number, view: "", target: "" }, Purpose::Layout));
        let size = [(640, 480), (1280, 960), (1920, 1200)][(chance.within(0.0, 3.0)) as usize];
        let size = ImageSize { width: size.0, height: size.1 };
        let sigma = 0.03 * 10.0_f64.powf(chance.within(0.0, 1.0));
        let count = (6.0 * (40.5_f64 / 6.0).powf(chance.within(0.0, 1.0))) as usize;
        let reach = chance.within(0.6, 1.0);
        let bend = match class.fault {
            Fault::Bent => [chance.either(0.3, 1.5), chance.either(0.1, 1.0), chance.either(0.0, 0.5)],
            _ => [0.0; 3],
        };
        loop {
            let camera = lens(&mut chance, class.lens, size);
            let board: Vec<Point3<f64>> = (0..BOARD.corners()).map(|corner| lifted(corner, bend)).collect();
            if let Some(seen) = views(&mut chance, &camera, &board, (count, reach), class.fault) {
                let material = material(&mut chance, size, &seen, sigma);
                return Self { camera, material };
            }
        }
    }
}

/// A corner of the bent board, mm; `bend` is `a (1 - u^2) + b (1 - v^2) + c u v`.
fn lifted(corner: usize, [a, b, c]: [f64; 3]) -> Point3<f64> {
    let (column, row) = ((corner % BOARD.columns) as f64, (corner / BOARD.columns) as f64);
    let (u, v) = (column / 4.0 - 1.0, row / 2.5 - 1.0);
    Point3::new(column * SIDE, -row * SIDE, a * (1.0 - u * u) + b * (1.0 - v * v) + c * u * v)
}

fn material(chance: &mut Chance, size: ImageSize, seen: &[Vec<PixelPoint>], sigma: f64) -> Material {
    let views: Vec<Arc<str>> = (1..=seen.len()).map(|view| format!("v{view:02}").into()).collect();
    let mut measured = |at: &PixelPoint| Some(PixelPoint::new(at.x + sigma * chance.normal(), at.y + sigma * chance.normal()));
    let at = seen.iter().map(|view| view.iter().map(&mut measured).collect()).collect();
    let operators = vec![Corners { method: "operator".into(), unavailable: None, at, rejected: Vec::new() }];
    Material { field: Field::Board { board: BOARD, side: SIDE }, size, views, missed: Vec::new(), operators }
}

fn lens(chance: &mut Chance, lens: Lens, size: ImageSize) -> Camera {
    let (w, h) = (f64::from(size.width), f64::from(size.height));
    loop {
        let (cx, cy) = (0.5 * w - 0.5 + 0.02 * w * chance.normal(), 0.5 * h - 0.5 + 0.02 * h * chance.normal());
        let camera: Camera = if lens == Lens::Fisheye {
            let f = 0.5 * w / (0.5 * chance.within(100.0, 150.0)).to_radians();
            let k = [chance.within(-0.05, 0.05), chance.within(-0.02, 0.02), 0.0, 0.0];
            OpenCvFisheye { size, fx: f, fy: f, cx, cy, skew: 0.0, k }.into()
        } else {
            let tangent = (0.5 * chance.within(35.0, 95.0)).to_radians().tan();
            let corner = tangent * (1.0 + (h / w).powi(2)).sqrt();
            let terms = distortion(chance, lens, corner);
            let f = 0.5 * w / tangent;
            let coefficients = if lens == Lens::Rational { 8 } else { 5 };
            OpenCv { size, fx: f, fy: f, cx, cy, distortion: terms, coefficients }.into()
        };
        let corners = [(0.0, 0.0), (w - 1.0, 0.0), (0.0, h - 1.0), (w - 1.0, h - 1.0)];
        if fold(&camera).is_none_or(|fold| fold.share < 0.3)
            && corners.iter().all(|&(x, y)| camera.unproject(PixelPoint::new(x, y)).is_ok())
        {
            return camera;
        }
    }
}

/// Drawn by what the terms do at the corner of the frame.
fn distortion(chance: &mut Chance, lens: Lens, corner: f64) -> [f64; 14] {
    let mut terms = [0.0; 14];
    let at = |share: f64, power: i32| share / corner.powi(power);
    terms[0] = at(chance.within(-0.25, 0.05), 2);
    let more = match lens {
        Lens::Radial(count) => count,
        Lens::Fisheye => 0,
        Lens::Decentred => 2,
        Lens::Rational => 3,
    };
    if more > 1 {
        terms[1] = at(chance.either(0.01, 0.08), 4);
    }
    if more > 2 {
        terms[4] = at(chance.either(0.005, 0.04), 6);
    }
    if matches!(lens, Lens::Decentred | Lens::Rational) {
        (terms[2], terms[3]) = (1e-3 * chance.normal(), 1e-3 * chance.normal());
    }
    if lens == Lens::Rational {
        terms[5] = at(chance.within(0.05, 0.4), 2);
        terms[6] = at(chance.either(0.01, 0.08), 4);
    }
    terms
}

/// Views in which all corners are inside the frame; `None` if that does not succeed.
fn views(
    chance: &mut Chance,
    camera: &Camera,
    board: &[Point3<f64>],
    (count, reach): (usize, f64),
    fault: Fault,
) -> Option<Vec<Vec<PixelPoint>>> {
    let ImageSize { width, height } = camera.size();
    let (w, h) = (f64::from(width), f64::from(height));
    let edge = camera.unproject(PixelPoint::new(w - 1.0, 0.5 * h)).ok()?;
    let half = edge.x.hypot(edge.y).atan2(-edge.z);
    let middle = Point3::new(4.0 * SIDE, -2.5 * SIDE, 0.0);
    let mut found = Vec::new();
    for _ in 0..400 * count {
        let (tilt, towards) = (chance.within(0.0, 0.9), chance.within(-3.2, 3.2));
        let back = Vector3::new(tilt.sin() * towards.cos(), tilt.sin() * towards.sin(), tilt.cos());
        let distance = 4.0 * SIDE / (half * chance.within(0.3, 0.8)).tan();
        let offset = half.min(1.2).tan() * distance * reach;
        let aim = middle + Vector3::new(chance.within(-offset, offset), 0.75 * chance.within(-offset, offset), 0.0);
        let roll = chance.within(-1.6, 1.6);
        let (motion, turn) = (chance.within(-2.0, 2.0), [0.003 * chance.normal(), 0.003 * chance.normal(), 0.003 * chance.normal()]);
        let Some(pose) = Pose::looking_at(middle + distance * back, aim, Vector3::y(), roll) else { continue };
        let moved = |row: f64| match fault {
            Fault::Rolling => {
                let part = row / h - 0.5;
                let turned = Rotation3::from_scaled_axis(part * Vector3::from(turn)).into_inner();
                Pose { rotation: turned * pose.rotation, centre: pose.centre + Vector3::new(0.3 * motion * part, 0.0, 0.0) }
            }
            _ => pose,
        };
        let pictured = |point: &Point3<f64>| {
            let mut at = camera.project(pose.ray(point)).ok()?;
            for _ in 0..if fault == Fault::Rolling { 3 } else { 0 } {
                at = camera.project(moved(at.y).ray(point)).ok()?;
            }
            let inside = at.x > 3.0 && at.y > 3.0 && at.x < w - 4.0 && at.y < h - 4.0;
            (inside && camera.unproject(at).is_ok()).then_some(at)
        };
        if let Some(seen) = board.iter().map(pictured).collect::<Option<Vec<_>>>() {
            found.push(seen);
        }
        if found.len() == count {
            return Some(found);
        }
    }
    None
}
