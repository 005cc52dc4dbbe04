//! What a calibrator is told: what a user would know, and nothing of the truth.

use calibench_model::PixelPoint;
use calibench_model::camera::ImageSize;
use nalgebra::Point3;
use serde_json::{Value, json};

/// What is to be calibrated.
#[derive(Clone, Debug, PartialEq)]
pub struct Task {
    /// The camera model asked for, one of [`calibench_calibrate::MODELS`].
    pub model: String,
    /// Of all images, px.
    pub size: ImageSize,
    /// The standard deviation of an image coordinate as the user states it, px; `None` where it is not stated.
    pub sigma_px: Option<f64>,
    /// What object coordinates are in.
    pub unit: String,
    /// The board, in a word as options have it; `None` for other control.
    pub board: Option<String>,
    /// Object points with their names, object units.
    pub points: Vec<(String, Point3<f64>)>,
    /// Their standard deviation as the user states it, object units; 0 where they are taken as exact.
    pub points_sigma: f64,
    /// Image points.
    pub images: Vec<TaskImage>,
    /// An interior orientation to start from.
    pub start: Option<Start>,
    /// Pixels at which rays and uncertainties are asked for.
    pub grid: Vec<PixelPoint>,
    /// How long it may take, s.
    pub seconds: f64,
}

/// What was measured in an image.
#[derive(Clone, Debug, PartialEq)]
pub struct TaskImage {
    /// Its name.
    pub name: String,
    /// Places in [`Task::points`], and image points, px.
    pub points: Vec<(usize, PixelPoint)>,
}

/// A start: a camera without distortion, px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Focal length.
    pub f: f64,
    /// Principal point.
    pub centre: PixelPoint,
}

impl Task {
    /// The line that a program is asked with as its question `number`.
    pub fn request(&self, number: u64) -> Vec<u8> {
        let points = |image: &TaskImage| image.points.iter().map(|(place, at)| json!([place, at.x, at.y])).collect::<Value>();
        let line = json!({
            "task": number,
            "model": self.model,
            "size": [self.size.width, self.size.height],
            "sigma_px": self.sigma_px,
            "unit": self.unit,
            "board": self.board,
            "points": self.points.iter().map(|(name, at)| json!([name, at.x, at.y, at.z])).collect::<Value>(),
            "points_sigma": self.points_sigma,
            "images": self.images.iter().map(|image| json!({ "name": image.name, "points": points(image) })).collect::<Value>(),
            "start": self.start.map(|start| json!({ "f": start.f, "cx": start.centre.x, "cy": start.centre.y })),
            "grid": self.grid.iter().map(|at| json!([at.x, at.y])).collect::<Value>(),
            "threads": 1,
            "seconds": self.seconds,
        });
        let mut line = line.to_string().into_bytes();
        line.push(b'\n');
        line
    }
}
