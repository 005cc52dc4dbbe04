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
    /// The kept block of each point or image that is kept, or `usize::MAX`.
    pub(crate) block_of: Vec<usize>,
}

impl Plan {
    pub(crate) fn of(layout: &Layout) -> Self {
        let points = (0..layout.triple_free.len()).filter(|&i| layout.is_triple_unknown(i)).collect::<Vec<_>>();
        let poses = (0..layout.pose_free.len()).filter(|&i| layout.is_pose_unknown(i)).collect::<Vec<_>>();
        // All images see a surface: eliminated, it would couple each with each.
        let (eliminated, members, others, size, count) = if 6 * poses.len() > 3 * points.len() || layout.triples.surfaces > 0 {
            (Eliminated::Poses, poses, points, 3, layout.triple_free.len())
        } else {
            (Eliminated::Points, points, poses, 6, layout.pose_free.len())
        };
        let mut kept: Vec<usize> = layout.cameras.iter().map(|camera| camera.offset).collect();
        let mut block_of = vec![usize::MAX; count];
        for (i, other) in others.into_iter().enumerate() {
            block_of[other] = layout.cameras.len() + i;
            kept.push(layout.width + i * size);
        }
        kept.push(layout.width + (kept.len() - layout.cameras.len()) * size);
        Self { eliminated, members, kept, block_of }
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
                    push(Source::Sight(sight), self.block_of[layout.sights[sight].point()]);
                }
                for (surface, triple) in layout.triples.of_surfaces().enumerate() {
                    push(Source::Surface(member * layout.triples.surfaces + surface), self.block_of[triple]);
                }
            }
            Eliminated::Points => {
                for pair in &layout.pairs[layout.pairs_of(member)] {
                    push(Source::PointCamera(pair.offset), pair.camera);
                }
                for sight in layout.of_triple(member) {
                    push(Source::Sight(sight), self.block_of[layout.sights[sight].image()]);
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
        for (kept, &block) in self.block_of.iter().enumerate().filter(|(_, block)| **block != usize::MAX) {
            match self.eliminated {
                Eliminated::Points => columns[layout.camera_of[kept]].add(std::iter::once(block)),
                Eliminated::Poses => {
                    layout.pairs[layout.pairs_of(kept)].iter().for_each(|pair| columns[pair.camera].add(std::iter::once(block)));
                }
            }
        }
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
