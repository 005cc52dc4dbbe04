//! The tables of an oriented pair.

use std::io;

use calibench_exchange::{POSE_COLUMNS, POSE_SIGMA_COLUMNS, station_numbers};
use calibench_files::write_table;
use calibench_model::Pose;
use nalgebra::{Matrix3, Point3};

use super::pair::{LeftOutOfPair, Pair, PairTarget, Side};

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
const FURTHER_COLUMNS: [&str; 3] = ["points", "sigma0_px", "redundancy"];

impl Pair {
    /// Writes a row for every target given: coordinates and standard deviations in object units; residuals are nearest coplanar less measured, px, and
    /// the parallax is their length.
    ///
    /// # Errors
    /// What `file` returns.
    pub fn write_points(&self, file: impl io::Write) -> io::Result<()> {
        write_table(file, &POINT_COLUMNS, self.targets.iter().map(|row| self.cells(row)))
    }

    fn cells(&self, row: &PairTarget) -> Vec<String> {
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
            Err(LeftOutOfPair::Rejected) => ["rejected".to_owned(), "its rays are not coplanar with the others' orientation".to_owned()],
            Err(LeftOutOfPair::Unseen(Side::Left)) => ["left_out".to_owned(), "not measured in the left image".to_owned()],
            Err(LeftOutOfPair::Unseen(Side::Right)) => ["left_out".to_owned(), "not measured in the right image".to_owned()],
            Err(LeftOutOfPair::NoPoint(why)) => ["left_out".to_owned(), why.to_string()],
        });
        cells
    }

    /// Writes the poses as a station file, object units and degrees: the left image's is the origin.
    ///
    /// # Errors
    /// What `file` returns.
    pub fn write_poses(&self, file: impl io::Write, [left, right]: [&str; 2]) -> io::Result<()> {
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
        let columns = [&["image"], &POSE_COLUMNS[..], &POSE_SIGMA_COLUMNS, &FURTHER_COLUMNS].concat();
        write_table(file, &columns, poses.map(row))
    }
}
