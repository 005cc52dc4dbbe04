//! A board before a wide lens: drawn with sides that bend, and where its corners are.

use std::f64::consts::{PI, TAU};

use calibench_model::boards::{Board, Chessboard, Layout};
use calibench_model::camera::ImageSize;
use calibench_model::testfield::PlatePoint;
use calibench_model::{Image, PixelPoint};

use super::lens::{Camera, Lens};
use crate::picture::{Fine, blurred, noisy};

/// Points along a side of a square.
const ALONG: usize = 12;
/// Of a square the shortest side, px: what is drawn has no smaller ones.
pub const LEAST_SIDE: f64 = 6.0;

/// Numbers between 0 and 1, from a seed.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        let mut random = Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x2545_f491_4f6c_dd1d);
        for _ in 0..8 {
            random.next();
        }
        random
    }

    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f64 / f64::from(1_u32 << 24)
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }
}

/// A board before a camera.
#[derive(Clone, Debug)]
pub struct Scene {
    pub camera: Camera,
    pub columns: usize,
    pub rows: usize,
    pub layout: Layout,
    /// The middle of the board and the directions of its axes (u, v) before the camera.
    middle: [f64; 3],
    axes: [[f64; 3]; 2],
    pub blur: f64,
    pub noise: f64,
    seed: u64,
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = a.iter().map(|part| part * part).sum::<f64>().sqrt();
    a.map(|part| part / length)
}

/// `a cos + b sin`, each part.
fn turned(a: [f64; 3], b: [f64; 3], angle: f64) -> [f64; 3] {
    let (sine, cosine) = angle.sin_cos();
    std::array::from_fn(|k| cosine * a[k] + sine * b[k])
}

impl Scene {
    /// The scene of a seed, with a field of `field` degrees: a board that is seen whole, with squares of [`LEAST_SIDE`] and more.
    pub fn of(seed: u64, field: [f64; 2]) -> Self {
        let mut random = Random::new(seed);
        loop {
            if let Some(scene) = Self::drawn(&mut random, field, seed) {
                return scene;
            }
        }
    }

