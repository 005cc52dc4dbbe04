//! What photographs say about operators and camera models: one page, made from the records of a judgement.

mod board;
mod figures;
mod html;
mod tables;
mod verdict;
mod words;

use calibench_records::judgement::{Summary, Trusted};

use super::canvas::Canvas;
use super::plot::Figure;

pub use html::{Measured, page};
pub use verdict::{in_use, verdict};

/// The operator and the model to trust, and how far, in a sentence or two; `None` where nothing could be judged.
pub fn answer(summary: &Summary) -> Option<String> {
    let trusted = summary.unavailable.is_none().then(|| summary.trusted())??;
    verdict(summary, &trusted).lines().next().map(|line| line.trim_start_matches("- ").to_owned())
}

/// What the figures of a judgement show.
fn figures(summary: &Summary, trusted: &Trusted<'_>) -> Vec<Figure> {
    let mut all = vec![figures::holdout(summary, trusted), figures::views(summary, &trusted.cell.model)];
    all.extend(figures::halves(trusted.cell));
    all.extend(trusted.cell.principal.as_ref().map(figures::principal));
    all
}

/// The text of the section, and its pictures with their file names.
pub fn section(summary: &Summary) -> (String, Vec<(String, Canvas)>) {
    let heading = "### Which operator, which model, and how far\n\n";
    if let Some(why) = &summary.unavailable {
        return (format!("{heading}**unavailable**: {why}.\n\n"), Vec::new());
    }
    let Some(trusted) = summary.trusted() else {
        let why = summary.cells.iter().find_map(|cell| cell.trouble.as_deref()).unwrap_or("no operator measured enough corners");
        return (format!("{heading}Nothing could be judged: {why}.\n\n"), Vec::new());
    };
    let mut text = format!("{heading}{}\n", verdict(summary, &trusted));
    let mut pictures = Vec::new();
    let figures = figures(summary, &trusted);
    let mut show = |text: &mut String, names: &[&str], heading: &str, about: &str| {
        text.push_str(&format!("### {heading}\n\n{about}\n\n"));
        for figure in names.iter().filter_map(|name| figures.iter().find(|figure| figure.name == *name)) {
            text.push_str(&format!("![{}]({})\n\n", figure.caption, figure.file()));
            pictures.push((figure.file(), figure.picture()));
        }
    };
    show(&mut text, &["holdout"], "Photographs that the camera has not seen", &tables::about_holdout(summary));
    text.push_str(&tables::cells(summary));
    let about = "The photographs are split into two halves at random, each calibrates a camera, and the two are compared over the frame after the best rotation. \
                 The predicted difference comes from the covariances of both. Empirical over predicted: over the frame, and in the modes of the difference \
                 (each over its own standard deviation, so that the frame's corners do not decide alone); p is twice the median over the splits, a bound that \
                 holds although splits of the same photographs depend on each other.";
    show(&mut text, &["halves", "halves-predicted"], "Halves of the photographs: are the sigmas honest?", about);
    text.push_str(&tables::halves(summary));
    let about = format!(
        "With `{}`: RMS residual of each photograph in the adjustment of all. A photograph is named where its RMS is larger than that of the others by more \
         than their own scatter explains (logarithms, median and median absolute deviation, Holm over all photographs, alpha {}).",
        trusted.cell.model,
        calibench_records::judgement::OUTLIER_ALPHA
    );
    show(&mut text, &["views"], "Photograph by photograph", &about);
    text.push_str(&tables::views(summary, &trusted));
    let about = format!("With `{}` and `{}`.", trusted.cell.method, trusted.cell.model);
    show(&mut text, &["principal-point"], "The principal point, again and again", &about);
    text.push_str(&tables::principal(summary, &trusted.cell.model));
    (text, pictures)
}

#[cfg(test)]
mod tests;
