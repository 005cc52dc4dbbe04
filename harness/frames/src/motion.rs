//! How fast a board moves through a video.

use calibench_model::upper_median;

use crate::Frame;
use crate::choice::apart;

/// By how much the board moves from each of the `chosen` frames (places in `frames`) to the next or from the one before, whichever is less, px RMS a frame: the median
/// over those that have a neighbour, and the most. `None` where none has.
///
/// Where rows are exposed one after the other, up to so much of it is in the points.
pub fn motion(frames: &[Frame], chosen: &[usize]) -> Option<(f64, f64)> {
    let of = |&place: &usize| {
        let frame = &frames[place];
        let neighbours = [place.checked_sub(1), Some(place + 1)].into_iter().flatten().filter_map(|other| frames.get(other));
        let near = neighbours.filter(|other| other.number.abs_diff(frame.number) == 1);
        near.filter_map(|other| apart(frame, other)).min_by(f64::total_cmp)
    };
    let all: Vec<f64> = chosen.iter().filter_map(of).collect();
    let most = all.iter().copied().max_by(f64::total_cmp)?;
    Some((upper_median(all)?, most))
}

#[cfg(test)]
mod tests {
    use calibench_model::PixelPoint;

    use super::*;
    use crate::Seen;

    #[test]
    fn a_board_moves_as_far_as_to_the_nearer_of_its_neighbours() {
        let frame = |number: usize, x: f64| {
            let seen = |target: usize| Seen { board: 0, target, at: PixelPoint::new(x + target as f64, 5.0) };
            Frame { number, seen: (0..4).map(seen).collect(), width: 2.0 }
        };
        let frames = [frame(0, 0.0), frame(1, 3.0), frame(2, 10.0), frame(9, 11.0)];
        assert_eq!(motion(&frames, &[0]), Some((3.0, 3.0)));
        assert_eq!(motion(&frames, &[1, 2]), Some((7.0, 7.0)));
        assert_eq!(motion(&frames, &[0, 1, 2]), Some((3.0, 7.0)));
        assert_eq!(motion(&frames, &[3]), None, "seven frames later");
        assert_eq!(motion(&frames, &[]), None);
    }
}
