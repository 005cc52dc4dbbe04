//! What the model may leave out: the checks of a calibration, for the page and the terminal.

use calibench_calibrate::{Calibration, Checked, Finding, SHARE, Verdict};

use calibench_model::escape;

use crate::markdown::MarkdownTable;
use crate::plain;

/// A probability that nobody takes for chance.
const UNLIKELY: f64 = 1e-4;

/// What stands first if there is doubt: the most likely cause. It holds names as their files have them.
pub(super) fn headline(calibration: &Calibration<'_>) -> Option<String> {
    let doubts = calibration.doubts();
    (!doubts.is_empty()).then(|| format!("doubtful: {}", doubts.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")))
}

/// What was looked for, in a line.
pub(super) fn fact(calibration: &Calibration<'_>) -> Option<String> {
    let one = |checked: &Checked| match &checked.verdict {
        Verdict::Untested(_) => format!("{} not tested", checked.subject.what()),
        Verdict::Sound(_) => format!("{} sound", checked.subject.what()),
        Verdict::Slight(..) => format!("{} found, too little to matter", checked.subject.what()),
        Verdict::Doubt(..) => format!("{} DOUBTFUL", checked.subject.what()),
    };
    let all: Vec<String> = calibration.checked.iter().map(one).collect();
    (!all.is_empty()).then(|| format!("checks: {}", all.join(", ")))
}

/// What was found and does not matter.
pub(super) fn slight<'c>(calibration: &'c Calibration<'_>) -> impl Iterator<Item = String> + 'c {
    calibration.checked.iter().filter_map(|checked| match &checked.verdict {
        Verdict::Slight(finding, cause) => {
            let moves = finding
                .moves
                .map_or_else(String::new, |moves| format!("; the camera moves by {} of its standard deviations", plain(moves)));
            Some(format!("{cause}{moves}"))
        }
        _ => None,
    })
}

/// The section of the page.
pub(super) fn section(calibration: &Calibration<'_>) -> String {
    if calibration.checked.is_empty() {
        return String::new();
    }
    let mut table = MarkdownTable::new(&["looked for", "p", "moves the camera by", "verdict"]);
    for checked in &calibration.checked {
        let (finding, verdict) = match &checked.verdict {
            Verdict::Untested(why) => (None, format!("not tested: {why}")),
            Verdict::Sound(finding) if finding.p < UNLIKELY => {
                (Some(finding), "sound: another cause explains what was found, or it is rounding".to_owned())
            }
            Verdict::Sound(finding) => (Some(finding), "sound".to_owned()),
            Verdict::Slight(finding, cause) => (Some(finding), format!("{}; too little to matter", escape::markdown(cause))),
            Verdict::Doubt(finding, cause) => (Some(finding), format!("**{}**", escape::markdown(cause))),
        };
        let (p, moves) = finding.map_or_else(Default::default, cells);
        table.row([checked.subject.what().to_owned(), p, moves, verdict]);
    }
    format!(
        "\n## What the model may leave out\n\n{}\np: the probability of residuals as uneven by chance. The camera moves by so many of its standard deviations over the \
         frame (RMS, after the best rotation) when what was looked for is allowed for; it counts beyond {SHARE}.\n",
        table.render()
    )
}

fn cells(finding: &Finding) -> (String, String) {
    let p = if finding.p < UNLIKELY { "< 0.0001".to_owned() } else { format!("{:.4}", finding.p) };
    (p, finding.moves.map_or(String::new(), plain))
}
