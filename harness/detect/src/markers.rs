//! Boards with square markers.

use calibench_model::boards::{Board, Dictionary, Layout, Marker};
use calibench_model::{Image, TargetKind};

use crate::arrange::{self, Arranged, Mark, arrange};
use crate::cells::{Form, Sight, read};
use crate::corners;
use crate::ground::Ground;
use crate::instead;
use crate::patches::Patches;
use crate::plane::{Homography, Point, distance, mean, minus, plus, times};
use crate::quads::{adjusted, quad};
use crate::reasons;
use crate::smooth::smoothed;
use crate::{Doubt, Found, NotFound};

/// Where between dark (0) and light (1) areas end. At the lower one those that touch by their corners come apart, however blurred; at the upper one narrow frames hold together.
const LEVELS: [f32; 2] = [0.3, 0.5];
/// The least side of a dark quadrangle, by its pixels' centres, px.
const LEAST_SIDE: f64 = 8.0;

/// So many others say what a marker looks like, to so many px and so large a fraction of its side at each corner.
const WITNESSES: usize = 6;
const BENT: [f64; 2] = [1.0, 0.05];
/// Where the others themselves are no plane's picture, a marker beside them may be by so many times the root mean square of what that leaves further off.
const LENS: f64 = 2.5;

/// A marker of the board that was read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    pub id: u32,
    /// Wrong cells.
    pub wrong: u32,
    /// Its corners, in the marker's own order, px.
    pub corners: [Point; 4],
    /// An index into the layout's markers.
    pub index: usize,
    /// From the board to the image.
    pub map: Homography,
    /// Light less dark, fraction of full scale.
    pub contrast: f64,
}

/// What a board's markers are.
pub(crate) struct Markers<'a> {
    pub layout: &'a Layout,
    pub dictionary: &'static Dictionary,
    pub form: Form,
}

impl<'a> Markers<'a> {
    pub(crate) fn new(board: &Board, layout: &'a Layout) -> Option<Self> {
        let (dictionary, border) = board.dictionary()?;
        Some(Self { layout, dictionary, form: Form { side: dictionary.side, border } })
    }

    /// The side of a marker, object units.
    pub(crate) fn size(&self) -> f64 {
        self.layout.markers.first().map_or(0.0, |marker| distance(marker.corners[0], marker.corners[1]))
    }

    fn index(&self, id: u32) -> Option<usize> {
        let first = self.layout.markers.first()?.id;
        let index = id.checked_sub(first)? as usize;
        self.layout.markers.get(index).filter(|marker| marker.id == id).map(|_| index)
    }
}

/// The markers among `sights`: those of the board, and the ids of others, ascending.
pub(crate) fn identified(sights: &[Sight], of: &Markers) -> (Vec<Seen>, Vec<u32>) {
    let (mut seen, mut foreign): (Vec<Seen>, Vec<u32>) = (Vec::new(), Vec::new());
    for sight in sights {
        let Some((id, wrong, corners)) = sight.identify(of.dictionary) else { continue };
        let Some(index) = of.index(id) else {
            foreign.push(id);
            continue;
        };
        let Some(map) = Homography::of_square(of.layout.markers[index].corners, corners) else { continue };
        let marker = Seen { id, wrong, corners, index, map, contrast: sight.contrast };
        let reach = 0.3 * sight.least_side();
        match seen.iter_mut().find(|other| other.id == id && distance(mean(&other.corners), mean(&corners)) < reach) {
            Some(other) if other.wrong <= wrong => {}
            Some(other) => *other = marker,
            None => seen.push(marker),
        }
    }
    foreign.sort_unstable();
    foreign.dedup();
    (seen, foreign)
}

/// The markers of `seen` that stand to each other as the board has them.
///
/// # Errors
/// As of [`arrange`].
pub(crate) fn arranged(seen: &[Seen], of: &Markers) -> Result<Arranged, NotFound> {
    arrange(&marks(seen, of), of.size())
}

