//! Whether marks stand to each other as the board has them.

use calibench_model::upper_median;

use crate::NotFound;
use crate::plane::{Homography, Linear, Point, cross, distance, dot, minus, plus, times};

/// So many of the ids nearest to a mark's are looked at.
const NEAREST: usize = 6;
/// How far a neighbour may be from where two marks have it, as a fraction of its distance: across, and along.
const ACROSS: f64 = 0.2;
const ALONG: f64 = 0.25;
/// Marks that no neighbour reaches belong to the others if they are so near to where a homography of those has them, in distances of marks.
const REACHED: f64 = 0.35;
/// Beside marks that agree with nothing it takes so many that agree with each other; a group of others that agree is a rival from this part of them on.
const LEAST: usize = 3;
const RIVALS: usize = 4;
/// The distances of marks may be off by this share, and by the second, px, of a mark's size: ink and exposure move edges.
const SPACING: [f64; 2] = [0.03, 1.0];

/// A mark that was read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark {
    pub id: u32,
    /// Its middle on the board.
    pub plate: Point,
    /// Its middle in the image.
    pub at: Point,
    /// The map from the board to the image there; `None` for one that may be turned.
    pub linear: Option<Linear>,
}

/// Marks that agree with each other, and others; indices.
#[derive(Debug, PartialEq)]
pub(crate) struct Arranged {
    pub kept: Vec<usize>,
    pub strays: Vec<usize>,
}

/// Two neighbours.
struct Pair {
    marks: [usize; 2],
    /// Their distance on the board.
    apart: f64,
    /// Where the maps of both have the one from the other, along and across where it is seen, 1 its distance.
    along: f64,
    across: f64,
    /// A mark's size in the image, px.
    size: f64,
}

/// Which of `marks`, whose size is `size` object units, stand to each other as the board has them.
///
/// # Errors
/// [`NotFound::OtherSpacing`], [`NotFound::OtherArrangement`].
pub(crate) fn arrange(marks: &[Mark], size: f64) -> Result<Arranged, NotFound> {
    let pairs = pairs(marks, size);
    spacing(&pairs)?;
    let groups = groups(marks.len(), &pairs);
    let mut kept = largest(&groups, &(0..marks.len()).collect::<Vec<_>>());
    let least = pairs.iter().map(|pair| pair.apart).fold(f64::INFINITY, f64::min);
    kept.extend(reached(marks, &kept, size, least));
    kept.sort_unstable();
    let strays: Vec<usize> = (0..marks.len()).filter(|index| kept.binary_search(index).is_err()).collect();
    let rivals = largest(&groups, &strays).len();
    if !strays.is_empty() && (kept.len() < LEAST || (rivals > 1 && RIVALS * rivals > kept.len())) {
        return Err(NotFound::OtherArrangement { marks: marks.len(), together: kept.len(), instead: None });
    }
    Ok(Arranged { kept, strays })
}

/// Of each mark the first one of those that it agrees with, in whatever many steps.
fn groups(count: usize, pairs: &[Pair]) -> Vec<usize> {
    let mut groups: Vec<usize> = (0..count).collect();
    let agreeing = pairs.iter().filter(|pair| pair.across.abs() < ACROSS && (pair.along - 1.0).abs() < ALONG);
    for [a, b] in agreeing.map(|pair| pair.marks) {
        let (one, other) = (groups[a].min(groups[b]), groups[a].max(groups[b]));
        groups.iter_mut().filter(|group| **group == other).for_each(|group| *group = one);
    }
    groups
}

/// The marks of each of several boards, the largest first: those that agree with each other, with those that no neighbour reaches and that stand where these have
/// them. What agrees with fewer than two others is no board, nor are marks at other distances.
pub(crate) fn boards(marks: &[Mark], size: f64) -> Vec<Vec<usize>> {
    let all_pairs = pairs(marks, size);
    let groups = groups(marks.len(), &all_pairs);
    let members = |group: usize| (0..marks.len()).filter(|index| groups[*index] == group).collect::<Vec<_>>();
    let of = |own: &[usize]| own.iter().map(|index| marks[*index]).collect::<Vec<_>>();
    let mut boards: Vec<Vec<usize>> = (0..marks.len()).filter(|group| groups[*group] == *group).map(members).collect();
    boards.retain(|own| own.len() >= LEAST && spacing(&pairs(&of(own), size)).is_ok());
    boards.sort_by_key(|own| std::cmp::Reverse(own.len()));
    let mut free: Vec<usize> = (0..marks.len()).filter(|index| !boards.iter().any(|own| own.contains(index))).collect();
    let least = all_pairs.iter().map(|pair| pair.apart).fold(f64::INFINITY, f64::min);
    for own in &mut boards {
        let more: Vec<usize> = reached(marks, own, size, least).into_iter().filter(|index| free.contains(index)).collect();
        free.retain(|index| !more.contains(index));
        own.extend(more);
        own.sort_unstable();
    }
    boards
}

/// The largest group among these members; of several the first.
fn largest(groups: &[usize], members: &[usize]) -> Vec<usize> {
    let mut counts = vec![0; groups.len()];
    members.iter().for_each(|index| counts[groups[*index]] += 1);
    let most = counts.iter().copied().max().unwrap_or(0);
    let best = counts.iter().position(|count| *count == most);
    members.iter().copied().filter(|index| Some(groups[*index]) == best).collect()
}

