//! What every operator does.

use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start, Told, Unknowns, stop};

use crate::finder::BoardFinder;
use crate::recorded::Recorded;

/// A way of measuring points in an image, with its parameters set.
pub trait Operator: Send + Sync {
    /// Measures one point, starting at `start`.
    ///
    /// # Errors
    /// A [`Rejection`] that says why the point was missed. Operators never panic on grey values, whatever these are.
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection>;

    /// Measures many points of one image, in the order given.
    fn measure_all(&self, image: &Image, starts: &[Start]) -> Vec<Result<Measurement, Rejection>> {
        let one = |start| {
            stop::point();
            self.measure(image, start)
        };
        starts.iter().map(one).collect()
    }

    /// Whether each point is measured from its own surroundings, whatever others are measured with it: points of one image may then be shared out among
    /// threads. False of detectors of whole images, which would search the image again for every share.
    fn is_local(&self) -> bool {
        true
    }

    /// What the operator estimates beside the position: with it, and with it alone, its precision is compared to the bound.
    fn unknowns(&self) -> Unknowns {
        Unknowns::default()
    }

    /// Whether a start must say what is pictured.
    fn needs_kind(&self) -> bool {
        false
    }

    /// Whether the result depends on the grey values: true of all operators but the one that returns its start.
    fn reads_grey_values(&self) -> bool {
        true
    }

    /// What it was recorded as, if it does not measure but was recorded: it is asked by name then, and [`Self::measure`] finds nothing.
    fn recorded(&self) -> Option<&dyn Recorded> {
        None
    }

    /// What it finds boards by, if it is no operator but finds a board in the whole image: it is asked for the board then, and [`Self::measure`] finds nothing.
    fn board_finder(&self) -> Option<&dyn BoardFinder> {
        None
    }

    /// What a reader of its results has to know of how they came about; asked for after measuring. Nothing, of operators that are part of this program.
    fn told(&self) -> Told {
        Told::default()
    }

    /// The same in words.
    fn notes(&self) -> Vec<String> {
        self.told().notes()
    }
}

/// A finder as a method: it is asked for boards, and measures nothing of which it does not know what board it is on.
pub struct Finds<F>(pub F);

impl<F: BoardFinder> Operator for Finds<F> {
    /// # Errors
    /// [`Rejection::NotDetected`], always.
    fn measure(&self, _: &Image, _: &Start) -> Result<Measurement, Rejection> {
        Err(Rejection::NotDetected)
    }

    fn is_local(&self) -> bool {
        false
    }

    fn board_finder(&self) -> Option<&dyn BoardFinder> {
        Some(&self.0)
    }

    fn told(&self) -> Told {
        Told::said(self.0.notes())
    }
}

/// The whole pixel (column, row) nearest to a start, around which a window is laid.
///
/// # Errors
/// [`Rejection::NotFinite`] for a start that is not finite, [`Rejection::Border`] when the square of half-width `reach` px leaves the image.
pub fn window_centre(image: &Image, start: &Start, reach: i64) -> Result<(i64, i64), Rejection> {
    let (x, y) = start.position.nearest_pixel().ok_or(Rejection::NotFinite)?;
    if image.holds(x, y, reach) { Ok((x, y)) } else { Err(Rejection::Border) }
}

/// Whether all grey values of the square of half-width `reach` px around a pixel are numbers.
///
/// # Errors
/// [`Rejection::Border`] when the square leaves the image, [`Rejection::NotFinite`].
pub fn finite_around(image: &Image, (x, y): (i64, i64), reach: i64) -> Result<(), Rejection> {
    let mut rows = image.rows_around(x, y, reach).ok_or(Rejection::Border)?;
    // A row at once: most are finite, and looked at side by side.
    if rows.all(|row| row.iter().fold(true, |all, grey| all & grey.is_finite())) { Ok(()) } else { Err(Rejection::NotFinite) }
}

/// What a detector of whole images measures: of each start the nearest detection within `radius` px. `reach` px around a start count; without any start that can be
/// measured nothing is detected.
pub fn nearest_detected(
    (image, starts): (&Image, &[Start]),
    (reach, radius): (i64, f64),
    detect: impl FnOnce() -> Vec<PixelPoint>,
) -> Vec<Result<Measurement, Rejection>> {
    let admit = |start: &Start| window_centre(image, start, reach).and_then(|centre| finite_around(image, centre, reach));
    let admitted: Vec<Result<(), Rejection>> = starts.iter().map(admit).collect();
    let found = if admitted.iter().any(Result::is_ok) { detect() } else { Vec::new() };
    let measure = |(start, admitted): (&Start, Result<(), Rejection>)| {
        admitted?;
        start.position.nearest(&found, radius).map(|position| Measurement { position, covariance: None }).ok_or(Rejection::NoCorner)
    };
    starts.iter().zip(admitted).map(measure).collect()
}
