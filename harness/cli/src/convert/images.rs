//! `convert --crop`, `--size`, `--scale`, `--binned`, `--turn`: the same camera in other images.

use calibench_cameras::CameraFormat;
use calibench_cameras::for_file::kept_format;
use calibench_model::NamedCamera;
use calibench_model::camera::{CameraModel, ImageSize, Turn};
use calibench_model::reframing::{Crop, FrameChange, Reframing, Scaling};
use clap::Args;

use super::{Convert, positive};
use crate::failure::Failure;

/// What becomes of the images, beside `--size`.
#[derive(Args)]
pub struct OtherImages {
    /// The same camera in a part of its images, as a video mode cuts it out: from column X and row Y on, counted from 0, W columns and H rows; done before the others
    #[arg(long, value_name = "X,Y,W,H", value_parser = crop)]
    crop: Option<Crop>,
    /// The same camera in images F times as large; sides are rounded, and the factor stays
    #[arg(long, value_name = "F", value_parser = positive, allow_negative_numbers = true, conflicts_with = "binned")]
    scale: Option<f64>,
    /// The same camera in images of which N x N pixels make one; what is left over on the right and below is cut off
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    binned: Option<u32>,
    /// The same camera in images that are turned clockwise, its axes with them; between landscape and portrait by 90 or 270, as it was held. Done after the others
    #[arg(long, value_name = "90|180|270", value_parser = turn)]
    turn: Option<Turn>,
}

/// A camera in other images.
pub struct InOtherImages {
    pub camera: NamedCamera,
    pub by: Reframing,
    /// What of it was dropped.
    pub dropped: Vec<String>,
}

impl Convert {
    /// A camera in the images that were asked for; `None` where they are its own.
    pub(super) fn in_other_images(&self, source: &NamedCamera) -> Result<Option<InOtherImages>, Failure> {
        let OtherImages { crop, scale, binned, turn } = self.images;
        let own = source.camera.size();
        // Of a file that states no size it is that of its images.
        let is_new = |size: &ImageSize| *size != own || (crop.is_some() && self.reading.states_size(self.file()));
        let size = self.reading.size().filter(is_new).map(Scaling::Size);
        let others = scale.map(Scaling::Times).or(binned.map(Scaling::Binned));
        if size.is_some() && others.is_some() {
            let stated = format!("the file states {} x {} px", own.width, own.height);
            return Err(Failure::input(format!(
                "--size: {stated}, and other images have one size: expected one of --size, --scale, --binned"
            )));
        }
        let change = FrameChange { crop, scaling: size.or(others), turn };
        let by = change.of(own).map_err(|error| Failure::input(format!("{}: {error}", self.flags(&change))))?;
        if by.is_none() {
            return Ok(None);
        }
        let (camera, dropped) = by.named(source).map_err(|error| Failure::input(format!("{}: {error}", self.flags(&change))))?;
        Ok(Some(InOtherImages { camera, by, dropped }))
    }

    /// The format of a file that is to hold a camera as it is, read from one of the format `read`.
    pub(super) fn kept_format(
        &self,
        read: &'static CameraFormat,
        camera: &NamedCamera,
        by: Option<Reframing>,
    ) -> Result<&'static CameraFormat, Failure> {
        let Some(by) = by else {
            let size = camera.camera.size();
            return Err(Failure::input(format!(
                "--to: expected, as the images stay what they are, {} x {} px; `calibench list conventions` lists what to convert to",
                size.width, size.height
            )));
        };
        kept_format(self.output.as_deref(), read, camera).ok_or_else(|| {
            let why = if read.is_written() { "does not hold the camera in these images" } else { "is only read" };
            Failure::input(format!("{} {why} ({by}); expected --to, which names the convention of the new file", read.name))
        })
    }

    /// The flags of a change, for messages.
    fn flags(&self, change: &FrameChange) -> String {
        let given = [
            (change.crop.is_some(), "--crop"),
            (matches!(change.scaling, Some(Scaling::Size(_))), "--size"),
            (self.images.scale.is_some(), "--scale"),
            (self.images.binned.is_some(), "--binned"),
            (change.turn.is_some(), "--turn"),
        ];
        given.iter().filter(|(is, _)| *is).map(|(_, flag)| *flag).collect::<Vec<_>>().join(", ")
    }
}

fn crop(text: &str) -> Result<Crop, String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y, width, height]) if width > 0 && height > 0 => Ok(Crop { x, y, size: ImageSize { width, height } }),
        _ => Err("expected the first column and row, counted from 0, and columns and rows, in whole pixels, as in 0,150,1600,900".into()),
    }
}

fn turn(text: &str) -> Result<Turn, String> {
    let known = Turn::ALL.into_iter().find(|turn| text.parse() == Ok(turn.degrees()));
    known.ok_or_else(|| "expected 90, 180 or 270: degrees, clockwise".into())
}
