//! Grids of circles, with an origin or without.

mod dots;
mod fill;
mod placing;
mod spots;
mod unlike;

use std::borrow::Cow;

use calibench_model::Image;
use calibench_model::boards::{Circles, Layout, Marks};

use crate::corners::found;
use crate::found::Doubt;
use crate::lattice::{ALIKE, Grid, Grids, limited};
use crate::plane::{Homography, Point, distance, length};
use crate::round::{Round, areas};
use crate::{Found, NotFound};

use dots::Dots;
use placing::{Misplaced, Placed};

/// How an image is looked at.
#[derive(Clone, Copy)]
struct Look {
    light: bool,
    /// Whether for spots that are too small to be round.
    small: bool,
}

/// Dark circles come first, what is too small to be told from something else last.
const LOOKS: [Look; 4] = [
    Look { light: false, small: false },
    Look { light: true, small: false },
    Look { light: true, small: true },
    Look { light: false, small: true },
];

/// How far circles are from where a homography has them at most, in distances of circles, where it tells how they are seen.
const PLANE: f64 = 0.3;

/// What is seen of circles in an image, and the largest grid that is not the board.
struct Best {
    round: usize,
    largest: usize,
    why: Unfit,
    instead: Option<String>,
}

/// Why a grid is not the board.
#[derive(Clone, Debug, PartialEq)]
enum Unfit {
    Misplaced(Misplaced),
    /// So many distances at most are its circles off where their neighbours have them.
    Bent(f64),
    /// Of other sizes than the others are so many.
    Sizes(usize),
}

/// The circles of a grid: dark on light or, where no such grid is seen, light on dark; discs, then lights and dots of a few pixels.
pub(crate) fn detect(image: &Image, circles: &Circles, layout: &Layout) -> Result<Found, NotFound> {
    let mut best = Best { round: 0, largest: 0, why: Unfit::Misplaced(Misplaced::Counts), instead: None };
    for look in LOOKS {
        let seen = if look.light { Cow::Owned(negative(image)) } else { Cow::Borrowed(image) };
        if let Some(found) = looked(&seen, circles, layout, look, &mut best) {
            return Ok(Found { light: look.light, ..found });
        }
    }
    Err(best.reason(layout.points.len()))
}

/// The board among the grids of one look: the first that is the whole board, or the largest part of it.
fn looked(image: &Image, circles: &Circles, layout: &Layout, look: Look, best: &mut Best) -> Option<Found> {
    let expected = layout.points.len();
    let (areas, rounds) = seen(image, look);
    let mut part: Option<Found> = None;
    for grid in Grids::new(&areas[..rounds], if look.small { f64::INFINITY } else { ALIKE }) {
        let filled = fill::filled(&grid, &areas, 2 * circles.columns * circles.rows);
        let mut why = None;
        let exact = trimmed(&grid, expected).into_iter().chain(trimmed(&filled, expected)).map(|grid| (grid, false));
        for (grid, lenient) in exact.chain([(filled.clone(), true)]) {
            let Some(dots) = Dots::new(&grid, &areas, (!look.small).then_some(image)) else { continue };
            match board(&dots, circles, layout, (look, lenient)) {
                Ok(found) => return Some(found),
                Err(unfit) => why = why.or(Some(unfit)),
            }
        }
        if !circles.marks.is_empty()
            && let Some(dots) = Dots::new(&filled, &areas, (!look.small).then_some(image)).filter(Dots::is_smooth)
        {
            match placing::part(&dots, circles, image) {
                Ok(placed) => {
                    let found = points(&dots, &placed, circles, layout);
                    part = part.filter(|part| part.points.len() >= found.points.len()).or(Some(found));
                }
                Err(misplaced) => why = Some(Unfit::Misplaced(misplaced)),
            }
        }
        let counted = grid.len().max(if filled.len() <= expected { filled.len() } else { 0 });
        if counted > best.largest || best.round == 0 {
            // Circles of another size are no part of the grid, and fill it.
            let other = |grid| Dots::new(grid, &areas, None).and_then(|dots| unlike::other(&dots, circles));
            let instead = other(&grid).or_else(|| other(&filled));
            *best = Best { round: rounds, largest: counted, why: why.unwrap_or(Unfit::Misplaced(Misplaced::Counts)), instead };
        }
    }
    part
}

/// What may be circles, those that are round first, and how many these are.
fn seen(image: &Image, look: Look) -> (Vec<Round>, usize) {
    if look.small {
        let spots = limited(spots::spots(image));
        let count = spots.len();
        return (spots, count);
    }
    let (rounds, others): (Vec<Round>, Vec<Round>) = areas(image).into_iter().partition(|area| area.is_oval && !area.is_cut);
    let mut all = limited(rounds);
    let count = all.len();
    all.extend(limited(others));
    (all, count)
}

