//! The records of a judgement, and the figures and the verdict that are made of them.

pub mod measure;
mod outlier;
mod rows;
mod summary;

pub use outlier::{ALPHA as OUTLIER_ALPHA, outliers};
pub use rows::{JUDGEMENT, RECORDED_JUDGEMENT, Row, read_rows, write_rows};
pub use summary::{
    ALPHA, Beside, BoardShare, Cell, Estimate, FreedCorners, HONEST, InUse, MARGIN_PX, Measured, OtherCorners, Point, Predicted, Principal,
    Published, Split, Standing, StillHolds, Summary, Trusted, View,
};

/// An operator that measured a smaller share (0 to 1) of the corners does not decide on which corners the others are compared.
pub const COMPARABLE: f64 = 0.8;
