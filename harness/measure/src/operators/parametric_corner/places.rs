//! Where the pixels of a window are.

use std::sync::OnceLock;

use super::window::WIDEST;
use crate::lanes::WIDE;

/// Coordinates of pixels from the centre of their window, row by row, with room for whole chunks.
pub(super) struct Places {
    pub(super) x: Vec<f32>,
    pub(super) y: Vec<f32>,
}

impl Places {
    /// Of a window of odd `side`, px: the same for all of that side.
    pub(super) fn of(side: usize) -> &'static Self {
        static PLACES: [OnceLock<Places>; WIDEST + 1] = [const { OnceLock::new() }; WIDEST + 1];
        PLACES[side].get_or_init(|| {
            let (half, room) = ((side / 2) as f32, 0..(side * side).next_multiple_of(WIDE));
            Self { x: room.clone().map(|i| (i % side) as f32 - half).collect(), y: room.map(|i| (i / side) as f32 - half).collect() }
        })
    }
}
