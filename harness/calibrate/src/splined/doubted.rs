//! Why splines are in doubt, as a noun.

/// What of splines is in doubt.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SplinedSubject {
    /// How well the camera is known over its frame.
    OverFrame,
    /// The lens folds inside the frame.
    Fold,
    /// Image points lie beyond the grid.
    Grid,
    /// Image points in gross error.
    GrossErrors,
}

impl SplinedSubject {
    /// The name for programs.
    pub const fn name(self) -> &'static str {
        match self {
            Self::OverFrame => "over-frame",
            Self::Fold => "fold",
            Self::Grid => "grid",
            Self::GrossErrors => "gross-errors",
        }
    }
}

/// Why splines are in doubt. With any the exit code is 3.
#[derive(Clone, Debug, PartialEq)]
pub struct SplinedDoubt {
    /// What is in doubt.
    pub subject: SplinedSubject,
    /// The most likely cause, and what to do.
    pub words: String,
}
