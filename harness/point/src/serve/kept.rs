//! What was pointed at, on the disk: one table beside the photographs, of which browsers have copies.

use std::collections::HashMap;
use std::fs::{self, File};
use std::io;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use calibench_exchange::points::parse_points_checked;
use calibench_exchange::write_points;
use calibench_files::{OutputFile, bounded};
use calibench_model::{PixelPoint, PointRef, PointRow, Start, TargetKind};
use serde::Deserialize;
use serde_json::{Value, json};

/// A table of points that are pointed at: `image,target,x,y` and the shape, as `measure --points` reads it.
///
/// Whoever changes points says which: they are merged by photograph and target into what the table holds at that moment, and it is replaced at once. What it holds of
/// other photographs stays.
pub struct Kept {
    file: OutputFile,
    photos: Vec<String>,
    kind: Option<TargetKind>,
    turn: Mutex<()>,
}

/// What a browser sends: which state it knows, and what it changed since.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Changes {
    since: Option<String>,
    /// Photograph, target, and where it is now, or nowhere.
    pub(super) changes: Vec<(usize, String, Option<[f64; 2]>)>,
}

impl Kept {
    /// The table `file` of `photos`, as points call them; rows that are new have this `kind`.
    ///
    /// # Errors
    /// A table that is there and is none of points, or one of measured points, which it would spoil.
    pub fn open(file: OutputFile, photos: Vec<String>, kind: Option<TargetKind>) -> Result<Self, String> {
        let kept = Self { file, photos, kind, turn: Mutex::new(()) };
        kept.rows().map(|_| kept)
    }

    fn rows(&self) -> Result<Vec<PointRow>, String> {
        let name = self.file.path().display().to_string();
        let text = match bounded::table(self.file.path()) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            read => read.map_err(|error| format!("{name}: {error}"))?,
        };
        let found = parse_points_checked(&name, &text[..], &|_| Ok(())).map_err(|error| error.to_string())?;
        if !found.lost.is_empty() || found.points.rows().any(|row| row.start.covariance.is_some()) {
            return Err(format!(
                "{name}: holds measured points, expected none but those that are pointed at; name another file by --points"
            ));
        }
        Ok(found.points.rows().map(PointRow::from).collect())
    }

    /// Takes changes, and answers with all that is pointed at now, or with its revision alone if that is known.
    ///
    /// # Errors
    /// In words: a photograph or a name that there is not, and what the file system refuses; nothing is changed then.
    pub(super) fn take(&self, sent: &Changes) -> Result<Value, String> {
        let _turn = self.turn.lock().unwrap_or_else(PoisonError::into_inner);
        // Another server of these photographs waits as well.
        let folder = File::open(self.file.path().parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))).ok();
        folder.as_ref().map(File::lock);
        let rows = if sent.changes.is_empty() {
            if sent.since.as_ref() == Some(&self.revision()) {
                return Ok(json!({ "revision": sent.since }));
            }
            self.rows()?
        } else {
            let rows = self.merged(&sent.changes)?;
            let refs = rows.iter().map(PointRef::from);
            self.file.write(|file| write_points(file, refs)).map_err(|error| error.to_string())?;
            rows
        };
        let cells = |row: &PointRow| json!([row.target, row.start.position.x, row.start.position.y]);
        let of = |photo: &String| rows.iter().filter(|row| row.image == *photo).map(cells).collect::<Vec<Value>>();
        let points: Vec<Vec<Value>> = self.photos.iter().map(of).collect();
        Ok(json!({ "revision": self.revision(), "points": points }))
    }

    /// The rows of the table with these changes.
    fn merged(&self, changes: &[(usize, String, Option<[f64; 2]>)]) -> Result<Vec<PointRow>, String> {
        let mut rows: Vec<Option<PointRow>> = self.rows()?.into_iter().map(Some).collect();
        let key = |row: &PointRow| (row.image.clone(), row.target.clone());
        let mut places: HashMap<(String, String), usize> =
            rows.iter().enumerate().filter_map(|(place, row)| Some((key(row.as_ref()?), place))).collect();
        for (photo, target, at) in changes {
            let image = self.photos.get(*photo).ok_or("there is no such photograph")?;
            let target = target.trim();
            if target.is_empty() || target.contains(char::is_control) {
                return Err("expected a name without control characters".to_owned());
            }
            let place = *places.entry((image.clone(), target.to_owned())).or_insert(rows.len());
            if place == rows.len() {
                rows.push(None);
            }
            let position = at.map(|[x, y]| PixelPoint::new(x, y));
            let old = rows[place].take().map_or(Start { kind: self.kind, ..Start::at(PixelPoint::new(0.0, 0.0)) }, |row| row.start);
            rows[place] =
                position.map(|position| PointRow { image: image.clone(), target: target.to_owned(), start: Start { position, ..old } });
        }
        Ok(rows.into_iter().flatten().collect())
    }

    /// What is another one after each change of the table, whoever made it.
    fn revision(&self) -> String {
        let Ok(about) = fs::metadata(self.file.path()) else { return String::new() };
        #[cfg(unix)]
        let number = std::os::unix::fs::MetadataExt::ino(&about);
        #[cfg(not(unix))]
        let number = 0;
        let time = about.modified().ok().and_then(|time| time.duration_since(std::time::UNIX_EPOCH).ok()).unwrap_or_default();
        format!("{number}-{}-{}", about.len(), time.as_nanos())
    }
}
