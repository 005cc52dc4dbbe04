//! The part of the frame that image points surround.

use calibench_model::PixelPoint;

/// A convex polygon around points, px; empty for fewer than three that are not on a line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hull(Vec<PixelPoint>);

impl Hull {
    /// The convex hull of image points, px.
    ///
    /// Source: Andrew 1979.
    pub fn of(points: &[PixelPoint]) -> Self {
        let mut sorted: Vec<PixelPoint> = points.to_vec();
        sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let mut chain: Vec<PixelPoint> = half(sorted.iter());
        chain.extend(half(sorted.iter().rev()));
        if chain.len() < 3 { Self::default() } else { Self(chain) }
    }

    /// Whether a place is inside or on the border.
    pub fn holds(&self, at: PixelPoint) -> bool {
        !self.0.is_empty() && self.sides().all(|[a, b]| turn(a, b, at) >= 0.0)
    }

    /// The sides, one after the other around.
    pub fn sides(&self) -> impl Iterator<Item = [PixelPoint; 2]> + '_ {
        (0..self.0.len()).map(|i| [self.0[i], self.0[(i + 1) % self.0.len()]])
    }

    /// Its corners around, the first once more at the end; empty for an empty one.
    pub fn outline(&self) -> Vec<(f64, f64)> {
        self.0.iter().chain(self.0.first()).map(|corner| (corner.x, corner.y)).collect()
    }
}

/// One half of the way around, without its end.
fn half<'a>(points: impl Iterator<Item = &'a PixelPoint>) -> Vec<PixelPoint> {
    let mut chain: Vec<PixelPoint> = Vec::new();
    for &point in points {
        while chain.len() > 1 && turn(chain[chain.len() - 2], chain[chain.len() - 1], point) <= 0.0 {
            chain.pop();
        }
        chain.push(point);
    }
    chain.pop();
    chain
}

/// Twice the area of the triangle, positive where c is on the right hand of the way from a to b, y down.
fn turn(a: PixelPoint, b: PixelPoint, c: PixelPoint) -> f64 {
    (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hull_of_a_grid_is_its_rectangle() {
        let points: Vec<PixelPoint> = (0..30).map(|k| PixelPoint::new(f64::from(k % 6) * 10.0, f64::from(k / 6) * 7.0)).collect();
        let hull = Hull::of(&points);
        assert_eq!(hull.sides().count(), 4);
        let holds = |x: f64, y: f64| hull.holds(PixelPoint::new(x, y));
        assert!(holds(0.0, 0.0) && holds(50.0, 28.0) && holds(25.0, 28.0) && holds(33.0, 12.0));
        assert!(!holds(-0.1, 5.0) && !holds(50.1, 5.0) && !holds(25.0, 28.1) && !holds(25.0, -0.1));
    }

    #[test]
    fn what_surrounds_nothing_holds_nothing() {
        let line: Vec<PixelPoint> = (0..5).map(|k| PixelPoint::new(f64::from(k), 2.0 * f64::from(k))).collect();
        for points in [&line[..], &line[..1], &[]] {
            let hull = Hull::of(points);
            assert!(!hull.holds(PixelPoint::new(2.0, 4.0)) && hull.sides().count() == 0, "{hull:?}");
        }
    }
}
