//! Which frames of a sequence to calibrate from.

use calibench_model::ControlRow;
use calibench_model::camera::ImageSize;
use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::Frame;
use crate::information::information;

/// Frames that are chosen, at most, where nothing else is said: more lower the standard deviations by their root alone.
pub const USUAL: usize = 40;
/// A frame is blurred whose edges are so many times as wide as those of the sharpest tenth ...
pub const BLURRED: f64 = 1.5;
/// ... and wider than this, px: so wide are the edges of a good photograph.
pub const SHARP_PX: f64 = 3.0;
/// Two frames are alike whose boards lie nearer to each other than this part of the frame's diagonal, RMS.
pub const ALIKE: f64 = 0.01;

/// The frames that are chosen, and what became of the others; all are places in the list of frames that show the board.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Choice {
    /// To calibrate from, in the order of the sequence.
    pub chosen: Vec<usize>,
    /// How many are too blurred.
    pub blurred: usize,
    /// How many show the board as a chosen one does.
    pub alike: usize,
    /// How many are sharp and unlike, and more than are wanted.
    pub spare: usize,
    /// The widest edges that are not blurred, px.
    pub limit_px: f64,
}

/// Chooses at most `most` of `frames`: those that are blurred are left out, then one after the other is taken that adds most to what is known of the camera (D-optimal:
/// the determinant of the normal matrix of the interior orientation, poses being unknown), and frames that are like it are left out.
///
/// `control` are the board's points by [`crate::Seen::target`], object units. The camera is approximated from all that is sharp; what a frame tells depends on where in
/// the picture the board lies, how far away and how tilted it is.
///
/// Source: for the criterion Fedorov 1972, Theory of optimal experiments.
pub fn choose(frames: &[Frame], control: &[ControlRow], size: ImageSize, most: usize) -> Choice {
    let limit_px = limit(frames);
    let mut left: Vec<usize> = (0..frames.len()).filter(|&place| frames[place].width <= limit_px).collect();
    let mut choice = Choice { blurred: frames.len() - left.len(), limit_px, ..Choice::default() };
    let sharp: Vec<&Frame> = left.iter().map(|&place| &frames[place]).collect();
    let (mut known, each) = information(&sharp, control, size);
    // By the place among all.
    let mut told = vec![None; frames.len()];
    left.iter().zip(each).for_each(|(&place, own)| told[place] = Some(own));
    let told = |place: usize, known: &DMatrix<f64>| told[place].as_ref().map_or_else(|| known.clone(), |own| known + own);
    let alike = ALIKE * f64::from(size.width).hypot(f64::from(size.height));
    while choice.chosen.len() < most {
        let gain = |&place: &usize| (place, log_determinant(told(place, &known)));
        let best = left.par_iter().map(gain).collect::<Vec<_>>().into_iter().min_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        let Some((best, _)) = best else { break };
        known = told(best, &known);
        choice.chosen.push(best);
        let before = left.len();
        left.retain(|&place| place != best && apart(&frames[best], &frames[place]).is_none_or(|far| far > alike));
        choice.alike += before - left.len() - 1;
    }
    choice.spare = left.len();
    choice.chosen.sort_unstable();
    choice
}

/// The width of edges beyond which a frame is blurred, px.
fn limit(frames: &[Frame]) -> f64 {
    let mut widths: Vec<f64> = frames.iter().map(|frame| frame.width).collect();
    widths.sort_unstable_by(f64::total_cmp);
    widths.get(widths.len() / 10).map_or(SHARP_PX, |sharp| (BLURRED * sharp).max(SHARP_PX))
}

fn log_determinant(matrix: DMatrix<f64>) -> f64 {
    matrix.cholesky().map_or(f64::NEG_INFINITY, |factor| factor.l_dirty().diagonal().iter().map(|d| d.ln()).sum())
}

/// How far the points that two frames share are apart, px RMS; `None` where they share less than half of what either shows.
pub(crate) fn apart(one: &Frame, other: &Frame) -> Option<f64> {
    let (mut squares, mut shared) = (0.0, 0_usize);
    for seen in &one.seen {
        let key = (seen.board, seen.target);
        if let Ok(place) = other.seen.binary_search_by_key(&key, |seen| (seen.board, seen.target)) {
            squares += seen.at.distance(other.seen[place].at).powi(2);
            shared += 1;
        }
    }
    (shared > 0 && 2 * shared >= one.seen.len().max(other.seen.len())).then(|| (squares / shared as f64).sqrt())
}

#[cfg(test)]
mod tests;
