//! Pieces of outlines in the image.

use calibench_model::Polygon;

/// A smooth arc: the curve of degree four through five points, at parameters 0, 1/4, 1/2, 3/4 and 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// The points, (x, y), px; pixel centres are whole numbers.
    pub points: [[f64; 2]; 5],
    /// What lies on its inside minus what lies on its outside, fraction of full scale; negative for an outline that runs the other way round.
    pub contrast: f64,
}

/// Coefficients of t^0 to t^4.
pub(crate) type Quartic = [f64; 5];

impl Piece {
    /// The straight piece from `start` to `end`, (x, y), px; `contrast` as [`Self::contrast`].
    pub fn straight(start: [f64; 2], end: [f64; 2], contrast: f64) -> Self {
        let at = |t: f64| [start[0] + t * (end[0] - start[0]), start[1] + t * (end[1] - start[1])];
        Self { points: [start, at(0.25), at(0.5), at(0.75), end], contrast }
    }

    /// Whether `next` is of the same outline and begins where this one ends.
    pub(crate) fn goes_on_in(&self, next: &Piece) -> bool {
        self.points[4] == next.points[0] && self.contrast == next.contrast
    }

    /// Its polynomials in x and y.
    #[inline(always)]
    pub(crate) fn polynomial(&self) -> [Quartic; 2] {
        std::array::from_fn(|i| {
            let [a, b, c, d, e] = self.points.map(|p| p[i]);
            // Differences from the first point, so that a straight piece has no curvature but rounding.
            let (b, c, d, e) = (b - a, c - a, d - a, e - a);
            [
                a,
                16.0 * b - 12.0 * c + 16.0 / 3.0 * d - e,
                -208.0 / 3.0 * b + 76.0 * c - 112.0 / 3.0 * d + 22.0 / 3.0 * e,
                96.0 * b - 128.0 * c + 224.0 / 3.0 * d - 16.0 * e,
                -128.0 / 3.0 * b + 64.0 * c - 128.0 / 3.0 * d + 32.0 / 3.0 * e,
            ]
        })
    }

    /// The lowest and highest y that it can reach.
    pub(crate) fn rows(&self) -> [f64; 2] {
        self.span(1)
    }

    /// The lowest and highest x that it can reach.
    pub(crate) fn columns(&self) -> [f64; 2] {
        self.span(0)
    }

    fn span(&self, axis: usize) -> [f64; 2] {
        let values = self.points.map(|p| p[axis]);
        let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)));
        // Between its points a quartic goes no further beyond them than a third of their spread, a smooth one much less.
        let slack = (high - low) / 3.0;
        [low - slack, high + slack]
    }

    /// The length of the polygon through its points, px: at most a little less than its own.
    pub(crate) fn length(&self) -> f64 {
        self.points.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).sum()
    }

    /// Twice the signed area between the piece and its origin `from`, px^2, by the polygon through its points.
    fn doubled_area(&self, from: [f64; 2]) -> f64 {
        let cross = |a: [f64; 2], b: [f64; 2]| (a[0] - from[0]) * (b[1] - from[1]) - (b[0] - from[0]) * (a[1] - from[1]);
        self.points.windows(2).map(|pair| cross(pair[0], pair[1])).sum()
    }
}

/// The value at `t`.
#[inline(always)]
pub(crate) fn at([c0, c1, c2, c3, c4]: Quartic, t: f64) -> f64 {
    c0 + t * (c1 + t * (c2 + t * (c3 + t * c4)))
}

/// The derivative at `t`.
#[inline(always)]
pub(crate) fn slope([_, c1, c2, c3, c4]: Quartic, t: f64) -> f64 {
    c1 + t * (2.0 * c2 + t * (3.0 * c3 + t * 4.0 * c4))
}

/// Turns `pieces`, a closed outline, so that `contrast` lies on its inside.
pub(crate) fn orient(pieces: &mut [Piece], contrast: f64) {
    // From its own start, so that a small outline far from the origin loses no digits.
    let origin = pieces.first().map_or([0.0, 0.0], |piece| piece.points[0]);
    let area: f64 = pieces.iter().map(|piece| piece.doubled_area(origin)).sum();
    pieces.iter_mut().for_each(|piece| piece.contrast = contrast * area.signum());
}

