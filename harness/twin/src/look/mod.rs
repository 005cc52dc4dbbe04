//! What images of a board look like: figures by estimators that are the same for photographs and for their twin.

mod edge;
mod figures;
mod light;
mod noise;
mod spread;
mod square;

use calibench_model::{Image, Pose};

use crate::geometry::Geometry;

pub use edge::{EdgeFit, Profile, STEP, STEPS, cumulative, fit_edge};
pub use figures::{Figure, Look};
pub use light::{INK, Light, PAPER};
pub use noise::{NoiseLine, binned, noise_line};
pub use spread::across;
pub use square::{SquareFit, fit_square};

/// What an image of a board shows: its edges and the insides of its squares.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ViewLook {
    /// The edges that can be looked at.
    pub edges: Vec<EdgeFit>,
    /// The squares that have an inside.
    pub squares: Vec<SquareFit>,
    /// The mean profile of the edges.
    pub profile: Profile,
}

impl ViewLook {
    /// What `image`, taken from `pose`, shows of the board.
    pub fn of(image: &Image, geometry: &Geometry, pose: &Pose) -> Self {
        let mut profile = Profile::default();
        let edges = geometry.edges(pose).iter().filter_map(|edge| fit_edge(image, edge, &mut profile)).collect();
        let squares = geometry.squares(pose).iter().filter_map(|square| fit_square(image, square)).collect();
        Self { edges, squares, profile }
    }
}
