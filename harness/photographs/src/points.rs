//! Points of a file, measured in the photographs that they name.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use calibench_exchange::Outcome;
use calibench_measure::{Configured, Operator};
use calibench_model::views::photo_of;
use calibench_model::{Covariance, Image, Measurement, PixelPoint, Points, Rejection, Start, stop};
use rayon::prelude::*;

use crate::names::{ambiguous, names, once};
use crate::{PhotographsError, Reader};

/// Points that are handed to a method at a time: bounds the memory, whatever the number of points.
const CHUNK: usize = 1 << 16;
/// Points that a thread takes at a time.
const SHARE: usize = 128;

/// The results of several methods at the same points: 41 bytes a point and method.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    points: usize,
    methods: Vec<OfMethod>,
}

/// Of one method, by point.
#[derive(Clone, Debug, PartialEq)]
struct OfMethod {
    state: Vec<State>,
    position: Vec<PixelPoint>,
    /// sxx, sxy, syy; not numbers where there is none.
    covariance: Vec<[f64; 3]>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    /// Its photograph was not given.
    NotGiven,
    /// The method is limited to other kinds of targets.
    OtherKind,
    Measured,
    Rejected(Rejection),
}

impl Measured {
    fn new(points: usize, methods: usize) -> Self {
        let nothing = PixelPoint::new(f64::NAN, f64::NAN);
        let of_method =
            || OfMethod { state: vec![State::NotGiven; points], position: vec![nothing; points], covariance: vec![[f64::NAN; 3]; points] };
        Self { points, methods: (0..methods).map(|_| of_method()).collect() }
    }

    fn set(&mut self, method: usize, point: usize, result: Result<Measurement, Rejection>) {
        let of = &mut self.methods[method];
        match result {
            Ok(found) => {
                (of.state[point], of.position[point]) = (State::Measured, found.position);
                of.covariance[point] = found.covariance.map_or([f64::NAN; 3], |s| [s.sxx, s.sxy, s.syy]);
            }
            Err(why) => of.state[point] = State::Rejected(why),
        }
    }

    /// The result of a method at a point, counted among those that are available; `None` if its photograph was not given, or if the method is limited to
    /// other kinds of targets.
    pub fn outcome(&self, method: usize, point: usize) -> Option<Outcome> {
        let of = self.methods.get(method)?;
        match of.state[point] {
            State::NotGiven | State::OtherKind => None,
            State::Rejected(why) => Some(Outcome::Rejected(why)),
            State::Measured => {
                let [sxx, sxy, syy] = of.covariance[point];
                let covariance = (!sxx.is_nan()).then_some(Covariance { sxx, sxy, syy });
                Some(Outcome::Measured(Measurement { position: of.position[point], covariance }))
            }
        }
    }

    /// How many points were measured, by all methods together.
    pub fn measured(&self) -> usize {
        self.count(|state| state == State::Measured)
    }

    /// How many were rejected, by all methods together.
    pub fn rejected(&self) -> usize {
        self.count(|state| matches!(state, State::Rejected(_)))
    }

    /// Points of photographs that were not given.
    pub fn not_given(&self) -> usize {
        self.methods.first().map_or(self.points, |of| of.state.iter().filter(|state| **state == State::NotGiven).count())
    }

    fn count(&self, wanted: impl Fn(State) -> bool) -> usize {
        self.methods.iter().flat_map(|of| &of.state).filter(|state| wanted(**state)).count()
    }
}

