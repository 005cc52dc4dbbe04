//! What measures the images of a campaign.

use std::fmt;
use std::sync::Arc;

use calibench_diagnostics::Problem;
use calibench_measure::{Configured, Registry};
use toml::Spanned;

/// An operator that measures rendered images, and what it starts from.
#[derive(Clone)]
pub struct Measuring {
    /// The operator.
    pub operator: Arc<Configured>,
    /// Whether it starts from what the build's detector of chessboards finds, in place of a hand.
    pub detected: bool,
}

impl fmt::Debug for Measuring {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Measuring").field("operator", &self.operator.label).field("detected", &self.detected).finish()
    }
}

/// The operator that `text` names.
pub fn read(text: &Spanned<String>, detected: bool, registry: &Registry, problems: &mut Vec<Problem>) -> Option<Measuring> {
    match registry.parse(text.get_ref()) {
        Ok(operator) if operator.recorded().is_some() => {
            let message = format!("`{}` is a file of positions, which calibrations do not start from", operator.label);
            problems.push(Problem::new(text.span(), message).help("expected a method that measures"));
            None
        }
        Ok(operator) if operator.board_finder().is_some() => {
            let message = format!("`{}` finds boards in whole images, and here points are measured", operator.label);
            problems.push(Problem::new(text.span(), message).help("expected a method that measures a point from a start"));
            None
        }
        Ok(operator) => Some(Measuring { operator: Arc::new(operator), detected }),
        Err(error) => {
            problems.push(Problem::new(text.span(), error.to_string()));
            None
        }
    }
}
