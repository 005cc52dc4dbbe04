//! The `[recognition]` table: a coded field is recognised in every image, and measuring starts from what was found.

mod read;
pub mod wire;

use calibench_recognise::Recogniser;

pub(crate) use read::read;

/// The name under which counts of recognition stand in the records.
pub const RECOGNITION: &str = "recognition";

/// A checked `[recognition]` table.
#[derive(Clone, Debug)]
pub struct Recognition {
    /// The classifiers' names.
    pub classifiers: Vec<String>,
    /// The recogniser of each classifier; measuring starts from the first.
    pub recognisers: Vec<Recogniser>,
    /// Images that are counted together: a name, and the places of stations.
    pub images: Vec<(String, Vec<usize>)>,
}
