//! Verdicts after allowing for one more kind of unknown.

use crate::checked::Verdict;
use crate::finding::Finding;

/// The verdicts on gross errors, and on control, lens and shutter, each by itself.
pub(crate) type Verdicts = (Verdict, [Allowed; 3]);

/// The verdict after allowing for one more kind of unknown.
#[derive(Clone, Debug)]
pub(crate) struct Allowed {
    pub(crate) verdict: Verdict,
    /// No image point is in gross error then.
    pub(crate) is_clean: bool,
}

impl Allowed {
    pub(crate) fn untested(why: &str) -> Self {
        Self { verdict: Verdict::Untested(why.into()), is_clean: false }
    }

    pub(crate) fn is_structure(&self) -> bool {
        matches!(self.verdict, Verdict::Doubt(..) | Verdict::Slight(..))
    }

    pub(crate) fn explains(&self) -> f64 {
        match self.verdict {
            Verdict::Doubt(Finding { explains, .. }, _) | Verdict::Slight(Finding { explains, .. }, _) => explains,
            _ => 0.0,
        }
    }
}
