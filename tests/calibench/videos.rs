//! Videos and image sequences in place of photographs.

use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Output};

use calibench_images::{read_photo, write_png};
use calibench_model::Image;

use crate::judge::board;
use crate::project::{program, run, stderr, stdout};

/// The board's photographs three times, as frames of 8 bits: as it is, the same again, and blurred along its rows. Returns how many photographs there are.
fn sequence(folder: &Path) -> usize {
    let photographs = board(folder);
    std::fs::create_dir(folder.join("seq")).unwrap();
    for (k, name) in photographs.iter().enumerate() {
        let image = read_photo(&folder.join(name)).unwrap().image;
        let moved =
            |x: usize, y: usize| (0..9).map(|step| image.at((x + step).saturating_sub(4).min(image.width() - 1), y)).sum::<f32>() / 9.0;
        let blurred = Image::from_fn(image.width(), image.height(), moved);
        for (which, frame) in [&image, &image, &blurred].into_iter().enumerate() {
            write_png(&folder.join(format!("seq/{:03}.png", 3 * k + which)), frame, false).unwrap();
        }
    }
    photographs.len()
}

/// The parameters of a calibration's camera, by its answer.
fn parameters(output: &Output) -> Vec<f64> {
    let answer: serde_json::Value = serde_json::from_str(&stdout(output)).unwrap_or_else(|_| panic!("{}", stderr(output)));
    let all = answer["cameras"][0]["camera"]["parameters"].as_array().unwrap();
    all.iter().map(|parameter| parameter["value"].as_f64().unwrap()).collect()
}

const CALIBRATE: [&str; 5] = ["calibrate", "--board", "9x6:25", "--model", "opencv5"];

#[test]
fn frames_of_a_folder_are_sharp_and_unlike() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let count = sequence(here);
    let with = |more: &[&str]| run(here, &[&CALIBRATE[..], more].concat());
    let all = with(&["seq", "--frames", "40", "--json"]);
    let said = stderr(&all);
    let (read, words) = (3 * count, said.replace('\n', " "));
    assert!(words.contains(&format!("frames: {read} read, {read} show the board: {count} are blurred (edges wider than ")), "{said}");
    assert!(
        words.contains(&format!(
            "{count} show it where one that is taken does (to 1 % of the diagonal), 0 more are not needed, {count} are taken"
        )),
        "{said}"
    );
    let taken: Vec<String> = (0..count).map(|k| format!("{:03}.png", 3 * k)).collect();
    assert!(words.contains(&format!("taken: {}", taken.join(", "))), "{said}");
    assert!(!said.contains("the same photograph"), "{said}");
    // The camera is that of the photographs themselves.
    let photographs: Vec<String> = (0..count).map(|k| format!("seq/{:03}.png", 3 * k)).collect();
    let photographs: Vec<&str> = photographs.iter().map(String::as_str).collect();
    assert_eq!(parameters(&all), parameters(&with(&[&photographs[..], &["--json"]].concat())));
    // Fewer: all of them sharp.
    let few = stderr(&run(here, &["detect", "--board", "9x6", "seq", "--frames", "5", "-o", "found.csv"]));
    assert!(few.contains(&format!("{} more are not needed, 5 are taken", 2 * (count - 5))), "{few}");
    let found = std::fs::read_to_string(here.join("found.csv")).unwrap();
    let mut names: Vec<&str> = found.lines().skip(1).filter_map(|line| line.split(',').next()).collect();
    names.dedup();
    assert!(names.len() == 5 && names.iter().all(|name| taken.iter().any(|taken| taken == name)), "{names:?}");
}

/// A program in place of ffmpeg, which says `said` and does `done`.
#[cfg(unix)]
fn pretended(here: &Path, said: &str, done: &str) -> std::path::PathBuf {
    use std::os::unix::fs::PermissionsExt;
    let path = here.join("pretended-ffmpeg");
    std::fs::write(here.join("said"), said).unwrap();
    std::fs::write(&path, format!("#!/bin/sh\ncat '{}' >&2\n{done}\n", here.join("said").display())).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    path
}

