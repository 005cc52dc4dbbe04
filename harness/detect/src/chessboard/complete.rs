//! From a grown grid to a whole rectangle: stray lines go, gaps are filled, and every line of corners that is there is added.

use super::candidates::Saddle;
use super::grow::{Grid, Place, WAYS, fits, foreseen, moved};
use super::level::Level;
use super::sectors::{Steps, contrast};
use crate::plane::{Point, length, mean, minus, plus, times};

/// A line along the border stays if it has this share of its corners.
const KEPT: f64 = 0.5;
/// A line beyond the border is added if this share of its corners is found.
const ADDED: f64 = 0.6;
/// How far a corner that was no candidate may be from where its neighbours have it, as a share of the shorter step; px at least.
const REACH: f64 = 0.22;
const LEAST_REACH: f64 = 1.5;

/// So large a share of the corners may be inferred from the others and from the squares around them.
const INFERRED: f64 = 0.06;

/// The least and the greatest place of a grid on both axes.
pub(super) fn extent(grid: &Grid) -> Option<[Place; 2]> {
    let first = *grid.keys().next()?;
    let merged = |[low, high]: [Place; 2], place: &Place| {
        [[low[0].min(place[0]), low[1].min(place[1])], [high[0].max(place[0]), high[1].max(place[1])]]
    };
    Some(grid.keys().fold([first, first], merged))
}

/// The places of the line at `at` on an axis.
fn line([low, high]: [Place; 2], axis: usize, at: i32) -> Vec<Place> {
    let along = |other: i32| if axis == 0 { [at, other] } else { [other, at] };
    (low[1 - axis]..=high[1 - axis]).map(along).collect()
}

/// The grid as a whole rectangle of at least 2 x 2 corners, with all lines that are seen, at most `most` along an axis; `None` if there are gaps.
pub(super) fn complete(level: &Level, mut grid: Grid, most: usize) -> Option<Grid> {
    trim(&mut grid)?;
    fill(level, &mut grid)?;
    loop {
        let [low, high] = extent(&grid)?;
        if (0..2).any(|axis| (high[axis] - low[axis]) as usize >= most) {
            break;
        }
        let before = grid.len();
        WAYS.iter().for_each(|way| extend(level, &mut grid, *way));
        if grid.len() == before {
            break;
        }
        fill(level, &mut grid)?;
    }
    let [low, high] = extent(&grid)?;
    let whole = (high[0] - low[0] + 1) as usize * (high[1] - low[1] + 1) as usize;
    if grid.len() < whole && (whole - grid.len()) as f64 <= INFERRED * whole as f64 {
        fill_with(&mut grid, |grid, place| inferred(level, grid, place))?;
    }
    (grid.len() == whole).then_some(grid)
}

/// Takes lines along the border away that have few corners; `None` if nothing is left.
fn trim(grid: &mut Grid) -> Option<()> {
    loop {
        let both = extent(grid)?;
        if both[0][0] == both[1][0] || both[0][1] == both[1][1] {
            return None;
        }
        let border = WAYS.iter().map(|(axis, sign)| line(both, *axis, both[usize::from(*sign > 0)][*axis]));
        let share = |line: &Vec<Place>| line.iter().filter(|place| grid.contains_key(*place)).count() as f64 / line.len() as f64;
        let Some(poorest) = border.min_by(|a, b| share(a).total_cmp(&share(b))).filter(|line| share(line) < KEPT) else { return Some(()) };
        grid.retain(|place, _| !poorest.contains(place));
    }
}

/// Fills the gaps inside with corners that are there; some gaps may stay.
fn fill(level: &Level, grid: &mut Grid) -> Option<()> {
    fill_with(grid, |grid, place| sought(level, grid, place))
}

fn fill_with(grid: &mut Grid, corner: impl Fn(&Grid, Place) -> Option<Saddle>) -> Option<()> {
    loop {
        let [low, high] = extent(grid)?;
        let places = (low[0]..=high[0]).flat_map(|u| (low[1]..=high[1]).map(move |v| [u, v]));
        let gaps: Vec<Place> = places.filter(|place| !grid.contains_key(place)).collect();
        let before = grid.len();
        for place in gaps {
            if let Some(corner) = corner(grid, place) {
                grid.insert(place, corner);
            }
        }
        if grid.len() == before {
            return Some(());
        }
    }
}

/// Adds the line beyond the border if it is there.
fn extend(level: &Level, grid: &mut Grid, (axis, sign): (usize, i32)) {
    let Some(both) = extent(grid) else { return };
    let places = line(both, axis, both[usize::from(sign > 0)][axis] + sign);
    let mut wider = grid.clone();
    for place in &places {
        if let Some(corner) = sought(level, &wider, *place) {
            wider.insert(*place, corner);
        }
    }
    if (wider.len() - grid.len()) as f64 >= ADDED * places.len() as f64 {
        *grid = wider;
    }
}

/// Where its neighbours have the corner at a place, and the shortest step to it.
fn expected(grid: &Grid, place: Place) -> Option<(Point, f64)> {
    let back = WAYS.iter().map(|(axis, sign)| (moved(place, *axis, -sign), (*axis, *sign)));
    let all: Vec<(Point, f64)> = back.filter_map(|(from, way)| foreseen(grid, from, way)).collect();
    let step = all.iter().map(|(_, step)| *step).fold(f64::INFINITY, f64::min);
    (!all.is_empty() && step.is_finite()).then(|| (mean(&all.iter().map(|(at, _)| *at).collect::<Vec<Point>>()), step))
}

/// The steps from a point at a place to the corners around.
fn steps(grid: &Grid, place: Place, at: Point) -> Option<Steps> {
    Steps::at(at, |by| grid.get(&[place[0] + by[0], place[1] + by[1]]).map(|saddle| saddle.at))
}

/// The corner at a place, if there is one where its neighbours have it.
pub(crate) fn sought(level: &Level, grid: &Grid, place: Place) -> Option<Saddle> {
    let (at, step) = expected(grid, place)?;
    let corner = Saddle::near(level, at, (REACH * step).max(LEAST_REACH)).filter(|corner| fits(level, grid, place, corner))?;
    contrast(&level.smooth, corner.at, &steps(grid, place, corner.at)?).map(|_| corner)
}

/// The corner at a place where its neighbours have it, if the squares around it are there: the edge of a shadow may hide it.
pub(crate) fn inferred(level: &Level, grid: &Grid, place: Place) -> Option<Saddle> {
    let (at, _) = expected(grid, place)?;
    let steps = steps(grid, place, at)?;
    let contrast = contrast(&level.smooth, at, &steps)?;
    let [u, v] = steps.0.map(|step| times(step, 1.0 / length(step)));
    let middle = if contrast.mean > 0.0 { plus(u, v) } else { minus(u, v) };
    let light = times(middle, 1.0 / length(middle));
    light.iter().all(|part| part.is_finite()).then_some(Saddle { at, light })
}
