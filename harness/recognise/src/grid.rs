//! The grid among the lines of an image.

use std::collections::BTreeMap;

use calibench_model::stop;
use nalgebra::Vector2;

use crate::adjust::{Adjusted, adjust, through};
use crate::error::NotRecognised;
use crate::hough::{Line, lines};
use crate::mapping::{Mapping, Unit, by_place, straight};
use crate::order::{Numbered, numbered};
use crate::ridge::Ridge;

/// Bends that are tried, the likely ones first.
const BENDS: [f64; 7] = [0.0, -0.06, 0.06, -0.14, 0.14, -0.24, 0.2];
/// So often the bend of the best grid is tried too, unless it is this near to one that was.
const AGAIN: usize = 2;
const SAME_BEND: f64 = 0.008;
/// Lines of a direction: the cosine of the angle between them, for the perspective.
const ALIKE: f64 = 0.9;
/// Directions of the two sets of lines: the cosine of the angle between them at most.
const ACROSS: f64 = 0.82;
/// Pairs of directions that are tried.
const PAIRS: usize = 4;
/// The share of a side's length in which its line must be seen: blurred lines beside targets are not seen everywhere, and where there is no line a twentieth is.
const COVERED: f64 = 0.15;
/// What the points of lines scatter, px: grids through others scatter more.
const SCATTER: f64 = 0.2;
/// How far a square's inside may seem to leave the image, px.
const BORDER: f64 = 0.3;
/// Sides of a square that must be seen, or lie at the border of the image.
const SIDES: usize = 2;
/// Sides of squares are looked at in pieces of so many px.
const PIECE: f64 = 2.5;
/// A grid of which this share of the sides is seen, and whose points scatter no more than this, px, needs no other try: one that is bent otherwise comes to 0.25.
const ENOUGH: f64 = 0.85;
const SHARP: f64 = 0.2;
/// Squares of a grid, from the middle of the image in any direction.
const FARTHEST: f64 = 40.0;
/// The smallest square, px.
const SMALLEST: f64 = 12.0;

/// A grid in an image.
#[derive(Clone, Debug)]
pub(crate) struct Grid {
    pub adjusted: Adjusted,
    pub sides: Sides,
}

/// The grid through the points of lines of an image of `size` px.
///
/// Where the bend is far from those tried, some lines are not found straight, and the others may be those of a grid two or three times as wide. It has the right
/// bend: with that all lines are found.
///
/// # Errors
/// Too few lines; no grid among them.
pub(crate) fn find(points: &[Ridge], size: [usize; 2]) -> Result<Grid, NotRecognised> {
    let mut search = Search { points, size, best: None, most: 0, tried: Vec::new() };
    for bend in BENDS {
        search.with(bend);
        if search.is_enough() {
            break;
        }
    }
    for _ in 0..AGAIN {
        let Some(bend) = search.best.as_ref().map(|(_, grid)| grid.adjusted.mapping.bend) else { break };
        if search.tried.iter().any(|other| (other - bend).abs() < SAME_BEND) {
            break;
        }
        search.with(bend);
    }
    match search.best {
        Some((score, grid)) if score > 0.0 => Ok(grid),
        _ if search.most < 4 => Err(NotRecognised::TooFewLines { found: search.most }),
        _ => Err(NotRecognised::NoGrid { found: search.most }),
    }
}

/// The best grid so far, with its score, the most lines that any bend showed, and the bends.
struct Search<'a> {
    points: &'a [Ridge],
    size: [usize; 2],
    best: Option<(f64, Grid)>,
    most: usize,
    tried: Vec<f64>,
}

impl Search<'_> {
    /// Looks for straight lines once the image is bent back so.
    fn with(&mut self, bend: f64) {
        self.tried.push(bend);
        let unit = Unit::of(self.size[0], self.size[1]);
        let straightened: Vec<Ridge> = self.points.iter().map(|point| straightened(point, unit, bend)).collect();
        let lines = lines(&straightened, unit.reach * 1.5, self.size[0].min(self.size[1]) as f64);
        self.most = self.most.max(lines.len());
        self.consider(candidates(&lines, unit, bend));
        if !self.is_enough() {
            // A false line may spoil the grid through the others.
            let sharp: Vec<Line> = lines.into_iter().filter(|line| line.rms < SHARP).collect();
            self.consider(candidates(&sharp, unit, bend));
        }
    }

    fn consider(&mut self, mappings: Vec<Mapping>) {
        for mapping in mappings {
            stop::point();
            let Some(grid) = Grid::adjusted(&mapping, self.points, self.size) else { continue };
            let score = grid.sides.score() / (1.0 + (grid.adjusted.rms / SCATTER).powi(2));
            if self.best.as_ref().is_none_or(|(least, _)| score > *least) {
                self.best = Some((score, grid));
            }
        }
    }

    /// Whether no other bend need be tried.
    fn is_enough(&self) -> bool {
        self.best.as_ref().is_some_and(|(_, grid)| grid.is_enough())
    }
}

