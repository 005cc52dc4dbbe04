//! Where measuring starts: somebody points, or a detector finds.

mod board;
mod harris;

use std::ops::Range;

use calibench_diagnostics::Problem;
use calibench_model::{Image, PixelPoint, Start};
use calibench_synth::pointing::{Hand, MapError};

pub use board::{BoardPointing, BoardPointingWire};
pub use harris::{HarrisPointing, HarrisWire};

use super::section::Section;
use super::wire::{PointingWire, bounded};

bounded! {
    /// A distance, px.
    DetectorReach(f64), f64 "f64", 0.1, 100.0;
}

/// Where a target takes the nearest detection, px, unless the file says otherwise.
const WITHIN: f64 = 3.0;

/// How far an approximate orientation of the camera turns a target, degrees, and by what part it changes its axes' lengths, where nothing else is said.
const MAP_TURN: f64 = 5.0;
const MAP_STRETCH: f64 = 0.1;

/// Who gives the approximate positions.
#[derive(Clone, Debug)]
pub enum Pointing {
    /// A hand, near the truth.
    Hand {
        /// How well it points.
        hand: Hand,
        /// Whether at targets too of which only a part is in view.
        clipped: bool,
    },
    /// The Harris detector.
    Harris(HarrisPointing),
    /// What finds boards, whichever board the testfield is.
    Board {
        /// Where `detector` stands.
        span: Range<usize>,
        /// As in [`BoardPointing::within`].
        within: f64,
    },
}

/// A detector, which sees the image and nothing else, in the place of a hand.
#[derive(Clone, Debug)]
pub enum Detector {
    /// The Harris detector.
    Harris(HarrisPointing),
    /// What finds a board.
    Board(BoardPointing),
}

impl Pointing {
    /// Reads a pointing table: that of a detector if it names one, otherwise that of a hand.
    pub fn read(section: Section<'_>, problems: &mut Vec<Problem>) -> Option<Self> {
        if let Some((key, value)) = section.table.get_key_value("detector") {
            if value.get_ref().as_str() == Some("board") {
                let span = key.span();
                let wire: BoardPointingWire = section.read(&[], problems)?;
                return Some(Self::Board { span, within: wire.within.map_or(WITHIN, |within| within.0) });
            }
            return section.read::<HarrisWire>(&[], problems).map(|wire| Self::Harris(wire.into()));
        }
        let wire: PointingWire = section.read(&["detector"], problems)?;
        let shakes = wire.sigma.0 > 0.0;
        let usual = |value: f64| if shakes { value } else { 0.0 };
        let turn = wire.map_turn.map_or(usual(MAP_TURN), |turn| turn.0).to_radians();
        let stretch = wire.map_stretch.map_or(usual(MAP_STRETCH), |stretch| stretch.0);
        let hand = Hand { sigma: wire.sigma.0, whole_pixels: wire.whole_pixels, map: MapError { turn, stretch } };
        Some(Self::Hand { hand, clipped: wire.clipped.unwrap_or(false) })
    }
}

impl Detector {
    /// The start that each target, a name and where it truly is, gets in an image; `None` where nothing was found for it.
    pub fn starts<'t>(&self, image: &Image, targets: impl IntoIterator<Item = (&'t str, PixelPoint)>) -> Vec<Option<Start>> {
        match self {
            Self::Harris(harris) => harris.starts(image, targets.into_iter().map(|(_, truth)| truth)),
            Self::Board(board) => board.starts(image, targets),
        }
    }
}
