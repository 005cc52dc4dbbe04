//! What a certificate is made of: the calibration, its files with their digests, what the photographs say of the camera.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::path::{Component, Path, PathBuf};

use calibench_calibrate::{Calibration, Suspected};
use calibench_certificate::{
    CameraRecord, Certificate, Equipment, Fields, FileEntry, FrameRecord, LIST_FILE, PlaceRecord, RECORD, RECORD_FILE, Record, Role,
    Sealed, digest_of_file, line,
};
use calibench_files::{Inputs, NewFolder, OutputFile, at};
use calibench_images::picture::said;
use calibench_photographs::Photo;
use calibench_report::calibration::FrameUncertainty;
use calibench_report::json::{CalibrationAnswer, answer_value};
use clap::Args;
use rayon::prelude::*;

use super::super::context::finder;
use super::super::output;
use super::{Calibrate, Outputs};
use crate::failure::Failure;

/// The names of chosen places, row by row.
const PLACES: [&str; 9] = [
    "upper left corner",
    "upper side",
    "upper right corner",
    "left side",
    "middle",
    "right side",
    "lower left corner",
    "lower side",
    "lower right corner",
];

/// What a person says on a certificate.
#[derive(Args, Clone, Default)]
pub struct Said {
    /// Of a certificate: who issues it [default: a line to fill in by hand]
    #[arg(long, value_name = "NAME")]
    by: Option<String>,
    /// Of a certificate: where it is issued [default: a line to fill in by hand]
    #[arg(long, value_name = "PLACE")]
    place: Option<String>,
    /// Of a certificate: when it is issued, in any words [default: a line to fill in by hand]
    #[arg(long, value_name = "DATE")]
    date: Option<String>,
    /// Of a certificate: the camera, as its maker, name and serial number, beside what the photographs say
    #[arg(long, value_name = "TEXT")]
    body: Option<String>,
    /// Of a certificate: the lens, beside what the photographs say
    #[arg(long, value_name = "TEXT")]
    lens: Option<String>,
}

/// The longest text of a field, letters.
const LONGEST: usize = 200;

impl Said {
    /// The fields of a certificate.
    ///
    /// # Errors
    /// A text that has no room.
    pub fn fields(&self) -> Result<Fields, Failure> {
        let all = [("--by", &self.by), ("--place", &self.place), ("--date", &self.date), ("--body", &self.body), ("--lens", &self.lens)];
        if let Some((name, _)) =
            all.iter().find(|(_, text)| text.as_ref().is_some_and(|text| text.chars().count() > LONGEST || text.trim().is_empty()))
        {
            return Err(Failure::input(format!("{name}: expected a text of 1 to {LONGEST} letters")));
        }
        let Self { by, place, date, body, lens } = self.clone();
        Ok(Fields { camera: body, lens, by, place, date })
    }

    /// That nothing is said where there is no certificate.
    ///
    /// # Errors
    /// What is said all the same.
    pub fn without_certificate(&self) -> Result<(), Failure> {
        let all = [("--by", &self.by), ("--place", &self.place), ("--date", &self.date), ("--body", &self.body), ("--lens", &self.lens)];
        let given: Vec<&str> = all.iter().filter(|(_, text)| text.is_some()).map(|(name, _)| *name).collect();
        if given.is_empty() {
            Ok(())
        } else {
            Err(Failure::input(format!("{}: for a certificate; name it with --certificate", given.join(", "))))
        }
    }
}

/// The record of a calibration, and the list of the digests of its files.
pub struct Recorded {
    record: Record,
    list: String,
}

/// What a calibration was made of, and made.
struct Made<'a> {
    /// Photographs as they were given; of the measured ones their names too.
    photos: (&'a [PathBuf], &'a [Photo]),
    method: Option<String>,
    board: Option<String>,
    /// Tables and start values.
    inputs: Vec<PathBuf>,
    /// The camera file.
    camera: Option<PathBuf>,
}

/// The certificate that was asked for.
pub type Asked = (OutputFile, Fields);

/// Measured photographs, what was in doubt of them before, what the inputs are suspected to be.
type Before<'a> = (&'a [Photo], &'a [String], &'a [Suspected]);

impl Calibrate {
    /// The certificate that was asked for.
    pub(super) fn certified(&self, inputs: &Inputs) -> Result<Option<Asked>, Failure> {
        let Some(path) = &self.certificate else { return self.said.without_certificate().map(|()| None) };
        if self.cameras.are_several() {
            let what = "several cameras, and a certificate is of one; write a report (--report DIR), then `calibench certificate DIR --camera NAME -o FILE`";
            return Err(Failure::input(format!("--certificate: {what}")));
        }
        Ok(Some((output::document("--certificate", path, inputs)?, self.said.fields()?)))
    }

