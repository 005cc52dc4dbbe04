//! What the reports of single papers have beside their tables and scenarios.

use crate::canvas::Pictures;
use crate::load::{LoadError, Loaded};
use crate::sweep::LoadedSweep;
use crate::zhu;

/// Makes sections of a paper's own from the scenarios of its family, without a sweep and with one.
type Own = fn(&[&Loaded], &[&LoadedSweep]) -> Result<(String, Pictures), LoadError>;

/// The families that have such.
const OWN: [(&str, Own); 1] = [(zhu::FAMILY, zhu::section)];

/// The sections and pictures that `family` has of its own: of most none.
///
/// # Errors
/// Records that cannot be read.
pub fn section(family: &str, plain: &[&Loaded], swept: &[&LoadedSweep]) -> Result<(String, Pictures), LoadError> {
    match OWN.iter().find(|(of, _)| *of == family) {
        Some((_, own)) => own(plain, swept),
        None => Ok((String::new(), Pictures::new())),
    }
}
