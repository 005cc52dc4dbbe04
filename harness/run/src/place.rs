//! How an order is run, and where it goes.

use calibench_scenario::{Sweep, no_board};

use crate::parts::{self, Done, Wanted};
use crate::store::{self, RecordsFolder, SweepPlan};
use crate::{Order, Plan, RunError};

/// Where what is run goes.
pub enum Place<'a> {
    /// To records.
    Records(&'a RecordsFolder),
    /// To a folder of parts.
    Part(Wanted<'a>),
}

/// What became of a run.
pub enum Ran {
    /// How many points were measured, or calibrations applied, or sets of printed figures recomputed.
    Whole(u64),
    /// A part is there.
    Part(Box<Done>),
}

impl<'a> Order<'a> {
    /// Whether it can be run.
    ///
    /// # Errors
    /// [`RunError::Asked`]: methods in a scenario whose methods are its own, several trials where nothing is random, a file of positions in a sweep.
    pub fn check(&self) -> Result<(), RunError> {
        self.own_methods()?;
        let (scenario, methods) = (self.scenario, self.methods);
        let Some(sweep) = &scenario.sweep else {
            self.known_boards()?;
            return self.random_trials();
        };
        if sweep.changes_methods() && !methods.is_empty() {
            return Err(RunError::Asked(format!("-m: `{}` sweeps the parameters of its own methods; leave out -m", scenario.name)));
        }
        if let Some(method) = scenario.methods.iter().chain(methods).find(|method| method.recorded().is_some()) {
            let (label, name) = (&method.label, &scenario.name);
            return Err(RunError::Asked(format!(
                "`{label}` is a file of positions, and `{name}` is a sweep, of which `render` makes the first cell alone; expected a scenario without [sweep]"
            )));
        }
        Ok(())
    }

    /// Whether every method of the order that finds boards knows the board of a scenario that is not swept; of its own methods its file was checked.
    ///
    /// # Errors
    /// [`RunError::Asked`]: the first that does not, and why.
    fn known_boards(&self) -> Result<(), RunError> {
        let name = &self.scenario.name;
        for (method, finder) in self.methods.iter().filter_map(|method| Some((method, method.board_finder()?))) {
            if let Some(why) = no_board(&self.scenario.subject, finder) {
                return Err(RunError::Asked(format!("`{}` finds boards, and in `{name}` {why}", method.label)));
            }
        }
        Ok(())
    }

    /// Whether trials that are asked for differ, of a scenario that is not swept.
    fn random_trials(&self) -> Result<(), RunError> {
        match self.trials {
            Some(trials) if trials > 1 && self.scenario.is_deterministic() => Err(RunError::Asked(format!(
                "--trials {trials}: nothing is random in `{}`, every trial would be the same; expected 1",
                self.scenario.name
            ))),
            _ => Ok(()),
        }
    }

    /// Calibrations that are applied, and printed figures, are a scenario's own: none of the methods that measure takes their place.
    fn own_methods(&self) -> Result<(), RunError> {
        if self.scenario.subject.is_measured() || self.methods.is_empty() {
            return Ok(());
        }
        let name = &self.scenario.name;
        Err(RunError::Asked(format!("-m: `{name}` measures nothing: its calibrations or printed figures are its own; leave out -m")))
    }

    /// How it is run; `None` of a sweep, whose cells have a plan each.
    pub fn plan(&self) -> Option<Plan<'a>> {
        self.scenario.sweep.is_none().then(|| self.single())
    }

    fn single(&self) -> Plan<'a> {
        Plan { trials: self.trials.unwrap_or(self.scenario.trials), ..self.plan_of(self.scenario) }
    }

    /// How many steps [`Self::run`] reports, about.
    pub fn steps(&self, place: &Place<'_>) -> u64 {
        let cells = self.scenario.sweep.as_ref().map_or(0, Sweep::cells) as u64;
        match (self.plan(), place) {
            (Some(plan), Place::Records(_)) => plan.steps(),
            (Some(plan), Place::Part(wanted)) => parts::trials(&plan, wanted.part).count(),
            (None, Place::Records(_)) => cells,
            (None, Place::Part(wanted)) => cells.div_ceil(wanted.part.of()),
        }
    }

    /// Checks and runs it; `step` is called after each step, on any thread.
    ///
    /// # Errors
    /// As [`Self::check`]; what the run or the file system refuses, or that it was stopped; what was there before is then as it was.
    pub fn run(&self, place: &Place<'_>, revision: &str, step: &(dyn Fn() + Sync)) -> Result<Ran, RunError> {
        self.check()?;
        let swept = self.scenario.sweep.as_ref().map(|sweep| SweepPlan { order: self, sweep });
        Ok(match (swept, place) {
            (Some(plan), Place::Records(folder)) => Ran::Whole(store::run_sweep(folder, &plan, revision, step)?),
            (Some(plan), Place::Part(wanted)) => Ran::Part(Box::new(parts::run_sweep(wanted, &plan, step)?)),
            (None, Place::Records(folder)) => Ran::Whole(store::run(folder, &self.single(), revision, step)?),
            (None, Place::Part(wanted)) => Ran::Part(Box::new(parts::run(wanted, &self.single(), step)?)),
        })
    }
}
