//! How two lines of one width join at a corner.

use std::f64::consts::PI;

/// How the lines of a corner join, as drawing programs name it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Join {
    /// The outer edges go on until they meet.
    #[default]
    Mitre,
    /// The tip of the mitre is cut where the lines' own ends are.
    Bevel,
    /// An arc about where the lines' middles meet.
    Round,
    /// No join: each line ends where the middles meet.
    Butt,
    /// No join: each line goes on by half its width.
    Square,
}

impl Join {
    /// Every way to join.
    pub const ALL: [Self; 5] = [Self::Mitre, Self::Bevel, Self::Round, Self::Butt, Self::Square];

    /// The outline around the outside of a corner that opens towards +x by `angle` (radians), from the line with y > 0 to the other one: (x, y) from where the middles
    /// meet, in the unit of `half`, the half width.
    pub(super) fn outside(self, half: f64, angle: f64) -> Vec<[f64; 2]> {
        let (sine, cosine) = (0.5 * angle).sin_cos();
        let end = |side: f64, beyond: f64| [-half * sine - beyond * cosine, side * (half * cosine - beyond * sine)];
        match self {
            Self::Mitre => vec![[-half / sine, 0.0]],
            Self::Bevel => vec![end(1.0, 0.0), end(-1.0, 0.0)],
            Self::Round => {
                let turn = PI - angle;
                let steps = (turn / STEP).ceil().max(1.0);
                let arc = |step: u32| {
                    let (y, x) = (PI + turn * (f64::from(step) / steps - 0.5)).sin_cos();
                    [half * x, half * y]
                };
                (0..=steps as u32).map(arc).collect()
            }
            Self::Butt => vec![end(1.0, 0.0), [0.0, 0.0], end(-1.0, 0.0)],
            Self::Square => vec![end(1.0, half), [-half / cosine, 0.0], end(-1.0, half)],
        }
    }
}

/// Steps of an arc, radians.
const STEP: f64 = PI / 32.0;

#[cfg(test)]
mod tests {
    use super::*;

    /// The area between the outside and where the middles meet, by the shoelace formula.
    fn area(join: Join, half: f64, angle: f64) -> f64 {
        let outside = join.outside(half, angle);
        let (sine, cosine) = (0.5 * angle).sin_cos();
        // All begin and end at the lines' own corners; what is before and behind these is counted the same way.
        let corner = |side: f64| [-half * sine, side * half * cosine];
        let all: Vec<[f64; 2]> = std::iter::once([0.0, 0.0]).chain([corner(1.0)]).chain(outside).chain([corner(-1.0)]).collect();
        let crossed = |[ax, ay]: [f64; 2], [bx, by]: [f64; 2]| ax * by - ay * bx;
        0.5 * (0..all.len()).map(|i| crossed(all[i], all[(i + 1) % all.len()])).sum::<f64>()
    }

    /// Closed forms for a half width of 2: a kite, a triangle, a sector, nothing, and two squares less what both cover.
    #[test]
    fn joins_add_the_areas_of_their_shapes() {
        for angle in [PI / 6.0, PI / 4.0, PI / 3.0, 2.0 * PI / 3.0] {
            let half = 0.5 * angle;
            let kite = 4.0 * half.cos() / half.sin();
            let (triangle, sector) = (4.0 * half.sin() * half.cos(), 2.0 * (PI - angle));
            for (join, expected, within) in
                [(Join::Mitre, kite, 1e-12), (Join::Bevel, triangle, 1e-12), (Join::Round, sector, 5e-3 * sector), (Join::Butt, 0.0, 1e-12)]
            {
                assert!((area(join, 2.0, angle) - expected).abs() < within, "{join:?} {angle}: {}", area(join, 2.0, angle));
            }
            // Each line's own half square beyond its end, cut by the bisector.
            let square = 4.0 * (2.0 - half.tan());
            assert!((area(Join::Square, 2.0, angle) - square).abs() < 1e-12, "{angle}: {} {square}", area(Join::Square, 2.0, angle));
        }
    }
}
