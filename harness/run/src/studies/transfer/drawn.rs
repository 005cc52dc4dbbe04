//! What is measured in a trial: errors of image coordinates and of the survey, drawn or from rendered images, and the views of the board.

use std::cell::RefCell;
use std::rc::Rc;

use calibench_adjust::approximate::Control;
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{PixelPoint, Pose};
use calibench_random::{Key, Purpose, stream};
use calibench_scenario::studies::transfer::{Board, Conditions};
use calibench_synth::stations::Station;
use nalgebra::{Point3, Vector3};
use rand_distr::{Distribution, StandardNormal};

use super::bent::bent;
use super::camera::refocused;
use super::imaged::{BoardImages, measured_wall};
use super::{Campaign, Seen};
use crate::RunError;

/// What is measured in a trial, drawn or in rendered images, and its survey, which all conditions share, and its board's views.
pub struct Drawn<'a> {
    campaign: &'a Campaign<'a>,
    key: Key<'a>,
    /// Of each station: target and image coordinates, px.
    images: Vec<Vec<Seen>>,
    /// How many targets were not measured.
    missed: usize,
    /// Of each target, errors of standard deviation 1.
    survey: Vec<Vector3<f64>>,
    /// The views of the board, the board's units; why there are none.
    boards: Result<Vec<Station>, String>,
    /// What was measured in images of the board, by its bend and the refocus.
    measured: RefCell<Vec<([f64; 2], Rc<BoardImages>)>>,
}

impl<'a> Drawn<'a> {
    /// Of the trial of `key`.
    ///
    /// # Errors
    /// Images that cannot be rendered.
    pub fn new(campaign: &'a Campaign<'a>, key: Key<'a>) -> Result<Self, RunError> {
        let subject = campaign.subject;
        let targets = &subject.field.targets;
        let survey = |target: &calibench_model::ObjectTarget| {
            let mut rng = stream(Key { target: &target.id, ..key }, Purpose::Control);
            Vector3::from_fn(|_, _| StandardNormal.sample(&mut rng))
        };
        let boards = match &campaign.transfer.board {
            Some(board) => views(board, &subject.camera, key),
            None => Ok(Vec::new()),
        };
        let (images, missed) = match &campaign.transfer.measured_by {
            Some(measuring) => measured_wall(campaign, measuring, key)?,
            None => (drawn_wall(campaign, key), 0),
        };
        let survey = targets.iter().map(survey).collect();
        Ok(Self { campaign, key, images, missed, survey, boards, measured: RefCell::default() })
    }

    /// How many targets of the field were not measured, in all stations.
    pub fn missed(&self) -> usize {
        self.missed
    }

    /// Of a station what is measured: target and image coordinates, px; with `measurement` off the truth of it.
    pub fn seen(&self, station: usize, measurement: bool) -> &[Seen] {
        if measurement { &self.images[station] } else { &self.campaign.images[station] }
    }

    /// Where the survey has a target, object units.
    pub fn surveyed(&self, target: usize, survey: bool) -> Point3<f64> {
        let sigma = if survey { self.campaign.transfer.survey_sigma } else { 0.0 };
        self.campaign.truth[target] + self.survey[target] * sigma
    }

    /// What is measured of control in a station.
    pub fn control(&self, station: usize, conditions: &Conditions) -> Vec<Control> {
        let of = |&(target, image): &Seen| Control { object: self.surveyed(target, conditions.survey), image };
        let seen = self.seen(station, conditions.measurement).iter();
        seen.filter(|(target, _)| self.campaign.is_control[*target]).map(of).collect()
    }

    /// The corners of the board in each of its views as the method at `place` measures them, and how many were not measured.
    ///
    /// # Errors
    /// In words: no views within the bounds, a corner that is not pictured, images that cannot be rendered.
    pub fn boards(&self, place: usize, sigma_px: f64, conditions: &Conditions) -> Result<(Vec<Vec<Seen>>, usize), String> {
        let campaign = self.campaign;
        let (board, method) = (campaign.transfer.board.as_ref().ok_or("there is no board")?, &campaign.transfer.methods[place]);
        let stations = self.boards.as_ref().map_err(Clone::clone)?;
        let camera = refocused(&campaign.subject.camera, conditions.refocus, campaign.transfer.pitch_um)?;
        if conditions.measurement && method.measured_by.is_some() {
            let images = self.board_images(board, &camera, stations, conditions)?;
            return Ok((images.of(place), images.missed(place)));
        }
        let corners = bent(board, conditions.bend);
        let sigma = if conditions.measurement { sigma_px } else { 0.0 };
        let of_view = |station: &Station| {
            // Methods do not share their errors.
            let key = Key { view: &station.name, target: &method.name, ..self.key };
            let errors = errors(corners.len(), key, Purpose::DrawnPoint);
            let corner = |((place, at), [x, y]): ((usize, &Point3<f64>), [f64; 2])| {
                let seen = camera.project(station.pose.ray(at)).map_err(|error| format!("view {}: {error}", station.name))?;
                Ok((place, PixelPoint::new(seen.x + sigma * x, seen.y + sigma * y)))
            };
            corners.iter().enumerate().zip(errors).map(corner).collect()
        };
        let views: Result<Vec<Vec<Seen>>, String> = stations.iter().map(of_view).collect();
        Ok((views?, 0))
    }

    /// What all methods measure in images of the board: rendered once for each bend and refocus.
    fn board_images(
        &self,
        board: &Board,
        camera: &Camera,
        stations: &[Station],
        conditions: &Conditions,
    ) -> Result<Rc<BoardImages>, String> {
        let which = [conditions.bend, conditions.refocus];
        if let Some((_, known)) = self.measured.borrow().iter().find(|(other, _)| *other == which) {
            return Ok(known.clone());
        }
        let found = BoardImages::new(self.campaign, (board, camera, conditions.bend), stations, self.key).map_err(|why| why.to_string())?;
        let found = Rc::new(found);
        self.measured.borrow_mut().push((which, found.clone()));
        Ok(found)
    }
}

/// Image coordinates of the field that are drawn.
fn drawn_wall(campaign: &Campaign<'_>, key: Key<'_>) -> Vec<Vec<Seen>> {
    let (subject, sigma) = (campaign.subject, campaign.transfer.sigma_px);
    let station = |(station, seen): (&Station, &Vec<Seen>)| {
        let errors = errors(subject.field.targets.len(), Key { view: &station.name, ..key }, Purpose::CommonError);
        let point = |&(target, at): &Seen| {
            let [x, y] = errors[target];
            (target, PixelPoint::new(at.x + sigma * x, at.y + sigma * y))
        };
        seen.iter().map(point).collect()
    };
    subject.stations.iter().zip(&campaign.images).map(station).collect()
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
