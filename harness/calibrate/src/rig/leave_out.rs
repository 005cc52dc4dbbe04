//! Standard deviations of mounts that the sets themselves show: from leaving some of them out.

use calibench_adjust::{Mount, Options, Rig, RigSolution, adjust_rig, relative};
use calibench_model::Pose;
use calibench_model::camera::CameraModel;
use nalgebra::{DMatrix, Matrix6, Rotation3, UnitQuaternion, Vector6};
use rayon::prelude::*;

use crate::resampled::{GROUPS, MOST, NEAR};

/// Sets at least.
const LEAST: usize = 4;

/// The scatter by leaving sets out.
#[derive(Clone, Debug, PartialEq)]
pub struct BySets {
    /// Groups of sets, each of which was left out once.
    pub groups: usize,
    /// Of each camera.
    pub cameras: Vec<Scatter>,
    /// Covariance of the unknown parameters, in the order of [`calibench_adjust::RigCovariances::parameters`].
    pub parameters: DMatrix<f64>,
}

/// The scatter of a camera's mount.
#[derive(Clone, Debug, PartialEq)]
pub struct Scatter {
    /// Its pose, with the covariance that leaving sets out shows.
    pub mount: Mount,
}

impl BySets {
    /// The jackknife over groups of sets.
    ///
    /// # Errors
    /// Why there is none, in words.
    ///
    /// Source: Efron & Tibshirani 1993, chapter 11.
    pub(super) fn of(solution: &RigSolution<'_>, left_out: &[usize]) -> Result<Self, String> {
        let rig = solution.ended();
        let sets = rig.stations.len();
        if sets < LEAST {
            return Err(format!("{sets} sets; it takes {LEAST}"));
        }
        if rig.network.observations.len() > MOST {
            return Err(format!("more than {MOST} image points"));
        }
        let groups = sets.min(GROUPS);
        let found: Option<Vec<Without>> = (0..groups).into_par_iter().map(|group| without(&rig, left_out, (group, groups))).collect();
        let found = found.ok_or("without some of the sets the rig is not determined")?;
        let factor = (groups - 1) as f64 / groups as f64;
        let scatter = |camera: usize| {
            let own = &solution.mounts()[camera];
            let off: Vec<Vector6<f64>> = found.iter().map(|without| motion(own, &without.mounts[camera])).collect();
            let mean = off.iter().sum::<Vector6<f64>>() / groups as f64;
            let covariance: Matrix6<f64> = off.iter().map(|off| (off - mean) * (off - mean).transpose()).sum::<Matrix6<f64>>() * factor;
            Scatter { mount: Mount { pose: *own, covariance } }
        };
        let width = found.first().map_or(0, |without| without.parameters.len());
        let mean: Vec<f64> = (0..width).map(|k| found.iter().map(|without| without.parameters[k]).sum::<f64>() / groups as f64).collect();
        let product = |i: usize, j: usize| {
            found.iter().map(|without| (without.parameters[i] - mean[i]) * (without.parameters[j] - mean[j])).sum::<f64>() * factor
        };
        Ok(Self { groups, cameras: (0..rig.mounts.len()).map(scatter).collect(), parameters: DMatrix::from_fn(width, width, product) })
    }
}

/// From one pose to a near one: rotation about its axes, radians, and shift along them.
pub fn motion(from: &Pose, to: &Pose) -> Vector6<f64> {
    let step = relative(from, to);
    // The angle of a matrix by its trace is lost where it is small.
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(step.rotation)).scaled_axis();
    Vector6::new(turn.x, turn.y, turn.z, -step.centre.x, -step.centre.y, -step.centre.z)
}

struct Without {
    mounts: Vec<Pose>,
    parameters: Vec<f64>,
}

fn without(rig: &Rig, left_out: &[usize], (group, groups): (usize, usize)) -> Option<Without> {
    let is_out = |image: usize| rig.station_of[image] % groups == group;
    let more = (0..rig.network.observations.len()).filter(|&index| is_out(rig.network.observations[index].image));
    let left_out = left_out.iter().copied().chain(more).collect();
    let solution = adjust_rig(rig, &Options { left_out, most_iterations: NEAR, ..Options::default() }).ok()?;
    let parameters = rig.network.cameras.iter().zip(solution.cameras()).flat_map(|(interior, camera)| {
        let unknown = interior.parameters.iter().zip(camera.parameters()).filter(|(status, _)| status.is_unknown());
        unknown.map(|(_, parameter)| parameter.value).collect::<Vec<_>>()
    });
    Some(Without { mounts: solution.mounts().to_vec(), parameters: parameters.collect() })
}