/// Measures every point in its photograph with every available method that is not limited to other kinds of targets.
///
/// `points` name their images by file name, with folders where two photographs share one. One photograph a thread is in memory; `step` is called after each, on
/// any thread. Photographs are shared out among the threads, and so are the points of each: the results are the same on any number of threads.
///
/// # Errors
/// As [`photos_of`]; a photograph that cannot be read.
pub fn measure_points(
    points: &Points,
    reader: &Reader,
    methods: &[Configured],
    step: &(dyn Fn() + Sync),
) -> Result<Measured, PhotographsError> {
    let photos = reader.photos();
    let photo_of = photos_of(points, photos)?;
    let mut images: Vec<Vec<usize>> = vec![Vec::new(); photos.len()];
    photo_of.iter().enumerate().for_each(|(image, photo)| photo.iter().for_each(|&photo| images[photo].push(image)));
    let groups = points.by_image();
    let available: Vec<_> = methods.iter().filter_map(|method| Some((method, method.operator.as_ref().ok()?))).collect();
    let found = Mutex::new(Measured::new(points.len(), available.len()));
    let one = |(path, images): (&PathBuf, &Vec<usize>)| -> Result<(), PhotographsError> {
        // Read even if no point asks for it: a photograph that cannot be read is a mistake.
        let photo = reader.read(path)?;
        let wanted: Vec<usize> = images.iter().flat_map(|&image| groups.of_group(image)).collect();
        for chunk in wanted.chunks(CHUNK) {
            for (index, (method, operator)) in available.iter().enumerate() {
                let mine = |point: &usize| method.measures(points.start(*point).kind);
                let (own, others): (Vec<usize>, Vec<usize>) = chunk.iter().copied().partition(mine);
                let starts: Vec<Start> = own.iter().map(|&point| points.start(point)).collect();
                let results = shared_out(operator.as_ref(), &photo, &starts);
                let mut found = found.lock().unwrap_or_else(PoisonError::into_inner);
                own.iter().zip(results).for_each(|(&point, result)| found.set(index, point, result));
                others.iter().for_each(|&point| found.methods[index].state[point] = State::OtherKind);
            }
        }
        step();
        Ok(())
    };
    // In batches: a thread that waits for the shares of its photograph would begin with another one, and then with a third.
    let batch = rayon::current_num_threads();
    for (photos, images) in photos.chunks(batch).zip(images.chunks(batch)) {
        photos.par_iter().zip(images).map(one).collect::<Result<(), PhotographsError>>()?;
    }
    Ok(found.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// Whether [`shared_out`] has no work for more than one thread.
pub fn is_one_share(operator: &dyn Operator, starts: &[Start]) -> bool {
    operator.is_local() && starts.len() <= SHARE
}

/// The results at `starts`, in their order. The points of an image are shared out among the threads: the results are the same on any number of them.
pub fn shared_out(operator: &dyn Operator, image: &Image, starts: &[Start]) -> Vec<Result<Measurement, Rejection>> {
    if !operator.is_local() {
        return operator.measure_all(image, starts);
    }
    let measured = |share| {
        stop::point();
        operator.measure_all(image, share)
    };
    let shares: Vec<_> = starts.par_chunks(SHARE).map(measured).collect();
    shares.concat()
}

/// The photograph of each image that points name, as its place among `photos`; `None` for one that is not among them.
///
/// Photographs are called as [`names`] says; a point file may give one its folders, though its name alone would do.
///
/// # Errors
/// A photograph that is given twice, or that points do not name clearly; photographs of which points name none.
pub fn photos_of(points: &Points, photos: &[PathBuf]) -> Result<Vec<Option<usize>>, PhotographsError> {
    once(photos)?;
    let called = names(photos);
    if let Some((name, both)) = ambiguous(photos, points.images().iter()) {
        return Err(PhotographsError::Ambiguous { name: name.to_owned(), paths: both.map(Path::to_owned) });
    }
    let by_name: HashMap<&str, usize> = called.iter().enumerate().map(|(photo, name)| (name.as_str(), photo)).collect();
    let by_path: HashMap<&Path, usize> = photos.iter().enumerate().map(|(photo, path)| (path.as_path(), photo)).collect();
    let whole = |image: &str| by_name.get(image).or_else(|| by_path.get(Path::new(image))).copied();
    // One of several boards in a photograph.
    let of = |image: &str| whole(image).or_else(|| whole(photo_of(image)?));
    let found: Vec<Option<usize>> = points.images().iter().map(of).collect();
    match (points.images().iter().next(), called.first()) {
        (Some(named), Some(called)) if found.iter().all(Option::is_none) => {
            Err(PhotographsError::NoneNamed { named: named.to_owned(), called: called.clone() })
        }
        _ => Ok(found),
    }
}

#[cfg(test)]
mod tests {
    use calibench_images::write_png;
    use calibench_measure::Registry;
    use calibench_model::TargetKind;

    use super::*;
    use crate::Asked;

    fn points(images: &[&str]) -> Points {
        let mut points = Points::default();
        images.iter().enumerate().for_each(|(i, image)| points.push(image, &i.to_string(), Start::at(PixelPoint::new(1.0, 1.0))));
        points
    }

    #[test]
    fn images_are_found_by_name_or_by_path() {
        let photos = ["x/a.png", "x/b.png"].map(PathBuf::from);
        assert_eq!(photos_of(&points(&["b.png", "c.png", "x/a.png"]), &photos).unwrap(), [Some(1), None, Some(0)]);
        let error = |images: &[&str], photos: &[PathBuf]| photos_of(&points(images), photos).unwrap_err().to_string();
        assert!(error(&["c.png", "d.png"], &photos).ends_with("points name `c.png`, the photographs are called `a.png`"));
        let alike = ["x/a.png", "y/a.png"].map(PathBuf::from);
        assert!(error(&["a.png"], &alike).starts_with("two photographs are called a.png"));
        assert_eq!(photos_of(&points(&["y/a.png"]), &alike).unwrap(), [Some(1)]);
        // Views of several boards in a photograph.
        let views = ["a.png#1", "x/b.png#2", "a.png#12", "a.png#x", "c.png#1"];
        assert_eq!(photos_of(&points(&views), &photos).unwrap(), [Some(0), Some(1), Some(0), None, None]);
        assert!(error(&["a.png#1"], &alike).starts_with("two photographs are called a.png"));
        let odd = ["x/a#1.png", "x/a#1.png#2"].map(PathBuf::from);
        assert_eq!(photos_of(&points(&["a#1.png", "a#1.png#2", "a#1.png#3"]), &odd).unwrap(), [Some(0), Some(1), Some(0)]);
    }

    /// Squares of 14 px whose grey values no two corners share, and a start half a pixel beside each corner: row by row.
    fn board(columns: usize, rows: usize) -> (Image<'static>, Vec<Start>) {
        let (width, height) = (14 * (columns + 1), 14 * (rows + 1));
        let sharp =
            |x: usize, y: usize| if (x / 14 + y / 14).is_multiple_of(2) { 0.2 } else { 0.7 + 0.0001 * (x * 7 + y * 3) as f32 / 9.0 };
        // Means of nine pixels: edges without any blur are no photograph's.
        let near = |place: usize| place.saturating_sub(1)..place + 2;
        let grey = |x: usize, y: usize| {
            let around: Vec<f32> = near(y).flat_map(|y| near(x).map(move |x| sharp(x, y))).collect();
            around.iter().sum::<f32>() / around.len() as f32
        };
        let corner = |i: usize| PixelPoint::new(14.0 * (i % columns + 1) as f64 - 0.2, 14.0 * (i / columns + 1) as f64 - 0.9);
        let start = |i| Start { kind: Some(TargetKind::ChessCorner), ..Start::at(corner(i)) };
        (Image::from_fn(width, height, grey), (0..columns * rows).map(start).collect())
    }

    #[test]
    fn results_are_those_of_each_photograph_alone_on_any_number_of_threads() {
        let folder = tempfile::tempdir().unwrap();
        let (names, mut points) = (["a.png", "b.png", "c.png"], Points::default());
        let photos = names.map(|name| folder.path().join(name));
        // More than one share, and one that is not full.
        let boards = [(23, 12), (5, 4), (13, 10)].map(|(columns, rows)| board(columns, rows));
        for ((image, starts), (name, path)) in boards.iter().zip(names.iter().zip(&photos)) {
            write_png(path, image, true).unwrap();
            starts.iter().enumerate().for_each(|(i, start)| points.push(name, &i.to_string(), *start));
        }
        let methods = ["forstner:window=7", "parametric_corner:window=7", "lsm:window=7", "chess_corners", "disc=centroid"]
            .map(|method| Registry::builtin().parse(method).unwrap());
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| measure_points(&points, &Reader::of(&photos, Asked::default()).unwrap(), &methods, &|| ())).unwrap()
        };
        let found = on(1);
        for (m, method) in methods.iter().take(4).enumerate() {
            let mut point = 0;
            for (path, (_, starts)) in photos.iter().zip(&boards) {
                let alone = method.operator.as_ref().unwrap().measure_all(&calibench_images::read_photo(path).unwrap().image, starts);
                assert!(alone.iter().filter(|result| result.is_ok()).count() * 2 > starts.len(), "{}", method.label);
                for result in alone {
                    let outcome = result.map_or_else(Outcome::Rejected, Outcome::Measured);
                    assert_eq!(found.outcome(m, point), Some(outcome), "{}, point {point}", method.label);
                    point += 1;
                }
            }
        }
        assert_eq!((found.outcome(4, 3), found.not_given()), (None, 0));
        // Not a number is not itself: as text.
        [2, 3, 5].iter().for_each(|&threads| assert!(format!("{:?}", on(threads)) == format!("{found:?}"), "{threads} threads"));
    }
}
