//! The pictures of a rendered scene's first trial: the image with approximations and results, and a panel a target.

use std::collections::{BTreeMap, BTreeSet};

use calibench_model::{CornerPoint, Image, PixelPoint};
use calibench_records::results::{MethodInfo, Outcome};

use super::canvas::{COLOURS, Canvas, Mark};
use super::figures::{Layer, MarkAt, Panel, Window, overview, panels};
use super::load::Loaded;

/// More targets than this are not all labelled.
const MOST_LABELS: usize = 24;
/// More targets than this are not marked with approximations and results in an overview.
const CROWD: usize = 120;
/// Targets that get a panel of their own.
const MOST_PANELS: usize = 12;
/// The least and the most side of the window of a panel, px.
const WINDOW: [f64; 2] = [11.0, 61.0];
/// Kinds of targets that are points where edges meet.
const POINTS: [&str; 3] = ["chess_corner", "corner", "junction"];
/// The side of a panel, px of the picture, about.
const PANEL: u32 = 308;
/// Images with a longer side, px, are reduced for an overview.
const LARGE: usize = 1600;

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
    match factor(image.width(), image.height()) {
        1 => whole(image, 1, &[layer], &marks, &labelled(targets)),
        factor => whole(&image.reduced(factor), factor, &[layer], &marks, &labelled(targets)),
    }
}

/// How a point that was found is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// By its mark.
    Plain,
    /// With its name: the first points say which way the names run.
    First,
    /// With its name and what makes it doubtful.
    Doubtful,
}

/// A photograph with the points that were found in it, each with its label and its look.
pub fn found(image: &Image, points: &[(String, PixelPoint, Look)]) -> Canvas {
    let layer = |name: &str, mark, colour| Layer { name: name.into(), mark, colour: COLOURS[colour], is_method: false };
    let layers = [layer("found", Mark::Dot, 1), layer("the first ones", Mark::Square, 2), layer("in doubt", Mark::Diamond, 0)];
    let of = |look: Look| match look {
        Look::Plain => 0,
        Look::First => 1,
        Look::Doubtful => 2,
    };
    let marks: Vec<MarkAt> = points.iter().map(|(_, at, look)| MarkAt { layer: of(*look), at: *at }).collect();
    let named = points.iter().filter(|(.., look)| *look != Look::Plain);
    let labels: Vec<(String, PixelPoint)> = named.map(|(name, at, _)| (name.clone(), *at)).collect();
    match factor(image.width(), image.height()) {
        1 => whole(image, 1, &layers, &marks, &labels),
        factor => whole(&image.reduced(factor), factor, &layers, &marks, &labels),
    }
}

/// The targets that are labelled. Many labels would hide each other: the first and the last say which way the names run.
fn labelled(targets: &[(String, PixelPoint)]) -> Vec<(String, PixelPoint)> {
    let ends = targets.iter().take(1).chain(targets.last());
    if targets.len() > MOST_LABELS { ends.cloned().collect() } else { targets.to_vec() }
}

/// The pictures of a scene.
pub struct SceneFigures {
    /// The whole image with truth, approximations and one method.
    pub overview: Canvas,
    /// Windows around targets.
    pub panels: Canvas,
    /// What is marked in the overview, for a sentence.
    pub marked: &'static str,
    /// What the panels show, for a sentence.
    pub shown: String,
}

/// The pictures, or `None` where no image was kept or nothing was measured.
pub fn figures(loaded: &Loaded) -> Option<SceneFigures> {
    let first = loaded.first.points.first()?;
    let image = loaded.levels(&first.view)?;
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
    let factor = factor(image.width(), image.height());
    let overview = whole(&image.reduced(factor), factor, &of_all, &few, &labelled(&targets));
    let kinds = kinds(loaded);
    let chosen = chosen(&targets, &kinds);
    let side = window(&targets, &chosen, &kinds);
    let several = kinds.values().collect::<BTreeSet<_>>().len() > 1;
    let title = |target: &str, truth: &PixelPoint| match kinds.get(target) {
        Some(kind) if several => format!("{}: {target}", kind.replace('_', " ")),
        _ => format!("{target}: ({}, {}) px", round(truth.x), round(truth.y)),
    };
    let panel = |(target, truth): &&(String, PixelPoint)| Panel {
        title: title(target, truth),
        window: Window::around(&image, *truth, side),
        marks: marks.iter().filter(|(id, _)| id == target).map(|(_, mark)| mark.clone()).collect(),
    };
    let close: Vec<Panel> = chosen.iter().map(panel).collect();
    let zoom = (PANEL / side).max(1);
    let which = match (several, close.len() < targets.len()) {
        (true, true) => "a target of each kind",
        (false, true) => "some of the targets",
        (_, false) => "each target",
    };
    let shown = format!("{side} x {side} px around {which}, enlarged {zoom} times");
    let marked = if targets.len() > CROWD { "truth" } else { "truth, approximate positions and the results of one method" };
    Some(SceneFigures { marked, overview, panels: panels(&close, &layers, side, zoom, 5), shown })
}

/// The kind of each target, where the records tell it.
fn kinds(loaded: &Loaded) -> BTreeMap<&str, &str> {
    let Some(views) = loaded.scenario.study.views() else { return BTreeMap::new() };
    views.targets.iter().map(|target| (target.id.as_str(), target.kind.as_str())).collect()
}

