//! Runs whose results are in a store: what is there is read, what is missing is computed and put there.
//!
//! An entry holds what one method makes of all trials of a scenario or a cell; where nothing is cleared of its points, what is adjusted from them has an entry of its own, so that
//! cells which differ in the adjustment alone share their points. The trials that are handed on are those of a run without a store, to the last bit.

mod arithmetic;
mod code;
mod frames;
mod images;
mod kept;
mod keys;
mod stamp;

use std::io;
use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::{AtomicUsize, Ordering};

use calibench_records::parts::Span;
use calibench_records::results::Trial;
use calibench_store::Store;
use rayon::prelude::*;

use crate::trials::{BATCH, Work};
use crate::{Plan, RunError};
pub use code::is_known as is_code_known;
use kept::{Kept, Unit, merged};
pub(crate) use stamp::Stamp;

/// A store, and what is to be known of it.
#[derive(Clone, Copy)]
pub struct Reuse<'a> {
    /// Where results are.
    pub store: &'a Store,
    /// A digest of all code that has none of its own: of the program, or of what it has beside calibench's crates.
    pub program: &'a str,
    /// What was found there, and what was not.
    pub tally: &'a Tally,
}

/// Results of methods in scenarios and cells: how many were in the store, and how many were computed.
#[derive(Debug, Default)]
pub struct Tally {
    found: AtomicUsize,
    computed: AtomicUsize,
    unchanged: AtomicUsize,
    refused: Mutex<Option<String>>,
}

impl Tally {
    /// How many were in the store.
    pub fn found(&self) -> usize {
        self.found.load(Ordering::Relaxed)
    }

    /// How many were computed.
    pub fn computed(&self) -> usize {
        self.computed.load(Ordering::Relaxed)
    }

    /// Why something was computed and could not be put into the store, if so.
    pub fn refused(&self) -> Option<String> {
        self.refused.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// How many runs had nothing to do: their records are as they would write them.
    pub fn unchanged(&self) -> usize {
        self.unchanged.load(Ordering::Relaxed)
    }

    /// Counts a run that has nothing to do.
    pub(crate) fn leave(&self) {
        self.unchanged.fetch_add(1, Ordering::Relaxed);
    }

    /// Counts one of each that is computed, or found.
    fn count(&self, computed: usize, found: usize) {
        self.computed.fetch_add(computed, Ordering::Relaxed);
        self.found.fetch_add(found, Ordering::Relaxed);
    }

    /// What `result` gives; what stands in the way is kept, and costs no more than the entry.
    fn unless_refused<T>(&self, result: io::Result<T>) -> Option<T> {
        let why = match result {
            Ok(value) => return Some(value),
            Err(why) => why,
        };
        self.refused.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(why.to_string());
        None
    }
}

/// As [`Plan::run`] without a store.
pub(crate) fn run(
    plan: &Plan<'_>,
    reuse: Reuse<'_>,
    step: &(dyn Fn() + Sync),
    sink: &mut dyn FnMut(Trial) -> Result<(), RunError>,
) -> Result<(), RunError> {
    let Some(keys) = keys::of(plan, &reuse) else { return plan.compute(step, sink) };
    let mut units: Vec<Unit> = keys.methods.iter().map(|method| Unit::find(reuse.store, method)).collect();
    let images = plan.images.filter(|_| plan.span().holds(0));
    let pictured = match images {
        Some(folder) => images::put(reuse.store, keys.images, folder)?,
        None => true,
    };
    let measured = places(&units, Unit::lacks_points);
    let [bounded, adjusted] = [places(&units, Unit::lacks_bounds), places(&units, Unit::lacks_adjusted)];
    let computed = units.iter().filter(|unit| unit.lacks_anything()).count();
    reuse.tally.count(computed, units.len() - computed);
    let wanted = Plan { asked: Some(&measured), bounds: false, images: images.filter(|_| !pictured), data: plan.data.clone(), ..*plan };
    let work = if measured.is_empty() { Work::Nothing } else { wanted.work()? };
    if measured.is_empty() && !pictured {
        // Images alone: those of the first trial.
        let only = Plan { only: Some(Span { from: 0, to: 1 }), data: plan.data.clone(), ..wanted };
        only.work()?.measured(&only, 0, &|| ())?;
    }
    for unit in &mut units {
        unit.begin(reuse);
    }
    let bounding = Plan { asked: Some(&bounded), images: None, data: plan.data.clone(), ..*plan };
    let bounds = if bounded.is_empty() { None } else { Some(bounding.bounding()?) };
    let adjusting = Plan { asked: Some(&adjusted), images: None, data: plan.data.clone(), ..*plan };
    let Span { from, to } = plan.span();
    for first in (from..to).step_by(BATCH as usize) {
        let kept = (first..(first + BATCH).min(to)).map(|number| Kept::read(number, &mut units)).collect::<io::Result<Vec<_>>>()?;
        let done = |kept: Kept| {
            plan.go_on()?;
            let number = kept.number;
            let new = work.measured(&wanted, number, step)?;
            let mut trial = merged(plan, kept, new);
            if let Some(bounds) = &bounds {
                bounds.of(&bounding, number)?.add_to(&mut trial.whole.points, &bounding);
            }
            if keys.apart {
                let more = adjusting.adjust(&trial.whole, number);
                trial.add_adjusted(more);
            }
            Ok(trial)
        };
        let mut images_kept = pictured;
        for trial in kept.into_par_iter().map(done).collect::<Result<Vec<_>, RunError>>()? {
            for unit in &mut units {
                unit.write(&trial, reuse.tally);
            }
            if let Some(folder) = images.filter(|_| !images_kept) {
                reuse.tally.unless_refused(images::keep(reuse.store, keys.images, folder));
                images_kept = true;
            }
            sink(trial.into_whole())?;
        }
    }
    for unit in units {
        unit.finish(reuse.tally);
    }
    Ok(())
}

/// The places of the methods whose unit lacks what is asked for.
fn places<'k>(units: &[Unit<'k>], lacks: impl Fn(&Unit<'k>) -> bool) -> Vec<usize> {
    units.iter().filter(|unit| lacks(unit)).map(Unit::place).collect()
}
