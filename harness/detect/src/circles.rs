//! Grids of circles.

use std::borrow::Cow;

use calibench_model::Image;
use calibench_model::boards::{Board, BoardPoint, Circles, Layout};

use crate::corners::found;
use crate::lattice::{Grid, Grids, bases, limited};
use crate::plane::{Homography, Point, distance, length};
use crate::round::{Round, rounds};
use crate::{Found, NotFound};

/// How far a circle may be from where a plane has it, in distances of circles, and how many times as large as another it may be.
const BEND: f64 = 0.3;
const SIZES: f64 = 1.8;

/// The circles of a grid, dark on light or, where no such grid is seen, light on dark.
pub(crate) fn detect(image: &Image, circles: &Circles, layout: &Layout) -> Result<Found, NotFound> {
    let expected = layout.points.len();
    let (mut best, mut instead) = ([0, 0], None);
    for light in [false, true] {
        let seen = if light { Cow::Owned(negative(image)) } else { Cow::Borrowed(image) };
        let rounds = limited(rounds(&seen));
        for grid in Grids::new(&rounds) {
            let largest = (grid.len() > best[1] || best[0] == 0).then(|| grid.clone());
            let whole = trimmed(grid, expected).into_iter().find_map(|grid| numbered(&grid, &rounds, circles, layout));
            if let Some(found) = whole {
                return Ok(found);
            }
            if let Some(grid) = largest {
                best = [rounds.len(), grid.len()];
                instead = other(&grid, &rounds, circles);
            }
        }
    }
    Err(NotFound::NoGrid { round: best[0], largest: best[1], expected, instead })
}

/// The grid if it has as many as expected. If it has one more: what is left without one of those at its border, something beside the board.
fn trimmed(grid: Grid, expected: usize) -> Vec<Grid> {
    if grid.len() == expected {
        return vec![grid];
    }
    let neighbours =
        |[i, j]: [i32; 2]| [[i + 1, j], [i - 1, j], [i, j + 1], [i, j - 1]].iter().filter(|place| grid.contains_key(*place)).count();
    let loose = grid.keys().filter(|place| grid.len() == expected + 1 && neighbours(**place) < 3);
    let without = |place: &[i32; 2]| grid.iter().filter(|(other, _)| *other != place).map(|(place, index)| (*place, *index)).collect();
    loose.map(without).collect()
}

/// Kind and counts of the grid of circles that a grid is, the larger number of a symmetric one first; `None` if it is no whole one.
fn other(grid: &Grid, rounds: &[Round], circles: &Circles) -> Option<String> {
    let counts = |asymmetric: bool| {
        let rows = 2..=grid.len() / 2;
        let all = rows.filter(|rows| grid.len().is_multiple_of(*rows)).map(move |rows| (grid.len() / rows, rows));
        all.filter(move |(columns, rows)| asymmetric || columns >= rows).map(move |(columns, rows)| Circles {
            columns,
            rows,
            asymmetric,
            ..*circles
        })
    };
    let is_whole = |one: &Circles| {
        let layout = Board::Circles(*one).layout();
        layout.is_ok_and(|layout| numbered(grid, rounds, one, &layout).is_some())
    };
    let whole = counts(false).chain(counts(true)).find(is_whole)?;
    Some(format!("{}:{}x{}", Board::Circles(whole).kind(), whole.columns, whole.rows))
}

fn negative(image: &Image) -> Image<'static> {
    Image::new(image.width(), image.height(), image.grey().iter().map(|grey| 1.0 - grey).collect())
}

/// The circles in the order of the layout, in the one of the orders that are possible whose first is nearest to the image's upper left.
fn numbered(grid: &Grid, rounds: &[Round], circles: &Circles, layout: &Layout) -> Option<Found> {
    let mut best: Option<(f64, Vec<Point>, Homography)> = None;
    for basis in bases() {
        let Some(order) = ordered(grid, basis, circles) else { continue };
        let points: Vec<Point> = order.iter().map(|index| rounds[*index].at).collect();
        let pairs: Vec<(Point, Point)> = layout.points.iter().map(|point| point.at).zip(points.iter().copied()).collect();
        let Some(map) = Homography::fitted(&pairs) else { continue };
        // The board's v is up, the image's y is down.
        let seen_from_front = layout.points.iter().all(|point| map.linear(point.at).determinant() < 0.0);
        let far = length(points[0]);
        let seen: Vec<&Round> = order.iter().map(|index| &rounds[*index]).collect();
        if seen_from_front && is_plane(&seen, &map, layout, circles.spacing) && best.as_ref().is_none_or(|(least, ..)| far < *least) {
            best = Some((far, points, map));
        }
    }
    let (_, points, map) = best?;
    let listed = layout.points.iter().zip(points).enumerate();
    let points: Vec<_> = listed.map(|(index, (point, at))| found(index, point, at, map.linear(point.at))).collect();
    Some(Found { markers: points.len(), points, doubts: Vec::new() })
}

/// Whether areas lie and are as large as on a plane that is seen in perspective, but for some bend of the lens.
fn is_plane(seen: &[&Round], map: &Homography, layout: &Layout, spacing: f64) -> bool {
    let scales: Vec<f64> = layout.points.iter().map(|point| map.linear(point.at).determinant().abs()).collect();
    let mut sizes: Vec<f64> = seen.iter().zip(&scales).map(|(round, scale)| round.area / scale).collect();
    let off = |((round, scale), point): ((&&Round, &f64), &BoardPoint)| distance(round.at, map.at(point.at)) / (spacing * scale.sqrt());
    let far = seen.iter().zip(&scales).zip(&layout.points).map(off).fold(0.0, f64::max);
    sizes.sort_unstable_by(f64::total_cmp);
    far < BEND && sizes[sizes.len() - 1] < SIZES * sizes[0]
}

/// The grid's areas in the order of the layout, if their places in this basis are the board's.
fn ordered(grid: &Grid, [a, b]: [[i32; 2]; 2], circles: &Circles) -> Option<Vec<usize>> {
    let place = |[i, j]: [i32; 2]| {
        let [m, n] = [a[0] * i + a[1] * j, b[0] * i + b[1] * j];
        if circles.asymmetric { [m + n, m - n] } else { [m, n] }
    };
    let low = |axis: usize| grid.keys().map(|key| place(*key)[axis]).min();
    let (x0, y0) = (low(0)?, low(1)?);
    let mut order = vec![None; circles.columns * circles.rows];
    for (key, index) in grid {
        let [x, y] = place(*key);
        let (x, row) = ((x - x0) as usize, (y - y0) as usize);
        let column = if circles.asymmetric {
            let twice = x.checked_sub(row % 2)?;
            twice.is_multiple_of(2).then_some(twice / 2)?
        } else {
            x
        };
        if column >= circles.columns || row >= circles.rows {
            return None;
        }
        order[row * circles.columns + column] = Some(*index);
    }
    order.into_iter().collect()
}
