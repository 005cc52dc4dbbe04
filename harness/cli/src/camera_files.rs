//! Known cameras of some images.

use std::path::PathBuf;
use std::str::FromStr;

use calibench_model::camera::{Camera, ImageSize};
use clap::Args;
use glob::Pattern;

use crate::failure::Failure;
use crate::inputs::camera;

#[derive(Args)]
pub struct CameraFiles {
    /// A camera file of any known format; of several cameras IMAGES=FILE, as in left*=left.yaml (* is any text), may be repeated: the first that names an image is its camera
    #[arg(long = "camera", value_name = "[IMAGES=]FILE", required = true)]
    files: Vec<ImagesFile>,
    /// Size of the images, for camera files that do not state it
    #[arg(long, value_name = "WxH", value_parser = super::reading::size)]
    size: Option<ImageSize>,
}

/// A camera file, and the images that it is for.
#[derive(Clone, Debug)]
pub struct ImagesFile {
    images: Pattern,
    file: PathBuf,
}

impl ImagesFile {
    /// The camera file.
    pub fn path(&self) -> &PathBuf {
        &self.file
    }
}

impl FromStr for ImagesFile {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            // A file may have = in its name.
            Some((images, file)) if !PathBuf::from(text).exists() => {
                let images = Pattern::new(images).map_err(|error| format!("`{images}` names no images: {error}"))?;
                Ok(Self { images, file: file.into() })
            }
            _ => Ok(Self { images: Pattern::new("*").map_err(|error| error.to_string())?, file: text.into() }),
        }
    }
}

impl CameraFiles {
    /// Those of a command that need not know any camera.
    pub fn new(files: Vec<ImagesFile>, size: Option<ImageSize>) -> Self {
        Self { files, size }
    }

    /// The files.
    pub fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        self.files.iter().map(ImagesFile::path)
    }

    /// The camera of each image.
    pub fn of(&self, images: &[String]) -> Result<Vec<Camera>, Failure> {
        let cameras = self.files.iter().map(|given| camera(&given.file, self.size)).collect::<Result<Vec<_>, _>>()?;
        let of = |image: &String| {
            let place = self.files.iter().position(|given| given.images.matches(image));
            place.map(|place| cameras[place]).ok_or_else(|| {
                let patterns: Vec<&str> = self.files.iter().map(|given| given.images.as_str()).collect();
                Failure::input(format!("--camera: none is for image `{image}`: there are {}", patterns.join(", ")))
            })
        };
        images.iter().map(of).collect()
    }
}
