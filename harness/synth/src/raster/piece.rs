//! Pieces of outlines in the image.

use calibench_model::Polygon;

/// An arc between two points: the parabola through its ends and its middle (at parameter one half).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Where it starts, (x, y), px; pixel centres are whole numbers.
    pub start: [f64; 2],
    /// Where it is half-way.
    pub middle: [f64; 2],
    /// Where it ends.
    pub end: [f64; 2],
    /// What lies on its inside minus what lies on its outside, fraction of full scale; negative for an outline that runs the other way round.
    pub contrast: f64,
}

impl Piece {
    /// A straight piece.
    pub fn straight(start: [f64; 2], end: [f64; 2], contrast: f64) -> Self {
        Self { start, middle: [0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])], end, contrast }
    }

    /// Coefficients of t^0, t^1, t^2 for x and y.
    #[inline(always)]
    pub(crate) fn polynomial(&self) -> [[f64; 3]; 2] {
        std::array::from_fn(|i| {
            let (a, m, b) = (self.start[i], self.middle[i], self.end[i]);
            [a, 4.0 * m - 3.0 * a - b, 2.0 * (a - 2.0 * m + b)]
        })
    }

    /// The lowest and highest y that it can reach.
    pub(crate) fn rows(&self) -> [f64; 2] {
        span(self.start[1], self.middle[1], self.end[1])
    }

    /// The lowest and highest x that it can reach.
    pub(crate) fn columns(&self) -> [f64; 2] {
        span(self.start[0], self.middle[0], self.end[0])
    }

    /// The length of the polygon through its three points, px: at most a little less than its own.
    pub(crate) fn length(&self) -> f64 {
        let [a, m, b] = [self.start, self.middle, self.end];
        (m[0] - a[0]).hypot(m[1] - a[1]) + (b[0] - m[0]).hypot(b[1] - m[1])
    }

    /// Twice the signed area between the piece and the origin, px^2.
    pub(crate) fn doubled_area(&self) -> f64 {
        // Simpson's rule is exact for the cubic integrand.
        let [[x0, x1, x2], [y0, y1, y2]] = self.polynomial();
        let cross = |t: f64| {
            let (x, y) = (x0 + t * (x1 + t * x2), y0 + t * (y1 + t * y2));
            x * (y1 + 2.0 * t * y2) - y * (x1 + 2.0 * t * x2)
        };
        (cross(0.0) + 4.0 * cross(0.5) + cross(1.0)) / 6.0
    }
}

/// The control polygon of the parabola bounds it.
fn span(a: f64, m: f64, b: f64) -> [f64; 2] {
    let control = 2.0 * m - 0.5 * (a + b);
    [a.min(b).min(control), a.max(b).max(control)]
}

/// Turns `pieces`, a closed outline, so that `contrast` lies on its inside.
pub(crate) fn orient(pieces: &mut [Piece], contrast: f64) {
    // From its own start, so that a small outline far from the origin loses no digits.
    let origin = pieces.first().map_or([0.0, 0.0], |piece| piece.start);
    let moved = |p: [f64; 2]| [p[0] - origin[0], p[1] - origin[1]];
    let local = |piece: &Piece| Piece { start: moved(piece.start), middle: moved(piece.middle), end: moved(piece.end), contrast };
    let area: f64 = pieces.iter().map(|piece| local(piece).doubled_area()).sum();
    pieces.iter_mut().for_each(|piece| piece.contrast = contrast * area.signum());
}

/// The pieces of a polygon on a ground of grey value `ground`.
pub(crate) fn polygon(polygon: &Polygon, ground: f64) -> Vec<Piece> {
    let mut pieces: Vec<Piece> = polygon.edges().map(|(a, b)| Piece::straight([a.x, a.y], [b.x, b.y], 0.0)).collect();
    orient(&mut pieces, polygon.grey - ground);
    pieces
}