fn pairs(marks: &[Mark], size: f64) -> Vec<Pair> {
    let mut all: Vec<[usize; 2]> = Vec::new();
    for (a, mark) in marks.iter().enumerate() {
        let mut others: Vec<(f64, usize)> =
            (0..marks.len()).filter(|b| marks[*b].id != mark.id).map(|b| (distance(mark.plate, marks[b].plate), b)).collect();
        others.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut ids: Vec<u32> = Vec::with_capacity(NEAREST);
        let near = others.iter().take_while(|(_, b)| {
            let id = marks[*b].id;
            if ids.contains(&id) {
                return true;
            }
            ids.push(id);
            ids.len() <= NEAREST
        });
        all.extend(near.map(|(_, b)| [a.min(*b), a.max(*b)]));
    }
    all.sort_unstable();
    all.dedup();
    all.into_iter().filter_map(|pair| Pair::new(marks, pair, size)).collect()
}

impl Pair {
    /// By the mean of the maps at both ends: what perspective and lens change between them is the same forth and back, to second order.
    fn new(marks: &[Mark], pair: [usize; 2], size: f64) -> Option<Self> {
        let [a, b] = pair.map(|index| marks[index]);
        let on_board = minus(b.plate, a.plate);
        let linears: Vec<Linear> = [a, b].iter().filter_map(|mark| mark.linear).collect();
        let count = linears.len() as f64;
        let expected = linears.iter().fold([0.0, 0.0], |sum, linear| plus(sum, times(linear.of(on_board), 1.0 / count)));
        let seen = minus(b.at, a.at);
        let squared = dot(seen, seen);
        let scale = linears.iter().map(|linear| linear.determinant().abs().sqrt()).fold(0.0, f64::max);
        (count > 0.0 && squared > 0.0).then(|| Self {
            marks: pair,
            apart: distance(a.plate, b.plate),
            along: dot(expected, seen) / squared,
            across: cross(expected, seen) / squared,
            size: scale * size,
        })
    }
}

/// Whether marks stand in the board's directions, all of them at other distances.
fn spacing(pairs: &[Pair]) -> Result<(), NotFound> {
    let least = pairs.iter().map(|pair| pair.apart).fold(f64::INFINITY, f64::min);
    let near = || pairs.iter().filter(|pair| pair.apart < 1.7 * least);
    let aligned: Vec<&Pair> = near().filter(|pair| pair.across.abs() < ACROSS * pair.along).collect();
    let (Some(along), Some(size)) =
        (upper_median(aligned.iter().map(|pair| pair.along)), upper_median(aligned.iter().map(|pair| pair.size)))
    else {
        return Ok(());
    };
    let alike = aligned.iter().filter(|pair| (pair.along / along - 1.0).abs() < 0.12).count();
    let off = (along - 1.0).abs() > SPACING[0] + SPACING[1] / size;
    if off && alike * 4 > near().count() * 3 {
        return Err(NotFound::OtherSpacing { times: 1.0 / along });
    }
    Ok(())
}

/// The marks outside the group that stand where a homography of the group has them.
fn reached(marks: &[Mark], group: &[usize], size: f64, apart: f64) -> Vec<usize> {
    let half = 0.5 * size;
    let points = group.iter().flat_map(|index| {
        let mark = marks[*index];
        let around = [[half, 0.0], [-half, 0.0], [0.0, half], [0.0, -half]];
        let around = around.into_iter().filter_map(move |step| Some((plus(mark.plate, step), plus(mark.at, mark.linear?.of(step)))));
        std::iter::once((mark.plate, mark.at)).chain(around)
    });
    let Some(map) = Homography::fitted(&points.collect::<Vec<_>>()).filter(|_| group.len() > 1) else { return Vec::new() };
    let near = |mark: &Mark| distance(map.at(mark.plate), mark.at) < REACHED * apart * map.linear(mark.plate).determinant().abs().sqrt();
    (0..marks.len()).filter(|index| !group.contains(index) && near(&marks[*index])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Marks of a grid as a camera sees them, three columns, under a tilt.
    fn marks(place: impl Fn(usize) -> Point) -> Vec<Mark> {
        let map = Homography::of_unit_square([[100.0, 100.0], [300.0, 120.0], [310.0, 260.0], [80.0, 240.0]]).unwrap();
        let mark = |index: usize| {
            let [seen, plate] = [place(index), [(index % 3) as f64, (index / 3) as f64]];
            let at = times(seen, 0.2);
            let Linear(rows) = map.linear(at);
            Mark { id: index as u32, plate, at: map.at(at), linear: Some(Linear(rows.map(|row| times(row, 0.2)))) }
        };
        (0..12).map(mark).collect()
    }

    #[test]
    fn a_board_agrees_with_itself_and_a_stray_is_left_out() {
        let grid = |index: usize| [(index % 3) as f64, (index / 3) as f64];
        assert_eq!(arrange(&marks(grid), 0.7).unwrap().kept.len(), 12);
        let stray = arrange(&marks(|index| if index == 4 { [4.0, 0.5] } else { grid(index) }), 0.7).unwrap();
        assert_eq!(stray.strays, [4]);
    }

    #[test]
    fn other_distances_and_orders_are_named() {
        let wide = arrange(&marks(|index| [1.1 * (index % 3) as f64, 1.1 * (index / 3) as f64]), 0.7).unwrap_err();
        assert!(matches!(wide, NotFound::OtherSpacing { times } if (times - 1.1).abs() < 0.01), "{wide}");
        let rows_of_four = arrange(&marks(|index| [(index % 4) as f64, (index / 4) as f64]), 0.7).unwrap_err();
        assert_eq!(rows_of_four.name(), "other_arrangement");
    }

    #[test]
    fn marks_beyond_a_covered_part_belong_to_the_board() {
        let mut seen = marks(|index| [(index % 3) as f64, (index / 3) as f64]);
        seen.drain(3..9);
        assert_eq!(arrange(&seen, 0.7).unwrap().kept.len(), 6);
    }
}
