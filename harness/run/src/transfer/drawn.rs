//! What is drawn in a trial: errors of image coordinates and of the survey, and the views of the board.

use calibench_adjust::approximate::Control;
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{Bend, PixelPoint, Pose};
use calibench_random::{Key, Purpose, stream};
use calibench_scenario::transfer::{Board, Conditions, Method};
use calibench_synth::stations::Station;
use nalgebra::{Point3, Vector3};
use rand_distr::{Distribution, StandardNormal};

use super::Campaign;
use super::camera::refocused;

/// Errors of standard deviation 1 of a trial, which all conditions share, and its board's views.
pub struct Drawn<'a> {
    campaign: &'a Campaign<'a>,
    key: Key<'a>,
    /// Of each station, of each target.
    images: Vec<Vec<[f64; 2]>>,
    /// Of each target.
    survey: Vec<Vector3<f64>>,
    /// The views of the board, the board's units; why there are none.
    boards: Result<Vec<Station>, String>,
}

impl<'a> Drawn<'a> {
    /// Of the trial of `key`.
    pub fn new(campaign: &'a Campaign<'a>, key: Key<'a>) -> Self {
        let subject = campaign.subject;
        let targets = &subject.field.targets;
        let errors = |station: &Station| errors(targets.len(), Key { view: &station.name, ..key }, Purpose::CommonError);
        let survey = |target: &calibench_model::ObjectTarget| {
            let mut rng = stream(Key { target: &target.id, ..key }, Purpose::Control);
            Vector3::from_fn(|_, _| StandardNormal.sample(&mut rng))
        };
        let boards = match &campaign.transfer.board {
            Some(board) => views(board, &subject.camera, key),
            None => Ok(Vec::new()),
        };
        Self { campaign, key, images: subject.stations.iter().map(errors).collect(), survey: targets.iter().map(survey).collect(), boards }
    }

    /// Of a station what is measured: target and image coordinates, px.
    pub fn seen(&self, station: usize, measurement: bool) -> impl Iterator<Item = (usize, PixelPoint)> + '_ {
        let sigma = if measurement { self.campaign.transfer.sigma_px } else { 0.0 };
        self.campaign.images[station].iter().map(move |&(target, at)| {
            let [x, y] = self.images[station][target];
            (target, PixelPoint::new(at.x + sigma * x, at.y + sigma * y))
        })
    }

    /// Where the survey has a target, object units.
    pub fn surveyed(&self, target: usize, survey: bool) -> Point3<f64> {
        let sigma = if survey { self.campaign.transfer.survey_sigma } else { 0.0 };
        self.campaign.truth[target] + self.survey[target] * sigma
    }

    /// What is measured of control in a station.
    pub fn control(&self, station: usize, conditions: &Conditions) -> Vec<Control> {
        let of = |(target, image)| Control { object: self.surveyed(target, conditions.survey), image };
        let seen = self.seen(station, conditions.measurement);
        seen.filter(|(target, _)| self.campaign.is_control[*target]).map(of).collect()
    }

    /// The corners of the board in each of its views as `method` measures them with `sigma_px`: where they are meant to be on a flat board, the board's
    /// units, and image coordinates.
    ///
    /// # Errors
    /// In words: no views within the bounds, a corner that is not pictured.
    pub fn boards(&self, board: &Board, method: &Method, sigma_px: f64, conditions: &Conditions) -> Result<Vec<Vec<Control>>, String> {
        let campaign = self.campaign;
        let camera = refocused(&campaign.subject.camera, conditions.refocus, campaign.transfer.pitch_um)?;
        let corners = bent(board, conditions.bend);
        let sigma = if conditions.measurement { sigma_px } else { 0.0 };
        let of_view = |station: &Station| {
            // Methods do not share their errors.
            let key = Key { view: &station.name, target: &method.name, ..self.key };
            let errors = errors(corners.len(), key, Purpose::DrawnPoint);
            let corner = |((target, at), [x, y]): ((&calibench_model::ObjectTarget, &Point3<f64>), [f64; 2])| {
                let seen = camera.project(station.pose.ray(at)).map_err(|error| format!("view {}: {error}", station.name))?;
                Ok(Control { object: target.surveyed, image: PixelPoint::new(seen.x + sigma * x, seen.y + sigma * y) })
            };
            board.field.targets.iter().zip(&corners).zip(errors).map(corner).collect()
        };
        self.boards.as_ref().map_err(Clone::clone)?.iter().map(of_view).collect()
    }
}

/// `count` pairs of standard normal numbers.
fn errors(count: usize, key: Key<'_>, purpose: Purpose) -> Vec<[f64; 2]> {
    let mut rng = stream(key, purpose);
    (0..count).map(|_| [StandardNormal.sample(&mut rng), StandardNormal.sample(&mut rng)]).collect()
}

/// Views whose corners all lie in the middle part of the frame.
fn views(board: &Board, camera: &Camera, key: Key<'_>) -> Result<Vec<Station>, String> {
    let size = camera.size();
    let [left, top] = [size.width, size.height].map(|side| 0.5 * f64::from(side) * (1.0 - board.within));
    let (right, bottom) = (f64::from(size.width) - left, f64::from(size.height) - top);
    let inside = |pose: &Pose, point: &Point3<f64>| {
        camera.project(pose.ray(point)).is_ok_and(|at| {
            let corner = at.to_corner();
            corner.x >= left && corner.x <= right && corner.y >= top && corner.y <= bottom
        })
    };
    let all_inside = |pose: &Pose| board.field.targets.iter().all(|target| inside(pose, &target.surveyed));
    board.views.generate(&board.aim, key, all_inside).map_err(|error| error.to_string())
}

/// The corners of a board whose middle is higher by `peak` than its outermost corners along its longer side.
pub(super) fn bent(board: &Board, peak: f64) -> Vec<Point3<f64>> {
    let targets = &board.field.targets;
    let ends = |axis: usize| {
        let along = targets.iter().map(|target| target.at[axis]);
        along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)))
    };
    let [(u0, u1), (v0, v1)] = [ends(0), ends(1)];
    let across = if u1 - u0 >= v1 - v0 { 0.0 } else { std::f64::consts::FRAC_PI_2 };
    let reach = 0.5 * (u1 - u0).max(v1 - v0);
    let mut plate = board.field.plates[0].clone();
    plate.bend = Some(Bend { peak, middle: [0.5 * (u0 + u1), 0.5 * (v0 + v1)], across, reach });
    targets.iter().map(|target| plate.point(target.at)).collect()
}
