//! A file of positions among the operators.

use std::sync::{Arc, Mutex, PoisonError};

use calibench_measure::{ImageId, Known, Operator, Recorded, RunId};
use calibench_model::{Image, Measurement, Rejection, Start, Told, told};

use super::positions::Positions;
use crate::declaration::Grey;
use crate::request::rounds;

type Measured = Result<Measurement, Rejection>;

/// A file of positions, and what is told of how it fits a run.
pub struct Recalled {
    positions: Arc<Positions>,
    told: Mutex<told::Recalled>,
}

impl Recalled {
    pub fn new(positions: Arc<Positions>) -> Self {
        let told = Mutex::new(told::Recalled { file: positions.file.clone(), ..told::Recalled::default() });
        Self { positions, told }
    }

    /// What the file says, or why it says nothing of the image.
    fn found(&self, which: ImageId<'_>, image: &Image, targets: &[&str], told: &mut told::Recalled) -> Result<Vec<Measured>, Rejection> {
        let place = || (which.trial, which.view.to_owned());
        let missing = |told: &mut told::Recalled| {
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
        let mut told = told::Recalled::default();
        let results = self.found(which, image, targets, &mut told).unwrap_or_else(|why| vec![Err(why); targets.len()]);
        if told.missing.is_empty() {
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

    fn told(&self) -> Told {
        Told::recalled(self.told.lock().unwrap_or_else(PoisonError::into_inner).clone())
    }
}
