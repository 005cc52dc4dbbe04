//! `opencv_find_charuco` and `opencv_find_aprilgrid`: the module `aruco` as it is in OpenCV 4.5 and 4.6.

use std::collections::{HashMap, HashSet};

use calibench_measure::{BoardFinder, BoardPointFound, Settings, Sought};
use calibench_model::boards::{Board, Charuco, Dictionary as Codes};
use calibench_model::{Image, PixelPoint, Rejection};
use opencv::aruco::{
    CORNER_REFINE_APRILTAG, CORNER_REFINE_CONTOUR, CORNER_REFINE_NONE, CharucoBoard, DetectorParameters, Dictionary, detect_markers,
    get_predefined_dictionary_i32, interpolate_corners_charuco_def,
};
use opencv::core::{Mat, Point2f, Ptr, Vector};
use opencv::prelude::DetectorParametersTrait;

use super::is_place;
use crate::chessboard::to_8_bit;
use crate::subpix::pixel;

/// The names of OpenCV's dictionaries, in its order.
const DICTIONARIES: [&str; 21] = [
    "DICT_4X4_50",
    "DICT_4X4_100",
    "DICT_4X4_250",
    "DICT_4X4_1000",
    "DICT_5X5_50",
    "DICT_5X5_100",
    "DICT_5X5_250",
    "DICT_5X5_1000",
    "DICT_6X6_50",
    "DICT_6X6_100",
    "DICT_6X6_250",
    "DICT_6X6_1000",
    "DICT_7X7_50",
    "DICT_7X7_100",
    "DICT_7X7_250",
    "DICT_7X7_1000",
    "DICT_ARUCO_ORIGINAL",
    "DICT_APRILTAG_16h5",
    "DICT_APRILTAG_25h9",
    "DICT_APRILTAG_36h10",
    "DICT_APRILTAG_36h11",
];

/// Where ChArUco corners of 4.6 to 4.13 and AprilTag's refinement have the centre of the first pixel, px: at its corner they have theirs.
/// Source: opencv/opencv_contrib#3024, opencv/opencv#28380.
const HALF: [f64; 2] = [0.5; 2];

/// How far the corners of tags lie outwards by refinement (none, subpix, contour, apriltag), px, on a board seen somewhat from aside: of tags whose corners touch squares,
/// and of tags that stand alone. Without refinement corners of the first lie two pixels inside in x and in y, since the outline that is followed is the inner one, those of
/// the second half a pixel. Alike from 4.6 to 5.0 but for subpix. Source: findings/opencv-aprilgrid-corners.sh, whose tags stand upright.
const OUTWARDS: [[f64; 4]; 2] = [[-2.65, 0.0, -1.99, 0.0], [-0.71, -0.15, -0.71, 0.0]];

fn place_of(dictionary: &Codes) -> Option<i32> {
    DICTIONARIES.iter().position(|name| name.eq_ignore_ascii_case(dictionary.name)).map(|place| place as i32)
}

fn unknown(dictionary: &Codes) -> Option<String> {
    place_of(dictionary).is_none().then(|| format!("OpenCV {} has no {}", crate::version(), dictionary.name))
}

/// Markers by id with their corners, and the 8-bit image that they are in.
struct Seen {
    grey: Mat,
    corners: Vector<Vector<Point2f>>,
    ids: Vector<i32>,
}

fn seen(image: &Image, dictionary: &Ptr<Dictionary>, border: usize, refinement: i32) -> opencv::Result<Seen> {
    let grey = to_8_bit(image)?;
    let mut parameters = DetectorParameters::create()?;
    parameters.set_marker_border_bits(border as i32);
    parameters.set_corner_refinement_method(refinement);
    let (mut corners, mut ids) = (Vector::<Vector<Point2f>>::new(), Vector::<i32>::new());
    let mut rejected = Vector::<Vector<Point2f>>::new();
    detect_markers(&grey, dictionary, &mut corners, &mut ids, &parameters, &mut rejected)?;
    Ok(Seen { grey, corners, ids })
}

/// Each place once: the first that is seen there.
fn once(points: impl Iterator<Item = (usize, PixelPoint)>) -> Vec<BoardPointFound> {
    let mut known = HashSet::new();
    let new = points.filter(|(index, at)| is_place(*at) && known.insert(*index));
    new.map(|(index, position)| BoardPointFound { index, position }).collect()
}

fn moved(at: PixelPoint, by: [f64; 2]) -> PixelPoint {
    PixelPoint::new(at.x - by[0], at.y - by[1])
}

/// The corners between the markers that detectMarkers finds, by interpolateCornersCharuco, without a camera.
///
/// Source: OpenCV, aruco.
pub struct CharucoCorners {
    corrected: bool,
}

impl CharucoCorners {
    pub fn new(settings: &Settings) -> Self {
        Self { corrected: settings.get("corrected") > 0.0 }
    }

    fn shift(&self) -> [f64; 2] {
        if self.corrected { HALF } else { [0.0; 2] }
    }

