//! Scores of points: tables of errors, the poses of a board, images with all results. Also of a study whose records hold no figures of its own.

use super::recognition;
use super::shown::{OnPage, Shown};
use crate::load::{Loaded, LoadedSweep};
use crate::{LoadError, poses, scene_figures, scores_section, sweep as swept};

/// The scores of a scenario.
pub fn section(loaded: &Loaded, OnPage { stem, .. }: OnPage<'_>) -> Shown {
    let mut shown = Shown { text: scores_section::section(loaded) + "\n", scored: true, ..Shown::default() };
    if let Some(canvas) = poses::of(&loaded.scenario) {
        let file = format!("{stem}-poses.png");
        shown.text.push_str(&format!("{0}:\n\n![{0}]({file})\n\n", poses::CAPTION));
        shown.pictures.push((file, canvas));
    }
    if let Some(figures) = scene_figures::figures(loaded) {
        shown.text.push_str(&format!(
            "The image of the first trial with {0}, and {1}, with all results:\n\n\
             ![The image with {0}]({stem}.png)\n\n![Targets with all results]({stem}-targets.png)\n\n",
            figures.marked, figures.shown
        ));
        shown.pictures.push((format!("{stem}.png"), figures.overview));
        shown.pictures.push((format!("{stem}-targets.png"), figures.panels));
    }
    shown
}

/// The scores of a sweep, or what was recognised in it, where the records count that.
///
/// # Errors
/// Records that cannot be read, or do not belong together.
pub fn sweep(loaded: &LoadedSweep, OnPage { stem, .. }: OnPage<'_>) -> Result<Shown, LoadError> {
    if recognition::is_counted(loaded)? {
        return Ok(Shown { text: recognition::sweep(loaded)?, ..Shown::default() });
    }
    let (text, picture) = swept::section(loaded, stem);
    let pictures = picture.map(|picture| (format!("{stem}.png"), picture)).into_iter().collect();
    Ok(Shown { text, pictures, scored: true, ..Shown::default() })
}
