//! A plausible network: what the paper says of its own, and the rest drawn.

use std::fmt::Write;

use calibench_model::Pose;
use nalgebra::{Point3, Vector3};
use rand::seq::IndexedRandom;
use rand::{Rng, RngExt};

/// Stations 6 and 9 stand so far apart, in heights above the wall.
const BASE_TO_HEIGHT: std::ops::Range<f64> = 2.05..2.15;
/// Mean distance of stations 6, 1 and 9 from the wall's middle, m.
const MEAN_DISTANCE: f64 = 6.178;
/// The principal distance, px.
const FOCAL: f64 = 16.55 / 0.0047;
/// Sheets side by side, rows and columns of points on each: 33 to 44 points.
const LAYOUTS: [(usize, usize, usize); 11] =
    [(3, 4, 3), (3, 3, 4), (3, 7, 2), (3, 2, 6), (3, 6, 2), (3, 11, 1), (1, 5, 7), (1, 6, 6), (1, 5, 8), (1, 6, 7), (1, 4, 9)];

/// A station by its direction from the middle of the wall.
#[derive(Clone, Copy, Debug)]
struct From {
    /// Angle from the wall's normal towards +x and +y, degrees.
    azimuth: f64,
    elevation: f64,
    /// m.
    distance: f64,
    /// Where it looks, m.
    towards: [f64; 2],
    roll: f64,
}

/// The wall and its points.
#[derive(Clone, Debug)]
struct Wall {
    sheets: usize,
    rows: usize,
    columns: usize,
    /// m.
    width: f64,
    height: f64,
    /// How far the outer sheets stand before or behind the middle one, m.
    relief: [f64; 2],
}

/// A network without its noise.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Its name, and the seed of its noise.
    pub number: u64,
    wall: Wall,
    stations: [From; 10],
    /// Standard deviation of a surveyed coordinate, m.
    pub survey: f64,
    /// Share of the smallest variance of image coordinates that all methods have in common.
    pub common: f64,
}

/// What is wrong with the coordinates, px.
#[derive(Clone, Copy, Debug)]
pub struct Noise {
    /// The hand, before it stops at whole pixels.
    pub hand: f64,
    /// In the coordinates of all methods alike.
    pub floor: f64,
    /// Of 9 x 9 and 15 x 15, each its own.
    pub own: [f64; 2],
}

/// Whose errors are looked at in the second step.
#[derive(Clone, Debug)]
pub struct Check {
    /// Control points.
    pub control: Vec<String>,
    /// Check points.
    pub points: Vec<String>,
}

impl Drawn {
    /// A network by its number.
    pub fn new(number: u64, rng: &mut impl Rng) -> Self {
        let mut stations = std::array::from_fn(|index| station(rng, index));
        draw_triplet(rng, &mut stations);
        let (survey, common) = survey(rng);
        Self { number, wall: Wall::new(rng), stations, survey, common }
    }

    /// The same with one of its parts drawn anew: as likely to come back from there as to go.
    pub fn redrawn(&self, number: u64, rng: &mut impl Rng) -> Self {
        let mut other = Self { number, ..self.clone() };
        match rng.random_range(0..10) {
            0 => other.wall = Wall::new(rng),
            1 => (other.survey, other.common) = survey(rng),
            2 => draw_triplet(rng, &mut other.stations),
            place => {
                let index = [1, 2, 3, 4, 6, 7, 9][place - 3];
                other.stations[index] = station(rng, index);
            }
        }
        other
    }

    /// Image points that a pinhole camera would have, moved by at most `slack` towards 326: distortion shows a few more.
    pub fn roughly_seen(&self, slack: usize) -> usize {
        let seen = self
            .stations
            .iter()
            .map(|station| {
                let pose = station.pose();
                self.wall.places().filter(|place| sees(&pose, *place)).count()
            })
            .sum::<usize>();
        if seen < 326 { (seen + slack).min(326) } else { seen.saturating_sub(slack).max(326) }
    }

    /// Stations that are rolled by 90 degrees or more.
    pub fn rolled(&self) -> usize {
        self.stations.iter().filter(|station| station.roll.abs() > 45.0).count()
    }