    /// What a certificate or a report holds of the calibration and its files, if either is asked for. It comes after the camera file, whose digest is among the others.
    pub(super) fn recorded(
        &self,
        calibration: &Calibration<'_>,
        (photos, doubts, suspects): Before<'_>,
        outputs: &Outputs,
    ) -> Result<Option<Recorded>, Failure> {
        if outputs.report.is_none() && outputs.certificate.is_none() {
            return Ok(None);
        }
        let given = [&self.points, &self.control, &self.approx, &self.distances, &self.poses].into_iter().flatten().cloned();
        let usual = |board| finder(board).map(|finder| finder.usual_method().to_owned());
        let method = match (self.board, &self.method) {
            (None, _) => None,
            (_, Some(method)) => Some(method.clone()),
            (Some(board), None) => Some(usual(board)?),
        };
        let made = Made {
            photos: (&self.photos, photos),
            method,
            board: self.board.map(|board| board.to_string()),
            inputs: given
                .chain(self.cameras.starts())
                .chain(self.known.inputs().cloned())
                .chain(self.reconstruction.path.iter().flat_map(|path| files_of(path)))
                .collect(),
            camera: outputs.camera.as_ref().map(|output| output.path().to_owned()).filter(|path| path.is_file()),
        };
        Recorded::new(calibration, (doubts, suspects), &made).map(Some)
    }
}

/// The file of a reconstruction, or those of its folder.
fn files_of(path: &Path) -> Vec<PathBuf> {
    let Ok(entries) = path.read_dir() else { return vec![path.to_owned()] };
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).filter(|path| path.is_file()).collect();
    files.sort();
    files
}

impl Recorded {
    /// Of a calibration, with doubts about its photographs that others had before, and what its inputs are suspected to be.
    ///
    /// # Errors
    /// A file that cannot be read again, a covariance that is none.
    fn new(calibration: &Calibration<'_>, (doubts, suspects): (&[String], &[Suspected]), made: &Made<'_>) -> Result<Self, Failure> {
        let answer = CalibrationAnswer::new(calibration, doubts, suspects).map_err(Failure::Input)?;
        let groups = calibration.resampled.as_ref().and_then(|found| found.as_ref().ok()).map(|found| found.groups);
        let cameras = (0..calibration.cameras()).map(|camera| CameraRecord {
            equipment: equipment(calibration, camera, made.photos.1),
            frame: FrameUncertainty::of(calibration, camera).map(|found| frame(&found)),
        });
        let roles = made.photos.0.iter().map(|path| (Role::Photograph, path));
        let roles =
            roles.chain(made.inputs.iter().map(|path| (Role::Input, path))).chain(made.camera.iter().map(|path| (Role::Camera, path)));
        let (all, pipes): (Vec<_>, Vec<_>) = roles.partition(|(_, path)| path.is_file());
        let paths: Vec<&Path> = all.iter().map(|(_, path)| path.as_path()).collect();
        let digests = paths.par_iter().map(|path| digest_of_file(path).map_err(|error| at(path, &error))).collect::<Result<Vec<_>, _>>()?;
        let (mut files, mut list) = (Vec::new(), String::new());
        for (((role, _), path), (digest, bytes)) in all.iter().zip(shown(&paths)).zip(digests) {
            list.push_str(&line(&digest, &path));
            files.push(FileEntry { role: *role, path, bytes });
        }
        let record = Record {
            certificate: RECORD,
            calibench: env!("CARGO_PKG_VERSION").into(),
            calibration: answer_value(&answer)?,
            groups,
            method: made.method.clone(),
            board: made.board.clone(),
            cameras: cameras.collect(),
            tasks: Vec::new(),
            files,
            without_digest: pipes.iter().map(|(_, path)| format!("{}: no file that can be read again", path.display())).collect(),
        };
        Ok(Self { record, list })
    }

    /// Puts record and list into the folder of a report.
    pub fn put(&self, folder: &NewFolder) -> std::io::Result<()> {
        let text = serde_json::to_string(&self.record)?;
        folder.write(RECORD_FILE, |file| file.write_all(text.as_bytes()))?;
        folder.write(LIST_FILE, |file| file.write_all(self.list.as_bytes()))
    }

    /// Writes the certificate of the only camera; says what it is.
    pub fn write(&self, fields: &Fields, output: &OutputFile) -> Result<bool, Failure> {
        certify(&Certificate { fields: fields.clone(), camera: 0, record: self.record.clone() }, &self.list, output)
    }
}

