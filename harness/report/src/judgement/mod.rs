//! What photographs say about operators and camera models: one page, made from the records of a judgement.

mod html;
mod map;
mod matrix;
mod principal;
mod tables;
mod verdict;
mod views;

use calibench_records::judgement::Summary;

use super::canvas::Canvas;

pub use html::{Measured, page};
pub use verdict::{in_use, verdict};

/// The operator and the model to trust, and how far, in a sentence or two; `None` where nothing could be judged.
pub fn answer(summary: &Summary) -> Option<String> {
    let trusted = summary.unavailable.is_none().then(|| summary.trusted())??;
    verdict(summary, &trusted).lines().next().map(|line| line.trim_start_matches("- ").to_owned())
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
    let mut show = |text: &mut String, file: &str, heading: &str, about: &str, canvas: Option<Canvas>| {
        text.push_str(&format!("### {heading}\n\n{about}\n\n"));
        if let Some(canvas) = canvas {
            text.push_str(&format!("![{heading}]({file})\n\n"));
            pictures.push((file.to_owned(), canvas));
        }
    };
    show(
        &mut text,
        "holdout.png",
        "Photographs that the camera has not seen",
        &tables::about_holdout(summary),
        Some(matrix::picture(summary, &trusted)),
    );
    text.push_str(&tables::cells(summary));
    let about = "The photographs are split into two halves at random, each calibrates a camera, and the two are compared over the frame after the best rotation. \
                 The predicted difference comes from the covariances of both. Empirical over predicted: over the frame, and in the modes of the difference \
                 (each over its own standard deviation, so that the frame's corners do not decide alone); p is twice the median over the splits, a bound that \
                 holds although splits of the same photographs depend on each other.";
    show(&mut text, "halves.png", "Halves of the photographs: are the sigmas honest?", about, map::picture(trusted.cell));
    text.push_str(&tables::halves(summary));
    let about = format!(
        "With `{}`: RMS residual of each photograph in the adjustment of all. A photograph is named where its RMS is larger than that of the others by more \
         than their own scatter explains (logarithms, median and median absolute deviation, Holm over all photographs, alpha {}).",
        trusted.cell.model,
        calibench_records::judgement::OUTLIER_ALPHA
    );
    show(&mut text, "views.png", "Photograph by photograph", &about, Some(views::picture(summary, &trusted.cell.model)));
    text.push_str(&tables::views(summary, &trusted));
    let about = format!("With `{}` and `{}`.", trusted.cell.method, trusted.cell.model);
    show(
        &mut text,
        "principal-point.png",
        "The principal point, again and again",
        &about,
        trusted.cell.principal.as_ref().map(principal::picture),
    );
    text.push_str(&tables::principal(summary, &trusted.cell.model));
    (text, pictures)
}

#[cfg(test)]
mod tests;
