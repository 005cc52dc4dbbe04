//! What a method makes of the targets of its kinds.

use calibench_measure::{Configured, ImageId};
use calibench_model::{Image, Measurement, Rejection, Start, TargetKind};

/// What an operator says of a target.
pub type Measured = Result<Measurement, Rejection>;

/// A target that a method may be asked for.
#[derive(Clone, Copy)]
pub struct Asked<'a> {
    /// Its name, by which only recorded methods go.
    pub name: &'a str,
    /// Its kind.
    pub kind: TargetKind,
    /// Where measuring starts; `None` where nobody found the target.
    pub start: Option<Start>,
}

/// The results of `method` at `targets`, in their order: `None` where it is not to measure, not detected where nobody found the target. `None` of a method that
/// is not there.
///
/// Where nobody found the target no operator is asked. `which` is the image among those of the run; a recorded method has nothing of others.
pub fn of_its_kinds(
    method: &Configured,
    (which, image): (Option<ImageId<'_>>, &Image),
    targets: &[Asked<'_>],
) -> Option<Vec<Option<Measured>>> {
    let operator = method.operator.as_deref().ok()?;
    let mine = |target: &Asked<'_>| method.measures(Some(target.kind));
    let asked: Vec<(&str, Start)> =
        targets.iter().filter(|target| mine(target)).filter_map(|target| Some((target.name, target.start?))).collect();
    let mut results = match (operator.recorded(), which) {
        (Some(recorded), Some(which)) => recorded.recall(which, image, &asked.iter().map(|(name, _)| *name).collect::<Vec<_>>()),
        _ => operator.measure_all(image, &asked.iter().map(|(_, start)| *start).collect::<Vec<_>>()),
    }
    .into_iter();
    let missed = Err(Rejection::NotDetected);
    let result = |target: &Asked<'_>| mine(target).then(|| target.start.and_then(|_| results.next()).unwrap_or(missed));
    Some(targets.iter().map(result).collect())
}

#[cfg(test)]
mod tests {
    use TargetKind::{Corner, Disc};
    use calibench_measure::Registry;
    use calibench_model::PixelPoint;

    use super::*;

    /// `pixel` says where it was asked, so that each answer tells whose it is.
    #[test]
    fn answers_go_to_those_who_were_asked_for() {
        let image = Image::from_fn(40, 30, |_, _| 0.5);
        let start = |x| Some(Start::at(PixelPoint::new(x, 9.0)));
        let targets = [(Corner, None), (Corner, start(5.0)), (Disc, start(11.0)), (Corner, None), (Disc, None), (Corner, start(21.0))];
        let said = |method: &str| {
            let method = Registry::builtin().parse(method).unwrap();
            let position = |one: Option<Measured>| one.map(|one| one.map(|found| found.position.x));
            let targets = targets.map(|(kind, start)| Asked { name: "", kind, start });
            of_its_kinds(&method, (None, &image), &targets).unwrap().into_iter().map(position).collect::<Vec<_>>()
        };
        let (missed, at) = (Some(Err(Rejection::NotDetected)), |x: f64| Some(Ok(x)));
        assert_eq!(said("pixel"), [missed, at(5.0), at(11.0), missed, missed, at(21.0)]);
        assert_eq!(said("corner=pixel"), [missed, at(5.0), None, missed, None, at(21.0)]);
        assert_eq!(said("disc=pixel"), [None, None, at(11.0), None, missed, None]);
    }
}
