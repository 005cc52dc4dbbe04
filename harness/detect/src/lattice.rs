//! Grids of round areas, grown from neighbour to neighbour.

use std::collections::{BTreeMap, VecDeque};

use calibench_model::stop;

use crate::plane::{Point, cross, distance, length, minus, plus, times};
use crate::round::Round;

/// Neighbours have areas that differ by this factor at most, where areas tell anything.
pub(crate) const ALIKE: f64 = 2.0;
/// So many of the nearest are looked at for the first steps of a grid.
const NEAREST: usize = 8;
/// How far a neighbour may be from where the last step has it, as a fraction of the shorter step.
const REACH: f64 = 0.3;
/// So many grids are begun.
const SEEDS: usize = 60;
/// So many areas are looked at, the largest.
const MOST: usize = 3000;

/// A grid: its areas by their place. Which of the lattice's bases the places count in is open.
pub(crate) type Grid = BTreeMap<[i32; 2], usize>;

/// The grids among round areas, one after the other; the areas by their indices.
pub(crate) struct Grids<'a> {
    rounds: &'a [Round],
    /// By which factor neighbours' areas may differ.
    alike: f64,
    /// Of each area, its nearest of like size.
    neighbours: Vec<Vec<usize>>,
    seeds: VecDeque<usize>,
    taken: Vec<bool>,
}

/// The largest of too many areas, in their order.
pub(crate) fn limited(mut rounds: Vec<Round>) -> Vec<Round> {
    if rounds.len() > MOST {
        let mut areas: Vec<f64> = rounds.iter().map(|round| round.area).collect();
        areas.sort_unstable_by(|a, b| b.total_cmp(a));
        rounds.retain(|round| round.area > areas[MOST]);
    }
    rounds
}

fn alike(a: &Round, b: &Round, factor: f64) -> bool {
    a.area < factor * b.area && b.area < factor * a.area
}

impl<'a> Grids<'a> {
    /// Of neighbours whose areas differ by less than the factor `alike`.
    pub(crate) fn new(rounds: &'a [Round], alike: f64) -> Self {
        let neighbours: Vec<Vec<usize>> = (0..rounds.len()).map(|index| nearest(rounds, index, alike)).collect();
        let mut grids = Self { rounds, alike, neighbours, seeds: VecDeque::new(), taken: vec![false; rounds.len()] };
        let mut seeds: Vec<(usize, usize)> = (0..rounds.len()).map(|index| (grids.paired(index).len(), index)).collect();
        seeds.sort_unstable_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
        grids.seeds = seeds.into_iter().map(|(_, index)| index).collect();
        grids
    }

    fn steps(&self, index: usize) -> Vec<Point> {
        self.neighbours[index].iter().map(|other| minus(self.rounds[*other].at, self.rounds[index].at)).collect()
    }

    /// The steps to neighbours that have another opposite to them.
    fn paired(&self, index: usize) -> Vec<Point> {
        let steps = self.steps(index);
        let opposite = |step: &Point| steps.iter().any(|other| length(plus(*step, *other)) < 0.2 * length(*step));
        steps.iter().filter(|step| opposite(step)).copied().collect()
    }

    /// Two steps that span the lattice around an area.
    fn basis(&self, index: usize) -> Option<[Point; 2]> {
        let mut steps = self.paired(index);
        steps.extend(self.steps(index));
        let first = *steps.first()?;
        let slanted = |step: &&Point| cross(first, **step).abs() > 0.35 * length(first) * length(**step);
        Some([first, *steps.iter().find(slanted)?])
    }

    fn grow(&mut self, seed: usize, basis: [Point; 2]) -> Grid {
        let mut grid = Grid::from([([0, 0], seed)]);
        self.taken[seed] = true;
        let mut open = VecDeque::from([([0, 0], seed, basis)]);
        while let Some((place, index, steps)) = open.pop_front() {
            for (axis, sign) in [(0, 1), (0, -1), (1, 1), (1, -1)] {
                let mut there = place;
                there[axis] += sign;
                if grid.contains_key(&there) {
                    continue;
                }
                let step = times(steps[axis], f64::from(sign));
                let reach = REACH * length(steps[0]).min(length(steps[1]));
                let Some(next) = self.near(index, plus(self.rounds[index].at, step), reach) else { continue };
                let mut onwards = steps;
                onwards[axis] = times(minus(self.rounds[next].at, self.rounds[index].at), f64::from(sign));
                self.taken[next] = true;
                grid.insert(there, next);
                open.push_back((there, next, onwards));
            }
        }
        grid
    }

    /// The free area nearest to a point among the neighbours of one, or of all.
    fn near(&self, of: usize, at: Point, reach: f64) -> Option<usize> {
        let free = |index: &usize| !self.taken[*index] && alike(&self.rounds[of], &self.rounds[*index], self.alike);
        let by_distance = |index: usize| (distance(self.rounds[index].at, at), index);
        let nearest = self.neighbours[of].iter().copied().filter(free).map(by_distance).min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.filter(|(distance, _)| *distance < reach).map(|(_, index)| index)
    }
}

impl Iterator for Grids<'_> {
    type Item = Grid;

    fn next(&mut self) -> Option<Grid> {
        let before = self.rounds.len().saturating_sub(self.seeds.len());
        for _ in before..SEEDS.max(before) {
            stop::point();
            let seed = self.seeds.pop_front()?;
            if !self.taken[seed]
                && let Some(basis) = self.basis(seed)
            {
                return Some(self.grow(seed, basis));
            }
        }
        None
    }
}

fn nearest(rounds: &[Round], index: usize, factor: f64) -> Vec<usize> {
    let own = &rounds[index];
    let others = (0..rounds.len()).filter(|other| *other != index && alike(own, &rounds[*other], factor));
    let mut all: Vec<(f64, usize)> = others.map(|other| (distance(own.at, rounds[other].at), other)).collect();
    let order = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
    if all.len() > NEAREST {
        all.select_nth_unstable_by(NEAREST, order);
        all.truncate(NEAREST);
    }
    all.sort_unstable_by(order);
    all.into_iter().map(|(_, other)| other).collect()
}

/// All bases of a lattice near the one that was grown: matrices of small whole numbers with determinant 1 or -1.
pub(crate) fn bases() -> impl Iterator<Item = [[i32; 2]; 2]> {
    let all = || -2_i32..=2;
    all()
        .flat_map(move |a| all().flat_map(move |b| all().flat_map(move |c| all().map(move |d| [[a, b], [c, d]]))))
        .filter(|[[a, b], [c, d]]| (a * d - b * c).abs() == 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slanted_grid_is_grown_whole_and_what_lies_beside_is_left_out() {
        let round = |at: Point| Round { at, moments: [4.0, 0.0, 4.0], area: 50.0, is_oval: true, is_cut: false };
        let mut rounds: Vec<Round> = (0..20)
            .map(|index| (f64::from(index % 5), f64::from(index / 5)))
            .map(|(x, y)| round([100.0 + 20.0 * x + 6.0 * y, 80.0 + 3.0 * x + 18.0 * y + 0.5 * x * y]))
            .collect();
        rounds.extend([[20.0, 20.0], [300.0, 100.0]].map(round));
        let grids: Vec<Grid> = Grids::new(&rounds, ALIKE).collect();
        assert_eq!(grids[0].len(), 20);
        assert!(grids[0].values().all(|index| *index < 20));
        assert_eq!(bases().filter(|basis| *basis == [[1, 0], [0, 1]]).count(), 1);
    }
}
