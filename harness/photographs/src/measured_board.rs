//! A board in an image, in the hands of many methods.

use std::path::PathBuf;
use std::sync::Arc;

use calibench_measure::{Configured, ImageId};
use calibench_model::camera::ImageSize;
use calibench_model::{Image, PixelPoint, Start, stop};
use calibench_records::results::{MethodInfo, Outcome, PointResult, Trial};
use rayon::prelude::*;

use crate::copies::copies;
use crate::names::{names, once, same_size};
use crate::{Finder, PhotographsError, Reader, Sighting};

/// A board in photographs of one camera, in the hands of many methods.
#[derive(Debug)]
pub struct MeasuredBoards {
    /// What was measured, by photograph, in the order given.
    pub trial: Trial,
    /// The size of the photographs.
    pub size: ImageSize,
    /// What is in doubt of where the board was found.
    pub doubts: Vec<String>,
}

/// A board's points in photographs, all of one size, in the hands of every available method. Photographs that are the same as another one are among those without
/// the board, and in doubt. `step` is called after each photograph, on any thread.
///
/// # Errors
/// A photograph that cannot be read, or that is given twice; photographs of several sizes.
pub fn measured_boards(
    reader: &Reader,
    finder: &Finder,
    methods: &[Configured],
    step: &(dyn Fn() + Sync),
) -> Result<MeasuredBoards, PhotographsError> {
    let (photos, names) = (reader.photos(), names(reader.photos()));
    once(photos)?;
    let size = same_size(photos.iter().zip(reader.sizes().iter().copied()))?;
    let one = |(path, name): (&PathBuf, &String)| {
        stop::point();
        let image = reader.read(path)?;
        let sighting = finder.find(&image, name);
        let at: Vec<(String, PixelPoint)> = sighting.rows.iter().map(|row| (finder.key(row), row.start.position)).collect();
        let (mut trial, mut doubts) = (Trial::default(), Vec::new());
        for (view, sighting) in views(name, sighting) {
            let (of_view, in_doubt) = measured_sighting(&image, &view, (finder, sighting), methods.iter().enumerate());
            trial.points.extend(of_view.points);
            trial.missed_views.extend(of_view.missed_views);
            doubts.extend(in_doubt);
        }
        step();
        Ok((trial, doubts, at))
    };
    let mut found = photos.par_iter().zip(&names).map(one).collect::<Result<Vec<_>, PhotographsError>>()?;
    let points: Vec<Vec<_>> = found.iter().map(|(.., at)| at.iter().map(|(target, at)| (target.as_str(), *at)).collect()).collect();
    for same in copies(&points) {
        found[same.of].1.push(same.said(&names));
        for copy in same.others {
            let why = format!("the same photograph as {}", names[same.of]);
            found[copy].0 = Trial { missed_views: vec![(names[copy].as_str().into(), why)], ..Trial::default() };
        }
    }
    let mut whole = MeasuredBoards { size, trial: Trial::default(), doubts: Vec::new() };
    for (trial, doubts, _) in found {
        whole.trial.points.extend(trial.points);
        whole.trial.missed_views.extend(trial.missed_views);
        whole.doubts.extend(doubts);
    }
    Ok(whole)
}

/// What was found in the photograph `name` by views, of which there is one where boards do not count each; what is in doubt stands with the first.
fn views(name: &str, mut found: Sighting) -> Vec<(String, Sighting)> {
    let doubts = std::mem::take(&mut found.doubts);
    let mut views: Vec<(String, Sighting)> = Vec::new();
    for row in std::mem::take(&mut found.rows) {
        match views.last_mut() {
            Some((view, own)) if *view == row.image => own.rows.push(row),
            _ => views.push((row.image.clone(), Sighting { rows: vec![row], ..found.clone() })),
        }
    }
    if views.is_empty() {
        views.push((name.to_owned(), found));
    }
    views[0].1.doubts = doubts;
    views
}

/// A method as results list it.
pub fn method_info(method: &Configured) -> MethodInfo {
    MethodInfo {
        label: method.label.as_str().into(),
        version: method.version.as_str().into(),
        unavailable: method.operator.as_ref().err().cloned(),
    }
}

/// A board's points in an image called `view`, in the hands of every available method of these, with their places, from the same whole pixels; and what is in doubt.
pub fn measured_board<'m>(
    image: &Image,
    view: &str,
    finder: &Finder,
    methods: impl IntoIterator<Item = (usize, &'m Configured)>,
) -> (Trial, Vec<String>) {
    measured_sighting(image, view, (finder, finder.find(image, view)), methods)
}

fn measured_sighting<'m>(
    image: &Image,
    view: &str,
    (finder, found): (&Finder, Sighting),
    methods: impl IntoIterator<Item = (usize, &'m Configured)>,
) -> (Trial, Vec<String>) {
    let doubts = found.doubts.iter().map(|doubt| format!("{view}: {doubt}")).collect();
    let (mut trial, view): (Trial, Arc<str>) = (Trial::default(), view.into());
    if let Some(why) = found.why {
        trial.missed_views.push((view, why));
        return (trial, doubts);
    }
    // Whole pixels, as a hand would point: no operator starts from another's result.
    let start = |given: Start| Start {
        kind: given.kind,
        affine: given.affine.filter(|_| finder.tells_size()),
        warp: given.warp,
        ..Start::at(PixelPoint::new(given.position.x.round(), given.position.y.round()))
    };
    let starts: Vec<Start> = found.rows.iter().map(|row| start(row.start)).collect();
    let names: Vec<String> = found.rows.into_iter().map(|row| row.target).collect();
    for (method, operator) in methods.into_iter().filter_map(|(i, method)| Some((i, method.operator.as_deref().ok()?))) {
        stop::point();
        let results = match operator.recorded() {
            Some(recorded) => {
                recorded.recall(ImageId { trial: 0, view: &view }, image, &names.iter().map(String::as_str).collect::<Vec<_>>())
            }
            None => operator.measure_all(image, &starts),
        };
        for (index, result) in results.into_iter().enumerate() {
            let outcome = match result {
                Ok(found) => Outcome::Measured { position: found.position, error: None },
                Err(rejection) => Outcome::Rejected(rejection),
            };
            trial.points.push(PointResult::new(view.clone(), names[index].clone(), method, outcome));
        }
    }
    (trial, doubts)
}
