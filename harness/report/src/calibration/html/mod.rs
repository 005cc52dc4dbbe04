//! A calibration as one file that answers questions: the text of the page, with figures in the place of its pictures, the distortion and the network.

mod maps;
mod network;
mod patches;
mod residuals;

use calibench_calibrate::{Calibration, Verdict};

use super::warnings::warnings;
use crate::html::{Figures, Groups, Level, Page};

pub use patches::Pictured;

/// The page: `text` is what the Markdown page says below its headline.
pub(super) fn page(calibration: &Calibration<'_>, text: &str, photos: &[Pictured<'_>]) -> String {
    let mut page = Page::new("Calibration");
    let (level, sentence) = verdict(calibration);
    page.verdict(level, &sentence, reasons(calibration));
    let names = calibration.prepared.survey.images.iter();
    let groups: Groups = names.enumerate().map(|(image, name)| (name.clone(), image)).collect();
    let worst = residuals::worst(calibration);
    page.markdown(text, &mut figures(calibration, &worst), &groups);
    for camera in 0..calibration.cameras() {
        if let Some(figure) = maps::distortion(calibration, camera) {
            page.section(&format!("Distortion{}", super::of(calibration, camera)), figure);
        }
    }
    page.section("The network in space", network::figure(calibration));
    for (key, figure) in patches::patches(calibration, &worst, photos) {
        page.patch(key, &figure);
    }
    page.render()
}

fn verdict(calibration: &Calibration<'_>) -> (Level, String) {
    let doubts = calibration.doubts().len();
    let of = |is: fn(&Verdict) -> bool| calibration.checked.iter().filter(|checked| is(&checked.verdict)).count();
    let untested = of(|verdict| matches!(verdict, Verdict::Untested(_)));
    let made = calibration.checked.len() - untested;
    match doubts {
        0 => (Level::Good, format!("No doubt was found: {made} checks of the residuals, {untested} could not be made")),
        1 => (Level::Doubt, "Doubtful, for one reason".into()),
        _ => (Level::Doubt, format!("Doubtful, for {doubts} reasons")),
    }
}

/// Doubts, what was not tested, and what is to be known besides.
fn reasons(calibration: &Calibration<'_>) -> Vec<String> {
    let untested = calibration.checked.iter().filter_map(|checked| match &checked.verdict {
        Verdict::Untested(why) => Some(format!("not tested: {}: {why}", checked.what)),
        _ => None,
    });
    let doubts = calibration.doubts().into_iter().map(str::to_owned);
    doubts.chain(untested).chain(warnings(calibration)).collect()
}

/// Figures by the names of the pictures whose place they take.
fn figures(calibration: &Calibration<'_>, worst: &[usize]) -> Figures {
    let mut figures = Figures::new();
    figures.extend(maps::board(calibration).map(|figure| ("board.png".to_owned(), figure)));
    for camera in 0..calibration.cameras() {
        let prefix = if calibration.cameras() > 1 { format!("{}-", calibration.name_of(camera)) } else { String::new() };
        let mut put = |file: &str, figure: String| drop(figures.insert(format!("{prefix}{file}"), figure));
        put("residuals.png", residuals::together(calibration, camera, worst));
        put("distribution.png", maps::distribution(calibration, camera));
        maps::correlations(calibration, camera).into_iter().for_each(|figure| put("correlations.png", figure));
        maps::uncertainty(calibration, camera).into_iter().for_each(|(file, figure)| put(file, figure));
        put("residuals-by-image-1.png", residuals::by_image(calibration, camera));
        // What follows is in the first.
        let images = (0..calibration.prepared.survey.images.len()).filter(|&image| calibration.owner(image) == camera).count();
        (2..=images / super::pictures::PANELS + 1).for_each(|number| put(&format!("residuals-by-image-{number}.png"), String::new()));
    }
    figures
}
