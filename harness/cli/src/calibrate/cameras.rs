//! The cameras of a calibration: which images each took, and what is known and wanted of it.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use calibench_calibrate::{Optics, OwnParameter, Prior};
use calibench_model::NamedCamera;
use calibench_model::camera::{Camera, ImageSize};
use calibench_photographs::Photo;
use clap::Args;
use glob::Pattern;

use super::super::convert::positive;
use super::super::photos::one_size;
use super::super::reading;
use crate::failure::Failure;
use crate::same_camera::for_images;

#[derive(Args)]
pub struct Cameras {
    /// One of several cameras and its images, as in left=left*.png,l?.jpg (* is any text, ? one character); may be repeated. An image belongs to the first that claims it
    #[arg(long = "camera", value_name = "NAME=IMAGES")]
    claims: Vec<Claim>,
    /// Size of the images, px. Here and in what follows, CAMERA= before a value says which of several cameras it is for; may be repeated
    #[arg(long, value_name = "[CAMERA=]WxH", value_parser = |text: &str| For::parse(text, reading::size),
          required_unless_present_any = ["photos", "reconstruction"], conflicts_with = "photos")]
    size: Vec<For<ImageSize>>,
    /// Pixel pitch, um, for models in mm
    #[arg(long, value_name = "[CAMERA=]UM", value_parser = |text: &str| For::parse(text, positive), allow_hyphen_values = true)]
    pitch: Vec<For<f64>>,
    /// Camera model: photogrammetric, opencv5, metashape and others, or mrcal's splines, as in splined:30x20:170:3 (columns and rows of control points, horizontal field of view in degrees, order 2 or 3) [default: photogrammetric with --pitch, or else opencv5]
    #[arg(long, value_name = "[CAMERA=]MODEL", value_parser = |text: &str| For::parse(text, model))]
    model: Vec<For<String>>,
    /// Parameters to solve for, as in c,x0,y0,k1, or none; the others keep their start values [default: what the model usually needs]
    #[arg(long, value_name = "[CAMERA=]NAMES", value_parser = |text: &str| For::parse(text, names))]
    solve: Vec<For<Vec<String>>>,
    /// An observed parameter and its standard deviation, in the parameter's unit, as in k1=-3e-4:1e-5; may be repeated
    #[arg(long = "prior", value_name = "[CAMERA.]NAME=VALUE:SIGMA", allow_hyphen_values = true)]
    priors: Vec<Prior>,
    /// What each image has for itself beside what all share, as in c,x0,y0 (a lens that focuses anew): NAME:SIGMA states how far it scatters, in the parameter's unit, NAME lets the images tell
    #[arg(long, value_name = "[CAMERA=]NAMES", value_parser = |text: &str| For::parse(text, own_parameters))]
    per_image: Vec<For<Vec<OwnParameter>>>,
    /// A camera file to start from, and whose values the parameters keep that are not solved for
    #[arg(long, value_name = "[CAMERA=]FILE", value_parser = |text: &str| For::parse(text, word))]
    start: Vec<For<String>>,
    /// The camera of --start took the images, too, if they have the same aspect and another size: it is taken as it is in theirs
    #[arg(long, requires = "start")]
    same_camera: bool,
}

/// A value for one camera, or for all that have none of their own.
#[derive(Clone, Debug, PartialEq)]
struct For<T> {
    camera: Option<String>,
    value: T,
}

impl<T> For<T> {
    fn parse(text: &str, value: impl Fn(&str) -> Result<T, String>) -> Result<Self, String> {
        match text.split_once('=') {
            Some((camera, rest)) => Ok(Self { camera: Some(camera.to_owned()), value: value(rest)? }),
            None => Ok(Self { camera: None, value: value(text)? }),
        }
    }
}

#[expect(clippy::unnecessary_wraps, reason = "as the other parsers")]
fn word(text: &str) -> Result<String, String> {
    Ok(text.to_owned())
}

/// A model's name without a board: `judge` names both in one word.
fn model(text: &str) -> Result<String, String> {
    match text.strip_suffix("+bent") {
        Some(lens) => Err(format!("the board is no part of the model here: expected --model {lens} and --board-shape bent")),
        None => Ok(text.to_owned()),
    }
}

fn names(text: &str) -> Result<Vec<String>, String> {
    if text == "none" {
        return Ok(Vec::new());
    }
    let names: Vec<String> = text.split(',').map(|name| name.trim().to_owned()).collect();
    if names.iter().any(String::is_empty) { Err("expected names of parameters, as in c,x0,y0,k1".into()) } else { Ok(names) }
}

