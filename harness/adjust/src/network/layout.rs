//! Where everything stands: observations by image and by point, unknowns by block.

use std::ops::Range;

use calibench_model::camera::CameraModel;
use nalgebra::DMatrix;

use super::{Attitude, Centre, Counts, ImageObservation, Network, NetworkError, Status, Triples};

/// An image point, ready for the loops.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sight {
    pub(crate) image: u32,
    pub(crate) point: u32,
    /// Place among the observations as given.
    pub(crate) given: u32,
    /// The pair of its point's triple and its camera; of no meaning where the triple or the camera is known.
    pub(crate) pair: u32,
}

impl Sight {
    /// Index of its image.
    #[inline]
    pub(crate) const fn image(&self) -> usize {
        self.image as usize
    }

    /// Index of its point.
    #[inline]
    pub(crate) const fn point(&self) -> usize {
        self.point as usize
    }

    /// What was measured, among the observations as given: of millions a copy here would be the larger part of the layout.
    #[inline]
    pub(crate) const fn observed<'o>(&self, given: &'o [ImageObservation]) -> &'o ImageObservation {
        &given[self.given as usize]
    }
}

/// Unknowns of a camera.
#[derive(Clone, Debug)]
pub(crate) struct CameraPlace {
    /// Parameters that are unknown.
    pub(crate) free: Vec<usize>,
    /// First of them among those of all cameras.
    pub(crate) offset: usize,
}

/// A triple and a camera that pictures what it moves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    pub(crate) camera: usize,
    /// Of its 3 x n block.
    pub(crate) offset: usize,
}

/// The order of observations and unknowns.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    /// By image, then by point.
    pub(crate) sights: Vec<Sight>,
    pub(crate) of_image: Vec<Range<usize>>,
    /// Sights by triple.
    by_triple: Vec<u32>,
    triple_start: Vec<u32>,
    pub(crate) cameras: Vec<CameraPlace>,
    /// The camera of each image.
    pub(crate) camera_of: Vec<usize>,
    /// Of each camera: whether its images have numbers of their own.
    pub(crate) has_own: Vec<bool>,
    /// Unknowns of all cameras together.
    pub(crate) width: usize,
    /// Of each image: whether its rotation and its centre are unknowns.
    pub(crate) pose_free: Vec<[bool; 2]>,
    /// Which unknowns move which points.
    pub(crate) triples: Triples,
    /// Of each triple: which of its numbers are unknowns.
    pub(crate) triple_free: Vec<[bool; 3]>,
    /// Ends of each distance.
    pub(crate) distances: Vec<[usize; 2]>,
    /// Unknown points that a distance joins to another one, sorted.
    pub(crate) joined: Vec<usize>,
    has_unknown_points: bool,
    /// No observation's point lies behind its camera.
    pub(crate) all_before: bool,
    /// Whether what couples points with cameras and poses is kept for all sights, and not made anew for some points at a time.
    pub(crate) keeps_couplings: bool,
    pub(crate) pairs: Vec<Pair>,
    pair_start: Vec<usize>,
    pub(crate) pair_values: usize,
    pub(crate) counts: Counts,
}

impl Layout {
    /// What rounding of pixels makes of the weighted sum of squares of the observations as `given`.
    pub(crate) fn rounding(&self, given: &[ImageObservation]) -> f64 {
        let rounding = |at: f64, whiten: f64| (4.0 * f64::EPSILON * at.abs().max(1.0) * whiten).powi(2);
        let of = |sight: &Sight| {
            let ImageObservation { position, precision, .. } = sight.observed(given);
            let [a, _, c] = precision.whitening();
            rounding(position.x, a) + rounding(position.y, c)
        };
        self.sights.iter().map(of).sum()
    }

