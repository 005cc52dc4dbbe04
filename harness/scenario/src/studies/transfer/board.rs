//! `[transfer.board]`.

use calibench_diagnostics::Problem;
use calibench_model::TargetKind;
use calibench_model::camera::{CameraModel, ImageSize};
use calibench_synth::stations::{Aim, RandomViews};

use super::wire::BoardWire;
use super::{Board, Sites};
use crate::section::Section;

/// The fewest views of a plane that show an interior orientation.
const LEAST_VIEWS: usize = 3;
/// Boards whose normals differ by less are parallel, degrees.
const PARALLEL: f64 = 0.5;

/// What the table says.
pub struct ReadBoard {
    /// The board and its views.
    pub board: Board,
    /// The height of its bend, the board's units.
    pub bend: f64,
    /// Standard deviation of a corner's coordinates in place of the methods' own, px.
    pub sigma_px: Option<f64>,
}

/// Reads the table; images have the `size`.
pub fn read(section: Section<'_>, size: ImageSize, sites: &mut Sites<'_>, problems: &mut Vec<Problem>) -> Option<ReadBoard> {
    let before = problems.len();
    let wire: BoardWire = section.read(&[], problems)?;
    let (count, tilt) = (wire.views.get_ref().0, wire.tilt.get_ref().0);
    if count < LEAST_VIEWS {
        let message =
            format!("{count} views of the board: expected at least {LEAST_VIEWS}, fewer do not show the principal distance and point");
        problems.push(Problem::new(wire.views.span(), message));
    }
    if tilt < PARALLEL {
        let message = format!(
            "`tilt` is {tilt} degrees: all boards are parallel, expected at least {PARALLEL}, parallel planes do not show the principal distance"
        );
        problems.push(Problem::new(wire.tilt.span(), message));
    }
    let views = sites(&wire.file).map_err(|why| problems.push(Problem::new(wire.file.span(), why))).ok()?;
    let corners = views.field.targets.iter().filter(|target| target.kind == TargetKind::ChessCorner).count();
    if views.field.plates.len() != 1 || corners != views.field.targets.len() {
        problems.push(Problem::new(
            wire.file.span(),
            format!("`{}` has no chessboard: expected one sheet of chess corners", wire.file.get_ref()),
        ));
    }
    if views.camera.size() != size {
        problems.push(Problem::new(
            wire.file.span(),
            format!("the images of `{}` are of another size than those where calibrations are applied", wire.file.get_ref()),
        ));
    }
    let aim = Aim::of(&views.field);
    if aim.is_none() {
        problems.push(Problem::new(wire.file.span(), "the board faces no way"));
    }
    let random = RandomViews {
        count,
        distance: wire.distance.0,
        tilt: tilt.to_radians(),
        roll: wire.roll.map_or(0.0, |roll| roll.0.to_radians()),
        aside: wire.aside.map_or([0.0; 2], |aside| aside.0),
    };
    if problems.len() > before {
        return None;
    }
    let board = Board { field: views.field, views: random, aim: aim?, within: wire.within.map_or(1.0, |part| part.0) };
    Some(ReadBoard { board, bend: wire.bend.map_or(0.0, |bend| bend.0), sigma_px: wire.sigma_px.map(|sigma| sigma.0) })
}
