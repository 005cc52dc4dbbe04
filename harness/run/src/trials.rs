//! All trials of a plan, in their order.

use calibench_measure::kinds::cover;
use calibench_random::Key;
use calibench_records::parts::Span;
use calibench_records::results::Trial;
use calibench_scenario::{Subject, ViewsSubject};
use rayon::prelude::*;

use super::transfer::Campaign;
use super::{Plan, RunError, photographs, printed, scene, views};

/// Trials that are computed side by side before they are handed on: bounds the memory, whatever the number of trials.
const BATCH: u64 = 32;

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
        cover(self.methods, &self.scenario.subject.kinds(), &self.scenario.kinds)?;
        if self.span().count() == 0 {
            return Ok(());
        }
        self.check_recorded()?;
        match &self.scenario.subject {
            Subject::Photographs(subject) => sink(photographs::run(self, subject, step)?),
            Subject::Printed(printed) => {
                let trial = printed::run(printed);
                step();
                sink(trial)
            }
            Subject::Scene(subject) => {
                let prepared = scene::Prepared::new(self, subject)?;
                self.trials(step, sink, &|number| scene::run_trial(self, &prepared, number))
            }
            Subject::Views(subject) if subject.transfer.is_some() => self.transferred(subject, step, sink),
            Subject::Views(subject) => {
                // Drawn coordinates are those of no image.
                let drawn = subject.calibration.as_ref().is_some_and(|calibration| calibration.drawn.is_some());
                let bounds = if self.bounds && !drawn { views::bounds(self, subject)? } else { None };
                // What is drawn anew in each trial has its bounds there.
                let fixed = bounds.as_ref().filter(|_| !subject.changes());
                let key = Key { seed: self.seed, scenario: &self.scenario.name, trial: 0, view: "", target: "" };
                let prepared = views::Prepared::with(subject, &subject.stations, key, fixed, views::renderer(subject)?)?;
                self.trials(step, sink, &|number| views::run_trial(self, &prepared, bounds.as_ref(), number))
            }
        }
    }

    /// Calibrations that are applied.
    fn transferred(
        &self,
        subject: &ViewsSubject,
        step: &(dyn Fn() + Sync),
        sink: &mut dyn FnMut(Trial) -> Result<(), RunError>,
    ) -> Result<(), RunError> {
        let Some(transfer) = &subject.transfer else { return Ok(()) };
        let campaign = Campaign::new(subject, transfer, self.tools)?;
        let key = |trial| Key { seed: self.seed, scenario: &self.scenario.name, trial, view: "", target: "" };
        self.trials(step, sink, &|number| campaign.trial(key(number)))
    }

    /// Runs trials in batches and hands them on in their order.
    fn trials(
        &self,
        step: &(dyn Fn() + Sync),
        sink: &mut dyn FnMut(Trial) -> Result<(), RunError>,
        trial: &(dyn Fn(u64) -> Result<Trial, RunError> + Sync),
    ) -> Result<(), RunError> {
        let Span { from, to } = self.span();
        for first in (from..to).step_by(BATCH as usize) {
            let batch = first..(first + BATCH).min(to);
            let counted = |number| {
                self.go_on()?;
                let trial = trial(number);
                step();
                trial
            };
            for trial in batch.into_par_iter().map(counted).collect::<Result<Vec<_>, _>>()? {
                sink(trial)?;
            }
        }
        Ok(())
    }
}
