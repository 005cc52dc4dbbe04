//! A file of positions among the operators.

use std::sync::{Arc, Mutex, PoisonError};

use calibench_measure::{ImageId, Known, Operator, Recorded, RunId};
use calibench_model::{Image, Measurement, Rejection, Start};

use super::positions::Positions;
use super::told::Cases;
use crate::declaration::Grey;
use crate::request::rounds;

type Measured = Result<Measurement, Rejection>;

/// A file of positions, and what is told of how it fits a run.
pub struct Recalled {
    positions: Arc<Positions>,
    told: Mutex<Told>,
}

#[derive(Default)]
struct Told {
    /// Images that were asked for.
    images: u64,
    /// Those of which it has no row, by trial and view.
    missing: Cases<(u64, String)>,
    /// Those that are not as they were rendered.
    other: Cases<(u64, String)>,
    /// Targets without a row in images of which it has one.
    absent: Cases<(u64, String, String)>,
    rounded: bool,
}

impl Recalled {
    pub fn new(positions: Arc<Positions>) -> Self {
        Self { positions, told: Mutex::default() }
    }

    /// What the file says, or why it says nothing of the image.
    fn found(&self, which: ImageId<'_>, image: &Image, targets: &[&str], told: &mut Told) -> Result<Vec<Measured>, Rejection> {
        let place = || (which.trial, which.view.to_owned());
        let missing = |told: &mut Told| {
            told.missing.add(1, &place());
            Rejection::NotGiven
        };
        told.images += 1;
        let Some(found) = self.positions.image(which) else { return Err(missing(told)) };
        if let Some(fingerprint) = found.fingerprint {
            if !fingerprint.is_of(image) {
                told.other.add(1, &place());
                return Err(Rejection::OtherImage);
            }
            told.rounded |= rounds(image, if fingerprint.is_deep() { Grey::Gray16le } else { Grey::Gray8 });
        }
        self.positions.of(&found, targets).ok_or_else(|| missing(told))
    }
}

impl Recorded for Recalled {
    fn unfit(&self, run: &RunId<'_>) -> Option<String> {
        self.positions.unfit(run)
    }

    fn check(&self, known: &Known<'_>) -> Result<(), String> {
        self.positions.check(known)
    }

    fn recall(&self, which: ImageId<'_>, image: &Image, targets: &[&str]) -> Vec<Measured> {
        let mut told = Told::default();
        let results = self.found(which, image, targets, &mut told).unwrap_or_else(|why| vec![Err(why); targets.len()]);
        if told.missing.said(|_, _| ()).is_none() {
            for (target, _) in targets.iter().zip(&results).filter(|(_, result)| **result == Err(Rejection::NotGiven)) {
                told.absent.add(1, &(which.trial, which.view.to_owned(), (*target).to_owned()));
            }
        }
        self.told.lock().unwrap_or_else(PoisonError::into_inner).join(&told);
        results
    }
}

impl Operator for Recalled {
    fn measure(&self, _: &Image, _: &Start) -> Measured {
        Err(Rejection::NotGiven)
    }

    fn recorded(&self) -> Option<&dyn Recorded> {
        Some(self)
    }

    fn notes(&self) -> Vec<String> {
        self.told.lock().unwrap_or_else(PoisonError::into_inner).notes(&self.positions.file)
    }
}

impl Told {
    fn join(&mut self, other: &Self) {
        self.images += other.images;
        self.rounded |= other.rounded;
        other.missing.said(|count, first| self.missing.add(count, first));
        other.other.said(|count, first| self.other.add(count, first));
        other.absent.said(|count, first| self.absent.add(count, first));
    }

    fn notes(&self, file: &str) -> Vec<String> {
        let Self { images, missing, other, absent, rounded } = self;
        let missing = missing.said(|count, (trial, view)| {
            format!("`{file}` has no row of {count} of {images} images, that of view `{view}` in trial {trial} for one")
        });
        let other = other.said(|count, (trial, view)| {
            format!(
                "{count} of {images} images are not those that were rendered for `{file}`, that of view `{view}` in trial {trial} for one: render and measure again"
            )
        });
        let absent = absent.said(|count, (trial, view, target)| {
            format!("`{file}` has no row of {count} targets in images that it has, `{target}` of view `{view}` in trial {trial} for one")
        });
        let rounded = rounded.then(|| "grey values were rounded or clipped in the files of the images that were measured".to_owned());
        [missing, other, absent, rounded].into_iter().flatten().collect()
    }
}
