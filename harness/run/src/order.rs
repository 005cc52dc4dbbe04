//! A run that is asked for: a scenario, and what differs from its file.

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use calibench_measure::{Configured, Registry};
use calibench_scenario::Scenario;

use crate::tally::Reuse;
use crate::{Plan, Tools};

/// What is asked for.
pub struct Order<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// Methods in place of its own, if there are any.
    pub methods: &'a [Configured],
    /// The number of trials in place of its own.
    pub trials: Option<u64>,
    /// The seed in place of its own.
    pub seed: Option<u64>,
    /// What this build has beside its methods.
    pub tools: Tools<'a>,
    /// Where photographs are.
    pub data: PathBuf,
    /// The store of results, if there is one.
    pub reuse: Option<Reuse<'a>>,
    /// All methods that there are.
    pub registry: &'a Registry,
    /// Ends the run before its next trial, once it is true.
    pub stop: Option<&'a AtomicBool>,
}

impl<'a> Order<'a> {
    /// The methods that measure.
    pub fn measuring(&self) -> &'a [Configured] {
        if self.methods.is_empty() { &self.scenario.methods } else { self.methods }
    }

    /// The seed.
    pub fn seed(&self) -> u64 {
        self.seed.unwrap_or(self.scenario.seed)
    }

    /// How `scenario`, its own or a cell of its own, is run with its own number of trials.
    pub(crate) fn plan_of<'p>(&self, scenario: &'p Scenario) -> Plan<'p>
    where
        'a: 'p,
    {
        let mut plan = Plan { stop: self.stop, reuse: self.reuse, ..Plan::new(scenario, self.tools, self.data.clone()) };
        if !self.methods.is_empty() {
            plan.methods = self.methods;
        }
        plan.seed = self.seed.unwrap_or(scenario.seed);
        plan
    }
}
