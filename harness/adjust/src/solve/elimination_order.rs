//! Which unknowns are eliminated first, and where the others stand in what remains.

use super::Engine;
use super::window::Window;
use crate::network::Layout;
use crate::normal::Normals;
use crate::state::State;

/// Rows of a column that are not yet worth sorting.
const FEW_ROWS: usize = 64;

/// The blocks that are eliminated one by one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Eliminated {
    /// Exterior orientations: of boards, whose points are known or few.
    Poses,
    /// Object points: of bundles.
    Points,
}

/// Where the coupling of an eliminated block with a kept one comes from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Source {
    /// A camera with an image: the image.
    PoseCamera(usize),
    /// A camera with a point: the first of the 3 x n values.
    PointCamera(usize),
    /// A pose with a point: the sight.
    Sight(usize),
    /// A pose with a surface: its place among all blocks of images and surfaces.
    Surface(usize),
}

/// What a kept block beyond those of the cameras holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kept {
    /// The exterior orientation of an image.
    Pose(usize),
    /// A triple: a point, or the coefficients of a surface.
    Point(usize),
}

/// A kept block that an eliminated one is coupled with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coupled {
    pub(crate) source: Source,
    /// Among the kept blocks.
    pub(crate) block: usize,
    pub(crate) offset: usize,
    pub(crate) width: usize,
}

/// The normal equations in the order of elimination, and the values at which they were made.
#[derive(Clone, Copy)]
pub(crate) struct Ordered<'a> {
    pub(crate) engine: &'a Engine<'a>,
    pub(crate) state: &'a State,
    pub(crate) normals: &'a Normals,
}

/// The order of elimination.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) eliminated: Eliminated,
    /// Images or points that are eliminated.
    pub(crate) members: Vec<usize>,
    /// First unknown of each kept block, and of none at the end.
    pub(crate) kept: Vec<usize>,
    /// The kept block of each image, or `usize::MAX`.
    pub(crate) pose_block: Vec<usize>,
    /// The kept block of each triple, or `usize::MAX`.
    pub(crate) point_block: Vec<usize>,
    /// What each kept block beyond those of the cameras holds, in their order.
    others: Vec<Kept>,
}

impl Plan {
    pub(crate) fn of(layout: &Layout) -> Self {
        let points = (0..layout.triple_free.len()).filter(|&i| layout.is_triple_unknown(i)).collect::<Vec<_>>();
        let poses = (0..layout.pose_free.len()).filter(|&i| layout.is_pose_unknown(i)).collect::<Vec<_>>();
        // All images see a surface: eliminated, it would couple each with each.
        let is_of_boards = 6 * poses.len() > 3 * points.len() || layout.triples.surfaces > 0;
        let (eliminated, members, others): (_, _, Vec<Kept>) = if is_of_boards {
            (Eliminated::Poses, poses, points.into_iter().map(Kept::Point).collect())
        } else {
            // Members are coupled with what is kept alone: the ends of a distance are.
            let (joined, members): (Vec<usize>, _) = points.into_iter().partition(|point| layout.joined.binary_search(point).is_ok());
            let poses = poses.into_iter().map(Kept::Pose);
            (Eliminated::Points, members, poses.chain(joined.into_iter().map(Kept::Point)).collect())
        };
        let mut kept: Vec<usize> = layout.cameras.iter().map(|camera| camera.offset).collect();
        let (mut pose_block, mut point_block) = (vec![usize::MAX; layout.pose_free.len()], vec![usize::MAX; layout.triple_free.len()]);
        let mut end = layout.width;
        for other in &others {
            let block = kept.len();
            kept.push(end);
            match *other {
                Kept::Pose(image) => (pose_block[image], end) = (block, end + 6),
                Kept::Point(point) => (point_block[point], end) = (block, end + 3),
            }
        }
        kept.push(end);
        Self { eliminated, members, kept, pose_block, point_block, others }
    }

