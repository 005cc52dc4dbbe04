//! The `[camera]` table: an interior orientation written out, or a camera file of any tool.

use std::path::{Path, PathBuf};

use calibench_cameras::{ReadOptions, read_camera_with};
use calibench_diagnostics::Problem;
use calibench_model::camera::{Camera, CameraModel, ImageSize, Photogrammetric};
use calibench_synth::local::{LocalDesign, LocalError};
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::section::Section;
use super::wire::{ImageSides, bounded};

bounded! {
    /// A pixel pitch, um.
    Pitch(f64), f64 "f64", 0.01, 1e4;
    /// A principal distance, mm.
    Distance(f64), f64 "f64", 1e-3, 1e5;
    /// A place on the sensor, mm.
    Place(f64), f64 "f64", -1e4, 1e4;
    /// A coefficient of distortion.
    Coefficient(f64), f64 "f64", -1e6, 1e6;
    /// A standard deviation of a displacement, px.
    LocalSigma(f64), f64 "f64", 0.0, 1e4;
    /// A length of correlation, px.
    Correlation(f64), f64 "f64", 0.1, 1e6;
}

/// The camera: a canonical interior orientation, or `file`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CameraWire {
    /// A camera file of any format that `calibench list formats` names, relative to the scenario's folder. Instead of all other keys but `size` and `name`.
    #[schemars(with = "Option<String>")]
    pub file: Option<Spanned<String>>,
    /// Which camera of the file, if it holds several.
    pub name: Option<String>,
    /// Columns and rows of the image.
    #[schemars(with = "Option<ImageSides>")]
    pub size: Option<Spanned<ImageSides>>,
    /// Pixel pitch, um.
    pub pitch: Option<Pitch>,
    /// Principal distance c, mm.
    pub c: Option<Distance>,
    /// Principal point x0, mm from the centre of the frame. Default 0.
    pub x0: Option<Place>,
    /// Principal point y0, mm upwards from the centre of the frame. Default 0.
    pub y0: Option<Place>,
    /// Radial distortion k1, mm^-2: a correction of measured coordinates. Default 0.
    pub k1: Option<Coefficient>,
    /// Radial distortion k2, mm^-4. Default 0.
    pub k2: Option<Coefficient>,
    /// Radial distortion k3, mm^-6. Default 0.
    pub k3: Option<Coefficient>,
    /// Decentring distortion p1, mm^-1, in Brown's order. Default 0.
    pub p1: Option<Coefficient>,
    /// Decentring distortion p2, mm^-1. Default 0.
    pub p2: Option<Coefficient>,
    /// Difference of scale b1. Default 0.
    pub b1: Option<Coefficient>,
    /// Shear b2. Default 0.
    pub b2: Option<Coefficient>,
}

/// The local distortion of the camera: a smooth random field over the sensor that is in the images and their truth, and in no model that is adjusted.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LocalWire {
    /// Standard deviation of the displacement in x and in y, px; at most a tenth of `correlation`, so that the image cannot fold. 0: there is none.
    #[schemars(with = "LocalSigma")]
    pub sigma: Spanned<LocalSigma>,
    /// Length of correlation, px: at a distance d the correlation is exp(-d^2 / (2 correlation^2)).
    #[schemars(with = "Correlation")]
    pub correlation: Spanned<Correlation>,
    /// false: the same field in all trials. Default: drawn anew in each; it is the same in all images of a trial.
    pub each_trial: Option<bool>,
}

/// A local distortion that is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalPlan {
    /// How large and how smooth it is.
    pub design: LocalDesign,
    /// Whether each trial has one of its own.
    pub each_trial: bool,
}

/// A checked `[camera]` table.
pub struct CameraPlan {
    /// The interior orientation.
    pub camera: Camera,
    /// The file that it was read from.
    pub file: Option<PathBuf>,
    /// What it distorts beyond that.
    pub local: Option<LocalPlan>,
}

/// The largest image, px: 400 megapixels take about 5 GB.
const MOST_PIXELS: u64 = 400_000_000;

