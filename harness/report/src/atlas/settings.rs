//! The best setting of each operator that a search found.

use super::load::Part;

/// The best setting of one operator on one class of images.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The operator.
    pub operator: String,
    /// Its name and setting.
    pub label: String,
    /// Its RMSE there, px, with failures counted as errors of 1 px.
    pub rmse: f64,
}

/// For each cell of the search its value and the best setting of each operator, in the order of the file; of equal ones the first.
pub fn best(search: &Part) -> Vec<(String, Vec<Found>)> {
    let cells = 0..search.sweep.cells.len();
    cells.map(|cell| (search.sweep.sweep.cells[cell].label.clone(), best_of(search, cell))).collect()
}

fn best_of(search: &Part, cell: usize) -> Vec<Found> {
    let mut found: Vec<Found> = Vec::new();
    for (method, info) in search.sweep.methods.iter().enumerate() {
        let losses = search.losses(&[cell], method);
        if losses.is_empty() {
            continue;
        }
        let rmse = (losses.iter().sum::<f64>() / losses.len() as f64).sqrt();
        let operator = info.name.split(':').next().unwrap_or_default();
        let this = Found { operator: operator.to_owned(), label: info.name.clone(), rmse };
        match found.iter_mut().find(|earlier| earlier.operator == operator) {
            Some(earlier) if rmse < earlier.rmse => *earlier = this,
            Some(_) => {}
            None => found.push(this),
        }
    }
    found
}

/// The settings of the search that `evaluation` does not measure: none, if its file is up to date.
pub fn unmeasured(search: &Part, evaluation: &Part) -> Vec<String> {
    let measured = |label: &str| evaluation.sweep.scenario.methods.iter().any(|known| known == label);
    let mut missing: Vec<String> =
        best(search).into_iter().flat_map(|(_, found)| found).map(|found| found.label).filter(|label| !measured(label)).collect();
    missing.sort();
    missing.dedup();
    missing
}
