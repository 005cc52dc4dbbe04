//! Whether the errors of image points are their own. A wrong measurement is off alone; what lens, board or motion leave is off alike at neighbours: in the image,
//! at the same place of the lens in other images, and of the same target from image to image.

use std::collections::{BTreeMap, BTreeSet};

use calibench_adjust::{Residual, Solution};
use nalgebra::Vector3;

use crate::start::spread;

/// Neighbours of an image point that are asked.
const NEAREST: usize = 4;
/// Points that are asked for them, at most: of an image, of a lens, of a target.
const MOST: usize = 500;
/// Points of a lens among which they are sought, at most.
const AMONG: usize = 20_000;
/// Standard deviations by which a sum of likenesses must exceed none, and their mean, to be no chance.
const SIGMAS: f64 = 4.0;
const MEAN: f64 = 0.3;
/// The same of one target, of whose images nearly all have to agree.
const SIGMAS_OF_TARGET: f64 = 3.0;
const MEAN_OF_TARGET: f64 = 0.5;

/// An image point where the adjusted pose has it. Neither a wrong measurement nor a wrong lens moves that among foreign neighbours.
struct Seen {
    observation: usize,
    image: usize,
    camera: usize,
    target: usize,
    /// From the projection centre, camera axes, of unit length.
    ray: Vector3<f64>,
    /// Its residual, px; `None` where the camera does not picture it.
    off: Option<[f64; 2]>,
    /// The same in object axes.
    across: Vector3<f64>,
}

/// The image points of a solution, those that were left out as well.
fn seen(solution: &Solution<'_>) -> Vec<Seen> {
    let network = solution.network();
    let of = |residual: Residual| {
        let pose = &solution.poses()[residual.image];
        let ray = pose.camera_from_world(&solution.points()[residual.point]);
        let [x, y] = residual.v.unwrap_or_default();
        Seen {
            observation: residual.observation,
            image: residual.image,
            camera: network.images[residual.image].camera,
            target: residual.point,
            ray: ray / ray.norm().max(f64::MIN_POSITIVE),
            off: residual.v,
            // Rows count downwards.
            across: pose.rotation.transpose() * Vector3::new(x, -y, 0.0),
        }
    };
    solution.each_residual().map(of).collect()
}

/// How alike errors are in pairs. Of two errors that is the cosine of the angle between them times the root of the ratio of the shorter to the longer: 1 of the same, 0 on
/// average of independent directions, whatever their lengths, and near 0 where one of them is far smaller.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Likeness {
    sum: f64,
    pairs: usize,
}

impl Likeness {
    /// Of the observations that `asks` is true of with their neighbours in the same image.
    pub(crate) fn in_images(solution: &Solution<'_>, asks: impl Fn(usize) -> bool) -> Self {
        grouped(&seen(solution), |seen| seen.image).values().map(|image| Self::of_nearest(image, &asks)).fold(Self::default(), Self::with)
    }

    /// Of those of some points of one image, or of one lens, that `asks` is true of, with their nearest.
    fn of_nearest(all: &[&Seen], asks: &impl Fn(usize) -> bool) -> Self {
        let asked: Vec<usize> = (0..all.len()).filter(|&place| asks(all[place].observation)).collect();
        let among: Vec<usize> = spread(all.len(), all.len().min(AMONG)).collect();
        let mut pairs = BTreeSet::new();
        for place in spread(asked.len(), asked.len().min(MOST)).map(|k| asked[k]) {
            let away = |other: usize| (all[other].ray - all[place].ray).norm_squared();
            let mut others: Vec<(f64, usize)> = among.iter().filter(|&&other| other != place).map(|&other| (away(other), other)).collect();
            let near = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
            if others.len() > NEAREST {
                others.select_nth_unstable_by(NEAREST - 1, near);
                others.truncate(NEAREST);
            }
            pairs.extend(others.iter().map(|&(_, other)| (place.min(other), place.max(other))));
        }
        pairs.iter().fold(Self::default(), |all_pairs, &(a, b)| all_pairs.with(Self::of_pair(all[a].off, all[b].off)))
    }

    /// What is not pictured at all goes with anything: no measurement is the reason.
    fn of_pair(a: Option<[f64; 2]>, b: Option<[f64; 2]>) -> Self {
        let sum = match (a, b) {
            (Some(a), Some(b)) => like(a[0] * b[0] + a[1] * b[1], a[0] * a[0] + a[1] * a[1], b[0] * b[0] + b[1] * b[1]),
            _ => 1.0,
        };
        Self { sum, pairs: 1 }
    }

