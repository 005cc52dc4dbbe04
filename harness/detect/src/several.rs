//! Several boards of one kind in an image.

use std::borrow::Cow;

use calibench_model::boards::Board;
use calibench_model::{Affine, Image, PixelPoint};

use crate::kinds::detect;
use crate::{Doubt, Found, FoundPoint, NotFound, codes, dotted, markers, puzzle};

/// So many boards are looked for.
const MOST: usize = 50;
/// Around a corner of squares so many squares to each side are taken out of the image with its board, and around a circle so much of the way to the next one, at
/// least so many of its diameters.
const SQUARES: f64 = 1.15;
const CIRCLES: f64 = 0.52;
const DISC: f64 = 0.6;

/// The points of each board of this kind that is seen in `image`, from the left by the middles of their points; what [`detect`] has where there is one.
///
/// Boards with the same marks are told apart by where their marks stand to each other, others by taking each that is found out of the image. What no board explains
/// is in doubt of the largest one.
///
/// # Errors
/// As of [`detect`], where there is no board.
pub fn detect_all(image: &Image, board: &Board) -> Result<Vec<Found>, NotFound> {
    let first = detect(image, board);
    let mut all = match several(image, board, &first) {
        Some(all) => all,
        None => vec![first?],
    };
    all.sort_by(|a, b| by_place(a).partial_cmp(&by_place(b)).unwrap_or(std::cmp::Ordering::Equal));
    Ok(all)
}

/// How many points each board of this kind has that is seen in `image`, from the left, where there are several beside what [`detect`] said; nothing where there is
/// one or none.
///
/// Of boards with markers or codes only those are looked for that were in doubt or refused, since marks that are seen twice are.
pub fn seen_several(image: &Image, board: &Board, said: &Result<Found, NotFound>) -> Option<Vec<usize>> {
    let mut all = several(image, board, said)?;
    all.sort_by(|a, b| by_place(a).partial_cmp(&by_place(b)).unwrap_or(std::cmp::Ordering::Equal));
    Some(all.iter().map(|found| found.points.len()).collect())
}

fn by_place(found: &Found) -> [f64; 2] {
    let middle = found.middle();
    [middle.x, middle.y]
}

/// The boards, the largest first, if there are more than one.
fn several(image: &Image, board: &Board, said: &Result<Found, NotFound>) -> Option<Vec<Found>> {
    let layout = board.layout().ok()?;
    let suspected = match said {
        Ok(found) => {
            found.doubts.iter().any(|doubt| matches!(doubt, Doubt::Twice { .. } | Doubt::Stray { .. } | Doubt::TwiceCorners { .. }))
        }
        Err(why) => matches!(why, NotFound::OtherArrangement { .. } | NotFound::OtherSpacing { .. }),
    };
    // A board without ids, or one of them that is seen whole at one scale, leaves no doubt.
    let looked_for = match board {
        Board::Chessboard(_) | Board::Circles(_) => said.is_ok(),
        Board::Dotted(_) | Board::Puzzle(_) => suspected || said.is_ok(),
        Board::Charuco(_) | Board::AprilGrid(_) | Board::GridBoard(_) | Board::Rings(_) => suspected,
    };
    if !looked_for {
        return None;
    }
    let all = match board {
        Board::Chessboard(_) | Board::Circles(_) => peeled(image, board, said.as_ref().ok()?),
        Board::Charuco(_) | Board::AprilGrid(_) | Board::GridBoard(_) => markers::detect_all(image, board, &layout)?,
        Board::Rings(rings) => codes::detect_all(image, rings, &layout)?,
        Board::Dotted(board) => dotted::detect_all(image, board, &layout),
        Board::Puzzle(board) => puzzle::detect_all(image, board, &layout),
    };
    (all.len() > 1).then_some(all)
}

/// One board after the other, each taken out of the image before the next is looked for.
fn peeled(image: &Image, board: &Board, first: &Found) -> Vec<Found> {
    let mut all = vec![first.clone()];
    let mut left: Cow<Image> = Cow::Borrowed(image);
    while let Some(last) = all.last().filter(|_| all.len() < MOST) {
        left = Cow::Owned(without(&left, board, last));
        let Ok(found) = detect(&left, board) else { break };
        // What is left of a board is not another one.
        if all.iter().any(|other| other.holds(found.middle())) {
            break;
        }
        all.push(found);
    }
    all
}

