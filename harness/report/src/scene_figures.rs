//! The pictures of a rendered scene's first trial: the image with approximations and results, and a panel a target.

use calibench_model::{Image, PixelPoint};
use calibench_records::results::{MethodInfo, Outcome};

use super::canvas::Canvas;
use super::figures::{Layer, MarkAt, Panel, overview, panels};
use super::load::Loaded;

/// More targets than this are not all labelled.
const MOST_LABELS: usize = 24;
/// More targets than this are not marked with approximations and results in an overview.
const CROWD: usize = 120;
/// Targets that get a panel of their own.
const MOST_PANELS: usize = 12;

/// The first layers, which an overview shows.
const OVERVIEW: usize = 3;

/// The zoom at which a picture of a whole image is about 1100 px wide.
fn zoom_for(image: &Image) -> u32 {
    (1100 / image.width().max(image.height()).max(1)).clamp(1, 6) as u32
}

/// An image with its targets, for a look at a scenario.
pub fn preview(image: &Image, targets: &[(String, PixelPoint)]) -> Canvas {
    let marks: Vec<MarkAt> = targets.iter().map(|(_, at)| MarkAt { layer: 0, at: *at }).collect();
    let mark = if targets.len() > CROWD { Layer::truth_of_a_crowd() } else { Layer::truth() };
    let layer = Layer { name: "target".into(), ..mark };
    overview(image, zoom_for(image), &[layer], &marks, &labelled(targets))
}

/// The targets that are labelled. Many labels would hide each other: the first and the last say which way the names run.
fn labelled(targets: &[(String, PixelPoint)]) -> Vec<(String, PixelPoint)> {
    let ends = targets.iter().take(1).chain(targets.last());
    if targets.len() > MOST_LABELS { ends.cloned().collect() } else { targets.to_vec() }
}

/// Overview and panels, or `None` where no image was kept or nothing was measured.
pub fn figures(loaded: &Loaded) -> Option<(Canvas, Canvas)> {
    let first = loaded.first.points.first()?;
    let image = loaded.image(&first.view)?;
    let targets = targets(loaded, &first.view);
    let (layers, layer_of) = layers(loaded);
    let mut marks = Vec::new();
    for (target, truth) in &targets {
        marks.push((target.clone(), MarkAt { layer: 0, at: *truth }));
        for point in loaded.first.points.iter().filter(|point| point.view == first.view && *point.target == **target) {
            if let (Some(layer), Some(at)) = (layer_of[point.method], point.outcome.position()) {
                marks.push((target.clone(), MarkAt { layer, at }));
            }
        }
    }
    // An overview shows truth, starts and one method: more would hide each other.
    // Of a crowd of targets it shows the truth alone.
    let of_all = if targets.len() > CROWD { vec![Layer::truth_of_a_crowd()] } else { layers[..OVERVIEW.min(layers.len())].to_vec() };
    let shown = of_all.len();
    let few: Vec<MarkAt> = marks.iter().filter(|(_, mark)| mark.layer < shown).map(|(_, mark)| mark.clone()).collect();
    let whole = overview(&image, zoom_for(&image), &of_all, &few, &labelled(&targets));
    // One further at each step, so that targets that come in turn all get a panel.
    let step = targets.len().div_ceil(MOST_PANELS).max(1);
    let chosen = (0..targets.len().min(MOST_PANELS)).map(|i| &targets[(i * step + if step > 1 { i } else { 0 }) % targets.len()]);
    let close: Vec<Panel<'_>> = chosen
        .map(|(target, truth)| Panel {
            title: format!("{target}: ({}, {}) px", round(truth.x), round(truth.y)),
            image: &image,
            centre: *truth,
            marks: marks.iter().filter(|(id, _)| id == target).map(|(_, mark)| mark.clone()).collect(),
        })
        .collect();
    Some((whole, panels(&close, &layers, 11, 28, 5)))
}

fn round(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

/// Every target of a view of the first trial with its true position: a measured position less its error.
pub(super) fn targets(loaded: &Loaded, view: &str) -> Vec<(String, PixelPoint)> {
    let mut targets: Vec<(String, PixelPoint)> = Vec::new();
    for point in loaded.first.points.iter().filter(|point| &*point.view == view) {
        let Outcome::Measured { position, error: Some((dx, dy)) } = point.outcome else { continue };
        if !targets.iter().any(|(id, _)| *id == *point.target) {
            targets.push((point.target.to_string(), PixelPoint::new(position.x - dx, position.y - dy)));
        }
    }
    targets
}

/// The layers, truth and approximations first, and the layer of each method. `pixel` is the approximation.
fn layers(loaded: &Loaded) -> (Vec<Layer>, Vec<Option<usize>>) {
    let shown = |info: &&MethodInfo| info.unavailable.is_none() && &*info.label != "pixel";
    let mut layers = vec![Layer::truth(), Layer::start()];
    layers.extend(Layer::methods(loaded.head.methods.iter().filter(shown).map(|info| &*info.label)));
    let layer_of = |info: &MethodInfo| match &*info.label {
        "pixel" => info.unavailable.is_none().then_some(1),
        label => layers.iter().position(|layer| layer.name == label),
    };
    let of = loaded.head.methods.iter().map(layer_of).collect();
    (layers, of)
}
