//! What is known of a camera, what is wanted, and which images are its own.

use calibench_model::camera::{Camera, ImageSize};
use calibench_model::views::photo_of;
use glob::Pattern;

use super::{CalibrationError, OwnParameter, Prior};

/// The name of a camera that is the only one.
const ALONE: &str = "the camera";

/// One camera: what is known of it, and what is wanted.
#[derive(Clone, Debug)]
pub struct Optics {
    /// Its name in messages and tables.
    pub name: String,
    /// The names of its images, each with `*` for any text and `?` for one character; an image belongs to the first camera that claims it. Empty: it claims all.
    pub images: Vec<Pattern>,
    /// Size of its images.
    pub size: ImageSize,
    /// Pixel pitch, um, for models in mm.
    pub pitch_um: Option<f64>,
    /// The camera model, one of [`super::MODELS`]; `None` for photogrammetric with a pitch and OpenCV's five coefficients without.
    pub model: Option<String>,
    /// The parameters to be solved for; `None` for those that the model usually needs.
    pub solve: Option<Vec<String>>,
    /// Parameters that were observed; they are unknowns, solved for or not.
    pub priors: Vec<Prior>,
    /// What each of its images has for itself.
    pub per_image: Vec<OwnParameter>,
    /// An interior orientation to start from; parameters that are not solved for keep its values.
    pub start: Option<Camera>,
}

impl Optics {
    /// The only camera, of which nothing but the size of its images is known.
    pub fn new(size: ImageSize) -> Self {
        Self {
            name: ALONE.into(),
            images: Vec::new(),
            size,
            pitch_um: None,
            model: None,
            solve: None,
            priors: Vec::new(),
            per_image: Vec::new(),
            start: None,
        }
    }

    /// Whether it claims an image, by its name.
    pub fn claims(&self, image: &str) -> bool {
        let matches = |name: &str| self.images.iter().any(|pattern| pattern.matches(name));
        self.images.is_empty() || matches(image) || photo_of(image).is_some_and(matches)
    }
}

/// The camera of each image.
///
/// # Errors
/// [`CalibrationError::WhoseImage`] for an image that none claims, [`CalibrationError::NoImage`] for a camera without one.
pub(super) fn owners(cameras: &[Optics], images: &[String]) -> Result<Vec<usize>, CalibrationError> {
    let owner = |image: &String| {
        let found = cameras.iter().position(|camera| camera.claims(image));
        found.ok_or_else(|| CalibrationError::WhoseImage { image: image.clone(), cameras: names(cameras) })
    };
    let owners = images.iter().map(owner).collect::<Result<Vec<_>, _>>()?;
    match (0..cameras.len()).find(|camera| !owners.contains(camera)) {
        None => Ok(owners),
        Some(idle) => {
            let first = images.first().cloned().unwrap_or_default();
            Err(CalibrationError::NoImage { camera: cameras[idle].name.clone(), first })
        }
    }
}

fn names(cameras: &[Optics]) -> String {
    let one = |camera: &Optics| {
        let patterns: Vec<&str> = camera.images.iter().map(Pattern::as_str).collect();
        format!("{} ({})", camera.name, patterns.join(","))
    };
    cameras.iter().map(one).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(name: &str, images: &[&str]) -> Optics {
        let images = images.iter().map(|text| Pattern::new(text).unwrap()).collect();
        Optics { name: name.into(), images, ..Optics::new(ImageSize { width: 640, height: 480 }) }
    }

    #[test]
    fn an_image_belongs_to_the_first_camera_that_claims_it() {
        let cameras = [camera("left", &["left*", "rig/l?.png"]), camera("rest", &["*"])];
        let images = ["left1.png", "right1.png", "rig/l4.png", "rig/l44.png"].map(str::to_owned);
        assert_eq!(owners(&cameras, &images), Ok(vec![0, 1, 0, 1]));
        let other = owners(&cameras[..1], &images).unwrap_err().to_string();
        assert!(other.contains("`right1.png`") && other.contains("left (left*,rig/l?.png)"), "{other}");
        let idle = owners(&cameras, &images[..1]).unwrap_err().to_string();
        assert!(idle.contains("`rest`") && idle.contains("left1.png"), "{idle}");
        assert_eq!(owners(&[camera("alone", &[])], &images), Ok(vec![0; 4]));
    }
}
