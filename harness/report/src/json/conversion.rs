//! What became of cameras in another convention, as JSON.

use calibench_model::camera::{Fold, Turn};
use calibench_model::convert::{Conversion, Method, Region, Spread, Verdict};
use calibench_model::reframing::Reframing;
use schemars::JsonSchema;
use serde::Serialize;

use super::{Answer, CameraAnswer, Size, Sizes};

/// Cameras in another convention.
#[derive(Serialize, JsonSchema)]
pub struct ConversionAnswer {
    /// The file that was read, as it was named; several with a comma between them.
    pub file: String,
    /// Name of the format that the cameras are converted to.
    pub to: String,
    /// What of that format's convention is not confirmed by numbers of its tool; null: nothing.
    pub unverified: Option<String>,
    /// Where the camera file or the folder of camera files was written; null: nowhere.
    pub output: Option<String>,
    /// The cameras, in the order of the file.
    pub cameras: Vec<ConvertedCamera>,
}

impl Answer for ConversionAnswer {
    const COMMAND: &'static str = "convert";
    const SCHEMA: u32 = 1;
}

/// A camera in another convention, and how far it is the one that was given.
#[derive(Serialize, JsonSchema)]
pub struct ConvertedCamera {
    /// `exact` (the same camera in other units), `fitted` (by least squares) or `naive` (by formulas that are wrong beyond first order).
    method: &'static str,
    /// `good`, `warning` (residuals above 0.01 px) or `accepted` (above 0.5 px, and taken all the same); of a naive conversion `naive`.
    verdict: &'static str,
    /// The model of the tool that was chosen, where it has several.
    model: Option<String>,
    /// Residuals over the region: where the camera pictures a ray, against where the source does; of a naive conversion after the best rotation.
    residuals: Sizes,
    /// Radius from the image of the axis within which the conversion holds, px; null: the whole frame.
    radius_px: Option<f64>,
    /// Angle by which the camera is rotated against the source, degrees.
    rotation_deg: f64,
    /// Distance from the image of the axis at which the distortion folds over, px; null if it does not within the frame.
    fold_px: Option<f64>,
    /// What of the camera the format has no place for.
    lost: Vec<String>,
    /// The other images that the camera was asked for in; null: its own.
    images: Option<Images>,
    /// The camera.
    camera: CameraAnswer,
}

/// Images that are made of a camera's own.
#[derive(Serialize, JsonSchema)]
struct Images {
    /// Size of its own.
    of: Size,
    /// Columns and rows that are cut off before the first, px.
    offset: [f64; 2],
    /// New pixels for an old one, along rows and along columns.
    scale: [f64; 2],
    /// Then turned clockwise, degrees: 0, 90, 180 or 270.
    turn_deg: u16,
    /// Size of the new ones.
    size: Size,
}

impl ConvertedCamera {
    /// The same in other images.
    #[must_use]
    pub fn in_other_images(self, by: Option<&Reframing>) -> Self {
        let images = |by: &Reframing| Images {
            of: by.resampling.from.into(),
            offset: by.resampling.offset,
            scale: by.resampling.scale,
            turn_deg: by.turn.map_or(0, Turn::degrees),
            size: by.size().into(),
        };
        Self { images: by.map(images), ..self }
    }

    /// Of a conversion.
    pub fn new(conversion: &Conversion, model: Option<String>, fold: Option<Fold>, lost: Vec<String>, camera: CameraAnswer) -> Self {
        Self {
            method: if conversion.method == Method::Exact { "exact" } else { "fitted" },
            verdict: match conversion.verdict {
                Verdict::Good => "good",
                Verdict::Warning => "warning",
                Verdict::Accepted => "accepted",
            },
            model,
            residuals: (&conversion.residual).into(),
            radius_px: match conversion.region {
                Region::Frame => None,
                Region::Radius { px } => Some(px),
            },
            rotation_deg: conversion.rotation.angle().to_degrees(),
            fold_px: fold.map(|fold| fold.radius_px),
            lost,
            images: None,
            camera,
        }
    }

    /// Of a conversion by formulas that are wrong beyond first order, which costs `cost` after the best rotation.
    pub fn naive(cost: &Spread, rotation_deg: f64, fold: Option<Fold>, lost: Vec<String>, camera: CameraAnswer) -> Self {
        let fold_px = fold.map(|fold| fold.radius_px);
        Self {
            method: "naive",
            verdict: "naive",
            model: None,
            residuals: cost.into(),
            radius_px: None,
            rotation_deg,
            fold_px,
            lost,
            images: None,
            camera,
        }
    }
}
