//! `calibench measure --eccentricity`: positions of discs' centres from the centres of their pictures.

use std::path::PathBuf;

use calibench_calibrate::orientation::poses_of;
use calibench_calibrate::{Discs, Offset, Survey, offsets};
use calibench_exchange::{Outcome, read_control, read_stations};
use calibench_model::camera::ImageSize;
use calibench_model::{PixelPoint, Points};
use clap::Args;

use crate::camera_files::{CameraFiles, ImagesFile};
use crate::failure::Failure;
use crate::reading;

#[derive(Args)]
pub struct Eccentricity {
    /// Take the eccentricity of discs out where cameras, poses and discs are known (`calibrate --eccentricity` needs none of them): the discs' radius in object units, or `control` where the control file has the column radius. Planes are the control file's nX,nY,nZ, or those of each disc's neighbours
    #[arg(long = "eccentricity", id = "eccentricity", value_name = "RADIUS", requires_all = ["camera", "stations", "control"])]
    discs: Option<Discs>,
    /// For --eccentricity: a camera file; of several cameras IMAGES=FILE, as in left*=left.yaml, may be repeated
    #[arg(long, value_name = "[IMAGES=]FILE", requires = "eccentricity")]
    camera: Vec<ImagesFile>,
    /// For --eccentricity: size of the images, for camera files that do not state it
    #[arg(long, value_name = "WxH", value_parser = reading::size, requires = "eccentricity")]
    size: Option<ImageSize>,
    /// For --eccentricity: the camera of a file took the photographs, too, if they have the same aspect and another size: it is taken as it is in theirs
    #[arg(long, requires = "eccentricity")]
    same_camera: bool,
    /// For --eccentricity: exterior orientations, CSV with image,X0,Y0,Z0,omega_deg,phi_deg,kappa_deg
    #[arg(long, value_name = "CSV", requires = "eccentricity")]
    stations: Option<PathBuf>,
    /// For --eccentricity: control points, CSV with target,X,Y,Z, and of discs radius and nX,nY,nZ
    #[arg(long, value_name = "CSV", requires = "eccentricity")]
    control: Option<PathBuf>,
}

impl Eccentricity {
    /// The files that are read.
    pub fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        self.stations.iter().chain(&self.control).chain(self.camera.iter().map(ImagesFile::path))
    }

    /// Of each point; none where it was not asked for. `size` is that of an image's photograph, `None` of one that was not given.
    pub fn offsets(&self, points: &Points, size: impl Fn(&str) -> Option<ImageSize>) -> Result<Vec<Offset>, Failure> {
        let (Some(discs), Some(stations), Some(control)) = (self.discs, &self.stations, &self.control) else {
            return Ok(Vec::new());
        };
        let survey = Survey::new(points.clone(), &read_control(control)?)?;
        let cameras = CameraFiles::new(self.camera.clone(), self.size, self.same_camera).of_images(&survey.images, size)?;
        let poses = poses_of(&survey, &read_stations(stations)?)?;
        Ok(offsets(&survey, &cameras, &poses, discs)?)
    }
}

/// What was measured, less an offset.
pub fn less(outcome: Outcome, offset: Offset) -> Outcome {
    match (outcome, offset) {
        (Outcome::Measured(mut found), Offset::Of([x, y])) => {
            found.position = PixelPoint::new(found.position.x - x, found.position.y - y);
            Outcome::Measured(found)
        }
        (Outcome::Measured(_), Offset::Unknown(why)) => Outcome::Unavailable(why.to_owned()),
        (other, _) => other,
    }
}
