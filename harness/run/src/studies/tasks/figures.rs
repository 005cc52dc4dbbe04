//! What lengths say of the intervals around them.

use calibench_calibrate::Calibration;
use calibench_model::Pose;
use calibench_random::{Key, Purpose, stream};
use calibench_records::figures::Quantity;
use calibench_records::results::Figure;
use calibench_scenario::studies::tasks::Tasks;
use calibench_task::{HALF_95, KnownCamera};

use super::board::Board;
use super::length::{Measured, Measuring, Way};
use crate::studies::told::Trial;

/// The figures of one camera.
///
/// # Errors
/// In words: stations that cannot be drawn, covariances that are none, a way in which no length was measured.
pub(super) fn of(plan: &Tasks, trial: &Trial<'_>, board: &Board, found: &Calibration<'_>, key: Key<'_>) -> Result<Vec<Figure>, String> {
    let named = found.named_camera(0)?;
    let over_frame = found.over_frame.first().copied().flatten();
    // As the file of a report has it for `task --calibration`.
    let halves = over_frame.and_then(|known| Some(known.by_images_px? / known.formal_px)).filter(|times| times.is_finite());
    let poses = measuring_poses(trial, key)?;
    let measuring =
        Measuring { plan, board, truth: &trial.subject.camera, found: KnownCamera { halves, ..KnownCamera::of(&named) }, poses: &poses };
    let mut by_way: [Vec<Measured>; 3] = Default::default();
    for place in 0..plan.count {
        let name = format!("length {place}");
        let mut rng = stream(Key { view: "", target: &name, ..key }, Purpose::DrawnPoint);
        let way = place % Way::ALL.len();
        by_way[way].extend(measuring.measure(Way::ALL[way], &mut rng));
    }
    if let Some(way) = (0..Way::ALL.len().min(plan.count)).find(|way| by_way[*way].is_empty()) {
        let (way, length, unit) = (Way::ALL[way].name(), plan.length, trial.subject.unit.name());
        return Err(format!(
            "no length of {length} {unit} and more was measured ({way}): expected a shorter `length`, or stations that see more of the board"
        ));
    }
    let counts = found.solution.counts();
    let mut figures = vec![
        Figure::plain(Quantity::CostOverRedundancy, found.solution.cost() / counts.redundancy() as f64, ""),
        Figure::plain(Quantity::Redundancy, counts.redundancy() as f64, ""),
        Figure::plain(Quantity::ImagePoints, (counts.image_coordinates / 2) as f64, ""),
        Figure::plain(Quantity::IsDoubtful, f64::from(u8::from(!found.doubts().is_empty())), ""),
    ];
    for (way, all) in Way::ALL.into_iter().zip(&by_way) {
        figures.extend(of_way(way.name(), all, trial.subject.unit.name()));
    }
    let all: Vec<Measured> = by_way.into_iter().flatten().collect();
    figures.extend(of_way("all", &all, trial.subject.unit.name()));
    Ok(figures)
}

/// Other poses than those of the calibration, from the same stations.
fn measuring_poses(trial: &Trial<'_>, key: Key<'_>) -> Result<Vec<Pose>, String> {
    let of = format!("{}, measuring", key.of);
    let stations = trial.subject.stations_of(Key { of: &of, ..key }).map_err(|error| error.to_string())?;
    Ok(stations.iter().map(|station| station.pose).collect())
}

fn of_way(name: &'static str, all: &[Measured], unit: &'static str) -> Vec<Figure> {
    let count = all.len() as f64;
    if all.is_empty() {
        return Vec::new();
    }
    let mean = |of: &dyn Fn(&Measured) -> f64| all.iter().map(of).sum::<f64>() / count;
    vec![
        Figure {
            name: Quantity::TaskLength.of(&[name]),
            value: mean(&|one| one.length),
            sigma: Some(mean(&|one| one.sigma.powi(2)).sqrt()),
            error: Some(mean(&|one| one.error.powi(2)).sqrt()),
            unit,
        },
        Figure {
            name: Quantity::SquareOfTasks.of(&[name]),
            ..Figure::plain(Quantity::SquareOfLengths, mean(&|one| (one.error / one.sigma).powi(2)), "")
        },
        Figure {
            name: Quantity::TasksWithin.of(&[name]),
            ..Figure::plain(Quantity::LengthsWithin, mean(&|one| f64::from(u8::from(one.error.abs() <= HALF_95 * one.sigma))), "")
        },
    ]
}