/// Where a run keeps the scenario's camera file, in the folder of its records: they are read without what they were made from.
pub const KEPT: &str = "camera-of-the-run";

/// The file that a scenario in `folder` names beside itself, or what a run kept of it.
pub fn located(folder: &Path, file: &str) -> PathBuf {
    let kept = Path::new(file).file_name().map(|name| folder.join(KEPT).join(name));
    kept.filter(|kept| kept.is_file()).unwrap_or_else(|| folder.join(file))
}

/// Reads a `[camera]` table; `folder` is where the scenario's file is.
pub fn read(mut section: Section<'_>, folder: &Path, problems: &mut Vec<Problem>) -> Option<CameraPlan> {
    let span = section.span.clone();
    let local = section.take_table("local", "[camera.local]", problems);
    let wire: Option<CameraWire> = section.read(&["local"], problems);
    let local: Option<Option<LocalWire>> = local.map(|section| section.read(&[], problems));
    let wire = wire?;
    let (camera, file) = match &wire.file {
        Some(file) => {
            let path = located(folder, file.get_ref());
            of_file(&wire, file, &path, problems).map(|camera| (camera, Some(path)))
        }
        None => written_out(&wire, span.clone(), problems).map(|camera| (camera, None)),
    }?;
    let size = camera.size();
    if u64::from(size.width) * u64::from(size.height) > MOST_PIXELS {
        let gigabytes = f64::from(size.width) * f64::from(size.height) * 12.0 / 1e9;
        let message =
            format!("an image of {} x {} px needs about {gigabytes:.0} GB: expected at most 400 megapixels", size.width, size.height);
        problems.push(Problem::new(wire.size.map_or(span, |size| size.span()), message));
    }
    let local = match local {
        Some(wire) => local_plan(&wire?, size, problems),
        None => None,
    };
    Some(CameraPlan { camera, file, local })
}

/// What is drawn; `None` for no displacement, and with a problem for a field that cannot be.
fn local_plan(wire: &LocalWire, size: ImageSize, problems: &mut Vec<Problem>) -> Option<LocalPlan> {
    let design = LocalDesign { sigma: wire.sigma.get_ref().0, correlation: wire.correlation.get_ref().0 };
    if design.sigma == 0.0 {
        return None;
    }
    if let Err(error) = design.check(size) {
        let span = if matches!(error, LocalError::Fine { .. }) { wire.correlation.span() } else { wire.sigma.span() };
        problems.push(Problem::new(span, error.to_string()));
        return None;
    }
    Some(LocalPlan { design, each_trial: wire.each_trial.unwrap_or(true) })
}

fn written_out(wire: &CameraWire, span: std::ops::Range<usize>, problems: &mut Vec<Problem>) -> Option<Camera> {
    let (Some(size), Some(pitch), Some(c)) = (&wire.size, wire.pitch, wire.c) else {
        let missing: Vec<&str> = [("`size`", wire.size.is_none()), ("`pitch`", wire.pitch.is_none()), ("`c`", wire.c.is_none())]
            .iter()
            .filter_map(|(key, missing)| missing.then_some(*key))
            .collect();
        let help = "expected `size` (px), `pitch` (um) and `c` (mm), or `file`";
        problems.push(Problem::new(span, format!("[camera] has no {}", missing.join(", "))).help(help));
        return None;
    };
    if wire.name.is_some() {
        problems.push(Problem::new(span, "[camera] has a `name` and no `file`").help("`name` tells which camera of a file is meant"));
        return None;
    }
    let place = |value: Option<Place>| value.map_or(0.0, |value| value.0);
    let term = |value: Option<Coefficient>| value.map_or(0.0, |value| value.0);
    let camera = Photogrammetric {
        size: size.get_ref().size(),
        pitch_um: pitch.0,
        c: c.0,
        x0: place(wire.x0),
        y0: place(wire.y0),
        k: [term(wire.k1), term(wire.k2), term(wire.k3)],
        p: [term(wire.p1), term(wire.p2)],
        b: [term(wire.b1), term(wire.b2)],
    };
    Some(camera.into())
}

