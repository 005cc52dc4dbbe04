//! A board in an image, in the hands of many methods.

use std::path::PathBuf;
use std::sync::Arc;

use calibench_exchange::read_photo;
use calibench_measure::{Configured, ImageId};
use calibench_model::camera::ImageSize;
use calibench_model::{Image, PixelPoint, Start, stop};
use calibench_records::results::{MethodInfo, Outcome, PointResult, Trial};
use rayon::prelude::*;

use crate::names::{names, once, same_size};
use crate::{Finder, PhotographsError};

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

/// A board's points in photographs, all of one size, in the hands of every available method. `step` is called after each photograph, on any thread.
///
/// # Errors
/// A photograph that cannot be read, or that is given twice; photographs of several sizes.
pub fn measured_boards(
    photos: &[PathBuf],
    finder: &Finder,
    methods: &[Configured],
    step: &(dyn Fn() + Sync),
) -> Result<MeasuredBoards, PhotographsError> {
    once(photos)?;
    let one = |(path, name): (&PathBuf, &String)| {
        stop::point();
        let image = read_photo(path)?.image;
        let found = measured_board(&image, name, finder, methods.iter().enumerate());
        step();
        Ok((found, ImageSize { width: image.width() as u32, height: image.height() as u32 }))
    };
    let found = photos.par_iter().zip(&names(photos)).map(one).collect::<Result<Vec<_>, PhotographsError>>()?;
    let size = same_size(photos.iter().zip(found.iter().map(|(_, size)| *size)))?;
    let mut whole = MeasuredBoards { size, trial: Trial::default(), doubts: Vec::new() };
    for ((trial, doubts), _) in found {
        whole.trial.points.extend(trial.points);
        whole.trial.missed_views.extend(trial.missed_views);
        whole.doubts.extend(doubts);
    }
    Ok(whole)
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
    let found = finder.find(image, view);
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