    /// Kept blocks beyond those of the cameras: what each holds, and its place among all.
    pub(crate) fn others(&self) -> impl Iterator<Item = (Kept, usize)> + '_ {
        let first = self.kept.len() - 1 - self.others.len();
        self.others.iter().enumerate().map(move |(i, kept)| (*kept, first + i))
    }

    /// Sights of a kept point whose poses are kept too, with the pose's block.
    pub(crate) fn kept_sights(&self, layout: &Layout, point: usize) -> impl Iterator<Item = (usize, usize)> {
        let sights = if self.eliminated == Eliminated::Points { Some(layout.of_triple(point)) } else { None };
        let block = |sight: usize| (sight, self.pose_block[layout.sights[sight].image()]);
        sights.into_iter().flatten().map(block).filter(|(_, block)| *block != usize::MAX)
    }

    /// The blocks of two points that a distance joins, the lower one in the matrix first; `None` if one of them is known.
    pub(crate) fn joint(&self, ends: [usize; 2]) -> Option<[usize; 2]> {
        let [a, b] = ends.map(|point| self.point_block[point]);
        (a != usize::MAX && b != usize::MAX).then(|| [a.max(b), a.min(b)])
    }

    /// What a member is coupled with, sorted by offset: found where it is needed, since all lists together are longer than the observations.
    pub(crate) fn couple(&self, layout: &Layout, place: usize, into: &mut Vec<Coupled>) {
        let member = self.members[place];
        into.clear();
        let mut push = |source: Source, block: usize| {
            if block != usize::MAX && self.width(block) > 0 {
                into.push(Coupled { source, block, offset: self.kept[block], width: self.width(block) });
            }
        };
        match self.eliminated {
            Eliminated::Poses => {
                push(Source::PoseCamera(member), layout.camera_of[member]);
                for sight in layout.of_image[member].clone() {
                    push(Source::Sight(sight), self.point_block[layout.sights[sight].point()]);
                }
                for (surface, triple) in layout.triples.of_surfaces().enumerate() {
                    push(Source::Surface(member * layout.triples.surfaces + surface), self.point_block[triple]);
                }
            }
            Eliminated::Points => {
                for pair in &layout.pairs[layout.pairs_of(member)] {
                    push(Source::PointCamera(pair.offset), pair.camera);
                }
                for sight in layout.of_triple(member) {
                    push(Source::Sight(sight), self.pose_block[layout.sights[sight].image()]);
                }
            }
        }
    }

    /// Unknowns of a kept block.
    pub(crate) fn width(&self, block: usize) -> usize {
        self.kept[block + 1] - self.kept[block]
    }

    /// Unknowns that are kept.
    pub(crate) fn size(&self) -> usize {
        self.kept[self.kept.len() - 1]
    }

    /// Unknowns of a member.
    pub(crate) const fn depth(&self) -> usize {
        match self.eliminated {
            Eliminated::Poses => 6,
            Eliminated::Points => 3,
        }
    }

    /// Of each column of kept blocks the rows at or below that have a block in the reduced matrix.
    pub(crate) fn pattern(&self, layout: &Layout) -> Vec<Vec<usize>> {
        let mut columns: Vec<Column> = (0..self.kept.len() - 1).map(|block| Column { rows: vec![block], most: 0 }).collect();
        let mut coupled = Vec::new();
        for place in 0..self.members.len() {
            self.couple(layout, place, &mut coupled);
            for (i, column) in coupled.iter().enumerate() {
                columns[column.block].add(coupled[i..].iter().map(|row| row.block));
            }
        }
        for (kept, block) in self.others() {
            match kept {
                Kept::Pose(image) => columns[layout.camera_of[image]].add(std::iter::once(block)),
                Kept::Point(point) => {
                    layout.pairs[layout.pairs_of(point)].iter().for_each(|pair| columns[pair.camera].add(std::iter::once(block)));
                    self.kept_sights(layout, point).for_each(|(_, pose)| columns[pose].add(std::iter::once(block)));
                }
            }
        }
        layout.distances.iter().filter_map(|ends| self.joint(*ends)).for_each(|[low, high]| columns[high].add(std::iter::once(low)));
        columns.into_iter().map(Column::rows).collect()
    }
}

/// Rows of a column of blocks, each as often as it was found since they were last sorted.
struct Column {
    rows: Vec<usize>,
    /// Beyond so many they are sorted.
    most: usize,
}

impl Column {
    fn add(&mut self, rows: impl Iterator<Item = usize>) {
        self.rows.extend(rows);
        if self.rows.len() > self.most {
            self.sort();
            self.most = 2 * self.rows.len() + FEW_ROWS;
        }
    }

    fn sort(&mut self) {
        self.rows.sort_unstable();
        self.rows.dedup();
    }

    fn rows(mut self) -> Vec<usize> {
        self.sort();
        self.rows
    }
}

impl Ordered<'_> {
    /// Copies row `d` of a coupling, of `width` numbers, to `into`.
    #[inline]
    pub(crate) fn coupling_row(&self, window: &Window, coupled: &Coupled, d: usize, into: &mut [f64]) {
        let (own, width) = (d * coupled.width, coupled.width);
        match (coupled.source, self.engine.plan.eliminated) {
            (Source::PoseCamera(image), _) => into.copy_from_slice(&self.normals.pose_camera[image][own..][..width]),
            (Source::PointCamera(first), _) => into.copy_from_slice(&window.camera(*self, first)[own..][..width]),
            (Source::Surface(place), _) => {
                let block = &self.normals.surface_pose[place];
                (0..3).for_each(|i| into[i] = block[6 * i + d]);
            }
            (Source::Sight(sight), Eliminated::Points) => into.copy_from_slice(&window.pose(*self, sight)[6 * d..6 * d + 6]),
            (Source::Sight(sight), Eliminated::Poses) => {
                let block = window.pose(*self, sight);
                (0..3).for_each(|i| into[i] = block[6 * i + d]);
            }
        }
    }
}
