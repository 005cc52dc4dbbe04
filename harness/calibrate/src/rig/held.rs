//! The same rig with the cameras as their files say.

use calibench_adjust::{Options, RigSolution, Status, adjust_rig};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use super::prepared::RigPrepared;
use crate::ended::ITERATIONS;

/// The rig whose cameras are held as the files say that they started from, against that whose interiors are adjusted.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    /// Weighted sum of squares, a number.
    pub cost: f64,
    /// Probability of so much more of it where the files are right.
    pub p: f64,
    /// Of each camera: how far from its place on the other, object units.
    pub moves: Vec<f64>,
}

impl Held {
    /// Where all cameras have files and some parameter is adjusted.
    pub(super) fn of(prepared: &RigPrepared, solution: &RigSolution<'_>, left_out: &[usize]) -> Option<Self> {
        let starts: Option<Vec<_>> = prepared.asked.settings.cameras.iter().map(|optics| optics.start).collect();
        let starts = starts?;
        let mut rig = solution.ended();
        let mut more = 0;
        for (interior, start) in rig.network.cameras.iter_mut().zip(&starts) {
            // Of another model the file says nothing of single parameters.
            let is_same = std::mem::discriminant(&interior.camera) == std::mem::discriminant(start);
            if !is_same || interior.parameters.iter().any(|status| matches!(status, Status::Observed { .. })) {
                return None;
            }
            more += interior.parameters.iter().filter(|status| status.is_unknown()).count();
            interior.camera = *start;
            interior.parameters.iter_mut().for_each(|status| *status = Status::Fixed);
        }
        if more == 0 {
            return None;
        }
        let options = Options { left_out: left_out.to_vec(), most_iterations: ITERATIONS, ..Options::default() };
        let held = adjust_rig(&rig, &options).ok()?;
        let redundancy = solution.counts().redundancy();
        let fisher = FisherSnedecor::new(more as f64, redundancy as f64).ok()?;
        let gain = (held.cost() - solution.cost()).max(0.0) / more as f64;
        let p = fisher.sf(gain / (solution.cost() / redundancy as f64).max(f64::MIN_POSITIVE));
        let moves = held.mounts().iter().zip(solution.mounts()).map(|(a, b)| (a.centre - b.centre).norm()).collect();
        Some(Self { cost: held.cost(), p, moves })
    }
}
