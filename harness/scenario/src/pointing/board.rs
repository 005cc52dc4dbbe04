//! What finds boards, in place of a hand.

use std::collections::HashMap;

use calibench_detect::{detect, warps};
use calibench_model::boards::Board;
use calibench_model::camera::ImageSize;
use calibench_model::{Image, PixelPoint, Start};
use schemars::JsonSchema;
use serde::Deserialize;

use super::DetectorReach;

/// What finds boards, in the place of a hand: operators start at the points of the board that it finds.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(inline)]
pub struct BoardPointingWire {
    /// `board`: what `detect` finds of the testfield, which is a board.
    #[allow(dead_code, reason = "read before, to tell the tables apart")]
    pub detector: BoardKind,
    /// Without marks that can be read nobody knows which point is which: a target takes the nearest point that was found within this distance, px; without one
    /// it is missed. Default 3.
    pub within: Option<DetectorReach>,
}

/// Which detector.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum BoardKind {
    /// What finds boards.
    Board,
}

/// A board that is looked for in the image.
#[derive(Clone, Copy, Debug)]
pub struct BoardPointing {
    /// The board.
    pub board: Board,
    /// A target of a board without readable marks takes the nearest point within this distance, px.
    pub within: f64,
}

impl BoardPointing {
    /// The start that each target gets: the whole pixel where its point was found, its kind, its axes, and what the lens does to it beyond them. A point that was taken for another is another's start.
    ///
    /// Of boards without readable marks, whose points are counted from one of several corners, the truth says which point is meant and nothing more.
    pub(super) fn starts<'t>(&self, image: &Image, targets: impl IntoIterator<Item = (&'t str, PixelPoint)>) -> Vec<Option<Start>> {
        let (Ok(layout), Ok(found)) = (self.board.layout(), detect(image, &self.board)) else {
            return targets.into_iter().map(|_| None).collect();
        };
        let size = ImageSize { width: image.width() as u32, height: image.height() as u32 };
        let warps = warps(&layout, &found, size);
        let start = |place: usize| {
            let point = &found.points[place];
            let position = PixelPoint::new(point.position.x.round(), point.position.y.round());
            Start { kind: Some(layout.points[point.index].kind), affine: Some(point.affine), warp: warps[place], ..Start::at(position) }
        };
        if self.board.is_coded() {
            let id = |place: usize| layout.points[found.points[place].index].id.as_str();
            let starts: HashMap<&str, Start> = (0..found.points.len()).map(|place| (id(place), start(place))).collect();
            return targets.into_iter().map(|(id, _)| starts.get(id).copied()).collect();
        }
        let positions: Vec<PixelPoint> = found.points.iter().map(|point| point.position).collect();
        let nearest = |truth: PixelPoint| {
            let near = truth.nearest(&positions, self.within)?;
            positions.iter().position(|position| *position == near).map(start)
        };
        targets.into_iter().map(|(_, truth)| nearest(truth)).collect()
    }
}
