//! From rows to figures and a verdict: a pure function of the records.

mod board;
mod in_use;
mod limit;
mod models;
mod principal;
mod trusted;

use std::collections::BTreeMap;
use std::sync::Arc;

use calibench_model::upper_median;
use calibench_random::{Key, Purpose, stream};
use rand::RngExt;

use super::{Row, measure, outliers};
pub use board::{BoardShare, FreedCorners, OtherCorners};
pub use in_use::{InUse, StillHolds};
pub use limit::Predicted;
pub use models::{MARGIN_PX, Standing};
pub use principal::{Point, Principal};
pub use trusted::{ALPHA, HONEST, Trusted};

/// Photographs drawn again for an interval.
const DRAWS: u64 = 2000;

/// A figure with its 95 % interval over views: photographs drawn again with replacement, the same for every operator and model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The figure, px.
    pub value: f64,
    /// The interval, lower and upper end, px.
    pub interval: (f64, f64),
}

/// How far two cameras are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beside {
    /// RMS over the frame after the best rotation, px.
    pub frame: f64,
    /// The largest difference of these, px.
    pub most: f64,
    /// RMS where corners were measured, after the best rotation there, px. `None` where they were nowhere near a place of the comparison.
    pub seen: Option<f64>,
}

/// What halves of the photographs say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Split {
    /// RMS difference of two halves over the frame and all splits, px.
    pub difference: f64,
    /// The predicted one, px.
    pub predicted: f64,
    /// Empirical over predicted standard deviation in the modes of the difference, a number: 1 if the sigmas are right.
    pub modes: f64,
    /// The chance of as large differences if the sigmas are right, at most. Splits of the same photographs depend on each other: twice the median of their
    /// p-values, which holds however they do.
    ///
    /// Source: Rüger 1978; used for repeated splits by Meinshausen, Meier & Bühlmann 2009.
    pub p: f64,
    /// How many splits.
    pub count: usize,
}

impl Split {
    /// Empirical over predicted difference over the frame, a number.
    pub fn ratio(&self) -> f64 {
        self.difference / self.predicted
    }
}

/// A view in the hands of an operator and a model.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Its name.
    pub name: Arc<str>,
    /// RMS residual in the adjustment of all views, px, and of how many corners.
    pub residual: (f64, usize),
    /// Holm's p-value of its being like the others, 0 to 1.
    pub p: f64,
}

/// A camera that somebody published, beside ours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Published {
    /// How far they are apart.
    pub beside: Beside,
    /// The predicted standard deviation of ours, RMS over the frame, px.
    pub predicted: f64,
    /// The one that the published camera states of itself, RMS over the frame, px.
    pub stated: Option<f64>,
}

/// An operator with a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// The operator.
    pub method: Arc<str>,
    /// The model.
    pub model: Arc<str>,
    /// How many parameters it solves for; 0 if there is no calibration.
    pub parameters: usize,
    /// Why there is no calibration, if so; or the first thing that could not be judged.
    pub trouble: Option<Arc<str>>,
    /// Every view of the adjustment.
    pub views: Vec<View>,
    /// By view: hold-out RMS, px, and of how many corners.
    pub held_out: BTreeMap<Arc<str>, (f64, usize)>,
    /// By view: the same, one side of the field from the other, px.
    pub carried: BTreeMap<Arc<str>, (f64, usize)>,
    /// Over all views, px.
    pub holdout: Option<Estimate>,
    /// The same, one side of the field from the other, px.
    pub across: Option<Estimate>,
    /// Departure of rows and columns from straight, px.
    pub straight: Option<Estimate>,
    /// Halves.
    pub split: Option<Split>,
    /// Over the frame: x, y (from the centre of the first pixel, y down), RMS difference of halves and the predicted one, px.
    pub map: Vec<(f64, f64, f64, f64)>,
    /// Standard deviation of a projected point in the centre and in the worst corner, px.
    pub uncertainty: Option<(f64, f64)>,
    /// What is predicted of its error over the whole frame.
    pub predicted: Option<Predicted>,
    /// The principal point.
    pub principal: Option<Principal>,
    /// Its camera beside those of models that come after it.
    pub beside: BTreeMap<Arc<str>, Beside>,
    /// The published camera beside it.
    pub published: Option<Published>,
    /// By view: RMS residual with the published camera, px.
    pub published_views: BTreeMap<Arc<str>, f64>,
    /// Predictions with corners of the board that are freed in the other views; `None` where they were not.
    pub freed: Option<OtherCorners>,
    /// Predictions with nominal corners in the place of measured ones; `None` where none were measured.
    pub nominal: Option<OtherCorners>,
    /// How far freed corners are from their places.
    pub moved: Option<FreedCorners>,
}

