//! Lists of cameras that are converted in pieces, and so may be as long as they need be.

use std::fs::File;
use std::io::{self, BufWriter, Seek, Write};

use calibench_cameras::target::named_for;
use calibench_cameras::{CameraFile, CameraFileError, CameraFormat, CameraList, ListWriter, format_named};
use rayon::prelude::*;

use super::file::CamerasFile;
use super::said::Said;
use super::{Answer, Convert, lost};
use crate::deliver::stream;
use crate::failure::Failure;

/// Cameras that are in memory.
const AT_A_TIME: usize = 4096;

/// What is said when all is converted.
#[derive(Default)]
struct Words {
    cameras: Said,
    lost: Said,
    /// Whether no lens has one of the cameras.
    doubtful: bool,
}

impl Convert {
    /// Converts a list to a list; false where one of them is none, and nothing is done.
    pub(super) fn in_pieces(&self, to: &CamerasFile, quiet: bool) -> Result<bool, Failure> {
        let named = self.to.as_deref().map(|to| named_for(to, self.output.as_deref()));
        let format = named.and_then(format_named).filter(|format| self.all && self.files.len() == 1 && format.is_written_in_pieces());
        let Some(format) = format.filter(|_| !matches!(to, CamerasFile::Folder(_))) else { return Ok(false) };
        let Some(list) = self.reading.list(self.file())? else { return Ok(false) };
        let mut words = Words::default();
        let place = if let CamerasFile::File(file) = to { format!("-o {}: ", file.path().display()) } else { String::new() };
        let mut write = |output: &mut dyn Write| self.write_list(&list, (format, &place), output, &mut words, quiet);
        match to {
            CamerasFile::File(file) if file.is_file() => file.write(|output| write(output))?,
            // What cannot be taken back is written when nothing can be wrong any more.
            CamerasFile::File(file) => {
                let mut all = aside(write)?;
                file.write(|output| io::copy(&mut all, output).map(drop))?;
            }
            CamerasFile::Standard | CamerasFile::Folder(_) => {
                let mut all = aside(write)?;
                stream(|output| io::copy(&mut all, output).map(drop))?;
            }
        }
        words.cameras.say();
        self.reading.warn_of_format(format);
        words.lost.say();
        if words.doubtful { Err(Failure::Doubt) } else { Ok(true) }
    }

    /// Writes the converted list; `place` stands before what is wrong with its file.
    fn write_list(
        &self,
        list: &CameraList,
        (format, place): (&'static CameraFormat, &str),
        output: &mut dyn Write,
        words: &mut Words,
        quiet: bool,
    ) -> Result<(), Failure> {
        let unwritten = |error: CameraFileError| Failure::input(format!("{place}{error}"));
        let (mut writer, head) = ListWriter::new(format, list).map_err(unwritten)?;
        output.write_all(&head)?;
        let mut index = 0;
        for piece in list.pieces(AT_A_TIME)? {
            let count = index + piece.as_ref().map_or(0, Vec::len);
            let read = CameraFile { format: list.format(), cameras: piece? };
            let numbered = self.reading.open_points().read(read).into_par_iter().enumerate();
            let one = |(at, source)| self.one_of_many(index + at, (list.format(), &source), list.len() > 1, quiet);
            let found: Vec<Result<Answer, Failure>> = numbered.map(one).collect();
            let mut cameras = Vec::with_capacity(found.len());
            for answer in found {
                let Answer { camera, said, doubtful, .. } = answer?;
                words.doubtful |= doubtful;
                said.iter().for_each(|(label, text)| words.cameras.add(label.as_deref(), text));
                lost(format, &camera).for_each(|text| words.lost.add(None, &text));
                cameras.push(camera);
            }
            self.reading.open_points().written(format, &mut cameras);
            output.write_all(&writer.piece(&cameras).map_err(unwritten)?)?;
            index = count;
        }
        writer.end().map_err(unwritten)
    }
}

/// What is written, in a file without a name.
fn aside(write: impl FnOnce(&mut dyn Write) -> Result<(), Failure>) -> Result<File, Failure> {
    let mut file = BufWriter::new(Aside(tempfile::tempfile().map_err(in_aside)?));
    write(&mut file)?;
    let mut file = file.into_inner().map_err(io::IntoInnerError::into_error)?.0;
    file.rewind().map_err(in_aside)?;
    Ok(file)
}

/// A file whose errors say what it is.
struct Aside(File);

impl Write for Aside {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes).map_err(in_aside)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush().map_err(in_aside)
    }
}

fn in_aside(error: io::Error) -> io::Error {
    if error.kind() == io::ErrorKind::Interrupted { error } else { io::Error::new(error.kind(), format!("a temporary file: {error}")) }
}
