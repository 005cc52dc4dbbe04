//! A calibration system as a method.

use crate::{Answer, Task};

/// An answer with what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibrated {
    /// What was answered.
    pub answer: Answer,
    /// Processor's time from the question to the answer, s.
    pub seconds: f64,
    /// The most memory that its process has had in use so far, MB; `None` where that is not known, or where it has none of its own.
    pub peak_mb: Option<f64>,
}

/// A version of a system in one configuration.
pub trait Calibrator: Send + Sync {
    /// The version of its system.
    ///
    /// # Errors
    /// Why it cannot run here, in words.
    fn version(&self) -> Result<String, String>;

    /// Calibrates. Whatever goes wrong there is an answer: [`crate::Status::Failed`] with the reason.
    ///
    /// # Errors
    /// Why it cannot run here, in words.
    fn calibrate(&self, task: &Task) -> Result<Calibrated, String>;
}

/// A calibrator with what is known of it.
pub struct Listed {
    /// Its name in scenarios and pages.
    pub name: String,
    /// Its system.
    pub system: String,
    /// What is special about this configuration.
    pub about: String,
    /// Where it is published.
    pub source: String,
    /// What beside its version its answers depend on: how it is started, a hash of its files.
    pub identity: String,
    /// The camera models that it can be asked for.
    pub models: Vec<String>,
    /// Whether it is given a start.
    pub start: bool,
    /// Itself.
    pub calibrator: Box<dyn Calibrator>,
}

impl Listed {
    /// That it does not have a model, in words.
    pub fn lacks(&self, model: &str) -> String {
        format!("it has no model `{model}`: it has {}", self.models.join(", "))
    }

    /// Calibrates, where it has the model and can run.
    ///
    /// # Errors
    /// Why it cannot, in words.
    pub fn calibrate(&self, task: &Task) -> Result<Calibrated, String> {
        if !self.models.contains(&task.model) {
            return Err(self.lacks(&task.model));
        }
        if self.start || task.start.is_none() {
            return self.calibrator.calibrate(task);
        }
        self.calibrator.calibrate(&Task { start: None, ..task.clone() })
    }
}
