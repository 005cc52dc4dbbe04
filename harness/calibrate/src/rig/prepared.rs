//! From points and control to a rig with start values.

use calibench_adjust::{Exterior, ImageObservation, Interior, ObjectPoint, Options, Precision, Rig, Station, adjust};
use calibench_model::camera::Camera;
use calibench_model::{ControlRow, Points, Pose};
use nalgebra::Point3;

use super::pairing::{Moments, Pairing};
use super::start::{Seen, mounts, stations};
use crate::ended::ITERATIONS;
use crate::start::{control_of, robust_pose_of};
use crate::{BoardShape, CalibrationError, DatumChoice, GrossErrors, Prepared, Settings, StatedBoard, Survey, few, optics, prepare};

/// Known points of an image from which its own pose is looked for.
const LEAST: usize = 6;
/// Known points of a set from which the rig is placed.
const LEAST_OF_SET: usize = 4;
/// Huber's bound of each camera's own calibration, in standard deviations.
const BOUND: f64 = 2.0;

/// How a rig is calibrated.
#[derive(Clone, Debug)]
pub struct RigSettings {
    /// Its cameras, in its order, and how they are calibrated. Control is fixed.
    pub settings: Settings,
    /// How images of one moment are told.
    pub pairing: Pairing,
    /// The camera that defines the frame of the rig.
    pub origin: usize,
}

/// A rig with its start values.
#[derive(Clone, Debug)]
pub struct RigPrepared {
    /// How it was asked for.
    pub asked: RigSettings,
    /// Who measured what.
    pub survey: Survey,
    /// Which images belong together.
    pub moments: Moments,
    /// Where the interior orientation of each camera started.
    pub origins: Vec<String>,
    /// What is adjusted. Its images are those of the survey that take part.
    pub rig: Rig,
    /// Of each of its images, that of the survey.
    pub images: Vec<usize>,
    /// The sight behind each of its observations.
    pub sights: Vec<u32>,
    /// Images that take no part, with the reason.
    pub left_out: Vec<(String, String)>,
}

impl RigPrepared {
    /// Images of the rig that no other camera took with it.
    pub fn alone(&self) -> Vec<&str> {
        let mut members = vec![0; self.rig.stations.len()];
        self.rig.station_of.iter().for_each(|&station| members[station] += 1);
        let images = self.rig.network.images.iter().zip(&self.rig.station_of);
        images.filter(|(_, station)| members[**station] == 1).map(|(image, _)| image.name.as_str()).collect()
    }
}

/// Joins points with control, finds out which images belong together, and start values for everything: each camera by itself, its images' poses, and from these where
/// the cameras sit.
///
/// # Errors
/// As [`prepare`]; images that cannot be paired, cameras that share no moment, by name; what a rig is not adjusted with (unknown points, a bent board).
pub fn prepare_rig(points: &Points, control: &[ControlRow], asked: &RigSettings) -> Result<RigPrepared, CalibrationError> {
    let settings = own_settings(&asked.settings)?;
    let survey = Survey::new(points.clone(), control)?;
    let owners = optics::owners(&settings.cameras, &survey.images)?;
    let moments = Moments::of(&survey.images, &owners, &asked.pairing)?;
    let known: Vec<Option<Point3<f64>>> = (0..survey.targets()).map(|target| survey.known(target)).collect();
    let seen: Vec<_> = (0..survey.images.len()).map(|image| control_of(&survey, &known, image)).collect();
    let (cameras, interiors, origins) = cameras(points, control, &settings, &seen)?;
    let images: Vec<Seen> = seen
        .iter()
        .enumerate()
        .map(|(image, control)| Seen {
            camera: owners[image],
            set: moments.of_image[image],
            pose: (control.len() >= LEAST).then(|| robust_pose_of(&cameras[owners[image]], control).ok()).flatten(),
            points: control.iter().map(|seen| (seen.object, seen.image)).collect(),
        })
        .collect();
    let names: Vec<String> = settings.cameras.iter().map(|optics| optics.name.clone()).collect();
    let mounts = mounts(&images, &names, asked.origin)?;
    let places = stations(&images, &moments, &mounts, &cameras);
    let mut prepared = RigPrepared {
        asked: RigSettings { settings, ..asked.clone() },
        survey,
        moments,
        origins,
        rig: Rig { mounts, origin: asked.origin, ..Rig::default() },
        images: Vec::new(),
        sights: Vec::new(),
        left_out: Vec::new(),
    };
    prepared.rig.network.cameras = interiors;
    prepared.fill(&images, &places);
    Ok(prepared)
}

