//! Places of a grid that were left out when it was grown: what stands there is of another size or shape.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Matrix3, Matrix3x2, RowVector2, Vector3};

use crate::lattice::Grid;
use crate::plane::{Linear, Point, distance, dot, length};
use crate::round::Round;

/// How far an area may be from where its neighbours have it, in distances of neighbours.
const REACH: f64 = 0.35;
/// The same for what is not round or not whole, and in px at most: a circle that is hidden in part has its middle elsewhere.
const NEAR: [f64; 2] = [0.08, 1.5];
/// So many steps around an empty place tell where it is.
const AROUND: i32 = 2;
/// A determinant below this share of the product of its diagonal is none.
const FLAT: f64 = 1e-6;
/// Right, below, left, above.
const WAYS: [[i32; 2]; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];

/// The grid with what stands at its empty places that have two of its circles beside them, until no more is added or it has `most`.
pub(super) fn filled(grid: &Grid, areas: &[Round], most: usize) -> Grid {
    let mut grid = grid.clone();
    let mut taken: BTreeSet<usize> = grid.values().copied().collect();
    loop {
        let before = grid.len();
        for place in empty(&grid) {
            let Some((at, step)) = expected(&grid, areas, place) else { continue };
            let near =
                areas.iter().enumerate().filter(|(index, _)| !taken.contains(index)).map(|(index, area)| (distance(area.at, at), index));
            let nearest = near.min_by(|a, b| a.0.total_cmp(&b.0));
            let is_whole = |index: usize| areas[index].is_oval && !areas[index].is_cut;
            let reach = |index: usize| if is_whole(index) { REACH * step } else { (NEAR[0] * step).min(NEAR[1]) };
            if let Some((_, index)) = nearest.filter(|(distance, index)| *distance < reach(*index))
                && grid.len() < most
            {
                grid.insert(place, index);
                taken.insert(index);
            }
        }
        if grid.len() == before {
            return grid;
        }
    }
}

fn stepped([i, j]: [i32; 2], [u, v]: [i32; 2]) -> [i32; 2] {
    [i + u, j + v]
}

/// Places beside those that are taken.
pub(super) fn empty(grid: &Grid) -> BTreeSet<[i32; 2]> {
    let beside = grid.keys().flat_map(|place| WAYS.map(|way| stepped(*place, way)));
    beside.filter(|place| !grid.contains_key(place)).collect()
}

/// How many of the four places beside one are taken.
pub(super) fn beside(grid: &Grid, place: [i32; 2]) -> usize {
    WAYS.iter().filter(|way| grid.contains_key(&stepped(place, **way))).count()
}

/// Where the places around have an empty one, by a linear map of the nearer ones, and the shortest step there, px; `None` if it has less than two beside it.
fn expected(grid: &Grid, areas: &[Round], place: [i32; 2]) -> Option<(Point, f64)> {
    let (at, linear) = (beside(grid, place) > 1).then(|| fitted(grid, areas, place))??;
    let ways = [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, -1.0]];
    Some((at, ways.map(|way| length(linear.of(way))).into_iter().fold(f64::INFINITY, f64::min)))
}

/// Where a linear map has a place, and the map from steps to px.
fn fitted(grid: &Grid, areas: &[Round], place: [i32; 2]) -> Option<(Point, Linear)> {
    let steps = (-AROUND..=AROUND).flat_map(|u| (-AROUND..=AROUND).map(move |v| [u, v]));
    let near = steps.filter_map(|step| Some((step.map(f64::from), areas[*grid.get(&stepped(place, step))?].at)));
    let (mut normal, mut right) = (Matrix3::zeros(), Matrix3x2::zeros());
    for (step, at) in near {
        let row = Vector3::new(1.0, step[0], step[1]);
        let weight = 1.0 / dot(step, step).powi(2);
        normal += weight * row * row.transpose();
        right += weight * row * RowVector2::new(at[0], at[1]);
    }
    // Places in one line tell nothing beside it.
    let spread = normal.determinant() / (normal[(0, 0)] * normal[(1, 1)] * normal[(2, 2)]);
    let found = normal.try_inverse().filter(|_| spread > FLAT)? * right;
    Some(([found[(0, 0)], found[(0, 1)]], Linear([[found[(1, 0)], found[(2, 0)]], [found[(1, 1)], found[(2, 1)]]])))
}

/// Where the places beside those that are taken would be seen, by what is next to them.
pub(super) fn around(grid: &Grid, areas: &[Round]) -> BTreeMap<[i32; 2], Point> {
    empty(grid).into_iter().filter_map(|place| Some((place, fitted(grid, areas, place)?.0))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(at: Point) -> Round {
        Round { at, moments: [4.0, 0.0, 4.0], area: 50.0, is_oval: true, is_cut: false }
    }

    /// Five by four places, of which a corner and an inner one are left out; what stands there and beside the grid.
    #[test]
    fn a_corner_and_an_inner_place_are_filled_and_nothing_beside() {
        let place = |index: i32| [index % 5, index / 5];
        let at = |[x, y]: [i32; 2]| [100.0 + 20.0 * f64::from(x) + 3.0 * f64::from(y), 50.0 + 18.0 * f64::from(y) + f64::from(x * y)];
        let areas: Vec<Round> = (0..20).map(|index| area(at(place(index)))).chain([area(at([5, 1])), area(at([-1, 0]))]).collect();
        let mut grid: Grid = (0..20).map(|index| (place(index), index as usize)).collect();
        grid.remove(&[4, 3]);
        grid.remove(&[2, 1]);
        assert_eq!(empty(&grid).len(), 2 + 18 - 2);
        let full = filled(&grid, &areas, 100);
        assert_eq!(full.len(), 20, "{full:?}");
        assert!(full[&[4, 3]] == 19 && full[&[2, 1]] == 7);
        let beyond = around(&full, &areas)[&[5, 0]];
        assert!(distance(beyond, at([5, 0])) < 1.0, "{beyond:?}");
        assert_eq!((beside(&full, [5, 0]), beside(&full, [2, 1])), (1, 4));
    }
}
