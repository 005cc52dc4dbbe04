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

use calibench_records::parts::Span;
use calibench_records::results::Trial;
use rayon::prelude::*;

pub use crate::tally::{Reuse, Tally};
use crate::trials::{BATCH, Work};
use crate::{Plan, RunError};
pub use code::is_known as is_code_known;

/// A digest of the code of adjustments and of what stands before them; of the `program` where that is not known.
pub fn digest_of_adjusting(program: &str) -> &str {
    code::digest(code::ADJUSTED, program)
}

use kept::{Kept, Unit, merged};
pub(crate) use stamp::Stamp;

/// As [`Plan::run`]; what is in the plan's store is read, and what is not is put there.
///
/// # Errors
/// As [`Plan::run`].
pub fn run(plan: &Plan<'_>, step: &(dyn Fn() + Sync), sink: &mut dyn FnMut(Trial) -> Result<(), RunError>) -> Result<(), RunError> {
    let Some(reuse) = plan.reuse else { return plan.run(step, sink) };
    let Some(keys) = keys::of(plan, &reuse) else { return plan.run(step, sink) };
    plan.check()?;
    if plan.span().count() == 0 {
        return Ok(());
    }
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
    let unknowns = |method: usize| bounding.asks_for(method).then(|| bounding.unknowns(method));
    let adjusting = Plan { asked: Some(&adjusted), images: None, data: plan.data.clone(), ..*plan };
    let mut images_kept = pictured;
    let Span { from, to } = plan.span();
    for first in (from..to).step_by(BATCH as usize) {
        let kept = (first..(first + BATCH).min(to)).map(|number| Kept::read(number, &mut units)).collect::<io::Result<Vec<_>>>()?;
        let done = |kept: Kept| {
            plan.go_on()?;
            let number = kept.number;
            let new = work.measured(&wanted, number, step)?;
            let mut trial = merged(plan, kept, new);
            if let Some(bounds) = &bounds {
                bounds.of(&bounding, number)?.add_to(&mut trial.whole.points, unknowns);
            }
            if !adjusted.is_empty() {
                let more = adjusting.adjust(&trial.whole, number);
                trial.add_adjusted(more);
            }
            Ok(trial)
        };
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
