//! The section of a scenario whose calibrations are applied elsewhere.

use super::check_points::has_check_points;
use super::{cases, decomposition, errors};
use crate::canvas::Pictures;
use crate::load::Loaded;
use crate::studies::network::pictures::plan::plan;
use crate::studies::shown::OnPage;

/// The text of a scenario whose calibrations are applied elsewhere and its pictures; `None` without figures of check points.
pub fn section(loaded: &Loaded, OnPage { stem, .. }: OnPage<'_>) -> Option<(String, Pictures)> {
    let found = loaded.calibrations.as_ref().filter(|found| has_check_points(found))?;
    let mut text = cases::table(found);
    text.push_str(&decomposition::tables(found));
    let mut pictures: Pictures = Vec::new();
    if let Some(canvas) = loaded.scenario.study.views().and_then(plan) {
        let file = format!("{stem}-plan.png");
        text.push_str(&format!(
            "Where calibrations are applied: stations, control and check points:\n\n![Stations, control and check points]({file})\n\n"
        ));
        pictures.push((file, canvas));
    }
    for (place, (case, canvas)) in errors::pictures(found).into_iter().enumerate() {
        let file = format!("{stem}-errors-{}.png", place + 1);
        text.push_str(&format!(
            "Errors of the check points in the first trial, case *{case}*:\n\n![Errors of the check points, {case}]({file})\n\n"
        ));
        pictures.push((file, canvas));
    }
    Some((text, pictures))
}
