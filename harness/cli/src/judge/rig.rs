//! `calibench judge --rig`: do the cameras of a rig still sit as a file has them?

use std::path::Path;

use calibench_calibrate::rig::{Pairing, RigSettings, Stand, Still, calibrate_rig, prepare_rig, still_stands};
use calibench_calibrate::{Optics, Settings};
use calibench_cameras::{ReadOptions, read_camera_with};
use calibench_exchange::{PointFile, read_control};
use calibench_model::camera::ImageSize;
use calibench_model::{ControlRow, NamedCamera, Points};
use calibench_photographs::Photo;
use calibench_photographs::measured::Corners;
use calibench_report::calibration::rig_stands;
use calibench_report::json::RigStandsAnswer;
use clap::Args;
use glob::Pattern;

use super::super::calibrate::{corners, patterns, places, rig_names};
use super::super::context::{Context, finder};
use super::super::convert::positive;
use super::super::photos::one_size;
use super::{Judge, MARGIN};
use crate::deliver::{answer, print};
use crate::failure::Failure;
use crate::inputs::measured;
use crate::same_camera::for_images;

#[derive(Args)]
pub struct RigArguments {
    /// Cameras that are mounted rigidly to each other, by name, as in the file of --camera: does each still sit as it did against the first? Interiors are taken as the file has them. Exit code 0 if all stand, 1 if one has moved, 3 if the images cannot tell
    #[arg(long = "rig", value_name = "NAMES", value_delimiter = ',', requires_all = ["camera", "sync", "distance"],
          conflicts_with_all = ["all", "models", "pitch", "limit", "report"])]
    names: Vec<String>,
    /// Which images of a rig belong together: of each camera a pattern, in the order of --rig, as in left*.png=right*.png; where * stands for the same text, images are of one moment
    #[arg(long, value_name = "A=B", requires = "names")]
    sync: Option<String>,
    /// With --rig: at which distance points are compared, in the units of the board or control
    #[arg(long, value_name = "D", requires = "names", value_parser = positive, allow_negative_numbers = true)]
    distance: Option<f64>,
}

impl RigArguments {
    /// Whether a rig is asked for.
    pub const fn is_asked(&self) -> bool {
        !self.names.is_empty()
    }
}

/// What is seen of known points.
struct Seen {
    points: Points,
    control: Vec<ControlRow>,
    photos: Vec<Photo>,
    doubts: Vec<String>,
}

impl Judge {
    /// As [`Judge::run`], of a rig.
    pub(super) fn run_rig(&self, context: &Context<'_>) -> Result<(), Failure> {
        let names = rig_names(&self.rig.names)?;
        let (Some(file), Some(sync), Some(distance)) = (&self.camera, &self.rig.sync, self.rig.distance) else {
            return Err(Failure::input("--rig: expected --camera with the file of the rig, --sync and --distance"));
        };
        let patterns = patterns(sync, &names)?;
        let Seen { points, control, photos, doubts } = self.seen(context)?;
        let known = self.known_rig(file, &names, &patterns, &photos)?;
        let optics = |((name, pattern), camera): ((&String, &Pattern), &NamedCamera)| Optics {
            name: name.clone(),
            images: vec![pattern.clone()],
            start: Some(camera.camera),
            solve: Some(Vec::new()),
            ..Optics::new(calibench_model::camera::CameraModel::size(&camera.camera))
        };
        let cameras: Vec<Optics> = names.iter().zip(&patterns).zip(&known).map(optics).collect();
        let pairing = Pairing::Names(patterns.iter().map(|pattern| vec![pattern.clone()]).collect());
        let prepared = prepare_rig(&points, &control, &RigSettings { settings: Settings::new(cameras), pairing, origin: 0 })?;
        let found = calibrate_rig(&prepared)?;
        let stands = still_stands(&found, &known, distance)?;
        let at = (distance, self.margin.unwrap_or(MARGIN));
        if self.answered.json {
            answer(&RigStandsAnswer::new(&found, &stands, at, &doubts))?;
        } else {
            print(&rig_stands(&found, &stands, at))?;
        }
        let is = |verdict: Still| move |stand: &Stand| stand.verdict(at.1) == verdict;
        if stands.iter().any(is(Still::Moved)) {
            return Err(Failure::Gate);
        }
        let is_clear = stands.iter().all(is(Still::Stands)) && found.doubts.is_empty() && doubts.is_empty();
        if is_clear { Ok(()) } else { Err(Failure::Doubt) }
    }

    fn seen(&self, context: &Context<'_>) -> Result<Seen, Failure> {
        let finder = self.board.map(finder).transpose()?;
        let control = match (&self.control, &finder) {
            (Some(path), _) => read_control(path)?,
            (None, Some(finder)) => finder.control(),
            (None, None) => return Err(Failure::input("--rig: expected --board, or --control with --points and --size")),
        };
        match (&self.points[..], &finder) {
            ([], Some(finder)) => {
                let method = match &self.methods[..] {
                    [] => None,
                    [one] => Some(one.as_str()),
                    _ => return Err(Failure::input("--rig: expected one --method at most")),
                };
                let (Corners { points, photos, doubts, .. }, _) = corners(context, finder, &|| self.read.reader(&self.photos), method)?;
                Ok(Seen { points: points.iter().collect(), control, photos, doubts })
            }
            ([one], _) => {
                self.read.without_photographs()?;
                let PointFile { points, .. } = measured(&one.path)?;
                Ok(Seen { points, control, photos: Vec::new(), doubts: Vec::new() })
            }
            _ => Err(Failure::input("--rig: expected photographs of a --board, or one file of --points with the images of all cameras")),
        }
    }

    /// The cameras of the rig before, in the order of `names`, for the images that they took.
    fn known_rig(&self, path: &Path, names: &[String], patterns: &[Pattern], photos: &[Photo]) -> Result<Vec<NamedCamera>, Failure> {
        let sizes: Vec<ImageSize> = match self.size {
            Some(size) => vec![size; names.len()],
            None => names.iter().zip(patterns).map(|(name, pattern)| size_of(name, pattern, photos)).collect::<Result<_, _>>()?,
        };
        let options = ReadOptions { size: sizes.first().copied(), other_size: true, ..ReadOptions::default() };
        let file = read_camera_with(path, &options)?;
        let places = places(&file, path, names)?;
        places.into_iter().zip(&sizes).map(|(place, size)| for_images(path, &file.cameras[place], *size, self.same_camera)).collect()
    }
}

/// The size of the photographs that a pattern names.
fn size_of(name: &str, pattern: &Pattern, photos: &[Photo]) -> Result<ImageSize, Failure> {
    let own = || photos.iter().filter(|(image, ..)| pattern.matches(image)).map(|(_, path, size)| (path, *size));
    if own().next().is_none() {
        return Err(Failure::input(format!("--sync: `{pattern}` names no photograph of {name} in which the board was found")));
    }
    one_size(own())
}
