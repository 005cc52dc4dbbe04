//! Reading `[tasks]`.

use calibench_diagnostics::Problem;
use calibench_measure::Configured;
use calibench_model::Testfield;

use super::wire::TasksWire;
use super::{BoardErrors, Tasks};
use crate::section::Section;
use crate::studies::{Seen, check_model};

/// Lengths of each camera if the scenario does not say how many.
const COUNT: usize = 20;
/// Of the largest distance within the board, how long the least length may be: longer ones would hardly be found.
const OF_BOARD: f64 = 0.7;

/// Reads the table of a scenario of `views`, whose methods are `methods`.
pub fn read(section: Section<'_>, views: &Seen<'_>, methods: &[Configured], problems: &mut Vec<Problem>) -> Option<Tasks> {
    let (before, span) = (problems.len(), section.span.clone());
    let wire: TasksWire = section.read(&[], problems)?;
    check_model(&wire.model, problems);
    if !views.redrawn {
        let problem = Problem::new(span.clone(), "[tasks] with stations that are the same in all trials: expected others in each");
        problems.push(problem.help("`each_trial = true` in [stations] of kind \"random\""));
    }
    match board_size(views.field) {
        None => problems.push(Problem::new(span, "[tasks] needs a testfield whose targets lie in the plane Z = 0, as a board's do")),
        Some([width, height]) => {
            let most = OF_BOARD * width.hypot(height);
            if wire.length.get_ref().0 > most {
                let message =
                    format!("`length` {}: expected at most {most:.6}, {OF_BOARD} of the board's diagonal", wire.length.get_ref().0);
                problems.push(Problem::new(wire.length.span(), message));
            }
        }
    }
    (problems.len() == before).then(|| Tasks {
        model: wire.model.into_inner(),
        noise_px: wire.noise_px.0,
        drawn: methods.iter().map(|method| (method.label.clone(), Some(wire.noise_px.0))).collect(),
        board: BoardErrors { print: wire.print_noise.0, scale: wire.board_scale.0, flatness: wire.flatness.0 },
        count: wire.count.map_or(COUNT, |count| count.0),
        length: wire.length.into_inner().0,
        centre_sigma: wire.centre_sigma.0,
        angle_sigma: wire.angle_sigma.0.to_radians(),
        plane_sigma: wire.plane_sigma.0,
        tilt_sigma: wire.tilt_sigma.0.to_radians(),
    })
}

/// Width and height of the targets, object units; `None` where they are not in the plane Z = 0.
fn board_size(field: &Testfield) -> Option<[f64; 2]> {
    let points = || field.targets.iter().map(|target| field.position(target));
    if points().any(|point| point.z != 0.0) {
        return None;
    }
    let range = |axis: usize| {
        points().map(|point| point[axis]).fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    };
    Some([0, 1].map(range).map(|[low, high]| high - low)).filter(|size| size.iter().all(|edge| *edge > 0.0))
}
