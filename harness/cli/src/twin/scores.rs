//! What operators do to photographs and to their twin.

use std::collections::{BTreeMap, HashMap};

use calibench_calibrate::choice::ModelChoice;
use calibench_judge::{Material, Options, judge};
use calibench_model::{BoardCorner, PixelPoint};
use calibench_records::judgement::{Row, measure};
use calibench_records::results::{Outcome, Trial};
use calibench_run::shots::TrueTarget;
use calibench_twin::score::Rms;

use crate::failure::Failure;

/// Hold-out of each operator, in the order of the material: predictions of photographs that the camera has not seen.
pub fn held_out(material: &Material, model: &ModelChoice) -> Result<Vec<Rms>, Failure> {
    let models = vec![model.clone()];
    let options = Options { models, pitch_um: None, splits: 0, seed: 0, name: "twin".into(), published: None, published_sigma: None };
    let rows = judge(material, &options)?;
    let view = |row: &Row| {
        let count = row.count?;
        Some((row.place.to_string(), row.value?.powi(2) * count as f64, count))
    };
    let of = |method: &str| {
        let own = rows.iter().filter(|row| &*row.measure == measure::HOLDOUT && &*row.method == method);
        Rms { views: own.filter_map(view).collect() }
    };
    Ok(material.operators.iter().map(|operator| of(&operator.method)).collect())
}

/// The truth about images of a twin.
#[derive(Default)]
pub struct Truth {
    /// The places of corners by view and name, px.
    at: HashMap<(String, String), PixelPoint>,
    /// The board's corners as they are printed.
    pub corners: Vec<BoardCorner>,
}

impl Truth {
    /// What is known of a view.
    pub fn add(&mut self, view: &str, targets: &[TrueTarget]) {
        self.at.extend(targets.iter().filter_map(|target| Some(((view.to_owned(), target.id.clone()), target.at?))));
        if self.corners.is_empty() {
            let exact = |target: &TrueTarget| {
                let position = target.object?.into();
                let sigmas = [f64::MIN_POSITIVE; 3];
                Some(BoardCorner { target: target.id.clone(), position, sigmas, covariances: None, nominal: None, photographs: None })
            };
            self.corners = targets.iter().filter_map(exact).collect();
        }
    }
}

/// True errors of each of so many operators in a twin, on the corners that all of those measured which measured any.
pub fn true_errors(trial: &Trial, operators: usize, truth: &Truth) -> Vec<Rms> {
    // By view and corner, in one order on any number of threads.
    let mut errors: BTreeMap<(&str, &str), Vec<Option<f64>>> = BTreeMap::new();
    for point in &trial.points {
        let Outcome::Measured { position, .. } = &point.outcome else { continue };
        let Some(at) = truth.at.get(&(point.view.to_string(), point.target.to_string())) else { continue };
        let corner = errors.entry((&point.view, &point.target)).or_insert_with(|| vec![None; operators]);
        corner[point.method] = Some(position.distance(*at).powi(2));
    }
    let ran: Vec<usize> = (0..operators).filter(|operator| errors.values().any(|squares| squares[*operator].is_some())).collect();
    errors.retain(|_, squares| ran.iter().all(|operator| squares[*operator].is_some()));
    let of = |operator: usize| {
        let mut views: Vec<(String, f64, usize)> = Vec::new();
        for ((view, _), squares) in &errors {
            let Some(square) = squares[operator] else { continue };
            match views.last_mut() {
                Some((name, sum, count)) if name == view => (*sum, *count) = (*sum + square, *count + 1),
                _ => views.push(((*view).to_owned(), square, 1)),
            }
        }
        Rms { views }
    };
    (0..operators).map(of).collect()
}
