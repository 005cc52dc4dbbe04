//! The relative orientation of two images of a survey, and the model that they make.

use std::collections::HashMap;

use calibench_adjust::approximate::{ApproximateError, ModelPoint, RelativeOrientation, Search, Shape, Tolerance, orient_relatively};
use calibench_diagnostics::nearest;
use calibench_model::camera::Camera;
use calibench_model::{PixelPoint, Points, Pose, upper_median};
use thiserror::Error;

/// One of two images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The image in whose axes the model is.
    Left,
    /// The other one.
    Right,
}

/// Why two images make no pair.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PairError {
    /// Both are the same.
    #[error("the left and the right image are both {0}: expected two images")]
    Same(String),
    /// An image of which no point was measured.
    #[error("{image}: no point is of this image{}", near.as_ref().map_or(String::new(), |near| format!("; did you mean `{near}`?")))]
    NoPoint {
        /// Which of the two.
        side: Side,
        /// Its name.
        image: String,
        /// The image whose name is nearest.
        near: Option<String>,
    },
}

/// A target of one image or of both.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// Its name.
    pub target: String,
    /// Where, in the left and in the right image.
    pub at: [Option<PixelPoint>; 2],
}

/// An oriented pair with its object points, scaled to the length of the base.
#[derive(Clone, Debug)]
pub struct Pair {
    /// The orientation, in base lengths.
    pub found: RelativeOrientation,
    /// Length of the base, object units.
    pub base: f64,
    /// A row for each target given.
    pub targets: Vec<PairTarget>,
}

/// A target in a pair.
#[derive(Clone, Debug)]
pub struct PairTarget {
    /// Where it was measured.
    pub seen: Seen,
    /// Nearest coplanar minus measured: x and y in the left image, then in the right, px. `None` where it was measured in one image alone.
    pub residual: Option<[f64; 4]>,
    /// In base lengths; or why there is none.
    pub point: Result<ModelPoint, LeftOutOfPair>,
}

/// Why a target is no point of the model.
#[derive(Clone, Debug, PartialEq)]
pub enum LeftOutOfPair {
    /// It did not fit.
    Rejected,
    /// It was not measured in this image.
    Unseen(Side),
    /// Its rays do not meet.
    NoPoint(ApproximateError),
}

impl Seen {
    /// The targets of two images, in the order of the file.
    ///
    /// # Errors
    /// One image given twice, or one without points.
    pub fn of(points: &Points, left: &str, right: &str) -> Result<Vec<Self>, PairError> {
        if left == right {
            return Err(PairError::Same(left.to_owned()));
        }
        for (side, image) in [(Side::Left, left), (Side::Right, right)] {
            if points.images().find(image).is_none() {
                let near = nearest(image, points.images().iter()).map(str::to_owned);
                return Err(PairError::NoPoint { side, image: image.to_owned(), near });
            }
        }
        let (mut seen, mut places) = (Vec::<Self>::new(), HashMap::new());
        for row in points.rows() {
            let Some(side) = [left, right].iter().position(|name| *name == row.image) else { continue };
            let place = *places.entry(row.target).or_insert_with(|| {
                seen.push(Self { target: row.target.to_owned(), at: [None; 2] });
                seen.len() - 1
            });
            seen[place].at[side] = Some(row.start.position);
        }
        Ok(seen)
    }

    /// Where it is in both images, if it is in both.
    pub fn pair(&self) -> Option<[PixelPoint; 2]> {
        Some([self.at[0]?, self.at[1]?])
    }
}

impl Pair {
    /// Orients the right image in the axes of the left and intersects what fits. `base` in object units; rays that meet at less than `least_angle` (rad)
    /// are parallel.
    ///
    /// # Errors
    /// As [`orient_relatively`].
    pub fn orient(
        cameras: [&Camera; 2],
        seen: Vec<Seen>,
        (tolerance, seed): (Tolerance, u64),
        base: f64,
        least_angle: f64,
    ) -> Result<Self, ApproximateError> {
        let pairs: Vec<[PixelPoint; 2]> = seen.iter().filter_map(Seen::pair).collect();
        let found = orient_relatively(cameras, &pairs, &Search { seed, tolerance })?;
        let mut index = 0;
        let row = |seen: Seen| {
            let Some(pair) = seen.pair() else {
                let side = if seen.at[0].is_some() { Side::Right } else { Side::Left };
                return PairTarget { seen, residual: None, point: Err(LeftOutOfPair::Unseen(side)) };
            };
            let place = index;
            index += 1;
            let point = if found.rejected.contains(&place) {
                Err(LeftOutOfPair::Rejected)
            } else {
                found.model_point(cameras, pair, least_angle).map_err(LeftOutOfPair::NoPoint)
            };
            PairTarget { seen, residual: found.residuals[place], point }
        };
        let targets = seen.into_iter().map(row).collect();
        Ok(Self { found, base, targets })
    }

    /// A pose of [`Self::found`] with its projection centre in object units.
    pub fn pose(&self, of: &Pose) -> Pose {
        Pose { rotation: of.rotation, centre: of.centre * self.base }
    }

    /// Standard deviations from the residuals of X0, Y0, Z0 (object units) and of a small rotation about the right camera's axes (rad).
    pub fn sigmas(&self) -> [f64; 6] {
        let cofactor = self.found.pose_cofactor();
        let sigma = |i: usize| self.found.sigma0 * cofactor[(i, i)].max(0.0).sqrt();
        std::array::from_fn(|i| sigma(i) * if i < 3 { self.base } else { 1.0 })
    }

    /// The points of the model, base lengths.
    pub fn points(&self) -> impl Iterator<Item = &ModelPoint> {
        self.targets.iter().filter_map(|row| row.point.as_ref().ok())
    }

    /// The smallest extent of the model relative to the largest: 0 of a plane. `None` without points.
    pub fn thickness(&self) -> Option<f64> {
        let shape = Shape::of(self.points().map(|point| point.position).collect::<Vec<_>>().into_iter());
        (shape.extents[0] > 0.0).then(|| shape.relative()[0])
    }

    /// The median angle at which rays meet, rad.
    pub fn median_angle(&self) -> Option<f64> {
        upper_median(self.points().map(|point| point.angle))
    }

    /// The correlation of elements `i` and `j` of the orientation: rotations about the right camera's x, y and z, then the base along its two axes.
    pub fn correlation(&self, i: usize, j: usize) -> f64 {
        let q = &self.found.cofactor;
        q[(i, j)] / (q[(i, i)] * q[(j, j)]).sqrt()
    }
}