    /// Of the errors of one target in its images, on the object, of which at least one of two is asked for.
    fn of_target(all: &[&Seen], asks: &impl Fn(usize) -> bool) -> Self {
        let all: Vec<&Seen> = spread(all.len(), all.len().min(MOST)).map(|k| all[k]).filter(|seen| seen.off.is_some()).collect();
        let asked: Vec<bool> = all.iter().map(|seen| asks(seen.observation)).collect();
        let mut found = Self::default();
        for (k, a) in all.iter().enumerate() {
            for b in (0..k).filter(|&b| asked[k] || asked[b]).map(|b| all[b]) {
                let sum = like(a.across.dot(&b.across), a.across.norm_squared(), b.across.norm_squared());
                found = found.with(Self { sum, pairs: 1 });
            }
        }
        found
    }

    fn with(self, other: Self) -> Self {
        Self { sum: self.sum + other.sum, pairs: self.pairs + other.pairs }
    }

    /// Their mean: 0 of errors that are their points' own, 1 of such as are alike; 0 of none.
    pub(crate) fn mean(self) -> f64 {
        if self.pairs == 0 { 0.0 } else { self.sum / self.pairs as f64 }
    }

    /// Whether they are more alike than chance makes. Of independent directions a likeness has the variance one half at most, and two have no covariance, even if they share an error.
    fn exceeds(self, mean: f64, sigmas: f64) -> bool {
        self.mean() > mean && self.sum > sigmas * (0.5 * self.pairs as f64).sqrt()
    }
}

/// Of the product of two errors and the squares of their lengths.
fn like(product: f64, a: f64, b: f64) -> f64 {
    let (short, long) = (a.min(b), a.max(b));
    if short > 0.0 { product / (short * long * long * long).powf(0.25) } else { 0.0 }
}

fn grouped(all: &[Seen], of: impl Fn(&Seen) -> usize) -> BTreeMap<usize, Vec<&Seen>> {
    let mut groups: BTreeMap<usize, Vec<&Seen>> = BTreeMap::new();
    all.iter().for_each(|seen| groups.entry(of(seen)).or_default().push(seen));
    groups
}

/// Whether the errors of some observations are their own: neither those of their neighbours in the image nor at the same place of the lens, nor those of their target in
/// nearly all of its images.
pub(crate) fn are_own(solution: &Solution<'_>, some: &BTreeSet<usize>) -> bool {
    if some.is_empty() {
        return true;
    }
    let asks = |observation: usize| some.contains(&observation);
    let all = seen(solution);
    let near = |of: fn(&Seen) -> usize| {
        grouped(&all, of).values().map(|group| Likeness::of_nearest(group, &asks)).fold(Likeness::default(), Likeness::with)
    };
    let go_together = [near(|seen| seen.image), near(|seen| seen.camera)].into_iter().any(|found| found.exceeds(MEAN, SIGMAS));
    let of_targets = || {
        let mut targets = grouped(&all, |seen| seen.target);
        targets.retain(|_, target| target.iter().any(|seen| asks(seen.observation)));
        targets.values().any(|target| Likeness::of_target(target, &asks).exceeds(MEAN_OF_TARGET, SIGMAS_OF_TARGET))
    };
    !go_together && !of_targets()
}

#[cfg(test)]
mod tests {
    use calibench_adjust::{ImageObservation, Network, Options, adjust};
    use calibench_model::PixelPoint;

    use super::*;
    use crate::scenes::{SIZE, Scene, board, lens, settings};