fn marks(seen: &[Seen], of: &Markers) -> Vec<Mark> {
    let mark = |seen: &Seen| {
        let plate = mean(&corners_of(&of.layout.markers[seen.index]));
        Mark { id: seen.id, plate, at: seen.map.at(plate), linear: Some(seen.map.linear(plate)) }
    };
    seen.iter().map(mark).collect()
}

fn corners_of(marker: &Marker) -> [Point; 4] {
    marker.corners
}

/// Dark quadrangles of the image, their sides adjusted to its edges.
pub(crate) fn quadrangles(image: &Image, form: Form) -> Vec<[Point; 4]> {
    let ground = Ground::new(image);
    let sides = [LEAST_SIDE as u32, image.width().max(image.height()) as u32];
    let mut all = Vec::new();
    for level in LEVELS {
        let patches = Patches::new(image, &ground, level, sides);
        let quads = patches.iter().filter_map(|runs| quad(runs, LEAST_SIDE));
        all.extend(quads.filter_map(|corners| adjusted(image, &corners, reach(&corners, form.all()))));
    }
    all
}

/// The frames of this form among quadrangles, each once.
pub(crate) fn frames(image: &Image, quadrangles: &[[Point; 4]], form: Form) -> Vec<Sight> {
    let mut sights: Vec<Sight> = Vec::new();
    for sight in quadrangles.iter().filter_map(|corners| read(image, corners, form)) {
        let same = |other: &Sight| other.cells == sight.cells && distance(other.middle(), sight.middle()) < 1.0;
        if !sights.iter().any(same) {
            sights.push(sight);
        }
    }
    sights
}

/// The points of a board with markers.
pub(crate) fn detect(image: &Image, board: &Board, layout: &Layout) -> Result<Found, NotFound> {
    let of = Markers::new(board, layout).expect("a board with markers");
    let quadrangles = quadrangles(image, of.form);
    let sights = frames(image, &quadrangles, of.form);
    let (seen, foreign) = identified(&sights, &of);
    let arranged = reasons::checked(image, &quadrangles, &sights, &seen, &foreign, &of);
    let arranged = arranged.map_err(|why| instead::named(why, board, &sights))?;
    if !arranged.strays.is_empty()
        && let Some(other) = instead::better(board, &sights, arranged.kept.len())
    {
        return Err(NotFound::OtherArrangement { marks: seen.len(), together: arranged.kept.len(), instead: Some(other) });
    }
    let mut doubts: Vec<Doubt> = arranged.strays.iter().map(|index| Doubt::Stray { id: seen[*index].id }).collect();
    doubts.extend(foreign.iter().map(|id| Doubt::Foreign { id: *id }));
    let mut found = located(image, board, layout, arranged.kept.iter().map(|index| seen[*index]).collect())?;
    doubts.append(&mut found.doubts);
    Ok(Found { doubts, ..found })
}

/// The points of each of several boards with the same markers, if there are several; the largest first, with what is in doubt of all of them.
pub(crate) fn detect_all(image: &Image, board: &Board, layout: &Layout) -> Option<Vec<Found>> {
    let of = Markers::new(board, layout)?;
    let sights = frames(image, &quadrangles(image, of.form), of.form);
    let (seen, foreign) = identified(&sights, &of);
    let boards = arrange::boards(&marks(&seen, &of), of.size());
    let is_free = |index: &usize| !boards.iter().any(|own| own.contains(index));
    let mut doubts: Vec<Doubt> = (0..seen.len()).filter(is_free).map(|index| Doubt::Stray { id: seen[index].id }).collect();
    doubts.extend(foreign.iter().map(|id| Doubt::Foreign { id: *id }));
    let of_board = |own: &Vec<usize>| located(image, board, layout, own.iter().map(|index| seen[*index]).collect()).ok();
    let mut all: Vec<Found> = boards.iter().filter_map(of_board).filter(|found| !found.points.is_empty()).collect();
    if all.len() < 2 {
        return None;
    }
    all[0].doubts.extend(doubts);
    Some(all)
}

