//! The league: what calibrators make of every trial of a class, and what of that is up to date.

mod photographs;
mod trials;

use std::ops::Range;

use calibench_calibrators::{Answer, Calibrated, Listed};
use calibench_records::league::{Answered, UNAVAILABLE, median};
use rayon::prelude::*;

use crate::reuse::digest_of_adjusting;
use crate::studies::calibrators;
pub use crate::studies::calibrators::absent;
use crate::{Plan, RunError};
use photographs::Photographs;
pub use trials::Trials;

/// A calibrator whose calibrations take less, s, is asked more often about points that are drawn: what is rare is seen, and what it states is judged.
const QUICK_S: f64 = 0.2;
/// Trials of those.
const QUICK_TRIALS: u64 = 300;

/// A class in the league: a scenario whose study is of calibrators, or whose photographs they are told halves of.
pub struct Class<'a> {
    plan: &'a Plan<'a>,
    told: Told<'a>,
}

/// What calibrators are told.
enum Told<'a> {
    Views(Box<Trials<'a>>),
    Photographs(Photographs<'a>),
}

/// A calibrator that is asked, and what stands for all that its answers depend on.
#[derive(Clone, Copy)]
pub struct Bout<'a> {
    /// The calibrator.
    pub listed: &'a Listed,
    /// The version that it says.
    pub version: &'a str,
}

impl<'a> Class<'a> {
    /// That of `plan`; `None` of a scenario that is none.
    ///
    /// # Errors
    /// Views that cannot be pictured; in words, photographs that are not there or cannot be read.
    pub fn new(plan: &'a Plan<'a>) -> Result<Option<Self>, RunError> {
        let told = match Trials::new(plan)? {
            Some(trials) => Some(Told::Views(trials.into())),
            None => Photographs::new(plan)?.map(Told::Photographs),
        };
        Ok(told.map(|told| Self { plan, told }))
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.plan.scenario.name
    }

    /// How many trials every calibrator gets; of photographs, how many splits into halves.
    pub fn trials(&self) -> u64 {
        match &self.told {
            Told::Views(_) => self.plan.trials,
            Told::Photographs(photographs) => photographs.splits(),
        }
    }