fn own_parameters(text: &str) -> Result<Vec<OwnParameter>, String> {
    text.split(',').map(|name| name.parse().map_err(|error: calibench_calibrate::NoOwnParameter| error.to_string())).collect()
}

/// A camera and the patterns of its images' names.
#[derive(Clone, Debug)]
struct Claim {
    name: String,
    images: Vec<Pattern>,
}

impl FromStr for Claim {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("`{text}` is no camera: expected its name and the names of its images, as in left=left*.png");
        let (name, images) = text.split_once('=').ok_or_else(wrong)?;
        // It becomes a part of file names.
        let sane = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_');
        if name.is_empty() || !name.chars().all(sane) {
            return Err(format!("`{name}` is no name of a camera: expected letters, digits, - and _"));
        }
        let pattern = |text: &str| Pattern::new(text.trim()).map_err(|error| format!("`{text}` names no images: {error}"));
        let images = images.split(',').map(pattern).collect::<Result<Vec<_>, _>>()?;
        if images.iter().any(|pattern| pattern.as_str().is_empty()) { Err(wrong()) } else { Ok(Self { name: name.to_owned(), images }) }
    }
}

impl Cameras {
    /// The camera files to start from.
    pub fn starts(&self) -> impl Iterator<Item = PathBuf> {
        self.start.iter().map(|start| PathBuf::from(&start.value))
    }

    /// The size of the images of all cameras together.
    pub fn common_size(&self) -> Option<ImageSize> {
        self.size.iter().find(|size| size.camera.is_none()).map(|size| size.value)
    }

    /// The parameters that all cameras together are solved for.
    pub fn common_solve(&self) -> Option<Vec<String>> {
        self.solve.iter().find(|solve| solve.camera.is_none()).map(|solve| solve.value.clone())
    }

    /// The models that are named, of whichever camera.
    pub fn models(&self) -> impl Iterator<Item = &str> {
        self.model.iter().map(|model| model.value.as_str())
    }

    /// Whether images have something for themselves.
    pub const fn has_per_image(&self) -> bool {
        !self.per_image.is_empty()
    }

    /// Whether parameters were observed.
    pub const fn has_priors(&self) -> bool {
        !self.priors.is_empty()
    }

    /// A camera of a file for images of `size`, of another size where the user says that it is the same camera.
    pub fn for_images(&self, path: &Path, named: &NamedCamera, size: ImageSize) -> Result<Camera, Failure> {
        Ok(for_images(path, named, size, self.same_camera)?.camera)
    }

    /// Whether several cameras are told apart.
    pub const fn are_several(&self) -> bool {
        !self.claims.is_empty()
    }

    /// The pixel pitch of a camera, um.
    pub fn pitch_um(&self, camera: &str) -> Option<f64> {
        of(&self.pitch, camera).copied()
    }

    /// All cameras. Of photographs the sizes are known; of points somebody has to say them.
    pub fn optics(&self, photos: &[Photo]) -> Result<Vec<Optics>, Failure> {
        self.optics_of(&self.claims, photos, true)
    }

    /// The cameras called `names`, in this order; their images are those that `patterns` name, where these are given, or else their own.
    pub fn of_rig(&self, names: &[String], patterns: Option<Vec<Pattern>>, photos: &[Photo]) -> Result<Vec<Optics>, Failure> {
        let claims = match patterns {
            Some(patterns) if self.claims.is_empty() => {
                names.iter().zip(patterns).map(|(name, pattern)| Claim { name: name.clone(), images: vec![pattern] }).collect()
            }
            _ => self.claims.clone(),
        };
        let known: Vec<&str> = claims.iter().map(|claim| claim.name.as_str()).collect();
        if let Some(stranger) = names.iter().find(|name| !known.contains(&name.as_str())) {
            return Err(no_such("rig", stranger, &known));
        }
        let ordered: Vec<Claim> = names.iter().filter_map(|name| claims.iter().find(|claim| claim.name == *name).cloned()).collect();
        // A file for all of them may hold them all.
        self.optics_of(&ordered, photos, self.common_start().is_none())
    }

    /// A camera file for all cameras together.
    pub fn common_start(&self) -> Option<&str> {
        self.start.iter().find(|start| start.camera.is_none()).map(|start| start.value.as_str())
    }

