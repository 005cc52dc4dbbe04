//! What pages show of each study: a folder for each, with its section in `section.rs`, that of a sweep in `sweep.rs`, and the tables and pictures of both.

mod accepted;
mod blocks;
mod calibrators;
mod network;
mod networks;
mod photographs;
mod points;
mod printed;
mod recognition;
mod scored;
mod section;
mod shown;
mod tasks;
mod transfer;

#[cfg(test)]
mod tests;

/// The worked example of CONTRIBUTING, linked from `examples/`.
#[cfg(test)]
mod example;

use calibench_records::description::{Description, Study};

pub use section::Section;
pub use shown::{OnPage, Shown};

/// The study of a scenario. A new one is a line here.
pub fn of(scenario: &Description) -> &'static dyn Section {
    match &scenario.study {
        Study::Scene | Study::Views(_) => &points::Points,
        Study::Network(..) => &network::Network,
        Study::Blocks(..) => &blocks::Blocks,
        Study::Calibrators(..) => &calibrators::Calibrators,
        Study::Networks(..) => &networks::Networks,
        Study::Tasks(..) => &tasks::Tasks,
        Study::Transfer(_) => &transfer::Transfer,
        Study::Photographs { .. } => &photographs::Photographs,
        Study::Printed(_) => &printed::Printed,
    }
}