    fn drawn(random: &mut Random, [least, most]: [f64; 2], seed: u64) -> Option<Self> {
        let lens = match random.below(6) {
            0 => Lens::Equidistant,
            1 => Lens::Equisolid,
            2 => Lens::Stereographic,
            3 => Lens::Polynomial(random.between(-0.06, 0.03)),
            _ => Lens::Mei(random.between(0.6, 2.2)),
        };
        let half_field = 0.5 * random.between(least, most).to_radians();
        let [width, height] = [[640, 480], [752, 480], [1280, 960], [1032, 778]][random.below(4)];
        let [inner, outer] = [0.5 * height as f64, 0.5 * (width as f64).hypot(height as f64)];
        let camera = Camera { lens, width, height, half_field, radius: random.between(0.9 * inner, outer) };
        let (columns, rows) = (4 + random.below(8), 3 + random.below(6));
        let layout = Board::Chessboard(Chessboard { columns, rows, square: 1.0 }).layout().ok()?;
        // Where the board is, how far it is turned away from the line of sight, and in its plane.
        let (off, around) = (half_field * random.between(0.0, 0.9), random.between(0.0, TAU));
        let sight = [off.sin() * around.cos(), off.sin() * around.sin(), off.cos()];
        let beside = unit(cross(sight, if sight[0].abs() < 0.7 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] }));
        let below = cross(sight, beside);
        let about = random.between(0.0, TAU);
        let (p, q) = (turned(beside, below, about), turned(beside, below, about + 0.5 * PI));
        let tilt = random.between(0.0, 60.0_f64.to_radians());
        let (p, q) = (p, turned(q, sight, tilt));
        let turn = random.between(0.0, TAU);
        let half = 0.5 * (columns as f64 + 1.0).hypot(rows as f64 + 1.0);
        let far = half / random.between(10.0_f64, 65.0).to_radians().tan();
        let (u, down) = (turned(p, q, turn), turned(p, q, turn + 0.5 * PI));
        let [blur, noise] = [random.between(0.5, 2.5), random.between(0.0, 0.05)];
        let axes = [u, down.map(|part| -part)];
        let scene = Self { camera, columns, rows, layout, middle: sight.map(|part| far * part), axes, blur, noise, seed };
        (lens.reaches(half_field) && scene.is_whole()).then_some(scene)
    }

    /// The size of the image.
    pub fn size(&self) -> ImageSize {
        ImageSize { width: self.camera.width as u32, height: self.camera.height as u32 }
    }

    fn before(&self, [u, v]: PlatePoint) -> [f64; 3] {
        let [[u0, v0], [u1, v1]] = self.layout.printed;
        let (u, v) = (u - 0.5 * (u0 + u1), v - 0.5 * (v0 + v1));
        std::array::from_fn(|k| self.middle[k] + u * self.axes[0][k] + v * self.axes[1][k])
    }

    /// Where a point of the board is seen.
    pub fn at(&self, at: PlatePoint) -> Option<PixelPoint> {
        self.camera.at(self.before(at)).map(|[x, y]| PixelPoint::new(x, y))
    }

    /// Its inner corners, in the order of the layout.
    pub fn corners(&self) -> Vec<PixelPoint> {
        self.layout.points.iter().filter_map(|point| self.at(point.at)).collect()
    }

    /// Whether all squares are in the image, seen from the front, with sides that are long enough.
    fn is_whole(&self) -> bool {
        let normal = cross(self.axes[0], self.axes[1]);
        let ahead = |at: [f64; 3]| (0..3).map(|k| normal[k] * at[k]).sum::<f64>() < 0.0;
        let [[u0, v0], _] = self.layout.printed;
        let place = |column: usize, row: usize| self.at([u0 + column as f64, v0 + row as f64]).filter(|at| self.holds(*at));
        let apart = |a: Option<PixelPoint>, b: Option<PixelPoint>| Some(a?.distance(b?));
        ahead(self.middle)
            && (0..=self.rows + 1).all(|row| {
                (0..=self.columns + 1).all(|column| {
                    let own = place(column, row);
                    let right = column > self.columns || apart(own, place(column + 1, row)).is_some_and(|far| far >= LEAST_SIDE);
                    let up = row > self.rows || apart(own, place(column, row + 1)).is_some_and(|far| far >= LEAST_SIDE);
                    own.is_some() && right && up
                })
            })
    }

    fn holds(&self, at: PixelPoint) -> bool {
        (3.0..self.camera.width as f64 - 4.0).contains(&at.x) && (3.0..self.camera.height as f64 - 4.0).contains(&at.y)
    }

    /// The angle of each corner from the axis at most, degrees.
    pub fn farthest(&self) -> f64 {
        let angle = |at: PlatePoint| {
            let [x, y, z] = self.before(at);
            x.hypot(y).atan2(z).to_degrees()
        };
        self.layout.points.iter().map(|point| angle(point.at)).fold(0.0, f64::max)
    }

    /// A polygon of the board's plane, as it is seen; `None` where a part is outside the field.
    fn outline(&self, corners: &[PlatePoint]) -> Option<Vec<PixelPoint>> {
        let next = corners.iter().cycle().skip(1);
        let along = corners.iter().zip(next).flat_map(|(a, b)| {
            (0..ALONG).map(move |step| {
                let share = step as f64 / ALONG as f64;
                [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])]
            })
        });
        along.map(|at| self.at(at)).collect()
    }

    /// The picture: the board on its sheet.
    pub fn picture(&self) -> Image<'static> {
        let mut random = Random::new(self.seed ^ 0x17);
        let (paper, ink) = (random.between(0.65, 0.95) as f32, random.between(0.03, 0.2) as f32);
        let [[u0, v0], [u1, v1]] = self.layout.printed;
        let sheet = |rim: f64| vec![[u0 - rim, v0 - rim], [u1 + rim, v0 - rim], [u1 + rim, v1 + rim], [u0 - rim, v1 + rim]];
        // The widest sheet that is in the field.
        let rim = [0.8, 0.5, 0.25].into_iter().find(|rim| self.outline(&sheet(*rim)).is_some()).unwrap_or(0.0);
        let dark = self.layout.shapes.iter().map(|shape| (shape.outline.0.iter().map(|curve| curve.at(0.0)).collect(), ink));
        self.drawn_before_clutter(std::iter::once((sheet(rim), paper)).chain(dark))
    }

    /// Polygons of the board's plane, one upon the other, before a cluttered ground, black beyond the circle of the field.
    pub fn drawn_before_clutter(&self, polygons: impl Iterator<Item = (Vec<PlatePoint>, f32)>) -> Image<'static> {
        let mut random = Random::new(self.seed ^ 0xb0a2);
        let Camera { width, height, radius, .. } = self.camera;
        let mut fine = Fine::new(width, height, 0.0);
        let [cx, cy] = self.camera.middle();
        let circle: Vec<PixelPoint> =
            (0..240).map(|k| TAU * f64::from(k) / 240.0).map(|a| PixelPoint::new(cx + radius * a.cos(), cy + radius * a.sin())).collect();
        fine.fill(&circle, random.between(0.2, 0.6) as f32);
        // Whatever stands behind a board: areas of any grey with straight borders.
        for _ in 0..12 {
            let (x, y) = (random.between(0.0, width as f64), random.between(0.0, height as f64));
            let (size, turn) = (random.between(0.03, 0.25) * radius, random.between(0.0, TAU));
            let corners: Vec<PixelPoint> = (0..4)
                .map(|k| turn + f64::from(k) * 0.5 * PI + random.between(-0.4, 0.4))
                .map(|a| PixelPoint::new(x + size * a.cos(), y + size * a.sin()))
                .filter(|at| (at.x - cx).hypot(at.y - cy) < 0.97 * radius)
                .collect();
            if corners.len() > 2 {
                fine.fill(&corners, random.between(0.05, 0.9) as f32);
            }
        }
        for (corners, grey) in polygons {
            if let Some(outline) = self.outline(&corners) {
                fine.fill(&outline, grey);
            }
        }
        let image = blurred(&fine.picture(), self.blur);
        noisy(&image, self.noise, self.seed)
    }
}
