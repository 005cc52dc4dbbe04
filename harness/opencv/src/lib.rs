//! OpenCV's methods: the operators of `calibench-measure` with OpenCV's beside them.

pub mod subpix;

use calibench_measure::Registry;

/// Every method of this build: ours and OpenCV's.
pub fn registry() -> Registry {
    Registry::builtin().with(subpix::method())
}
