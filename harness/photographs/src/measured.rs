//! A board's points in photographs, found and measured by one method.

use std::path::{Path, PathBuf};

use calibench_measure::Operator;
use calibench_model::camera::ImageSize;
use calibench_model::{LostRow, PixelPoint, PointRow, Start};
use rayon::prelude::*;

use crate::copies::copies;
use crate::names::{names, once};
use crate::{Finder, PhotographsError, Reader, Sighting};

/// The status of a photograph in which the board was not found.
pub const NOT_FOUND: &str = "not_found";
/// The status of a photograph that is the same as another one.
pub const COPY: &str = "copy";

/// A photograph: the name of its image, where it is, and its size.
pub type Photo = (String, PathBuf, ImageSize);

/// The points of a photograph under other names.
fn placed<'n>(corners: &Corners, called: &'n [String]) -> Vec<(&'n str, PixelPoint)> {
    called.iter().map(String::as_str).zip(corners.points.iter().map(|row| row.start.position)).collect()
}

/// Measured points, and the photographs that they are of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Corners {
    /// Those with a position.
    pub points: Vec<PointRow>,
    /// Those without.
    pub lost: Vec<LostRow>,
    /// The photographs, where each of several boards counts one for each view; none where the points were given.
    pub photos: Vec<Photo>,
    /// What is in doubt of where the board was found.
    pub doubts: Vec<String>,
}

impl FromIterator<Corners> for Corners {
    fn from_iter<I: IntoIterator<Item = Corners>>(all: I) -> Self {
        let mut whole = Self::default();
        for one in all {
            whole.points.extend(one.points);
            whole.lost.extend(one.lost);
            whole.photos.extend(one.photos);
            whole.doubts.extend(one.doubts);
        }
        whole
    }
}

impl Finder {
    /// The board's points in photographs: approximately where it is found, then by the operator called `method`. Those that it rejects, and photographs without
    /// the board, are listed among the lost, and so are photographs that are the same as another one, which are in doubt. One list a photograph; `step` is called
    /// after each, on any thread.
    ///
    /// # Errors
    /// A photograph that cannot be read, or that is given twice.
    pub fn measure(
        &self,
        reader: &Reader,
        (method, operator): (&str, &dyn Operator),
        step: &(dyn Fn() + Sync),
    ) -> Result<Vec<Corners>, PhotographsError> {
        let (photos, names) = (reader.photos(), names(reader.photos()));
        once(photos)?;
        let one = |(path, name): (&PathBuf, &String)| {
            let found = self.in_photo(reader, (path, name), operator, method);
            step();
            found
        };
        let mut found: Vec<Corners> = photos.par_iter().zip(&names).map(one).collect::<Result<_, _>>()?;
        let called: Vec<Vec<String>> = found.iter().map(|corners| corners.points.iter().map(|row| self.key(row)).collect()).collect();
        let points: Vec<Vec<_>> = found.iter().zip(&called).map(|(corners, called)| placed(corners, called)).collect();
        for same in copies(&points) {
            found[same.of].doubts.push(same.said(&names));
            for copy in same.others {
                let reason = format!("the same photograph as {}", names[same.of]);
                found[copy].points.clear();
                found[copy].lost = vec![LostRow { image: names[copy].clone(), target: String::new(), status: COPY.to_owned(), reason }];
            }
        }
        Ok(found)
    }

    fn in_photo(
        &self,
        reader: &Reader,
        (path, name): (&Path, &str),
        operator: &dyn Operator,
        method: &str,
    ) -> Result<Corners, PhotographsError> {
        let image = reader.read(path)?;
        let Sighting { rows, why, doubts, .. } = self.find(&image, name);
        let starts: Vec<Start> = rows.iter().map(|row| row.start).collect();
        let measured = operator.measure_all(&image, &starts);
        let size = ImageSize { width: image.width() as u32, height: image.height() as u32 };
        let mut views: Vec<String> = rows.iter().map(|row| row.image.clone()).collect();
        views.dedup();
        if views.is_empty() {
            views.push(name.to_owned());
        }
        let photos = views.into_iter().map(|view| (view, path.to_owned(), size)).collect();
        let doubts = doubts.into_iter().map(|doubt| format!("{name}: {doubt}")).collect();
        let mut corners = Corners { points: Vec::new(), lost: Vec::new(), photos, doubts };
        let lost =
            |image: String, target: String, status: &str, reason: String| LostRow { image, target, status: status.to_owned(), reason };
        if let Some(why) = why {
            corners.lost.push(lost(name.to_owned(), String::new(), NOT_FOUND, why));
        }
        for (row, result) in rows.into_iter().zip(measured) {
            match result {
                Ok(found) => {
                    let start = Start { position: found.position, covariance: found.covariance, ..row.start };
                    corners.points.push(PointRow { start, ..row });
                }
                Err(rejection) => corners.lost.push(lost(row.image, row.target, "rejected", format!("{method}: {rejection}"))),
            }
        }
        Ok(corners)
    }
}
