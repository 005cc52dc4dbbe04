//! Points of a reconstruction that nothing holds: their rays are as good as parallel, or do not meet.

use std::collections::BTreeSet;

use calibench_adjust::{Datum, Network, far_points};

use crate::ended::ITERATIONS;
use crate::{Calibration, LeftOut, Prepared};

/// Iterations of the first round; later ones have more where points run away slowly.
const FIRST: usize = 30;

impl Prepared {
    /// A reconstruction without the points that run off to where their rays would be parallel; `None` where there are none, or where start values were not given.
    pub(crate) fn without_far_points(&self) -> Option<Self> {
        if !self.is_given {
            return None;
        }
        let (mut left, mut iterations) = (None, FIRST);
        while iterations < ITERATIONS {
            let prepared = left.as_ref().unwrap_or(self);
            let Ok(Some(points)) = far_points(&prepared.network, iterations) else { break };
            match prepared.without(&points, "its point is very far away") {
                Some((without, names)) => left = Some(Self { far: prepared.far.iter().cloned().chain(names).collect(), ..without }),
                None => iterations *= 2,
            }
        }
        left
    }

    /// The same without points of the network, and without what is seen of them, and their names; `None` if all stay. Points of distances and lengths do, so that they are
    /// named if they cannot be determined.
    fn without(&self, points: &[usize], why: &str) -> Option<(Self, Vec<String>)> {
        let is_needed = |point: usize| {
            let is_end = |ends: &[usize; 2]| ends.contains(&point);
            self.network.distances.iter().any(|distance| is_end(&distance.points)) || self.lengths.iter().any(is_end)
        };
        let points: Vec<usize> = points.iter().copied().filter(|point| !is_needed(*point)).collect();
        if points.is_empty() {
            return None;
        }
        let mut prepared = self.clone();
        let network = &mut prepared.network;
        let mut goes = vec![false; network.points.len()];
        points.iter().for_each(|&point| goes[point] = true);
        let names = network.points.iter().zip(&goes).filter(|(_, goes)| **goes).map(|(point, _)| point.name.clone()).collect();
        let mut place = 0;
        let places: Vec<usize> = goes.iter().map(|goes| (place, place += usize::from(!goes)).0).collect();
        let keeps: Vec<bool> = network.observations.iter().map(|observation| !goes[observation.point]).collect();
        let lost = prepared.sights.iter().zip(&keeps).filter(|(_, keeps)| !**keeps);
        prepared.left_out.extend(lost.map(|(&sight, _)| LeftOut { sight: sight as usize, why: why.into() }));
        prepared.left_out.sort_by_key(|left_out| left_out.sight);
        retain(&mut prepared.sights, &keeps);
        retain(&mut network.observations, &keeps);
        retain(&mut network.points, &goes.iter().map(|goes| !goes).collect::<Vec<_>>());
        renumber(network, &goes, &places);
        prepared.lengths.iter_mut().flatten().for_each(|point| *point = places[*point]);
        Some((prepared, names))
    }
}

impl Calibration<'_> {
    /// What was adjusted, a reconstruction, without the points whose last two rays do not meet: either may be wrong. `None` where there are none, or where start values
    /// were not given.
    pub(crate) fn without_disputed_points(&self) -> Option<Prepared> {
        let kept: BTreeSet<usize> = self.found.iter().filter(|found| !found.left_out).map(|found| found.observation).collect();
        if !self.prepared.is_given || kept.is_empty() {
            return None;
        }
        let (seen, mut rays) = (&self.prepared.network.observations, vec![0; self.solution.points().len()]);
        seen.iter().for_each(|o| rays[o.point] += 1);
        self.found.iter().filter(|found| found.left_out).for_each(|found| rays[seen[found.observation].point] -= 1);
        let points: BTreeSet<usize> = kept.into_iter().map(|kept| seen[kept].point).filter(|point| rays[*point] <= 2).collect();
        let (without, names) = self.prepared.without(&Vec::from_iter(points), "the last two rays of its point do not meet")?;
        Some(Prepared { disputed: names, ..without })
    }
}

fn retain<T>(all: &mut Vec<T>, keeps: &[bool]) {
    let mut keeps = keeps.iter();
    all.retain(|_| keeps.next().is_none_or(|keeps| *keeps));
}

fn renumber(network: &mut Network, goes: &[bool], places: &[usize]) {
    network.observations.iter_mut().for_each(|observation| observation.point = places[observation.point]);
    network.distances.iter_mut().flat_map(|distance| &mut distance.points).for_each(|point| *point = places[*point]);
    match &mut network.datum {
        Datum::InnerOver(points) => *points = points.iter().filter(|point| !goes[**point]).map(|&point| places[point]).collect(),
        Datum::Minimal { horizontal, vertical } => horizontal.iter_mut().chain(vertical).for_each(|point| *point = places[*point]),
        Datum::Control | Datum::Inner => {}
    }
}
