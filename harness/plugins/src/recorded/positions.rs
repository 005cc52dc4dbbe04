//! A file's positions, by image and target.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::{Path, PathBuf};

use calibench_diagnostics::nearest;
use calibench_exchange::points::{Check, read_points_checked};
use calibench_exchange::{Fingerprint, PointFile, RENDERED, RenderedImage, read_rendered};
use calibench_measure::{ImageId, Known, RunId};
use calibench_model::points::{Groups, Names};
use calibench_model::{Measurement, PointRef, Points, Rejection};

use super::declaration::{Images, Origin, Recording};

/// The positions of a file. They take as much memory as the file has rows, whatever is run.
pub struct Positions {
    /// The file as it is called in its declaration.
    pub file: String,
    path: PathBuf,
    scenario: String,
    origin: Origin,
    /// Where images are rendered: the seed, and the images.
    rendered: Option<(u64, ByTrial)>,
    points: Points,
    by_image: Groups,
    lost: Lost,
}

/// The name and the fingerprint of each image, by trial and view.
type ByTrial = BTreeMap<u64, HashMap<String, (String, Fingerprint)>>;
/// Why rows have no position, by image and target.
type Lost = HashMap<String, HashMap<String, Rejection>>;

/// An image that has a row: its name in the file, and by what it is known again.
pub struct Found<'a> {
    name: &'a str,
    /// Its fingerprint, if it was rendered.
    pub fingerprint: Option<&'a Fingerprint>,
}

impl Positions {
    /// Reads the file of `recording` and the list of its images.
    pub(super) fn read(recording: &Recording, folder: &Path) -> Result<Self, String> {
        let path = folder.join(&recording.file);
        let (scenario, rendered, list) = match &recording.images {
            Images::Photographs(scenario) => (scenario.clone(), None, None),
            Images::Rendered(images) => {
                let list = folder.join(images);
                let images = read_rendered(&list).map_err(|error| error.to_string())?;
                let (scenario, seed) = of_one_run(&images).map_err(|why| format!("{}: {why}", list.join(RENDERED).display()))?;
                (scenario, Some((seed, images)), Some(list))
            }
        };
        let names: Vec<&str> = rendered.iter().flat_map(|(_, images)| images).map(|one| one.image.as_str()).collect();
        let all: HashSet<&str> = names.iter().copied().collect();
        let known = |name: &str| all.is_empty() || all.contains(name);
        let whose = list.map_or_else(String::new, |list| list.join(RENDERED).display().to_string());
        let check = |image: &str| if known(image) { Ok(()) } else { Err(stranger("image", image, &whose, &names)) };
        let file = read_points_checked(&path, &|row| check(row.image).map_err(|why| ("image", why))).map_err(|error| error.to_string())?;
        let lost = lost(&file).map_err(|why| format!("{}: {why}", path.display()))?;
        let rendered = rendered.map(|(seed, images)| (seed, by_trial(images)));
        let by_image = file.points.by_image();
        Ok(Self { file: recording.file.clone(), path, origin: recording.origin, scenario, rendered, points: file.points, by_image, lost })
    }

    /// How many positions and images there are.
    pub fn counts(&self) -> [usize; 2] {
        [self.points.len(), self.points.images().len()]
    }

    /// Why nothing of it is of a run.
    pub fn unfit(&self, run: &RunId<'_>) -> Option<String> {
        let Self { file, scenario, rendered, .. } = self;
        match rendered {
            _ if scenario != run.scenario => Some(format!("`{file}` is of images of the scenario `{scenario}`")),
            Some(_) if run.photographs => Some(format!("`{file}` is of rendered images, and this scenario is of photographs")),
            None if !run.photographs => {
                Some(format!("`{file}` does not say which rendered images were measured: give `images`, the folder that `render` wrote"))
            }
            Some((seed, _)) if *seed != run.seed => {
                Some(format!("`{file}` is of images of the seed {seed}, and this run has the seed {}", run.seed))
            }
            _ => None,
        }
    }

