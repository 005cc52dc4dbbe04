//! What was looked for in the residuals, and what was found.

use crate::{Doubt, Finding, Subject};

/// Times the standard deviation of the camera over the frame (RMS, after the best rotation) by which a structure must move it to count.
pub const SHARE: f64 = 3.0;

/// What was looked for, and with what result.
#[derive(Clone, Debug, PartialEq)]
pub struct Checked {
    /// What was looked at.
    pub subject: Subject,
    /// The result.
    pub verdict: Verdict,
}

/// What a check found.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// It could not be made, in words.
    Untested(String),
    /// No structure.
    Sound(Finding),
    /// A structure that moves the camera too little to matter, and its most likely cause in words.
    Slight(Finding, String),
    /// A structure that moves the camera, and its most likely cause in words.
    Doubt(Finding, String),
}

impl Verdict {
    /// Whether it is a doubt.
    pub(crate) fn is_doubt(&self) -> bool {
        matches!(self, Self::Doubt(..))
    }

    /// Whatever was found is no structure.
    pub(crate) fn sound(self) -> Self {
        match self {
            Self::Doubt(finding, _) | Self::Slight(finding, _) => Self::Sound(finding),
            other => other,
        }
    }

    /// Whatever was found counts.
    pub(crate) fn doubted(self) -> Self {
        match self {
            Self::Slight(finding, cause) => Self::Doubt(finding, cause),
            other => other,
        }
    }
}

impl Finding {
    /// Whether a structure that is no chance moves the camera.
    pub(crate) fn weighed(self, cause: String) -> Verdict {
        if self.moves.is_none_or(|moves| moves > SHARE) { Verdict::Doubt(self, cause) } else { Verdict::Slight(self, cause) }
    }
}

impl Checked {
    /// What was not looked for, and why; `None` where it was.
    pub fn untested(&self) -> Option<String> {
        match &self.verdict {
            Verdict::Untested(why) => Some(format!("{}: {why}", self.subject.what())),
            _ => None,
        }
    }

    /// The doubt, with its most likely cause.
    pub fn doubt(&self) -> Option<Doubt> {
        match &self.verdict {
            Verdict::Doubt(finding, cause) => Some(Doubt { finding: Some(*finding), ..Doubt::of_all(self.subject, cause.clone()) }),
            _ => None,
        }
    }
}
