//! A judgement as one file that answers questions: the text of the page, with figures in the place of its pictures.

use calibench_model::camera::ImageSize;
use calibench_records::judgement::{Cell, InUse, OUTLIER_ALPHA, Principal, StillHolds, Summary, Trusted};

use super::map::grid;
use super::matrix::scale;
use super::principal::{NINETY_FIVE, extent};
use super::{in_use, verdict};
use crate::corners::{Corner, Pictured, choose, over_frame, patches};
use crate::field::shade;
use crate::html::{Axis, Figures, Groups, Level, Page, Plot, Said, Shape, escaped};
use crate::plain;

/// Where points were measured that a page of a judgement shows, and in which photographs.
#[derive(Default)]
pub struct Measured<'a> {
    /// The points of what is to be trusted with their residuals; photographs are numbered as in the summary.
    pub corners: Vec<Corner<'a>>,
    /// The photographs by their names, where they are at hand.
    pub photos: Vec<Pictured<'a>>,
    /// Their size, px.
    pub size: Option<ImageSize>,
}

/// The page: `text` is the Markdown page. `found` is what was found of a camera in use, if one was asked about; doubts were had before, of the photographs.
pub fn page(
    title: &str,
    text: &str,
    (summary, trusted): (&Summary, Option<&Trusted<'_>>),
    (found, doubts): (Option<&InUse>, &[String]),
    measured: Measured<'_>,
) -> String {
    let mut page = Page::new(title);
    match trusted {
        None => page.verdict(Level::Doubt, "Nothing could be judged", doubts.iter().cloned()),
        Some(trusted) => {
            let reasons = doubts.iter().cloned().chain(trusted.doubt().map(|why| format!("{why}: its limits do not hold")));
            let reasons: Vec<String> = reasons.collect();
            let (level, sentence) = head(summary, trusted, found, !reasons.is_empty());
            page.verdict(level, &sentence, reasons);
        }
    }
    let groups: Groups = summary.views.iter().enumerate().map(|(place, name)| (name.to_string(), place)).collect();
    // The parts of a judgement are sections of a page of their own here.
    let text = if text.contains("\n## ") { text.to_owned() } else { text.replace("\n### ", "\n## ") };
    let mut figures = trusted.map_or_else(Figures::new, |trusted| figures(summary, trusted));
    page.markdown(&text, &mut figures, &groups);
    if let Some(trusted) = trusted {
        residuals(&mut page, trusted, measured);
    }
    page.render()
}

/// What the adjustment that is trusted left of each point, and the longest enlarged.
fn residuals(page: &mut Page, trusted: &Trusted<'_>, Measured { mut corners, photos, size }: Measured<'_>) {
    let Some(size) = size.filter(|_| !corners.is_empty()) else { return };
    choose(&mut corners);
    let enlarged = if photos.is_empty() { "" } else { " A click on one of the longest 200 shows its point enlarged." };
    let about = format!(
        "<p>With <code>{}</code> and <code>{}</code>, all photographs adjusted together.{enlarged}</p>\n",
        escaped(&trusted.cell.method),
        escaped(&trusted.cell.model)
    );
    page.section("Residuals over the frame", about + &over_frame("residuals", "", size, corners.iter()));
    for (key, figure) in patches(&corners, &photos) {
        page.patch(key, &figure);
    }
}

fn head(summary: &Summary, trusted: &Trusted<'_>, found: Option<&InUse>, doubted: bool) -> (Level, String) {
    let bare = |text: &str| text.trim_start_matches("- ").replace(['*', '`'], "");
    if let Some(found) = found {
        let level = match found.verdict {
            StillHolds::Moved => Level::Bad,
            StillHolds::Holds if !doubted => Level::Good,
            StillHolds::Holds | StillHolds::CannotTell => Level::Doubt,
        };
        return (level, bare(&in_use(found)));
    }
    let first = verdict(summary, trusted);
    let level = match trusted.cell.split {
        _ if doubted => Level::Doubt,
        Some(_) => Level::Good,
        // Its sigmas were not tested.
        None => Level::Open,
    };
    (level, bare(first.lines().next().unwrap_or_default()))
}

fn figures(summary: &Summary, trusted: &Trusted<'_>) -> Figures {
    let mut figures = Figures::from([
        ("holdout.png".to_owned(), holdout(summary, trusted)),
        ("views.png".to_owned(), views(summary, &trusted.cell.model)),
    ]);
    figures.extend(halves(trusted.cell).map(|figure| ("halves.png".to_owned(), figure)));
    figures.extend(trusted.cell.principal.as_ref().map(|found| ("principal-point.png".to_owned(), principal(found))));
    figures
}

/// Operator by model: RMS of photographs not seen.
fn holdout(summary: &Summary, trusted: &Trusted<'_>) -> String {
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
            let colour = shade(0.5 * part(found.value));
            plot.cell([(x - 0.5, y - 0.5), (x + 0.5, y + 0.5)], Some([colour.0, colour.1, colour.2]), &said);
            plot.note((x, y), &plain(found.value), true);
        }
    }
    plot.series(0, None, &[""]);
    let place = |cell: &Cell| {
        let x = methods.iter().position(|name| **name == *cell.method)? as f64;
        Some((x, models_up.iter().position(|name| **name == *cell.model)? as f64))
    };
    if let Some((x, y)) = place(trusted.cell) {
        let corners = [(-0.48, -0.46), (0.48, -0.46), (0.48, 0.46), (-0.48, 0.46), (-0.48, -0.46)];
        plot.line(&corners.map(|(dx, dy)| (x + dx, y + dy)), &Said::default());
    }
    plot.figure(
        "RMS with which points of photographs that took no part are predicted, px; the darker the larger. Framed: what is to be trusted.",
    )
}

