//! Methods that find a board in a whole image by themselves and number its points.

use std::collections::HashMap;

use calibench_model::boards::{Board, BoardError, Layout};
use calibench_model::{Image, PixelPoint, Rejection};

/// A board that is looked for.
#[derive(Clone, Debug)]
pub struct Sought {
    /// The board.
    pub board: Board,
    /// What is printed on it.
    pub layout: Layout,
}

impl Sought {
    /// The board as it is looked for.
    ///
    /// # Errors
    /// A board that cannot be.
    pub fn new(board: Board) -> Result<Self, BoardError> {
        Ok(Self { board, layout: board.layout()? })
    }
}

/// A point of a board in an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardPointFound {
    /// Its place in [`Layout::points`].
    pub index: usize,
    /// Where, px; the centre of the first pixel is (0, 0).
    pub position: PixelPoint,
}

/// What finds boards in whole images.
pub trait BoardFinder: Send + Sync {
    /// Why it cannot find such a board, if so.
    fn unfit(&self, board: &Board) -> Option<String>;

    /// Where the centre of the first pixel is in the coordinates in which it finds such a board, px, as far as that is known of it: others than zero are the
    /// finder's own mistake, and stay in what it finds unless it is asked to take them out.
    fn origin(&self, _: &Board) -> [f64; 2] {
        [0.0; 2]
    }

    /// How far such a board's points lie away from the middle of the marker whose corners they are, or of the board, px, as far as that is known of it: below zero
    /// what it sees too small.
    fn outwards(&self, _: &Board) -> f64 {
        0.0
    }

    /// The points that it sees, each at most once, in any order.
    ///
    /// # Errors
    /// Why it found nothing.
    fn find(&self, image: &Image, sought: &Sought) -> Result<Vec<BoardPointFound>, Rejection>;

    /// What a reader of its results has to know of how they came about.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }
}

/// What was found, by the names of points.
pub type Named<'n> = Vec<(&'n str, PixelPoint)>;

/// Looks for a board of which points are `expected` by name, about where they are; the names of what is found.
///
/// Where the board's marks say which point is which, these names count. Those of other boards are counted from one of several corners: where every point found has
/// another one of the expected nearest to it, it has its name, otherwise the board's own.
///
/// # Errors
/// Why nothing was found.
pub fn find_named<'n>(
    finder: &dyn BoardFinder,
    (image, sought): (&Image, &'n Sought),
    expected: &[(&'n str, PixelPoint)],
) -> Result<Named<'n>, Rejection> {
    let found = finder.find(image, sought)?;
    if !sought.board.is_coded()
        && let Some(named) = by_place(&found, expected)
    {
        return Ok(named);
    }
    let name = |point: &BoardPointFound| Some((sought.layout.points.get(point.index)?.id.as_str(), point.position));
    Ok(found.iter().filter_map(name).collect())
}

/// Each with the name of the expected point that is nearest; `None` where two have the same.
fn by_place<'n>(found: &[BoardPointFound], expected: &[(&'n str, PixelPoint)]) -> Option<Named<'n>> {
    let nearest = |at: PixelPoint| expected.iter().min_by(|a, b| a.1.distance(at).total_cmp(&b.1.distance(at))).map(|(name, _)| *name);
    let named: HashMap<&str, PixelPoint> = found.iter().filter_map(|point| Some((nearest(point.position)?, point.position))).collect();
    let in_order = expected.iter().filter_map(|(name, _)| Some((*name, *named.get(name)?)));
    (named.len() == found.len()).then(|| in_order.collect())
}

#[cfg(test)]
mod tests {
    use calibench_model::boards::Chessboard;

    use super::*;

    struct Says(Vec<BoardPointFound>);

    impl BoardFinder for Says {
        fn unfit(&self, _: &Board) -> Option<String> {
            None
        }

        fn find(&self, _: &Image, _: &Sought) -> Result<Vec<BoardPointFound>, Rejection> {
            Ok(self.0.clone())
        }
    }

    fn found(places: &[(usize, f64, f64)]) -> Says {
        Says(places.iter().map(|&(index, x, y)| BoardPointFound { index, position: PixelPoint::new(x, y) }).collect())
    }

    const EXPECTED: [(&str, PixelPoint); 3] =
        [("r1c1", PixelPoint { x: 10.0, y: 10.0 }), ("r1c2", PixelPoint { x: 30.0, y: 10.0 }), ("r1c3", PixelPoint { x: 50.0, y: 10.0 })];

    fn names(board: &str, says: &Says) -> Vec<(String, f64)> {
        let (image, sought) = (Image::from_fn(60, 20, |_, _| 0.5), Sought::new(board.parse().unwrap()).unwrap());
        let named = find_named(says, (&image, &sought), &EXPECTED).unwrap();
        named.into_iter().map(|(name, at)| (name.to_owned(), at.x)).collect()
    }

    #[test]
    fn a_board_that_looks_the_same_upside_down_is_numbered_as_it_is_expected() {
        let turned = found(&[(2, 10.2, 10.0), (1, 30.1, 10.0), (0, 49.0, 10.0)]);
        let named = |name: &str, x| (name.to_owned(), x);
        assert_eq!(names("chessboard:3x3:20", &turned), [named("r1c1", 10.2), named("r1c2", 30.1), named("r1c3", 49.0)]);
        // Marks say which is which: what is wrong stays wrong.
        assert_eq!(names("charuco:5x5:20:12:DICT_4X4_50", &turned), [named("r1c3", 10.2), named("r1c2", 30.1), named("r1c1", 49.0)]);
    }

    #[test]
    fn points_are_not_made_fewer_by_being_near_to_the_same() {
        let crowded = found(&[(0, 29.0, 10.0), (1, 31.0, 10.0)]);
        let named = |name: &str, x| (name.to_owned(), x);
        assert_eq!(names("chessboard:3x3:20", &crowded), [named("r1c1", 29.0), named("r1c2", 31.0)]);
    }

    #[test]
    fn what_is_no_point_of_the_board_has_no_name() {
        assert!(names("charuco:5x5:20:12:DICT_4X4_50", &found(&[(99, 1.0, 1.0)])).is_empty());
        assert!(Chessboard { columns: 3, rows: 3, square: 1.0 }.layout().unwrap().points.len() == 9);
    }
}
