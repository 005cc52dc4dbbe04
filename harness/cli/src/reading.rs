//! How a camera file is read: which camera of it, and what it may leave open.

use std::collections::HashSet;
use std::path::Path;

use calibench_diagnostics::nearest;
use calibench_exchange::camera::open_points::{self, OpenPoints};
use calibench_exchange::camera::{self, CameraFile, CameraFormat, FORMATS, NamedCamera, ReadOptions, format_named, read_camera_with};
use calibench_model::camera::{Camera, ImageSize, TangentialOrder, Verification};
use calibench_model::escape;
use clap::{Args, ValueEnum};

use crate::failure::Failure;

/// What a camera file may leave open.
#[derive(Args)]
pub struct Reading {
    /// Size of the images, for files that do not state it
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<ImageSize>,
    /// Format of the file, where more than one recognises it; `list formats` lists them
    #[arg(long, value_name = "FORMAT", value_parser = format)]
    from: Option<&'static CameraFormat>,
    /// The file's OpenCV camera is the fisheye, though it does not say so
    #[arg(long)]
    fisheye: bool,
    /// Order of the decentring coefficients of Pix4D, PhotoScan before 1.2 and Lens, which public sources do not settle [default: opencv]
    #[arg(long, value_enum, value_name = "ORDER")]
    order: Option<Order>,
    /// What (0, 0) is in files of PhotoScan before 1.2, Lens [default: corner], MicMac, OpenMVG and Theia [default: centre], which public sources do not settle
    #[arg(long, value_enum, value_name = "ORIGIN")]
    origin: Option<Origin>,
    /// Distortion model of RealityScan's CSV, which does not say it [default: brown, where the coefficients can be no other's]
    #[arg(long, value_enum, value_name = "LENS")]
    lens: Option<Lens>,
    /// Which camera of a file that holds several: its name, or its place counted from 1 [default: the first]
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
}

/// Which of two decentring coefficients multiplies r^2 + 2 x^2.
#[derive(Clone, Copy, ValueEnum)]
pub enum Order {
    /// The first: Brown's
    Brown,
    /// The second: OpenCV's
    Opencv,
}

/// Whose coefficients they are.
#[derive(Clone, Copy, ValueEnum)]
pub enum Lens {
    /// Brown's polynomials
    Brown,
    /// The division model
    Division,
}

/// What the position (0, 0) is.
#[derive(Clone, Copy, ValueEnum)]
pub enum Origin {
    /// The outer corner of the first pixel
    Corner,
    /// The centre of the first pixel
    Centre,
}

impl Reading {
    /// What the user decided of what formats leave open.
    pub fn open_points(&self) -> OpenPoints {
        let order = self.order.map(|order| match order {
            Order::Brown => TangentialOrder::Brown,
            Order::Opencv => TangentialOrder::OpenCv,
        });
        let origin = self.origin.map(|origin| match origin {
            Origin::Corner => open_points::Origin::Corner,
            Origin::Centre => open_points::Origin::Centre,
        });
        OpenPoints { order, origin }
    }

    /// Says what of a format's convention is not confirmed by numbers of its tool.
    pub fn warn_of_format(&self, format: &CameraFormat) {
        if let Some(Verification::Unverified(open)) = format.convention.map(|convention| convention.verification) {
            let flag = if format.origin_is_open && self.origin.is_none() { "; --origin corner or --origin centre decides" } else { "" };
            say!("unverified: {}: {open}{flag}", format.name);
        }
    }

    /// What of a camera's convention is not confirmed by numbers of its tool, and which flag decides it.
    pub fn doubt(&self, camera: &Camera) -> Option<String> {
        let Verification::Unverified(open) = camera.convention().verification else { return None };
        let flag = match camera {
            Camera::Pix4d(_) if self.order.is_none() => "; --order brown or --order opencv decides the order of T1 and T2",
            Camera::Agisoft(_) if self.order.is_none() || self.origin.is_none() => "; --order and --origin decide",
            _ => "",
        };
        Some(format!("unverified: {}: {open}{flag}", camera.convention().name))
    }

    pub fn file(&self, path: &Path) -> Result<CameraFile, Failure> {
        let lens = self.lens.map(|lens| match lens {
            Lens::Brown => camera::Lens::Brown,
            Lens::Division => camera::Lens::Division,
        });
        let options = ReadOptions { size: self.size, fisheye: self.fisheye.then_some(true), lens, from: self.from };
        Ok(read_camera_with(path, &options)?)
    }

    /// The camera that is meant, with a word on standard error about what was assumed and left out.
    pub fn one(&self, path: &Path) -> Result<NamedCamera, Failure> {
        let mut file = self.file(path)?;
        let chosen = self.choose(path, &file.cameras)?;
        if file.cameras.len() > 1 && self.camera.is_none() {
            let (count, name) = (file.cameras.len(), escape::name(&file.cameras[chosen].name));
            say!("{}: the first of {count} cameras, `{name}`; choose with --camera NAME", shown(path));
        }
        let one = vec![file.cameras.swap_remove(chosen)];
        let one = self.decided(path, CameraFile { cameras: one, ..file });
        one.into_iter().next().ok_or_else(|| Failure::input(format!("{}: holds no camera", shown(path))))
    }

    /// All cameras, with the same words, each once.
    pub fn all(&self, path: &Path) -> Result<Vec<NamedCamera>, Failure> {
        if self.camera.is_some() {
            return Err(Failure::input("--all and --camera NAME exclude each other"));
        }
        Ok(self.decided(path, self.file(path)?))
    }

    /// The place of the camera that is meant.
    fn choose(&self, path: &Path, cameras: &[NamedCamera]) -> Result<usize, Failure> {
        let Some(name) = &self.camera else { return Ok(0) };
        let by_name = cameras.iter().position(|camera| camera.name == *name);
        let by_place = || name.parse::<usize>().ok().filter(|place| (1..=cameras.len()).contains(place)).map(|place| place - 1);
        by_name.or_else(by_place).ok_or_else(|| Failure::input(format!("{}: no camera is called {}", shown(path), escape::name(name))))
    }

    /// The cameras as the user decided open points; says what is unverified, assumed and left out.
    fn decided(&self, path: &Path, file: CameraFile) -> Vec<NamedCamera> {
        let format = file.format;
        let cameras = self.open_points().read(file);
        self.warn_of_format(format);
        let mut said: HashSet<&str> = HashSet::new();
        for named in &cameras {
            if format.convention.is_none() && said.insert(named.camera.convention().name) {
                self.doubt(&named.camera).iter().for_each(|doubt| say!("{doubt}"));
            }
            for note in named.notes.iter().filter(|note| said.insert(note.as_str())) {
                say!("{}: {}", shown(path), escape::name(note));
            }
        }
        cameras
    }
}

/// The format of a name.
fn format(name: &str) -> Result<&'static CameraFormat, String> {
    let near = || nearest(name, FORMATS.iter().map(|format| format.name)).map_or(String::new(), |near| format!("; did you mean `{near}`?"));
    format_named(name).ok_or_else(|| format!("no such format; `calibench list formats` lists them{}", near()))
}

/// A file's name in a message.
pub fn shown(path: &Path) -> String {
    escape::name(&path.display().to_string()).into_owned()
}

pub fn size(text: &str) -> Result<ImageSize, String> {
    let side = |text: &str| text.parse().ok().filter(|n| *n > 0);
    let size = text.split_once(['x', 'X']).and_then(|(w, h)| Some(ImageSize { width: side(w)?, height: side(h)? }));
    size.ok_or_else(|| "expected columns x rows, as in 4272x2848".into())
}
