//! Convex quadrangles around dark areas.

use calibench_model::{Image, stop, upper_median};

use crate::ground::grey;
use crate::patches::Run;
use crate::plane::{Point, cross, distance, dot, minus, plus, times};

/// The share of an area's convex hull that the largest quadrangle in it takes up, if it is one: a disc reaches 0.64, a hexagon 0.75.
const LEAST_SHARE: f64 = 0.82;
/// The least and the greatest ratio of its sides, and the least sine of its angles.
const SIDES: f64 = 8.0;
const SINE: f64 = 0.25;
/// The share of a side along which its edge is seen, when it is adjusted for the first time and for the second.
const SEEN: [f64; 2] = [0.5, 0.6];

/// The convex hull of an area's pixels, by their centres, clockwise from the top.
pub(crate) fn hull(runs: &[Run]) -> Vec<Point> {
    let mut rows: Vec<[f64; 3]> = Vec::new();
    for run in runs {
        let (y, from, to) = (f64::from(run.y), f64::from(run.from), f64::from(run.to - 1));
        match rows.last_mut() {
            Some(row) if row[0] == y => *row = [y, row[1].min(from), row[2].max(to)],
            _ => rows.push([y, from, to]),
        }
    }
    let mut right = chain(rows.iter().map(|row| [row[2], row[0]]));
    let left = chain(rows.iter().rev().map(|row| [row[1], row[0]]));
    right.extend(left);
    right.dedup();
    if right.len() > 1 && right[0] == right[right.len() - 1] {
        right.pop();
    }
    right
}

fn chain(points: impl Iterator<Item = Point>) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    for point in points {
        while let [.., a, b] = kept[..] {
            if cross(minus(b, a), minus(point, b)) > 0.0 {
                break;
            }
            kept.pop();
        }
        kept.push(point);
    }
    kept
}

fn area(points: &[Point]) -> f64 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| 0.5 * cross(*a, *b)).sum()
}

/// The largest quadrangle of a hull's vertices, and its share of the hull.
pub(crate) fn largest_quad(hull: &[Point]) -> Option<([Point; 4], f64)> {
    let n = hull.len();
    if n < 4 {
        return None;
    }
    let triangle = |a: usize, b: usize, c: usize| cross(minus(hull[b], hull[a]), minus(hull[c], hull[a]));
    let mut best = (0.0, [0; 4]);
    for i in 0..n - 2 {
        let (mut j, mut l) = (i + 1, i + 3);
        for k in i + 2..n {
            while j + 1 < k && triangle(i, j + 1, k) > triangle(i, j, k) {
                j += 1;
            }
            l = l.max(k + 1);
            while l + 1 < n + i && triangle(i, k, (l + 1) % n) > triangle(i, k, l % n) {
                l += 1;
            }
            if l >= n + i {
                continue;
            }
            let both = 0.5 * (triangle(i, j, k) + triangle(i, k, l % n));
            if both > best.0 {
                best = (both, [i, j, k, l % n]);
            }
        }
    }
    (best.0 > 0.0).then(|| (best.1.map(|index| hull[index]), best.0 / area(hull)))
}

/// The quadrangle that an area fills, clockwise, its pixels' centres within; `None` if its shape is another or a side is shorter than `least` px.
pub(crate) fn quad(runs: &[Run], least: f64) -> Option<[Point; 4]> {
    stop::point();
    let (quad, share) = largest_quad(&hull(runs))?;
    (share >= LEAST_SHARE && is_square_seen(&quad, least)).then_some(quad)
}

