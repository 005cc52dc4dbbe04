//! Image points, column by column.

use super::{Names, PointRow};
use crate::frames::{Covariance, PixelPoint};
use crate::observation::Start;
use crate::target::{Affine, TargetKind};

/// Image points in the order given. Names are kept once and numbers in columns: 24 bytes a point, and what is known of its shape and its covariance.
#[derive(Clone, Debug, Default)]
pub struct Points {
    images: Names,
    targets: Names,
    image: Vec<u32>,
    target: Vec<u32>,
    position: Vec<PixelPoint>,
    kind: Column<TargetKind>,
    affine: Column<Affine>,
    covariance: Column<Covariance>,
}

/// An image point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointRef<'a> {
    /// The image's file name.
    pub image: &'a str,
    /// The target's name.
    pub target: &'a str,
    /// Position, kind, affine start and covariance.
    pub start: Start,
}

/// Indices of points by what they have in common: an image or a target.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Groups {
    order: Vec<u32>,
    starts: Vec<u32>,
}

impl Points {
    /// An empty table with room for `count` points.
    pub fn with_capacity(count: usize) -> Self {
        let mut points = Self::default();
        points.image.reserve_exact(count);
        points.target.reserve_exact(count);
        points.position.reserve_exact(count);
        points
    }

    /// Adds a point.
    ///
    /// # Panics
    /// Beyond 2^32 points.
    pub fn push(&mut self, image: &str, target: &str, start: Start) {
        let index = self.len();
        u32::try_from(index).expect("fewer than 2^32 points");
        // Files go image by image.
        let same = self.image.last().copied().filter(|&last| self.images.get(last as usize) == image);
        self.image.push(same.unwrap_or_else(|| self.images.place(image) as u32));
        self.target.push(self.targets.place(target) as u32);
        self.position.push(start.position);
        let room = self.position.capacity();
        self.kind.push(index, room, start.kind);
        self.affine.push(index, room, start.affine);
        self.covariance.push(index, room, start.covariance);
    }

    /// Changes all positions, px.
    pub fn move_each(&mut self, to: impl Fn(PixelPoint) -> PixelPoint) {
        self.position.iter_mut().for_each(|at| *at = to(*at));
    }

    /// Adds all points of another table.
    ///
    /// # Panics
    /// Beyond 2^32 points.
    pub fn append(&mut self, other: &Self) {
        u32::try_from(self.len() + other.len()).expect("fewer than 2^32 points");
        let images: Vec<u32> = other.images.iter().map(|name| self.images.place(name) as u32).collect();
        let targets: Vec<u32> = other.targets.iter().map(|name| self.targets.place(name) as u32).collect();
        let (first, room) = (self.len(), self.position.capacity());
        self.image.extend(other.image.iter().map(|&image| images[image as usize]));
        self.target.extend(other.target.iter().map(|&target| targets[target as usize]));
        self.position.extend_from_slice(&other.position);
        for index in 0..other.len() {
            self.kind.push(first + index, room, other.kind.get(index));
            self.affine.push(first + index, room, other.affine.get(index));
            self.covariance.push(first + index, room, other.covariance.get(index));
        }
    }

    /// The first point whose image and target an earlier one has: that one, and itself.
    pub fn twice(&self) -> Option<(usize, usize)> {
        let groups = self.by_image();
        let mut last: Vec<Option<u32>> = vec![None; self.targets.len()];
        let mut found = None::<(usize, usize)>;
        for image in 0..self.images.len() {
            for index in groups.of_group(image) {
                if last[self.target_of(index)].replace(image as u32) == Some(image as u32) && found.is_none_or(|(_, first)| index < first) {
                    let earlier = groups.of_group(image).find(|&earlier| self.target[earlier] == self.target[index]);
                    found = earlier.map(|earlier| (earlier, index));
                    break;
                }
            }
        }
        found
    }

    /// How many points there are.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// None at all.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// The images, in the order in which they come.
    pub fn images(&self) -> &Names {
        &self.images
    }

    /// The targets, in the order in which they come.
    pub fn targets(&self) -> &Names {
        &self.targets
    }

    /// Place among the images of the image of point `index`.
    #[inline]
    pub fn image_of(&self, index: usize) -> usize {
        self.image[index] as usize
    }

    /// Place among the targets of the target of point `index`.
    #[inline]
    pub fn target_of(&self, index: usize) -> usize {
        self.target[index] as usize
    }

    /// Where point `index` is.
    #[inline]
    pub fn position(&self, index: usize) -> PixelPoint {
        self.position[index]
    }

    /// What point `index` is a picture of, if it was said.
    #[inline]
    pub fn kind(&self, index: usize) -> Option<TargetKind> {
        self.kind.get(index)
    }

    /// The covariance of point `index`, px^2.
    #[inline]
    pub fn covariance(&self, index: usize) -> Option<Covariance> {
        self.covariance.get(index)
    }

    /// Position, kind, affine start and covariance of point `index`.
    pub fn start(&self, index: usize) -> Start {
        let (kind, affine, covariance) = (self.kind.get(index), self.affine.get(index), self.covariance.get(index));
        Start { position: self.position[index], kind, affine, covariance, warp: None }
    }