    fn optics_of(&self, claims: &[Claim], photos: &[Photo], starts: bool) -> Result<Vec<Optics>, Failure> {
        self.check(claims)?;
        let bare = |claim: &Claim| Optics {
            name: claim.name.clone(),
            images: claim.images.clone(),
            ..Optics::new(ImageSize { width: 1, height: 1 })
        };
        let mut cameras: Vec<Optics> = claims.iter().map(bare).collect();
        if cameras.is_empty() {
            cameras.push(Optics::new(ImageSize { width: 1, height: 1 }));
        }
        let owner = |image: &str| cameras.iter().position(|camera| camera.claims(image));
        let owners: Vec<Option<usize>> = photos.iter().map(|(image, ..)| owner(image)).collect();
        for (index, camera) in cameras.iter_mut().enumerate() {
            let own = photos.iter().zip(&owners).filter(|(_, owner)| **owner == Some(index)).map(|((_, path, size), _)| (path, *size));
            camera.size = match (photos.is_empty(), of(&self.size, &camera.name)) {
                (true, Some(size)) => *size,
                (true, None) => {
                    return Err(Failure::input(format!(
                        "--size: expected the size of the images of {0}, as in {0}=4272x2848",
                        camera.name
                    )));
                }
                (false, _) if owners.contains(&Some(index)) => one_size(own)?,
                (false, _) => return Err(Failure::input(format!("--camera {}: no photograph is claimed by it", camera.name))),
            };
            camera.pitch_um = self.pitch_um(&camera.name);
            camera.model = of(&self.model, &camera.name).cloned();
            camera.solve = of(&self.solve, &camera.name).cloned();
            camera.priors = self.priors(&camera.name);
            camera.per_image = of(&self.per_image, &camera.name).cloned().unwrap_or_default();
            camera.start = self
                .start(&camera.name)
                .filter(|_| starts)
                .map(|path| crate::inputs::camera_for(path.as_ref(), Some(camera.size), self.same_camera))
                .transpose()?;
        }
        Ok(cameras)
    }

    fn start(&self, name: &str) -> Option<String> {
        // Where there is one camera alone, a file may have = in its name.
        match self.start.first() {
            Some(For { camera: Some(before), value }) if self.claims.is_empty() => Some(format!("{before}={value}")),
            _ => of(&self.start, name).cloned(),
        }
    }

    /// What was observed of a camera: by its name before a dot, or of all.
    fn priors(&self, camera: &str) -> Vec<Prior> {
        let own = |prior: &Prior| match prior.parameter.rsplit_once('.') {
            Some((name, parameter)) => (name == camera).then(|| Prior { parameter: parameter.to_owned(), ..prior.clone() }),
            None => Some(prior.clone()),
        };
        self.priors.iter().filter_map(own).collect()
    }

    /// Cameras that there are, each once.
    fn check(&self, claims: &[Claim]) -> Result<(), Failure> {
        let known: Vec<&str> = claims.iter().map(|claim| claim.name.as_str()).collect();
        if let Some(twice) = known.iter().enumerate().find(|(i, name)| known[..*i].contains(name)) {
            return Err(Failure::input(format!("--camera {}: given twice; expected all its patterns in one, with commas", twice.1)));
        }
        let alone = claims.is_empty();
        let start = if alone { vec![None; self.start.len()] } else { given(&self.start) };
        for (flag, given) in [
            ("size", given(&self.size)),
            ("pitch", given(&self.pitch)),
            ("model", given(&self.model)),
            ("solve", given(&self.solve)),
            ("per-image", given(&self.per_image)),
            ("start", start),
        ] {
            let stranger = given.iter().flatten().find(|name| !known.contains(name));
            stranger.map_or(Ok(()), |name| Err(no_such(flag, name, &known)))?;
            let twice = given.iter().enumerate().find(|(i, name)| given[..*i].contains(name));
            if let Some((_, name)) = twice {
                let whose = name.map_or_else(String::new, |name| format!(" for {name}"));
                return Err(Failure::input(format!("--{flag}: given twice{whose}; expected one value")));
            }
        }
        let of_priors = self.priors.iter().filter_map(|prior| prior.parameter.rsplit_once('.')).find(|(name, _)| !known.contains(name));
        of_priors.map_or(Ok(()), |(name, _)| Err(no_such("prior", name, &known)))
    }
}

fn no_such(flag: &str, name: &str, known: &[&str]) -> Failure {
    let known = if known.is_empty() { "none is given with --camera".to_owned() } else { format!("there are {}", known.join(", ")) };
    Failure::input(format!("--{flag}: no camera is called `{name}`: {known}"))
}

/// Whom the values are for.
fn given<T>(values: &[For<T>]) -> Vec<Option<&str>> {
    values.iter().map(|value| value.camera.as_deref()).collect()
}