    /// How many trials a calibrator gets of which `rows` are those that every one gets.
    pub fn trials_after<'r>(&self, rows: impl IntoIterator<Item = &'r Answered, IntoIter: Clone>) -> u64 {
        let rows = rows.into_iter();
        let is_drawn = matches!(&self.told, Told::Views(trials) if trials.are_drawn());
        let is_quick = median(rows.clone().map(|row| row.seconds)).is_some_and(|seconds| seconds < QUICK_S);
        let is_asked = rows.clone().all(|row| row.status != UNAVAILABLE);
        if is_drawn && is_asked && is_quick { self.trials().max(QUICK_TRIALS) } else { self.trials() }
    }

    /// The model that is asked for.
    fn model(&self) -> &str {
        match &self.told {
            Told::Views(trials) => trials.model(),
            Told::Photographs(photographs) => photographs.model(),
        }
    }

    /// A digest of what a calibrator's answers depend on beside its version: what it is told, and how it is started; of ours the code.
    pub fn digest(&self, listed: &Listed, program: &str) -> String {
        let resolved = &self.plan.scenario.resolved.points;
        let told = match &self.told {
            Told::Views(trials) => trials.told(),
            Told::Photographs(photographs) => photographs.told(),
        };
        let own = if listed.system == calibench_calibrators::OURS { digest_of_adjusting(program) } else { "" };
        let parts = [resolved.as_str(), &told, &self.plan.seed.to_string(), &listed.identity, own];
        let mut hasher = blake3::Hasher::new();
        parts.iter().for_each(|part| _ = hasher.update(part.as_bytes()).update(&[0]));
        hasher.finalize().to_hex()[..16].to_owned()
    }

    /// Whether `rows`, of one calibrator, hold all trials of this class under `digest` and `version`.
    pub fn is_up_to_date(&self, rows: &[Answered], digest: &str, version: &str) -> bool {
        let mine: Vec<&Answered> = rows.iter().filter(|row| row.class == self.name()).collect();
        let asked = self.trials_after(mine.iter().copied().take(self.trials() as usize));
        let whole = mine.len() as u64 == asked || mine.iter().all(|row| row.status == UNAVAILABLE) && !mine.is_empty();
        whole && mine.iter().all(|row| row.digest == digest && row.version == version)
    }

    /// The rows of one calibrator in the trials that every one gets; one row alone where it has no such model. `step` is called after each trial.
    ///
    /// # Errors
    /// Images that cannot be rendered; in words, a program that can no longer be started.
    pub fn rows(&self, bout: Bout<'_>, digest: &str, step: &(dyn Fn() + Sync)) -> Result<Vec<Answered>, RunError> {
        if !bout.listed.models.iter().any(|model| model == self.model()) {
            let message = format!("has no model {}", self.model());
            return Ok(vec![Answered { status: UNAVAILABLE.to_owned(), message, ..self.blank(bout, digest, 0) }]);
        }
        self.of_trials(bout, digest, 0..self.trials(), step)
    }

    /// The rows of further trials, where the calibrator was so quick in `rows`, which every one gets, that it is asked more often.
    ///
    /// # Errors
    /// As [`Self::rows`].
    pub fn further(&self, bout: Bout<'_>, digest: &str, rows: &[Answered], step: &(dyn Fn() + Sync)) -> Result<Vec<Answered>, RunError> {
        self.of_trials(bout, digest, self.trials()..self.trials_after(rows), step)
    }

    fn of_trials(&self, bout: Bout<'_>, digest: &str, trials: Range<u64>, step: &(dyn Fn() + Sync)) -> Result<Vec<Answered>, RunError> {
        let one = |trial: u64| {
            self.plan.go_on()?;
            let row = self.blank(bout, digest, trial);
            let (calibrated, row) = match &self.told {
                Told::Views(trials) => of_trial(trials, bout.listed, row)?,
                Told::Photographs(photographs) => of_half(photographs, bout.listed, row)?,
            };
            step();
            Ok(with_answer(row, &calibrated))
        };
        trials.into_par_iter().map(one).collect()
    }

    /// The row of a trial without what was answered.
    fn blank(&self, bout: Bout<'_>, digest: &str, trial: u64) -> Answered {
        Answered {
            class: self.name().to_owned(),
            digest: digest.to_owned(),
            system: bout.listed.system.clone(),
            version: bout.version.to_owned(),
            trial,
            ..Answered::default()
        }
    }
}

/// The answer to a trial whose truth is known, and its row with the scores.
fn of_trial(trials: &Trials<'_>, listed: &Listed, mut row: Answered) -> Result<(Calibrated, Answered), RunError> {
    let asked = trials.asked(row.trial)?;
    let answered = calibrators::answer(&asked, listed).map_err(std::io::Error::other)?;
    row.silent = answered.is_wrong_and_silent();
    match answered.score {
        Ok(Some(score)) => {
            (row.frame, row.covered, row.length) = (Some(score.frame_px), score.covered_px, score.length_mm);
            (row.stated, row.z2, row.z2_parameters) = (score.stated_px, score.z2_frame, score.z2_parameters);
        }
        Ok(None) => {}
        Err(why) => row.message = why,
    }
    Ok((answered.calibrated, row))
}

/// The answer to half of the photographs, and its row with what it predicts of the others.
fn of_half(photographs: &Photographs<'_>, listed: &Listed, mut row: Answered) -> Result<(Calibrated, Answered), RunError> {
    let half = photographs.half(row.trial);
    let calibrated = listed.calibrate(&half.task).map_err(std::io::Error::other)?;
    match calibrated.answer.lens.as_ref().map(|lens| half.held_out.predicted(lens)) {
        Some(Ok(predicted)) => (row.held_out, row.across) = (Some(predicted.interleaved_px), Some(predicted.across_px)),
        Some(Err(why)) => row.message = why,
        None => {}
    }
    Ok((calibrated, row))
}

/// A row with what was answered; where the system says nothing, with what stands in the way of its scores.
fn with_answer(mut row: Answered, Calibrated { answer, seconds, peak_mb }: &Calibrated) -> Answered {
    let Answer { status, messages, rms_px, outliers, .. } = answer;
    status.name().clone_into(&mut row.status);
    if let Some(first) = messages.first() {
        row.message.clone_from(first);
    }
    (row.rms, row.left_out) = (*rms_px, outliers.len());
    (row.seconds, row.peak_mb) = (Some(*seconds), *peak_mb);
    row
}
