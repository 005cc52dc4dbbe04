//! Recognition of rendered images of fields that the table of contours was not learned on.

#[path = "../campaign/mod.rs"]
mod campaign;
mod lines;
mod others;
mod partial;
mod rates;
mod refused;

use calibench_model::Testfield;
use calibench_recognise::{Classifier, NotRecognised, Recogniser, Recognition};

const BOTH: [Classifier; 2] = [Classifier::Modern, Classifier::Contours];

fn recogniser(field: &Testfield, classifier: Classifier) -> Recogniser {
    Recogniser::new(field, classifier).expect("a coded field")
}

/// The reason's name, or how many targets were labelled.
fn told(found: &Result<Recognition, NotRecognised>) -> String {
    match found {
        Ok(found) => format!("{} targets", found.targets.len()),
        Err(error) => error.name().to_owned(),
    }
}
