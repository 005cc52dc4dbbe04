//! Derivatives of many projections, and the pose they belong to.

/// Points that lie side by side in a block.
pub(super) const LANES: usize = 8;

/// Object to camera: `N = rotation X + translation`, x right, y up, z backwards, as in [`crate::camera::Ray`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraFromWorld {
    /// 3 x 3, row by row.
    pub rotation: [[f64; 3]; 3],
    /// In the unit of the object.
    pub translation: [f64; 3],
}

impl CameraFromWorld {
    /// The object's frame is the camera's.
    pub const IDENTITY: Self = Self { rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], translation: [0.0; 3] };
}

/// Derivatives of many projected points.
///
/// Columns: a small rotation about the camera's axes x, y, z (radians; `N` becomes `N + d x N`), the translation along them (object units), then the
/// parameters of the model in their order. Kept in blocks of eight points, so that each column of a block is contiguous: what sums of products want.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Jacobian {
    columns: usize,
    points: usize,
    values: Vec<f64>,
}

impl Jacobian {
    /// Columns: 6 of the pose, then the parameters.
    pub const fn columns(&self) -> usize {
        self.columns
    }

    /// Points.
    pub const fn points(&self) -> usize {
        self.points
    }

    /// d(x, y) / d(column) of a point, px per unit of the column; not numbers if the point has no image.
    ///
    /// # Panics
    /// If there is no such point or column.
    pub fn at(&self, point: usize, column: usize) -> [f64; 2] {
        assert!(point < self.points && column < self.columns, "no derivative of point {point} by column {column}");
        let first = (point / LANES * self.columns + column) * 2 * LANES + point % LANES;
        [self.values[first], self.values[first + LANES]]
    }

    /// Blocks of eight points: for each column eight derivatives of x, then eight of y, as [`Self::at`] gives them. The last block is filled up with
    /// copies of its last point.
    pub fn blocks(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks_exact((self.columns * 2 * LANES).max(1))
    }

    /// Room for `points`; memory is kept from call to call.
    pub(super) fn fit(&mut self, points: usize, columns: usize) -> &mut [f64] {
        (self.points, self.columns) = (points, columns);
        self.values.resize(points.div_ceil(LANES) * columns * 2 * LANES, 0.0);
        &mut self.values
    }
}
