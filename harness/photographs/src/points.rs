//! Points of a file, measured in the photographs that they name.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use calibench_exchange::{Outcome, PointRow, read_photo};
use calibench_measure::Configured;
use calibench_model::Start;
use rayon::prelude::*;

use crate::PhotographsError;
use crate::names::{ambiguous, names, once};

/// Measures every point in its photograph with every available method.
///
/// `points` name their images by file name, with folders where two photographs share one. One photograph a thread is in memory; `step` is called after each, on
/// any thread. Returns the outcomes of each point, in the order of the available `methods`; none for a point whose photograph is not among `photos`.
///
/// # Errors
/// A photograph that cannot be read, that is given twice, or that points do not name clearly.
pub fn measure_points(
    points: &[PointRow],
    photos: &[PathBuf],
    methods: &[Configured],
    step: &(dyn Fn() + Sync),
) -> Result<Vec<Vec<Outcome>>, PhotographsError> {
    let photos = by_name(photos, points)?;
    let one = |(name, path): (&String, &&Path)| {
        let found = in_photo(points, name, path, methods);
        step();
        found
    };
    let mut outcomes: Vec<Vec<Outcome>> = vec![Vec::new(); points.len()];
    for (index, outcome) in photos.par_iter().map(one).collect::<Result<Vec<_>, _>>()?.into_iter().flatten() {
        outcomes[index] = outcome;
    }
    Ok(outcomes)
}

/// Photographs by the names that point files give them: those of [`names`].
///
/// # Errors
/// A photograph given twice; points that may be of either of two.
pub fn by_name<'p>(paths: &'p [PathBuf], points: &[PointRow]) -> Result<BTreeMap<String, &'p Path>, PhotographsError> {
    once(paths)?;
    let unclear = points.iter().find_map(|point| Some((&point.image, ambiguous(paths, &point.image)?)));
    if let Some((name, both)) = unclear {
        return Err(PhotographsError::Ambiguous { name: name.clone(), paths: both.map(Path::to_owned) });
    }
    Ok(names(paths).into_iter().zip(paths.iter().map(PathBuf::as_path)).collect())
}

/// (index of the point, one outcome a method).
fn in_photo(points: &[PointRow], name: &str, path: &Path, methods: &[Configured]) -> Result<Vec<(usize, Vec<Outcome>)>, PhotographsError> {
    let wanted: Vec<usize> = (0..points.len()).filter(|&i| is_called(&points[i].image, name, path)).collect();
    // Read even if no point asks for it: a photograph that cannot be read is a mistake.
    let image = read_photo(path)?.image;
    let starts: Vec<Start> = wanted.iter().map(|&i| points[i].start).collect();
    let mut outcomes: Vec<(usize, Vec<Outcome>)> = wanted.into_iter().map(|i| (i, Vec::new())).collect();
    for operator in methods.iter().filter_map(|method| method.operator.as_ref().ok()) {
        for ((_, outcome), result) in outcomes.iter_mut().zip(operator.measure_all(&image, &starts)) {
            outcome.push(result.map_or_else(Outcome::Rejected, Outcome::Measured));
        }
    }
    Ok(outcomes)
}

/// A point file may give a photograph its folders, though its name alone would do here.
fn is_called(image: &str, name: &str, path: &Path) -> bool {
    image == name || Path::new(image) == path
}
