//! The operators: one file each. A new one is its file and its two lines here.

use crate::registry::Registry;

pub mod calib_targets;
pub mod centroid;
pub mod chess_corners;
pub mod detect;
pub mod ellipse_edges;
pub mod forstner;
pub mod harris_paraboloid;
pub mod lsm;
pub mod opencv_boards;
pub mod opencv_chessboard_sb;
pub mod opencv_subpix;
pub mod parametric_circle;
pub mod parametric_corner;
pub mod parametric_junction;
pub mod pixel;
pub mod saddle;

/// The worked example of CONTRIBUTING, linked from `examples/`.
#[cfg(test)]
mod example;

impl Registry {
    /// The methods of this crate, in the order in which they are listed.
    pub fn builtin() -> Self {
        let methods = [
            pixel::method(),
            forstner::method(),
            harris_paraboloid::method(),
            harris_paraboloid::linear(),
            centroid::method(),
            centroid::binary(),
            lsm::method(),
            saddle::method(),
            parametric_corner::method(),
            parametric_junction::method(),
            parametric_circle::method(),
            ellipse_edges::method(),
            chess_corners::method(),
            detect::method(),
            calib_targets::method(),
        ];
        methods.into_iter().fold(Self::default(), Self::with).all_own()
    }
}
