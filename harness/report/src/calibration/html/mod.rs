//! A calibration as one file that answers questions: the text of the page, with figures in the place of its pictures, the distortion and the network.

mod maps;
pub(super) mod network;
mod residuals;

use calibench_calibrate::{Calibration, Checked};

use super::images_of;
use super::pictures::{PANELS, named};
use super::uncertainty::UncertaintyMap;
use super::warnings::warnings;
use crate::corners::{Corner, Pictured, patches};
use crate::html::{Figures, Groups, Level, Page};

/// Whose figures are made.
struct OfCamera<'c, 'n> {
    calibration: &'c Calibration<'n>,
    camera: usize,
    /// Of its uncertainty.
    maps: &'c [UncertaintyMap],
    /// What stands before the names and before the captions of its figures.
    prefix: String,
    whose: String,
}

impl<'c, 'n> OfCamera<'c, 'n> {
    fn new(calibration: &'c Calibration<'n>, camera: usize, maps: &'c [UncertaintyMap]) -> Self {
        let (prefix, whose) = named(calibration, camera);
        Self { calibration, camera, maps, prefix, whose }
    }

    /// The name of a figure in the page: no two have the same.
    fn id(&self, name: &str) -> String {
        format!("{}{name}", self.prefix)
    }

    fn caption(&self, text: &str) -> String {
        format!("{}{text}", self.whose)
    }
}

/// The page: `text` is what the Markdown page says below its headline; `maps` are the uncertainty's, camera by camera, `next` the figures of what to photograph next, `before` what is in doubt of where a board was found.
pub(super) fn page(
    calibration: &Calibration<'_>,
    text: &str,
    (maps, next): (&[Vec<UncertaintyMap>], Figures),
    (photos, before): (&[Pictured<'_>], &[String]),
) -> String {
    let mut page = Page::new("Calibration");
    let doubts: Vec<String> = before.iter().cloned().chain(calibration.doubts().into_iter().map(|doubt| doubt.words)).collect();
    let (level, sentence) = verdict(calibration, doubts.len());
    page.verdict(level, &sentence, reasons(calibration, doubts));
    let names = calibration.prepared.survey.images.iter();
    let groups: Groups = names.enumerate().map(|(image, name)| (name.clone(), image)).collect();
    let corners = residuals::corners(calibration);
    let cameras: Vec<OfCamera<'_, '_>> = maps.iter().enumerate().map(|(camera, maps)| OfCamera::new(calibration, camera, maps)).collect();
    let mut figures = figures(&cameras, &corners);
    figures.extend(next);
    page.markdown(text, &mut figures, &groups);
    for of in &cameras {
        if let Some(figure) = maps::distortion(of) {
            page.section(&format!("Distortion{}", calibration.of(of.camera)), figure);
        }
    }
    page.section("The network in space", network::figure(calibration));
    for (key, figure) in patches(&corners, photos) {
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

/// Figures by the names of the pictures whose place they take.
fn figures(cameras: &[OfCamera<'_, '_>], corners: &[Corner<'_>]) -> Figures {
    let mut figures = Figures::new();
    figures.extend(cameras.first().and_then(|of| maps::board(of.calibration)).map(|figure| ("board.png".to_owned(), figure)));
    for of in cameras {
        let mut put = |name: &str, figure: String| drop(figures.insert(format!("{}.png", of.id(name)), figure));
        put("residuals", residuals::together(of, corners));
        put("distribution", maps::distribution(of));
        maps::correlations(of).into_iter().for_each(|figure| put("correlations", figure));
        maps::uncertainty(of).into_iter().for_each(|(name, figure)| put(name, figure));
        put("residuals-by-image-1", residuals::by_image(of));
        // What follows is in the first.
        let images = images_of(of.calibration, of.camera).count();
        (2..=images / PANELS + 1).for_each(|number| put(&format!("residuals-by-image-{number}"), String::new()));
    }
    figures
}
