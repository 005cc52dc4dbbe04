//! A video, decoded by the program `ffmpeg` and read as it comes.

use std::ffi::OsString;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, ChildStdout, Command, Stdio};
use std::thread::JoinHandle;

use calibench_images::Foreign;

use crate::pgm::{self, Still};
use crate::{FFMPEG, FramesError};

/// Bytes of a file that tell what it is.
const TELLING: u64 = 64;
/// Endings of videos whose first bytes are those of other things, as of a photograph, or of nothing.
const ENDINGS: [&str; 9] = ["mjpeg", "mjpg", "ts", "mts", "m2ts", "mpg", "mpeg", "wmv", "y4m"];
/// Of a line that the program says so much is kept, bytes.
const LINE: u64 = 4096;
/// What tells when frames are shown.
const FILTER: &str = "showinfo=checksum=0";
/// Versions that know the option for frames as they come, none left out or given twice to keep an interval, by its older name alone.
const OLDER: [&str; 4] = ["2.", "3.", "4.", "5.0"];

/// Whether a file is a video, by its first bytes or its ending.
pub fn is_video(path: &Path) -> bool {
    let ending = path.extension().map(std::ffi::OsStr::to_ascii_lowercase);
    if !path.is_file() {
        return false;
    }
    if ending.is_some_and(|ending| ENDINGS.iter().any(|known| ending == *known)) {
        return true;
    }
    let mut head = Vec::new();
    let read = File::open(path).and_then(|file| file.take(TELLING).read_to_end(&mut head));
    read.is_ok() && Foreign::of(&head) == Some(Foreign::Video)
}

/// A video that is being decoded: its frames, one after the other.
#[derive(Debug)]
pub struct Video {
    path: PathBuf,
    child: Child,
    output: BufReader<ChildStdout>,
    listener: Option<JoinHandle<Heard>>,
    frames: usize,
}

/// What the program said of a video.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Heard {
    /// When each frame is shown, s.
    pub times: Vec<f64>,
    /// Frames made of rows of two times.
    pub interlaced: usize,
    /// How many errors it met.
    pub errors: usize,
    /// The first and the last of them.
    pub said: Vec<String>,
}

impl Video {
    /// Starts to decode the video at `path`: its first stream of pictures, with 8 bits a level; turned as it is to be seen, or with `as_stored` as the sensor had it.
    /// Nothing but this file is opened, whatever it names.
    ///
    /// # Errors
    /// [`FramesError::Missing`], [`FramesError::Program`].
    pub fn open(path: &Path, as_stored: bool) -> Result<Self, FramesError> {
        let program = std::env::var_os(FFMPEG).unwrap_or_else(|| "ffmpeg".into());
        let cannot = |source: io::Error| match source.kind() {
            io::ErrorKind::NotFound => FramesError::Missing { path: path.to_owned() },
            _ => FramesError::Program { path: path.to_owned(), source },
        };
        let version = Command::new(&program).arg("-version").stdin(Stdio::null()).output().map_err(cannot)?.stdout;
        // A name with a colon is no protocol, one with a dash at its beginning no option.
        let mut file = OsString::from("file:");
        file.push(path);
        let mut command = Command::new(&program);
        command.args(["-nostdin", "-hide_banner", "-nostats", "-loglevel", "level+info", "-protocol_whitelist", "file"]);
        command.args(as_stored.then_some("-noautorotate"));
        command.arg("-i").arg(file);
        command.args(["-map", "0:V:0", "-vf", FILTER, as_they_come(&version), "passthrough"]);
        command.args(["-pix_fmt", "gray", "-c:v", "pgm", "-f", "image2pipe", "pipe:1"]);
        let started = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
        let mut child = started.map_err(cannot)?;
        let no_pipe = || FramesError::Program { path: path.to_owned(), source: io::Error::other("no pipe to the program") };
        let (output, said) = (child.stdout.take().ok_or_else(no_pipe)?, child.stderr.take().ok_or_else(no_pipe)?);
        let listener = Some(std::thread::spawn(|| heard(said)));
        Ok(Self { path: path.to_owned(), child, output: BufReader::new(output), listener, frames: 0 })
    }

    /// Waits until the program has ended, after the last frame.
    ///
    /// # Errors
    /// [`FramesError::NoStream`], [`FramesError::Failed`].
    pub fn finish(mut self) -> Result<Heard, FramesError> {
        let status = self.child.wait().map_err(|source| FramesError::Program { path: self.path.clone(), source })?;
        let heard = self.listener.take().and_then(|listener| listener.join().ok()).unwrap_or_default();
        let path = self.path.clone();
        match (status.success(), self.frames) {
            (true, 1..) => Ok(heard),
            _ if heard.said.iter().any(|line| line.contains("matches no streams")) => Err(FramesError::NoStream { path }),
            (_, frames) => {
                let said = if heard.said.is_empty() { status.to_string() } else { heard.said.join(" ... ") };
                Err(FramesError::Failed { path, frames, said })
            }
        }
    }
}

