//! The network that the errors of some columns determine, and what it predicts of the others.

use calibench_model::Frame;
use calibench_model::camera::{Camera, Photogrammetric};
use calibench_model::convert::{Tangential, from_naive};
use calibench_records::figures::Quantity;
use calibench_records::results::Figure;
use calibench_scenario::Printed;
use calibench_scenario::studies::printed::{NetworkPlan, Variant};
use nalgebra::Vector3;
use rayon::prelude::*;

use super::errors::root_mean_squares;
use super::fit::least_squares;
use super::network::{NUMBERS, NUMBERS_OF, Pictures, Site};

/// Length of a difference, as a part of the distance.
const DIFFERENCE: f64 = 1e-6;
/// Every start ends where a step lowers the sum of squares by less, as a part of it, and the best of them is then followed further.
const ROUGH: f64 = 1e-3;
/// Where the best ends.
const FINE: f64 = 1e-9;
/// Place and angles of a station.
const STATION: [Quantity; 3] = [Quantity::StationX, Quantity::StationY, Quantity::StationZ];
const ANGLES: [Quantity; 3] = [Quantity::Omega, Quantity::Phi, Quantity::Kappa];
/// The predicted error of a point, by axis.
const ERRORS: [Quantity; 3] = [Quantity::ObjectX, Quantity::ObjectY, Quantity::ObjectZ];
/// Root mean squares of predicted errors: alone, and of a column among others.
const PREDICTED: [[Quantity; 2]; 5] = [
    [Quantity::PredictedX, Quantity::PredictedXOf],
    [Quantity::PredictedY, Quantity::PredictedYOf],
    [Quantity::PredictedZ, Quantity::PredictedZOf],
    [Quantity::PredictedPlanimetric, Quantity::PredictedPlanimetricOf],
    [Quantity::PredictedSpatial, Quantity::PredictedSpatialOf],
];
/// Starts whose misfit is within this factor of the least one end at the same network.
const SAME: f64 = 1.01;

/// A fitted network.
struct Fitted {
    numbers: [f64; NUMBERS],
    /// Root mean square of the fitted errors' misfits, object units.
    misfit: f64,
    /// How many starts there were, and how many of them ended here.
    starts: [usize; 2],
    pictures: Pictures,
}

/// What a fitted network says of all columns.
pub struct Predictions<'a> {
    printed: &'a Printed,
    plan: &'a NetworkPlan,
    site: Site,
    fitted: Fitted,
}

impl<'a> Predictions<'a> {
    /// Fits the network of `plan`.
    ///
    /// # Errors
    /// In words: no start from which every point is seen.
    pub fn new(printed: &'a Printed, plan: &'a NetworkPlan) -> Result<Self, String> {
        let cameras: Vec<Photogrammetric> = printed.cameras.iter().map(|column| column.camera).collect();
        let Photogrammetric { size, pitch_um, .. } = cameras[plan.truth];
        let frame = Frame::new(size.width, size.height, pitch_um).map_err(|why| why.to_string())?;
        let site = Site::new(plan, &printed.points, frame);
        let fitted = fit(printed, plan, &site, (&cameras, &plan.turned_truth.of(&cameras[plan.truth])))?;
        Ok(Self { printed, plan, site, fitted })
    }

