//! The images of a trial in memory, with their truth: what `render` writes into files.

use calibench_model::camera::Camera;
use calibench_model::{Affine, Image, PixelPoint, Pose, Start, TargetKind};
use calibench_random::Key;
use calibench_scenario::{Scenario, SceneSubject, Subject, ViewsSubject};
use calibench_synth::stations::Station;
use calibench_synth::view::Visibility;
use nalgebra::Point3;
use rayon::prelude::*;

use crate::prepared::{Prepared, PreparedView};
use crate::{RunError, VIEW, prepared, scene};

/// A target and the truth about it.
#[derive(Clone, Debug, PartialEq)]
pub struct TrueTarget {
    /// Its name.
    pub id: String,
    /// Its kind.
    pub kind: TargetKind,
    /// Where its reference point is, px; `None` if it has no place in the image plane.
    pub at: Option<PixelPoint>,
    /// How much of it is in the image.
    pub visibility: Visibility,
    /// The affine part of the map from the target's own axes to the image, px.
    pub affine: Option<Affine>,
    /// Its reference point, object units; `None` in a flat scene, which has no object.
    pub object: Option<Point3<f64>>,
}

/// An image and all that is known of it.
#[derive(Clone, Debug)]
pub struct Shot {
    /// The station's name, or that of the only view.
    pub name: String,
    /// What the sensor gave.
    pub image: Image<'static>,
    /// All targets.
    pub targets: Vec<TrueTarget>,
    /// Where measuring starts, by the names of targets.
    pub starts: Vec<(String, Start)>,
    /// The camera and where it stood; `None` in a flat scene.
    pub camera: Option<(Camera, Pose)>,
}

/// The images of trial `trial` of a scenario under `seed`, all of them or those of some stations. Of a sweep the first cell's.
///
/// # Errors
/// Photographs and printed figures, which are not rendered; a station that there is not; a view that cannot be pictured.
pub fn shots(scenario: &Scenario, seed: u64, trial: u64, stations: &[String]) -> Result<Vec<Shot>, RunError> {
    let key = Key { seed, of: &scenario.drawn, trial, view: "", target: "" };
    match &scenario.subject {
        Subject::Scene(subject) => {
            known(stations, &[VIEW])?;
            Ok(vec![flat(subject, key)?])
        }
        Subject::Views(subject) => from_stations(subject, key, stations),
        Subject::Photographs(_) | Subject::Printed(_) => Err(RunError::NothingToRender),
    }
}

fn known(asked: &[String], names: &[&str]) -> Result<(), RunError> {
    match asked.iter().find(|name| !names.contains(&name.as_str())) {
        Some(name) => Err(RunError::NoStation { name: name.clone(), known: names.join(", ") }),
        None => Ok(()),
    }
}

fn flat(subject: &SceneSubject, key: Key<'_>) -> Result<Shot, RunError> {
    let key = Key { view: VIEW, ..key };
    let truth = scene::trial_truth(subject, key);
    let image = scene::trial_picture(subject, &subject.renderer()?, &truth, key)?.image;
    let starts = scene::starts(subject, &image, &truth, key);
    let starts = truth.targets.iter().zip(starts).filter_map(|(target, start)| Some((target.id.clone(), start?))).collect();
    let target = |target: &calibench_model::SceneTarget| TrueTarget {
        id: target.id.clone(),
        kind: target.kind,
        at: Some(target.at),
        visibility: Visibility::Visible,
        affine: None,
        object: None,
    };
    Ok(Shot { name: VIEW.into(), image, targets: truth.targets.iter().map(target).collect(), starts, camera: None })
}

fn from_stations(subject: &ViewsSubject, key: Key<'_>, asked: &[String]) -> Result<Vec<Shot>, RunError> {
    let drawn = subject.stations_of(key)?;
    known(asked, &drawn.iter().map(|station| station.name.as_str()).collect::<Vec<_>>())?;
    let chosen = |station: &&Station| asked.is_empty() || asked.contains(&station.name);
    let stations: Vec<Station> = drawn.iter().filter(chosen).cloned().collect();
    let prepared = Prepared::of(subject, &stations, key)?;
    let shots = prepared.views.par_iter().map(|view| from_station(subject, &prepared, view, key)).collect::<Vec<_>>();
    shots.into_iter().collect()
}

fn from_station(subject: &ViewsSubject, prepared: &Prepared<'_>, view: &PreparedView<'_>, key: Key<'_>) -> Result<Shot, RunError> {
    let image = prepared.image(view, key)?.image;
    let starts = prepared::starts(prepared, view, &image, key).into_iter().map(|(name, start)| (name.to_owned(), start)).collect();
    let target = |(target, truth): (&calibench_model::ObjectTarget, &calibench_synth::view::TargetTruth)| TrueTarget {
        id: target.id.clone(),
        kind: target.kind,
        at: truth.at,
        visibility: truth.visibility,
        affine: truth.affine,
        object: Some(truth.object),
    };
    let targets = subject.field.targets.iter().zip(&view.truth).map(target).collect();
    Ok(Shot { name: view.station.name.clone(), image, targets, starts, camera: Some((subject.camera, view.station.pose)) })
}
