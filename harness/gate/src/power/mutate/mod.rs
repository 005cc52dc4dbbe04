//! Faults put into a run on purpose, of which the gate is to see each.

use std::collections::BTreeMap;
use std::sync::Arc;

use calibench_model::Rejection;
use calibench_random::{Key, Purpose, stream};
use calibench_records::results::LOST;
use rand::seq::SliceRandom;
use rand_distr::{Distribution, StandardNormal};

use crate::point_entry::{Entry, Found, Place, rounded};
use crate::table::MethodTable;

/// A fault in the results of one method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mutation {
    /// Independent noise on both coordinates that makes the scatter about each target's mean 10 % larger.
    MoreNoise,
    /// Every deviation from the mean of its target doubled.
    DoubledNoise,
    /// As many points lost as there are already.
    LostDoubled,
    /// A tenth of the measured points rejected, one at least.
    TenthRejected,
    /// One trial a copy of another.
    CopiedTrial,
    /// One coordinate not a number.
    OneNan,
    /// dx and dy exchanged.
    Swapped,
}

impl Mutation {
    /// All of them with their names in tables.
    pub const ALL: [(Self, &'static str); 7] = [
        (Self::MoreNoise, "+10 % noise"),
        (Self::DoubledNoise, "noise doubled"),
        (Self::LostDoubled, "lost points doubled"),
        (Self::TenthRejected, "10 % rejected"),
        (Self::CopiedTrial, "a trial copied"),
        (Self::OneNan, "one NaN"),
        (Self::Swapped, "dx, dy swapped"),
    ];

    /// The method's results with this fault; random choices are those of `key`.
    ///
    /// # Errors
    /// Why there is no such fault in these results.
    pub fn of(self, method: &MethodTable, key: Key<'_>) -> Result<MethodTable, &'static str> {
        let mut points = method.points.clone();
        match self {
            Self::MoreNoise => more_noise(&mut points, key)?,
            Self::DoubledNoise => doubled(&mut points)?,
            Self::LostDoubled => lost(&mut points, key)?,
            Self::TenthRejected => rejected(&mut points, key)?,
            Self::CopiedTrial => copied(&mut points)?,
            Self::OneNan => nan(&mut points)?,
            Self::Swapped => change(&mut points, |_, [dx, dy]| [dy, dx]),
        }
        if points == method.points { Err("the results stay the same") } else { Ok(MethodTable { points, ..method.clone() }) }
    }
}

type Points = BTreeMap<Place, Entry>;
type Target = (Arc<str>, Arc<str>);

fn change(points: &mut Points, new: impl FnMut(&Place, [f64; 2]) -> [f64; 2]) {
    let mut new = new;
    for (place, entry) in points.iter_mut() {
        if let Some(found) = entry.found().copied() {
            *entry = at(found, new(place, found.at));
        }
    }
}

fn at(found: Found, [dx, dy]: [f64; 2]) -> Entry {
    let found = Found { at: [rounded(dx), rounded(dy)], ..found };
    if dx.hypot(dy) <= LOST { Entry::Measured(found) } else { Entry::Lost(found) }
}

fn target(place: &Place) -> Target {
    (place.view.clone(), place.target.clone())
}

/// The mean of each target over the trials in which it was measured.
fn means(points: &Points) -> BTreeMap<Target, [f64; 2]> {
    let mut sums: BTreeMap<Target, ([f64; 2], f64)> = BTreeMap::new();
    for (place, entry) in points {
        if let Some([dx, dy]) = entry.kept() {
            let (sum, n) = sums.entry(target(place)).or_default();
            (*sum, *n) = ([sum[0] + dx, sum[1] + dy], *n + 1.0);
        }
    }
    sums.into_iter().map(|(target, ([x, y], n))| (target, [x / n, y / n])).collect()
}

fn more_noise(points: &mut Points, key: Key<'_>) -> Result<(), &'static str> {
    let means = means(points);
    let squares: Vec<f64> = points
        .iter()
        .filter_map(|(place, entry)| {
            let ([dx, dy], [mx, my]) = (entry.kept()?, means[&target(place)]);
            Some((dx - mx).powi(2) + (dy - my).powi(2))
        })
        .collect();
    let scatter = (squares.iter().sum::<f64>() / (2.0 * squares.len().max(1) as f64)).sqrt();
    if scatter == 0.0 {
        return Err("there is no scatter");
    }
    let (sigma, mut rng) = (scatter * (1.1_f64 * 1.1 - 1.0).sqrt(), stream(key, Purpose::Split));
    let mut draw = || -> f64 { sigma * Distribution::<f64>::sample(&StandardNormal, &mut rng) };
    change(points, |_, [dx, dy]| [dx + draw(), dy + draw()]);
    Ok(())
}

fn doubled(points: &mut Points) -> Result<(), &'static str> {
    let means = means(points);
    if means.is_empty() {
        return Err("no point is measured");
    }
    change(points, |place, [dx, dy]| means.get(&target(place)).map_or([dx, dy], |[mx, my]| [2.0 * dx - mx, 2.0 * dy - my]));
    Ok(())
}

fn shuffled(points: &Points, which: impl Fn(&Entry) -> bool, key: Key<'_>) -> Vec<Place> {
    let mut places: Vec<Place> = points.iter().filter(|(_, entry)| which(entry)).map(|(place, _)| place.clone()).collect();
    places.shuffle(&mut stream(key, Purpose::Split));
    places
}

fn lost(points: &mut Points, key: Key<'_>) -> Result<(), &'static str> {
    let count = points.values().filter(|entry| matches!(entry, Entry::Lost(_))).count();
    let kept = shuffled(points, Entry::is_kept, key);
    if count == 0 || kept.is_empty() {
        return Err(if count == 0 { "no point is lost" } else { "no point is measured" });
    }
    for place in kept.into_iter().take(count) {
        if let Some(Entry::Measured(found)) = points.get(&place).copied() {
            points.insert(place, at(found, [found.at[0] + 2.0, found.at[1]]));
        }
    }
    Ok(())
}

fn rejected(points: &mut Points, key: Key<'_>) -> Result<(), &'static str> {
    let kept = shuffled(points, Entry::is_kept, key);
    if kept.is_empty() {
        return Err("no point is measured");
    }
    for place in kept.iter().take(kept.len().div_ceil(10)) {
        points.insert(place.clone(), Entry::Rejected(Rejection::NoCorner));
    }
    Ok(())
}

fn copied(points: &mut Points) -> Result<(), &'static str> {
    let mut trials: Vec<u64> = points.keys().map(|place| place.trial).collect();
    trials.dedup();
    let [first, second, ..] = trials[..] else { return Err("there is one trial") };
    let from: Vec<(Place, Entry)> = points.iter().filter(|(place, _)| place.trial == second).map(|(p, e)| (p.clone(), *e)).collect();
    for (place, entry) in from {
        points.insert(Place { trial: first, ..place }, entry);
    }
    Ok(())
}

fn nan(points: &mut Points) -> Result<(), &'static str> {
    let entry = points.values_mut().find(|entry| entry.is_kept()).ok_or("no point is measured")?;
    if let Entry::Measured(found) = *entry {
        *entry = Entry::Lost(Found { at: [f64::NAN, found.at[1]], ..found });
    }
    Ok(())
}

#[cfg(test)]
mod tests;
