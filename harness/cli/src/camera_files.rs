//! Known cameras of some images.

use std::path::PathBuf;
use std::str::FromStr;

use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, ImageSize};
use clap::Args;
use glob::Pattern;

use crate::failure::Failure;
use crate::inputs::{camera, camera_for};
use crate::same_camera::for_images;

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
        images.iter().map(|image| Ok(cameras[self.place(image)?])).collect()
    }

    /// The camera of each image, whose size is known of some: of another size where `is_same` says that it is the same camera.
    pub fn of_images(&self, images: &[String], is_same: bool, size: impl Fn(&str) -> Option<ImageSize>) -> Result<Vec<Camera>, Failure> {
        let mut made: Vec<((usize, Option<ImageSize>), Camera)> = Vec::new();
        let mut cameras = Vec::with_capacity(images.len());
        for image in images {
            let (place, size) = (self.place(image)?, size(image));
            let known = made.iter().find(|(of, _)| *of == (place, size)).map(|(_, camera)| *camera);
            let file = &self.files[place].file;
            // A size that the user states beside a file is that of its camera.
            let of = || match size {
                Some(size) if self.size.is_none_or(|stated| stated == size) => camera_for(file, size, is_same),
                Some(size) => {
                    let named = NamedCamera::new("", camera(file, self.size)?);
                    Ok(for_images(file, &named, size, is_same)?.camera)
                }
                None => camera(file, self.size),
            };
            let camera = known.map_or_else(of, Ok)?;
            if known.is_none() {
                made.push(((place, size), camera));
            }
            cameras.push(camera);
        }
        Ok(cameras)
    }

    /// The place of the file that is for an image.
    fn place(&self, image: &str) -> Result<usize, Failure> {
        self.files.iter().position(|given| given.images.matches(image)).ok_or_else(|| {
            let patterns: Vec<&str> = self.files.iter().map(|given| given.images.as_str()).collect();
            Failure::input(format!("--camera: none is for image `{image}`: there are {}", patterns.join(", ")))
        })
    }
}
