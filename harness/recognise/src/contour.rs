//! Contours and their features.

use crate::blobs::Areas;
use crate::normal::SIDE;

/// Turns of the contour, degrees, that are features: from so many on blunt, right as of a square, sharp as of a triangle; below, concave as of a cross.
const TURNS: [f64; 3] = [60.0, 80.0, 100.0];
const CONCAVE: f64 = -15.0;
/// The steps over which a turn is taken: this share of the contour's length, before and after.
const STEP: f64 = 1.0 / 7.0;

/// How often each feature is seen along a contour: blunt, right and sharp angles, and concave ones.
pub(crate) type Features = [usize; 4];

/// The features of the contour of an area.
///
/// Source: Vosselman & Förstner 1988, section 3.3, which names "sharp angle" and "concave angle".
pub(crate) fn features(areas: &Areas, index: usize) -> Features {
    let contour = follow(areas, index);
    let n = contour.len();
    let step = ((n as f64 * STEP).round() as usize).max(1);
    let mut counts = [0; 4];
    for i in 0..n {
        let [before, here, after] = [contour[(i + n - step % n) % n], contour[i], contour[(i + step) % n]];
        let (a, b) = (minus(here, before), minus(after, here));
        let turn = (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]).to_degrees();
        match TURNS.iter().rposition(|least| turn > *least) {
            Some(feature) => counts[feature] += 1,
            None => counts[3] += usize::from(turn < CONCAVE),
        }
    }
    counts
}

fn minus(a: [i32; 2], b: [i32; 2]) -> [f64; 2] {
    [f64::from(a[0] - b[0]), f64::from(a[1] - b[1])]
}

/// The eight directions, clockwise as displayed, from the right.
const AROUND: [[i32; 2]; 8] = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];

/// The pixels along the outer border of an area, clockwise as displayed.
pub(crate) fn follow(areas: &Areas, index: usize) -> Vec<[i32; 2]> {
    let area = &areas.areas[index];
    let is = |[x, y]: [i32; 2]| {
        let inside = |v: i32| (0..SIDE as i32).contains(&v);
        inside(x) && inside(y) && areas.labels[y as usize * SIDE + x as usize] == area.label
    };
    let start = area.first.map(|v| v as i32);
    // The first pixel row by row has nothing above it and nothing to its left.
    let (mut at, mut from, mut contour) = (start, 6, vec![start]);
    let mut first_move = None;
    while contour.len() < SIDE * SIDE {
        let next = (0..8).map(|k| (from + k) % 8).find(|&d| is([at[0] + AROUND[d][0], at[1] + AROUND[d][1]]));
        let Some(direction) = next else { break };
        if at == start && first_move == Some(direction) {
            contour.pop();
            break;
        }
        first_move.get_or_insert(direction);
        at = [at[0] + AROUND[direction][0], at[1] + AROUND[direction][1]];
        contour.push(at);
        // Begin with the pixel after the one that was seen to be free last.
        from = (direction + 6 - direction % 2) % 8;
    }
    contour
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::normal::Normal;

    fn areas(dark: impl Fn(f64, f64) -> bool) -> Areas {
        let dark = (0..SIDE * SIDE).map(|at| f32::from(u8::from(dark((at % SIDE) as f64 - 60.0, (at / SIDE) as f64 - 60.0)))).collect();
        Areas::of(&Normal { dark, contrast: 0.8 }, 2, 1.0)
    }

    #[test]
    fn a_contour_goes_once_round_clockwise() {
        let areas = areas(|x, y| x.abs() <= 2.0 && y.abs() <= 1.0);
        let contour = follow(&areas, 0);
        assert_eq!(contour.len(), 12, "{contour:?}");
        let doubled: i32 = (0..12).map(|i| contour[i][0] * contour[(i + 1) % 12][1] - contour[i][1] * contour[(i + 1) % 12][0]).sum();
        assert_eq!(doubled, 2 * 8, "the area between the pixels' middles, positive clockwise as y points down");
    }

    #[test]
    fn a_pixel_and_a_thin_line_are_followed() {
        assert_eq!(follow(&areas(|x, y| x == 0.0 && y == 0.0), 0).len(), 1);
        assert_eq!(follow(&areas(|x, y| x.abs() <= 3.0 && y == 0.0), 0).len(), 12);
        assert_eq!(features(&areas(|x, y| x == 0.0 && y == 0.0), 0), [0; 4]);
    }

    /// Corners of triangles are sharp, of squares at most right; the ends of crosses are sharp, and what is between them is concave where the bars are narrow;
    /// discs have hardly a corner.
    #[test]
    fn shapes_have_their_features() {
        let half = 10.0;
        for turn in [0.0_f64, 0.3, 0.7] {
            let (s, c) = turn.sin_cos();
            let own = move |x: f64, y: f64| (c * x + s * y, c * y - s * x);
            let square = features(&areas(|x, y| own(x, y).0.abs() <= half && own(x, y).1.abs() <= half), 0);
            let within = |x: f64, y: f64, k: f64| {
                let (s, c) = (turn + k * std::f64::consts::TAU / 3.0).sin_cos();
                c * x + s * y <= 8.0
            };
            let triangle = features(&areas(|x, y| (0..3).all(|k| within(x, y, f64::from(k)))), 0);
            let cross = |wide: f64| {
                let bar = |a: f64, b: f64| a.abs() <= 12.0 && b.abs() <= wide;
                features(&areas(|x, y| bar(own(x, y).0, own(x, y).1) || bar(own(x, y).1, own(x, y).0)), 0)
            };
            let (printed, narrow) = (cross(4.0), cross(1.5));
            let disc = features(&areas(|x, y| x.hypot(y) <= half), 0);
            assert!(triangle[2] > square[2] + 3 && square[0] + square[1] > 8, "{triangle:?} {square:?}");
            assert!(printed[2] > disc[2] + 8 && disc[1..] == [0; 3], "{printed:?} {disc:?}");
            assert!(narrow[3] > 4 && square[3] == 0 && triangle[3] == 0, "{narrow:?}");
        }
    }
}
