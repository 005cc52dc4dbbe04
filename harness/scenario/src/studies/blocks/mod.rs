//! The `[blocks]` and `[[block]]` tables: free networks of what every method measured.

mod read;
#[cfg(test)]
mod tests;
pub mod wire;

use calibench_model::camera::Ebner;

pub(crate) use read::read;

use super::plan::StudyPlan;

/// The name under which comparisons of residuals stand in the records.
pub const RESIDUALS: &str = "residuals";

/// Checked `[blocks]` and `[[block]]` tables.
#[derive(Clone, Debug)]
pub struct Blocks {
    /// The camera that is held; its additional parameters are zero.
    pub camera: Ebner,
    /// A-priori standard deviation of an image coordinate, px.
    pub sigma_px: f64,
    /// Where gross errors begin, px.
    pub gross_px: f64,
    /// Whether the image points of every trial are kept.
    pub keep_points: bool,
    /// The blocks, in their order.
    pub list: Vec<Block>,
    /// What is compared of their residuals.
    pub residuals: Option<ResidualPairs>,
}

/// A free network.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Its name.
    pub name: String,
    /// Its targets, by their places in the field.
    pub targets: Vec<usize>,
    /// Its images, by the places of their stations: a network for each choice.
    pub images: Vec<Vec<usize>>,
    /// Whether the file gives several choices of images.
    pub several: bool,
    /// Ebner's parameters that are solved for.
    pub parameters: Vec<String>,
    /// Of each station, the set of parameters that is its own, counted from 0.
    pub groups: Vec<usize>,
    /// The block whose parameters correct the image coordinates.
    pub corrected_by: Option<usize>,
    /// Standard deviation of every height, object units.
    pub height_sigma: Option<f64>,
    /// How many of an image's points are used.
    pub points_per_image: Option<usize>,
    /// Over which distance from the middle the bend is reported, object units.
    pub bend_over: Option<f64>,
    /// The methods whose points are adjusted, by their places.
    pub methods: Vec<usize>,
}

/// Residuals that are compared.
#[derive(Clone, Debug, PartialEq)]
pub struct ResidualPairs {
    /// Of which blocks.
    pub blocks: Vec<usize>,
    /// In which pairs of images, by the places of their stations.
    pub pairs: Vec<[usize; 2]>,
}

impl StudyPlan for Blocks {
    /// Those of the blocks, then [`RESIDUALS`] if residuals are compared.
    fn sets(&self) -> Vec<String> {
        let compared = self.residuals.iter().map(|_| RESIDUALS.to_owned());
        self.list.iter().map(|block| block.name.clone()).chain(compared).collect()
    }

    fn keeps_points(&self) -> bool {
        self.keep_points
    }
}
