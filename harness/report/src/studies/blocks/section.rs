//! The section of a scenario whose points make free networks.

use super::{pictures, tables};
use crate::canvas::{Canvas, Pictures};
use crate::load::Loaded;
use crate::studies::recognition;
use crate::studies::shown::OnPage;

/// The text of a scenario with blocks and its pictures; `None` without figures of blocks.
pub fn section(loaded: &Loaded, OnPage { stem, .. }: OnPage<'_>) -> Option<(String, Pictures)> {
    let found = loaded.calibrations.as_ref()?;
    let (views, told) = loaded.scenario.in_blocks()?;
    let mut text = recognition::section(found).unwrap_or_default();
    text.push_str(&tables::blocks(found));
    text.push_str(&tables::location(found));
    text.push_str(&tables::residuals(found, told));
    text.push_str(&tables::failures(found));
    let mut drawn: Pictures = Vec::new();
    let mut add = |name: &str, caption: &str, canvas: Option<Canvas>| {
        if let Some(canvas) = canvas {
            let file = format!("{stem}-{name}.png");
            text.push_str(&format!("{caption}:\n\n![{caption}]({file})\n\n"));
            drawn.push((file, canvas));
        }
    };
    add("recognition", "What recognition makes of an image on its way to its targets", recognition::steps(loaded));
    add("stations", "Where the cameras stand, seen along the normal of the field", pictures::stations(views));
    add(
        "heights",
        "Heights of the object points in the first trial, from the plane through the three that hold the frame, with their standard deviations",
        pictures::heights(found, views),
    );
    add(
        "residuals",
        "Residuals of the first trial in a pair of images whose residuals are compared",
        pictures::pair(loaded, found, views, told),
    );
    Some((text, drawn))
}
