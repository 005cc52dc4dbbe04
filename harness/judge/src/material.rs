//! What was measured: points of a field in photographs, by several operators.

use std::collections::HashMap;
use std::sync::Arc;

use calibench_adjust::approximate::Control;
use calibench_model::camera::ImageSize;
use calibench_model::{PixelPoint, Points, Start};
use calibench_records::judgement::COMPARABLE;
use calibench_records::results::{MethodInfo, Outcome, Trial};
use nalgebra::Point3;

use super::bend::Bend;
use super::field::Field;

/// A view with fewer corners of an operator does not take part in its calibration; of a board with fewer, all are needed.
pub const FEWEST: usize = 12;

/// Corners of one operator.
#[derive(Clone, Debug)]
pub struct Corners {
    /// The operator's label.
    pub method: Arc<str>,
    /// Why it measured nothing, if so.
    pub unavailable: Option<String>,
    /// By view, by point of the field: image coordinates, px; `None` where it measured none.
    pub at: Vec<Vec<Option<PixelPoint>>>,
    /// View, corner and reason of what it rejected.
    pub rejected: Vec<(usize, usize, Arc<str>)>,
}

/// All corners.
#[derive(Clone, Debug)]
pub struct Material {
    /// What they show.
    pub field: Field,
    /// Size of the photographs.
    pub size: ImageSize,
    /// Photographs that show it.
    pub views: Vec<Arc<str>>,
    /// Photographs in which it was not found, and why.
    pub missed: Vec<(Arc<str>, String)>,
    /// The operators.
    pub operators: Vec<Corners>,
}

impl Material {
    /// The corners of a run of photographs.
    pub fn new(trial: &Trial, methods: &[MethodInfo], field: Field, size: ImageSize) -> Self {
        let place: HashMap<String, usize> = (0..field.count()).map(|index| (field.name(index).into_owned(), index)).collect();
        let mut views: Vec<Arc<str>> = Vec::new();
        for point in &trial.points {
            if !views.contains(&point.view) {
                views.push(point.view.clone());
            }
        }
        let empty = |info: &MethodInfo| Corners {
            method: info.label.clone(),
            unavailable: info.unavailable.clone(),
            at: vec![vec![None; field.count()]; views.len()],
            rejected: Vec::new(),
        };
        let mut operators: Vec<Corners> = methods.iter().map(empty).collect();
        for point in &trial.points {
            let view = views.iter().position(|view| *view == point.view);
            let (Some(view), Some(&corner)) = (view, place.get(&*point.target)) else { continue };
            match point.outcome {
                Outcome::Measured { position, .. } => operators[point.method].at[view][corner] = Some(position),
                Outcome::Rejected(why) => operators[point.method].rejected.push((view, corner, why.name().into())),
            }
        }
        Self { field, size, views, missed: trial.missed_views.clone(), operators }
    }

    /// The corners of an operator in some views, in their order.
    pub fn points(&self, operator: usize, views: &[usize]) -> Points {
        let mut points = Points::default();
        for &view in views {
            for (corner, at) in self.operators[operator].at[view].iter().enumerate() {
                at.iter().for_each(|at| points.push(&self.views[view], &self.field.name(corner), Start::at(*at)));
            }
        }
        points
    }

    /// The corners of an operator in a view among those of `chosen`, as control of a resection.
    pub fn seen(&self, operator: usize, view: usize, bend: &Bend, chosen: &dyn Fn(usize) -> bool) -> Vec<Control> {
        let corners = self.operators[operator].at[view].iter().enumerate();
        corners
            .filter(|(corner, _)| chosen(*corner))
            .filter_map(|(c, at)| Some(Control { object: bend.at(c, Point3::from(self.field.object(c))), image: (*at)? }))
            .collect()
    }

    /// The views in which an operator measured enough.
    pub fn usable(&self, operator: usize) -> Vec<usize> {
        let enough = |view: &usize| self.operators[operator].at[*view].iter().flatten().count() >= FEWEST.min(self.field.count());
        (0..self.views.len()).filter(enough).collect()
    }

    /// All corners that an operator measured.
    pub fn positions(&self, operator: usize) -> Vec<PixelPoint> {
        self.operators[operator].at.iter().flatten().flatten().copied().collect()
    }

    /// How many corners an operator measured.
    pub fn measured(&self, operator: usize) -> usize {
        self.operators[operator].at.iter().flatten().flatten().count()
    }

    /// By view: how many corners at least one operator measured or rejected. In photographs these are the whole board, in a file what the detector saw of it.
    pub fn tried(&self) -> Vec<usize> {
        let mut tried = vec![vec![false; self.field.count()]; self.views.len()];
        for operator in &self.operators {
            operator.rejected.iter().for_each(|&(view, corner, _)| tried[view][corner] = true);
            for (tried, at) in tried.iter_mut().zip(&operator.at) {
                tried.iter_mut().zip(at).for_each(|(tried, at)| *tried |= at.is_some());
            }
        }
        tried.iter().map(|view| view.iter().filter(|tried| **tried).count()).collect()
    }

    /// By view and corner: whether every operator that measured enough of them measured this one. Operators are compared on these.
    pub fn common(&self) -> Vec<Vec<bool>> {
        let all: usize = self.tried().iter().sum();
        let enough: Vec<&Corners> = (0..self.operators.len())
            .filter(|&operator| self.measured(operator) as f64 >= COMPARABLE * all as f64)
            .map(|operator| &self.operators[operator])
            .collect();
        let by_corner = |view: usize| (0..self.field.count()).map(|c| enough.iter().all(|o| o.at[view][c].is_some())).collect();
        (0..self.views.len()).map(by_corner).collect()
    }
}
