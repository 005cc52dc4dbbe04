//! Videos and image sequences in place of photographs: the frames of them that are taken.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::path::{Path, PathBuf};

use calibench_cameras::inputs_of;
use calibench_files::OutputFolder;
use calibench_frames::{ALIKE, Choice, Place, Raw, Sequence, Source, USUAL, Watched, choose, extract, is_video, motion, watch};
use calibench_images::{Foreign, encode_png, write_png};
use calibench_model::boards::Board;
use calibench_model::camera::ImageSize;
use calibench_photographs::Reader;
use clap::Args;
use tempfile::TempDir;

use super::context::{Context, finder};
use super::output;
use super::photos::{AsRead, with_folders};
use super::progress::Progress;
use crate::failure::Failure;

/// Which frames are taken.
#[derive(Args)]
pub struct Frames {
    /// Take at most so many of the photographs, or frames of a video: sharp ones, unlike each other, that tell most of the camera [default: of a video 40; all photographs]
    #[arg(long, value_name = "N", requires = "photos", value_parser = clap::value_parser!(u16).range(1..))]
    frames: Option<u16>,
    /// Folder for the frames that are taken of a video, as PNG; of one that is there, only what calibench wrote is replaced [default: they are not kept]
    #[arg(long, value_name = "DIR", requires = "photos")]
    save_frames: Option<PathBuf>,
}

/// What frames are taken for.
pub struct Wanted<'a> {
    /// The command.
    pub command: &'static str,
    /// The board that one camera sees; without it there are no frames to choose.
    pub board: Option<Board>,
    /// Whether each of several boards counts.
    pub each: bool,
    /// How photographs are read.
    pub read: &'a AsRead,
    /// The size that photographs are to have.
    pub only_size: Option<ImageSize>,
}

/// Photographs, or frames in the place of them.
pub struct Taken {
    /// All of them, in their order.
    pub photos: Vec<PathBuf>,
    /// What is in doubt of the videos.
    pub doubts: Vec<String>,
    /// Where frames are that are not kept.
    passing: Option<TempDir>,
}

impl Taken {
    /// Whether some will be gone when the command has ended.
    pub const fn is_passing(&self) -> bool {
        self.passing.is_some()
    }
}

impl Frames {
    /// The photographs to work with: those given and those in folders given, or the frames that are chosen of all of them, videos too. Says how many were chosen, and why
    /// others were not.
    pub fn taken(&self, given: &[PathBuf], wanted: &Wanted<'_>, context: &Context<'_>) -> Result<Taken, Failure> {
        let videos: HashSet<&PathBuf> = given.iter().filter(|path| is_video(path)).collect();
        let photos = with_folders(given)?;
        if videos.is_empty() && self.frames.is_none() {
            if self.save_frames.is_some() {
                return Err(Failure::input("--save-frames: keeps frames of a video, and there is none; leave it out"));
            }
            return Ok(Taken { photos, doubts: Vec::new(), passing: None });
        }
        let Some(board) = wanted.board else { return Err(not_chosen(videos.iter().next().map(|path| path.as_path()))) };
        let kept = self.save_frames.as_deref();
        let kept = kept.map(|path| output::folder("--save-frames", path, &inputs_of(&photos), (wanted.command, None))).transpose()?;
        let own: Vec<PathBuf> = photos.iter().filter(|path| !videos.contains(path)).cloned().collect();
        let reader = (!own.is_empty()).then(|| wanted.read.of_sequence(&own, wanted.only_size)).transpose()?;
        let read: HashSet<&PathBuf> = reader.iter().flat_map(Reader::photos).collect();
        let source = |path: &PathBuf| if videos.contains(path) { Source::Video(path.clone()) } else { Source::Photo(path.clone()) };
        let as_stored = wanted.read.is_as_stored();
        let mut sequence = Sequence::of(photos.iter().filter(|path| videos.contains(path) || read.contains(path)).map(source), as_stored);
        let finder = finder(board)?.of_each(wanted.each);
        let progress = Progress::counting("frames", context.quiet);
        let watched = watch(&mut sequence, |raw: Raw| raw.image(reader.as_ref()), &finder, &|| progress.step())?;
        let (Some(size), false) = (watched.size, watched.frames.is_empty()) else { return Err(none(&watched, given)) };
        let most = self.frames.map_or(USUAL, usize::from);
        let choice = choose(&watched.frames, &finder.control(), size, most);
        progress.finish(&in_words(&watched, &choice));
        let places = choice.chosen.iter().filter_map(|&place| sequence.place(watched.frames[place].number));
        let places: Vec<Place<'_>> = places.collect();
        if !context.quiet {
            say!("taken: {}", places.iter().map(named).collect::<Vec<_>>().join(", "));
            if !videos.is_empty() {
                say_of_videos(size, motion(&watched.frames, &choice.chosen));
            }
        }
        let (photos, passing) = put(&places, as_stored, kept.as_ref())?;
        Ok(Taken { photos, doubts: doubts(&sequence), passing })
    }
}

/// Why there are no frames to choose.
fn not_chosen(video: Option<&Path>) -> Failure {
    let otherwise = video.map_or_else(String::new, |path| format!("; {} makes photographs of the video", Foreign::Video.advice(path)));
    Failure::input(format!(
        "frames are chosen by the board that one camera sees; expected --board with its words (not `unknown`), and neither a rig nor several cameras{otherwise}"
    ))
}