/// What ffmpeg is asked for, by a program in its place: so this is tried where there is none.
#[test]
#[cfg(unix)]
fn a_video_is_read_as_it_comes_and_what_fails_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let count = sequence(here);
    std::fs::write(here.join("clip.mp4"), b"\0\0\0\x18ftypisom").unwrap();
    let calibrated = |ffmpeg: &Path, more: &[&str]| {
        let output = program(here).env("CALIBENCH_FFMPEG", ffmpeg).args([&CALIBRATE[..], &["clip.mp4"], more].concat()).output().unwrap();
        (output.status.code(), stderr(&output), output)
    };
    let fails = |ffmpeg: &Path, why: &str| {
        let (code, said, _) = calibrated(ffmpeg, &[]);
        assert!(code == Some(2) && said.contains(why), "{why}: {code:?} {said}");
    };
    fails(&here.join("none"), "the program `ffmpeg` reads, and there is none");
    fails(
        &here.join("none"),
        "`apt-get install ffmpeg` installs it, or make frames where it is: `ffmpeg -i clip.mp4 -vf fps=2 clip-%04d.png`",
    );
    fails(
        &pretended(here, "[fatal] Stream map '' matches no streams.\n[fatal] Invalid argument\n", "exit 234"),
        "clip.mp4: has no video stream",
    );
    fails(
        &pretended(here, "[in#0] [error] moov atom not found\n[fatal] Invalid data\n", "exit 183"),
        "reads 0 frames and fails: moov atom not found ... Invalid data",
    );
    fails(&pretended(here, "", "exit 3"), "reads 0 frames and fails: exit status: 3");
    fails(&pretended(here, "", ""), "reads 0 frames and fails: exit status: 0");
    fails(&pretended(here, "", "echo P6"), "frame 0: ffmpeg answers the bytes [50, 36]; expected a picture");
    fails(
        &pretended(here, "", "printf 'P5\\n2 1\\n255\\nabP5\\n1 1\\n255\\na'"),
        "clip.mp4: frame 1 has 1 x 1 px, the frames before it 2 x 1 px",
    );
    fails(&pretended(here, "", "printf 'P5\\n2 1\\n255\\nab'"), "clip.mp4: 1 frames were read, and none shows the board");
    // Frames, with a time each.
    let (mut stream, mut said) = (Vec::new(), String::new());
    for frame in 0..3 * count {
        let image = read_photo(&here.join(format!("seq/{frame:03}.png"))).unwrap().image;
        stream.extend(format!("P5\n{} {}\n255\n", image.width(), image.height()).bytes().chain(image.to_u8()));
        writeln!(said, "[showinfo] [info] n:{frame} pts:0 pts_time:{:.1} fmt:yuv420p i:P", 0.1 * frame as f64).unwrap();
    }
    std::fs::write(here.join("stream"), stream).unwrap();
    let whole = format!("cat '{}'", here.join("stream").display());
    let (_, words, output) = calibrated(&pretended(here, &said, &whole), &["--json", "--save-frames", "kept"]);
    assert!(words.contains("taken: clip.mp4 0 (0.00 s), clip.mp4 3 (0.30 s), "), "{words}");
    assert!(
        words.contains("the camera of a video is that of its frames, 640 x 480 px") && words.contains("the board moves by 0."),
        "{words}"
    );
    let frames = run(here, &[&CALIBRATE[..], &["kept", "--json"]].concat());
    assert_eq!(parameters(&output), parameters(&frames), "those that were kept");
    assert_eq!(parameters(&output), parameters(&run(here, &[&CALIBRATE[..], &["seq", "--frames", "40", "--json"]].concat())));
    let detected = |ffmpeg: &Path| {
        let detect = ["detect", "clip.mp4", "--board", "9x6", "-o", "found.csv"];
        let output = program(here).env("CALIBENCH_FFMPEG", ffmpeg).args(detect).output().unwrap();
        (output.status.code(), stderr(&output))
    };
    assert_eq!(detected(&pretended(here, &said, &whole)).0, Some(0));
    let (code, words) = detected(&pretended(here, &said.replace("i:P", "i:T"), &whole));
    assert!(
        code == Some(3) && words.contains(&format!("in doubt: clip.mp4: {read} of {read} frames are interlaced", read = 3 * count)),
        "{words}"
    );
    let (code, words) = detected(&pretended(here, &(said.clone() + "[mpeg4] [error] damaged at 7 3\n"), &whole));
    assert!(code == Some(3) && words.contains("ffmpeg reports errors (1), frames may be damaged or missing: damaged at 7 3"), "{words}");
    let (code, words) = detected(&pretended(here, &said, &format!("{whole}; exit 9")));
    assert!(code == Some(2) && words.contains(&format!("reads {} frames and fails", 3 * count)), "{words}");
}

