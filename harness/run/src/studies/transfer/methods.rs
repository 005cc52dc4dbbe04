//! Calibrations that are applied, in the place of methods.

use calibench_records::results::MethodInfo;
use calibench_scenario::Transfer;
use calibench_scenario::studies::transfer::{Calibrates, Method, Solver};

use crate::Tools;

/// The version of calibration methods: raised when their numbers change on purpose.
const VERSION: &str = "1";

/// The calibrations of `transfer` as results list them.
pub(crate) fn method_infos(transfer: &Transfer, tools: Tools<'_>) -> Vec<MethodInfo> {
    let info = |(place, method): (usize, &Method)| MethodInfo {
        label: method.name.as_str().into(),
        version: version(method, tools).into(),
        unavailable: tools.lack(transfer, place),
    };
    transfer.methods.iter().enumerate().map(info).collect()
}

/// The version of a calibration, with those of what measures for it and solves for it.
fn version(method: &Method, tools: Tools<'_>) -> String {
    let measuring = method.measured_by.iter().map(|measuring| format!("{} {}", measuring.operator.label, measuring.operator.version));
    let solver = match method.calibrates {
        Calibrates::FromBoard { solver: Solver::Opencv, .. } => {
            tools.solver.map(|solver| format!("{} {}", solver.name(), solver.version()))
        }
        _ => None,
    };
    [VERSION.to_owned()].into_iter().chain(measuring).chain(solver).collect::<Vec<_>>().join(", ")
}
