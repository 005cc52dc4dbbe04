//! What operators measure in rendered images of a campaign.

use calibench_measure::{Board as Counted, BoardDetector};
use calibench_model::camera::Camera;
use calibench_model::{Image, PixelPoint, Start, Testfield};
use calibench_random::Key;
use calibench_scenario::ViewsSubject;
use calibench_scenario::studies::transfer::{Board, Measuring};
use calibench_synth::stations::Station;
use rayon::prelude::*;

use super::bent::bent_plate;
use super::{Campaign, Seen};
use crate::RunError;
use crate::measured::{Asked, Pictured, of_its_kinds};
use crate::prepared::{Pointed, Prepared, pointed};

/// Of each target that is pointed at its place, and its image coordinates if it was measured, px.
type Found = Vec<(usize, Option<PixelPoint>)>;

/// Of each station target and image coordinates, px; how many targets were not measured.
pub type Measured = (Vec<Vec<Seen>>, usize);

/// The image coordinates of the field's control and check points.
///
/// # Errors
/// A view that cannot be pictured, an image that the sensor cannot write.
pub fn measured_wall(campaign: &Campaign<'_>, measuring: &Measuring, key: Key<'_>) -> Result<Measured, RunError> {
    let subject = campaign.subject;
    let prepared = Prepared::of(subject, &subject.stations, key)?;
    let images = images(&prepared, &[measuring], None, key)?;
    let is_used = |target: usize| campaign.is_control[target] || campaign.is_check[target];
    let mut missed = 0;
    let mut station = |mut ways: Vec<Found>| -> Vec<Seen> {
        let used = ways.swap_remove(0).into_iter().filter(|(target, _)| is_used(*target));
        used.filter_map(|(target, at)| {
            missed += usize::from(at.is_none());
            Some((target, at?))
        })
        .collect()
    };
    let found = images.into_iter().map(&mut station).collect();
    Ok((found, missed))
}

/// What each method measures in images of the board.
pub struct BoardImages {
    /// The methods that measure, by their places.
    methods: Vec<usize>,
    /// Of each view, of each of them.
    views: Vec<Vec<Found>>,
}

impl BoardImages {
    /// Renders the `board`, bent by a height, its units, as a camera pictures it from `stations`, and measures it.
    ///
    /// # Errors
    /// As of [`measured_wall`].
    pub fn new(
        campaign: &Campaign<'_>,
        (board, camera, bend): (&Board, &Camera, f64),
        stations: &[Station],
        key: Key<'_>,
    ) -> Result<Self, RunError> {
        let flat = &board.field;
        let field = Testfield { plates: vec![bent_plate(flat, bend)], ..flat.clone() };
        let pictured = campaign.board.ok_or(RunError::NothingToRender)?;
        let subject = ViewsSubject { field, camera: *camera, stations: stations.to_vec(), ..pictured.clone() };
        let all = campaign.transfer.methods.iter().enumerate();
        let (methods, ways): (Vec<usize>, Vec<&Measuring>) =
            all.filter_map(|(place, method)| Some((place, method.measured_by.as_ref()?))).unzip();
        // The field where calibrations are applied has views of its own, maybe of the same names.
        let name = format!("{}, board", key.of);
        let key = Key { of: &name, ..key };
        let prepared = Prepared::of(&subject, stations, key)?;
        Ok(Self { methods, views: images(&prepared, &ways, campaign.tools.detector, key)? })
    }

    /// The measured corners of each view, of the method at `place`.
    pub fn of(&self, place: usize) -> Vec<Vec<Seen>> {
        self.ways(place).map(|way| way.iter().filter_map(|&(corner, at)| Some((corner, at?))).collect()).collect()
    }

    /// How many corners the method at `place` did not measure.
    pub fn missed(&self, place: usize) -> usize {
        self.ways(place).flatten().filter(|(_, at)| at.is_none()).count()
    }

    fn ways(&self, place: usize) -> impl Iterator<Item = &Found> {
        let way = self.methods.iter().position(|method| *method == place);
        self.views.iter().filter_map(move |view| view.get(way?))
    }
}

/// Renders every view and measures it in all `ways`: of each view, of each way, each target that is pointed at.
fn images(
    prepared: &Prepared<'_>,
    ways: &[&Measuring],
    detector: Option<&dyn BoardDetector>,
    key: Key<'_>,
) -> Result<Vec<Vec<Found>>, RunError> {
    let view = |view: &crate::prepared::PreparedView<'_>| {
        let image = prepared.image(view, key)?.image;
        let points = pointed(prepared, view, &image, key);
        Ok(ways.iter().map(|way| measured(&prepared.subject.field, way, detector, &image, &points)).collect())
    };
    prepared.views.par_iter().map(view).collect()
}

fn measured(
    field: &Testfield,
    way: &Measuring,
    detector: Option<&dyn BoardDetector>,
    image: &Image,
    points: &[(Pointed, Option<Start>)],
) -> Found {
    let kind = |(point, _): &(Pointed, Option<Start>)| field.targets[point.target].kind;
    let starts: Vec<Option<Start>> = if way.detected {
        let corners = detector.and_then(|detector| detector.detect(image, counted(field)?));
        let named = corners.map_or_else(|| vec![None; points.len()], |corners| named(points, &corners));
        // A detector says where a corner is and nothing of its shape.
        named.into_iter().zip(points).map(|(at, point)| Some(Start { kind: Some(kind(point)), ..Start::at(at?) })).collect()
    } else {
        points.iter().map(|(_, start)| *start).collect()
    };
    let asked: Vec<Asked<'_>> = points.iter().zip(starts).map(|(point, start)| Asked { name: "", kind: kind(point), start }).collect();
    let shown = Pictured { which: None, image, board: None };
    let results = of_its_kinds(&way.operator, shown, &asked).map_or_else(|| vec![None; points.len()], |answers| answers.results);
    points
        .iter()
        .zip(results)
        .map(|((point, _), result)| (point.target, result.and_then(Result::ok).map(|measured| measured.position)))
        .collect()
}

/// The chessboard of a field, counted; `None` where its targets are no full rows.
fn counted(field: &Testfield) -> Option<Counted> {
    let first = field.targets.first()?.at[1];
    let columns = field.targets.iter().filter(|target| target.at[1] == first).count();
    let rows = field.targets.len() / columns;
    (rows * columns == field.targets.len()).then_some(Counted { columns, rows })
}

/// The detected corner of each point. A detector does not say which corner of a symmetric board is the first: that is told by where the corners are, and by
/// nothing finer than half of the least distance between two.
fn named(points: &[(Pointed, Option<Start>)], corners: &[PixelPoint]) -> Vec<Option<PixelPoint>> {
    let between = |i: usize| corners[i + 1..].iter().map(move |other| corners[i].distance(*other));
    let reach = 0.5 * (0..corners.len()).flat_map(between).fold(f64::INFINITY, f64::min);
    // Half way between two it is neither.
    points.iter().map(|(point, _)| point.truth.nearest(corners, reach.next_down())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_named_by_where_they_are() {
        let at = |x| PixelPoint::new(x, 0.0);
        let point = |target, x| (Pointed { target, truth: at(x), start: Start::at(at(x)) }, None);
        let points = [point(0, 10.0), point(1, 20.0), point(2, 30.0), point(3, 16.0)];
        // The other way round, one far off; the last point is half way between two.
        let corners = [PixelPoint::new(36.0, 0.0), PixelPoint::new(21.0, 0.0), PixelPoint::new(11.0, 0.0)];
        assert_eq!(named(&points, &corners), [Some(corners[2]), Some(corners[1]), None, None]);
    }
}