/// Writes a certificate, and returns whether it is in doubt.
pub fn certify(certificate: &Certificate, list: &str, output: &OutputFile) -> Result<bool, Failure> {
    let made = Sealed::new(certificate, list)?.certified()?;
    output.write::<std::io::Error>(|file| file.write_all(&made.pdf))?;
    let doubt = if made.doubts.is_empty() { "" } else { ", in doubt" };
    say!("{}: certificate{doubt}, SHA-256 {}", output.path().display(), made.digest);
    Ok(!made.doubts.is_empty())
}

/// Files as a certificate names them: relative to the folder of the command, or by as many of their last names as tell them apart.
fn shown(paths: &[&Path]) -> Vec<String> {
    let joined = |parts: &[&OsStr]| parts.iter().map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/");
    let named = |path: &Path| path.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    let parts: Vec<Vec<&OsStr>> = paths
        .iter()
        .map(|path| path.components().filter_map(|part| if let Component::Normal(part) = part { Some(part) } else { None }).collect())
        .collect();
    let last = |parts: &[&OsStr], count: usize| joined(&parts[parts.len().saturating_sub(count)..]);
    let foreign = || paths.iter().zip(&parts).filter(|(path, _)| !named(path)).map(|(_, parts)| parts);
    let deepest = parts.iter().map(Vec::len).max().unwrap_or(1);
    let are_apart = |count: &usize| {
        let mut names: Vec<String> = foreign().map(|parts| last(parts, *count)).collect();
        let all = names.len();
        names.sort_unstable();
        names.dedup();
        names.len() == all
    };
    let count = (1..=deepest).find(are_apart).unwrap_or(deepest);
    paths.iter().zip(&parts).map(|(path, parts)| if named(path) { joined(parts) } else { last(parts, count) }).collect()
}

/// What the photographs of a camera say of it, those that say the same counted. One that cannot be read says nothing.
fn equipment(calibration: &Calibration<'_>, camera: usize, photos: &[Photo]) -> Vec<Equipment> {
    let images = &calibration.prepared.survey.images;
    let own: BTreeSet<&str> =
        images.iter().enumerate().filter(|(image, _)| calibration.owner(*image) == camera).map(|(_, name)| name.as_str()).collect();
    let mut paths: Vec<&PathBuf> = photos.iter().filter(|(name, ..)| own.contains(name.as_str())).map(|(_, path, _)| path).collect();
    paths.dedup();
    let found: Vec<_> = paths.par_iter().map(|path| said(path).unwrap_or_default()).collect();
    let mut all: Vec<Equipment> = Vec::new();
    for one in found {
        let (first, last) = (one.taken.clone(), one.taken);
        let like = Equipment {
            photographs: 1,
            camera: one.camera,
            serial: one.serial,
            lens: one.lens,
            lens_serial: one.lens_serial,
            focal_mm: one.focal_mm,
            f_number: one.f_number,
            first,
            last,
        };
        let is_same = |known: &&mut Equipment| {
            let bare = |one: &Equipment| Equipment { photographs: 0, first: None, last: None, ..one.clone() };
            bare(known) == bare(&like)
        };
        match all.iter_mut().find(is_same) {
            Some(known) => {
                known.photographs += 1;
                known.first = [known.first.take(), like.first].into_iter().flatten().min();
                known.last = [known.last.take(), like.last].into_iter().flatten().max();
            }
            None => all.push(like),
        }
    }
    all
}

fn frame(found: &FrameUncertainty) -> FrameRecord {
    let digits = |sigma: f64| format!("{sigma:.3e}").parse().unwrap_or(sigma);
    let place = |(name, (at, sigma_px, measured)): (&&str, &(calibench_model::PixelPoint, Option<f64>, bool))| PlaceRecord {
        name: (*name).into(),
        x: at.x,
        y: at.y,
        sigma_px: *sigma_px,
        measured: *measured,
    };
    FrameRecord {
        grid: [found.grid.0, found.grid.1],
        sigma_px: found.places.iter().map(|(_, sigma, _)| sigma.map(digits)).collect(),
        measured: found.places.iter().map(|(.., measured)| *measured).collect(),
        places: PLACES.iter().zip(&found.chosen).map(place).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_named_without_the_folders_of_a_machine() {
        let of = |paths: &[&str]| shown(&paths.iter().map(Path::new).collect::<Vec<_>>());
        assert_eq!(of(&["photos/a.png", "./b.png"]), ["photos/a.png", "b.png"]);
        assert_eq!(of(&["/home/me/left/a.png", "/home/me/left/b.png"]), ["a.png", "b.png"]);
        assert_eq!(of(&["/home/me/left/a.png", "/home/me/right/a.png", "c.png"]), ["left/a.png", "right/a.png", "c.png"]);
        assert_eq!(of(&["../a.png"]), ["a.png"]);
    }
}
