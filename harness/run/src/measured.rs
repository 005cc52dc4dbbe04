//! What a method makes of the targets of its kinds.

use std::collections::HashMap;

use calibench_measure::finder::{Named, find_named};
use calibench_measure::{BoardFinder, Configured, ImageId, Sought};
use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start, TargetKind};

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

/// An image of a run: which it is, if any, and the board that is in it, if one is.
#[derive(Clone, Copy)]
pub struct Pictured<'a> {
    /// Which of the run; a recorded method has nothing of others.
    pub which: Option<ImageId<'a>>,
    /// Its grey values.
    pub image: &'a Image<'a>,
    /// The board that is pictured.
    pub board: Option<&'a Sought>,
}

/// What a method says of the targets of an image.
#[derive(Debug, Default)]
pub struct Answers<'a> {
    /// By target, in their order: `None` where it is not to measure, not detected where nobody found the target.
    pub results: Vec<Option<Measured>>,
    /// All points of the board that a finder of boards says to see, by name, or why there are none; `None` of operators.
    pub found: Option<Result<Named<'a>, Rejection>>,
}

/// What `method` says of `targets`. `None` of a method that is not there.
///
/// Where nobody found the target no operator is asked. What finds boards itself says nothing of boards that it does not know.
pub fn of_its_kinds<'a>(method: &Configured, shown: Pictured<'a>, targets: &[Asked<'a>]) -> Option<Answers<'a>> {
    let operator = method.operator.as_deref().ok()?;
    let mine = |target: &Asked<'_>| method.measures(Some(target.kind));
    if let Some(finder) = operator.board_finder() {
        return Some(of_board(finder, shown, targets, &mine));
    }
    let asked: Vec<(&str, Start)> =
        targets.iter().filter(|target| mine(target)).filter_map(|target| Some((target.name, target.start?))).collect();
    let Pictured { which, image, .. } = shown;
    let mut results = match (operator.recorded(), which) {
        (Some(recorded), Some(which)) => recorded.recall(which, image, &asked.iter().map(|(name, _)| *name).collect::<Vec<_>>()),
        _ => operator.measure_all(image, &asked.iter().map(|(_, start)| *start).collect::<Vec<_>>()),
    }
    .into_iter();
    let missed = Err(Rejection::NotDetected);
    let result = |target: &Asked<'_>| mine(target).then(|| target.start.and_then(|_| results.next()).unwrap_or(missed));
    Some(Answers { results: targets.iter().map(result).collect(), found: None })
}

/// What a finder of boards says: of every target, whether a hand pointed at it or not.
fn of_board<'a>(
    finder: &dyn BoardFinder,
    Pictured { image, board, .. }: Pictured<'a>,
    targets: &[Asked<'a>],
    mine: &dyn Fn(&Asked<'_>) -> bool,
) -> Answers<'a> {
    let Some(sought) = board.filter(|sought| finder.unfit(&sought.board).is_none()) else {
        return Answers { results: vec![None; targets.len()], found: None };
    };
    let expected: Vec<(&str, PixelPoint)> = targets.iter().filter_map(|target| Some((target.name, target.start?.position))).collect();
    let found = find_named(finder, (image, sought), &expected);
    let places: HashMap<&str, PixelPoint> = found.iter().flatten().copied().collect();
    let missed = found.as_ref().err().copied().unwrap_or(Rejection::NotDetected);
    let result = |target: &Asked<'_>| places.get(target.name).map(|&position| Measurement { position, covariance: None }).ok_or(missed);
    Answers { results: targets.iter().map(|target| mine(target).then(|| result(target))).collect(), found: Some(found) }
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
            let shown = Pictured { which: None, image: &image, board: None };
            of_its_kinds(&method, shown, &targets).unwrap().results.into_iter().map(position).collect::<Vec<_>>()
        };
        let (missed, at) = (Some(Err(Rejection::NotDetected)), |x: f64| Some(Ok(x)));
        assert_eq!(said("pixel"), [missed, at(5.0), at(11.0), missed, missed, at(21.0)]);
        assert_eq!(said("corner=pixel"), [missed, at(5.0), None, missed, None, at(21.0)]);
        assert_eq!(said("disc=pixel"), [None, None, at(11.0), None, missed, None]);
    }
}