impl Found {
    /// The mean of its points.
    fn middle(&self) -> PixelPoint {
        let count = self.points.len() as f64;
        let sum = self.points.iter().fold([0.0, 0.0], |sum, point| [sum[0] + point.position.x, sum[1] + point.position.y]);
        PixelPoint::new(sum[0] / count, sum[1] / count)
    }

    /// Whether a place lies well among its points.
    fn holds(&self, at: PixelPoint) -> bool {
        let span = |of: fn(&PixelPoint) -> f64| {
            let all = self.points.iter().map(|point| of(&point.position));
            all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
        };
        let middle = self.middle();
        let [x, y] = [span(|at| at.x), span(|at| at.y)];
        (at.x - middle.x).abs() < 0.25 * (x[1] - x[0]) && (at.y - middle.y).abs() < 0.25 * (y[1] - y[0])
    }
}

/// The image with the grey values of its surroundings in place of a board.
fn without(image: &Image, board: &Board, found: &Found) -> Image<'static> {
    let mut grey = image.grey().to_vec();
    let sizes: Vec<f64> = board.layout().map_or_else(|_| Vec::new(), |layout| layout.points.iter().map(|point| point.size).collect());
    // How far around a point its board is taken out, in the point's own size.
    let reach = |point: &FoundPoint| match board {
        Board::Circles(circles) => (CIRCLES * circles.spacing / sizes[point.index]).max(DISC),
        _ => SQUARES,
    };
    let patches: Vec<Patch> = found.points.iter().filter_map(|point| Patch::new(point, reach(point))).collect();
    let mean = {
        let all: Vec<f32> = patches.iter().flat_map(|patch| patch.corners(image)).collect();
        all.iter().sum::<f32>() / all.len().max(1) as f32
    };
    for patch in &patches {
        let corners = patch.corners(image);
        patch.each(image, |index, [s, t]| {
            let along = |a: f32, b: f32| (1.0 - s) * a + s * b;
            grey[index] = match board {
                Board::Circles(_) => (1.0 - t) * along(corners[0], corners[1]) + t * along(corners[3], corners[2]),
                _ => mean,
            };
        });
    }
    Image::new(image.width(), image.height(), grey)
}

/// A parallelogram around a point.
struct Patch {
    middle: PixelPoint,
    affine: Affine,
    determinant: f64,
    reach: f64,
}

impl Patch {
    fn new(point: &FoundPoint, reach: f64) -> Option<Self> {
        let Affine { axx, axy, ayx, ayy } = point.affine;
        let determinant = axx * ayy - axy * ayx;
        (determinant.abs() > 1e-9).then_some(Self { middle: point.position, affine: point.affine, determinant, reach })
    }

    fn at(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let Affine { axx, axy, ayx, ayy } = self.affine;
        [self.middle.x + axx * u + axy * v, self.middle.y + ayx * u + ayy * v]
    }

    fn ends(&self) -> [[f64; 2]; 4] {
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|end: [f64; 2]| self.at(end.map(|value| self.reach * value)))
    }

    /// The grey values at its corners, clockwise in its own axes, at the image's border where these are outside.
    fn corners(&self, image: &Image) -> [f32; 4] {
        let inside = |value: f64, count: usize| (value.round().max(0.0) as usize).min(count - 1);
        self.ends().map(|[x, y]| image.at(inside(x, image.width()), inside(y, image.height())))
    }

    /// Each pixel in it, with its place from 0 to 1 along both axes.
    fn each(&self, image: &Image, mut take: impl FnMut(usize, [f32; 2])) {
        let ends = self.ends();
        let span = |axis: usize, count: usize| {
            let low = ends.iter().map(|end| end[axis]).fold(f64::INFINITY, f64::min).max(0.0);
            let high = ends.iter().map(|end| end[axis]).fold(f64::NEG_INFINITY, f64::max).min(count as f64 - 1.0);
            low.ceil() as usize..(high.floor() + 1.0).max(0.0) as usize
        };
        let Affine { axx, axy, ayx, ayy } = self.affine;
        for y in span(1, image.height()) {
            for x in span(0, image.width()) {
                let [dx, dy] = [x as f64 - self.middle.x, y as f64 - self.middle.y];
                let own = [(ayy * dx - axy * dy) / self.determinant, (axx * dy - ayx * dx) / self.determinant];
                let place = own.map(|value| 0.5 + 0.5 * value / self.reach);
                if place.iter().all(|value| (0.0..=1.0).contains(value)) {
                    take(y * image.width() + x, place.map(|value| value as f32));
                }
            }
        }
    }
}
