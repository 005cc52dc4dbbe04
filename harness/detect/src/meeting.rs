//! Where edges meet: the point to which the gradients around it are closest to being at right angles.

use crate::plane::Point;

/// Gradients in a disc, gathered. Places are relative to its middle, px.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Meeting {
    xx: f64,
    xy: f64,
    yy: f64,
    x: f64,
    y: f64,
    misfit: f64,
    weights: f64,
}

impl Meeting {
    /// Adds the gradient at a place; it counts the less the nearer it is to the rim.
    pub(crate) fn add(&mut self, off: Point, [gx, gy]: Point, radius: f64) {
        let weight = 1.0 - (off[0] * off[0] + off[1] * off[1]) / (radius * radius);
        if weight <= 0.0 {
            return;
        }
        let along = gx * off[0] + gy * off[1];
        self.xx += weight * gx * gx;
        self.xy += weight * gx * gy;
        self.yy += weight * gy * gy;
        self.x += weight * gx * along;
        self.y += weight * gy * along;
        self.misfit += weight * along * along;
        self.weights += weight;
    }

    /// The place; `None` where all gradients have one direction.
    pub(crate) fn place(&self) -> Option<Point> {
        let Self { xx, xy, yy, x, y, .. } = *self;
        let (det, trace) = (self.determinant(), xx + yy);
        (det > 1e-3 * trace * trace && det > 0.0).then(|| [(yy * x - xy * y) / det, (xx * y - xy * x) / det])
    }

    /// Its variance by how far the gradients are from being at right angles to the middle, px^2.
    pub(crate) fn variance(&self) -> f64 {
        self.misfit / self.weights * (self.xx + self.yy) / self.determinant()
    }

    fn determinant(&self) -> f64 {
        self.xx * self.yy - self.xy * self.xy
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two edges through (0.3, -0.2), at right angles to (1, 0) and (1, 2).
    #[test]
    fn two_edges_meet_where_they_cross() {
        let (mut both, mut one) = (Meeting::default(), Meeting::default());
        for t in [-2.0, -1.0, 1.0, 2.0] {
            both.add([0.3, -0.2 + t], [1.0, 0.0], 4.0);
            both.add([0.3 - 2.0 * t / 3.0, -0.2 + t / 3.0], [1.0, 2.0], 4.0);
            one.add([0.3, -0.2 + t], [1.0, 0.0], 4.0);
        }
        let [x, y] = both.place().unwrap();
        assert!((x - 0.3).abs() < 1e-12 && (y + 0.2).abs() < 1e-12, "{x} {y}");
        assert!(both.variance() > 0.0);
        assert_eq!(one.place(), None);
        let mut far = both;
        far.add([5.0, 0.0], [9.0, 9.0], 4.0);
        assert_eq!(far.place(), both.place(), "beyond the radius");
    }
}
