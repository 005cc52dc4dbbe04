//! Whether the cameras are one rig.

use std::collections::BTreeSet;

use calibench_adjust::{AdjustError, Network, Options, Residual, Rig, RigSolution, Use, adjust, adjust_rig};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use crate::ended::ITERATIONS;

/// Image points from which an image has a pose of its own.
const LEAST: usize = 4;

/// The same observations with each image set free: what the one rig costs.
#[derive(Clone, Debug, PartialEq)]
pub struct OneRig {
    /// Fisher's F, a number, and its degrees of freedom.
    pub f: f64,
    /// Unknowns more of the images set free, and their redundancy.
    pub freedom: [usize; 2],
    /// Probability of one as large where the cameras are one rig and nothing else is wrong.
    pub p: f64,
    /// Standard deviation of unit weight of the rig and of the images set free, numbers.
    pub sigma0: [f64; 2],
    /// Share of the variance of unit weight, 0 to 1, that goes when the images are set free.
    pub explains: f64,
    /// Images without points enough for a pose of their own, which were left out of both.
    pub too_few: usize,
    /// The images that the rig fits least against their own pose: name, RMS with the rig and alone (2D, px); the worst first.
    pub worst: Vec<(String, [f64; 2])>,
}

impl OneRig {
    /// Of a solution, without the observations `left_out`.
    ///
    /// # Errors
    /// Why there is no test, in words.
    pub(super) fn of(solution: &RigSolution<'_>, left_out: &[usize]) -> Result<Self, String> {
        let rig = solution.ended();
        let (alone, left_out) = without_few(&rig.network, left_out);
        let options = Options { left_out, most_iterations: ITERATIONS, ..Options::default() };
        let fewer;
        let (cost, redundancy, of_rig) = if alone == 0 {
            (solution.cost(), solution.counts().redundancy(), solution.residuals())
        } else {
            fewer = adjust_rig(&rig, &options).map_err(|error| error.to_string())?;
            (fewer.cost(), fewer.counts().redundancy(), fewer.residuals())
        };
        let network = in_use(&rig, &options.left_out);
        let free = adjust(&network.0, &Options { left_out: network.1.clone(), ..options })
            .map_err(|error: AdjustError| format!("the images set free have no solution: {error}"))?;
        let (more, rest) = (redundancy - free.counts().redundancy(), free.counts().redundancy());
        if more <= 0 || rest <= 0 {
            return Err("no moment is seen by more than one camera with points enough, or there is no redundancy".into());
        }
        let distribution = FisherSnedecor::new(more as f64, rest as f64).map_err(|error| error.to_string())?;
        let (own, gain) = (free.cost() / rest as f64, (cost - free.cost()).max(0.0) / more as f64);
        let f = gain / own.max(f64::MIN_POSITIVE);
        let sigma0 = [(cost / redundancy as f64).sqrt(), own.sqrt()];
        let explains = (1.0 - (sigma0[1] / sigma0[0].max(f64::MIN_POSITIVE)).powi(2)).max(0.0);
        let of_free = free.residuals();
        let worst = worst(&rig.network, &of_rig, &of_free);
        Ok(Self { f, freedom: [more as usize, rest as usize], p: distribution.sf(f), sigma0, explains, too_few: alone, worst })
    }
}

/// How many images have too few points in use for a pose of their own, and the observations that are left out without them.
fn without_few(network: &Network, left_out: &[usize]) -> (usize, Vec<usize>) {
    let gone: BTreeSet<usize> = left_out.iter().copied().collect();
    let mut count = vec![0; network.images.len()];
    let used = network.observations.iter().enumerate().filter(|(index, _)| !gone.contains(index));
    used.for_each(|(_, o)| count[o.image] += 1);
    let few = |o: &calibench_adjust::ImageObservation| count[o.image] < LEAST;
    let all = (0..network.observations.len()).filter(|&index| gone.contains(&index) || few(&network.observations[index])).collect();
    (count.iter().filter(|&&count| count > 0 && count < LEAST).count(), all)
}

/// The network of images that have points in use. Observations keep their places.
fn in_use(rig: &Rig, left_out: &[usize]) -> (Network, Vec<usize>) {
    let gone: BTreeSet<usize> = left_out.iter().copied().collect();
    let mut network = rig.network.clone();
    let mut used = vec![false; network.images.len()];
    network.observations.iter().enumerate().filter(|(index, _)| !gone.contains(index)).for_each(|(_, o)| used[o.image] = true);
    for (image, _) in network.images.iter_mut().zip(&used).filter(|(_, used)| !**used) {
        (image.centre, image.attitude) = (calibench_adjust::Centre::Fixed, calibench_adjust::Attitude::Fixed);
    }
    (network, left_out.to_vec())
}

fn worst(network: &Network, of_rig: &[Residual], of_free: &[Residual]) -> Vec<(String, [f64; 2])> {
    const SHOWN: usize = 3;
    let mut sums = vec![([0.0; 2], 0); network.images.len()];
    for (rig, free) in of_rig.iter().zip(of_free).filter(|(rig, _)| rig.used != Use::LeftOut) {
        let square = |residual: &Residual| residual.v.map_or(0.0, |[x, y]| x * x + y * y);
        let (sum, count) = &mut sums[rig.image];
        (sum[0], sum[1], *count) = (sum[0] + square(rig), sum[1] + square(free), *count + 1);
    }
    let mut order: Vec<usize> = (0..sums.len()).filter(|&image| sums[image].1 > 0).collect();
    let costs = |image: usize| sums[image].0[0] - sums[image].0[1];
    order.sort_by(|&a, &b| costs(b).total_cmp(&costs(a)));
    let rms = |image: usize| sums[image].0.map(|sum| (sum / f64::from(sums[image].1)).sqrt());
    order.into_iter().take(SHOWN).map(|image| (network.images[image].name.clone(), rms(image))).collect()
}
