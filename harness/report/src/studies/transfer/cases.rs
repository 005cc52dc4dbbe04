//! Every case with every method.

use calibench_records::figures::Quantity;

use crate::load::adjustments::{Summaries, Summary};
use crate::markdown::{MarkdownTable, fixed, with_half};

/// Errors of check points, cm or the object unit's hundredth.
const ERRORS: [(Quantity, &str); 5] = [
    (Quantity::RmseX, "X"),
    (Quantity::RmseY, "Y"),
    (Quantity::RmseZ, "Z"),
    (Quantity::RmseXy, "planimetric"),
    (Quantity::RmseXyz, "in space"),
];

/// A figure in hundredths of the object unit, with half the 95 % interval of its mean.
pub fn hundredths(summary: Option<&Summary>) -> String {
    let text = |summary: &Summary| Some(with_half(100.0 * summary.value.mean()?, summary.value.half().map(|half| 100.0 * half), 2));
    summary.and_then(text).unwrap_or_default()
}

/// The cases, each with the methods that it takes.
pub fn table(found: &Summaries) -> String {
    let header = ["case", "method"].into_iter().chain(ERRORS.map(|(_, name)| name)).chain(["camera, px", "error of c, mm", "failed"]);
    let mut rows = MarkdownTable::new(&header.collect::<Vec<_>>());
    for set in &found.sets {
        for method in &found.methods {
            let of = |quantity: Quantity| found.of_set(method, set, quantity);
            let failed = found.failures(method, Some(set));
            if of(Quantity::RmseXyz).is_none() && (failed == 0 || !is_case(found, set)) {
                continue;
            }
            let errors = ERRORS.map(|(quantity, _)| hundredths(of(quantity)));
            let camera = of(Quantity::OverFrame).and_then(|s| Some(with_half(s.value.mean()?, s.value.half(), 2))).unwrap_or_default();
            let c = found
                .of_set(method, set, Quantity::Parameter.of(&["c"]))
                .and_then(|s| s.square.mean())
                .map_or_else(String::new, |square| fixed(square.sqrt(), 3));
            rows.row([set.clone(), method.clone()].into_iter().chain(errors).chain([camera, c, failed.to_string()]));
        }
    }
    let why: String = found
        .failed
        .iter()
        .map(|((method, set, _), (count, why))| {
            format!("- {set}, {method}: {count} of {} trials failed, the first because {why}.\n", found.trials)
        })
        .collect();
    let of_trials = match found.trials {
        1 => "one trial".to_owned(),
        trials => format!("mean of {trials} trials ± half its 95 % interval"),
    };
    format!(
        "### Cases\n\nRoot mean square errors of the check points against the truth, in hundredths of the object unit (cm where it is m), {of_trials}. *Camera*: distance of the applied camera from the true one \
         over the frame after the best rotation. *Error of c*: root mean square.\n\n{}\n{why}\n",
        rows.render()
    )
}

fn is_case(found: &Summaries, set: &str) -> bool {
    found.methods.iter().any(|method| found.of_set(method, set, Quantity::RmseXyz).is_some())
}