    /// The network itself: its numbers, its stations with their exterior orientations, how well it fits.
    pub fn network(&self) -> Vec<Figure> {
        let unit = self.printed.unit.name();
        let numbers = NUMBERS_OF.iter().zip(self.fitted.numbers).map(|(number, value)| Figure::plain(number.of(&[unit]), value, unit));
        let stations = self.fitted.pictures.iter().enumerate().flat_map(|(index, (pose, _))| {
            let centre = self.site.middle() + pose.centre.coords;
            let angles = pose.angles().map(f64::to_degrees);
            let plain = move |quantity: Quantity, value, unit| Figure::plain(quantity.of(&[&(index + 1).to_string()]), value, unit);
            let place = (0..3).map(move |axis| plain(STATION[axis], centre[axis], unit));
            place.chain((0..3).map(move |axis| plain(ANGLES[axis], angles[axis], "deg")))
        });
        let [starts, same] = self.fitted.starts.map(|count| count as f64);
        let seen = self.fitted.pictures.iter().flat_map(|(_, seen)| seen).flatten().count() as f64;
        let cameras: Vec<Photogrammetric> = self.printed.cameras.iter().map(|column| column.camera).collect();
        let near = self.near(&self.fitted, &cameras).ok();
        let whole = [
            Figure::plain(Quantity::MisfitFitted.of(&[unit]), self.fitted.misfit, unit),
            Figure::plain(Quantity::Starts, starts, ""),
            Figure::plain(Quantity::StartsAlike, same, ""),
            Figure::plain(Quantity::ImagePoints, seen, ""),
        ];
        whole.into_iter().chain(near).chain(numbers).chain(stations).collect()
    }

    /// How many errors of columns that are not fitted are predicted as near as the plan says.
    fn near(&self, fitted: &Fitted, cameras: &[Photogrammetric]) -> Result<Figure, String> {
        let mut near = 0;
        for (column, camera) in cameras.iter().enumerate().filter(|(column, _)| !self.plan.fitted.contains(column)) {
            let misfits = misfits(self.printed, column, &self.site.errors(&fitted.pictures, camera)?);
            near += misfits.into_iter().filter(|misfit| misfit.abs() <= self.plan.within).count();
        }
        Ok(Figure::plain(Quantity::PredictedNear, near as f64, ""))
    }

    /// What is predicted of a column.
    ///
    /// # Errors
    /// In words: points whose rays do not meet.
    pub fn column(&self, column: usize) -> Result<Vec<Figure>, String> {
        let camera = &self.printed.cameras[column].camera;
        let errors = self.site.errors(&self.fitted.pictures, camera)?;
        let unit = self.printed.unit.name();
        let points = self
            .printed
            .points
            .iter()
            .zip(&errors)
            .flat_map(|(point, error)| (0..3).map(move |axis| Figure::plain(ERRORS[axis].of(&[&point.name]), error[axis].abs(), unit)));
        Ok(self.means(None, column, &errors).into_iter().chain(points).collect())
    }

    /// What is predicted of a changed camera in this network; or, in one that is fitted again, of all columns.
    ///
    /// # Errors
    /// In words: points whose rays do not meet.
    pub fn variant(&self, variant: &Variant) -> Result<Vec<Figure>, String> {
        if !variant.refit {
            return Ok(self.means(None, variant.of, &self.site.errors(&self.fitted.pictures, &variant.camera)?));
        }
        let mut cameras: Vec<Photogrammetric> = self.printed.cameras.iter().map(|column| column.camera).collect();
        cameras[variant.of] = variant.camera;
        let truth = variant.turned_truth.unwrap_or(self.plan.turned_truth).of(&cameras[self.plan.truth]);
        cameras.iter_mut().for_each(|camera| *camera = variant.turned_columns.of(camera));
        let again = fit(self.printed, self.plan, &self.site, (&cameras, &truth))?;
        let unit = self.printed.unit.name();
        let [starts, same] = again.starts.map(|count| count as f64);
        let mut all = vec![
            Figure::plain(Quantity::MisfitFitted.of(&[unit]), again.misfit, unit),
            Figure::plain(Quantity::MisfitOverPrinted, again.misfit / self.fitted.misfit, ""),
            Figure::plain(Quantity::Starts, starts, ""),
            Figure::plain(Quantity::StartsAlike, same, ""),
            self.near(&again, &cameras)?,
        ];
        for (index, (column, camera)) in self.printed.cameras.iter().zip(&cameras).enumerate() {
            let errors = self.site.errors(&again.pictures, camera)?;
            all.extend(self.means(Some(&column.name), index, &errors));
        }
        Ok(all)
    }