/// That no frame shows the board.
fn none(watched: &Watched, given: &[PathBuf]) -> Failure {
    let given: Vec<String> = given.iter().map(|path| path.display().to_string()).collect();
    Failure::input(format!(
        "{}: {} frames were read, and none shows the board; expected one as it was described, of a chessboard all inner corners visible, counted as COLUMNSxROWS \
         (`calibench detect FRAME.png --board unknown` says what board a frame shows)",
        given.join(", "),
        watched.read
    ))
}

/// What became of the frames.
fn in_words(watched: &Watched, choice: &Choice) -> String {
    format!(
        "{} read, {} show the board: {} are blurred (edges wider than {:.1} px), {} show it where one that is taken does (to {} % of the diagonal), {} more are not needed, {} are taken",
        watched.read,
        watched.frames.len(),
        choice.blurred,
        choice.limit_px,
        choice.alike,
        100.0 * ALIKE,
        choice.spare,
        choice.chosen.len()
    )
}

/// A frame in words.
fn named(place: &Place<'_>) -> String {
    let Source::Video(path) = place.source else { return short(path_of(place.source)) };
    let time = place.time.map_or_else(String::new, |time| format!(" ({time:.2} s)"));
    format!("{} {}{time}", short(path), place.frame)
}

const fn path_of(source: &Source) -> &PathBuf {
    match source {
        Source::Photo(path) | Source::Video(path) => path,
    }
}

fn short(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// What is to be known of every video.
fn say_of_videos(ImageSize { width, height }: ImageSize, motion: Option<(f64, f64)>) {
    say!(
        "the camera of a video is that of its frames, {width} x {height} px: photographs of the same camera have another size and crop. Where a video is stabilised the \
         camera changes from frame to frame; compression smooths corners"
    );
    if let Some((median, most)) = motion {
        say!(
            "from a frame that is taken to the next the board moves by {median:.1} px (median; {most:.1} px at most): where rows are exposed one after the other, as most \
             cameras do, up to so much is in the points; hold still for a moment before each"
        );
    }
}

/// What is in doubt of videos.
fn doubts(sequence: &Sequence) -> Vec<String> {
    let mut doubts = Vec::new();
    for (source, frames, heard) in sequence.read() {
        let path = path_of(source).display();
        if heard.interlaced > 0 {
            doubts.push(format!(
                "{path}: {} of {frames} frames are interlaced, made of rows of two times: `ffmpeg -i {path} -vf yadif` makes whole ones",
                heard.interlaced
            ));
        }
        if heard.errors > 0 {
            doubts.push(format!(
                "{path}: ffmpeg reports errors ({}), frames may be damaged or missing: {}",
                heard.errors,
                heard.said.join(" ... ")
            ));
        }
    }
    doubts
}

/// Writes the frames of videos, and returns where all are.
fn put(places: &[Place<'_>], as_stored: bool, kept: Option<&OutputFolder>) -> Result<(Vec<PathBuf>, Option<TempDir>), Failure> {
    let passing = if kept.is_none() && places.iter().any(|place| matches!(place.source, Source::Video(_))) {
        Some(tempfile::tempdir()?)
    } else {
        None
    };
    let folder = kept.map(OutputFolder::path).or_else(|| passing.as_ref().map(TempDir::path));
    let names = names(places);
    let path = |(place, name): (&Place<'_>, &String)| match (place.source, folder) {
        (Source::Video(_), Some(folder)) => folder.join(name),
        (source, _) => path_of(source).clone(),
    };
    let photos: Vec<PathBuf> = places.iter().zip(&names).map(path).collect();
    let mut by_video: BTreeMap<&PathBuf, BTreeMap<usize, &String>> = BTreeMap::new();
    for (place, name) in places.iter().zip(&names) {
        if let Source::Video(path) = place.source {
            by_video.entry(path).or_default().insert(place.frame, name);
        }
    }
    let each = |put: &dyn Fn(&str, &calibench_model::Image) -> Result<(), Failure>| {
        by_video.iter().try_for_each(|(path, wanted)| {
            let numbers: BTreeSet<usize> = wanted.keys().copied().collect();
            extract(path, as_stored, &numbers, |number, still| put(wanted[&number], &still.image()))
        })
    };
    match (kept, &passing) {
        (Some(kept), _) => kept.replace(|folder| each(&|name, image| Ok(folder.write(name, |file| encode_png(file, image, false))?)))?,
        (None, Some(passing)) => each(&|name, image| Ok(write_png(&passing.path().join(name), image, false)?))?,
        (None, None) => {}
    }
    Ok((photos, passing))
}

/// What each frame of a video is called: as the video, with its number.
fn names(places: &[Place<'_>]) -> Vec<String> {
    let mut videos: Vec<&PathBuf> = Vec::new();
    for place in places {
        let path = path_of(place.source);
        if !videos.contains(&path) {
            videos.push(path);
        }
    }
    let stem = |path: &PathBuf| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let name = |place: &Place<'_>| {
        let path = path_of(place.source);
        let own = videos.iter().filter(|other| stem(other) == stem(path)).position(|other| *other == path).unwrap_or(0);
        let which = if own == 0 { String::new() } else { format!("-{}", own + 1) };
        format!("{}{which}-{:06}.png", stem(path), place.frame)
    };
    places.iter().map(name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_of_two_videos_of_one_name_have_two_names() {
        let sources = ["a/clip.mp4", "b/clip.avi", "b/other.mkv"].map(|path| Source::Video(path.into()));
        let place = |source: usize, frame: usize| Place { source: &sources[source], frame, time: None };
        let found = names(&[place(0, 12), place(1, 12), place(1, 1_234_567), place(2, 0)]);
        assert_eq!(found, ["clip-000012.png", "clip-2-000012.png", "clip-2-1234567.png", "other-000000.png"]);
    }
}
