//! `opencv_subpix`: OpenCV's cornerSubPix, with the failures that it keeps to itself brought to light.

use calibench_measure::operator::window_centre;
use calibench_measure::registry::{Build, Method};
use calibench_measure::{Operator, Settings};
use calibench_model::{Image, Measurement, PixelPoint, Rejection, Start};
use opencv::boxed_ref::BoxedRef;
use opencv::core::{Mat, Point2f, Size, TermCriteria, TermCriteria_COUNT, TermCriteria_EPS};

/// From where a result that equals its start is asked again, px in both axes.
const ASIDE: f32 = 0.25;
/// How near to the start the second run must end to confirm it, px.
const CONFIRMED: f64 = 0.05;
/// OpenCV refuses images that do not exceed the window by this much, px.
const SPARE: usize = 4;

/// OpenCV's cornerSubPix: the point whose connections with the pixels of the window are orthogonal to the gradients there, iterated.
///
/// The window of exactly `window` x `window` px is centred on the current estimate (grey values are interpolated bilinearly) and weighted by
/// `exp(-dx^2/h^2 - dy^2/h^2)`, `h = window / 2` rounded down; gradients are central differences. Iteration ends after `iterations` steps or
/// with a step of at most `epsilon` px. Positions are single precision: a step of 2.4e-4 px past column or row 2048.
///
/// OpenCV gives no covariance and does not say when it fails: it returns the start. A result that equals its start is therefore asked again
/// from a quarter of a pixel aside. The windows of later steps may reach past the image: OpenCV repeats the border there.
///
/// Source: OpenCV, cornerSubPix (G. Bradski, The OpenCV Library, 2000). Its documentation names no paper for the iteration; the single step is
/// that of Förstner & Gülch 1987.
pub struct Subpix {
    window: usize,
    iterations: i32,
    epsilon: f64,
}

/// The method's entry.
pub fn method() -> Method {
    calibench_measure::opencv_subpix::method(Build::With(|settings| Box::new(Subpix::new(settings))), crate::version())
}

impl Subpix {
    fn new(settings: &Settings) -> Self {
        let (window, iterations) = (settings.whole("window"), settings.whole("iterations") as i32);
        Self { window, iterations, epsilon: settings.get("epsilon") }
    }

    /// The start in OpenCV's precision, if its window can be read.
    fn admit(&self, image: &Image, start: &Start) -> Result<Point2f, Rejection> {
        let (x, y) = window_centre(image, start, self.ring())?;
        if image.width() < self.window + SPARE || image.height() < self.window + SPARE {
            return Err(Rejection::Border);
        }
        let mut rows = image.rows_around(x, y, self.ring()).ok_or(Rejection::Border)?;
        let finite = rows.all(|row| row.iter().all(|grey| grey.is_finite()));
        if finite { Ok(Point2f::new(start.position.x as f32, start.position.y as f32)) } else { Err(Rejection::NotFinite) }
    }

    /// Half-width of the window with the ring that gradients at its border need.
    fn ring(&self) -> i64 {
        self.window as i64 / 2 + 1
    }

    fn is_flat(&self, image: &Image, start: &Start) -> bool {
        let rows = window_centre(image, start, self.ring()).ok().and_then(|(x, y)| image.rows_around(x, y, self.ring()));
        let mut values = rows.into_iter().flatten().flatten();
        let first = values.next();
        values.all(|grey| Some(grey) == first)
    }

    /// OpenCV's results for `points`, in their order.
    fn refine(&self, image: &BoxedRef<Mat>, mut points: Vec<Point2f>) -> opencv::Result<Vec<Point2f>> {
        let half = self.window as i32 / 2;
        let criteria = TermCriteria::new(TermCriteria_COUNT | TermCriteria_EPS, self.iterations, self.epsilon)?;
        if !points.is_empty() {
            let mut corners = Mat::from_slice_mut(&mut points)?;
            opencv::imgproc::corner_sub_pix(image, &mut corners, Size::new(half, half), Size::new(-1, -1), criteria)?;
        }
        Ok(points)
    }