/// An operator and how many corners it measured.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Measured {
    /// Its label.
    pub method: Arc<str>,
    /// Corners measured.
    pub found: usize,
    /// Of how many.
    pub of: usize,
    /// By reason.
    pub rejected: BTreeMap<Arc<str>, usize>,
    /// Why it measured nothing, if so.
    pub unavailable: Option<Arc<str>>,
}

/// Everything.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// The operators.
    pub methods: Vec<Measured>,
    /// The models.
    pub models: Vec<Arc<str>>,
    /// Photographs that show the board.
    pub views: Vec<Arc<str>>,
    /// Those that do not, and why.
    pub missed: BTreeMap<Arc<str>, Arc<str>>,
    /// Corners on which operators are compared.
    pub common: usize,
    /// By operator, then by model.
    pub cells: Vec<Cell>,
    /// Why nothing was judged, if so.
    pub unavailable: Option<Arc<str>>,
    /// The seed with which photographs are drawn again.
    pub seed: u64,
    /// How well the camera must be known over the frame, px: beyond it the verdict is in doubt. `None` where nothing is asked.
    pub limit_px: Option<f64>,
}

impl Summary {
    /// The summary of the rows of a judgement with a seed.
    pub fn new(rows: &[Row], seed: u64) -> Self {
        let corners = || rows.iter().filter(|row| &*row.measure == measure::CORNERS);
        let mut methods: Vec<Measured> = Vec::new();
        let (mut views, mut missed, mut common) = (Vec::new(), BTreeMap::new(), 0);
        for row in corners() {
            if methods.iter().all(|method| method.method != row.method) {
                methods.push(Measured { method: row.method.clone(), ..Measured::default() });
            }
            let first = methods.len() == 1;
            let Some(method) = methods.last_mut() else { continue };
            match &*row.status {
                "found" => {
                    method.found += row.value.unwrap_or_default() as usize;
                    method.of += row.count.unwrap_or_default();
                    if !views.contains(&row.place) {
                        views.push(row.place.clone());
                        common += row.sigma.unwrap_or_default() as usize;
                    }
                }
                "missed" if first => drop(missed.insert(row.place.clone(), row.reason.clone())),
                "unavailable" => method.unavailable = Some(row.reason.clone()),
                _ => {}
            }
        }
        for row in rows.iter().filter(|row| &*row.measure == measure::REJECTED) {
            if let Some(method) = methods.iter_mut().find(|method| method.method == row.method) {
                *method.rejected.entry(row.reason.clone()).or_default() += 1;
            }
        }
        let mut models: Vec<Arc<str>> = Vec::new();
        for row in rows.iter().filter(|row| !row.model.is_empty()) {
            if !models.contains(&row.model) {
                models.push(row.model.clone());
            }
        }
        let unavailable = rows.iter().find(|row| row.method.is_empty() && &*row.status == "unavailable").map(|row| row.reason.clone());
        let cells = by_cell(rows).into_iter().map(|rows| cell(&rows, seed)).collect();
        Self { methods, models, views, missed, common, cells, unavailable, seed, limit_px: None }
    }

