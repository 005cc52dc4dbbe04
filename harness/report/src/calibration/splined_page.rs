//! Calibrated splines as a page, with the map of their uncertainty and tables.

use std::io;

use calibench_adjust::{SplinedPlace, Use};
use calibench_calibrate::splined::SplinedCalibration;
use calibench_files::NewFolder;
use calibench_model::camera::CameraModel;
use calibench_model::escape;

use super::csv::table;
use super::splined::{core, facts};
use crate::canvas::write_pictures;
use crate::field::rgb;
use crate::html::{Figures, Groups, Level, Page};
use crate::levels::Scale;
use crate::plain;
use crate::plot::{Figure, Plot, Said};

/// Columns and rows of the map.
const GRID: (usize, usize) = (48, 32);

/// Writes the page, its picture and its tables into `folder`; `doubts` are what is in doubt of where a board was found.
///
/// # Errors
/// What the file system refuses.
pub fn write_splined_report(found: &SplinedCalibration<'_>, doubts: &[String], folder: &NewFolder) -> io::Result<()> {
    let map = found.quality.over_frame(GRID);
    write_tables(found, &map, folder)?;
    let figure = uncertainty(found, &map);
    let all: Vec<String> = doubts.iter().cloned().chain(found.doubts.iter().map(|doubt| doubt.words.clone())).collect();
    let before: String = all.iter().map(|doubt| format!("**In doubt**: {}.\n\n", escape::markdown(doubt))).collect();
    let lines: String = facts(found).iter().map(|line| format!("- {}\n", escape::markdown(line))).collect();
    let shown = figure.as_ref().map_or_else(String::new, |figure| format!("\n![{0}]({1})\n\n{0}\n", figure.caption, figure.file()));
    let text = format!(
        "{lines}\n## Core\n\n{}\n## Uncertainty\n{shown}\n## Tables\n\n`residuals.csv` (every image point), `uncertainty.csv` (the map's numbers, px), \
         `control-points.csv` (offsets with their standard deviations, numbers).\n",
        core(found).render()
    );
    let pictures: Vec<_> = figure.iter().map(|figure| (figure.file(), figure.picture())).collect();
    write_pictures(folder, &pictures)?;
    folder.write("README.md", |file| file.write_all(format!("# Calibration of splines\n\n{before}{text}").as_bytes()))?;
    let mut page = Page::new("Calibration of splines");
    match all.len() {
        0 => page.verdict(Level::Good, "No doubt was found", []),
        count => page.verdict(Level::Doubt, &format!("Doubtful, for {count} reason{}", if count > 1 { "s" } else { "" }), all),
    }
    let mut figures: Figures = figure.iter().map(|figure| (figure.file(), figure.html())).collect();
    page.markdown(&text, &mut figures, &Groups::new());
    folder.write("report.html", |file| file.write_all(page.render().as_bytes()))
}

fn sigma(place: &SplinedPlace) -> f64 {
    (place.covariance.sxx + place.covariance.syy).max(0.0).sqrt()
}

/// The map: cells of the frame where no image point holds the splines have a ring.
fn uncertainty(found: &SplinedCalibration<'_>, map: &[SplinedPlace]) -> Option<Figure> {
    let size = found.solution.camera().size();
    let values: Vec<f64> = map.iter().map(sigma).collect();
    let scale = Scale::of(&values)?;
    let mut plot = Plot::frame("uncertainty-far", "Standard deviation of a projected point, far away", size);
    plot.series(1, None, &["x, px", "y, px", "standard deviation, px"]);
    let [width, height] = [(size.width, GRID.0), (size.height, GRID.1)].map(|(side, count)| f64::from(side - 1) / (count - 1) as f64);
    for (place, value) in map.iter().zip(&values) {
        let corners = [-0.5, 0.5].map(|half| (place.at.x + half * width, place.at.y + half * height));
        let inside = corners.map(|(x, y)| (x.clamp(-0.5, f64::from(size.width) - 0.5), y.clamp(-0.5, f64::from(size.height) - 0.5)));
        plot.cell(
            inside,
            Some(rgb(scale.part(*value))),
            &Said::of([format!("{:.0}", place.at.x), format!("{:.0}", place.at.y), plain(*value)]),
        );
    }
    plot.dots(map.iter().filter(|place| !place.is_held).map(|place| (place.at.x, place.at.y)).collect());
    let levels: Vec<(f64, String)> = scale.levels().into_iter().map(|level| (scale.part(level), plain(level))).collect();
    plot.shades("px (log scale)", &levels);
    let caption =
        "Standard deviation (2D) of the image of a point far away, after the rotation that makes up for most at the image points. \
                   Places with a dot have no image point in their cell of the splines: the uncertainty there is that of the prior."
            .to_owned();
    let px = |px: Option<f64>| px.map_or_else(|| "nothing".into(), plain);
    let remark = format!(
        "px, RMS where image points hold the splines: {}; over the frame: {}",
        px(found.over_held_px()),
        plain(found.over_frame_px())
    );
    Some(Figure { name: "uncertainty-far".into(), caption, remark, plot })
}

fn write_tables(found: &SplinedCalibration<'_>, map: &[SplinedPlace], folder: &NewFolder) -> io::Result<()> {
    let of_place = |place: &SplinedPlace| {
        let c = place.covariance;
        let numbers = [place.at.x, place.at.y, c.sxx, c.sxy, c.syy, sigma(place)].map(|number| number.to_string());
        numbers.into_iter().chain([if place.is_held { "yes" } else { "no" }.to_owned()]).collect()
    };
    table(folder, "uncertainty.csv", &["x", "y", "sxx", "sxy", "syy", "sigma", "held"], map.iter().map(of_place))?;
    let camera = found.solution.camera();
    let control = camera.control.iter().zip(found.quality.control_sigmas()).enumerate().map(|(place, ([x, y], [sx, sy]))| {
        let numbers = [*x, *y, sx, sy].map(|number| number.to_string());
        [place % camera.columns + 1, place / camera.columns + 1].map(|number| number.to_string()).into_iter().chain(numbers).collect()
    });
    table(folder, "control-points.csv", &["column", "row", "dx", "dy", "sdx", "sdy"], control)?;
    let network = &found.prepared.splines.network;
    let residuals = found.solution.residuals().into_iter().map(|r| {
        let o = &network.observations[r.observation];
        let [vx, vy] = r.v.map_or_else(Default::default, |v| v.map(|v| v.to_string()));
        let used = if r.used == Use::LeftOut { "left out" } else { "yes" };
        let numbers = [o.position.x.to_string(), o.position.y.to_string(), vx, vy];
        [network.images[r.image].name.clone(), network.points[r.point].name.clone()]
            .into_iter()
            .chain(numbers)
            .chain([used.to_owned()])
            .collect()
    });
    table(folder, "residuals.csv", &["image", "target", "x", "y", "vx", "vy", "used"], residuals)
}