    fn corners(&self, image: &Image, board: &Charuco) -> opencv::Result<Vec<BoardPointFound>> {
        let dictionary = get_predefined_dictionary_i32(place_of(board.dictionary).unwrap_or(-1))?;
        let Seen { grey, corners, ids } = seen(image, &dictionary, 1, 0)?;
        if ids.is_empty() {
            return Ok(Vec::new());
        }
        let theirs = CharucoBoard::create(board.columns as i32, board.rows as i32, board.square as f32, board.marker as f32, &dictionary)?;
        let (mut found, mut places) = (Vector::<Point2f>::new(), Vector::<i32>::new());
        interpolate_corners_charuco_def(&corners, &ids, &grey, &theirs, &mut found, &mut places)?;
        let point = |(place, at): (i32, Point2f)| (place as usize, moved(pixel(at), self.shift()));
        Ok(once(places.iter().zip(found.iter()).map(point)))
    }
}

impl BoardFinder for CharucoCorners {
    fn unfit(&self, board: &Board) -> Option<String> {
        let Board::Charuco(board) = board else { return Some("it finds ChArUco boards alone".into()) };
        let before = board.legacy && board.rows.is_multiple_of(2);
        let first = (board.first > 0).then(|| "OpenCV's boards begin with marker 0".to_owned());
        let legacy = before.then(|| "since 4.6 OpenCV's boards begin with a dark square".to_owned());
        unknown(board.dictionary).or(first).or(legacy)
    }

    fn origin(&self, _: &Board) -> [f64; 2] {
        if self.corrected { [0.0; 2] } else { HALF }
    }

    fn find(&self, image: &Image, sought: &Sought) -> Result<Vec<BoardPointFound>, Rejection> {
        let Board::Charuco(board) = &sought.board else { return Err(Rejection::NotDetected) };
        self.corners(image, board).ok().filter(|found| !found.is_empty()).ok_or(Rejection::NotDetected)
    }

    fn notes(&self) -> Vec<String> {
        let version = crate::version();
        let note = || {
            format!(
                "OpenCV {version} has ChArUco corners half a pixel to the right and below (opencv/opencv_contrib#3024); `corrected = \"yes\"` takes that out"
            )
        };
        (!self.corrected).then(note).into_iter().collect()
    }
}

/// The corners of the tags of an AprilGrid that detectMarkers finds.
///
/// Source: OpenCV, aruco; Garrido-Jurado et al. 2014.
pub struct TagCorners {
    refinement: i32,
    corrected: bool,
}

impl TagCorners {
    pub fn new(settings: &Settings) -> Self {
        Self { refinement: settings.whole("refinement") as i32, corrected: settings.get("corrected") > 0.0 }
    }

    /// What its refinement is known to be off, px.
    fn known(&self) -> [f64; 2] {
        if self.refinement == CORNER_REFINE_APRILTAG { HALF } else { [0.0; 2] }
    }

    fn corners(&self, image: &Image, sought: &Sought) -> opencv::Result<Vec<BoardPointFound>> {
        let Some((codes, border)) = sought.board.dictionary() else { return Ok(Vec::new()) };
        let dictionary = get_predefined_dictionary_i32(place_of(codes).unwrap_or(-1))?;
        let Seen { corners, ids, .. } = seen(image, &dictionary, border, self.refinement)?;
        let places: HashMap<&str, usize> = sought.layout.points.iter().enumerate().map(|(i, point)| (point.id.as_str(), i)).collect();
        let by = if self.corrected { self.known() } else { [0.0; 2] };
        let of_tag = |(id, four): (i32, Vector<Point2f>)| {
            // Upper left first and clockwise as ArUco reads a tag; ours stand upside down and go round the other way.
            let places = [1, 0, 3, 2].map(|corner| places.get(format!("t{id}c{corner}").as_str()).copied());
            let four: Vec<PixelPoint> = four.iter().map(|at| moved(pixel(at), by)).collect();
            places.into_iter().zip(four).filter_map(|(place, at)| Some((place?, at))).collect::<Vec<_>>()
        };
        Ok(once(ids.iter().zip(corners.iter()).flat_map(of_tag)))
    }
}

impl BoardFinder for TagCorners {
    fn unfit(&self, board: &Board) -> Option<String> {
        let Board::AprilGrid(board) = board else { return Some("it finds AprilGrids alone".into()) };
        unknown(board.dictionary)
    }

    fn origin(&self, _: &Board) -> [f64; 2] {
        if self.corrected { [0.0; 2] } else { self.known() }
    }

    fn outwards(&self, board: &Board) -> f64 {
        let alone = matches!(board, Board::AprilGrid(grid) if grid.squares.is_none());
        OUTWARDS[usize::from(alone)].get(self.refinement as usize).copied().unwrap_or(0.0)
    }

    fn find(&self, image: &Image, sought: &Sought) -> Result<Vec<BoardPointFound>, Rejection> {
        self.corners(image, sought).ok().filter(|found| !found.is_empty()).ok_or(Rejection::NotDetected)
    }

    fn notes(&self) -> Vec<String> {
        let note = match self.refinement {
            CORNER_REFINE_NONE | CORNER_REFINE_CONTOUR => {
                "it has the corners of tags that touch squares up to 2 px inside in x and in y; `refinement = \"subpix\"` mends that"
                    .to_owned()
            }
            CORNER_REFINE_APRILTAG if !self.corrected => {
                "its refinement `apriltag` has corners half a pixel to the right and below; `corrected = \"yes\"` takes that out".to_owned()
            }
            _ => return Vec::new(),
        };
        vec![note]
    }
}
