//! How a camera file is read: which camera of it, and what it may leave open.

use std::collections::HashSet;
use std::path::Path;

use calibench_cameras::open_points::{self, OpenPoints};
use calibench_cameras::{CameraFile, CameraFileError, CameraFormat, CameraList, FORMATS, ReadOptions, format_named, read_camera_with};
use calibench_diagnostics::nearest;
use calibench_model::camera::{Camera, ImageSize, TangentialOrder, Verification};
use calibench_model::{NamedCamera, escape};
use clap::{Args, ValueEnum};

use crate::failure::Failure;

/// Cameras of a long list that are in memory while one of them is looked for.
const AT_A_TIME: usize = 4096;

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
    /// What (0, 0) is in files of PhotoScan before 1.2, Lens [default: corner], MicMac, OpenMVG, Theia, Gyroflow, USD, DJI and Qualisys [default: centre], which public sources do not settle
    #[arg(long, value_enum, value_name = "ORIGIN")]
    origin: Option<Origin>,
    /// Distortion model of RealityScan's CSV, which does not say it [default: brown, where the coefficients can be no other's]
    #[arg(long, value_enum, value_name = "LENS")]
    lens: Option<Lens>,
    /// Which camera of a file that holds several: its name, or its place counted from 1 [default: the first]
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// A key that is not known and left out although it may make the camera another one; may be repeated
    #[arg(long = "ignore-key", value_name = "NAME")]
    ignore: Vec<String>,
    /// A file may state another size than `--size`: that is of other images.
    #[arg(skip)]
    other_size: bool,
    /// Name of the camera matrix, in OpenCV's and NumPy's files where it is one's own
    #[arg(long, value_name = "NAME")]
    matrix: Option<String>,
    /// Name of its coefficients of distortion, or `none`; of a camera matrix in a .npy the .npy beside it
    #[arg(long, value_name = "NAME")]
    distortion: Option<String>,
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
        self.open_point(format).iter().for_each(|open| say!("unverified: {}: {open}", format.name));
    }

    /// What of a format's convention is not confirmed by numbers of its tool, and which flag decides it.
    pub fn open_point(&self, format: &CameraFormat) -> Option<String> {
        let Verification::Unverified(open) = format.convention?.verification else { return None };
        let flag = if format.origin_is_open && self.origin.is_none() { "; --origin corner or --origin centre decides" } else { "" };
        Some(format!("{open}{flag}"))
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

    fn options(&self) -> ReadOptions {
        let lens = self.lens.map(|lens| match lens {
            Lens::Brown => calibench_cameras::Lens::Brown,
            Lens::Division => calibench_cameras::Lens::Division,
        });
        ReadOptions {
            size: self.size,
            fisheye: self.fisheye.then_some(true),
            lens,
            from: self.from,
            ignore: self.ignore.clone(),
            matrix: self.matrix.clone(),
            distortion: self.distortion.clone(),
            other_size: self.other_size,
            splines_alone: false,
        }
    }

    /// Takes `--size` as that of other images where a file states its own.
    pub fn allow_other_size(&mut self) {
        self.other_size = true;
    }

    /// The `--size` that was given.
    pub const fn size(&self) -> Option<ImageSize> {
        self.size
    }

    /// Whether a file states the size of its images.
    pub fn states_size(&self, path: &Path) -> bool {
        read_camera_with(path, &ReadOptions { size: None, ..self.options() }).is_ok()
    }

    /// Opens a file, once: a pipe has no second time.
    pub fn opened(&self, path: &Path) -> Result<Opened, Failure> {
        Ok(match CameraList::open(path, &self.options())? {
            Some(list) => Opened::List(list),
            None => Opened::Whole(read_camera_with(path, &self.options())?),
        })
    }

    /// The camera that is meant, with a word on standard error about what was assumed and left out.
    pub fn one(&self, path: &Path) -> Result<NamedCamera, Failure> {
        self.one_of(path, self.opened(path)?)
    }

    /// The same of a file that was opened at `path`.
    pub fn one_of(&self, path: &Path, opened: Opened) -> Result<NamedCamera, Failure> {
        let (format, count, chosen) = match opened {
            Opened::List(list) => (list.format(), list.len(), self.choose(list.pieces(AT_A_TIME)?)?),
            Opened::Whole(file) => (file.format, file.cameras.len(), self.choose([Ok(file.cameras)])?),
        };
        let chosen = chosen.ok_or_else(|| match &self.camera {
            Some(name) => Failure::input(format!("{}: no camera is called {}", shown(path), escape::name(name))),
            None => Failure::input(format!("{}: holds no camera", shown(path))),
        })?;
        if count > 1 && self.camera.is_none() {
            say!("{}: the first of {count} cameras, `{}`; choose with --camera NAME", shown(path), escape::name(&chosen.name));
        }
        let one = self.decided(path, CameraFile { format, cameras: vec![chosen] });
        one.into_iter().next().ok_or_else(|| Failure::input(format!("{}: holds no camera", shown(path))))
    }

    /// All cameras with their format, with the same words, each once.
    pub fn all(&self, path: &Path) -> Result<(&'static CameraFormat, Vec<NamedCamera>), Failure> {
        self.is_of_all()?;
        let file = read_camera_with(path, &self.options())?;
        Ok((file.format, self.decided(path, file)))
    }

    /// All cameras of a list that is read in pieces, with the same words; `None` for other files.
    pub fn list(&self, path: &Path) -> Result<Option<CameraList>, Failure> {
        self.is_of_all()?;
        let list = CameraList::open(path, &self.options())?;
        list.iter().for_each(|list| self.warn_of_format(list.format()));
        Ok(list)
    }

    fn is_of_all(&self) -> Result<(), Failure> {
        if self.camera.is_some() { Err(Failure::input("--all and --camera NAME exclude each other")) } else { Ok(()) }
    }

    /// The camera that is meant: the first of that name, or else the one in that place; without a name the first.
    fn choose(&self, pieces: impl IntoIterator<Item = Result<Vec<NamedCamera>, CameraFileError>>) -> Result<Option<NamedCamera>, Failure> {
        let place = self.camera.as_ref().map_or(Some(1), |name| name.parse::<usize>().ok());
        let (mut count, mut in_place) = (0, None);
        for piece in pieces {
            for camera in piece? {
                count += 1;
                if self.camera.as_ref().is_some_and(|name| camera.name == *name) {
                    return Ok(Some(camera));
                }
                if place == Some(count) {
                    in_place = Some(camera);
                }
            }
            if self.camera.is_none() {
                break;
            }
        }
        Ok(in_place)
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

/// A camera file: a long list that is read in pieces, or all of it.
#[expect(clippy::large_enum_variant, reason = "one at a time")]
pub enum Opened {
    List(CameraList),
    Whole(CameraFile),
}

impl Opened {
    /// The format.
    pub fn format(&self) -> &'static CameraFormat {
        match self {
            Self::List(list) => list.format(),
            Self::Whole(file) => file.format,
        }
    }

    /// A file as it is, of a long list its first `most` cameras; and how many it holds.
    pub fn file(&self, most: usize) -> Result<(CameraFile, usize), Failure> {
        Ok(match self {
            Self::List(list) => {
                let cameras = list.pieces(most)?.next().transpose()?.unwrap_or_default();
                (CameraFile { format: list.format(), cameras }, list.len())
            }
            Self::Whole(file) => (file.clone(), file.cameras.len()),
        })
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
