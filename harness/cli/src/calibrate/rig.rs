//! `calibench calibrate --rig`: cameras that are mounted rigidly to each other.

use std::path::{Path, PathBuf};

use calibench_calibrate::Optics;
use calibench_calibrate::rig::{Pairing, RigCalibration, RigPrepared, RigSettings, TimedImage, calibrate_rig, prepare_rig};
use calibench_cameras::for_file::for_file;
use calibench_cameras::rig_files::{colmap_rig, opencv_stereo};
use calibench_cameras::{CameraFile, ReadOptions, camera_bytes, inputs_of, read_camera_with};
use calibench_exchange::read_times;
use calibench_files::{NewFolder, OutputFolder};
use calibench_model::NamedCamera;
use calibench_photographs::Photo;
use calibench_report::calibration::rig_summary;
use calibench_report::json::{RigAnswer, write_answer};
use clap::Args;
use glob::Pattern;

use super::super::context::Context;
use super::super::convert::positive;
use super::super::output;
use super::{Calibrate, Input};
use crate::deliver::{answer, print};
use crate::failure::Failure;

#[derive(Args)]
pub struct RigArguments {
    /// Cameras that are mounted rigidly to each other, by the names of --camera or --sync; the first defines the frame of the rig
    #[arg(long = "rig", value_name = "NAMES", value_delimiter = ',',
          conflicts_with_all = ["compare", "per_image", "report", "certificate", "by", "place", "date", "body", "lens", "scene", "eccentricity", "huber", "poses", "all", "to", "distances", "approx", "length"])]
    names: Vec<String>,
    /// Which images of a rig belong together: of each camera a pattern, in the order of --rig, as in left*.png=right*.png; where * stands for the same text, images are of one moment [default: the patterns of --camera]
    #[arg(long, value_name = "A=B", requires = "names", conflicts_with = "times")]
    sync: Option<String>,
    /// When the images were taken, as CSV with image,time (s): the nearest belong together
    #[arg(long, value_name = "CSV", requires = "names")]
    times: Option<PathBuf>,
    /// How far apart in time images of one moment are at most, s [default: half of the usual time between two images of a camera]
    #[arg(long, value_name = "S", value_parser = positive, requires = "times")]
    tolerance: Option<f64>,
}

impl RigArguments {
    /// Whether the cameras are a rig.
    pub const fn is_asked(&self) -> bool {
        !self.names.is_empty()
    }

    fn pairing(&self, cameras: &[Optics], patterns: Option<Vec<Pattern>>) -> Result<Pairing, Failure> {
        if let Some(path) = &self.times {
            let times = read_times(path)?.into_iter().map(|(image, time_s)| TimedImage { image, time_s }).collect();
            return Ok(Pairing::Times { times, tolerance_s: self.tolerance });
        }
        let of_sync = patterns.map(|patterns| patterns.into_iter().map(|pattern| vec![pattern]).collect());
        Ok(Pairing::Names(of_sync.unwrap_or_else(|| cameras.iter().map(|optics| optics.images.clone()).collect())))
    }
}

/// The names of `--rig`: two at least, each once.
pub fn rig_names(given: &[String]) -> Result<Vec<String>, Failure> {
    let names: Vec<String> = given.iter().map(|name| name.trim().to_owned()).collect();
    if let Some(twice) = names.iter().enumerate().find(|(i, name)| names[..*i].contains(name)) {
        return Err(Failure::input(format!("--rig: `{}` stands twice", twice.1)));
    }
    let whole = names.len() > 1 && names.iter().all(|name| !name.is_empty());
    if whole { Ok(names) } else { Err(Failure::input("--rig: expected the names of two cameras or more, as in left,right")) }
}

/// The patterns of `--sync`, one a camera.
pub fn patterns(text: &str, names: &[String]) -> Result<Vec<Pattern>, Failure> {
    let pattern = |text: &str| Pattern::new(text.trim()).map_err(|error| Failure::input(format!("--sync: `{text}`: {error}")));
    let patterns = text.split('=').map(pattern).collect::<Result<Vec<_>, _>>()?;
    let right = patterns.len() == names.len() && patterns.iter().all(|pattern| !pattern.as_str().is_empty());
    let wrong =
        || format!("--sync: `{text}` has {} patterns; expected one for each of {}, with = between them", patterns.len(), names.join(", "));
    if right { Ok(patterns) } else { Err(Failure::input(wrong())) }
}

/// Where the cameras of these names are in a file: by name, or, where it has other names and as many cameras, in its order, which is said.
pub fn places(file: &CameraFile, path: &Path, names: &[String]) -> Result<Vec<usize>, Failure> {
    let by_name = |name: &String| file.cameras.iter().position(|camera| camera.name == *name);
    if let Some(places) = names.iter().map(by_name).collect() {
        return Ok(places);
    }
    let (count, shown) = (file.cameras.len(), path.display());
    if count != names.len() {
        let problem = format!("{shown}: holds {count} cameras that have other names than the {} of the rig", names.len());
        return Err(Failure::input(format!("{problem}; expected a file of the rig, or --start CAMERA=FILE of calibrate")));
    }
    say!("{shown}: its cameras are taken in their order as {}", names.join(", "));
    Ok((0..count).collect())
}

