//! Corners that were measured beforehand: a point file in an operator's place.

use std::collections::HashMap;
use std::sync::Arc;

use calibench_diagnostics::nearest;
use calibench_exchange::{PointFile, PointRef};
use calibench_measure::Board;
use calibench_model::PixelPoint;
use calibench_model::camera::ImageSize;

use super::{Corners, Material};

/// What the rows of a point file may name: the corners of a board, in images of one size.
#[derive(Clone, Debug)]
pub struct Expected {
    board: Board,
    size: ImageSize,
    places: HashMap<String, usize>,
}

impl Expected {
    /// The corners of `board` by their names (`r1c1` is the first) in images of `size`, px.
    pub fn new(board: Board, size: ImageSize) -> Self {
        Self { board, size, places: (0..board.corners()).map(|index| (board.target(index), index)).collect() }
    }

    /// Whether a row names a corner of the board, and lies in the image.
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

    /// Whether `target` is a corner of the board.
    ///
    /// # Errors
    /// What was expected and what to do.
    pub fn name(&self, target: &str) -> Result<(), String> {
        if self.places.contains_key(target) { Ok(()) } else { Err(self.stranger(target)) }
    }

    fn stranger(&self, target: &str) -> String {
        let Board { columns, rows } = self.board;
        let (first, last) = (self.board.target(0), self.board.target(self.board.corners() - 1));
        let mut known: Vec<&str> = self.places.keys().map(String::as_str).collect();
        known.sort_unstable();
        let near = nearest(target, known).map_or_else(String::new, |near| format!("; is it `{near}`?"));
        format!(
            "`{target}` is no inner corner of a board of {columns} x {rows}: expected `{first}` (row 1, column 1) to `{last}`, as `calibench control {columns}x{rows}:SIDE` \
             lists them{near}"
        )
    }
}

impl Material {
    /// The corners of point files whose rows passed [`Expected::check`], each file by the name of its operator; `side` is that of the board's squares, object
    /// units, `size` that of the images, px.
    ///
    /// Images stand in the order in which the files name them. Rows that a method rejected count as rejected; covariances are not used.
    pub fn of_files(files: &[(&Arc<str>, &PointFile)], board: Board, side: f64, size: ImageSize) -> Self {
        let places = Expected::new(board, size).places;
        let mut views = Views::default();
        let operators: Vec<Read> = files.iter().map(|(_, file)| Read::new(file, &places, &mut views)).collect();
        let missed = missed(files, &views);
        let corners = |((name, _), read): (&(&Arc<str>, &PointFile), Read)| {
            let mut at = vec![vec![None; board.corners()]; views.names.len()];
            read.found.into_iter().for_each(|(view, corner, position)| at[view][corner] = Some(position));
            Corners { method: Arc::clone(name), unavailable: None, at, rejected: read.rejected }
        };
        let operators = files.iter().zip(operators).map(corners).collect();
        Self { board, side, size, views: views.names, missed, operators }
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
