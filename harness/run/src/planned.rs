//! How an order is run, and where it goes.

use calibench_measure::Configured;
use calibench_scenario::no_board;

use crate::parts::{self, Done, Wanted};
use crate::store::{self, RecordsFolder, SweepPlan};
use crate::{Order, Plan, RunError};

/// How it is run.
pub enum Planned<'a> {
    /// A scenario by itself.
    One(Box<Plan<'a>>),
    /// A scenario that is swept.
    Sweep(SweepPlan<'a>),
}

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
    /// How it is run.
    ///
    /// # Errors
    /// [`RunError::Asked`]: methods in a scenario whose methods are its own, several trials where nothing is random, a file of positions in a sweep.
    pub fn planned(self) -> Result<Planned<'a>, RunError> {
        self.own_methods()?;
        let Some(sweep) = &self.scenario.sweep else { return Ok(Planned::One(Box::new(self.plan()?))) };
        let (scenario, methods) = (self.scenario, self.methods);
        if sweep.changes_methods() && !methods.is_empty() {
            return Err(RunError::Asked(format!("-m: `{}` sweeps the parameters of its own methods; leave out -m", scenario.name)));
        }
        if let Some(method) = scenario.methods.iter().chain(methods).find(|method| method.recorded().is_some()) {
            let (label, name) = (&method.label, &scenario.name);
            return Err(RunError::Asked(format!(
                "`{label}` is a file of positions, and `{name}` is a sweep, of which `render` makes the first cell alone; expected a scenario without [sweep]"
            )));
        }
        Ok(Planned::Sweep(SweepPlan { order: self, sweep }))
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

    fn plan(&self) -> Result<Plan<'a>, RunError> {
        self.known_boards()?;
        match self.trials {
            Some(trials) if trials > 1 && self.scenario.is_deterministic() => Err(RunError::Asked(format!(
                "--trials {trials}: nothing is random in `{}`, every trial would be the same; expected 1",
                self.scenario.name
            ))),
            asked => Ok(Plan { trials: asked.unwrap_or(self.scenario.trials), ..self.plan_of(self.scenario) }),
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
}

impl Planned<'_> {
    /// How many steps [`Self::run`] reports, about.
    pub fn steps(&self, place: &Place<'_>) -> u64 {
        match (self, place) {
            (Self::One(plan), Place::Records(_)) => plan.steps(),
            (Self::One(plan), Place::Part(wanted)) => parts::trials(plan, wanted.part).count(),
            (Self::Sweep(plan), Place::Records(_)) => plan.sweep.cells() as u64,
            (Self::Sweep(plan), Place::Part(wanted)) => (plan.sweep.cells() as u64).div_ceil(wanted.part.of()),
        }
    }

    /// The methods that measure.
    pub fn methods(&self) -> &[Configured] {
        match self {
            Self::One(plan) => plan.methods,
            Self::Sweep(plan) => plan.order.measuring(),
        }
    }

    /// Runs it; `step` is called after each step, on any thread.
    ///
    /// # Errors
    /// What the run or the file system refuses, or that it was stopped; what was there before is then as it was.
    pub fn run(&mut self, place: &Place<'_>, revision: &str, step: &(dyn Fn() + Sync)) -> Result<Ran, RunError> {
        Ok(match (self, place) {
            (Self::One(plan), Place::Records(folder)) => Ran::Whole(store::run(folder, plan, revision, step)?),
            (Self::One(plan), Place::Part(wanted)) => Ran::Part(Box::new(parts::run(wanted, plan, step)?)),
            (Self::Sweep(plan), Place::Records(folder)) => Ran::Whole(store::run_sweep(folder, plan, revision, step)?),
            (Self::Sweep(plan), Place::Part(wanted)) => Ran::Part(Box::new(parts::run_sweep(wanted, plan, step)?)),
        })
    }
}