    /// Root mean squares of predicted errors, and of their misfits to the printed ones of `column`; `name` is the column's, where those of all stand together.
    fn means(&self, name: Option<&str>, column: usize, errors: &[Vector3<f64>]) -> Vec<Figure> {
        let unit = self.printed.unit.name();
        let of = |[alone, of_column]: [Quantity; 2], value| {
            let figure = name.map_or_else(|| alone.of(&[unit]), |name| of_column.of(&[name, unit]));
            Figure::plain(figure, value, unit)
        };
        let means = PREDICTED.into_iter().zip(root_mean_squares(errors)).map(|(quantities, value)| of(quantities, value));
        let misfits = misfits(self.printed, column, errors);
        let misfit = (misfits.iter().map(|m| m * m).sum::<f64>() / misfits.len() as f64).sqrt();
        means.chain([of([Quantity::Misfit, Quantity::MisfitOf], misfit)]).collect()
    }
}

/// Predicted less printed absolute errors of a column, object units.
fn misfits(printed: &Printed, column: usize, errors: &[Vector3<f64>]) -> Vec<f64> {
    let pairs = printed.points.iter().map(|point| point.errors[column]).zip(errors);
    pairs.flat_map(|(given, error)| [0, 1, 2].map(|axis| error[axis].abs() - given[axis])).collect()
}

/// The network whose errors of the fitted columns, corrected by `cameras`, are nearest to the printed ones, over all starts: of the true camera `truth` is the
/// direct conversion.
fn fit(
    printed: &Printed,
    plan: &NetworkPlan,
    site: &Site,
    (cameras, truth): (&[Photogrammetric], &Photogrammetric),
) -> Result<Fitted, String> {
    let tool = printed.cameras[plan.truth].target().ok_or("the true camera has no tool")?;
    let truth = from_naive(truth, tool, Tangential::Converted).map_err(|why| why.to_string())?;
    let residuals = |numbers: &[f64; NUMBERS]| residuals(printed, plan, site, (cameras, &truth), numbers);
    let starts: Vec<[f64; NUMBERS]> = starts(plan);
    let found: Vec<_> = starts.par_iter().map(|start| least_squares(*start, (DIFFERENCE * start[0], ROUGH), residuals)).collect();
    let best = found.iter().flatten().min_by(|a, b| a.1.total_cmp(&b.1)).ok_or("no start sees every point from two stations")?;
    let best = least_squares(best.0, (DIFFERENCE * best.0[0], FINE), residuals).ok_or("the least misfit is none")?;
    let same = found.iter().flatten().filter(|(_, cost)| cost.sqrt() <= SAME * best.1.sqrt()).count();
    let poses = site.poses(&best.0).ok_or("a station looks along the vertical")?;
    let count = (3 * printed.points.len() * plan.fitted.len()) as f64;
    let (numbers, misfit) = (best.0, (best.1 / count).sqrt());
    Ok(Fitted { numbers, misfit, starts: [starts.len(), same], pictures: site.pictured(poses, &truth) })
}

fn residuals(
    printed: &Printed,
    plan: &NetworkPlan,
    site: &Site,
    (cameras, truth): (&[Photogrammetric], &Camera),
    numbers: &[f64; NUMBERS],
) -> Option<Vec<f64>> {
    let pictures = site.pictured(site.poses(numbers)?, truth);
    let mut all = Vec::new();
    for &column in &plan.fitted {
        all.extend(misfits(printed, column, &site.nearly(&pictures, &cameras[column])?));
    }
    Some(all)
}

/// Every distance with every base, straight and bent to the points, at every height, looking at the points' middle.
fn starts(plan: &NetworkPlan) -> Vec<[f64; NUMBERS]> {
    let mut all = Vec::new();
    for &distance in &plan.distances {
        for &base in &plan.bases {
            for curve in [0.0, -0.5 * base * base / distance] {
                all.extend(plan.heights.iter().map(|&height| [distance, curve, base, 0.0, height, 0.0, 0.0, 0.0, 0.0]));
            }
        }
    }
    all
}
