//! `calibench detect --draw`: what was found, drawn on the photographs.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use calibench_files::{NewFolder, OutputFolder};
use calibench_model::{ControlRow, PixelPoint, PointRow};
use calibench_photographs::Reader;
use calibench_photographs::names::names;
use calibench_report::{Look, found};
use rayon::prelude::*;

use super::doubtful::doubtful;
use crate::failure::Failure;

/// So many points of a board are named: they say which way the names run.
const FIRST: usize = 3;

/// What is drawn on a photograph.
pub struct Drawn<'a> {
    /// The points that were found in it.
    pub rows: Vec<&'a PointRow>,
    /// Why there are none.
    pub why: Option<String>,
}

/// Draws what was found on each photograph and writes it as PNG, called as the photograph; returns what is to be said of points in doubt. `control` says where the
/// points are on the board; of a field, which may be none, no point is doubted.
pub fn draw(output: &OutputFolder, reader: &Reader, drawn: &[Drawn<'_>], control: &[ControlRow]) -> Result<Vec<String>, Failure> {
    let files = files(reader.photos());
    let mut said = Vec::new();
    output.replace(|folder: &NewFolder| {
        let one = |((path, name), drawn): ((&PathBuf, &String), &Drawn<'_>)| {
            let (points, doubts) = looks(drawn, control);
            let canvas = found(&reader.read(path).map_err(|error| Failure::input(error.to_string()))?, &points);
            folder.write(name, |file| canvas.encode(file))?;
            Ok(doubts.map(|doubts| format!("{}: {doubts}", path.display())))
        };
        let all: Vec<Option<String>> = reader.photos().par_iter().zip(&files).zip(drawn).map(one).collect::<Result<_, Failure>>()?;
        said.extend(all.into_iter().flatten());
        Ok::<_, Failure>(())
    })?;
    Ok(said)
}

/// Points with their labels and looks, and what is to be said of those in doubt.
fn looks(drawn: &Drawn<'_>, control: &[ControlRow]) -> (Vec<(String, PixelPoint, Look)>, Option<String>) {
    if let Some(why) = &drawn.why {
        // At the upper left corner.
        return (vec![(why.clone(), PixelPoint::new(0.0, 0.0), Look::Doubtful)], None);
    }
    let (mut points, mut doubts) = (Vec::new(), Vec::new());
    for view in drawn.rows.chunk_by(|a, b| a.image == b.image) {
        let own = doubtful(view, control);
        for (place, row) in view.iter().enumerate() {
            let off = own.iter().find(|(doubtful, _)| *doubtful == place).map(|(_, px)| px);
            let (label, look) = match off {
                Some(px) => (format!("{}: {px:.1} px off", row.target), Look::Doubtful),
                None if place < FIRST => (row.target.clone(), Look::First),
                None => (row.target.clone(), Look::Plain),
            };
            points.push((label, row.start.position, look));
        }
        doubts.extend(own.iter().map(|(place, px)| format!("{} by {px:.1} px", view[*place].target)));
    }
    let said = format!("points that are not where their neighbours say they must be: {}", doubts.join(", "));
    (points, (!doubts.is_empty()).then_some(said))
}

/// A file for each photograph, no two of the same name.
fn files(photos: &[PathBuf]) -> Vec<String> {
    let mut taken = BTreeSet::new();
    let file = |name: String| {
        let whole: String = name.chars().map(|c| if std::path::is_separator(c) || c == ':' { '-' } else { c }).collect();
        let stem = Path::new(&whole).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        // a.jpg beside a.png.
        let name = if taken.insert(format!("{stem}.png")) { format!("{stem}.png") } else { format!("{whole}.png") };
        taken.insert(name.clone());
        name
    };
    names(photos).into_iter().map(file).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_photograph_has_a_file_of_its_own() {
        let photos = ["x/a.jpg", "x/a.png", "x/b.tif", "y/b.tif"].map(PathBuf::from);
        assert_eq!(files(&photos), ["a.png", "a.png.png", "x-b.png", "y-b.png"]);
    }
}
