//! The cameras that are converted: one of a file, all of it, or those of several files.

use std::path::{Path, PathBuf};

use calibench_cameras::CameraFormat;
use calibench_cameras::joined::{Joined, joined};
use calibench_model::{NamedCamera, escape};

use super::Convert;
use crate::failure::Failure;

/// A camera and the format of its file.
type Source = (&'static CameraFormat, NamedCamera);

impl Convert {
    /// The file, of several the first.
    pub(super) fn file(&self) -> &Path {
        self.files.first().map_or(Path::new(""), |file| file.as_path())
    }

    /// The files as they were named.
    pub(super) fn named_files(&self) -> String {
        self.files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>().join(", ")
    }

    /// Whether every camera of the files is asked for.
    pub(super) fn takes_all(&self) -> bool {
        self.all || self.files.len() > 1
    }

    /// The cameras to convert, each with the format of its file; says what is known of poses between cameras of several files.
    pub(super) fn sources(&self, quiet: bool) -> Result<Vec<Source>, Failure> {
        if self.files.len() > 1 {
            return self.of_several(quiet);
        }
        if self.all {
            let (format, cameras) = self.reading.all(self.file())?;
            return Ok(cameras.into_iter().map(|camera| (format, camera)).collect());
        }
        let opened = self.reading.opened(self.file())?;
        Ok(vec![(opened.format(), self.reading.one_of(self.file(), opened)?)])
    }

    fn of_several(&self, quiet: bool) -> Result<Vec<Source>, Failure> {
        if self.to.is_none() {
            return Err(Failure::input(
                "several files become one, or a folder of files: expected --to, which names the convention of the new file",
            ));
        }
        if self.naive || self.plot.is_some() {
            return Err(Failure::input("--naive and --plot are for one camera, found several files"));
        }
        let read: Vec<_> = self.files.iter().map(|file| self.reading.all(file)).collect::<Result<_, Failure>>()?;
        let formats: Vec<_> = read.iter().flat_map(|(format, cameras)| cameras.iter().map(|_| *format)).collect();
        let Joined { cameras, poses } = joined(self.files.iter().map(PathBuf::as_path).zip(read.into_iter().map(|(_, cameras)| cameras)));
        if !quiet {
            say!("{}", escape::name(&poses));
        }
        Ok(formats.into_iter().zip(cameras).collect())
    }
}