    /// Whether its targets, and its photographs, are those of a run.
    ///
    /// # Errors
    /// The first name that is not, with line and column and the nearest right one.
    pub fn check(&self, known: &Known<'_>) -> Result<(), String> {
        let Known { targets, photographs } = known;
        let foreign = |names: &Names, known: &[&str]| {
            let known: HashSet<&str> = known.iter().copied().collect();
            names.iter().any(|name| !known.contains(name))
        };
        let of_photographs = self.rendered.is_none();
        let any = foreign(self.points.targets(), targets) || (of_photographs && foreign(self.points.images(), photographs));
        if !any {
            return Ok(());
        }
        // It is read again for the line.
        let whose = format!("the scenario `{}`", self.scenario);
        let check: Check<'_> = &|row| {
            if of_photographs && !photographs.contains(&row.image) {
                return Err(("image", stranger("photograph", row.image, &whose, photographs)));
            }
            if targets.contains(&row.target) { Ok(()) } else { Err(("target", stranger("target", row.target, &whose, targets))) }
        };
        read_points_checked(&self.path, check).map(|_| ()).map_err(|error| error.to_string())
    }

    /// The image of a run, if the file may have a row of it.
    pub fn image<'a>(&'a self, which: ImageId<'a>) -> Option<Found<'a>> {
        let Some((_, images)) = &self.rendered else { return Some(Found { name: which.view, fingerprint: None }) };
        let (name, fingerprint) = images.get(&which.trial)?.get(which.view)?;
        Some(Found { name, fingerprint: Some(fingerprint) })
    }

    /// What the file says of targets in an image, in their order; `None` if it has no row of the image.
    pub fn of(&self, image: &Found<'_>, targets: &[&str]) -> Option<Vec<Result<Measurement, Rejection>>> {
        let place = self.points.images().find(image.name);
        let lost = self.lost.get(image.name);
        if place.is_none() && lost.is_none() {
            return None;
        }
        let rows = place.into_iter().flat_map(|place| self.by_image.of_group(place));
        let rows: HashMap<usize, usize> = rows.map(|row| (self.points.target_of(row), row)).collect();
        let one = |target: &&str| match self.points.targets().find(target).and_then(|target| rows.get(&target)) {
            Some(&row) => {
                Ok(Measurement { position: self.origin.position(self.points.position(row)), covariance: self.points.covariance(row) })
            }
            None => Err(lost.and_then(|lost| lost.get(*target)).copied().unwrap_or(Rejection::NotGiven)),
        };
        Some(targets.iter().map(one).collect())
    }
}

/// Scenario and seed of images, which are those of all.
fn of_one_run(images: &[RenderedImage]) -> Result<(String, u64), String> {
    let first = images.first().map(|one| (one.scenario.clone(), one.seed)).ok_or("holds no image")?;
    match images.iter().find(|one| (&one.scenario, one.seed) != (&first.0, first.1)) {
        Some(other) => Err(format!("`{}` is of another scenario or seed than the first image; expected one folder a run", other.image)),
        None => Ok(first),
    }
}

fn by_trial(images: Vec<RenderedImage>) -> ByTrial {
    let mut found = ByTrial::new();
    for RenderedImage { image, trial, view, fingerprint, .. } in images {
        found.entry(trial).or_default().insert(view, (image, fingerprint));
    }
    found
}

/// Rows without a position: what measured says why, in its own words or in ours.
fn lost(file: &PointFile) -> Result<Lost, String> {
    let mut found = Lost::new();
    for [image, target, _, reason] in file.lost.iter() {
        let why = Rejection::ALL.into_iter().find(|why| why.name() == reason).unwrap_or(Rejection::Declined);
        if found.entry(image.to_owned()).or_default().insert(target.to_owned(), why).is_some() {
            return Err(format!("target `{target}` of image `{image}` has two rows without a position; expected each once"));
        }
    }
    let twice = |row: &PointRef<'_>| found.get(row.image).is_some_and(|lost| lost.contains_key(row.target));
    match file.points.rows().find(|row| !found.is_empty() && twice(row)) {
        Some(row) => {
            Err(format!("target `{}` of image `{}` has a row with a position and one without; expected each once", row.target, row.image))
        }
        None => Ok(found),
    }
}

fn stranger(what: &str, name: &str, whose: &str, known: &[&str]) -> String {
    let near = nearest(name, known.iter().copied()).map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
    format!("no {what} of {whose} is called `{name}`{near}")
}