#[test]
fn what_has_no_frames_to_choose_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::write(here.join("clip.avi"), b"RIFF\0\0\0\0AVI LIST").unwrap();
    write_png(&here.join("a.png"), &Image::from_fn(64, 48, |_, _| 0.5), false).unwrap();
    let fails = |arguments: &[&str], why: &str| {
        let output = run(here, arguments);
        assert!(output.status.code() == Some(2) && stderr(&output).contains(why), "{arguments:?}: {}", stderr(&output));
    };
    fails(&["detect", "clip.avi", "--board", "unknown"], "expected --board with its words");
    fails(&["detect", "clip.avi", "--board", "unknown"], "`ffmpeg -i clip.avi -vf fps=2 clip-%04d.png` converts it");
    fails(&["calibrate", "clip.avi", "--board", "9x6:25", "--camera", "a=a*", "--camera", "b=b*"], "neither a rig nor several cameras");
    fails(
        &["calibrate", "a.png", "--board", "9x6:25", "--save-frames", "kept"],
        "--save-frames: keeps frames of a video, and there is none",
    );
    fails(&["judge", "a.png", "--board", "9x6:25", "--frames", "3"], "a.png: 1 frames were read, and none shows the board");
    fails(&["calibrate", "a.png", "--board", "9x6:25", "--frames", "0"], "--frames");
    fails(&["measure", "clip.avi", "--board", "9x6:25"], "clip.avi: is a video, which is not read");
}

/// The program that reads videos, as calibench finds it.
fn ffmpeg(here: &Path, arguments: &[&str]) {
    let name = std::env::var_os("CALIBENCH_FFMPEG").unwrap_or_else(|| "ffmpeg".into());
    let output = Command::new(name).args(["-v", "error", "-y"]).args(arguments).current_dir(here).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
}

#[test]
#[cfg_attr(not(ffmpeg), ignore = "no ffmpeg on the path, nor under CALIBENCH_FFMPEG")]
fn ffmpeg_reads_videos_of_many_kinds() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let count = sequence(here);
    let from: [&str; 4] = ["-framerate", "10", "-i", "seq/%03d.png"];
    let lossless = ["-c:v", "ffv1", "-pix_fmt", "gray", "clip.mkv"];
    ffmpeg(here, &[&from[..], &lossless].concat());
    let with = |file: &str, more: &[&str]| run(here, &[&CALIBRATE[..], &[file, "--json"], more].concat());
    let clip = with("clip.mkv", &[]);
    let said = stderr(&clip);
    assert!(said.contains(&format!("{} read, {} show the board: {count} are blurred", 3 * count, 3 * count)), "{said}");
    assert!(said.contains("taken: clip.mkv 0 (0.00 s), clip.mkv 3 (0.30 s), clip.mkv 6 (0.60 s)"), "{said}");
    let exact = parameters(&clip);
    assert_eq!(exact, parameters(&with("seq", &["--frames", "40"])));
    for file in ["clip.mp4", "clip.mov", "clip.avi", "clip.mjpeg"] {
        let codec = if file.ends_with("mp4") || file.ends_with("mov") { "mpeg4" } else { "mjpeg" };
        ffmpeg(
            here,
            &[&from[..], &["-c:v", codec, "-q:v", "2", "-pix_fmt", if codec == "mjpeg" { "yuvj420p" } else { "yuv420p" }, file]].concat(),
        );
        let output = with(file, &[]);
        let found = parameters(&output);
        assert!(stderr(&output).contains(&format!("{} read, ", 3 * count)), "{file}: {}", stderr(&output));
        // Compression moves corners; the focal lengths stay to a thousandth.
        assert!((0..2).all(|k| (found[k] / exact[k] - 1.0).abs() < 1e-3), "{file}: {found:?} and {exact:?}");
    }
    let fails = |file: &str, why: &str| {
        let output = with(file, &[]);
        assert!(output.status.code() == Some(2) && stderr(&output).contains(why), "{file}: {}", stderr(&output));
    };
    let bytes = std::fs::read(here.join("clip.mp4")).unwrap();
    std::fs::write(here.join("cut.mp4"), &bytes[..bytes.len() / 2]).unwrap();
    fails("cut.mp4", "reads 0 frames and fails: ");
    let bytes = std::fs::read(here.join("clip.mkv")).unwrap();
    std::fs::write(here.join("cut.mkv"), &bytes[..bytes.len() - 1000]).unwrap();
    let cut = run(here, &["detect", "cut.mkv", "--board", "9x6", "-o", "found.csv"]);
    assert!(cut.status.code() == Some(3) && stderr(&cut).contains("frames may be damaged or missing"), "{}", stderr(&cut));
    ffmpeg(here, &["-f", "lavfi", "-i", "anullsrc", "-t", "1", "-c:a", "pcm_s16le", "sound.mkv"]);
    fails("sound.mkv", "sound.mkv: has no video stream");
    // Times that are not at one interval: each frame is read once.
    ffmpeg(here, &["-i", "clip.mkv", "-vf", "setpts=N*N/10/TB", "-fps_mode", "passthrough", "-c:v", "ffv1", "uneven.mkv"]);
    let uneven = with("uneven.mkv", &[]);
    assert_eq!(parameters(&uneven), exact);
    assert!(stderr(&uneven).contains("uneven.mkv 3 (0.90 s), uneven.mkv 6 (3.60 s)"), "{}", stderr(&uneven));
}
