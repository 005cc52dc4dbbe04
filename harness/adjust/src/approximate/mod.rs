//! Start values without truth: closed forms and robust searches.
//!
//! | from | comes | by |
//! |---|---|---|
//! | a plane and its picture | [`Homography`] | [`homography`] |
//! | pictures of planes | interior orientation | [`interior_from_planes`] |
//! | a data sheet, or nothing | interior orientation | [`interior_from_data_sheet`], [`interior_from_size`] |
//! | control points and a camera | [`Resection`] | [`resect`], for three points [`poses_of_three`], for a plane [`planar_poses`], [`planar_starts`] |
//! | control points and their rays | [`FittedPose`] | [`resect_by_rays`], [`fit_pose_to_rays`] from a pose nearby |
//! | control points alone | camera and pose | [`direct_linear`] |
//! | oriented pictures of a point | [`Intersection`] | [`intersect`] |
//! | two pictures of the same points | [`RelativeOrientation`] | [`orient_relatively`] |
//! | a pair so oriented | [`ModelPoint`] | [`RelativeOrientation::model_point`] |
//! | two sets of object points | [`Similarity`] | [`similarity`] |
//! | object points | a plane, a line or neither: [`Shape`] | [`Shape::of`] |
//!
//! Residuals are computed minus measured, px. A cofactor matrix is the covariance for a standard deviation of 1 px of each image coordinate.

mod by_rays;
mod consensus;
mod coplanarity;
mod direct_linear;
mod error;
mod essential;
mod homography;
mod interior;
mod intersection;
mod least_squares;
mod model;
mod p3p;
mod planar;
mod pose_fit;
mod projective;
mod relative;
mod resection;
mod rival;
mod roots;
mod shape;
mod similarity;
mod zhang;

#[cfg(test)]
mod tests;

pub use by_rays::{RayControl, fit_pose_to_rays, resect_by_rays};
pub use consensus::{Search, Tolerance};
pub use direct_linear::{DirectLinear, direct_linear};
pub use error::ApproximateError;
pub use homography::{Homography, homography, refine_homography};
pub use interior::{interior_from_data_sheet, interior_from_size};
pub use intersection::{Intersection, Sight, intersect};
pub use model::ModelPoint;
pub use p3p::{p3p, poses_of_three};
pub use planar::{planar_poses, planar_starts};
pub use pose_fit::{Control, FittedPose, fit_pose};
pub use relative::{RelativeOrientation, orient_relatively};
pub use resection::{Resection, resect};
pub use shape::Shape;
pub use similarity::{Similarity, similarity};
pub use zhang::{Assumed, PlaneInterior, interior_from_planes};
