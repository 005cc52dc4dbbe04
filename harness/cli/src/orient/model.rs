//! The model of an oriented pair, and its tables.

use std::io;

use calibench_adjust::approximate::{ModelPoint, RelativeOrientation};
use calibench_exchange::{station_numbers, write_table};
use calibench_model::Pose;
use calibench_model::camera::Camera;
use nalgebra::{Matrix3, Point3};

use crate::orient::seen::Seen;

/// An oriented pair with its object points, scaled to the length of the base.
pub(super) struct Model<'a> {
    /// The orientation, in base lengths.
    pub(super) found: &'a RelativeOrientation,
    /// Length of the base, object units.
    pub(super) base: f64,
    /// A row for each target given.
    pub(super) rows: Vec<Row<'a>>,
}

/// What became of a target.
pub(super) struct Row<'a> {
    seen: &'a Seen,
    /// Nearest coplanar minus measured: x and y in the left image, then in the right, px.
    residual: Option<[f64; 4]>,
    /// In base lengths; or why there is none.
    pub(super) point: Result<ModelPoint, Lost>,
}

/// Why a target is no point of the model.
pub(super) enum Lost {
    /// It did not fit.
    Rejected,
    /// It was no pair, or its rays do not meet.
    LeftOut(String),
}

const POINT_COLUMNS: [&str; 15] = [
    "target",
    "X",
    "Y",
    "Z",
    "sX",
    "sY",
    "sZ",
    "angle_deg",
    "v_left_x",
    "v_left_y",
    "v_right_x",
    "v_right_y",
    "parallax_px",
    "status",
    "reason",
];
const POSE_COLUMNS: [&str; 16] = [
    "image",
    "X0",
    "Y0",
    "Z0",
    "omega_deg",
    "phi_deg",
    "kappa_deg",
    "sX0",
    "sY0",
    "sZ0",
    "sx_deg",
    "sy_deg",
    "sz_deg",
    "points",
    "sigma0_px",
    "redundancy",
];

impl<'a> Model<'a> {
    /// Intersects what was oriented; `least_angle` in rad.
    pub(super) fn of(cameras: [&Camera; 2], seen: &'a [Seen], found: &'a RelativeOrientation, base: f64, least_angle: f64) -> Self {
        let mut index = 0;
        let row = |seen: &'a Seen| {
            let Some(pair) = seen.pair() else {
                let side = if seen.at[0].is_some() { "right" } else { "left" };
                return Row { seen, residual: None, point: Err(Lost::LeftOut(format!("not measured in the {side} image"))) };
            };
            let place = index;
            index += 1;
            let point = if found.rejected.contains(&place) {
                Err(Lost::Rejected)
            } else {
                found.model_point(cameras, pair, least_angle).map_err(|error| Lost::LeftOut(error.to_string()))
            };
            Row { seen, residual: found.residuals[place], point }
        };
        Self { found, base, rows: seen.iter().map(row).collect() }
    }

    /// The second pose, object units.
    pub(super) fn pose(&self, of: &Pose) -> Pose {
        Pose { rotation: of.rotation, centre: of.centre * self.base }
    }

    /// Standard deviations from the residuals of X0, Y0, Z0 (object units) and of a small rotation about the right camera's axes (rad).
    pub(super) fn sigmas(&self) -> [f64; 6] {
        let cofactor = self.found.pose_cofactor();
        let sigma = |i: usize| self.found.sigma0 * cofactor[(i, i)].max(0.0).sqrt();
        std::array::from_fn(|i| sigma(i) * if i < 3 { self.base } else { 1.0 })
    }

    /// The points of the model.
    pub(super) fn points(&self) -> impl Iterator<Item = &ModelPoint> {
        self.rows.iter().filter_map(|row| row.point.as_ref().ok())
    }

    /// Writes a row for every target given; residuals are nearest coplanar less measured, px, and the parallax is their length.
    pub(super) fn write_points(&self, file: impl io::Write) -> io::Result<()> {
        write_table(file, &POINT_COLUMNS, self.rows.iter().map(|row| self.cells(row)))
    }

    fn cells(&self, row: &Row<'_>) -> Vec<String> {
        let texts = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>();
        let mut cells = vec![row.seen.target.clone()];
        match &row.point {
            Ok(point) => {
                let sigma = |i: usize| self.base * self.found.sigma0 * point.cofactor[(i, i)].sqrt();
                cells.extend(texts((point.position * self.base).coords.as_slice()));
                cells.extend(texts(&[sigma(0), sigma(1), sigma(2), point.angle.to_degrees()]));
            }
            Err(_) => cells.extend(vec![String::new(); 7]),
        }
        match row.residual {
            Some(v) => cells.extend(texts(&[v[0], v[1], v[2], v[3], v.iter().map(|v| v * v).sum::<f64>().sqrt()])),
            None => cells.extend(vec![String::new(); 5]),
        }
        cells.extend(match &row.point {
            Ok(_) => ["used".to_owned(), String::new()],
            Err(Lost::Rejected) => ["rejected".to_owned(), "its rays are not coplanar with the others' orientation".to_owned()],
            Err(Lost::LeftOut(why)) => ["left_out".to_owned(), why.clone()],
        });
        cells
    }

    /// Writes the poses: the left image's is the origin.
    pub(super) fn write_poses(&self, file: impl io::Write, [left, right]: [&str; 2]) -> io::Result<()> {
        let origin = Pose { rotation: Matrix3::identity(), centre: Point3::origin() };
        let points = self.found.residuals.len() - self.found.rejected.len();
        let row = |(name, pose, sigmas): (&str, Pose, [f64; 6])| {
            let [sx, sy, sz, turns @ ..] = sigmas;
            let numbers = station_numbers(&pose).into_iter().chain([sx, sy, sz]).chain(turns.map(f64::to_degrees));
            let mut row = vec![name.to_owned()];
            // Zeros without a sign.
            row.extend(numbers.map(|number| (number + 0.0).to_string()));
            row.extend([points.to_string(), self.found.sigma0.to_string(), self.found.redundancy.to_string()]);
            row
        };
        let poses = [(left, origin, [0.0; 6]), (right, self.pose(&self.found.pose), self.sigmas())];
        write_table(file, &POSE_COLUMNS, poses.map(row))
    }
}
