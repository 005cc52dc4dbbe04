//! Points of a board that are not where their neighbours say they must be.

use std::collections::HashMap;

use calibench_adjust::approximate::homography;
use calibench_model::{ControlRow, PointRow, median};

/// So many neighbours on the board say where a point must be.
const NEIGHBOURS: usize = 8;
/// A point is doubtful that is off by more than this many times the usual distance, and by more than this many px: a lens bends a neighbourhood a little.
const TIMES: f64 = 6.0;
const LEAST_PX: f64 = 1.0;
/// So many of a board are named at most: where more are off the board as a whole is.
const MOST: usize = 20;

/// A place on the board, and in the picture.
type Pair = ([f64; 2], [f64; 2]);

/// The places in `rows` of points that are off the map by which their neighbours are pictured, and how far, px: the worst first. `control` says where the points of the
/// board are; all rows are of one board in one photograph. Each that is found takes no part in judging the others.
pub fn doubtful(rows: &[&PointRow], control: &[ControlRow]) -> Vec<(usize, f64)> {
    let on_board: HashMap<&str, [f64; 2]> = control.iter().map(|row| (row.target.as_str(), [row.position[0], row.position[1]])).collect();
    let pair = |row: &&PointRow| {
        let at = row.start.position;
        on_board.get(row.target.as_str()).map(|place| (*place, [at.x, at.y]))
    };
    let pairs: Vec<Option<Pair>> = rows.iter().map(pair).collect();
    let (mut found, mut left_out) = (Vec::new(), vec![false; rows.len()]);
    while found.len() < MOST {
        let good = |place: usize| pairs[place].filter(|_| !left_out[place]);
        let off: Vec<(usize, f64)> =
            (0..rows.len()).filter_map(|place| Some((place, off(place, good(place)?, &pairs, &left_out)?))).collect();
        let usual = median(off.iter().map(|(_, px)| *px)).unwrap_or(0.0);
        let worst = off.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, px)| *px > LEAST_PX.max(TIMES * usual));
        let Some((place, px)) = worst else { break };
        left_out[place] = true;
        found.push((place, px));
    }
    // What was found after it was among the neighbours that judged the first.
    for (place, px) in &mut found {
        let again = pairs[*place].and_then(|pair| off(*place, pair, &pairs, &left_out));
        *px = again.unwrap_or(*px);
    }
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    found
}

/// How far a point is from where its neighbours have it, px; `None` where they do not say.
fn off(place: usize, (own, at): Pair, pairs: &[Option<Pair>], left_out: &[bool]) -> Option<f64> {
    let distance = |[x, y]: [f64; 2]| (x - own[0]).hypot(y - own[1]);
    let others = pairs.iter().enumerate().filter(|(other, _)| *other != place && !left_out[*other]);
    let mut near: Vec<Pair> = others.filter_map(|(_, pair)| *pair).collect();
    near.sort_by(|a, b| distance(a.0).total_cmp(&distance(b.0)));
    near.truncate(NEIGHBOURS);
    let [x, y] = homography(&near).ok()?.map(own)?;
    Some((x - at[0]).hypot(y - at[1]))
}

#[cfg(test)]
mod tests {
    use calibench_model::{PixelPoint, Start};

    use super::*;

    /// A board of 9 x 6 in perspective, with a lens that bends lines by some pixels.
    fn board() -> (Vec<PointRow>, Vec<ControlRow>) {
        let places = (0..54).map(|i| (i, [f64::from(i % 9), -f64::from(i / 9)]));
        let pictured = |[x, y]: [f64; 2]| {
            let depth = 1.0 + 0.03 * x - 0.02 * y;
            let (u, v) = (40.0 * x / depth, -40.0 * y / depth);
            let bent = 1.0 - 2e-7 * (u - 150.0).hypot(v - 100.0).powi(2);
            PixelPoint::new(100.0 + 150.0 + (u - 150.0) * bent, 80.0 + 100.0 + (v - 100.0) * bent)
        };
        let name = |i: i32| format!("r{}c{}", i / 9 + 1, i % 9 + 1);
        let rows = places.clone().map(|(i, place)| PointRow { image: "a".into(), target: name(i), start: Start::at(pictured(place)) });
        (rows.collect(), places.map(|(i, [x, y])| ControlRow::new(name(i), [x, y, 0.0])).collect())
    }

    #[test]
    fn points_that_are_off_are_named_and_no_others() {
        let (mut rows, control) = board();
        let said = |rows: &[PointRow]| doubtful(&rows.iter().collect::<Vec<_>>(), &control);
        assert!(said(&rows).is_empty());
        // One in the middle, one at a corner, one beside it.
        for (place, by) in [(22, 4.0), (0, 6.0), (1, -3.0)] {
            rows[place].start.position.x += by;
        }
        let found = said(&rows);
        let mut places: Vec<usize> = found.iter().map(|(place, _)| *place).collect();
        places.sort_unstable();
        assert_eq!(places, [0, 1, 22], "{found:?}");
        assert!(
            found.iter().all(|(place, px)| (px - [6.0, 3.0, 4.0][[0, 1, 22].iter().position(|p| p == place).unwrap()]).abs() < 1.0),
            "{found:?}"
        );
        // Of few points nothing is said.
        assert!(said(&rows[..4]).is_empty());
    }
}
