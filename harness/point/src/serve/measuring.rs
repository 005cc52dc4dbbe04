//! What the page asks for: itself, tiles, measurements, predictions.

use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use calibench_images::PhotoError;
use calibench_measure::{Configured, Operator};
use calibench_model::camera::{Camera, ImageSize};
use calibench_model::{ControlRow, Image, PixelPoint, Start, TargetKind};
use rayon::prelude::*;
use serde::Deserialize;
use serde_json::{Value, json};

use super::http::{Answer, Request};
use super::kept::{Changes, Kept};
use super::not_found;
use crate::page::{Content, Pictured, served_page};
use crate::predict::predict;
use crate::shown::Shown;

/// Photographs in memory at a time.
const HELD: usize = 2;

/// What a server answers with.
pub struct Served<'a> {
    photos: Vec<(String, &'a Path)>,
    sizes: Vec<ImageSize>,
    operator: &'a dyn Operator,
    label: &'a str,
    kind: Option<TargetKind>,
    control: &'a [ControlRow],
    cameras: Option<Vec<Camera>>,
    kept: &'a Kept,
    page: String,
    held: Mutex<Vec<(usize, Arc<Held>)>>,
}

/// A photograph in memory.
struct Held {
    shown: Shown,
    image: Image<'static>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Pointed {
    photo: usize,
    x: f64,
    y: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Known {
    photo: usize,
    points: Vec<(String, f64, f64)>,
}

impl<'a> Served<'a> {
    /// `photos` (what points call each, and its file) are read once, so that what is wrong with one is said before anything is pointed at; `method` measures, and
    /// `kept` holds what is pointed at.
    ///
    /// # Errors
    /// A photograph that cannot be read.
    pub fn new(
        content: &Content,
        photos: Vec<(String, &'a Path)>,
        (method, operator): (&'a Configured, &'a dyn Operator),
        kind: Option<TargetKind>,
        control: &'a [ControlRow],
        kept: &'a Kept,
    ) -> Result<Self, PhotoError> {
        let read = |(name, path): &(String, &Path)| Ok(Pictured::new(name, &Shown::read(path)?.0));
        let pictured = photos.par_iter().map(read).collect::<Result<Vec<_>, PhotoError>>()?;
        let sizes = pictured.iter().map(Pictured::size).collect();
        let page = served_page(content, &pictured, &method.label);
        let held = Mutex::new(Vec::new());
        Ok(Self { photos, sizes, operator, label: &method.label, kind, control, cameras: None, kept, page, held })
    }

    /// The sizes of the photographs.
    pub fn sizes(&self) -> &[ImageSize] {
        &self.sizes
    }

    /// Predicts with the camera of each photograph.
    #[must_use]
    pub fn with_cameras(mut self, cameras: Vec<Camera>) -> Self {
        self.cameras = Some(cameras);
        self
    }

    /// The answer to a request for what is at `path`, and whether somebody used the page for it: one that only asks what others changed comes by itself.
    pub(super) fn answer(&self, request: &Request, path: &str) -> (Answer, bool) {
        let mut used = true;
        let answer = match (request.method.as_str(), path) {
            ("POST", "points") => asked(request, |sent: Changes| {
                used = !sent.changes.is_empty();
                Some(self.kept.take(&sent))
            }),
            ("GET", "") => Answer::new("text/html; charset=utf-8", self.page.clone().into_bytes()),
            ("GET", path) if path.starts_with("tile/") => self.tile(path).unwrap_or_else(not_found),
            ("POST", "ping") => Answer::json(&json!({})),
            ("POST", "measure") => asked(request, |pointed: Pointed| self.measured(&pointed)),
            ("POST", "predict") => asked(request, |known: Known| self.predicted(&known)),
            (_, "" | "ping" | "measure" | "predict" | "points") => Answer::words(405, "not in this way"),
            _ => not_found(),
        };
        (answer, used)
    }

    fn tile(&self, path: &str) -> Option<Answer> {
        let numbers: Vec<usize> = path.split('/').skip(1).map(|text| text.parse().ok()).collect::<Option<_>>()?;
        let [photo, level, column, row] = numbers.try_into().ok()?;
        match self.held(photo)? {
            Err(error) => Some(Answer::words(500, &error.to_string())),
            Ok(held) => Some(Answer::new("image/jpeg", held.shown.tile([level, column, row]).ok()??)),
        }
    }

    /// A photograph, read again if it is not in memory.
    fn held(&self, photo: usize) -> Option<Result<Arc<Held>, PhotoError>> {
        let path = self.photos.get(photo)?.1;
        // Locked while it is read: who asks for its next tile waits instead of reading it, too.
        let mut held = self.held.lock().unwrap_or_else(PoisonError::into_inner);
        let place = held.iter().position(|(index, _)| *index == photo);
        let found = if let Some(place) = place {
            held.remove(place).1
        } else {
            if held.len() >= HELD {
                held.remove(0);
            }
            match Shown::read(path) {
                Ok((shown, image)) => Arc::new(Held { shown, image }),
                Err(error) => return Some(Err(error)),
            }
        };
        held.push((photo, Arc::clone(&found)));
        Some(Ok(found))
    }

    fn measured(&self, pointed: &Pointed) -> Option<Result<Value, String>> {
        let held = match self.held(pointed.photo)? {
            Ok(held) => held,
            Err(error) => return Some(Err(error.to_string())),
        };
        let start = Start { kind: self.kind, ..Start::at(PixelPoint::new(pointed.x, pointed.y)) };
        let result = self.operator.measure_all(&held.image, &[start]).pop()?;
        let mut answer = match result {
            Ok(found) => json!({
                "status": "measured",
                "x": found.position.x,
                "y": found.position.y,
                "covariance": found.covariance.map(|c| [c.sxx, c.sxy, c.syy]),
            }),
            Err(why) => json!({ "status": "rejected", "reason": why.name(), "meaning": why.meaning() }),
        };
        answer["method"] = json!(self.label);
        Some(Ok(answer))
    }

    fn predicted(&self, known: &Known) -> Option<Result<Value, String>> {
        let size = *self.sizes.get(known.photo)?;
        let camera = self.cameras.as_ref().and_then(|cameras| cameras.get(known.photo));
        let points: Vec<_> = known.points.iter().map(|(name, x, y)| (name.clone(), PixelPoint::new(*x, *y))).collect();
        Some(Ok(match predict(self.control, &points, size, camera) {
            Ok(found) => {
                let targets: Vec<_> = found.targets.iter().map(|(name, place)| json!([name, place.x, place.y])).collect();
                json!({ "targets": targets, "how": found.how })
            }
            Err(why) => json!({ "targets": [], "how": format!("Nothing is predicted: {why}") }),
        }))
    }
}

/// What `answer` says to the JSON of a request; nothing where what it is about is not there.
fn asked<T: for<'d> Deserialize<'d>>(request: &Request, answer: impl FnOnce(T) -> Option<Result<Value, String>>) -> Answer {
    if request.header("content-type") != Some("application/json") {
        return Answer::words(400, "expected JSON");
    }
    match serde_json::from_slice(&request.body) {
        Err(error) => Answer::words(400, &error.to_string()),
        Ok(asked) => match answer(asked) {
            None => not_found(),
            Some(Err(error)) => Answer::words(500, &error),
            Some(Ok(value)) => Answer::json(&value),
        },
    }
}