/// The first target of each kind; of one kind, or where kinds are not known, some of all.
fn chosen<'a>(targets: &'a [(String, PixelPoint)], kinds: &BTreeMap<&str, &str>) -> Vec<&'a (String, PixelPoint)> {
    let mut seen = BTreeSet::new();
    let first: Vec<&(String, PixelPoint)> =
        targets.iter().filter(|(id, _)| kinds.get(id.as_str()).is_some_and(|kind| seen.insert(*kind))).collect();
    if first.len() > 1 {
        return first;
    }
    // One further at each step, so that targets that come in turn all get a panel.
    let (all, count) = (targets.len(), targets.len().min(MOST_PANELS));
    let mut taken = BTreeSet::new();
    for i in 0..count {
        let mut place = (i * all / count + if all > count { i } else { 0 }) % all;
        while !taken.insert(place) {
            place = (place + 1) % all;
        }
    }
    taken.into_iter().map(|place| &targets[place]).collect()
}

/// The side of a window that holds any of `chosen`: targets lie apart, and none is larger than its distance from the next. Odd. A point where edges meet has
/// no size.
fn window(targets: &[(String, PixelPoint)], chosen: &[&(String, PixelPoint)], kinds: &BTreeMap<&str, &str>) -> u32 {
    let sized = |id: &str| kinds.get(id).is_some_and(|kind| !POINTS.contains(kind));
    let nearest = |(id, at): &(String, PixelPoint)| {
        let others = targets.iter().filter(|(other, _)| other != id);
        others.map(|(_, other)| at.distance(*other)).fold(f64::INFINITY, f64::min)
    };
    let widest =
        chosen.iter().filter(|(id, _)| sized(id)).map(|target| nearest(target)).filter(|distance| distance.is_finite()).fold(0.0, f64::max);
    (widest.clamp(WINDOW[0], WINDOW[1]) / 2.0).floor() as u32 * 2 + 1
}

/// How many times an overview is smaller than an image of this size.
fn factor(width: usize, height: usize) -> usize {
    width.max(height).div_ceil(LARGE).max(1)
}

/// The overview of an image that was reduced `factor` times; everything on it is reduced as well.
fn whole(image: &Image, factor: usize, layers: &[Layer], marks: &[MarkAt], labels: &[(String, PixelPoint)]) -> Canvas {
    if factor == 1 {
        return overview(image, zoom_for(image), layers, marks, labels);
    }
    let marks: Vec<MarkAt> = marks.iter().map(|mark| MarkAt { at: smaller(mark.at, factor), ..mark.clone() }).collect();
    let labels: Vec<(String, PixelPoint)> = labels.iter().map(|(text, place)| (text.clone(), smaller(*place, factor))).collect();
    overview(image, 1, layers, &marks, &labels)
}

/// A place in the image that is `factor` times smaller.
fn smaller(at: PixelPoint, factor: usize) -> PixelPoint {
    let corner = at.to_corner();
    CornerPoint { x: corner.x / factor as f64, y: corner.y / factor as f64 }.to_pixel()
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

#[cfg(test)]
mod tests {
    use super::*;

    fn at(names: &[&str], place: impl Fn(usize) -> (f64, f64)) -> Vec<(String, PixelPoint)> {
        names.iter().enumerate().map(|(i, name)| ((*name).to_owned(), PixelPoint::new(place(i).0, place(i).1))).collect()
    }

    #[test]
    fn places_go_with_the_squares_that_become_pixels() {
        // The middle of the second square of four pixels a side, third row.
        assert_eq!(smaller(PixelPoint::new(5.5, 9.5), 4), PixelPoint::new(1.0, 2.0));
    }

    #[test]
    fn of_several_kinds_each_is_shown_once_and_of_one_kind_no_target_twice() {
        let targets = at(&["a", "b", "c", "d"], |i| (30.0 * i as f64, 5.0));
        let kinds = BTreeMap::from([("a", "disc"), ("b", "disc"), ("c", "cross"), ("d", "corner")]);
        let names = |chosen: Vec<&(String, PixelPoint)>| chosen.iter().map(|(id, _)| id.clone()).collect::<Vec<_>>();
        assert_eq!(names(chosen(&targets, &kinds)), ["a", "c", "d"]);
        let many: Vec<String> = (0..54).map(|i| i.to_string()).collect();
        let many = at(&many.iter().map(String::as_str).collect::<Vec<_>>(), |i| (i as f64, 0.0));
        let mut shown = names(chosen(&many, &BTreeMap::new()));
        assert_eq!(shown.len(), MOST_PANELS);
        shown.dedup();
        assert_eq!(shown.len(), MOST_PANELS);
    }

    /// 30 px from one to the next: half of them to each side of the middle pixel; points where edges meet need no more than the least.
    #[test]
    fn a_window_holds_a_target_and_not_its_neighbours() {
        let targets = at(&["a", "b", "c"], |i| (30.0 * i as f64, 5.0));
        let all: Vec<&(String, PixelPoint)> = targets.iter().collect();
        let of = |kind| window(&targets, &all, &BTreeMap::from([("a", kind), ("b", kind), ("c", kind)]));
        assert_eq!((of("disc"), of("chess_corner")), (31, 11));
    }
}