/// The points of markers that stand as the board has them, those that are seen twice or look otherwise left out and in doubt.
fn located(image: &Image, board: &Board, layout: &Layout, kept: Vec<Seen>) -> Result<Found, NotFound> {
    let (kept, twice) = once(kept);
    let mut doubts: Vec<Doubt> = twice.into_iter().map(|id| Doubt::Twice { id }).collect();
    let (kept, bent): (Vec<Seen>, Vec<Seen>) = kept.iter().partition(|marker| stands(marker, &kept, layout));
    doubts.extend(bent.into_iter().map(|marker| Doubt::Stray { id: marker.id }));
    let points = match board {
        Board::Charuco(charuco) => corners::of_squares(image, layout, &kept, charuco.square)?,
        _ if layout.points.iter().all(|point| point.kind == TargetKind::Corner) => {
            corners::of_markers(image, layout, &smoother(image, board, layout, &kept))
        }
        _ => corners::of_markers(image, layout, &kept),
    };
    Ok(Found { points, markers: kept.len(), doubts, light: false })
}

/// Markers that stand alone, whose sides alone tell their corners, adjusted once more to the edges of a smoothed image: noise moves those of a blurred one.
fn smoother(image: &Image, board: &Board, layout: &Layout, kept: &[Seen]) -> Vec<Seen> {
    let cells = board.dictionary().map_or(1, |(dictionary, border)| dictionary.side + 2 * border);
    let smooth = smoothed(image);
    let one = |seen: &Seen| {
        let corners = adjusted(&smooth, &seen.corners, reach(&seen.corners, cells))?;
        Some(Seen { corners, map: Homography::of_square(layout.markers[seen.index].corners, corners)?, ..*seen })
    };
    kept.iter().map(|seen| one(seen).unwrap_or(*seen)).collect()
}

/// How far from its sides the edges of a marker of so many cells are looked for, px.
fn reach(corners: &[Point; 4], cells: usize) -> f64 {
    let side = (0..4).map(|i| distance(corners[i], corners[(i + 1) % 4])).fold(f64::INFINITY, f64::min);
    (0.45 * side / cells as f64).clamp(1.5, 5.0)
}

/// Whether a marker looks as the nearest others have it, wherever it is: something beside a marker may have been taken for a part of it. That it is where it can be
/// its neighbours have said; at the rim of a frame the lens puts it elsewhere than a homography of the others.
fn stands(marker: &Seen, all: &[Seen], layout: &Layout) -> bool {
    let printed = |seen: &Seen| layout.markers[seen.index].corners;
    let middle = mean(&printed(marker));
    let mut others: Vec<(f64, &Seen)> =
        all.iter().filter(|other| other.index != marker.index).map(|other| (distance(mean(&printed(other)), middle), other)).collect();
    others.sort_by(|a, b| a.0.total_cmp(&b.0));
    others.truncate(WITNESSES);
    let pairs: Vec<(Point, Point)> = others.iter().flat_map(|(_, other)| printed(other).into_iter().zip(other.corners)).collect();
    let Some(map) = Homography::fitted(&pairs).filter(|_| others.len() == WITNESSES) else { return true };
    let side = distance(marker.corners[0], marker.corners[2]) / std::f64::consts::SQRT_2;
    let left = pairs.iter().map(|(plate, at)| distance(map.at(*plate), *at).powi(2)).sum::<f64>() / pairs.len() as f64;
    let limit = (BENT[1] * side).max(BENT[0]) + LENS * left.sqrt();
    let off: Vec<Point> = printed(marker).into_iter().zip(marker.corners).map(|(plate, at)| minus(at, map.at(plate))).collect();
    let shift = times(off.iter().fold([0.0, 0.0], |sum, off| plus(sum, *off)), 0.25);
    off.into_iter().all(|off| distance(off, shift) < limit)
}