impl Calibrate {
    /// As [`Calibrate::run`], of a rig.
    pub(super) fn run_rig(&self, context: &Context<'_>) -> Result<(), Failure> {
        let given = [&self.points, &self.control, &self.rig.times].into_iter().flatten().cloned();
        let inputs = inputs_of(self.photos.iter().cloned().chain(given).chain(self.known.inputs().cloned()).chain(self.cameras.starts()));
        let folder = self.output.as_deref().map(|path| output::folder("-o", path, &inputs, ("calibrate", None))).transpose()?;
        let names = rig_names(&self.rig.names)?;
        let patterns = self.rig.sync.as_deref().map(|text| patterns(text, &names)).transpose()?;
        let Input { points, photos, control, is_free, doubts, .. } = self.input(context)?;
        if is_free {
            return Err(Failure::input("--rig: expected --control, or photographs of a board: of a rig coordinates are known"));
        }
        if control.iter().any(|row| row.disc.is_some()) {
            say!("the centres of discs' pictures are taken as the pictures of their centres: of a rig their eccentricity is not taken out");
        }
        let cameras = self.rig_cameras(&names, patterns.clone(), &photos)?;
        let pairing = self.rig.pairing(&cameras, patterns)?;
        let settings = self.settings_of(cameras, None)?;
        let prepared = prepare_rig(&points, &control, &RigSettings { settings, pairing, origin: 0 })?;
        say_lost(&prepared);
        let found = calibrate_rig(&prepared)?;
        let told = if self.answered.json {
            answer(&RigAnswer::new(&found, &doubts).map_err(Failure::Input)?)
        } else {
            let before: String = doubts.iter().map(|doubt| format!("in doubt: {doubt}\n")).collect();
            print(&(before + &rig_summary(&found)))
        };
        let delivered = folder.map_or(Ok(()), |folder| deliver(&folder, &found, &doubts));
        told.and(delivered)?;
        if found.doubts.is_empty() && doubts.is_empty() { Ok(()) } else { Err(Failure::Doubt) }
    }

    /// The cameras of a rig; a file of as many gives each its own.
    fn rig_cameras(&self, names: &[String], patterns: Option<Vec<Pattern>>, photos: &[Photo]) -> Result<Vec<Optics>, Failure> {
        let mut cameras = self.cameras.of_rig(names, patterns, photos)?;
        let Some(path) = self.cameras.common_start() else { return Ok(cameras) };
        let options = ReadOptions { size: cameras.first().map(|camera| camera.size), other_size: true, ..ReadOptions::default() };
        let file = read_camera_with(Path::new(path), &options)?;
        let start = |optics: &Optics, named: &NamedCamera| self.cameras.for_images(Path::new(path), named, optics.size).map(Some);
        if let [one] = &file.cameras[..] {
            for optics in &mut cameras {
                optics.start = start(optics, one)?;
            }
            return Ok(cameras);
        }
        let places = places(&file, Path::new(path), names)?;
        for (optics, place) in cameras.iter_mut().zip(places) {
            optics.start = start(optics, &file.cameras[place])?;
        }
        Ok(cameras)
    }
}

fn say_lost(prepared: &RigPrepared) {
    let alone: Vec<String> = prepared.alone().into_iter().map(str::to_owned).collect();
    if !alone.is_empty() {
        say!("no other camera took an image with {}", calibench_calibrate::few(&alone));
    }
    if let Some(words) = prepared.left_out_words() {
        say!("{words}");
    }
}

/// The files of a rig. What one format does not hold is said, and the others are written.
fn deliver(output: &OutputFolder, found: &RigCalibration<'_>, doubts: &[String]) -> Result<(), Failure> {
    let named = found.named_cameras().map_err(Failure::Input)?;
    let answer = RigAnswer::new(found, doubts).map_err(Failure::Input)?;
    let mut said = Vec::new();
    output.replace(|folder: &NewFolder| -> std::io::Result<()> {
        folder.write("rig.json", |file| write_answer(file, &answer))?;
        let mut write = |name: &str, made: Result<Vec<u8>, String>| match made {
            Ok(bytes) => folder.write(name, |file| file.write_all(&bytes)),
            Err(why) => {
                said.push(format!("{name} is not written: {why}"));
                Ok(())
            }
        };
        write("camchain.yaml", chain(&named))?;
        write("colmap-rig.json", colmap_rig(&named).map(String::into_bytes).map_err(|error| error.to_string()))?;
        for (place, camera) in named.iter().enumerate() {
            write(&format!("{}.yaml", camera.name), one("camera.yaml", camera, None))?;
            write(&format!("{}.cameramodel", camera.name), one("camera.cameramodel", camera, Some("mrcal")))?;
            if place > 0 {
                let stereo = opencv_stereo(&named[0], camera).map(String::into_bytes).map_err(|error| error.to_string());
                write(&format!("stereo-{}-{}.yml", named[0].name, camera.name), stereo)?;
            }
        }
        Ok(())
    })?;
    said.iter().for_each(|words| say!("{words}"));
    Ok(())
}

/// Kalibr's chain: cameras of more coefficients than it has are converted by a fit.
fn chain(named: &[NamedCamera]) -> Result<Vec<u8>, String> {
    let path = Path::new("camchain.yaml");
    let made = named.iter().map(|camera| for_file(path, camera, Some("kalibr"))).collect::<Result<Vec<_>, _>>();
    let made = made.map_err(|error| error.to_string())?;
    let Some(format) = made.first().map(|file| file.format) else { return Err("no camera".into()) };
    let cameras: Vec<NamedCamera> = made.into_iter().map(|file| file.camera).collect();
    camera_bytes(format, &cameras).map_err(|error| error.to_string())
}

/// A camera by itself, in a format of the file's ending or of a tool.
fn one(path: &str, camera: &NamedCamera, to: Option<&str>) -> Result<Vec<u8>, String> {
    let file = for_file(Path::new(path), camera, to).map_err(|error| error.to_string())?;
    camera_bytes(file.format, &[file.camera]).map_err(|error| error.to_string())
}
