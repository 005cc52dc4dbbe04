//! What the figures of a judgement show, each once: for its pictures and for its page.

use calibench_model::camera::ImageSize;
use calibench_records::judgement::{Cell, OUTLIER_ALPHA, Principal, Summary, Trusted};

use crate::field::rgb;
use crate::plain;
use crate::plot::{Axis, Figure, Plot, Said, Shape, around};

/// Operators up to which a cell has room for its interval.
const INTERVALS: usize = 11;
/// Photographs up to which each has its name below.
const NAMES: usize = 30;

/// x, y, px, the RMS difference there and the predicted one, px.
type Place = (f64, f64, f64, f64);
/// What a map shows of a place.
type Shown = fn(&Place) -> f64;

fn figure(name: &str, (caption, remark): (String, String), plot: Plot) -> Figure {
    Figure { name: name.to_owned(), caption, remark, plot }
}

/// Half axes of the ellipse that holds 95 % of a normal distribution in the plane, in standard deviations.
const NINETY_FIVE: f64 = 2.4477;

/// The standard deviations of a half's point as predicted, x and y, px, and how far around the middle what is shown reaches, px.
fn extent(principal: &Principal) -> ((f64, f64), f64) {
    let all = principal.all;
    let halves = || principal.halves.iter().flatten();
    let mean = |axis: usize| (halves().map(|half| half[axis].1.powi(2)).sum::<f64>() / halves().count().max(1) as f64).sqrt();
    let half = (mean(0), mean(1));
    let points = halves().chain(&principal.without);
    let off = points.map(|point| (point[0].0 - all[0].0).abs().max((point[1].0 - all[1].0).abs())).fold(0.0, f64::max);
    (half, 1.08 * off.max(NINETY_FIVE * half.0.max(half.1)).max(NINETY_FIVE * all[0].1.max(all[1].1)).max(1e-9))
}

/// Where a hold-out RMS stands among all of them, 0 to 1, on a logarithmic scale.
fn scale(summary: &Summary) -> impl Fn(f64) -> f64 + use<> {
    let values = summary.cells.iter().filter_map(|cell| Some(cell.holdout?.value)).filter(|value| *value > 0.0);
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    move |value| if high > low { (value / low).ln() / (high / low).ln() } else { 0.0 }
}

/// Columns and rows of the places, px.
fn grid(places: &[Place]) -> [Vec<f64>; 2] {
    [|place: &Place| place.0, |place: &Place| place.1].map(|of: fn(&Place) -> f64| {
        let mut ticks: Vec<f64> = places.iter().map(of).collect();
        ticks.sort_by(f64::total_cmp);
        ticks.dedup();
        ticks
    })
}

/// Operator by model: RMS of photographs not seen.
pub(super) fn holdout(summary: &Summary, trusted: &Trusted<'_>) -> Figure {
    let methods: Vec<String> =
        summary.methods.iter().filter(|one| one.unavailable.is_none()).map(|one| one.method.to_string()).rev().collect();
    let models: Vec<String> = summary.models.iter().map(ToString::to_string).collect();
    let part = scale(summary);
    let height = (46.0 * models.len() as f64).clamp(120.0, 900.0);
    let models_up: Vec<String> = models.iter().rev().cloned().collect();
    // Models are many and their names long: they stand at the left.
    let mut plot = Plot::new(
        "holdout",
        "RMS of photographs not seen, by operator and model",
        Axis::named("operator", methods.clone()),
        Axis::named("model", models_up.clone()),
        height,
    )
    .with_names_at_the_left();
    plot.series(1, None, &["operator", "model", "RMS of photographs not seen, px", "95 % from, px", "to, px"]);
    for (x, method) in methods.iter().enumerate() {
        for (y, model) in models_up.iter().enumerate() {
            let (x, y) = (x as f64, y as f64);
            let Some(found) = summary.cell(method, model).and_then(|cell| cell.holdout) else {
                plot.note((x, y), "not judged", false);
                continue;
            };
            let numbers = [found.value, found.interval.0, found.interval.1].map(plain);
            let said = Said::of([method.clone(), model.clone()].into_iter().chain(numbers));
            plot.cell([(x - 0.5, y - 0.5), (x + 0.5, y + 0.5)], Some(rgb(0.5 * part(found.value))), &said);
            if methods.len() > INTERVALS {
                plot.note((x, y), &plain(found.value), true);
            } else {
                plot.note((x, y + 0.18), &plain(found.value), true);
                plot.note((x, y - 0.2), &format!("{}\u{2013}{}", plain(found.interval.0), plain(found.interval.1)), true);
            }
        }
    }
    plot.series(0, None, &[""]);
    let place = |cell: &Cell| {
        let x = methods.iter().position(|name| **name == *cell.method)? as f64;
        Some((x, models_up.iter().position(|name| **name == *cell.model)? as f64))
    };
    let is_least = trusted.least.method == trusted.cell.method && trusted.least.model == trusted.cell.model;
    if let Some(least) = place(trusted.least).filter(|_| !is_least) {
        plot.dashed(&around(least));
    }
    place(trusted.cell).into_iter().for_each(|at| plot.line(&around(at), &Said::default()));
    let caption = "RMS with which points of photographs that took no part are predicted, px, with its 95 % interval where there is room; the darker the larger. \
                   Framed: what is to be trusted; dashed: the least, if that is another.";
    figure("holdout", (caption.to_owned(), String::new()), plot)
}