fn of_file(wire: &CameraWire, file: &Spanned<String>, path: &Path, problems: &mut Vec<Problem>) -> Option<Camera> {
    let written = [wire.k1, wire.k2, wire.k3, wire.p1, wire.p2, wire.b1, wire.b2];
    let beside = wire.pitch.is_some() || wire.c.is_some() || wire.x0.is_some() || wire.y0.is_some();
    if beside || written.iter().any(Option::is_some) {
        let problem = Problem::new(file.span(), "`file` beside an interior orientation that is written out: expected one of them");
        problems.push(problem);
        return None;
    }
    let size: Option<ImageSize> = wire.size.as_ref().map(|size| size.get_ref().size());
    let options = ReadOptions { size, ..ReadOptions::default() };
    let read = match read_camera_with(path, &options) {
        Ok(read) => read,
        Err(error) => {
            problems.push(Problem::new(file.span(), format!("the camera cannot be read: {error}")));
            return None;
        }
    };
    let names: Vec<&str> = read.cameras.iter().map(|camera| camera.name.as_str()).collect();
    let chosen = match &wire.name {
        Some(name) => read.cameras.iter().find(|camera| camera.name == *name),
        None => read.cameras.first().filter(|_| read.cameras.len() == 1),
    };
    if chosen.is_none() {
        let help = match names[..] {
            [""] => "the file holds one camera, which has no name: leave `name` out".to_owned(),
            _ => format!("expected `name`, one of {}", names.join(", ")),
        };
        problems.push(Problem::new(file.span(), "which camera of the file?").help(help));
    }
    chosen.map(|camera| camera.camera)
}

#[cfg(test)]
mod tests {
    use toml::de::DeTable;

    use super::*;

    const CAMERA: &str = "size = [240, 240]\npitch = 27\nc = 57.5\n[local]\n";

    /// The plan of a text, or its problem at its place.
    fn local(keys: &str) -> Result<Option<LocalPlan>, String> {
        let text = format!("{CAMERA}{keys}");
        let table = DeTable::parse(&text).unwrap().into_inner();
        let mut problems = Vec::new();
        let plan = read(Section { name: "[camera]", span: 0..1, table }, Path::new(""), &mut problems);
        match &problems[..] {
            [] => Ok(plan.unwrap().local),
            [problem] => Err(format!("{}: {}", &text[problem.span.clone()], problem.message)),
            _ => panic!("{problems:?}"),
        }
    }

    #[test]
    fn a_local_distortion_is_read() {
        let design = LocalDesign { sigma: 0.033, correlation: 15.0 };
        assert_eq!(local("sigma = 0.033\ncorrelation = 15"), Ok(Some(LocalPlan { design, each_trial: true })));
        assert_eq!(local("sigma = 0.033\ncorrelation = 15\neach_trial = false"), Ok(Some(LocalPlan { design, each_trial: false })));
        assert_eq!(local("sigma = 0\ncorrelation = 15"), Ok(None), "none at all, for sweeps");
    }

    #[test]
    fn a_local_distortion_that_cannot_be_is_refused_at_its_key() {
        for (keys, message) in [
            (
                "sigma = 1.6\ncorrelation = 15",
                "1.6: `sigma` is 1.6 px with a `correlation` of 15 px: the image would fold over; expected at most a tenth, 1.5",
            ),
            ("sigma = 0.01\ncorrelation = 0.1", "0.1: `correlation` is 0.1 px: too fine for a frame of 240 x 240 px, expected at least"),
            ("sigma = -1\ncorrelation = 15", "-1: expected a number from 0 to 10000, found -1"),
            ("sigma = 1", "local: [camera.local] has no `correlation`"),
            ("sigma = 1\ncorrelation = 15\ntrial = 1", "trial: unknown key `trial` in [camera.local]"),
        ] {
            let found = local(keys).unwrap_err();
            assert!(found.contains(message), "{keys}\n{found}\n{message}");
        }
    }
}