    /// The cell of an operator and a model.
    pub fn cell(&self, method: &str, model: &str) -> Option<&Cell> {
        self.cells.iter().find(|cell| &*cell.method == method && &*cell.model == model)
    }

    /// The cameras of two models of an operator beside each other.
    pub fn beside(&self, method: &str, [one, other]: [&str; 2]) -> Option<Beside> {
        let of = |model: &str, other: &str| self.cell(method, model)?.beside.get(other).copied();
        of(one, other).or_else(|| of(other, one))
    }
}

impl Cell {
    /// The views that are not like the others, the worst first.
    pub fn outlying(&self) -> Vec<&View> {
        let mut found: Vec<&View> = self.views.iter().filter(|view| view.p < super::OUTLIER_ALPHA).collect();
        found.sort_by(|a, b| b.residual.0.total_cmp(&a.residual.0));
        found
    }
}

/// Rows of one operator and model each, in their order.
fn by_cell(rows: &[Row]) -> Vec<Vec<&Row>> {
    let mut cells: Vec<Vec<&Row>> = Vec::new();
    for row in rows.iter().filter(|row| !row.model.is_empty()) {
        match cells.last_mut() {
            Some(cell) if cell[0].method == row.method && cell[0].model == row.model => cell.push(row),
            _ => cells.push(vec![row]),
        }
    }
    cells
}

fn cell(rows: &[&Row], seed: u64) -> Cell {
    let of = |name: &'static str| rows.iter().filter(move |row| &*row.measure == name);
    let value = |name: &'static str, place: &'static str| of(name).find(|row| &*row.place == place).and_then(|row| row.value);
    let by_view = |name: &'static str| -> BTreeMap<Arc<str>, (f64, usize)> {
        of(name).filter_map(|row| Some((row.place.clone(), (row.value?, row.count?)))).collect()
    };
    let (held_out, carried) = (by_view(measure::HOLDOUT), by_view(measure::ACROSS));
    let parameters = value(measure::PARAMETERS, "").unwrap_or_default() as usize;
    Cell {
        method: rows[0].method.clone(),
        model: rows[0].model.clone(),
        parameters,
        trouble: rows.iter().find(|row| row.status.as_ref() == "failed").map(|row| row.reason.clone()),
        views: views(of(measure::RESIDUALS), parameters),
        holdout: pooled(&held_out, seed),
        freed: board::other_corners(&held_out, &by_view(measure::BOARD_FREED), |views| pooled(views, seed)),
        nominal: board::other_corners(&held_out, &by_view(measure::BOARD_NOMINAL), |views| pooled(views, seed)),
        moved: moved(rows),
        held_out,
        across: pooled(&carried, seed),
        carried,
        straight: pooled(&by_view(measure::STRAIGHT), seed),
        split: split(rows),
        map: of(measure::MAP).filter_map(|row| place(row)).collect(),
        uncertainty: value(measure::UNCERTAINTY, "centre").zip(value(measure::UNCERTAINTY, "corner")),
        predicted: of(measure::FRAME).find_map(|row| {
            let modes = value(measure::FRAME_MODES, "")?;
            Some(Predicted { formal: row.value?, by_views: row.sigma, modes })
        }),
        principal: Principal::new(rows),
        beside: of(measure::BESIDE).filter_map(|row| Some((row.place.clone(), beside(rows, row)?))).collect(),
        published: of(measure::PUBLISHED).find_map(|row| {
            let (most, seen) = (value(measure::PUBLISHED_MOST, "")?, value(measure::PUBLISHED_SEEN, ""));
            let stated = value(measure::PUBLISHED_SIGMA, "");
            Some(Published { beside: Beside { frame: row.value?, most, seen }, predicted: row.sigma?, stated })
        }),
        published_views: by_view(measure::PUBLISHED_VIEW).into_iter().map(|(view, (rms, _))| (view, rms)).collect(),
    }
}