/// The board that a grid is as a whole.
fn board(dots: &Dots, circles: &Circles, layout: &Layout, (look, lenient): (Look, bool)) -> Result<Found, Unfit> {
    let ways = placing::whole(dots, circles, lenient).map_err(Unfit::Misplaced)?;
    if !dots.is_smooth() {
        return Err(Unfit::Bent(dots.bend));
    }
    let far = |placed: &Placed| {
        let first = placed.seen.values().next().map(|place| dots.areas[dots.grid[place]].at);
        first.map_or(f64::INFINITY, length)
    };
    let placed = ways.into_iter().min_by(|a, b| far(a).total_cmp(&far(b))).ok_or(Unfit::Misplaced(Misplaced::Counts))?;
    let mut found = points(dots, &placed, circles, layout);
    if circles.marks.is_empty() && !look.small {
        let unlike = unlike::unlike(dots, &placed);
        // Lights are as large as they are bright.
        if unlike.are_many(dots) && !look.light {
            return Err(Unfit::Sizes(unlike.len()));
        }
        if !unlike.are_many(dots) {
            unlike.resize(&mut found.points, circles);
            found.doubts.extend(unlike.doubt(circles));
        }
    }
    Ok(found)
}

/// The points of a grid that lies so on the board.
fn points(dots: &Dots, placed: &Placed, circles: &Circles, layout: &Layout) -> Found {
    let indices: std::collections::HashMap<&str, usize> =
        layout.points.iter().enumerate().map(|(index, point)| (point.id.as_str(), index)).collect();
    let indexed = |([column, row], place): ([usize; 2], [i32; 2])| {
        let index = *indices.get(format!("r{}c{}", row + 1, column + 1).as_str())?;
        Some((index, place, dots.areas[dots.grid[&place]].at))
    };
    let seen: Vec<(usize, [i32; 2], Point)> = placed.iter().filter_map(indexed).collect();
    let map = plane(&seen, layout, circles.spacing);
    let point = |(index, place, at): &(usize, [i32; 2], Point)| {
        let own = &layout.points[*index];
        let linear = map.map_or_else(|| dots.linear(*place, placed.basis, circles.spacing), |map| map.linear(own.at));
        found(*index, own, *at, linear)
    };
    let points: Vec<_> = seen.iter().map(point).collect();
    let mut doubts = Vec::new();
    if placed.absent > 0 && placed.seen.len() + placed.absent == layout.points.len() {
        doubts.push(Doubt::Unseen { corners: placed.absent });
    }
    if placed.beyond > 0 {
        doubts.push(Doubt::Beyond { corners: placed.beyond });
    }
    Found { markers: points.len(), points, doubts, light: false }
}

/// The homography of a board that lies as a plane does, but for some bend of the lens; in wide lenses there is none.
fn plane(seen: &[(usize, [i32; 2], Point)], layout: &Layout, spacing: f64) -> Option<Homography> {
    let pairs: Vec<(Point, Point)> = seen.iter().map(|(index, _, at)| (layout.points[*index].at, *at)).collect();
    let map = Homography::fitted(&pairs)?;
    let off = |(plate, at): &(Point, Point)| distance(*at, map.at(*plate)) / (spacing * map.linear(*plate).determinant().abs().sqrt());
    (pairs.iter().map(off).fold(0.0, f64::max) < PLANE).then_some(map)
}

impl Best {
    fn reason(self, expected: usize) -> NotFound {
        let Self { round, largest, why, instead } = self;
        match why {
            Unfit::Misplaced(Misplaced::Counts) if largest != expected => NotFound::NoGrid { round, largest, expected, instead },
            Unfit::Misplaced(Misplaced::Counts) => NotFound::OtherRows { circles: largest, instead },
            Unfit::Misplaced(Misplaced::Marks) => NotFound::OtherMarks { circles: largest, instead },
            Unfit::Misplaced(Misplaced::Unsure) => NotFound::UnsurePart { circles: largest, expected },
            Unfit::Bent(by) => NotFound::BentGrid { circles: largest, by },
            Unfit::Sizes(unlike) => NotFound::OtherSizes { circles: largest, unlike },
        }
    }
}

/// The grid if it has as many as expected. If it has one more: what is left without one of those at its border, something beside the board.
fn trimmed(grid: &Grid, expected: usize) -> Vec<Grid> {
    if grid.len() == expected {
        return vec![grid.clone()];
    }
    let loose = grid.keys().filter(|place| grid.len() == expected + 1 && fill::beside(grid, **place) < 3);
    let without = |place: &[i32; 2]| grid.iter().filter(|(other, _)| *other != place).map(|(place, index)| (*place, *index)).collect();
    loose.map(without).collect()
}

/// The same board without its marks.
fn unmarked(circles: &Circles) -> Circles {
    Circles { marks: Marks::default(), ..*circles }
}

fn negative(image: &Image) -> Image<'static> {
    Image::new(image.width(), image.height(), image.grey().iter().map(|grey| 1.0 - grey).collect())
}