    /// Random numbers from 0 to 1 (Knuth's congruence).
    fn uniform(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A board from seven sides, 63 corners in each image, in their order.
    fn network() -> Network {
        Scene { sigma: 0.1, ..board(lens()) }.prepared(&settings("opencv5")).unwrap().network
    }

    /// Whether the errors of those observations are their own that get some, after an adjustment without them. At least so many do.
    fn own(least: usize, mut error: impl FnMut(&ImageObservation) -> Option<[f64; 2]>) -> bool {
        let mut network = network();
        let mut left_out = BTreeSet::new();
        for (index, o) in network.observations.iter_mut().enumerate() {
            if let Some([x, y]) = error(o) {
                o.position = PixelPoint::new(o.position.x + x, o.position.y + y);
                left_out.insert(index);
            }
        }
        assert!(left_out.len() >= least, "{} of {}", left_out.len(), network.observations.len());
        let options = Options { left_out: left_out.iter().copied().collect(), ..Options::default() };
        are_own(&adjust(&network, &options).unwrap(), &left_out)
    }

    fn from_middle(o: &ImageObservation) -> [f64; 2] {
        [o.position.x - 0.5 * f64::from(SIZE.width - 1), o.position.y - 0.5 * f64::from(SIZE.height - 1)]
    }

    /// From an observation to that of another point in the same image.
    fn to(network: &Network, o: &ImageObservation, point: usize) -> Option<[f64; 2]> {
        let other = network.observations.iter().find(|other| other.image == o.image && other.point == point)?;
        Some([other.position.x - o.position.x, other.position.y - o.position.y])
    }

    /// Wherever they are and wherever they lead to, at the border and beyond it as in the middle.
    #[test]
    fn wrong_measurements_are_off_alone() {
        for seed in 0..40 {
            let mut state = 12_345 + 1_000_003 * seed;
            for share in [0.02, 0.1, 0.3] {
                let mut drawn = || [0; 3].map(|_| uniform(&mut state));
                let anywhere = |[chosen, x, y]: [f64; 3], o: &ImageObservation| {
                    let to = [x * f64::from(SIZE.width - 1), y * f64::from(SIZE.height - 1)];
                    (chosen < share).then(|| [to[0] - o.position.x, to[1] - o.position.y])
                };
                assert!(own(1, |o| anywhere(drawn(), o)), "{seed}: {share}, anywhere");
                let near = |[chosen, length, angle]: [f64; 3]| {
                    let (sin, cos) = (std::f64::consts::TAU * angle).sin_cos();
                    (chosen < share).then_some([(3.0 + 27.0 * length) * cos, (3.0 + 27.0 * length) * sin])
                };
                assert!(own(1, |_| near(drawn())), "{seed}: {share}, nearby");
                let is_far = |o: &ImageObservation| from_middle(o).map(|d| d * d).iter().sum::<f64>() > 400.0 * 400.0;
                assert!(own(0, |o| near(drawn()).filter(|_| is_far(o))), "{seed}: {share}, far from the middle");
            }
        }
        // The names of two beside one another in each of three images.
        let network = network();
        let pairs = [(0, 20, 21), (1, 30, 31), (4, 40, 49)];
        let exchanged = |o: &ImageObservation| {
            let of = |&(image, a, b): &(usize, usize, usize)| {
                let other = if o.point == a { Some(b) } else { (o.point == b).then_some(a) };
                other.filter(|_| o.image == image)
            };
            to(&network, o, pairs.iter().find_map(of)?)
        };
        assert!(own(6, exchanged));
    }

    #[test]
    fn what_neighbours_share_is_no_error_of_a_point() {
        // A lens that pictures its border 5 px and more farther out: of each image some corners at most.
        let lens = |o: &ImageObservation| {
            let [x, y] = from_middle(o);
            let (r, far) = (x.hypot(y), 450.0);
            (r > far).then(|| [x, y].map(|d| d / r * (5.0 + 0.1 * (r - far))))
        };
        assert!(!own(10, lens));
        // The right part of one image.
        let part =
            |o: &ImageObservation| (o.image == 2 && o.position.x > 900.0).then_some([3.0 + 0.01 * o.position.x, 0.005 * o.position.y]);
        assert!(!own(10, part));
        // One control point in all images, and two that have each other's names.
        let network = network();
        let moved = |o: &ImageObservation| {
            let d = network.images[o.image].pose.rotation * Vector3::new(5.0, 2.0, 0.0);
            (o.point == 40).then_some([3.0 * d.x, -3.0 * d.y])
        };
        assert!(!own(7, moved));
        let swapped = |o: &ImageObservation| match o.point {
            11 => to(&network, o, 12),
            12 => to(&network, o, 11),
            _ => None,
        };
        assert!(!own(14, swapped));
    }

    #[test]
    fn errors_are_alike_in_direction_and_length() {
        let of = |a, b| Likeness::of_pair(a, b).mean();
        assert!((of(Some([3.0, 4.0]), Some([3.0, 4.0])) - 1.0).abs() < 1e-12);
        assert!((of(Some([3.0, 4.0]), Some([-12.0, -16.0])) + 0.5).abs() < 1e-12);
        assert_eq!(of(Some([3.0, 4.0]), Some([4.0, -3.0])), 0.0);
        assert_eq!(of(Some([0.0, 0.0]), Some([0.0, 0.0])), 0.0);
        // What is not pictured is no measurement's fault.
        assert_eq!(of(None, Some([1.0, 0.0])), 1.0);
        assert_eq!(Likeness::default().mean(), 0.0);
        assert!(!Likeness { sum: 4.0, pairs: 4 }.exceeds(MEAN, SIGMAS), "too few to say");
        assert!(Likeness { sum: 40.0, pairs: 60 }.exceeds(MEAN, SIGMAS) && !Likeness { sum: 200.0, pairs: 1000 }.exceeds(MEAN, SIGMAS));
    }
}
