//! How a board came out of the printer: the keys that all boards have beside their own.

use std::path::{Path, PathBuf};

use calibench_diagnostics::Problem;
use calibench_exchange::read_board_corners;
use calibench_synth::testfield::Print;
use nalgebra::Point3;
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::wire::{Distance, Height, Length};
use crate::camera::located;
use crate::section::Section;

/// The keys.
pub const KEYS: [&str; 4] = ["corners", "ink_spread", "ragged", "ragged_length"];

/// A ragged edge has nodes at this distance, as a part of the board's step, where nothing else is said.
const RAGGED_LENGTH: f64 = 0.1;

/// How a board was printed.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PrintWire {
    /// The board's own corners: a file that `calibrate --save-board` writes, relative to the scenario's folder. Not beside `bend` or `print_noise`.
    #[schemars(with = "Option<String>")]
    pub corners: Option<Spanned<String>>,
    /// Dark areas grow by this on every straight side, object units; below 0 they shrink. Default 0.
    pub ink_spread: Option<Height>,
    /// Standard deviation of straight edges across themselves, at nodes, object units. Default 0.
    pub ragged: Option<Distance>,
    /// With `ragged`: the distance of the nodes, object units. Default: a tenth of the board's step.
    pub ragged_length: Option<Length>,
}

/// A print and the file of its corners.
pub type Read = (Print, Option<PathBuf>);

/// Reads the keys of a board whose step is `step` object units; `others` are keys of the table that say the same otherwise.
pub fn read(section: Section<'_>, (step, others): (f64, &[&str]), folder: &Path, problems: &mut Vec<Problem>) -> Option<Read> {
    let span = section.span.clone();
    let wire: PrintWire = section.read(&[], problems)?;
    if wire.ragged_length.is_some() && wire.ragged.is_none() {
        problems.push(Problem::new(span, "`ragged_length` says nothing without `ragged`: add it"));
        return None;
    }
    let mut file = None;
    let mut corners = Vec::new();
    if let Some(name) = &wire.corners {
        if let Some(other) = others.first() {
            let message = format!("`corners` beside `{other}`: the file says where the corners are; leave `{other}` out");
            problems.push(Problem::new(name.span(), message));
            return None;
        }
        let path = located(folder, name.get_ref());
        match read_board_corners(&path) {
            Ok(rows) => corners.extend(rows.into_iter().map(|row| (row.target, Point3::from(row.position)))),
            Err(error) => {
                problems.push(Problem::new(name.span(), error.to_string()));
                return None;
            }
        }
        file = Some(path);
    }
    let print = Print {
        corners,
        ink_spread: wire.ink_spread.map_or(0.0, |spread| spread.0),
        ragged: wire.ragged.map_or(0.0, |ragged| ragged.0),
        ragged_length: wire.ragged_length.map_or(RAGGED_LENGTH * step, |length| length.0),
    };
    Some((print, file))
}
