//! What a method makes of the targets of its kinds.

use calibench_measure::Configured;
use calibench_model::{Image, Measurement, Rejection, Start, TargetKind};

/// What an operator says of a target.
pub type Measured = Result<Measurement, Rejection>;

/// The results of `method` at `targets`, in their order: `None` where it is not to measure, not detected where nobody found the target. `None` of a method that
/// is not there.
///
/// A target is its kind and its start; without a start no operator is asked.
pub fn of_its_kinds(method: &Configured, image: &Image, targets: &[(TargetKind, Option<Start>)]) -> Option<Vec<Option<Measured>>> {
    let operator = method.operator.as_deref().ok()?;
    let mine = |kind: TargetKind| method.measures(Some(kind));
    let starts: Vec<Start> = targets.iter().filter(|(kind, _)| mine(*kind)).filter_map(|(_, start)| *start).collect();
    let mut results = operator.measure_all(image, &starts).into_iter();
    let missed = Err(Rejection::NotDetected);
    let result = |(kind, start): &(TargetKind, Option<Start>)| mine(*kind).then(|| start.and_then(|_| results.next()).unwrap_or(missed));
    Some(targets.iter().map(result).collect())
}
