//! What a run makes of what a scenario shows: a folder for each study, with its figures in `figures.rs` where they are many.

mod accepted;
mod adjust;
pub mod blocks;
pub mod calibrators;
pub mod network;
pub mod networks;
pub mod printed;
pub mod recognition;
pub mod tasks;
mod told;
pub mod transfer;

/// The worked example of CONTRIBUTING, linked from `examples/`.
#[cfg(test)]
pub(crate) mod example;

use calibench_records::results::MethodInfo;
use calibench_scenario::{Study, Subject};

use crate::Tools;
pub use adjust::Adjust;

/// What a study makes of image points; `None` of one that adjusts none. A new study is a line here.
pub(crate) fn of<'a>(study: &'a Study, tools: Tools<'a>) -> Option<Box<dyn Adjust + 'a>> {
    match study {
        Study::Network(plan) => Some(Box::new(&**plan)),
        Study::Blocks(plan) => Some(Box::new(&**plan)),
        Study::Calibrators(plan) => Some(Box::new(calibrators::Study { plan, tools })),
        Study::Networks(plan) => Some(Box::new(&**plan)),
        Study::Tasks(plan) => Some(Box::new(&**plan)),
        Study::Points | Study::Transfer { .. } => None,
    }
}

/// The methods of a study's own as results list them; `None` where image points are measured.
pub(crate) fn method_infos(subject: &Subject, tools: Tools<'_>) -> Option<Vec<MethodInfo>> {
    match subject {
        Subject::Printed(_) => Some(printed::method_infos()),
        Subject::Views(views) => Some(transfer::method_infos(views.study.transfer()?, tools)),
        Subject::Scene(_) | Subject::Photographs(_) => None,
    }
}