    /// First and, for those that did not move, second results.
    fn run(&self, image: &Image, from: &[Point2f]) -> opencv::Result<Vec<Outcome>> {
        let header = Mat::new_rows_cols_with_data(image.height() as i32, image.width() as i32, image.grey())?;
        let first = self.refine(&header, from.to_vec())?;
        let unmoved: Vec<usize> = (0..from.len()).filter(|&i| first[i] == from[i]).collect();
        let aside: Vec<Point2f> = unmoved.iter().map(|&i| Point2f::new(from[i].x + ASIDE, from[i].y + ASIDE)).collect();
        let second = self.refine(&header, aside.clone())?;
        let mut outcomes: Vec<Outcome> = first.into_iter().map(Outcome::Moved).collect();
        for (k, &i) in unmoved.iter().enumerate() {
            outcomes[i] = Outcome::again(from[i], aside[k], second[k]);
        }
        Ok(outcomes)
    }

    fn conclude(&self, image: &Image, start: &Start, outcome: Outcome) -> Result<Measurement, Rejection> {
        match outcome {
            Outcome::Moved(to) | Outcome::Confirmed(to) => {
                let position = pixel(to);
                // A later window may have moved onto a grey value that is none.
                if position.is_finite() { Ok(Measurement { position, covariance: None }) } else { Err(Rejection::NotFinite) }
            }
            Outcome::Stuck => Err(Rejection::NoCorner),
            Outcome::Lost if self.is_flat(image, start) => Err(Rejection::NoCorner),
            Outcome::Lost => Err(Rejection::LeftWindow),
        }
    }
}

impl Operator for Subpix {
    /// # Errors
    /// [`Rejection::Border`] when the window and a ring of one pixel around the pixel nearest to the start leave the image, when the image is
    /// less than four px larger than the window, or when OpenCV refuses it; [`Rejection::NotFinite`]; of results that equal their start and
    /// that a second run does not confirm, [`Rejection::NoCorner`] when that did not move either or the window is flat, else
    /// [`Rejection::LeftWindow`].
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection> {
        let mut results = self.measure_all(image, std::slice::from_ref(start));
        results.pop().unwrap_or(Err(Rejection::Border))
    }

    fn measure_all(&self, image: &Image, starts: &[Start]) -> Vec<Result<Measurement, Rejection>> {
        let admitted: Vec<Result<Point2f, Rejection>> = starts.iter().map(|start| self.admit(image, start)).collect();
        let from: Vec<Point2f> = admitted.iter().filter_map(|point| point.as_ref().ok().copied()).collect();
        // What OpenCV objects to is the size of the image, which is the same for every point.
        let mut outcomes = self.run(image, &from).unwrap_or_default().into_iter();
        let finish = |(start, admitted): (&Start, Result<Point2f, Rejection>)| {
            admitted?;
            let outcome = outcomes.next().ok_or(Rejection::Border)?;
            self.conclude(image, start, outcome)
        };
        starts.iter().zip(admitted).map(finish).collect()
    }
}

/// What OpenCV made of a point.
#[derive(Clone, Copy)]
enum Outcome {
    /// The result differs from the start.
    Moved(Point2f),
    /// The result equals the start, and the second run came back to it.
    Confirmed(Point2f),
    /// Neither run moved.
    Stuck,
    /// The second run ended elsewhere.
    Lost,
}

impl Outcome {
    fn again(start: Point2f, aside: Point2f, second: Point2f) -> Self {
        if second == aside {
            Self::Stuck
        } else if pixel(second).distance(pixel(start)) <= CONFIRMED {
            Self::Confirmed(start)
        } else {
            Self::Lost
        }
    }
}

/// Both have the centre of the top-left pixel at (0, 0).
pub(crate) fn pixel(point: Point2f) -> PixelPoint {
    PixelPoint::new(f64::from(point.x), f64::from(point.y))
}

#[cfg(test)]
mod tests;
