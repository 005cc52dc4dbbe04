//! Station files: exterior orientations as CSV.

use std::io::Read;
use std::path::Path;

use calibench_files::bounded;
use calibench_model::{ObservedStation, Pose, StationRow};

use crate::csv_named_rows::{Form, Row, wrong};
use crate::points::PointFileError;

/// The columns of a pose in a station file: X0, Y0, Z0 in object units, omega, phi, kappa in degrees.
pub const POSE_COLUMNS: [&str; 6] = ["X0", "Y0", "Z0", "omega_deg", "phi_deg", "kappa_deg"];
/// The columns of its standard deviations: of X0, Y0, Z0 in object units, of small rotations about the camera's axes in degrees.
pub const POSE_SIGMA_COLUMNS: [&str; 6] = ["sX0", "sY0", "sZ0", "sx_deg", "sy_deg", "sz_deg"];

const FORM: Form = Form {
    what: "station file",
    key: "image",
    partner: None,
    group: None,
    required: &POSE_COLUMNS,
    optional: &[],
    others: true,
    passed_over: &[],
};
/// Standard deviations of the centre, and of a small rotation about the camera's axes.
const GROUPS: [&[&str]; 2] = [POSE_SIGMA_COLUMNS.split_at(3).0, POSE_SIGMA_COLUMNS.split_at(3).1];
/// With standard deviations; each group is there whole or not at all.
const OBSERVED: Form = Form { optional: &GROUPS, ..FORM };

/// As [`read_stations`], with the standard deviations `sX0,sY0,sZ0` (object units) and `sx_deg,sy_deg,sz_deg` (about the camera's axes), of which either
/// group may be missing or left empty in a row.
///
/// # Errors
/// As [`read_stations`]; a standard deviation that is not positive, a group that is there in part, a file without any standard deviation.
pub fn read_observed_stations(path: &Path) -> Result<Vec<ObservedStation>, PointFileError> {
    let name = path.display().to_string();
    let text = bounded::table(path).map_err(|error| wrong(&name, None, None, error.to_string()))?;
    parse_observed_stations(&name, &text)
}

/// As [`read_observed_stations`], from a text; `file` is its name in errors.
///
/// # Errors
/// As [`read_observed_stations`].
pub fn parse_observed_stations(file: &str, text: &[u8]) -> Result<Vec<ObservedStation>, PointFileError> {
    let observed = |file: &str, row: Row| {
        let rotation = sigmas(file, &row, 1)?.map(|sigmas| sigmas.map(f64::to_radians));
        Ok(ObservedStation { station: station(&row), centre: sigmas(file, &row, 0)?, rotation })
    };
    let rows = OBSERVED.parse(file, text, observed)?;
    if rows.iter().all(|row| row.centre.is_none() && row.rotation.is_none()) {
        let problem = format!("holds no standard deviation; expected {}", GROUPS.map(|group| group.join(",")).join(" or "));
        return Err(wrong(file, None, None, problem));
    }
    Ok(rows)
}

fn sigmas(file: &str, row: &Row, group: usize) -> Result<Option<[f64; 3]>, PointFileError> {
    let Some(sigmas) = row.optional::<3>(group) else { return Ok(None) };
    match sigmas.iter().position(|sigma| *sigma <= 0.0) {
        None => Ok(Some(sigmas)),
        Some(axis) => {
            let problem = "expected a positive standard deviation; leave all three empty for what was not observed".to_owned();
            Err(wrong(file, Some(row.line), Some(GROUPS[group][axis]), problem))
        }
    }
}

/// Reads a station file: header `image,X0,Y0,Z0,omega_deg,phi_deg,kappa_deg`; other columns are read over. Object units and degrees.
///
/// # Errors
/// The first mistake, with line and column: a missing column, a number that is none, an image given twice, no row at all.
pub fn read_stations(path: &Path) -> Result<Vec<StationRow>, PointFileError> {
    FORM.read(path, |_, row| Ok(station(&row)))
}

/// As [`read_stations`], from anything that can be read; `file` is its name in errors.
///
/// # Errors
/// As [`read_stations`].
pub fn parse_stations(file: &str, input: impl Read) -> Result<Vec<StationRow>, PointFileError> {
    FORM.parse(file, input, |_, row| Ok(station(&row)))
}

/// The numbers of a pose as a station file has them: X0, Y0, Z0 in object units and omega, phi, kappa in degrees.
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
    fn centres_and_rotations_are_observed_apart() {
        let header = "image,X0,Y0,Z0,omega_deg,phi_deg,kappa_deg,sX0,sY0,sZ0,sx_deg,sy_deg,sz_deg,rms_px\n";
        let text = format!("{header}a,1,2,3,10,-20,130,0.1,0.2,0.3,,,,1\nb,1,2,3,0,0,0,,,,180,90,45,1\nc,1,2,3,0,0,0,,,,,,,1\n");
        let rows = parse_observed_stations("s", text.as_bytes()).unwrap();
        assert_eq!((rows[0].centre, rows[0].rotation), (Some([0.1, 0.2, 0.3]), None));
        let turns = rows[1].rotation.unwrap();
        assert!(rows[1].centre.is_none() && (turns[0] - std::f64::consts::PI).abs() < 1e-12 && (turns[2] * 4.0 - turns[0]).abs() < 1e-12);
        assert_eq!((rows[2].centre, rows[2].rotation), (None, None));
        let error = |text: &str| parse_observed_stations("s.csv", text.as_bytes()).unwrap_err().to_string();
        let header = "image,X0,Y0,Z0,omega_deg,phi_deg,kappa_deg,sX0,sY0,sZ0\n";
        assert!(error(&format!("{header}a,1,2,3,4,5,6,1,0,1\n")).starts_with("s.csv:2, column `sY0`: expected a positive"));
        assert!(error(&format!("{header}a,1,2,3,4,5,6,,,\n")).starts_with("s.csv: holds no standard deviation; expected sX0,sY0,sZ0 or"));
        assert!(error("image,X0,Y0,Z0,omega_deg,phi_deg,kappa_deg,sx_deg\na,1,2,3,4,5,6,1\n").contains("these go together"));
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