    /// The layout of a checked network of which the datum holds the coordinates `held` (point, axis), without the observations `left_out`.
    pub(crate) fn new(network: &Network, held: &[(usize, usize)], left_out: &[usize]) -> Result<Self, NetworkError> {
        let sights = sights(network, left_out);
        let of_image = ranges(network.images.len(), sights.iter().map(Sight::image));
        let triples = Triples::of(network);
        let known = network.points.iter().map(|point| point.coordinates).chain(network.surfaces.iter().map(|surface| surface.statuses));
        let mut triple_free: Vec<[bool; 3]> = known.map(|statuses| statuses.map(Status::is_unknown)).collect();
        let (by_triple, triple_start) = by_triple(triple_free.len(), &sights, &triples);
        for &(point, axis) in held {
            if network.points[point].coordinates[axis] != Status::Free {
                let (name, axis) = (&network.points[point].name, ["X", "Y", "Z"][axis]);
                return Err(NetworkError::Datum(format!("{axis} of point {name} is known already")));
            }
            triple_free[point][axis] = false;
        }
        let distances: Vec<[usize; 2]> = network.distances.iter().map(|distance| distance.points).collect();
        let is_joint = |ends: &&[usize; 2]| ends.iter().all(|&end| triple_free[end] != [false; 3]);
        let mut joined: Vec<usize> = distances.iter().filter(is_joint).flatten().copied().collect();
        joined.sort_unstable();
        joined.dedup();
        let (cameras, width) = cameras(network);
        let pose_free =
            network.images.iter().map(|image| [image.attitude != Attitude::Fixed, image.centre != Centre::Fixed]).collect::<Vec<_>>();
        let counts = Counts::of(network, sights.len(), held.len());
        let mut layout = Self {
            sights,
            of_image,
            by_triple,
            triple_start,
            cameras,
            camera_of: network.images.iter().map(|image| image.camera).collect(),
            has_own: (0..network.cameras.len()).map(|camera| network.of_each_image(camera).next().is_some()).collect(),
            width,
            pose_free,
            has_unknown_points: triple_free[..network.points.len()].iter().any(|free| *free != [false; 3]),
            all_before: network.observations.iter().all(|o| !o.behind),
            triples,
            triple_free,
            distances,
            joined,
            keeps_couplings: true,
            pairs: Vec::new(),
            pair_start: vec![0],
            pair_values: 0,
            counts,
        };
        layout.find_pairs();
        if counts.unknowns == 0 { Err(NetworkError::NothingUnknown) } else { Ok(layout) }
    }

    fn find_pairs(&mut self) {
        let mut seen = Vec::new();
        for triple in 0..self.triple_free.len() {
            let sights = self.triple_start[triple] as usize..self.triple_start[triple + 1] as usize;
            if self.is_triple_unknown(triple) {
                seen.clear();
                seen.extend(sights.clone().map(|k| self.camera_of[self.sights[self.by_triple[k] as usize].image()]));
                seen.sort_unstable();
                seen.dedup();
                seen.retain(|&camera| !self.cameras[camera].free.is_empty());
            }
            let first = self.pairs.len();
            for &camera in &seen {
                self.pairs.push(Pair { camera, offset: self.pair_values });
                self.pair_values += 3 * self.cameras[camera].free.len();
            }
            for k in sights {
                let sight = &mut self.sights[self.by_triple[k] as usize];
                if let Ok(place) = seen.binary_search(&self.camera_of[sight.image()]) {
                    sight.pair = (first + place) as u32;
                }
            }
            seen.clear();
            self.pair_start.push(self.pairs.len());
        }
    }

