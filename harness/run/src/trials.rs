//! All trials of a plan, in their order.

use calibench_measure::coverage::cover;
use calibench_random::Key;
use calibench_records::parts::Span;
use calibench_records::results::{Calibrated, Trial};
use calibench_scenario::{PhotographsSubject, Printed, Study, Subject};
use rayon::prelude::*;

use super::bounding::Bounding;
use super::made::Made;
use super::studies::printed;
use super::studies::transfer::Campaign;
use super::{Plan, RunError, photographs, scene, views};

/// Trials that are computed side by side before they are handed on: bounds the memory, whatever the number of trials.
pub(crate) const BATCH: u64 = 32;

/// What makes the trials of a plan, with what is the same in all of them.
pub(crate) enum Work<'a> {
    /// Nothing: all is there.
    Nothing,
    /// Photographs.
    Photographs(&'a PhotographsSubject),
    /// Printed figures.
    Printed(&'a Printed),
    /// A rendered scene.
    Scene(Box<scene::Trials<'a>>),
    /// Views of a testfield.
    Views(Box<views::Trials<'a>>),
    /// Calibrations that are applied.
    Transfer(Box<Campaign<'a>>),
}

impl Work<'_> {
    /// Measures trial `number` with the methods that `plan` asks for, and adjusts what is not adjusted apart; `step` is called after each step, on any thread.
    pub fn measured(&self, plan: &Plan<'_>, number: u64, step: &(dyn Fn() + Sync)) -> Result<Made, RunError> {
        let made = match self {
            Self::Photographs(subject) => return Ok(photographs::run(plan, subject, step)?.into()),
            Self::Nothing => Made::default(),
            Self::Printed(printed) => printed::run(printed).into(),
            Self::Scene(trials) => scene::run_trial(plan, trials, number)?.into(),
            Self::Views(trials) => trials.measured(plan, number)?,
            Self::Transfer(campaign) => campaign.trial(plan.key(number))?.into(),
        };
        step();
        Ok(made)
    }
}

impl Plan<'_> {
    /// How many steps [`Plan::run`] reports.
    pub fn steps(&self) -> u64 {
        match &self.scenario.subject {
            Subject::Scene(_) | Subject::Views(_) | Subject::Printed(_) => self.span().count(),
            Subject::Photographs(photographs) => photographs.files.len() as u64 * self.span().count(),
        }
    }

    /// Runs all trials, or those that are wanted, and hands them to `sink` in their order; `step` is called after each step, on any thread.
    ///
    /// # Errors
    /// Targets of a kind that no method measures, a method without targets of its kinds; a recorded one with names of others; photographs that cannot be read; what `sink` returns.
    pub fn run(&self, step: &(dyn Fn() + Sync), sink: &mut dyn FnMut(Trial) -> Result<(), RunError>) -> Result<(), RunError> {
        self.check()?;
        if self.span().count() == 0 {
            return Ok(());
        }
        let work = self.work()?;
        let trial = |number| {
            self.go_on()?;
            let mut made = work.measured(self, number, step)?;
            if self.is_adjusted_apart() {
                made.trial.calibrations = self.adjust(&made.trial, number);
            }
            Ok(made.into_trial())
        };
        let Span { from, to } = self.span();
        for first in (from..to).step_by(BATCH as usize) {
            let batch = first..(first + BATCH).min(to);
            for trial in batch.into_par_iter().map(trial).collect::<Result<Vec<_>, RunError>>()? {
                sink(trial)?;
            }
        }
        Ok(())
    }

    /// Whether its methods are those of its targets.
    pub(crate) fn check(&self) -> Result<(), RunError> {
        cover(self.methods, &self.scenario.subject.kinds(), &self.scenario.kinds)?;
        if self.span().count() == 0 { Ok(()) } else { self.check_recorded() }
    }

    /// What makes the trials.
    pub(crate) fn work(&self) -> Result<Work<'_>, RunError> {
        Ok(match &self.scenario.subject {
            Subject::Photographs(subject) => Work::Photographs(subject),
            Subject::Printed(printed) => Work::Printed(printed),
            Subject::Scene(subject) => Work::Scene(Box::new(scene::Trials::new(self, subject)?)),
            Subject::Views(subject) => match &subject.study {
                Study::Transfer { plan, board } => Work::Transfer(Box::new(Campaign::new(subject, plan, board.as_deref(), self.tools)?)),
                Study::Points | Study::Network(_) | Study::Blocks(_) | Study::Calibrators(_) | Study::Networks(_) | Study::Tasks(_) => {
                    Work::Views(Box::new(views::Trials::new(self, subject)?))
                }
            },
        })
    }

    /// What computes the bounds of the methods that are asked for, apart from measuring.
    pub(crate) fn bounding(&self) -> Result<Bounding<'_>, RunError> {
        Ok(match &self.scenario.subject {
            Subject::Scene(subject) => Bounding::Scene(Box::new(scene::Trials::new(self, subject)?)),
            Subject::Views(subject) => Bounding::views(views::Trials::new(self, subject)?),
            Subject::Photographs(_) | Subject::Printed(_) => Bounding::Nothing,
        })
    }

    /// The key of a trial's random numbers.
    pub(crate) fn key(&self, trial: u64) -> Key<'_> {
        Key { seed: self.seed, of: &self.scenario.drawn, trial, view: "", target: "" }
    }

    /// Whether what is made of points is made apart from them: where all of them are kept, so that they can be adjusted again.
    pub(crate) fn is_adjusted_apart(&self) -> bool {
        matches!(&self.scenario.subject, Subject::Views(subject) if views::is_adjusted_apart(subject))
    }

    /// What is made of the points of trial `number`, apart, of the methods that are asked for.
    pub(crate) fn adjust(&self, trial: &Trial, number: u64) -> Vec<Calibrated> {
        match &self.scenario.subject {
            Subject::Views(subject) => views::adjusted(self, subject, &trial.points, self.key(number)),
            Subject::Scene(_) | Subject::Photographs(_) | Subject::Printed(_) => Vec::new(),
        }
    }
}
