//! Corners that were measured beforehand: a point file in an operator's place.

use std::collections::HashMap;
use std::sync::Arc;

use calibench_exchange::PointFile;
use calibench_model::camera::ImageSize;
use calibench_model::{PixelPoint, PointRef};

use super::{Corners, Field, Material};

/// What the rows of a point file may name: the points of a field, in images of one size.
#[derive(Clone, Debug)]
pub struct Expected {
    field: Field,
    size: ImageSize,
    places: HashMap<String, usize>,
}

impl Expected {
    /// The points of `field` by their names (of a board `r1c1` is the first) in images of `size`, px.
    pub fn new(field: Field, size: ImageSize) -> Self {
        let places = (0..field.count()).map(|index| (field.name(index).into_owned(), index)).collect();
        Self { field, size, places }
    }

    /// Whether a row names a point of the field, and lies in the image.
    ///
    /// # Errors
    /// The column that is wrong, what was expected there and what to do.
    pub fn check(&self, point: &PointRef<'_>) -> Result<(), (&'static str, String)> {
        self.name(point.target).map_err(|why| ("target", why))?;
        let PixelPoint { x, y } = point.start.position;
        let beyond = |at: f64, extent: u32| !(-0.5..=f64::from(extent) - 0.5).contains(&at);
        let (column, at, extent) = match (beyond(x, self.size.width), beyond(y, self.size.height)) {
            (false, false) => return Ok(()),
            (true, _) => ("x", x, self.size.width),
            (false, true) => ("y", y, self.size.height),
        };
        let (width, height) = (self.size.width, self.size.height);
        Err((
            column,
            format!(
                "{at} px is outside the image: expected -0.5 to {} with --size {width}x{height} (0 is the centre of the first pixel); correct --size or the point",
                f64::from(extent) - 0.5
            ),
        ))
    }

    /// Whether `target` is a point of the field.
    ///
    /// # Errors
    /// What was expected and what to do.
    pub fn name(&self, target: &str) -> Result<(), String> {
        if self.places.contains_key(target) { Ok(()) } else { Err(self.field.stranger(target)) }
    }
}

impl Material {
    /// The corners of point files whose rows passed [`Expected::check`], each file by the name of its operator.
    ///
    /// Images stand in the order in which the files name them. Rows that a method rejected count as rejected; covariances are not used.
    pub fn of_files(files: &[(&Arc<str>, &PointFile)], expected: &Expected) -> Self {
        let Expected { field, size, places } = expected;
        let mut views = Views::default();
        let operators: Vec<Read> = files.iter().map(|(_, file)| Read::new(file, places, &mut views)).collect();
        let missed = missed(files, &views);
        let corners = |((name, _), read): (&(&Arc<str>, &PointFile), Read)| {
            let mut at = vec![vec![None; field.count()]; views.names.len()];
            read.found.into_iter().for_each(|(view, corner, position)| at[view][corner] = Some(position));
            Corners { method: Arc::clone(name), unavailable: None, at, rejected: read.rejected }
        };
        let operators = files.iter().zip(operators).map(corners).collect();
        Self { field: field.clone(), size: *size, views: views.names, missed, operators }
    }
}

/// Images in the order in which they are named.
#[derive(Default)]
struct Views {
    names: Vec<Arc<str>>,
    places: HashMap<Arc<str>, usize>,
}

impl Views {
    fn place(&mut self, name: &str) -> usize {
        if let Some(&place) = self.places.get(name) {
            return place;
        }
        let name: Arc<str> = name.into();
        self.names.push(name.clone());
        self.places.insert(name, self.names.len() - 1);
        self.names.len() - 1
    }
}

/// The rows of a file, by image and corner.
struct Read {
    found: Vec<(usize, usize, PixelPoint)>,
    rejected: Vec<(usize, usize, Arc<str>)>,
}

impl Read {
    fn new(file: &PointFile, places: &HashMap<String, usize>, views: &mut Views) -> Self {
        let point = |row: PointRef<'_>| Some((views.place(row.image), *places.get(row.target)?, row.start.position));
        let found = file.points.rows().filter_map(point).collect();
        let lost = |[image, target, status, reason]: [&str; 4]| {
            let corner = *places.get(target).filter(|_| status == "rejected")?;
            Some((views.place(image), corner, reason.into()))
        };
        Self { found, rejected: file.lost.iter().filter_map(lost).collect() }
    }
}

/// Images without any corner of which a file says why, each once.
fn missed(files: &[(&Arc<str>, &PointFile)], views: &Views) -> Vec<(Arc<str>, String)> {
    let mut missed: Vec<(Arc<str>, String)> = Vec::new();
    for [image, _, _, reason] in files.iter().flat_map(|(_, file)| file.lost.iter()) {
        if !views.places.contains_key(image) && !missed.iter().any(|(name, _)| &**name == image) {
            missed.push((image.into(), reason.to_owned()));
        }
    }
    missed
}
