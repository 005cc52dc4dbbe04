//! A calibration as one file that answers questions: the text of the page, with figures in the place of its pictures, and the network.

pub(super) mod network;

use calibench_calibrate::{Calibration, Checked};

use super::warnings::warnings;
use crate::corners::{Corner, Pictured, patches};
use crate::html::{Figures, Groups, Level, Page};

/// The page: `text` is what the Markdown page says below its headline; `figures` take the place of its pictures, `before` is what is in doubt of where a board was found.
pub(super) fn page(
    calibration: &Calibration<'_>,
    (text, mut figures): (&str, Figures),
    corners: &[Corner<'_>],
    (photos, before): (&[Pictured<'_>], &[String]),
) -> String {
    let mut page = Page::new("Calibration");
    let doubts: Vec<String> = before.iter().cloned().chain(calibration.doubts().into_iter().map(|doubt| doubt.words)).collect();
    let (level, sentence) = verdict(calibration, doubts.len());
    page.verdict(level, &sentence, reasons(calibration, doubts));
    let names = calibration.prepared.survey.images.iter();
    let groups: Groups = names.enumerate().map(|(image, name)| (name.clone(), image)).collect();
    page.markdown(text, &mut figures, &groups);
    page.section("The network in space", network::figure(calibration));
    for (key, figure) in patches(corners, photos) {
        page.patch(key, &figure);
    }
    page.render()
}

fn verdict(calibration: &Calibration<'_>, doubts: usize) -> (Level, String) {
    let untested = calibration.checked.iter().filter_map(Checked::untested).count();
    let made = calibration.checked.len() - untested;
    match (doubts, untested) {
        (0, 0) if made > 0 => (Level::Good, format!("No doubt was found by {made} checks of the residuals")),
        (0, _) => (Level::Open, format!("No doubt was found: {made} checks of the residuals were made, {untested} could not be made")),
        (1, _) => (Level::Doubt, "Doubtful, for one reason".into()),
        _ => (Level::Doubt, format!("Doubtful, for {doubts} reasons")),
    }
}

/// Doubts, what was not tested, and what is to be known besides.
fn reasons(calibration: &Calibration<'_>, doubts: Vec<String>) -> Vec<String> {
    let untested = calibration.checked.iter().filter_map(Checked::untested).map(|what| format!("not tested: {what}"));
    doubts.into_iter().chain(untested).chain(warnings(calibration)).collect()
}