    /// Point `index`.
    pub fn row(&self, index: usize) -> PointRef<'_> {
        PointRef { image: self.images.get(self.image_of(index)), target: self.targets.get(self.target_of(index)), start: self.start(index) }
    }

    /// All points, in their order.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = PointRef<'_>> {
        (0..self.len()).map(|index| self.row(index))
    }

    /// The points of each image, in their order.
    pub fn by_image(&self) -> Groups {
        Groups::of(self.images.len(), &self.image)
    }

    /// The points of each target, in their order.
    pub fn by_target(&self) -> Groups {
        Groups::of(self.targets.len(), &self.target)
    }
}

impl Groups {
    /// Of keys below `count`.
    fn of(count: usize, keys: &[u32]) -> Self {
        let mut starts = vec![0_u32; count + 1];
        keys.iter().for_each(|&key| starts[key as usize + 1] += 1);
        (0..count).for_each(|i| starts[i + 1] += starts[i]);
        let (mut next, mut order) = (starts.clone(), vec![0; keys.len()]);
        for (index, &key) in keys.iter().enumerate() {
            order[next[key as usize] as usize] = index as u32;
            next[key as usize] += 1;
        }
        Self { order, starts }
    }

    /// The points of a group.
    #[inline]
    pub fn of_group(&self, group: usize) -> impl ExactSizeIterator<Item = usize> + Clone + '_ {
        self.order[self.starts[group] as usize..self.starts[group + 1] as usize].iter().map(|&index| index as usize)
    }
}

impl PartialEq for Points {
    fn eq(&self, other: &Self) -> bool {
        self.rows().eq(other.rows())
    }
}

impl<R: std::borrow::Borrow<PointRow>> FromIterator<R> for Points {
    fn from_iter<I: IntoIterator<Item = R>>(rows: I) -> Self {
        let mut points = Self::default();
        points.extend(rows);
        points
    }
}

impl<R: std::borrow::Borrow<PointRow>> Extend<R> for Points {
    fn extend<I: IntoIterator<Item = R>>(&mut self, rows: I) {
        rows.into_iter().for_each(|row| {
            let PointRow { image, target, start } = row.borrow();
            self.push(image, target, *start);
        });
    }
}

impl<'a> From<&'a PointRow> for PointRef<'a> {
    fn from(row: &'a PointRow) -> Self {
        Self { image: &row.image, target: &row.target, start: row.start }
    }
}

impl From<PointRef<'_>> for PointRow {
    fn from(row: PointRef<'_>) -> Self {
        Self { image: row.image.to_owned(), target: row.target.to_owned(), start: row.start }
    }
}

/// Values that some points have: nothing is kept before the first.
#[derive(Clone, Debug)]
struct Column<T> {
    values: Vec<T>,
    given: Vec<bool>,
}

impl<T> Default for Column<T> {
    fn default() -> Self {
        Self { values: Vec::new(), given: Vec::new() }
    }
}

impl<T: Copy> Column<T> {
    /// Of the point `index`, which comes after all others; `room` is how many there may be.
    fn push(&mut self, index: usize, room: usize, value: Option<T>) {
        if self.values.is_empty() && value.is_some() {
            self.values.reserve_exact(room);
            self.given.reserve_exact(room);
        }
        // What stands where there is no value means nothing.
        if let Some(filler) = value.or(self.values.last().copied()) {
            self.values.resize(index, filler);
            self.given.resize(index, false);
            self.values.push(filler);
            self.given.push(value.is_some());
        }
    }

    fn get(&self, index: usize) -> Option<T> {
        self.given.get(index).filter(|given| **given).map(|_| self.values[index])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_given_back_as_they_were() {
        let at = |x: f64| Start::at(PixelPoint::new(x, -x));
        let covariance = Some(Covariance { sxx: 1.0, sxy: 0.5, syy: 2.0 });
        let affine = Some(Affine { axx: 1.0, axy: 2.0, ayx: 3.0, ayy: 4.0 });
        let row = |image: &str, target: &str, start| PointRow { image: image.into(), target: target.into(), start };
        let rows = [
            row("a", "1", at(0.0)),
            row("b", "1", Start { covariance, ..at(1.0) }),
            row("a", "2", Start { kind: Some(TargetKind::Disc), affine, ..at(2.0) }),
            row("c", "3", at(3.0)),
        ];
        let points: Points = rows.iter().collect();
        assert_eq!(points.rows().map(PointRow::from).collect::<Vec<_>>(), rows);
        let of = |groups: &Groups, group| groups.of_group(group).collect::<Vec<_>>();
        assert_eq!((of(&points.by_image(), 0), of(&points.by_image(), 2)), (vec![0, 2], vec![3]));
        assert_eq!((of(&points.by_target(), 0), of(&points.by_target(), 1)), (vec![0, 1], vec![2]));
        assert_eq!((points.covariance(1), points.covariance(2), points.covariance(3)), (covariance, None, None));
    }
}
