//! Known cameras of some images.

use std::path::PathBuf;
use std::str::FromStr;

use calibench_cameras::ReadOptions;
use calibench_model::camera::{Camera, CameraModel, ImageSize};
use calibench_model::{NamedCamera, PixelPoint};
use calibench_undistort::View;
use clap::Args;
use glob::Pattern;

use crate::failure::Failure;
use crate::inputs::first;
use crate::same_camera::for_images;

#[derive(Args)]
pub struct CameraFiles {
    /// A camera file of any known format; of several cameras IMAGES=FILE, as in left*=left.yaml (* is any text), may be repeated: the first that names an image is its camera
    #[arg(long = "camera", value_name = "[IMAGES=]FILE", required = true)]
    files: Vec<ImagesFile>,
    /// Size of the images in which the points were measured, for camera files that do not state it or are of another size
    #[arg(long, value_name = "WxH", value_parser = super::reading::size)]
    size: Option<ImageSize>,
    /// The camera of a file took the images of --size, too, if they have the same aspect and another size: it is taken as it is in theirs
    #[arg(long, requires = "size")]
    same_camera: bool,
}

/// Says how many of the points that cameras took lie in no pixel of their images, and returns whether any does: then the images may be of another size.
pub fn say_outside<'c>(points: impl Iterator<Item = (&'c Camera, PixelPoint)>) -> bool {
    let count = points.filter(|(camera, at)| !View::Camera(**camera).holds(*at)).count();
    if count > 0 {
        say!(
            "in doubt: {count} points lie outside the images: is the camera's size that of the images (--size says theirs), and are x and y right?"
        );
    }
    count > 0
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
    /// Those of a command that need not know any camera. `size` is that of the images of files that do not state it; `same_camera` says that the cameras took images of
    /// another size, too.
    pub fn new(files: Vec<ImagesFile>, size: Option<ImageSize>, same_camera: bool) -> Self {
        Self { files, size, same_camera }
    }

    /// The files.
    pub fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        self.files.iter().map(ImagesFile::path)
    }

    /// The camera of each image, all of which have the size that the user states, if one is stated.
    pub fn of(&self, images: &[String]) -> Result<Vec<Camera>, Failure> {
        self.each(images, true, |_| self.size)
    }

    /// The camera of each image, whose size is known of some; a size that the user states is that of the cameras.
    pub fn of_images(&self, images: &[String], size: impl Fn(&str) -> Option<ImageSize>) -> Result<Vec<Camera>, Failure> {
        self.each(images, self.size.is_none(), size)
    }

    fn each(&self, images: &[String], other_size: bool, size: impl Fn(&str) -> Option<ImageSize>) -> Result<Vec<Camera>, Failure> {
        let mut read: Vec<Option<NamedCamera>> = vec![None; self.files.len()];
        let mut made: Vec<(usize, Camera)> = Vec::new();
        let mut cameras = Vec::with_capacity(images.len());
        for image in images {
            let (place, size) = (self.place(image)?, size(image));
            let file = &self.files[place].file;
            if read[place].is_none() {
                // A file without a size is of the first of its images: those of another size are others'.
                let options = ReadOptions { size: self.size.or(size), other_size, ..ReadOptions::default() };
                read[place] = Some(first(file, &options)?);
            }
            let Some(named) = &read[place] else { continue };
            let wanted = size.unwrap_or_else(|| named.camera.size());
            let known = made.iter().find(|(of, camera)| *of == place && camera.size() == wanted).map(|(_, camera)| *camera);
            let camera = known.map_or_else(|| for_images(file, named, wanted, self.same_camera).map(|named| named.camera), Ok)?;
            if known.is_none() {
                made.push((place, camera));
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