/// By photograph and operator, with the model that is trusted.
pub(super) fn views(summary: &Summary, model: &str) -> Figure {
    let cells: Vec<&Cell> = summary.cells.iter().filter(|cell| &*cell.model == model && !cell.views.is_empty()).collect();
    let values = || cells.iter().flat_map(|cell| cell.views.iter().map(|view| view.residual.0)).filter(|rms| *rms > 0.0);
    let (low, high) = (values().fold(f64::INFINITY, f64::min) / 1.3, values().fold(0.0, f64::max) * 1.3);
    let (low, high) = if low < high { (low, high) } else { (0.1, 1.0) };
    let short = |name: &str| name.rsplit_once('.').map_or(name, |(stem, _)| stem).chars().take(14).collect::<String>();
    let x = if summary.views.len() <= NAMES {
        Axis::named("photograph", summary.views.iter().map(|name| short(name)).collect())
    } else {
        Axis::linear("photograph, in the order of the table", [-1.0, summary.views.len() as f64])
    };
    let mut plot = Plot::new(
        "views",
        "RMS residual of each photograph by operator",
        x,
        Axis { log: true, ..Axis::linear("RMS residual, px", [low, high]) },
        380.0,
    );
    for (index, cell) in cells.iter().enumerate() {
        let shape = Shape::ALL[index % Shape::ALL.len()];
        plot.series(index % 8, Some(&cell.method), &["photograph", "operator", "RMS residual, px", "points", "p of being like the others"]);
        plot.legend(index % 8, shape, &cell.method, true);
        for view in &cell.views {
            let Some(place) = summary.views.iter().position(|name| *name == view.name) else { continue };
            let aside = 0.7 * (index as f64 - (cells.len() as f64 - 1.0) / 2.0) / (cells.len() as f64 + 1.0);
            let out = if view.p < OUTLIER_ALPHA { " (not like the others)" } else { "" };
            let values = vec![
                view.name.to_string(),
                cell.method.to_string(),
                plain(view.residual.0),
                view.residual.1.to_string(),
                format!("{:.3}{out}", view.p),
            ];
            let at = (place as f64 + aside, view.residual.0.max(low));
            plot.symbol(shape, at, &Said { values, group: Some(place), key: None });
            if view.p < OUTLIER_ALPHA {
                plot.ring(at);
            }
        }
    }
    let caption = format!("With {model}: RMS residual of each photograph in the adjustment of all.");
    figure("views", (caption, "ringed: not like the other photographs".into()), plot)
}

/// How far halves differ over the frame, and how far they should as their covariances predict, on one scale; none without halves.
pub(super) fn halves(cell: &Cell) -> Vec<Figure> {
    let Some(split) = cell.split else { return Vec::new() };
    let [xs, ys] = grid(&cell.map);
    let (Some(right), Some(down)) = (xs.last(), ys.last()) else { return Vec::new() };
    let most = cell.map.iter().map(|place| place.2.max(place.3)).fold(f64::MIN_POSITIVE, f64::max);
    let size = ImageSize { width: *right as u32 + 1, height: *down as u32 + 1 };
    let draw = |name: &str, label: &str, shown: Shown| {
        let mut plot = Plot::frame(name, label, size);
        plot.series(1, None, &["x, px", "y, px", "RMS difference of halves, px", "predicted, px"]);
        for place in &cell.map {
            let &(x, y, found, predicted) = place;
            let edge = |ticks: &[f64], value: f64, length: u32| {
                let at = ticks.partition_point(|tick| *tick < value);
                [at, at + 1].map(|i| i as f64 / ticks.len() as f64 * f64::from(length) - 0.5)
            };
            let ([x0, x1], [y0, y1]) = (edge(&xs, x, size.width), edge(&ys, y, size.height));
            let said = Said::of([format!("{x:.0}"), format!("{y:.0}"), plain(found), plain(predicted)]);
            plot.cell([(x0, y0), (x1, y1)], Some(rgb(shown(place) / most)), &said);
        }
        plot.shades_to("px", most);
        plot
    };
    let found = draw("halves", "RMS difference of two halves over the frame", |place| place.2);
    let predicted = draw("halves-predicted", "RMS difference of two halves as predicted", |place| place.3);
    let remark = format!(
        "over the frame {} px in place of {} px as predicted, {} splits",
        plain(split.difference),
        plain(split.predicted),
        split.count
    );
    vec![
        figure("halves", ("RMS difference of two halves of the photographs.".into(), remark), found),
        figure("halves-predicted", ("The same as the covariances of both halves predict it.".into(), String::new()), predicted),
    ]
}

