//! The pictures of each sweep of the atlas.

use crate::canvas::Canvas;
use crate::sweep::{Choice, Layout, LoadedSweep, Metric, curves, map};

/// A picture that is to be drawn of a sweep.
#[derive(Clone, Copy)]
struct Wanted {
    /// Its name after the scenario's.
    stem: &'static str,
    /// What it shows, in a line.
    about: &'static str,
    metric: Metric,
    x: &'static str,
    /// The y axis of a map; `None` for curves by method.
    map: Option<&'static str>,
    /// Panels of curves, and a key that is held at a value.
    facet: Option<&'static str>,
    at: Option<(&'static str, &'static str)>,
    /// All methods, not the usual settings alone.
    all: bool,
}

const BLUR: &str = "optics.blur";
const NOISE: &str = "sensor.snr_contrast_db";

const fn shades(stem: &'static str, about: &'static str, x: &'static str, y: &'static str) -> Wanted {
    Wanted { stem, about, metric: Metric::Ratio, x, map: Some(y), facet: None, at: None, all: true }
}

const fn lines(stem: &'static str, about: &'static str, metric: Metric, x: &'static str, facet: Option<&'static str>) -> Wanted {
    Wanted { stem, about, metric, x, map: None, facet, at: None, all: false }
}

const fn at_two_percent(wanted: Wanted) -> Wanted {
    Wanted { at: Some((NOISE, "34")), ..wanted }
}

fn wanted(scenario: &str) -> Vec<Wanted> {
    let images = || {
        vec![
            shades("ratio", "RMSE over the bound of each point, by blur and noise; one scale of shades for all methods", BLUR, NOISE),
            at_two_percent(lines("bias", "Length of the mean error over blur, at 2 % of noise, usual settings", Metric::Bias, BLUR, None)),
            at_two_percent(lines("scatter", "Scatter over blur, at 2 % of noise, usual settings", Metric::Scatter, BLUR, None)),
            lines("failed", "Points lost or rejected over blur, by noise, usual settings", Metric::Failed, BLUR, Some(NOISE)),
        ]
    };
    match scenario {
        "atlas/corners" | "atlas/discs" => images(),
        "atlas/corners-pose" => {
            vec![lines(
                "rmse",
                "RMSE over the board's tilt, by its rotation, usual settings",
                Metric::Rmse,
                "stations.tilts.0.1",
                Some("stations.rolls.0"),
            )]
        }
        "atlas/corners-phase" => vec![lines("rmse", "RMSE over the phase of the pixel grid", Metric::Rmse, "camera.x0", Some(BLUR))],
        "atlas/corners-window" => vec![lines("rmse", "RMSE over the window, by blur", Metric::Rmse, "method.window", Some(BLUR))],
        "atlas/discs-size" => vec![
            lines("rmse", "RMSE over the size of the disc, by tilt", Metric::Rmse, "testfield.fill.size", Some("stations.tilts.0.1")),
            lines(
                "failed",
                "Points lost or rejected over the size of the disc, by tilt",
                Metric::Failed,
                "testfield.fill.size",
                Some("stations.tilts.0.1"),
            ),
        ],
        "atlas/wedges" => vec![
            shades(
                "ratio",
                "RMSE over the bound of each point, by angle and blur; one scale of shades for all methods",
                "testfield.fill.angles.0",
                BLUR,
            ),
            lines("rmse", "RMSE over the angle, by blur, usual settings", Metric::Rmse, "testfield.fill.angles.0", Some(BLUR)),
            lines(
                "failed",
                "Points lost or rejected over the angle, by blur, usual settings",
                Metric::Failed,
                "testfield.fill.angles.0",
                Some(BLUR),
            ),
        ],
        _ => Vec::new(),
    }
}

/// The pictures of a sweep: file name, what it shows, picture. `usual` are the methods at their usual settings.
pub fn pictures(loaded: &LoadedSweep, usual: &[String]) -> Vec<(String, &'static str, Canvas)> {
    let stem = loaded.name.replace("atlas/", "").replace('/', "-");
    let draw = |wanted: Wanted| {
        let choice = Choice {
            x: Some(wanted.x.to_owned()),
            by: wanted.map.map(str::to_owned),
            facet: wanted.facet.map(str::to_owned),
            at: wanted.at.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect(),
            methods: if wanted.all { Vec::new() } else { usual.to_vec() },
        };
        // A sweep that was changed by hand may lack an axis: then it has no such picture.
        let layout = Layout::new(loaded, &choice, wanted.metric, wanted.map.is_some()).ok()?;
        let picture = if wanted.map.is_some() { map(loaded, &layout) } else { curves(loaded, &layout) };
        Some((format!("{stem}-{}.png", wanted.stem), wanted.about, picture))
    };
    wanted(&loaded.name).into_iter().filter_map(draw).collect()
}