impl Iterator for Video {
    type Item = Result<Still, FramesError>;

    fn next(&mut self) -> Option<Self::Item> {
        let still = pgm::next(&mut self.output);
        let answer = |found| FramesError::Answer { path: self.path.clone(), frame: self.frames, found };
        let still = still.map_err(answer).transpose()?;
        self.frames += 1;
        Some(still)
    }
}

impl Drop for Video {
    fn drop(&mut self) {
        // One that has ended is not there to be ended.
        self.child.kill().ok();
        self.child.wait().ok();
    }
}

/// The option for frames as they come, by what the program says of its version.
fn as_they_come(version: &[u8]) -> &'static str {
    let number = version.strip_prefix(b"ffmpeg version ").unwrap_or_default();
    if OLDER.iter().any(|older| number.starts_with(older.as_bytes())) { "-vsync" } else { "-fps_mode" }
}

/// Takes down what the program says, to its end.
fn heard(said: ChildStderr) -> Heard {
    let (mut said, mut heard, mut line) = (BufReader::new(said), Heard::default(), Vec::new());
    loop {
        line.clear();
        // Of a line that is longer the rest is taken for another one.
        match Read::by_ref(&mut said).take(LINE).read_until(b'\n', &mut line) {
            Ok(1..) => heard.take_down(&String::from_utf8_lossy(&line)),
            _ => return heard,
        }
    }
}

impl Heard {
    /// Takes down a line.
    fn take_down(&mut self, line: &str) {
        if let Some((_, said)) = line.split_once("[error] ").or_else(|| line.split_once("[fatal] ")) {
            self.errors += 1;
            self.said.truncate(1);
            self.said.push(said.trim().to_owned());
            self.said.dedup();
        } else if let Some(time) = after(line, " pts_time:") {
            // Of a frame without a time its place must stay.
            self.times.push(time.parse().unwrap_or(f64::NAN));
            self.interlaced += usize::from(after(line, " i:").is_some_and(|order| order == "T" || order == "B"));
        }
    }
}

/// The word behind `key`.
fn after<'l>(line: &'l str, key: &str) -> Option<&'l str> {
    line.split_once(key)?.1.split_whitespace().next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_errors_are_taken_down() {
        let mut heard = Heard::default();
        for line in [
            "[info]   Duration: 00:00:01.00, start: 0.000000, bitrate: 60 kb/s",
            "[Parsed_showinfo_0 @ 0x7f] [info] n:   0 pts:      0 pts_time:0       duration:   1024 fmt:yuv420p s:320x240 i:P iskey:1 type:I",
            "[Parsed_showinfo_0 @ 0x7f] [info] n:   1 pts:   NOPTS pts_time:NOPTS   fmt:yuv420p s:320x240 i:T iskey:0 type:B",
            "[Parsed_showinfo_0 @ 0x7f] [info] n:   2 pts:   2048 pts_time:0.25     fmt:yuv420p s:320x240 i:B iskey:0 type:B",
            "[h264 @ 0x55] [error] first",
            "[h264 @ 0x55] [error] second",
            "[fatal] last\n",
        ] {
            heard.take_down(line);
        }
        assert_eq!((heard.times.len(), heard.times[0], heard.times[2]), (3, 0.0, 0.25));
        assert!(heard.times[1].is_nan());
        assert_eq!((heard.interlaced, heard.errors, heard.said), (2, 3, vec!["first".to_owned(), "last".to_owned()]));
    }

    #[test]
    fn older_versions_have_the_older_option() {
        for (version, option) in [
            ("ffmpeg version 4.4.2-0ubuntu0.22.04.1 Copyright", "-vsync"),
            ("ffmpeg version 5.0.1", "-vsync"),
            ("ffmpeg version 5.1.6-0+deb12u1", "-fps_mode"),
            ("ffmpeg version n9.0.2-17-g2a571b6068", "-fps_mode"),
            ("ffmpeg version 40.1", "-fps_mode"),
            ("", "-fps_mode"),
        ] {
            assert_eq!(as_they_come(version.as_bytes()), option, "{version}");
        }
    }

    #[test]
    fn videos_are_told_by_content_or_ending() {
        let folder = tempfile::tempdir().unwrap();
        let is = |name: &str, content: &[u8]| {
            let path = folder.path().join(name);
            std::fs::write(&path, content).unwrap();
            is_video(&path)
        };
        assert!(is("a", b"\0\0\0\x20ftypisom\0\0\x02\0isom") && is("b.x", b"RIFF\0\0\0\0AVI LIST"));
        assert!(is("c.MJPEG", b"\xff\xd8\xff\xe0"), "frames of JPEG, one after the other");
        assert!(!is("d.jpg", b"\xff\xd8\xff\xe0") && !is("e.png", b"\x89PNG\r\n\x1a\n"));
        assert!(!is_video(folder.path()) && !is_video(&folder.path().join("none.ts")));
    }
}