/// The principal point from halves, from all but some, and from all.
pub(super) fn principal(principal: &Principal) -> Figure {
    let all = principal.all;
    let (cx, cy) = (all[0].0, all[1].0);
    let halves: Vec<_> = principal.halves.iter().flatten().collect();
    let (half, reach) = extent(principal);
    let x = Axis::linear("x, px", [cx - 1.5 * reach, cx + 1.5 * reach]);
    let y = Axis::linear("y, px", [cy + reach, cy - reach]);
    let mut plot = Plot::new("principal-point", "The principal point from parts of the photographs", x, y, 760.0 / 1.5);
    let ellipse = |[sx, sy]: [f64; 2]| -> Vec<(f64, f64)> {
        let angle = |i: i32| (f64::from(i) * std::f64::consts::TAU / 72.0).sin_cos();
        (0..=72).map(angle).map(|(sine, cosine)| (cx + NINETY_FIVE * sx * cosine, cy + NINETY_FIVE * sy * sine)).collect()
    };
    let said = |point: &calibench_records::judgement::Point| Said::of([point[0].0, point[1].0].map(|value| format!("{value:.2}")));
    plot.series(1, None, &["x, px", "y, px"]);
    plot.legend(1, Shape::Circle, "from a half of the photographs", false);
    plot.line(&ellipse([half.0, half.1]), &Said::default());
    halves.iter().for_each(|point| plot.symbol(Shape::Circle, (point[0].0, point[1].0), &said(point)));
    plot.series(0, None, &["x, px", "y, px"]);
    plot.legend(0, Shape::Cross, "from all but those of a fold", false);
    principal.without.iter().for_each(|point| plot.symbol(Shape::Cross, (point[0].0, point[1].0), &said(point)));
    plot.series(7, None, &["x, px", "y, px"]);
    plot.legend(7, Shape::Plus, "from all", false);
    plot.line(&ellipse([all[0].1, all[1].1]), &Said::default());
    plot.symbol(Shape::Plus, (cx, cy), &said(&all));
    let caption =
        "The principal point from halves of the photographs, from all but those of a fold, and from all. Ellipses hold 95 % as predicted.";
    let [a, b, c, d] = [half.0, half.1, all[0].1, all[1].1].map(plain);
    let remark = format!("standard deviations in x and y: {a} px, {b} px of halves, {c} px, {d} px of all");
    figure("principal-point", (caption.into(), remark), plot)
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_records::judgement::Split;

    /// Two places of 101 x 1 px: halves differ there by 2 and 4 px, and by 1 and 8 as predicted. One scale serves both maps.
    #[test]
    fn what_halves_do_and_what_they_should_are_two_maps_of_one_scale() {
        let mut cell = crate::judgement::tests::judged().cells.swap_remove(0);
        (cell.map, cell.split) = (
            vec![(0.0, 0.0, 2.0, 1.0), (100.0, 0.0, 4.0, 8.0)],
            Some(Split { difference: 3.0, predicted: 5.0, modes: 1.0, p: 0.5, count: 9 }),
        );
        let fills = |figure: &Figure| -> Vec<String> {
            let html = figure.html();
            html.split("<rect class=\"cell\"").skip(1).map(|rest| rest.split("fill=\"").nth(1).unwrap()[..7].to_owned()).collect()
        };
        let hex = |part: f64| {
            let [r, g, b] = rgb(part);
            format!("#{r:02x}{g:02x}{b:02x}")
        };
        let [found, predicted] = <[Figure; 2]>::try_from(halves(&cell)).unwrap();
        assert_eq!((found.name.as_str(), predicted.name.as_str()), ("halves", "halves-predicted"));
        assert_eq!(fills(&found), [hex(0.25), hex(0.5)]);
        assert_eq!(fills(&predicted), [hex(0.125), hex(1.0)]);
    }
}
