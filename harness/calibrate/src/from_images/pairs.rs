//! Pairs of images to begin with.

use std::collections::BTreeMap;

use calibench_adjust::approximate::{RelativeOrientation, Search, Tolerance, orient_relatively};
use calibench_model::PixelPoint;
use calibench_model::camera::Camera;
use calibench_model::upper_median;
use nalgebra::Point3;

use crate::Survey;
use crate::start::spread;

/// Targets that a pair must have in common.
const FEWEST: usize = 8;
/// Pairs that are oriented, and targets of which it is counted who sees them together.
const MOST: usize = 12;
const COUNTED: usize = 2000;
/// Common targets from which more of them add nothing.
const ENOUGH: usize = 80;
/// Angle between rays at which the depth of a point is as good as it gets, rad; below the second there is none.
const GOOD: f64 = 0.5;
const PARALLEL: f64 = 0.02;

/// Two images that are oriented relatively.
pub(super) struct Seed {
    pub(super) images: [usize; 2],
    pub(super) orientation: RelativeOrientation,
    /// Targets with their coordinates in the first image's axes, base lengths.
    pub(super) points: Vec<(usize, Point3<f64>)>,
    score: f64,
}

/// Pairs of images with targets in common, those with most first; of many some, spread over their order.
pub(super) fn candidates(survey: &Survey) -> Vec<[usize; 2]> {
    let mut together: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    let targets: Vec<usize> = match survey.targets() {
        all if all <= COUNTED => (0..all).collect(),
        all => spread(all, COUNTED).collect(),
    };
    for target in targets {
        let images: Vec<usize> = survey.of_target(target).map(|index| survey.sight(index).image).collect();
        // Of a target that very many see, some pairs do.
        let stride = 1 + images.len() / 200;
        for (i, &a) in images.iter().enumerate().step_by(stride) {
            images[i + 1..].iter().step_by(stride).for_each(|&b| *together.entry([a.min(b), a.max(b)]).or_default() += 1);
        }
    }
    let mut pairs: Vec<([usize; 2], usize)> = together.into_iter().filter(|(_, count)| *count >= FEWEST).collect();
    pairs.sort_by_key(|(pair, count)| (usize::MAX - count, *pair));
    // Those with most in common may be taken from one place: others with at least half as many are tried as well.
    let half = pairs.first().map_or(0, |(_, most)| most / 2);
    let near = pairs.iter().take_while(|(_, count)| *count >= half).count();
    if near <= MOST {
        return pairs.into_iter().take(MOST).map(|(pair, _)| pair).collect();
    }
    spread(near, MOST).map(|place| pairs[place].0).collect()
}

/// The candidates that can be oriented, the best first: many points, whose rays meet at good angles.
pub(super) fn seeds(survey: &Survey, owners: &[usize], cameras: &[Camera], candidates: &[[usize; 2]]) -> Vec<Seed> {
    let mut seeds: Vec<Seed> = candidates.iter().filter_map(|pair| seed(survey, owners, cameras, *pair)).collect();
    seeds.sort_by(|a, b| b.score.total_cmp(&a.score).then(a.images.cmp(&b.images)));
    seeds
}

fn seed(survey: &Survey, owners: &[usize], cameras: &[Camera], images: [usize; 2]) -> Option<Seed> {
    let common = common(survey, images);
    let own = images.map(|image| &cameras[owners[image]]);
    let pixels: Vec<[PixelPoint; 2]> = common.iter().map(|(_, pixels)| *pixels).collect();
    let against = Search { seed: 1, tolerance: Tolerance::Unknown };
    let orientation = orient_relatively(own, &pixels, &against).ok()?;
    let agrees = |k: &usize| orientation.rejected.binary_search(k).is_err();
    let found = (0..common.len()).filter(agrees).filter_map(|k| {
        let point = orientation.model_point(own, pixels[k], PARALLEL).ok()?;
        Some((common[k].0, point.position, point.angle))
    });
    let found: Vec<(usize, Point3<f64>, f64)> = found.collect();
    let angle = upper_median(found.iter().map(|(.., angle)| *angle).collect::<Vec<_>>())?;
    if found.len() < FEWEST {
        return None;
    }
    let count = found.len().min(ENOUGH) as f64;
    let plane = if orientation.rival.is_some() { 0.3 } else { 1.0 };
    let score = count * (angle / GOOD).min(1.0) * plane;
    Some(Seed { images, orientation, points: found.into_iter().map(|(target, point, _)| (target, point)).collect(), score })
}

/// Targets that both images show, with where.
fn common(survey: &Survey, images: [usize; 2]) -> Vec<(usize, [PixelPoint; 2])> {
    let sights = |image: usize| -> BTreeMap<usize, PixelPoint> {
        survey.of_image(image).map(|index| survey.sight(index)).map(|sight| (sight.target, sight.position)).collect()
    };
    let (a, b) = (sights(images[0]), sights(images[1]));
    let common: Vec<(usize, [PixelPoint; 2])> = a.into_iter().filter_map(|(target, at)| Some((target, [at, *b.get(&target)?]))).collect();
    if common.len() <= ENOUGH { common } else { spread(common.len(), ENOUGH).map(|place| common[place]).collect() }
}
