//! Adjustments as the gate compares them: as if they were points, one pair of figures each, trial by trial; and figure by figure.

use std::sync::Arc;

use calibench_model::Rejection;
use calibench_records::results::{Calibrated, Group};

use super::point_entry::{Entry, Found, rounded};

/// Value, standard deviation and error of a figure of an adjustment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Numbers {
    /// The value, in the figure's unit.
    pub value: f64,
    /// Its reported standard deviation, in the same unit.
    pub sigma: Option<f64>,
    /// Value less truth, in the same unit.
    pub error: Option<f64>,
}

/// Which figure of the adjustments of a method: the set of parameters (from 0), the group, the name within it.
pub type FigureKey = (usize, Group, Arc<str>);

/// The view under which they stand.
pub(super) const VIEW: &str = "adjustment";

/// The camera over the frame and, where there is a second step, the check points. An adjustment that failed is a rejected one.
pub(super) fn entries(adjusted: &Calibrated) -> Vec<(&'static str, Entry)> {
    let failed = Entry::Rejected(Rejection::NotConverged);
    let Ok(figures) = &adjusted.outcome else { return vec![("camera", failed), ("check points", failed)] };
    let find = |group: Group, name: &str| figures.iter().find(|figure| figure.group == group && &*figure.name == name);
    let mm = |name: &str| find(Group::Check, name).map(|figure| if figure.unit == "m" { 1e3 * figure.value } else { figure.value });
    let measured = |x: f64, y: f64| Entry::Measured(Found::bare([rounded(x), rounded(y)]));
    let camera = find(Group::Frame, "rms").map_or(failed, |figure| measured(figure.value, 0.0));
    let check = match (mm("rmse_xy"), mm("rmse_z")) {
        (Some(xy), Some(z)) => Some(measured(xy, z)),
        _ => adjusted.check_failed.as_ref().map(|_| failed),
    };
    [("camera", Some(camera)), ("check points", check)].into_iter().filter_map(|(name, entry)| Some((name, entry?))).collect()
}

/// Every figure but the residuals of single points, each in its unit.
pub(super) fn figures(adjusted: &Calibrated) -> Vec<(FigureKey, Numbers)> {
    let figures = adjusted.outcome.iter().flatten().filter(|figure| !matches!(figure.group, Group::Point | Group::Object));
    figures
        .map(|figure| {
            let numbers = Numbers { value: figure.value, sigma: figure.sigma, error: figure.error };
            ((adjusted.set, figure.group, figure.name.clone()), numbers)
        })
        .collect()
}
