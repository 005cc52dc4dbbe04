//! `calibench undistort`: photographs and points as another camera would have them.

mod photographs;
mod points;
mod views;

use std::path::{Path, PathBuf};

use calibench_cameras::inputs_of;
use calibench_images::picture::{Opened, PictureKind};
use calibench_model::camera::ImageSize;
use calibench_undistort::Kernel;
use clap::{Args, ValueEnum};

use crate::context::Context;
use crate::failure::Failure;
use crate::output;
use crate::photos::with_folders;
use views::Views;

#[derive(Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of the command line")]
pub struct Undistort {
    /// Photographs of one camera, or a folder of them (PNG, JPEG, TIFF, PNM, BMP or WebP, any channels), or one file of points: CSV with image,target,x,y
    #[arg(required = true, value_name = "PHOTO|CSV")]
    files: Vec<PathBuf>,
    /// The camera of the photographs: a file of any known format
    #[arg(long, value_name = "FILE")]
    camera: PathBuf,
    /// Size of the photographs, for camera files that do not state it or, of points, are of another size
    #[arg(long, value_name = "WxH", value_parser = crate::reading::size)]
    size: Option<ImageSize>,
    /// The camera of --camera took what is given, too, if that has the same aspect and another size: it is taken as it is in theirs
    #[arg(long)]
    same_camera: bool,
    /// What the new pictures are as if taken by: `pinhole`, `equirectangular`, or the camera of a file
    #[arg(long, value_name = "VIEW|FILE", default_value = "pinhole")]
    to: String,
    /// What the new pictures hold of the photographs; the camera of a file has its own frame
    #[arg(long, value_enum, default_value = "keep")]
    frame: Frame,
    /// Scale on the axis, as a share of the photographs'
    #[arg(long, value_name = "SHARE", default_value_t = 1.0, value_parser = crate::convert::positive, allow_negative_numbers = true)]
    scale: f64,
    /// How levels between pixels are found; `spline` moves points least, `area` is for pictures that shrink
    #[arg(long, value_name = "KERNEL", default_value = "cubic", value_parser = kernel)]
    kernel: Kernel,
    /// Back again: what is given are pictures of the new camera, what is made has the distortion of --camera
    #[arg(long)]
    redistort: bool,
    /// Kind of the new files [default: that of each photograph]
    #[arg(long = "as", value_enum, value_name = "KIND")]
    kind: Option<Kind>,
    /// Quality of JPEGs
    #[arg(long, value_name = "1-100", default_value_t = 95, value_parser = clap::value_parser!(u8).range(1..=100))]
    quality: u8,
    /// Also mask.png: white where the new pictures show something of the photographs, else black
    #[arg(long)]
    mask: bool,
    /// Take pixels as the files have them, whatever orientation their EXIF or TIFF tag asks for
    #[arg(long)]
    ignore_orientation: bool,
    /// Convention or tool of the new camera's file; `list conventions` lists them
    #[arg(long, value_name = "CONVENTION", default_value = "opencv")]
    camera_format: String,
    /// Pixel pitch, um, for conventions of the new camera's file that are in mm
    #[arg(long, value_name = "UM", value_parser = crate::convert::positive, allow_negative_numbers = true)]
    pitch: Option<f64>,
    /// The folder of the new pictures, or the new file of points
    #[arg(short, long, value_name = "DIR|CSV")]
    output: PathBuf,
}

/// What new pictures hold.
#[derive(Clone, Copy, ValueEnum)]
enum Frame {
    /// Size and axis of the photographs
    Keep,
    /// All that the photographs show
    All,
    /// The largest rectangle that has no empty pixel
    Crop,
}

/// Kinds of files.
#[derive(Clone, Copy, ValueEnum)]
enum Kind {
    /// PNG
    Png,
    /// TIFF, not compressed
    Tiff,
    /// JPEG
    Jpeg,
}

impl Kind {
    fn of(self) -> PictureKind {
        match self {
            Self::Png => PictureKind::Png,
            Self::Tiff => PictureKind::Tiff,
            Self::Jpeg => PictureKind::Jpeg,
        }
    }
}

fn kernel(name: &str) -> Result<Kernel, String> {
    name.parse()
}

/// Whether a file is one of points, by its ending.
fn is_table(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"))
}

impl Undistort {
    pub fn run(mut self, context: &Context<'_>) -> Result<(), Failure> {
        self.files = with_folders(&self.files)?;
        let target = self.target_file();
        let inputs = inputs_of(self.files.iter().chain([&self.camera]).chain(target.as_ref()));
        match self.files.as_slice() {
            [table] if is_table(table) => {
                let output = output::file_of_points("-o", &self.output, &inputs)?;
                points::moved(table, &self.views()?, &output, context.quiet)
            }
            files if files.iter().any(|path| is_table(path)) => {
                Err(Failure::input("expected photographs, or one file of points: give each CSV a command of its own"))
            }
            _ => {
                let project = context.folder()?;
                let folder = output::folder("-o", &self.output, &inputs, ("undistort", project.as_deref()))?;
                self.photographs(&folder, context.quiet)
            }
        }
    }

    /// The file of the camera that --to names, if it names one.
    fn target_file(&self) -> Option<PathBuf> {
        (!views::NAMES.contains(&self.to.as_str())).then(|| PathBuf::from(&self.to))
    }

    /// The size of what is given: of the first photograph; of points that of the photographs, if it is stated.
    fn given_size(&self) -> Result<Option<ImageSize>, Failure> {
        match self.files.first() {
            Some(path) if !is_table(path) => Ok(Some(Opened::new(path, self.ignore_orientation)?.form().size)),
            _ => Ok(self.size.filter(|_| !self.redistort)),
        }
    }

    /// The views of what is given and of what is made.
    fn views(&self) -> Result<Views, Failure> {
        Views::of(self)
    }
}