/// A point where it were without the bend, in px from the middle.
pub(crate) fn straightened(point: &Ridge, unit: Unit, bend: f64) -> Ridge {
    let p = unit.of_px(point.at);
    let q = straight(p, bend) * unit.reach;
    let turned = by_place(p, bend).transpose().try_inverse().map(|inverse| (inverse * Vector2::from(point.normal)).normalize());
    Ridge { at: [q.x, q.y], normal: turned.map_or(point.normal, Into::into), weight: point.weight }
}

/// Grids of two sets of lines, by the best supported directions.
fn candidates(lines: &[Line], unit: Unit, bend: f64) -> Vec<Mapping> {
    let cosine = |a: &Line, b: &Line| (a.normal[0] * b.normal[0] + a.normal[1] * b.normal[1]).abs();
    let mut directions: Vec<&Line> = Vec::new();
    for line in lines {
        if directions.iter().all(|other| cosine(other, line) < ALIKE) {
            directions.push(line);
        }
    }
    let pairs = (0..directions.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
    let across = pairs.filter(|&(i, j)| cosine(directions[i], directions[j]) < ACROSS).take(PAIRS);
    let of = |direction: &Line| {
        let alike: Vec<&Line> = lines.iter().filter(|line| cosine(line, direction) > ALIKE).collect();
        numbered(&alike, direction.normal)
    };
    across.filter_map(|(i, j)| mapping(&of(directions[i])?.0, &of(directions[j])?.0, unit, bend)).collect()
}

/// From the nodes where numbered lines meet; right-handed as seen, the first set of lines the more upright one.
fn mapping(a: &[Numbered], b: &[Numbered], unit: Unit, bend: f64) -> Option<Mapping> {
    let upright = |lines: &[Numbered]| lines.iter().map(|n| n.line.normal[0].abs()).sum::<f64>() / lines.len() as f64;
    let (a, b) = if upright(a) >= upright(b) { (a, b) } else { (b, a) };
    let node = |x: &Numbered, y: &Numbered| x.line.meet(&y.line).map(|at| (at, [x.number as f64, y.number as f64]));
    let nodes: Vec<_> = a.iter().flat_map(|x| b.iter().filter_map(move |y| node(x, y))).collect();
    let found = through(unit, &nodes, bend)?;
    // Numbers may run against x or y.
    let middle = found.to_grid;
    let sign = |row: usize| if middle[(row, row)] - middle[(row, 2)] * middle[(2, row)] < 0.0 { -1.0 } else { 1.0 };
    let (sx, sy) = (sign(0), sign(1));
    let flipped: Vec<_> = nodes.iter().map(|(at, [x, y])| (*at, [sx * x, sy * y])).collect();
    let found = through(unit, &flipped, bend)?;
    let g = found.to_grid;
    let area = (g[(0, 0)] - g[(0, 2)] * g[(2, 0)]) * (g[(1, 1)] - g[(1, 2)] * g[(2, 1)])
        - (g[(0, 1)] - g[(0, 2)] * g[(2, 1)]) * (g[(1, 0)] - g[(1, 2)] * g[(2, 0)]);
    (area > 0.0).then_some(found)
}

impl Grid {
    fn adjusted(start: &Mapping, points: &[Ridge], size: [usize; 2]) -> Option<Self> {
        let adjusted = adjust(start, points)?;
        let sides = Sides::of(&adjusted, size)?;
        Some(Self { adjusted, sides })
    }

    /// Whether it needs no other try.
    fn is_enough(&self) -> bool {
        self.sides.share() > ENOUGH && self.sides.seen() >= 12 && self.adjusted.rms < SHARP
    }

    /// The squares (column, row) that lie wholly in the image, row by row: their insides, `inset` squares from the lines' middles, and enough of their sides are
    /// seen.
    pub fn whole(&self, inset: f64, size: [usize; 2]) -> Vec<[i64; 2]> {
        let mapping = &self.adjusted.mapping;
        let inside = |x: f64, y: f64| mapping.image([x, y]).is_some_and(|at| is_inside(at, size, -BORDER));
        let whole = |&[column, row]: &[i64; 2]| {
            let (x, y) = (column as f64, row as f64);
            let corners = [(inset, inset), (1.0 - inset, inset), (1.0 - inset, 1.0 - inset), (inset, 1.0 - inset)];
            let sides = [(0, column, row), (0, column + 1, row), (1, row, column), (1, row + 1, column)];
            corners.iter().all(|(dx, dy)| inside(x + dx, y + dy))
                && sides.iter().filter(|side| self.sides.is_sound(**side)).count() >= SIDES
        };
        self.sides.squares.iter().copied().filter(whole).collect()
    }
}

fn is_inside([x, y]: [f64; 2], [width, height]: [usize; 2], margin: f64) -> bool {
    x >= margin && y >= margin && x <= width as f64 - 1.0 - margin && y <= height as f64 - 1.0 - margin
}

/// A side of a square: family, number of its line, and along it the square.
type Side = (usize, i64, i64);

/// In how much of each side its line is seen.
#[derive(Clone, Debug)]
pub(crate) struct Sides {
    /// Of those inside the image.
    shares: BTreeMap<Side, f64>,
    /// All squares in the image, in part at least, (column, row), row by row.
    pub squares: Vec<[i64; 2]>,
}

impl Sides {
    fn of(adjusted: &Adjusted, size: [usize; 2]) -> Option<Self> {
        let mapping = &adjusted.mapping;
        let [width, height] = size.map(|side| side as f64 - 1.0);
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for step in 0..=8 {
            let t = f64::from(step) / 8.0;
            for at in [[t * width, 0.0], [t * width, height], [0.0, t * height], [width, t * height]] {
                let Some(grid) = mapping.grid(at) else { continue };
                low = [0, 1].map(|i| low[i].min(grid[i]));
                high = [0, 1].map(|i| high[i].max(grid[i]));
            }
        }
        let middle = mapping.grid(mapping.unit.middle)?;
        let by = mapping.by_grid(middle)?;
        if by.column(0).norm().min(by.column(1).norm()) < SMALLEST {
            return None;
        }
        let bound = |value: f64, i: usize| value.clamp(middle[i] - FARTHEST, middle[i] + FARTHEST).floor() as i64;
        let ranges = [0, 1].map(|i| bound(low[i], i)..=bound(high[i], i));
        let squares: Vec<[i64; 2]> = ranges[1].clone().flat_map(|row| ranges[0].clone().map(move |column| [column, row])).collect();
        let mut pieces = Pieces::new(mapping, size);
        for &[column, row] in &squares {
            for side in [(0, column, row), (0, column + 1, row), (1, row, column), (1, row + 1, column)] {
                pieces.expect(side);
            }
        }
        adjusted.on.iter().for_each(|on| pieces.mark((on.family, on.number, on.along.floor() as i64), on.along - on.along.floor()));
        Some(Self { shares: pieces.shares(), squares })
    }

    fn is_sound(&self, side: Side) -> bool {
        self.shares.get(&side).is_none_or(|share| *share >= COVERED)
    }

    /// How many sides are seen.
    pub fn seen(&self) -> usize {
        self.shares.values().filter(|share| **share >= COVERED).count()
    }

    /// The sides between the outermost ones that are seen.
    fn within(&self) -> impl Iterator<Item = f64> {
        let seen = self.shares.iter().filter(|(_, share)| **share >= COVERED);
        let mut bounds: BTreeMap<(usize, bool), (i64, i64)> = BTreeMap::new();
        for ((family, number, along), _) in seen {
            for (key, value) in [((*family, false), *number), ((*family, true), *along)] {
                let bound = bounds.entry(key).or_insert((value, value));
                *bound = (bound.0.min(value), bound.1.max(value));
            }
        }
        let is = move |(family, number, along): Side| {
            let holds = |key, value: i64| bounds.get(&key).is_some_and(|(low, high)| (*low..=*high).contains(&value));
            holds((family, false), number) && holds((family, true), along)
        };
        self.shares.iter().filter(move |(side, _)| is(**side)).map(|(_, share)| *share)
    }

    /// The share of the sides between the outermost ones that is seen.
    pub fn share(&self) -> f64 {
        let (seen, all) = self.within().fold((0.0, 0.0), |(seen, all), share| (seen + f64::from(u8::from(share >= COVERED)), all + 1.0));
        if all > 0.0 { seen / all } else { 0.0 }
    }

    /// What is seen of the sides between the outermost ones, beyond what is seen where there is no line.
    fn score(&self) -> f64 {
        self.within().map(|share| share - COVERED).sum()
    }
}

/// Sides in pieces.
struct Pieces<'a> {
    mapping: &'a Mapping,
    size: [usize; 2],
    marked: BTreeMap<Side, Vec<bool>>,
}