/// What was given for a camera, or else for all.
fn of<'v, T>(given: &'v [For<T>], camera: &str) -> Option<&'v T> {
    let own = given.iter().find(|value| value.camera.as_deref() == Some(camera));
    own.or_else(|| given.iter().find(|value| value.camera.is_none())).map(|value| &value.value)
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use clap::Parser;

    use super::*;

    #[derive(Parser)]
    struct Line {
        #[arg(id = "photos")]
        photos: Vec<PathBuf>,
        #[command(flatten)]
        cameras: Cameras,
    }

    fn optics(arguments: &[&str], photos: &[Photo]) -> Result<Vec<Optics>, String> {
        let line = [&["calibrate"], arguments].concat();
        let line = Line::try_parse_from(line).map_err(|error| error.to_string())?;
        line.cameras.optics(photos).map_err(|failure| match failure {
            Failure::Input(text) | Failure::Picture(text) => text,
            Failure::Gate | Failure::Doubt => "gate".into(),
        })
    }

    #[test]
    fn values_are_for_one_camera_or_for_all() {
        let found = optics(
            &[
                "--camera",
                "left=l*,m*",
                "--camera",
                "right=r*",
                "--size",
                "640x480",
                "--size",
                "right=800x600",
                "--model",
                "left=opencv4",
                "--solve",
                "c,x0",
                "--solve",
                "right=fx, k1",
                "--pitch",
                "left=3.5",
                "--prior",
                "right.k1=-0.1:0.01",
                "--prior",
                "k2=0:1",
            ],
            &[],
        );
        let found = found.unwrap();
        assert_eq!(found.iter().map(|camera| camera.size.width).collect::<Vec<_>>(), [640, 800]);
        assert_eq!(found[0].model.as_deref(), Some("opencv4"));
        assert_eq!((found[1].model.as_ref(), found[0].pitch_um, found[1].pitch_um), (None, Some(3.5), None));
        assert_eq!(found[0].solve.as_deref(), Some(&["c".to_owned(), "x0".to_owned()][..]));
        assert_eq!(found[1].solve.as_deref(), Some(&["fx".to_owned(), "k1".to_owned()][..]));
        let priors = |camera: &Optics| camera.priors.iter().map(|prior| prior.parameter.clone()).collect::<Vec<_>>();
        assert_eq!((priors(&found[0]), priors(&found[1])), (vec!["k2".to_owned()], vec!["k1".to_owned(), "k2".to_owned()]));
        assert!(found[0].claims("m1.png") && !found[0].claims("r1.png"));
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let wrong: [(&[&str], &str); 10] = [
            (&["--size", "640x480", "--model", "left=opencv5"], "--model: no camera is called `left`: none is given"),
            (&["--camera", "left=*", "--size", "right=640x480"], "--size: no camera is called `right`: there are left"),
            (&["--camera", "left=*", "--size", "640x480", "--prior", "right.k1=0:1"], "--prior: no camera is called `right`"),
            (&["--camera", "left=l*", "--camera", "right=*", "--size", "left=640x480"], "right=4272x2848"),
            (&["--camera", "left=*", "--camera", "left=r*", "--size", "640x480"], "--camera left: given twice"),
            (&["--size", "640x480", "--size", "640x480"], "--size: given twice; expected one value"),
            (&["--camera", "a/b=*", "--size", "640x480"], "`a/b` is no name of a camera"),
            (&["--camera", "left", "--size", "640x480"], "`left` is no camera"),
            (&["--size", "640x480", "--model", "left=opencv5+bent"], "expected --model opencv5 and --board-shape bent"),
            (&["--camera", "left=[", "--size", "640x480"], "`[` names no images"),
        ];
        for (arguments, expected) in wrong {
            let error = optics(arguments, &[]).unwrap_err();
            assert!(error.contains(expected), "{arguments:?}: {error}");
        }
    }

    #[test]
    fn photographs_say_how_large_they_are_camera_by_camera() {
        let photo = |name: &str, width| (name.to_owned(), PathBuf::from(name), ImageSize { width, height: 480 });
        let photos = [photo("l1.png", 640), photo("r1.png", 800), photo("l2.png", 640)];
        let found = optics(&["l1.png", "--camera", "left=l*", "--camera", "right=r*"], &photos).unwrap();
        assert_eq!(found.iter().map(|camera| camera.size.width).collect::<Vec<_>>(), [640, 800]);
        assert!(optics(&["l1.png"], &photos).unwrap_err().contains("--camera"));
        assert!(optics(&["l1.png", "--camera", "left=*", "--camera", "right=r*"], &photos).is_err());
    }
}
