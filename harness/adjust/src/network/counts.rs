//! The bookkeeping: how many observations, unknowns, constraints.

use super::{Attitude, Centre, Network, Status};

/// How many observations and unknowns an adjustment has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Image coordinates: two for each image point.
    pub image_coordinates: usize,
    /// Observed parameters, centres, rotations and object coordinates.
    pub observed: usize,
    /// Constraints of the datum: coordinates that are held, or inner constraints. They count like observations.
    pub constraints: usize,
    /// Unknowns, those under constraints included.
    pub unknowns: usize,
}

impl Counts {
    /// Those of a network with so many image points in use and `constraints` of its datum.
    pub(crate) fn of(network: &Network, image_points: usize, constraints: usize) -> Self {
        let mut counts = Self { image_coordinates: 2 * image_points, constraints, ..Self::default() };
        let parameters = network.cameras.iter().flat_map(|camera| &camera.parameters);
        let coordinates = network.points.iter().flat_map(|point| &point.coordinates);
        let shapes = network.surfaces.iter().flat_map(|surface| &surface.statuses);
        parameters
            .chain(coordinates)
            .chain(shapes)
            .for_each(|status| counts.add(status.is_unknown(), matches!(status, Status::Observed { .. }), 1));
        counts.observed += network.distances.len();
        counts.add(true, true, network.zero_own().iter().map(Vec::len).sum());
        for image in &network.images {
            counts.add(image.centre != Centre::Fixed, matches!(image.centre, Centre::Observed { .. }), 3);
            counts.add(image.attitude != Attitude::Fixed, matches!(image.attitude, Attitude::Observed { .. }), 3);
        }
        counts
    }

    fn add(&mut self, unknown: bool, observed: bool, numbers: usize) {
        self.unknowns += usize::from(unknown) * numbers;
        self.observed += usize::from(observed) * numbers;
    }

    /// Observations as a paper counts them: image coordinates, observed quantities, constraints.
    pub const fn observations(&self) -> usize {
        self.image_coordinates + self.observed + self.constraints
    }

    /// Redundancy: observations less unknowns; negative if there are too few.
    pub const fn redundancy(&self) -> i64 {
        self.observations() as i64 - self.unknowns as i64
    }
}