/// Whether a quadrangle may be the picture of a square.
fn is_square_seen(quad: &[Point; 4], least: f64) -> bool {
    let sides: [Point; 4] = std::array::from_fn(|i| minus(quad[(i + 1) % 4], quad[i]));
    let lengths = sides.map(|side| side[0].hypot(side[1]));
    let (short, long) = lengths.iter().fold((f64::INFINITY, 0.0_f64), |(short, long), side| (short.min(*side), long.max(*side)));
    let sine = |i: usize| cross(sides[i], sides[(i + 1) % 4]) / (lengths[i] * lengths[(i + 1) % 4]);
    short >= least && long <= SIDES * short && (0..4).all(|i| sine(i) >= SINE)
}

/// A line by a point and its direction, of length 1.
#[derive(Clone, Copy)]
struct Line {
    at: Point,
    along: Point,
}

/// A dark quadrangle whose sides were adjusted to the edges of the image within `reach` px, twice; `None` where a side shows none along most of it.
pub(crate) fn adjusted(image: &Image, quad: &[Point; 4], reach: f64) -> Option<[Point; 4]> {
    stop::point();
    let once = adjusted_once(image, quad, reach, SEEN[0])?;
    adjusted_once(image, &once, reach, SEEN[1])
}

fn adjusted_once(image: &Image, quad: &[Point; 4], reach: f64, seen: f64) -> Option<[Point; 4]> {
    let mut lines = [Line { at: [0.0, 0.0], along: [0.0, 0.0] }; 4];
    for (i, line) in lines.iter_mut().enumerate() {
        *line = side(image, quad[i], quad[(i + 1) % 4], reach, seen)?;
    }
    let mut corners = [[0.0, 0.0]; 4];
    for (i, corner) in corners.iter_mut().enumerate() {
        *corner = meeting(lines[(i + 3) % 4], lines[i]).filter(|corner| distance(*corner, quad[i]) < 2.5 * reach + 1.0)?;
    }
    Some(corners)
}

fn meeting(a: Line, b: Line) -> Option<Point> {
    let sine = cross(a.along, b.along);
    (sine.abs() > 0.5 * SINE).then(|| plus(a.at, times(a.along, cross(minus(b.at, a.at), b.along) / sine)))
}

/// The line along the edge from dark to light near the side from `a` to `b`, of which the share `seen` has to lie on it; light lies to the left of it.
fn side(image: &Image, a: Point, b: Point, reach: f64, seen: f64) -> Option<Line> {
    let length = distance(a, b);
    let along = times(minus(b, a), 1.0 / length);
    let outwards = [along[1], -along[0]];
    let count = (length / 1.5).clamp(8.0, 40.0) as usize;
    // Near its ends other edges begin.
    let places = (0..count).map(|i| 0.12 + 0.76 * i as f64 / (count - 1) as f64);
    let edges: Vec<(Point, f64)> = places
        .filter_map(|place| {
            let at = plus(a, times(along, place * length));
            edge(image, at, outwards, reach).map(|(offset, rise)| (plus(at, times(outwards, offset)), rise))
        })
        .collect();
    // What rises much less is no edge of the same dark and light.
    let least = 0.3 * upper_median(edges.iter().map(|(_, rise)| *rise))?;
    let found: Vec<Point> = edges.iter().filter(|(_, rise)| *rise >= least).map(|(at, _)| *at).collect();
    trimmed(&found, (seen * count as f64).max(5.0) as usize, (0.45 * reach).max(0.9))
}

/// How far outwards of `at` grey values rise most, px, and by how much, fraction of full scale.
fn edge(image: &Image, at: Point, outwards: Point, reach: f64) -> Option<(f64, f64)> {
    const STEP: f64 = 0.5;
    let steps = (reach / STEP).ceil() as i32 + 2;
    let profile: Vec<f64> = (-steps..=steps).map(|k| grey(image, plus(at, times(outwards, STEP * f64::from(k))))).collect();
    let slopes: Vec<f64> = profile.windows(3).map(|three| three[2] - three[0]).collect();
    let within = 1..slopes.len() - 1;
    let top = within.max_by(|a, b| slopes[*a].total_cmp(&slopes[*b]))?;
    if slopes[top] < 0.01 {
        return None;
    }
    let near = top.saturating_sub(3)..slopes.len().min(top + 4);
    let (mut weight, mut sum) = (0.0, 0.0);
    for k in near {
        let slope = slopes[k].max(0.0);
        weight += slope;
        sum += slope * (k as f64 + 1.0 - f64::from(steps));
    }
    // Slopes are taken over two steps.
    Some((STEP * sum / weight, 0.5 * weight))
}

