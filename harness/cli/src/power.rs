//! `calibench gate-power`: what the gate sees, and how often it is wrong, on this project's own baselines.

use calibench_gate::power::{alarms, page, power, sweep_power};
use calibench_gate::{Cells, Coordinates, PointSums, Table, baseline_path, read_baseline};
use clap::Args;

use super::context::Context;
use crate::deliver::print;
use crate::failure::Failure;

#[derive(Args)]
pub struct Power {
    /// How many random divisions of the stored trials
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    divisions: u32,
}

impl Power {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let folder = context.root()?.join("reference/baselines");
        let (mut tables, mut sweeps): (Vec<Table>, Vec<Cells<PointSums>>) = (Vec::new(), Vec::new());
        for name in context.catalogue()?.names()? {
            let scenario = context.scenario(&name)?;
            let path = baseline_path(&folder, &name);
            if scenario.sweep.is_some() {
                sweeps.extend(Cells::read(&path, &name)?.map(|(cells, _)| cells));
                continue;
            }
            if scenario.is_deterministic() {
                continue;
            }
            let Some((table, _)) = read_baseline(&path, &name)? else { continue };
            if table.coordinates == Coordinates::Errors && table.trials() > 1 {
                tables.push(table);
            }
        }
        if tables.is_empty() {
            return Err(Failure::input("no scenario with random trials has a baseline: there is nothing to measure the gate with"));
        }
        let tables: Vec<&Table> = tables.iter().collect();
        print(&page(&power(&tables), &sweep_power(&sweeps), &alarms(&tables, self.divisions as usize)))
    }
}
