//! What couples points with cameras and poses, made anew for some points at a time where all of it would be larger than all else together.

use std::ops::Range;

use super::elimination_order::{Eliminated, Ordered};
use crate::normal::{Rows, Scratch};

/// Sights whose couplings are made at a time.
const CHUNK: usize = if cfg!(test) { 64 } else { 1 << 14 };

/// The couplings of some points that follow each other.
#[derive(Default)]
pub(crate) struct Window {
    points: Range<usize>,
    /// Of each image: its first sight here, and the place of that one's block.
    images: Vec<(usize, usize)>,
    /// Of each sight, 3 x 6.
    poses: Vec<[f64; 18]>,
    /// Of each pair of a point and a camera, 3 x n, one after the other.
    cameras: Vec<f64>,
    first_pair: usize,
    rows: Rows,
    scratch: Scratch,
}

impl Window {
    /// Makes sure that the couplings of a member are at hand: stored, or made here.
    pub(super) fn hold(&mut self, of: Ordered, member: usize) {
        let layout = &of.engine.layout;
        if layout.keeps_couplings || of.engine.plan.eliminated == Eliminated::Poses || self.points.contains(&member) {
            return;
        }
        let (mut end, mut sights) = (member, 0);
        while end < layout.triple_free.len() && (end == member || sights < CHUNK) {
            sights += layout.of_triple(end).len();
            end += 1;
        }
        self.points = member..end;
        self.images.clear();
        self.poses.clear();
        let offset = |point: usize| layout.pairs.get(layout.pairs_of(point).start).map_or(layout.pair_values, |pair| pair.offset);
        self.first_pair = offset(member);
        let values = if end < layout.triple_free.len() { offset(end) } else { layout.pair_values } - self.first_pair;
        self.cameras.clear();
        self.cameras.resize(values, 0.0);
        for (image, range) in layout.of_image.iter().enumerate() {
            let own = &layout.sights[range.clone()];
            let of_points = |bound: usize| range.start + own.partition_point(|sight| sight.point() < bound);
            self.fill(of, image, of_points(member)..of_points(end));
        }
    }

    fn fill(&mut self, of: Ordered, image: usize, sights: Range<usize>) {
        let (engine, layout) = (of.engine, &of.engine.layout);
        self.images.push((sights.start, self.poses.len()));
        if sights.is_empty() {
            return;
        }
        // The state pictures all sights: its normal equations are there.
        let pictured = self.rows.fill((engine.network, layout), of.state, engine.loss, (image, &[]), sights.clone(), &mut self.scratch);
        debug_assert!(pictured.is_ok());
        let width = layout.cameras[layout.camera_of[image]].free.len();
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        for index in sights {
            let (row, sight) = (self.rows.of(index), &layout.sights[index]);
            let (by_pose, by_point) = (&row[width..width + 6], &row[width + 6..]);
            self.poses.push(std::array::from_fn(|k| dot(by_point[k / 6], by_pose[k % 6])));
            if width > 0 && layout.is_triple_unknown(sight.point()) {
                let block = &mut self.cameras[layout.pairs[sight.pair as usize].offset - self.first_pair..][..3 * width];
                for (j, column) in row[..width].iter().enumerate() {
                    (0..3).for_each(|i| block[i * width + j] += dot(by_point[i], *column));
                }
            }
        }
    }

    /// The coupling of a sight's point with its pose: 3 x 6.
    #[inline]
    pub(super) fn pose<'a>(&'a self, of: Ordered<'a>, sight: usize) -> &'a [f64; 18] {
        if of.engine.layout.keeps_couplings {
            return &of.normals.point_pose[sight];
        }
        let (first, place) = self.images[of.engine.layout.sights[sight].image()];
        &self.poses[place + sight - first]
    }

    /// The coupling of a point with a camera from the value `first` of all pairs on.
    #[inline]
    pub(super) fn camera<'a>(&'a self, of: Ordered<'a>, first: usize) -> &'a [f64] {
        if of.engine.layout.keeps_couplings { &of.normals.point_camera[first..] } else { &self.cameras[first - self.first_pair..] }
    }
}
