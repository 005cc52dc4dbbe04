//! Why a rig is in doubt, as a noun.

/// What of a rig is in doubt.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RigSubject {
    /// The cameras are not one rig.
    OneRig,
    /// How well a camera is known over its frame.
    OverFrame,
    /// How well it is known where a camera sits.
    Mount,
    /// Errors that belong together in a set.
    Together,
    /// The camera files that the cameras started from.
    Files,
    /// Image points in gross error.
    GrossErrors,
}

impl RigSubject {
    /// The name for programs.
    pub const fn name(self) -> &'static str {
        match self {
            Self::OneRig => "one-rig",
            Self::OverFrame => "over-frame",
            Self::Mount => "mount",
            Self::Together => "together",
            Self::Files => "files",
            Self::GrossErrors => "gross-errors",
        }
    }
}

/// Why a rig is in doubt. With any the exit code is 3.
#[derive(Clone, Debug, PartialEq)]
pub struct RigDoubt {
    /// What is in doubt.
    pub subject: RigSubject,
    /// The camera that it is about; `None` where it is about all.
    pub camera: Option<usize>,
    /// The most likely cause, and what to do.
    pub words: String,
}
