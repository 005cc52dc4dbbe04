//! Boards of markers of which nothing is known.

use calibench_model::Image;
use calibench_model::boards::{AprilGrid, Board, Charuco, Dictionary, GridBoard};
use calibench_model::upper_median;

use crate::Found;
use crate::cells::{Form, Sight};
use crate::instead::instead;
use crate::kinds::proved;
use crate::markers::{Markers, arranged, frames, identified, quadrangles};
use crate::plane::{Homography, Linear, Point, distance, length, mean, minus, plus, times};

/// The form by which sides of quadrangles are adjusted.
const USUAL: Form = Form { side: 6, border: 1 };
/// By chance so many of the frames in an image are markers of a dictionary, at most, where these are believed.
const CHANCE: f64 = 0.01;
/// Two markers see each other at the same place, to this part of their distance.
const AGREE: f64 = 0.25;
/// Neighbours are nearer than so many sides of a marker.
const NEAR: f64 = 8.0;
/// The way to the nearest neighbour is along the markers' sides or across, as this tells: the shorter of its components beside the longer.
const ASLANT: [f64; 2] = [0.35, 0.65];
/// Sides are told to so many parts of the unit.
const PARTS: f64 = 100.0;

/// Which boards the nearest neighbours of markers tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Family {
    /// Neighbours across the corners: a ChArUco board; the side of a square, markers.
    Aslant(f64),
    /// Neighbours beside each other: a grid; the distance of markers, markers.
    Beside(f64),
}

/// The markers of an image.
pub(crate) struct Tags {
    pub dictionary: &'static Dictionary,
    pub form: Form,
    sights: Vec<Sight>,
    /// Frames of this form that were seen.
    all: usize,
}

