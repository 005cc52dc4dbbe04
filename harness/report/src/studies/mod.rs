//! What pages show of each study: a folder for each, with its section in `section.rs`, that of a sweep in `sweep.rs`, and the tables and pictures of both.

mod blocks;
mod network;
mod photographs;
mod points;
mod printed;
mod recognition;
mod scored;
mod section;
mod shown;
mod transfer;

use calibench_records::description::{Description, Study, Subject};

pub use section::Section;
pub use shown::{OnPage, Shown};

/// The study of a scenario. A new one is a line here.
pub fn of(scenario: &Description) -> &'static dyn Section {
    match &scenario.subject {
        Subject::Scene => &points::Points,
        Subject::Photographs { .. } => &photographs::Photographs,
        Subject::Printed(_) => &printed::Printed,
        Subject::Views(views) => match views.study {
            Study::Points => &points::Points,
            Study::Network(_) => &network::Network,
            Study::Blocks(_) => &blocks::Blocks,
            Study::Transfer => &transfer::Transfer,
        },
    }
}