    /// Stations whose view to the middle of the wall is at least `degrees` off its normal.
    pub fn convergent(&self, degrees: f64) -> usize {
        let off = |s: &&From| (s.azimuth.to_radians().cos() * s.elevation.to_radians().cos()).acos().to_degrees() >= degrees;
        self.stations.iter().filter(off).count()
    }

    /// The depth of the wall, m.
    pub fn depth(&self) -> f64 {
        let [left, right] = self.wall.relief;
        left.max(right).max(0.0) - left.min(right).min(0.0)
    }

    /// As a scenario; `survey` is what is wrong in the survey, m: what the adjustment is told of it stays.
    pub fn scenario(&self, noise: &Noise, survey: f64, check: Option<&Check>, trials: u64) -> String {
        let mut text = format!(
            "why = \"A plausible network.\"\nsource = \"ours\"\nseed = {}\ntrials = {trials}\n[camera]\nsize = [1362, 1021]\npitch = 4.70\nc = 16.55\nx0 = -0.05\ny0 = -0.06\nk1 = -3.7e-4\n\
             [testfield]\nkind = \"wall\"\nunit = \"m\"\n",
            self.number
        );
        let wall = &self.wall;
        for sheet in 0..wall.sheets {
            let (width, height, [x, z]) = (wall.sheet_width(), wall.height, wall.middle(sheet));
            let _ = write!(
                text,
                "[[testfield.plate]]\nid = \"s{sheet}\"\nmiddle = [{x}, 0, {z}]\nright = [1, 0, 0]\nup = [0, 1, 0]\nwidth = {width}\nheight = {height}\n"
            );
        }
        let _ = write!(text, "[testfield.fill]\nkinds = [\"corner\"]\nsize = 0.02\nrows = {}\ncolumns = {}\n", wall.rows, wall.columns);
        for (index, station) in self.stations.iter().enumerate() {
            let [x, y, z] = station.place();
            let [tx, ty] = station.towards;
            let _ = write!(
                text,
                "[[station]]\nname = \"{}\"\nat = [{x}, {y}, {z}]\ntowards = [{tx}, {ty}, 0]\nroll = {}\n",
                index + 1,
                station.roll
            );
        }
        let _ = write!(
            text,
            "[pointing]\nsigma = {}\nwhole_pixels = {}\n[calibration]\nsets = [\"c,x0,y0,k1\"]\nstart_c = 16.0\nsigma_px = 0.5\nfloor_px = {}\n\
             survey_sigma = {survey}\ncontrol_sigma = {}\ndrawn = {{ \"forstner:window=9\" = {}, \"forstner:window=15\" = {} }}\n",
            noise.hand,
            check.is_some(),
            noise.floor,
            self.survey,
            noise.own[0],
            noise.own[1]
        );
        if let Some(check) = check {
            let _ = write!(
                text,
                "[calibration.check]\nviews = [\"6\", \"1\", \"9\"]\ncontrol = {:?}\npoints = {:?}\n",
                check.control, check.points
            );
        }
        text + "[[method]]\nname = \"pixel\"\n[[method]]\nname = \"forstner\"\nwindow = 9\n[[method]]\nname = \"forstner\"\nwindow = 15\n"
    }
}

impl Wall {
    fn new(rng: &mut impl Rng) -> Self {
        let (sheets, rows, columns) = *LAYOUTS.choose(rng).expect("layouts");
        let relief = rng.random_range(0.0..0.5);
        // A third of the walls is flat.
        let relief = if sheets == 1 || rng.random_bool(1.0 / 3.0) { [0.0; 2] } else { [0; 2].map(|_| rng.random_range(-relief..=relief)) };
        Self { sheets, rows, columns, width: rng.random_range(1.5..3.5), height: rng.random_range(1.0..2.2), relief }
    }

    fn sheet_width(&self) -> f64 {
        self.width / self.sheets as f64
    }

