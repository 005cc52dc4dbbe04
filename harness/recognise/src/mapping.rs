//! From the grid to the image and back: a homography, and a bend of straight lines.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

/// Places of the image are taken from its middle, in halves of its diagonal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unit {
    /// The middle, px.
    pub middle: [f64; 2],
    /// Half the diagonal, px.
    pub reach: f64,
}

impl Unit {
    pub fn of(width: usize, height: usize) -> Self {
        let [w, h] = [width, height].map(|side| side as f64 - 1.0);
        Self { middle: [0.5 * w, 0.5 * h], reach: 0.5 * w.hypot(h) }
    }

    pub fn of_px(&self, [x, y]: [f64; 2]) -> Vector2<f64> {
        Vector2::new(x - self.middle[0], y - self.middle[1]) / self.reach
    }

    pub fn px(&self, p: Vector2<f64>) -> [f64; 2] {
        [self.middle[0] + p.x * self.reach, self.middle[1] + p.y * self.reach]
    }
}

/// Where a bent image's point would be without the bend: p / (1 + bend |p|^2) (division model).
pub(crate) fn straight(p: Vector2<f64>, bend: f64) -> Vector2<f64> {
    p / (1.0 + bend * p.norm_squared())
}

/// The derivatives of [`straight`] by its place.
pub(crate) fn by_place(p: Vector2<f64>, bend: f64) -> Matrix2<f64> {
    let d = 1.0 + bend * p.norm_squared();
    Matrix2::identity() / d - p * p.transpose() * (2.0 * bend / (d * d))
}

/// The derivative of [`straight`] by the bend.
pub(crate) fn by_bend(p: Vector2<f64>, bend: f64) -> Vector2<f64> {
    let d = 1.0 + bend * p.norm_squared();
    -p * (p.norm_squared() / (d * d))
}

/// The inverse of [`straight`]; `None` beyond the places that it comes to.
fn bent(q: Vector2<f64>, bend: f64) -> Option<Vector2<f64>> {
    let root = 1.0 - 4.0 * bend * q.norm_squared();
    (root >= 0.0).then(|| q * (2.0 / (1.0 + root.sqrt())))
}

/// How a grid of unit squares lies in an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mapping {
    pub unit: Unit,
    /// From straight places of the image (in [`Unit`]) to the grid; its last element is 1.
    pub to_grid: Matrix3<f64>,
    from_grid: Matrix3<f64>,
    pub bend: f64,
}

impl Mapping {
    /// `None` if `to_grid` is singular or the middle of the image is at the horizon.
    pub fn new(unit: Unit, to_grid: Matrix3<f64>, bend: f64) -> Option<Self> {
        let to_grid = to_grid / to_grid[(2, 2)];
        let from_grid = to_grid.try_inverse()?;
        (to_grid.iter().chain(from_grid.iter()).all(|x| x.is_finite())).then_some(Self { unit, to_grid, from_grid, bend })
    }

    /// The place on the grid of a point of the image (px); `None` beyond the horizon.
    pub fn grid(&self, at: [f64; 2]) -> Option<[f64; 2]> {
        let q = straight(self.unit.of_px(at), self.bend);
        let h = self.to_grid * Vector3::new(q.x, q.y, 1.0);
        (h.z > 1e-3).then(|| [h.x / h.z, h.y / h.z])
    }

    /// The point of the image, px, of a place on the grid; `None` beyond the horizon.
    pub fn image(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        let q = self.flat([x, y])?;
        bent(q, self.bend).map(|p| self.unit.px(p))
    }

    fn flat(&self, [x, y]: [f64; 2]) -> Option<Vector2<f64>> {
        let h = self.from_grid * Vector3::new(x, y, 1.0);
        // Of the same sign as at the middle of the image, where the grid's third coordinate is 1.
        let depth = 1.0 / h.z;
        (depth > 1e-3).then(|| Vector2::new(h.x / h.z, h.y / h.z))
    }

    /// Where a straight place, px, is seen in the bent image; `None` beyond the places that it comes to.
    pub fn bent(&self, at: [f64; 2]) -> Option<[f64; 2]> {
        bent(self.unit.of_px(at), self.bend).map(|p| self.unit.px(p))
    }

    /// The derivatives of the image by the place on the grid, px per square.
    pub fn by_grid(&self, at: [f64; 2]) -> Option<Matrix2<f64>> {
        let q = self.flat(at)?;
        let z = (self.from_grid * Vector3::new(at[0], at[1], 1.0)).z;
        let m = &self.from_grid;
        let by = |row: usize, value: f64| [0, 1].map(|column| (m[(row, column)] - value * m[(2, column)]) / z);
        let ([a, b], [c, d]) = (by(0, q.x), by(1, q.y));
        let p = bent(q, self.bend)?;
        let back = by_place(p, self.bend).try_inverse()?;
        Some(back * Matrix2::new(a, b, c, d) * self.unit.reach)
    }

    /// The same view by coordinates of the field: `turn` quarter turns and then a shift bring the grid's to the field's.
    pub fn moved(&self, place: &Place) -> Option<Self> {
        Self::new(self.unit, place.matrix() * self.to_grid, self.bend)
    }

    /// The homography from the grid to px, without the bend, scaled to 1 in its last element.
    pub fn homography(&self) -> Matrix3<f64> {
        let Unit { middle: [x, y], reach } = self.unit;
        let h = Matrix3::new(reach, 0.0, x, 0.0, reach, y, 0.0, 0.0, 1.0) * self.from_grid;
        h / h[(2, 2)]
    }
}

/// Where a grid lies on the field: turned, in a mirror or not, and shifted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Place {
    /// Quarter turns, 0 to 3.
    pub turns: usize,
    /// Whether x and y are exchanged first.
    pub mirrored: bool,
    /// Columns and rows.
    pub shift: [i64; 2],
}

impl Place {
    /// The place on the field.
    pub fn of(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.direction([x, y]);
        [x + self.shift[0] as f64, y + self.shift[1] as f64]
    }

    /// A direction on the field.
    pub fn direction(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [x, y] = if self.mirrored { [y, x] } else { [x, y] };
        match self.turns {
            0 => [x, y],
            1 => [-y, x],
            2 => [-x, -y],
            _ => [y, -x],
        }
    }

    /// The row and column on the field of the grid's square at (column, row).
    pub fn square(&self, [column, row]: [i64; 2]) -> [i64; 2] {
        let [x, y] = self.of([column as f64 + 0.5, row as f64 + 0.5]);
        [y.floor() as i64, x.floor() as i64]
    }

    fn matrix(&self) -> Matrix3<f64> {
        let ([a, c], [b, d]) = (self.direction([1.0, 0.0]), self.direction([0.0, 1.0]));
        Matrix3::new(a, b, self.shift[0] as f64, c, d, self.shift[1] as f64, 0.0, 0.0, 1.0)
    }
}

#[cfg(test)]
mod tests;