    /// Sights of the points that a triple moves.
    pub(crate) fn of_triple(&self, triple: usize) -> impl ExactSizeIterator<Item = usize> + Clone + '_ {
        self.by_triple[self.triple_start[triple] as usize..self.triple_start[triple + 1] as usize].iter().map(|&sight| sight as usize)
    }

    /// Pairs of a triple.
    pub(crate) fn pairs_of(&self, triple: usize) -> Range<usize> {
        self.pair_start[triple]..self.pair_start[triple + 1]
    }

    pub(crate) fn is_triple_unknown(&self, triple: usize) -> bool {
        self.triple_free[triple] != [false; 3]
    }

    /// The one surface of networks whose images have numbers of their own.
    pub(crate) fn surface(&self) -> Option<usize> {
        self.triples.of_surfaces().next()
    }

    /// Whether points stay where they are, but for those of one surface on which all are that were seen: else an image's own numbers would couple all its points.
    pub(crate) fn allows_own(&self, network: &Network) -> bool {
        let on_surface = || self.sights.iter().all(|sight| self.triples.surface_of(sight.point()).is_some());
        network.per_image.is_empty()
            || (!self.has_unknown_points() && (self.triples.surfaces == 0 || (self.triples.surfaces == 1 && on_surface())))
    }

    /// Shares of the numbers of each image's own along the unknown parameters of its camera: n x p.
    pub(crate) fn along(&self, network: &Network, camera: usize) -> DMatrix<f64> {
        let (free, own) = (&self.cameras[camera].free, network.of_each_image(camera).collect::<Vec<_>>());
        let share =
            |parameter: usize, own: &super::PerImage| own.along.iter().filter(|(of, _)| *of == parameter).map(|(_, share)| share).sum();
        DMatrix::from_fn(free.len(), own.len(), |i, j| share(free[i], own[j]))
    }

    pub(crate) fn has_unknown_points(&self) -> bool {
        self.has_unknown_points
    }

    pub(crate) fn is_pose_unknown(&self, image: usize) -> bool {
        self.pose_free[image] != [false; 2]
    }

    /// Which of the six unknowns of an image are free: rotation about the camera's axes, then its centre.
    pub(crate) fn pose_mask(&self, image: usize) -> [bool; 6] {
        let [rotation, centre] = self.pose_free[image];
        [rotation, rotation, rotation, centre, centre, centre]
    }
}

fn sights(network: &Network, left_out: &[usize]) -> Vec<Sight> {
    let mut takes_part = vec![true; network.observations.len()];
    for &index in left_out {
        if let Some(part) = takes_part.get_mut(index) {
            *part = false;
        }
    }
    let mut sights: Vec<Sight> = network
        .observations
        .iter()
        .enumerate()
        .filter(|(given, _)| takes_part[*given])
        .map(|(given, o)| Sight { image: o.image as u32, point: o.point as u32, given: given as u32, pair: u32::MAX })
        .collect();
    // A point is measured once in an image: the order is the same, stable or not.
    sights.sort_unstable_by_key(|sight| (sight.image, sight.point));
    sights
}

/// Ranges of equal keys, of sorted keys below `count`.
fn ranges(count: usize, keys: impl Iterator<Item = usize>) -> Vec<Range<usize>> {
    let mut sizes = vec![0; count];
    keys.for_each(|key| sizes[key] += 1);
    let mut start = 0;
    let range = |size: usize| {
        start += size;
        start - size..start
    };
    sizes.into_iter().map(range).collect()
}

fn by_triple(count: usize, sights: &[Sight], triples: &Triples) -> (Vec<u32>, Vec<u32>) {
    let mut start = vec![0_u32; count + 1];
    sights.iter().for_each(|sight| start[triples.of_point(sight.point()) + 1] += 1);
    (0..count).for_each(|i| start[i + 1] += start[i]);
    let (mut next, mut order) = (start.clone(), vec![0; sights.len()]);
    for (i, sight) in sights.iter().enumerate() {
        let next = &mut next[triples.of_point(sight.point())];
        order[*next as usize] = i as u32;
        *next += 1;
    }
    (order, start)
}

fn cameras(network: &Network) -> (Vec<CameraPlace>, usize) {
    let mut width = 0;
    let place = |interior: &super::Interior| {
        let unknown = |i: &usize| interior.parameters[*i].is_unknown();
        let free: Vec<usize> = (0..interior.camera.parameters().len()).filter(unknown).collect();
        let offset = width;
        width += free.len();
        CameraPlace { free, offset }
    };
    let cameras = network.cameras.iter().map(place).collect();
    (cameras, width)
}
