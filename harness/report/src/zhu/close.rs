//! The eight corners of Fig. 4 close up, where differences of a tenth of a pixel can be seen.

use calibench_model::PixelPoint;

use super::part::{OPERATOR, Part};
use crate::canvas::COLOURS;
use crate::figures::{Layer, MarkAt, Panel, Window, panels};
use crate::load::Loaded;
use crate::scene_figures::targets;

/// Pixels along the side of a panel, and how wide each is drawn.
const SIDE: u32 = 5;
const ZOOM: u32 = 56;

pub(super) fn section(loaded: &Loaded) -> Option<Part> {
    let view = &loaded.first.points.first()?.view;
    let image = loaded.levels(view)?;
    let method = loaded.head.methods.iter().position(|info| info.label.starts_with(OPERATOR))?;
    let pixel = loaded.method("pixel");
    let refined = Layer {
        name: format!("{}: refined", loaded.head.methods[method].label),
        is_method: false,
        ..Layer::methods(std::iter::once(OPERATOR)).remove(0)
    };
    // In colour: black marks on black areas would show by their rims alone.
    let truth = Layer { colour: COLOURS[0], ..Layer::truth() };
    let detected = Layer { name: "detected pixel".into(), colour: COLOURS[5], ..Layer::start() };
    let layers = [truth, detected, refined];
    let marks = |target: &str, truth: PixelPoint| {
        let mut marks = vec![MarkAt { layer: 0, at: truth }];
        for point in loaded.first.points.iter().filter(|point| *point.target == *target) {
            let layer = [(pixel, 1), (Some(method), 2)].into_iter().find_map(|(of, layer)| (of == Some(point.method)).then_some(layer));
            marks.extend(layer.zip(point.outcome.position()).map(|(layer, at)| MarkAt { layer, at }));
        }
        marks
    };
    let panel = |(id, truth): (String, PixelPoint)| Panel {
        title: format!("({id}), {SIDE} x {SIDE} px"),
        window: Window::around(&image, truth, SIDE),
        marks: marks(&id, truth),
    };
    let all: Vec<Panel> = targets(loaded, view).into_iter().map(panel).collect();
    let text = format!(
        "## The eight corners close up\n\n{SIDE} x {SIDE} px of each image of `{}`, {ZOOM} times enlarged: truth, detected pixel, refined position. Without noise; what separates the refined \
         position from the truth is bias.\n\n![Eight corners, each with truth, detection and refined position](close-up.png)\n\n",
        loaded.name
    );
    Some((text, Some(("close-up.png".into(), panels(&all, &layers, SIDE, ZOOM, 4)))))
}
