//! Station files: exterior orientations as CSV.

use std::io::Read;
use std::path::Path;

use calibench_model::Pose;

use crate::points::PointFileError;
use crate::sheet::{Form, Row};

/// The columns of a pose in a station file.
pub const POSE_COLUMNS: [&str; 6] = ["X0", "Y0", "Z0", "omega_deg", "phi_deg", "kappa_deg"];
/// The columns of its standard deviations: of X0, Y0, Z0 in object units, of small rotations about the camera's axes in degrees.
pub const POSE_SIGMA_COLUMNS: [&str; 6] = ["sX0", "sY0", "sZ0", "sx_deg", "sy_deg", "sz_deg"];

const FORM: Form = Form { what: "station file", key: "image", required: &POSE_COLUMNS, optional: &[], others: true };

/// An image and its exterior orientation.
#[derive(Clone, Debug, PartialEq)]
pub struct StationRow {
    /// The image's name.
    pub image: String,
    /// Its pose.
    pub pose: Pose,
}

/// Reads a station file: header `image,X0,Y0,Z0,omega_deg,phi_deg,kappa_deg`; other columns are read over. Object units and degrees.
///
/// # Errors
/// The first mistake, with line and column: a missing column, a number that is none, an image given twice, no row at all.
pub fn read_stations(path: &Path) -> Result<Vec<StationRow>, PointFileError> {
    Ok(FORM.read(path)?.iter().map(station).collect())
}

/// As [`read_stations`], from anything that can be read; `file` is its name in errors.
///
/// # Errors
/// As [`read_stations`].
pub fn parse_stations(file: &str, input: impl Read) -> Result<Vec<StationRow>, PointFileError> {
    Ok(FORM.parse(file, input)?.iter().map(station).collect())
}

/// The numbers of a pose as a station file has them: X0, Y0, Z0 and omega, phi, kappa in degrees.
pub fn station_numbers(pose: &Pose) -> [f64; 6] {
    let [omega, phi, kappa] = pose.angles().map(f64::to_degrees);
    [pose.centre.x, pose.centre.y, pose.centre.z, omega, phi, kappa]
}

fn station(row: &Row) -> StationRow {
    let n = &row.numbers;
    let pose = Pose::from_angles([n[0], n[1], n[2]].into(), [n[3], n[4], n[5]].map(f64::to_radians));
    StationRow { image: row.name.clone(), pose }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pose_goes_both_ways() {
        let text = "image,X0,Y0,Z0,omega_deg,phi_deg,kappa_deg,clipped_low\na,1,2,3,10,-20,130,7\n";
        let rows = parse_stations("s", text.as_bytes()).unwrap();
        assert_eq!(rows[0].image, "a");
        let numbers = station_numbers(&rows[0].pose);
        assert!(numbers.iter().zip([1.0, 2.0, 3.0, 10.0, -20.0, 130.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{numbers:?}");
    }

    #[test]
    fn mistakes_have_a_line_and_a_column() {
        let error = |text: &str| parse_stations("s.csv", text.as_bytes()).unwrap_err().to_string();
        let header = "image,X0,Y0,Z0,omega_deg,phi_deg,kappa_deg\n";
        assert!(error("image,X0,Y0,Z0,omega,phi,kappa\n").starts_with("s.csv:1, column `omega_deg`: missing in the header"));
        assert!(error(&format!("{header}a,1,2,3,4,5,six\n")).starts_with("s.csv:2, column `kappa_deg`: expected a finite number"));
        assert!(error(&format!("{header}a,1,2,3,4,5,6\na,1,2,3,4,5,6\n")).starts_with("s.csv:3, column `image`: `a` is already on line 2"));
    }
}
