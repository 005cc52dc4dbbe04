//! Measured corners in the place of a board's nominal ones.

use std::collections::{HashMap, HashSet};

use calibench_model::{BoardCorner, ControlRow, escape};
use nalgebra::Point3;
use thiserror::Error;

use crate::few;

/// The share of the distance to its nearest neighbour by which a measured corner may be off at most.
const OFF: f64 = 0.25;

/// A file of measured corners that is of another board.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum OtherBoard {
    /// Corners of the board that the file does not have.
    #[error("holds {found} corners, and the board has {expected}: {} not there; is it the file of another board?", are(missing))]
    Missing {
        /// How many corners the file holds.
        found: usize,
        /// How many the board has.
        expected: usize,
        /// Those that are missing.
        missing: Vec<String>,
    },
    /// Corners of the file that the board does not have.
    #[error("holds {found} corners, and the board has {expected}: {} none of its corners; is it the file of another board?", are(strange))]
    Strange {
        /// How many corners the file holds.
        found: usize,
        /// How many the board has.
        expected: usize,
        /// Those of the file alone.
        strange: Vec<String>,
    },
    /// A corner far from where the board has it.
    #[error(
        "`{target}` is {off} from where the board has it, and its next corner is {step} away: is it the file of a board of another size, or in another frame?"
    )]
    Elsewhere {
        /// The corner.
        target: String,
        /// How far it is off, object units.
        off: String,
        /// How far its nearest neighbour is, object units.
        step: String,
    },
}

fn are(names: &[String]) -> String {
    let escaped: Vec<String> = names.iter().map(|name| escape::name(name).into_owned()).collect();
    format!("{} {}", few(&escaped), if names.len() == 1 { "is" } else { "are" })
}

/// `control` with the coordinates and standard deviations that a file of measured corners has.
///
/// # Errors
/// [`OtherBoard`]: other names or counts; corners that are elsewhere.
pub fn with_corners(control: &[ControlRow], corners: &[BoardCorner]) -> Result<Vec<ControlRow>, OtherBoard> {
    let by_name: HashMap<&str, &BoardCorner> = corners.iter().map(|corner| (corner.target.as_str(), corner)).collect();
    let (found, expected) = (corners.len(), control.len());
    let missing: Vec<String> =
        control.iter().filter(|row| !by_name.contains_key(row.target.as_str())).map(|row| row.target.clone()).collect();
    if !missing.is_empty() {
        return Err(OtherBoard::Missing { found, expected, missing });
    }
    if found != expected {
        let known: HashSet<&str> = control.iter().map(|row| row.target.as_str()).collect();
        let strange = corners.iter().map(|corner| corner.target.clone()).filter(|name| !known.contains(name.as_str())).collect();
        return Err(OtherBoard::Strange { found, expected, strange });
    }
    let place = |row: &ControlRow| Point3::from(row.position);
    let measured = |row: &ControlRow| {
        let corner = by_name[row.target.as_str()];
        let off = (Point3::from(corner.position) - place(row)).norm();
        let others = control.iter().filter(|other| other.target != row.target);
        let step = others.map(|other| (place(other) - place(row)).norm()).fold(f64::INFINITY, f64::min);
        if off > OFF * step {
            let [off, step] = [off, step].map(calibench_diagnostics::plain);
            return Err(OtherBoard::Elsewhere { target: row.target.clone(), off, step });
        }
        Ok(ControlRow { position: corner.position, sigmas: Some(corner.sigmas), ..row.clone() })
    };
    control.iter().map(measured).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(row: &ControlRow, moved: [f64; 3]) -> BoardCorner {
        BoardCorner {
            target: row.target.clone(),
            position: [0, 1, 2].map(|k| row.position[k] + moved[k]),
            sigmas: [0.01, 0.02, 0.03],
            covariances: None,
            nominal: None,
            photographs: None,
        }
    }

    #[test]
    fn corners_take_the_place_of_nominal_ones_by_name() {
        let control = [ControlRow::new("a", [0.0; 3]), ControlRow::new("b", [20.0, 0.0, 0.0]), ControlRow::new("c", [0.0, 20.0, 0.0])];
        let mut corners: Vec<BoardCorner> = control.iter().map(|row| corner(row, [0.1, -0.2, 0.3])).collect();
        corners.reverse();
        let found = with_corners(&control, &corners).unwrap();
        assert_eq!(found.iter().map(|row| row.target.as_str()).collect::<Vec<_>>(), ["a", "b", "c"]);
        assert_eq!((found[1].position, found[1].sigmas), ([20.1, -0.2, 0.3], Some([0.01, 0.02, 0.03])));
        let words = |corners: &[BoardCorner]| with_corners(&control, corners).unwrap_err().to_string();
        assert!(words(&corners[..2]).contains("holds 2 corners, and the board has 3: a is not there"), "{}", words(&corners[..2]));
        let mut more = corners.clone();
        more.push(corner(&ControlRow::new("d", [1.0; 3]), [0.0; 3]));
        assert!(words(&more).contains("4 corners, and the board has 3: d is none of its corners"), "{}", words(&more));
        corners[0] = corner(&control[2], [0.0, 6.0, 0.0]);
        assert!(
            words(&corners).contains("`c` is 6.00 from where the board has it, and its next corner is 20.0 away"),
            "{}",
            words(&corners)
        );
    }
}