/// The markers of the dictionary that has most of the frames in an image without a wrong cell; of several dictionaries the first, which is the smallest.
pub(crate) fn tags(image: &Image) -> Option<Tags> {
    let quadrangles = quadrangles(image, USUAL);
    let forms = (4..=7).flat_map(|side| [1, 2].map(|border| Form { side, border }));
    let forms: Vec<(Form, Vec<Sight>)> = forms.map(|form| (form, frames(image, &quadrangles, form))).collect();
    let mut best: Option<(usize, &'static Dictionary, usize)> = None;
    for dictionary in Dictionary::names().filter_map(Dictionary::named) {
        for (place, (_, sights)) in forms.iter().enumerate().filter(|(_, (form, _))| form.side == dictionary.side) {
            let seen = sights.iter().filter(|sight| dictionary.identify(sight.cells, 0).is_some()).count();
            if seen > best.map_or(0, |(most, ..)| most) {
                best = Some((seen, dictionary, place));
            }
        }
    }
    let (_, dictionary, place) = best?;
    let (form, sights) = &forms[place];
    let own: Vec<Sight> = sights.iter().filter(|sight| dictionary.identify(sight.cells, 0).is_some()).copied().collect();
    Some(Tags { dictionary, form: *form, sights: own, all: sights.len() })
}

impl Tags {
    /// Their ids, ascending.
    pub(crate) fn ids(&self) -> Vec<u32> {
        let mut ids: Vec<u32> = self.read().map(|(id, _)| id).collect();
        ids.sort_unstable();
        ids
    }

    /// Whether they are no chance: what is in a frame is a marker of the dictionary by chance with its share of all that could be there.
    pub(crate) fn are_sure(&self) -> bool {
        let cells = self.dictionary.side * self.dictionary.side;
        let share = 4.0 * self.dictionary.codes.len() as f64 / 2_f64.powi(cells as i32);
        share * (self.all as f64) < CHANCE || (self.sights.len() as f64 > 5.0 * (share * self.all as f64).max(0.5))
    }

    fn read(&self) -> impl Iterator<Item = (u32, [Point; 4])> {
        self.sights.iter().filter_map(|sight| sight.identify(self.dictionary)).map(|(id, _, corners)| (id, corners))
    }

    /// The board on which they stand, and what is found of it.
    pub(crate) fn board(&self, image: &Image) -> Option<(Board, Found)> {
        let family = self.family()?;
        let first = self.ids().first().copied()?;
        let found = self.templates(family).into_iter().filter_map(|template| {
            let from = |first: u32| instead(&beginning(template, first)?, &self.sights);
            let (whole, seen) = (from(0), from(first));
            let most = seen.as_ref().map_or(0, |(kept, _)| *kept);
            let whole = whole.filter(|(kept, board)| first == 0 || (*kept >= most && !self.lacks(image, board, first)));
            proved(image, whole.or(seen)?.1)
        });
        // Of those that explain as many points the first.
        found.reduce(|best, other| if other.1.points.len() > best.1.points.len() { other } else { best })
    }

    /// How their nearest neighbours stand to them.
    pub(crate) fn family(&self) -> Option<Family> {
        let all: Vec<(Point, Linear)> = self
            .read()
            .filter_map(|(_, corners)| Some((mean(&corners), Homography::of_unit_square(corners)?.linear([0.5, 0.5]))))
            .collect();
        let way = |a: &(Point, Linear), b: &(Point, Linear)| {
            let apart = minus(b.0, a.0);
            let (one, other) = (a.1.back(apart)?, b.1.back(apart)?);
            let way = times(plus(one, other), 0.5);
            (distance(one, other) < AGREE * length(way) && length(way) < NEAR).then_some(way)
        };
        let nearest = |index: usize| {
            let ways = (0..all.len()).filter(|other| *other != index).filter_map(|other| way(&all[index], &all[other]));
            ways.min_by(|a, b| length(*a).total_cmp(&length(*b)))
        };
        let ways: Vec<[f64; 2]> = (0..all.len()).filter_map(nearest).map(|way| way.map(f64::abs)).collect();
        let slant = |[x, y]: &[f64; 2]| x.min(*y) / x.max(*y);
        let (aslant, beside): (Vec<_>, Vec<_>) =
            (ways.iter().filter(|way| slant(way) > ASLANT[1]).collect(), ways.iter().filter(|way| slant(way) < ASLANT[0]).collect());
        if aslant.len() > beside.len() {
            upper_median(aslant.iter().map(|[x, y]| 0.5 * (x + y))).map(Family::Aslant)
        } else {
            upper_median(beside.iter().map(|[x, y]| x.max(*y))).map(Family::Beside)
        }
    }

    /// Boards of the family, of any counts.
    fn templates(&self, family: Family) -> Vec<Board> {
        let rounded = |value: f64| (PARTS * value).round() / PARTS;
        let (dictionary, border, columns, rows, first) = (self.dictionary, self.form.border, 2, 2, 0);
        match family {
            Family::Aslant(side) => {
                let marker = rounded(side.recip());
                vec![Board::Charuco(Charuco { columns, rows, square: 1.0, marker, dictionary, first, legacy: false })]
            }
            Family::Beside(apart) => {
                let gap = rounded(apart - 1.0);
                let grid = GridBoard { columns, rows, marker: 1.0, separation: gap, dictionary, first, border };
                let kalibr = |squares| AprilGrid { columns, rows, tag: 1.0, spacing: gap, dictionary, first, border, squares };
                let kalibrs = [Some(0.0), None].map(|squares| Board::AprilGrid(kalibr(squares)));
                // Other tags than Kalibr's have no word.
                let kalibrs = kalibrs.into_iter().filter(|_| dictionary.name == "DICT_APRILTAG_36h11");
                std::iter::once(Board::GridBoard(grid)).chain(kalibrs).collect()
            }
        }
    }

    /// Whether a board whose markers before the first that is seen would mostly be in view is not this one.
    fn lacks(&self, image: &Image, board: &Board, first: u32) -> bool {
        let Ok(layout) = board.layout() else { return true };
        let Some(of) = Markers::new(board, &layout) else { return true };
        let (seen, _) = identified(&self.sights, &of);
        let Ok(arranged) = arranged(&seen, &of) else { return true };
        let own = arranged.kept.iter().map(|index| &seen[*index]);
        let pairs: Vec<(Point, Point)> = own.flat_map(|seen| layout.markers[seen.index].corners.into_iter().zip(seen.corners)).collect();
        let Some(map) = Homography::fitted(&pairs) else { return true };
        let before = layout.markers.iter().filter(|marker| marker.id < first).map(|marker| map.at(mean(&marker.corners)));
        let inside = |at: &Point| image.holds(at[0].round() as i64, at[1].round() as i64, 1);
        2 * before.filter(inside).count() > first as usize
    }
}

/// The board with another first marker.
fn beginning(board: Board, first: u32) -> Option<Board> {
    Some(match board {
        Board::Charuco(board) => Board::Charuco(Charuco { first, ..board }),
        Board::AprilGrid(board) => Board::AprilGrid(AprilGrid { first, ..board }),
        Board::GridBoard(board) => Board::GridBoard(GridBoard { first, ..board }),
        _ => return None,
    })
}
