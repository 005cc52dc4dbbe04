//! `[scale]`: how many pixels an object unit has, along the line between two targets.

/// A checked `[scale]` table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scale {
    /// The two targets, by their places in the field.
    pub between: [usize; 2],
}