    /// X and Z of the middle of a sheet, m.
    fn middle(&self, sheet: usize) -> [f64; 2] {
        let x = (sheet as f64 - 0.5 * (self.sheets - 1) as f64) * self.sheet_width();
        [x, if self.sheets == 1 { 0.0 } else { [self.relief[0], 0.0, self.relief[1]][sheet] }]
    }

    /// Its points, m.
    fn places(&self) -> impl Iterator<Item = [f64; 3]> {
        let along = |index: usize, count: usize| (index as f64 + 0.5) / count as f64 - 0.5;
        (0..self.sheets).flat_map(move |sheet| {
            let [x, z] = self.middle(sheet);
            let place = move |cell: usize| {
                [x + self.sheet_width() * along(cell % self.columns, self.columns), self.height * along(cell / self.columns, self.rows), z]
            };
            (0..self.rows * self.columns).map(place)
        })
    }
}

impl From {
    fn place(&self) -> [f64; 3] {
        let (azimuth, elevation) = (self.azimuth.to_radians(), self.elevation.to_radians());
        [azimuth.sin() * elevation.cos(), elevation.sin(), azimuth.cos() * elevation.cos()].map(|part| self.distance * part)
    }
}

impl From {
    fn pose(&self) -> Pose {
        let [x, y] = self.towards;
        let pose = Pose::looking_at(self.place().into(), Point3::new(x, y, 0.0), Vector3::y(), self.roll.to_radians());
        pose.expect("the wall is in front of every station")
    }
}

/// Whether a pinhole camera has a place of the wall in its frame.
fn sees(pose: &Pose, place: [f64; 3]) -> bool {
    let ray = pose.ray(&place.into());
    let (x, y) = (FOCAL * ray.x / ray.z, FOCAL * ray.y / ray.z);
    x.abs() < 681.0 && y.abs() < 510.5
}

/// Images 1 to 5 look at the wall less obliquely than 6 to 10.
fn station(rng: &mut impl Rng, index: usize) -> From {
    let oblique = if index < 5 { rng.random_range(0.0..20.0) } else { rng.random_range(15.0..50.0) };
    // Where people stand: mostly left and right of the wall.
    let turn: f64 = rng.random_range(0.0..std::f64::consts::TAU);
    let (azimuth, elevation) = (oblique * turn.cos(), oblique * turn.sin() * rng.random_range(0.0..1.0));
    looking(rng, azimuth, elevation)
}

/// Images 6 and 9 from both sides, image 1 between them: their distances and the base are the paper's.
fn draw_triplet(rng: &mut impl Rng, stations: &mut [From; 10]) {
    stations[0] = station(rng, 0);
    loop {
        let sideways = [-1.0, 1.0].map(|side| side * rng.random_range(36.0..56.0));
        for (index, azimuth) in [5, 8].into_iter().zip(sideways) {
            let elevation = rng.random_range(-15.0..15.0);
            stations[index] = looking(rng, azimuth, elevation);
        }
        let factor = MEAN_DISTANCE * 3.0 / [0, 5, 8].map(|index| stations[index].distance).iter().sum::<f64>();
        for index in [0, 5, 8] {
            stations[index].distance *= factor;
        }
        let [a, b] = [5, 8].map(|index| stations[index].place());
        let base = (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt();
        if BASE_TO_HEIGHT.contains(&(base / (0.5 * (a[2] + b[2])))) {
            return;
        }
    }
}

/// Three of ten cameras are turned on their side or upside down.
fn looking(rng: &mut impl Rng, azimuth: f64, elevation: f64) -> From {
    let towards = [0; 2].map(|_| rng.random_range(-0.25..0.25));
    let rolled = if rng.random_bool(0.3) { *[90.0, -90.0, 180.0].choose(rng).expect("rolls") } else { 0.0 };
    From { azimuth, elevation, distance: rng.random_range(4.0..8.0), towards, roll: rolled + rng.random_range(-5.0..5.0) }
}

/// What a survey with rule and invar plate is good for, m; and how much of their error the ways of measuring share.
fn survey(rng: &mut impl Rng) -> (f64, f64) {
    (1e-3 * 10_f64.powf(rng.random_range(-1.0..0.0)), rng.random_range(0.0..1.0))
}