impl<'a> Pieces<'a> {
    fn new(mapping: &'a Mapping, size: [usize; 2]) -> Self {
        Self { mapping, size, marked: BTreeMap::new() }
    }

    /// A side that should be seen, if it lies inside the image.
    fn expect(&mut self, (family, number, along): Side) {
        let node = |along: i64| {
            let (n, a) = (number as f64, along as f64);
            self.mapping.image(if family == 0 { [n, a] } else { [a, n] })
        };
        let (Some(a), Some(b)) = (node(along), node(along + 1)) else { return };
        if is_inside(a, self.size, 2.0) && is_inside(b, self.size, 2.0) {
            let pieces = ((a[0] - b[0]).hypot(a[1] - b[1]) / PIECE).round().max(3.0);
            self.marked.entry((family, number, along)).or_insert_with(|| vec![false; pieces as usize]);
        }
    }

    fn mark(&mut self, side: Side, part: f64) {
        if let Some(pieces) = self.marked.get_mut(&side) {
            let index = (part * pieces.len() as f64) as usize;
            let last = pieces.len() - 1;
            pieces[index.min(last)] = true;
        }
    }

    fn shares(self) -> BTreeMap<Side, f64> {
        let share = |pieces: &[bool]| pieces.iter().filter(|piece| **piece).count() as f64 / pieces.len() as f64;
        self.marked.into_iter().map(|(side, pieces)| (side, share(&pieces))).collect()
    }
}