/// By photograph and operator, with the model that is trusted.
fn views(summary: &Summary, model: &str) -> String {
    let cells: Vec<&Cell> = summary.cells.iter().filter(|cell| &*cell.model == model && !cell.views.is_empty()).collect();
    let values = || cells.iter().flat_map(|cell| cell.views.iter().map(|view| view.residual.0)).filter(|rms| *rms > 0.0);
    let (low, high) = (values().fold(f64::INFINITY, f64::min) / 1.3, values().fold(0.0, f64::max) * 1.3);
    let (low, high) = if low < high { (low, high) } else { (0.1, 1.0) };
    let numbers: Vec<String> = (1..=summary.views.len()).map(|number| number.to_string()).collect();
    let x = if numbers.len() <= 30 {
        Axis::named("photograph, in the order of the table", numbers)
    } else {
        Axis::linear("photograph", [0.0, numbers.len() as f64])
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
            plot.symbol(shape, (place as f64 + aside, view.residual.0.max(low)), &Said { values, group: Some(place), key: None });
        }
    }
    plot.figure(&format!("With `{model}`: RMS residual of each photograph in the adjustment of all. A click chooses a photograph, here and in the tables.").replace('`', ""))
}

/// How far halves differ over the frame, as a share of what their covariances predict.
fn halves(cell: &Cell) -> Option<String> {
    let split = cell.split?;
    let [xs, ys] = grid(&cell.map);
    let most = cell.map.iter().map(|place| place.2).fold(f64::MIN_POSITIVE, f64::max);
    let size = ImageSize { width: *xs.last()? as u32 + 1, height: *ys.last()? as u32 + 1 };
    let mut plot = Plot::frame("halves", "RMS difference of two halves over the frame", size);
    plot.series(1, None, &["x, px", "y, px", "RMS difference of halves, px", "predicted, px"]);
    for &(x, y, found, predicted) in &cell.map {
        let edge = |ticks: &[f64], value: f64, length: u32| {
            let at = ticks.partition_point(|tick| *tick < value);
            [at, at + 1].map(|i| i as f64 / ticks.len() as f64 * f64::from(length) - 0.5)
        };
        let ([x0, x1], [y0, y1]) = (edge(&xs, x, size.width), edge(&ys, y, size.height));
        let colour = shade(found / most);
        let said = Said::of([format!("{x:.0}"), format!("{y:.0}"), plain(found), plain(predicted)]);
        plot.cell([(x0, y0), (x1, y1)], Some([colour.0, colour.1, colour.2]), &said);
    }
    plot.shades("px", &[0.0, 0.25, 0.5, 0.75, 1.0].map(|part| (part, plain(part * most))));
    Some(plot.figure(&format!(
        "RMS difference of two halves of the photographs: over the frame {} px in place of {} px as predicted, {} splits.",
        plain(split.difference),
        plain(split.predicted),
        split.count
    )))
}

/// The principal point from halves, from all but some, and from all.
fn principal(principal: &Principal) -> String {
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
    plot.figure(&format!(
        "The principal point from halves of the photographs, from all but those of a fold, and from all. Ellipses hold 95 % as predicted: standard deviations {} px, {} px of halves, {} px, {} px of all.",
        plain(half.0),
        plain(half.1),
        plain(all[0].1),
        plain(all[1].1)
    ))
}