fn moved(rows: &[&Row]) -> Option<FreedCorners> {
    let of = |place: &str| {
        let row = rows.iter().find(|row| &*row.measure == measure::BOARD_MOVED && &*row.place == place)?;
        let (moved, sigma) = (row.value?, row.sigma?);
        Some(((moved * moved - sigma * sigma).max(0.0).sqrt(), sigma))
    };
    let ((in_plane, sigma_in_plane), (across, sigma_across)) = (of("in the plane")?, of("across")?);
    Some(FreedCorners { in_plane, across, sigma_in_plane, sigma_across })
}

fn beside(rows: &[&Row], frame: &Row) -> Option<Beside> {
    let seen = rows.iter().find(|row| &*row.measure == measure::BESIDE_SEEN && row.place == frame.place);
    Some(Beside { frame: frame.value?, most: frame.sigma?, seen: seen.and_then(|row| row.value) })
}

/// Place, value and what is predicted of a row of the map.
fn place(row: &Row) -> Option<(f64, f64, f64, f64)> {
    let (x, y) = row.place.split_once(':')?;
    Some((x.parse().ok()?, y.parse().ok()?, row.value?, row.sigma?))
}

fn views<'r>(rows: impl Iterator<Item = &'r &'r Row>, parameters: usize) -> Vec<View> {
    let found: Vec<(Arc<str>, (f64, usize))> = rows.filter_map(|row| Some((row.place.clone(), (row.value?, row.count?)))).collect();
    let p = outliers(&found.iter().map(|view| view.1).collect::<Vec<_>>(), parameters);
    found.into_iter().zip(p).map(|((name, residual), p)| View { name, residual, p }).collect()
}

/// The RMS over all views, each with the weight of its corners, and its interval.
fn pooled(views: &BTreeMap<Arc<str>, (f64, usize)>, seed: u64) -> Option<Estimate> {
    let squares: Vec<(f64, f64)> = views.values().map(|(rms, count)| (rms * rms * *count as f64, *count as f64)).collect();
    let root = |chosen: &mut dyn Iterator<Item = (f64, f64)>| {
        let (sum, count) = chosen.fold((0.0, 0.0), |(sum, count), (square, n)| (sum + square, count + n));
        (sum / count).sqrt()
    };
    if squares.is_empty() {
        return None;
    }
    let mut rng = stream(Key { seed, of: "interval over views", trial: 0, view: "", target: "" }, Purpose::Split);
    let mut drawn: Vec<f64> =
        (0..DRAWS).map(|_| root(&mut (0..squares.len()).map(|_| squares[rng.random_range(0..squares.len())]))).collect();
    drawn.sort_by(f64::total_cmp);
    let at = |part: f64| drawn[(part * (drawn.len() - 1) as f64).round() as usize];
    Some(Estimate { value: root(&mut squares.iter().copied()), interval: (at(0.025), at(0.975)) })
}

fn split(rows: &[&Row]) -> Option<Split> {
    let of = |name: &'static str| rows.iter().filter(move |row| &*row.measure == name).filter_map(|row| Some((row.value?, row.sigma?)));
    let count = of(measure::SPLIT).count();
    let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / count as f64;
    (count > 0).then(|| Split {
        difference: mean(&mut of(measure::SPLIT).map(|(found, _)| found * found)).sqrt(),
        predicted: mean(&mut of(measure::SPLIT).map(|(_, predicted)| predicted * predicted)).sqrt(),
        modes: mean(&mut of(measure::SPLIT_TEST).map(|(found, _)| found)).sqrt(),
        p: twice_median(of(measure::SPLIT_TEST).map(|(_, p)| p).collect()),
        count,
    })
}

/// Twice the middle of p-values, of an even number the upper one of the two; 1 of none.
fn twice_median(p: Vec<f64>) -> f64 {
    upper_median(p).map_or(1.0, |middle| (2.0 * middle).min(1.0))
}

#[cfg(test)]
mod tests;