/// The settings of each camera by itself; what a rig is not adjusted with is refused.
fn own_settings(settings: &Settings) -> Result<Settings, CalibrationError> {
    let refused = |what: &str| Err(CalibrationError::Rig(format!("{what}: a rig is adjusted before points that are known")));
    match (&settings.datum, settings.shape) {
        (DatumChoice::Control | DatumChoice::Fixed, BoardShape::Flat | BoardShape::Tested) => {}
        (DatumChoice::Control | DatumChoice::Fixed, _) => return refused("--board-shape is not flat"),
        _ => return refused("--datum is neither control nor fixed"),
    }
    if settings.discs.is_some() {
        return refused("the eccentricity of discs is asked for");
    }
    if !settings.stations.is_empty() {
        return refused("--poses are given");
    }
    if settings.board != StatedBoard::default() {
        return refused("--board-scale, --print-noise or --save-board is given");
    }
    if matches!(settings.gross, GrossErrors::Weighted(_)) {
        return Err(CalibrationError::Rig("--huber is not there for a rig: expected --snoop, --plain or neither".into()));
    }
    Ok(Settings { datum: DatumChoice::Fixed, shape: BoardShape::Flat, ..settings.clone() })
}

/// Each camera by itself: start values, what is known of its parameters, and where it comes from.
type Cameras = (Vec<Camera>, Vec<Interior>, Vec<String>);

fn cameras(
    points: &Points,
    control: &[ControlRow],
    settings: &Settings,
    seen: &[Vec<calibench_adjust::approximate::Control>],
) -> Result<Cameras, CalibrationError> {
    let mut enough = Points::default();
    for index in (0..points.len()).filter(|&index| seen[points.image_of(index)].len() >= LEAST) {
        let row = points.row(index);
        enough.push(row.image, row.target, row.start);
    }
    if enough.is_empty() {
        return Err(CalibrationError::Rig(format!("no image sees {LEAST} known points or more")));
    }
    let own = Settings { gross: GrossErrors::Weighted(BOUND), ..settings.clone() };
    let mut prepared = prepare(enough, control, &own)?;
    let options = Options { most_iterations: ITERATIONS, ..Options::default() };
    let robust = |prepared: &Prepared| Some(prepared.solution().ok()?.0.cameras().to_vec());
    let (mut cameras, mut held) = (robust(&prepared), None);
    if cameras.is_none() {
        // What the images of a camera do not determine, those of the rig do hardly.
        held = prepared.held_weakly();
        cameras = held.as_ref().and_then(|held| Some(adjust(&held.network, &options).ok()?.cameras().to_vec()));
    }
    if let Some(held) = held.filter(|_| cameras.is_some()) {
        prepared = held;
    }
    let cameras = cameras.unwrap_or_else(|| prepared.network.cameras.iter().map(|interior| interior.camera).collect());
    let mut interiors = prepared.network.cameras;
    interiors.iter_mut().zip(&cameras).for_each(|(interior, camera)| interior.camera = *camera);
    Ok((cameras, interiors, prepared.origins))
}

impl RigPrepared {
    /// Stations, images and observations of what takes part.
    fn fill(&mut self, images: &[Seen], places: &[Option<Pose>]) {
        let mut seen = vec![0; places.len()];
        images.iter().for_each(|image| seen[image.set] += image.points.len());
        let mut station_of_set = vec![None; places.len()];
        for (set, place) in places.iter().enumerate().filter(|(set, _)| seen[*set] >= LEAST_OF_SET) {
            if let Some(pose) = place {
                station_of_set[set] = Some(self.rig.stations.len());
                self.rig.stations.push(Station { name: self.moments.names[set].clone(), pose: *pose });
            }
        }
        let mut place_of_target = vec![None; self.survey.targets()];
        let sigma = self.asked.settings.sigma();
        for (index, image) in images.iter().enumerate() {
            let name = self.survey.images[index].clone();
            let Some(station) = station_of_set[image.set] else {
                let why = format!("{} known points, and no image of its moment places the rig", image.points.len());
                self.left_out.push((name, why));
                continue;
            };
            if image.points.is_empty() {
                self.left_out.push((name, "no known point".into()));
                continue;
            }
            let place = self.rig.network.images.len();
            self.images.push(index);
            self.rig.station_of.push(station);
            let pose = calibench_adjust::mounted(&self.rig.mounts[image.camera], &self.rig.stations[station].pose);
            self.rig.network.images.push(Exterior::free(name, image.camera, pose));
            for sight in self.survey.of_image(index) {
                let seen = self.survey.sight(sight);
                let Some(position) = self.survey.known(seen.target) else { continue };
                let points = &mut self.rig.network.points;
                let point = *place_of_target[seen.target].get_or_insert_with(|| {
                    points.push(ObjectPoint::fixed(self.survey.target(seen.target), position));
                    points.len() - 1
                });
                let own = seen.covariance.filter(|_| self.asked.settings.covariances);
                let precision = own.map_or(Precision::Sigma(sigma), Precision::Covariance);
                self.rig.network.observations.push(ImageObservation {
                    image: place,
                    point,
                    position: seen.position,
                    precision,
                    behind: false,
                });
                self.sights.push(sight as u32);
            }
        }
    }

    /// Images that take no part, in a few words.
    pub fn left_out_words(&self) -> Option<String> {
        let names: Vec<String> = self.left_out.iter().map(|(name, _)| name.clone()).collect();
        let (_, why) = self.left_out.first()?;
        Some(format!("{} of {} images take no part: {} ({why})", names.len(), self.survey.images.len(), few(&names)))
    }
}
