//! Every frame of a sequence, looked at once as it comes.

use std::collections::HashMap;

use calibench_model::camera::ImageSize;
use calibench_model::views::view_of;
use calibench_model::{Image, PixelPoint};
use calibench_photographs::{Finder, Sighting};
use rayon::iter::{ParallelBridge, ParallelIterator};

use crate::{FramesError, edge_width};

/// A point of a board that is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Which of several boards, from the left; 0 of one.
    pub board: usize,
    /// Its place in [`Finder::control`].
    pub target: usize,
    /// Where, to about a pixel.
    pub at: PixelPoint,
}

/// A frame that shows the board.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Its place in the sequence, counted from 0.
    pub number: usize,
    /// What is seen of it, by board and target.
    pub seen: Vec<Seen>,
    /// How wide its edges are, px ([`edge_width`]).
    pub width: f64,
}

/// What was seen of a sequence.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Watched {
    /// How many frames there are.
    pub read: usize,
    /// Those that show the board, in their order.
    pub frames: Vec<Frame>,
    /// The size of all; `None` without any.
    pub size: Option<ImageSize>,
}

/// Looks for the board of `finder` in every frame, each with its name, on all threads: `image` makes grey values of what `stills` gives, and `step` is called after each.
/// As many frames are in memory as there are threads; of those behind them what is seen of the board is kept.
///
/// # Errors
/// The first that `stills` or `image` has, and frames of several sizes.
pub fn watch<S: Send>(
    stills: impl Iterator<Item = Result<(String, S), FramesError>> + Send,
    image: impl Fn(S) -> Result<Image<'static>, FramesError> + Sync,
    finder: &Finder,
    step: &(dyn Fn() + Sync),
) -> Result<Watched, FramesError> {
    let places: HashMap<String, usize> = finder.control().into_iter().enumerate().map(|(place, row)| (row.target, place)).collect();
    let one = |(number, still): (usize, Result<(String, S), FramesError>)| {
        let (name, still) = still?;
        let image = image(still)?;
        let size = ImageSize { width: image.width() as u32, height: image.height() as u32 };
        let found = finder.find(&image, "");
        let width = edge_width(&image, &found.rows);
        step();
        Ok((number, name, size, width.map(|width| Frame { number, seen: seen(&found, &places), width })))
    };
    let mut all: Vec<_> = stills.enumerate().par_bridge().map(one).collect::<Result<_, FramesError>>()?;
    all.sort_unstable_by_key(|(number, ..)| *number);
    let size = all.first().map(|(_, _, size, _)| *size);
    if let Some((before, (_, name, size, _))) = size.and_then(|before| Some((before, all.iter().find(|(_, _, size, _)| *size != before)?)))
    {
        return Err(FramesError::Sizes { name: name.clone(), size: *size, before });
    }
    Ok(Watched { read: all.len(), frames: all.into_iter().filter_map(|(.., frame)| frame).collect(), size })
}

/// The points of a frame without a name, by board and target.
fn seen(found: &Sighting, places: &HashMap<String, usize>) -> Vec<Seen> {
    let boards: HashMap<String, usize> = (0..found.boards.len()).map(|board| (view_of("", board + 1), board)).collect();
    let one = |row: &calibench_model::PointRow| {
        let board = boards.get(&row.image).copied().unwrap_or(0);
        Some(Seen { board, target: *places.get(&row.target)?, at: row.start.position })
    };
    let mut seen: Vec<Seen> = found.rows.iter().filter_map(one).collect();
    seen.sort_unstable_by_key(|seen| (seen.board, seen.target));
    seen
}