/// Of the pieces those that are `kept`, with each run of those that `is_left` names joined to one from its start to its end before; a closed run is gone.
///
/// Of an outline that lies left of all pixels that are asked for, beyond the kernel's reach, only where it begins and ends counts: its integral of k(y) dy.
/// Runs are joined whole: of a part of a closed one that is left out, the rest would stay, add up to nothing, and yet count as an area that is seen.
pub(crate) fn join_left<'a>(
    pieces: impl Iterator<Item = &'a Piece>,
    is_left: impl Fn(&Piece) -> bool,
    kept: impl Fn(&Piece) -> bool,
) -> Vec<Piece> {
    let mut joined: Vec<Piece> = Vec::new();
    let mut run: Option<Piece> = None;
    let ends = |run: Option<Piece>| run.filter(|run| run.points[0] != run.points[4] && kept(run));
    for piece in pieces {
        if !is_left(piece) {
            joined.extend(ends(run.take()));
            joined.extend(kept(piece).then_some(*piece));
            continue;
        }
        let start = match run.take() {
            Some(run) if run.goes_on_in(piece) => run.points[0],
            other => {
                joined.extend(ends(other));
                piece.points[0]
            }
        };
        run = Some(Piece::straight(start, piece.points[4], piece.contrast));
    }
    joined.extend(ends(run));
    joined
}

/// The pieces of a polygon on a ground of grey value `ground`.
pub(crate) fn polygon(polygon: &Polygon, ground: f64) -> Vec<Piece> {
    let mut pieces: Vec<Piece> = polygon.edges().map(|(a, b)| Piece::straight([a.x, a.y], [b.x, b.y], 0.0)).collect();
    orient(&mut pieces, polygon.grey - ground);
    pieces
}

/// The pieces of a rectangle that is 2 px wide and begins at (`x`, 0).
#[cfg(test)]
pub(crate) fn rectangle(x: f64, height: f64, contrast: f64) -> impl Iterator<Item = Piece> {
    let corners = [[x, 0.0], [x + 2.0, 0.0], [x + 2.0, height], [x, height]];
    (0..4).map(move |i| Piece::straight(corners[i], corners[(i + 1) % 4], contrast))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_on_the_left_are_joined_and_closed_ones_are_gone() {
        let square = |x: f64, contrast: f64| rectangle(x, 2.0, contrast);
        let all: Vec<Piece> = square(0.0, 0.5).chain(square(3.0, 0.5)).chain(square(9.0, -0.5)).collect();
        let found = join_left(all.iter(), |piece| piece.columns()[1] < 4.0, |_| true);
        // Of the second square one edge is left of 4, and stays as it is.
        assert_eq!(found, all[4..].to_vec());
        let found = join_left(all.iter(), |piece| piece.columns()[1] < 10.0 && piece.points[0] != [9.0, 0.0], |_| true);
        assert_eq!(found, [all[8], all[9], all[10], all[11]]);
        let found = join_left(all[..3].iter(), |_| true, |_| true);
        assert_eq!(found, [Piece::straight([0.0, 0.0], [0.0, 2.0], 0.5)]);
        // Another contrast is another outline.
        let other = [Piece::straight([0.0, 0.0], [1.0, 1.0], 0.5), Piece::straight([1.0, 1.0], [0.0, 0.0], 0.25)];
        assert_eq!(join_left(other.iter(), |_| true, |_| true), other);
        // What is closed is gone, whatever of it would be kept; of the others what is kept stays.
        let upper = |piece: &Piece| piece.rows()[1] < 1.0;
        assert_eq!(join_left(all.iter(), |piece| piece.columns()[1] < 6.0, upper), [all[8]]);
    }

    #[test]
    fn the_polynomial_runs_through_its_points() {
        let points = [[1.0, 2.0], [3.5, 2.5], [4.0, 7.0], [2.0, 9.0], [-1.0, 8.5]];
        let [x, y] = Piece { points, contrast: 1.0 }.polynomial();
        for (i, [px, py]) in points.into_iter().enumerate() {
            let t = i as f64 / 4.0;
            assert!((at(x, t) - px).abs() < 1e-12 && (at(y, t) - py).abs() < 1e-12);
            let difference = (at(x, t + 1e-6) - at(x, t - 1e-6)) / 2e-6;
            assert!((slope(x, t) - difference).abs() < 1e-6);
        }
    }
}