/// The line of least squares, once more without what lies far off, `most` px at most; `None` for fewer than `least` points.
fn trimmed(points: &[Point], least: usize, most: f64) -> Option<Line> {
    let line = fitted(points, least)?;
    let off = |point: &Point| cross(line.along, minus(*point, line.at)).abs();
    let limit = (3.0 * upper_median(points.iter().map(off))?).clamp(0.6, most);
    let near: Vec<Point> = points.iter().filter(|point| off(point) <= limit).copied().collect();
    fitted(&near, least)
}

fn fitted(points: &[Point], least: usize) -> Option<Line> {
    if points.len() < least {
        return None;
    }
    let at = crate::plane::mean(points);
    let moment = |f: fn(Point) -> f64| points.iter().map(|point| f(minus(*point, at))).sum::<f64>();
    let (xx, xy, yy) = (moment(|d| d[0] * d[0]), moment(|d| d[0] * d[1]), moment(|d| d[1] * d[1]));
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    let along = [angle.cos(), angle.sin()];
    (dot(along, along) > 0.5).then_some(Line { at, along })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn runs(of: impl Fn(f64, f64) -> bool) -> Vec<Run> {
        let row = |y: u32| {
            let dark: Vec<u32> = (0..100).filter(|x| of(f64::from(*x), f64::from(y))).collect();
            dark.first().map(|from| Run { y, from: *from, to: dark[dark.len() - 1] + 1 })
        };
        (0..100).filter_map(row).collect()
    }

    #[test]
    fn a_square_is_told_from_a_disc_and_its_corners_are_met() {
        let turned = |x: f64, y: f64, angle: f64| {
            let (sine, cosine) = f64::sin_cos(angle);
            [cosine * (x - 50.0) + sine * (y - 50.0), cosine * (y - 50.0) - sine * (x - 50.0)]
        };
        for angle in [0.0, 0.3, 0.785, 1.2] {
            let square = runs(|x, y| turned(x, y, angle).into_iter().all(|at| at.abs() <= 20.0));
            let found = quad(&square, 10.0).unwrap();
            for corner in found {
                let at = turned(corner[0], corner[1], angle);
                assert!((at[0].abs() - 20.0).abs() < 1.5 && (at[1].abs() - 20.0).abs() < 1.5, "{angle}: {at:?}");
            }
            assert!(area(&found) > 0.0);
        }
        assert_eq!(quad(&runs(|x, y| (x - 50.0).hypot(y - 50.0) <= 20.0), 10.0), None);
        assert_eq!(quad(&runs(|x, y| (x - 50.0).abs() + 2.0 * (y - 50.0).abs() <= 8.0), 12.0), None);
    }

    #[test]
    fn sides_are_adjusted_to_edges() {
        let ramp = |off: f64| (0.5 + off).clamp(0.0, 1.0) as f32;
        let image = Image::from_fn(60, 60, |x, y| {
            let out = (x as f64 - 30.0).abs().max((y as f64 - 30.0).abs());
            0.1 + 0.8 * ramp(out - 12.3)
        });
        let start = [[18.0, 18.0], [42.0, 18.0], [42.0, 42.0], [18.0, 42.0]];
        let found = adjusted(&image, &start, 2.0).unwrap();
        for [x, y] in found {
            assert!(((x - 30.0).abs() - 12.3).abs() < 0.1 && ((y - 30.0).abs() - 12.3).abs() < 0.1, "{x} {y}");
        }
    }
}
