//! What every operator does.

use calibench_model::{Image, Measurement, Rejection, Start, Unknowns};

/// A way of measuring points in an image, with its parameters set.
pub trait Operator: Send + Sync {
    /// Measures one point, starting at `start`.
    ///
    /// # Errors
    /// A [`Rejection`] that says why the point was missed. Operators never panic on grey values, whatever these are.
    fn measure(&self, image: &Image, start: &Start) -> Result<Measurement, Rejection>;

    /// Measures many points of one image, in the order given.
    fn measure_all(&self, image: &Image, starts: &[Start]) -> Vec<Result<Measurement, Rejection>> {
        starts.iter().map(|start| self.measure(image, start)).collect()
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
}

/// The whole pixel (column, row) nearest to a start, around which a window is laid.
///
/// # Errors
/// [`Rejection::NotFinite`] for a start that is not finite, [`Rejection::Border`] when the square of half-width `reach` px leaves the image.
pub fn window_centre(image: &Image, start: &Start, reach: i64) -> Result<(i64, i64), Rejection> {
    let (x, y) = start.position.nearest_pixel().ok_or(Rejection::NotFinite)?;
    if image.holds(x, y, reach) { Ok((x, y)) } else { Err(Rejection::Border) }
}