/// The markers that are seen once, by their ids, and the ids of the others.
fn once(mut seen: Vec<Seen>) -> (Vec<Seen>, Vec<u32>) {
    seen.sort_by_key(|marker| marker.id);
    let mut twice: Vec<u32> = seen.windows(2).filter(|pair| pair[0].id == pair[1].id).map(|pair| pair[0].id).collect();
    twice.dedup();
    seen.retain(|marker| !twice.contains(&marker.id));
    (seen, twice)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    /// id, four corners: lines of the reference file, whose pixels have their centres at halves.
    fn reference(text: &str) -> Vec<(u32, [Point; 4])> {
        let numbers = |line: &str| -> Vec<f64> {
            line.split(|c: char| !(c.is_ascii_digit() || c == '.'))
                .filter(|part| !part.is_empty())
                .map(|part| part.parse().unwrap())
                .collect()
        };
        let entry = |all: Vec<f64>| (all[0] as u32, [1, 3, 5, 7].map(|k| [all[k] - 0.5, all[k + 1] - 0.5]));
        text.lines().map(numbers).filter(|all| all.len() == 9).map(entry).collect()
    }

    /// All markers of a board, 100 px a square, under a barrel distortion, px^-2.
    fn distorted(board: &Board, layout: &Layout, barrel: f64) -> Vec<Seen> {
        let lens = |[u, v]: Point| {
            let [x, y] = [u - 400.0, 300.0 - v];
            let factor = 1.0 - barrel * (x * x + y * y);
            [700.0 + x * factor, 500.0 + y * factor]
        };
        let of = Markers::new(board, layout).unwrap();
        let seen = |(index, marker): (usize, &Marker)| {
            let corners = marker.corners.map(lens);
            let map = Homography::of_square(of.layout.markers[index].corners, corners).unwrap();
            Seen { id: marker.id, wrong: 0, corners, index, map, contrast: 0.8 }
        };
        layout.markers.iter().enumerate().map(seen).collect()
    }

    #[test]
    fn the_lens_bends_no_marker_and_what_is_taken_for_a_part_of_one_does() {
        let board: Board = "charuco:10x7:100:70:DICT_4X4_50".parse().unwrap();
        let layout = board.layout().unwrap();
        // It moves the rim by some 45 px.
        let strong = 2.4e-7;
        let seen = distorted(&board, &layout, strong);
        let bent: Vec<u32> = seen.iter().filter(|marker| !stands(marker, &seen, &layout)).map(|marker| marker.id).collect();
        assert!(bent.is_empty(), "{bent:?}");
        for (marker, corner, barrel, by) in
            [(0, 0, 0.0, 7.0), (4, 1, 0.0, 7.0), (17, 2, 1e-8, 7.0), (34, 3, 1e-8, 7.0), (34, 3, strong, 25.0)]
        {
            let mut seen = distorted(&board, &layout, barrel);
            seen[marker].corners[corner][0] += by;
            assert!(!stands(&seen[marker], &seen, &layout), "marker {marker}, corner {corner}");
        }
    }

    #[test]
    fn the_tags_of_a_photograph_are_those_of_its_reference() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/targets/apriltag_33369213973_9d9bb4cc96_c");
        let (picture, text) = (path.with_extension("jpg"), path.with_extension("txt"));
        let (Ok(read), Ok(text)) = (image::open(&picture), std::fs::read_to_string(&text)) else {
            eprintln!("skipped: there is no {} with its text", picture.display());
            return;
        };
        let read = read.to_luma32f();
        let image = Image::new(read.width() as usize, read.height() as usize, read.into_raw());
        let (dictionary, form) = (Dictionary::named("DICT_APRILTAG_36h11").unwrap(), Form { side: 6, border: 1 });
        let sights = frames(&image, &quadrangles(&image, form), form);
        let found: Vec<(u32, [Point; 4])> =
            sights.iter().filter_map(|sight| sight.identify(dictionary)).map(|(id, _, corners)| (id, corners)).collect();
        assert!(found.iter().all(|(id, _)| *id == 0));
        let reference = reference(&text);
        assert_eq!(reference.len(), 12);
        for (_, corners) in &reference {
            let near = |corner: &Point| found.iter().flat_map(|(_, own)| own).any(|own| distance(*own, *corner) < 1.0);
            assert!(corners.iter().all(near), "{corners:?}");
        }
    }
}
