//! The camera models that are compared.

use calibench_diagnostics::nearest;
use calibench_model::camera::ImageSize;
use thiserror::Error;

use crate::{BoardShape, CalibrationError, GrossErrors, Optics, Settings, parameters};

/// Photographs from which a camera is calibrated by themselves, at least: a half of those that judge has as many.
pub const HALF: usize = 3;
/// Pixel pitch of models in mm where none is known, um. No figure in px depends on it.
pub const NOMINAL_PITCH: f64 = 10.0;
/// What follows a model that is calibrated on a board that may be bent.
const BENT: &str = "+bent";

/// A camera model, and which of its parameters are solved for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModelChoice {
    /// As it was written: its name in records.
    pub label: String,
    name: String,
    solve: Option<Vec<String>>,
    shape: BoardShape,
}

/// A model that cannot be compared.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ModelError {
    /// No model of this name.
    #[error(transparent)]
    Unknown(#[from] CalibrationError),
    /// A parameter that the model does not have.
    #[error("{model} has no parameter {name}; expected some of {known}, as in {model}:{known}{}", near.as_ref().map_or(String::new(), |near| format!("; did you mean `{near}`?")))]
    Parameter {
        /// The model.
        model: String,
        /// What was asked for.
        name: String,
        /// The names that there are.
        known: String,
        /// The nearest.
        near: Option<String>,
    },
    /// One model twice.
    #[error("the model {0} is asked for twice; expected each once")]
    Twice(String),
}

impl ModelChoice {
    /// A model by name, with the parameters that it usually needs; or `NAME:PARAMETER,...` with those that are named, the others at rest. With `+bent` after it
    /// the bend of the board is solved for too ([`BoardShape::Bent`]).
    ///
    /// # Errors
    /// A model or parameter that is not known.
    pub fn parse(text: &str) -> Result<Self, ModelError> {
        let (lens, shape) = text.strip_suffix(BENT).map_or((text, BoardShape::Flat), |lens| (lens, BoardShape::Bent));
        let (name, solve) = match lens.split_once(':') {
            Some((name, list)) => (name, Some(list.split(',').map(|name| name.trim().to_owned()).collect::<Vec<_>>())),
            None => (lens, None),
        };
        let choice = Self { label: text.to_owned(), name: name.to_owned(), solve, shape };
        let size = ImageSize { width: 640, height: 480 };
        let known = parameters(&Optics { solve: None, ..choice.optics(size, None) })?;
        match choice.solve.iter().flatten().find(|name| !known.contains(&name.as_str())) {
            None => Ok(choice),
            Some(other) => Err(ModelError::Parameter {
                model: name.to_owned(),
                name: other.clone(),
                known: known.join(","),
                near: nearest(other, known.iter().copied()).map(str::to_owned),
            }),
        }
    }

    /// Several, each once.
    ///
    /// # Errors
    /// As [`Self::parse`], with the place of the one that is wrong; [`ModelError::Twice`].
    pub fn parse_all(texts: &[String]) -> Result<Vec<Self>, (usize, ModelError)> {
        let mut found: Vec<Self> = Vec::new();
        for (place, text) in texts.iter().enumerate() {
            let choice = Self::parse(text).map_err(|error| (place, error))?;
            if found.contains(&choice) {
                return Err((place, ModelError::Twice(choice.label)));
            }
            found.push(choice);
        }
        Ok(found)
    }

    /// How it is calibrated where others are compared with it: from all points, whatever they are.
    pub fn settings(&self, size: ImageSize, pitch_um: Option<f64>) -> Settings {
        Settings { shape: self.shape, gross: GrossErrors::Kept, ..Settings::new(vec![self.optics(size, pitch_um)]) }
    }

    fn optics(&self, size: ImageSize, pitch_um: Option<f64>) -> Optics {
        let pitch_um = Some(pitch_um.unwrap_or(NOMINAL_PITCH));
        Optics { pitch_um, model: Some(self.name.clone()), solve: self.solve.clone(), ..Optics::new(size) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_are_known_by_name_and_parameters() {
        for good in [
            "opencv5",
            "opencv4:fx,fy,cx,cy",
            "photogrammetric:c,x0,y0,k1",
            "metashape",
            "photogrammetric",
            "opencv5+bent",
            "opencv4:fx,fy,cx,cy+bent",
        ] {
            assert_eq!(ModelChoice::parse(good).unwrap().label, good);
        }
        let shape = |text: &str| ModelChoice::parse(text).unwrap().settings(ImageSize { width: 640, height: 480 }, None).shape;
        assert_eq!(["opencv5", "opencv5+bent"].map(shape), [BoardShape::Flat, BoardShape::Bent]);
        let message = |text: &str| ModelChoice::parse(text).unwrap_err().to_string();
        assert!(message("opncv5").contains("did you mean `opencv5`?"), "{}", message("opncv5"));
        assert!(message("opencv5:fx,k9").contains("no parameter k9; expected some of fx,fy,"), "{}", message("opencv5:fx,k9"));
        let twice = ["opencv4".to_owned(), "opencv4".to_owned()];
        assert_eq!(ModelChoice::parse_all(&twice).unwrap_err().0, 1);
    }
}
