//! Lists in pieces and as a whole: the same cameras, the same mistakes, the same bytes.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::*;
use crate::{camera_bytes, format_named, read_camera_with};

/// A line of each of a few models, over and over; ids from 1.
fn text(count: usize) -> String {
    let models = ["SIMPLE_RADIAL 640 480 500 320 240 -0.1", "PINHOLE 640 480 500 400 320 240", "FOV 640 480 300 301 320 240 0.8"];
    (0..count).map(|i| format!("{} {}\n", i + 1, models[i % 3].replace("500", &format!("{}", 500 + i)))).collect()
}

fn bytes(text: &str) -> Vec<u8> {
    let cameras = crate::parse_camera("f", text.as_bytes(), &ReadOptions::default()).unwrap().cameras;
    camera_bytes(format_named("colmap-bin").unwrap(), &cameras).unwrap()
}

fn file(folder: &TempDir, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    path
}

/// All cameras of a list, `most` at a time.
fn all(list: &CameraList, most: usize) -> Vec<NamedCamera> {
    let pieces: Vec<Vec<NamedCamera>> = list.pieces(most).unwrap().collect::<Result<_, _>>().unwrap();
    assert!(pieces.iter().rev().skip(1).all(|piece| piece.len() == most));
    pieces.concat()
}

/// What a list holds in pieces is what is read whole; so is what is wrong. Returns that.
fn same(path: &Path, options: &ReadOptions) -> Option<String> {
    let whole = read_camera_with(path, options);
    match (CameraList::open(path, options), whole) {
        (Ok(Some(list)), Ok(file)) => {
            assert_eq!((list.format(), list.len()), (file.format, file.cameras.len()));
            for most in [1, 2, 7, 1000] {
                assert!(all(&list, most) == file.cameras, "{most} at a time");
            }
            None
        }
        (Err(error), Err(other)) => {
            assert_eq!(error, other);
            Some(error.to_string())
        }
        (Ok(None), Err(other)) => Some(format!("whole: {other}")),
        (Ok(None), Ok(_)) => Some("whole".to_owned()),
        (list, whole) => panic!("{:?}\n{whole:?}", list.map(|list| list.map(|list| list.len()))),
    }
}

fn said(folder: &TempDir, name: &str, bytes: impl AsRef<[u8]>) -> String {
    same(&file(folder, name, bytes), &ReadOptions::default()).expect("something is said")
}

#[test]
fn cameras_in_pieces_are_those_of_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let text = text(100);
    let commented = format!("\u{feff}# by hand\r\n\r\n{}\n# the end", text.replace('\n', "\r\n").trim_end());
    for (name, bytes) in [("a.txt", text.clone().into_bytes()), ("b.bin", bytes(&text)), ("c.txt", commented.into_bytes())] {
        assert_eq!(same(&file(&folder, name, bytes), &ReadOptions::default()), None, "{name}");
    }
    let size = |width| ReadOptions { size: Some(calibench_model::camera::ImageSize { width, height: 480 }), ..ReadOptions::default() };
    let path = folder.path().join("a.txt");
    assert_eq!(same(&path, &size(640)), None);
    assert!(same(&path, &size(641)).unwrap().contains("a.txt:1: the file says 640 x 480 px, 641 x 480 px were given"));
    // Long enough for a head that is not all of it.
    assert_eq!(same(&file(&folder, "long.txt", self::text(5000)), &ReadOptions::default()), None);
}

#[test]
fn a_list_is_written_in_pieces_as_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = file(&folder, "a.txt", text(23));
    let list = CameraList::open(&path, &ReadOptions::default()).unwrap().unwrap();
    let whole = all(&list, 23);
    for name in ["colmap", "colmap-bin", "kapture"] {
        let format = format_named(name).unwrap();
        for most in [1, 5, 23, 100] {
            let (mut writer, mut out) = ListWriter::new(format, &list).unwrap();
            list.pieces(most).unwrap().for_each(|piece| out.extend(writer.piece(&piece.unwrap()).unwrap()));
            writer.end().unwrap();
            assert!(out == camera_bytes(format, &whole).unwrap(), "{name}, {most} at a time");
        }
        let (mut writer, _) = ListWriter::new(format, &list).unwrap();
        writer.piece(&whole[..22]).unwrap();
        assert!(writer.end().unwrap_err().problem.contains("22 cameras were given; expected the 23 of the list"));
        let (mut writer, _) = ListWriter::new(format, &list).unwrap();
        writer.piece(&whole).unwrap();
        assert!(writer.piece(&whole[..1]).unwrap_err().problem.contains("24 cameras were given"));
    }
    assert!(ListWriter::new(format_named("ros").unwrap(), &list).is_err_and(|error| error.problem.contains("not written in pieces")));
}

#[test]
fn a_mistake_is_the_same_wherever_it_stands() {
    let folder = tempfile::tempdir().unwrap();
    let lines = |changed: &[(usize, &str)]| {
        let mut lines: Vec<String> = text(5000).lines().map(str::to_owned).collect();
        changed.iter().for_each(|(line, with)| lines[line - 1] = (*with).to_owned());
        lines.join("\n")
    };
    let one = "PINHOLE 640 480 500 501 320 240";
    let twice = format!("17 {one}");
    for (changed, expected) in [
        (vec![(4990, "4990 PINHOLE 640 480 500 x 320 240")], "a.txt:4990, `PARAMS[]`: expected a finite number"),
        (vec![(4990, "4990 PINHOLE 640 480 500 501 320")], "a.txt:4990, `PINHOLE`: expected 4 numbers for PINHOLE, found 3"),
        (vec![(4990, "nonsense")], "a.txt:4990: expected CAMERA_ID"),
        (vec![(4990, twice.as_str())], "a.txt:4990, `17`: the id of two cameras, first on line 17;"),
        (vec![(4000, twice.as_str()), (4990, "nonsense")], "a.txt:4000, `17`: the id of two cameras"),
        (vec![(4990, twice.as_str()), (4000, "nonsense")], "a.txt:4000: expected CAMERA_ID"),
        (vec![(4000, twice.as_str()), (4990, "3 PINHOLE 9 9 9 9 9 9")], "a.txt:4000, `17`: the id of two cameras, first on line 17;"),
        (vec![(4990, twice.as_str()), (4980, "3 PINHOLE 9 9 9 9 9 9")], "a.txt:4980, `3`: the id of two cameras, first on line 3;"),
        (vec![(4990, "4990 PINHOLE 640\0 480 500 501 320 240")], "a.txt:4990: expected text, found a zero byte"),
    ] {
        let found = said(&folder, "a.txt", lines(&changed));
        assert!(found.contains(expected), "{found}\nexpected {expected}");
    }
    let mut latin = lines(&[(4990, "# \u{e9}")]).into_bytes();
    latin.retain(|byte| *byte != 0xc3);
    assert!(said(&folder, "a.txt", latin).contains("a.txt:4990: expected text in UTF-8"));
}

#[test]
fn bytes_that_are_cut_or_changed_are_refused_as_a_whole_is() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = bytes(&text(40));
    for end in 8..bytes.len() {
        let found = said(&folder, "a.bin", &bytes[..end]);
        assert!(found.contains("a.bin, `camera ") || end < 40, "{end}: {found}");
    }
    assert!(said(&folder, "a.bin", [&bytes[..], &[0]].concat()).contains("1 bytes follow the last of 40 cameras"));
    let mut twice = bytes.clone();
    // The third camera begins after one with four numbers and one with four.
    twice[8 + 2 * (24 + 32)] = 1;
    assert!(said(&folder, "a.bin", twice).contains("`camera 3 of 40`: the id 1 is another camera's"));
    let mut big = bytes.clone();
    [0..8, 8..12, 12..16, 16..24, 24..32].into_iter().for_each(|range| big[range].reverse());
    assert!(said(&folder, "a.bin", big).contains("greatest byte first"));
}

#[test]
fn words_of_another_format_leave_the_choice_to_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let base = text(5000);
    let from = |format| ReadOptions { from: format_named(format), ..ReadOptions::default() };
    // Far beyond the head, in what is no camera.
    let path = file(&folder, "a.txt", format!("{base}# !!opencv-matrix\n"));
    let found = same(&path, &ReadOptions::default()).unwrap();
    assert!(found.starts_with("whole: ") && found.contains("may be a file of opencv-yaml or colmap"), "{found}");
    assert_eq!(same(&path, &from("colmap")), None, "the one that was asked for");
    assert!(same(&path, &from("opencv-yaml")).unwrap().starts_with("whole: "));
    // In a line that is wrong.
    let found = said(&folder, "a.txt", format!("{base}data: !!opencv-matrix\n{base}"));
    assert!(found.starts_with("whole: ") && found.contains("may be a file of opencv-yaml or colmap"), "{found}");
    // In an id, which the whole takes as it is.
    let found = said(&folder, "a.txt", format!("{base}!!opencv-matrix PINHOLE 640 480 500 501 320 240\n"));
    assert!(found.contains("may be a file of opencv-yaml or colmap"), "{found}");
    for id in ["09999", "a", "4294967296", "+7000"] {
        assert_eq!(said(&folder, "a.txt", format!("{base}{id} PINHOLE 640 480 500 501 320 240\n")), "whole", "{id}");
    }
    assert_eq!(said(&folder, "a.txt", format!("{base}# {}\n", "x".repeat(1 << 16))), "whole", "a long line");
    assert_eq!(said(&folder, "a.txt", base.clone() + &"# a comment\n".repeat(100_000)), "whole", "many comments");
    assert_eq!(said(&folder, "a.yml", "%YAML:1.0\n---\n").as_str().split(':').next(), Some("whole"));
    assert!(CameraList::open(folder.path(), &ReadOptions::default()).unwrap().is_none());
    assert!(CameraList::open(&folder.path().join("none"), &ReadOptions::default()).unwrap().is_none());
}

/// What makes a file another tool's stands in its first lines or in what is no line of COLMAP's: none of the other formats' recognisers
/// may claim more of a whole list than of what is kept of it.
#[test]
fn no_format_knows_its_files_by_cameras_of_colmap_s() {
    let head = "1 PINHOLE 640 480 500 501 320 240\n2 PINHOLE 640 480 500 501 320 240\n";
    let models = crate::colmap_models::MODELS.map(|(name, _)| name);
    let plain: String = models.iter().enumerate().map(|(i, model)| format!("{} {model} 640 480 1e5 -0.5E-3 +1 .5 7\n", i + 3)).collect();
    for comment in [
        "",
        "# !!opencv-matrix\n",
        "# LENSMODEL_OPENCV8\n",
        "# Bundle file v0.3\n",
        "# \"camera_type\" {\n",
        "# CalibrationInternConique\n",
    ] {
        let (kept, whole) = (format!("{head}{comment}"), format!("{head}{plain}{comment}"));
        for format in crate::FORMATS.iter().filter(|format| format.binary.is_none()) {
            let claims = |text: &str| (format.recognise)(&source::Source::new(text.as_bytes()).unwrap()).is_ok();
            assert_eq!(claims(&kept), claims(&whole), "{}: {comment}", format.name);
        }
    }
}

#[test]
fn a_file_beyond_the_limit_is_a_list_or_refused_with_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    let long = |name: &str, bytes: &[u8]| {
        let path = file(&folder, name, bytes);
        File::options().write(true).open(&path).unwrap().set_len(LARGEST_FILE + 1).unwrap();
        CameraList::open(&path, &ReadOptions::default()).err().expect("an error").to_string()
    };
    let found = long("a.yml", b"%YAML:1.0\n---\n");
    assert!(
        found.contains("a.yml: is larger than 64 MB; expected a camera file.") && found.contains(": it is none of these; split"),
        "{found}"
    );
    assert!(long("a.txt", text(3).as_bytes()).contains("is longer than 65536 bytes"));
    assert!(long("a.bin", &bytes(&text(3))).contains("bytes follow the last of 3 cameras"));
    let comments = long("a.txt", ("1 PINHOLE 640 480 500 501 320 240\n".to_owned() + &"# a comment\n".repeat(100_000)).as_bytes());
    assert!(comments.contains("which `camera` and `convert` read in pieces: more than 1048576 bytes of comments; split"), "{comments}");
}

/// Images whose cameras are in another order; `points` of every second one.
fn images(count: usize, cameras: usize) -> (String, Vec<u8>) {
    let (mut text, mut bytes) = (String::from("# Image list\n"), (count as u64).to_le_bytes().to_vec());
    for i in 0..count {
        let (id, camera, name) = (i as u32 + 1, (i * 7 % cameras) as u32 + 1, format!("left/a {i}.jpg"));
        let t = [i as f64, 0.5, -1.0];
        let points = if i % 2 == 0 { "" } else { "1.5 2.5 -1 3 4 -1" };
        text += &format!("{id} 0.6 0 0.8 0 {} {} {} {camera} {name}\n{points}\n", t[0], t[1], t[2]);
        bytes.extend(id.to_le_bytes());
        bytes.extend([0.6, 0.0, 0.8, 0.0, t[0], t[1], t[2]].into_iter().flat_map(f64::to_le_bytes));
        bytes.extend(camera.to_le_bytes());
        bytes.extend(name.bytes().chain([0]));
        let points = if i % 2 == 0 { 0_u64 } else { 2 };
        bytes.extend(points.to_le_bytes());
        bytes.extend(vec![0xff; 24 * points as usize]);
    }
    (text, bytes)
}

#[test]
fn images_in_pieces_are_those_of_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let (text, bytes) = images(120, 100);
    let cameras = self::text(100);
    let [images_text, images_bytes] =
        [("images.txt", text.clone().into_bytes()), ("images.bin", bytes.clone())].map(|(name, b)| file(&folder, name, b));
    let found = same(&images_text, &ReadOptions::default()).unwrap();
    assert!(found.contains("is COLMAP's list of images, whose cameras stand in"), "{found}");
    file(&folder, "cameras.txt", &cameras);
    assert_eq!([&images_text, &images_bytes].map(|path| same(path, &ReadOptions::default())), [None, None]);
    file(&folder, "cameras.bin", self::bytes(&cameras));
    assert_eq!([&images_text, &images_bytes].map(|path| same(path, &ReadOptions::default())), [None, None]);
    fs::remove_file(folder.path().join("cameras.bin")).unwrap();
    let list = CameraList::open(&images_text, &ReadOptions::default()).unwrap().unwrap();
    assert!(!list.own_numbers && all(&list, 50)[101].camera == all(&list, 120)[1].camera);
    for (from, to, expected) in [
        (" 8 left/a 1.jpg", " 101 left/a 1.jpg", "images.txt, `left/a 1.jpg`: camera 101 is not in "),
        ("0.6 0 0.8 0 99", "0.6 0 x 0 99", "images.txt:200: expected a finite number"),
        ("0.6 0 0.8 0 99", "0 0 0 0 99", "`left/a 99.jpg`: expected a quaternion"),
    ] {
        let found = said(&folder, "images.txt", text.replacen(from, to, 1));
        assert!(found.contains(expected), "{found}\nexpected {expected}");
    }
    let zero = text.replacen("0.6 0 0.8 0 99", "0.6 0 0.8\0 0 99", 1);
    assert!(said(&folder, "images.txt", zero).contains("images.txt:200: expected text, found a zero byte"));
    // A line that is wrong stands before a camera that is not there.
    let both = text.replacen(" 8 left/a 1.jpg", " 101 left/a 1.jpg", 1).replacen("0.6 0 0.8 0 99", "0.6 0 x 0 99", 1);
    assert!(said(&folder, "images.txt", both).contains("images.txt:200: "));
    for end in (44..bytes.len()).step_by(3) {
        let found = said(&folder, "images.bin", &bytes[..end]);
        assert!(found.contains("images.bin, `image ") && found.contains(" of 120`: "), "{end}: {found}");
    }
    file(&folder, "cameras.txt", cameras.replacen("2 PINHOLE 640 480", "2 PINHOLE 640 x", 1));
    assert!(said(&folder, "images.txt", text).contains("cameras.txt:2, `HEIGHT`: "));
}

#[test]
fn images_of_more_cameras_than_are_kept_have_theirs() {
    let folder = tempfile::tempdir().unwrap();
    let (text, bytes) = images(11_000, 5000);
    for (cameras, beside) in [("cameras.txt", self::text(5000).into_bytes()), ("cameras.bin", self::bytes(&self::text(5000)))] {
        file(&folder, cameras, beside);
        for (name, images) in [("images.txt", text.as_bytes()), ("images.bin", &bytes)] {
            let path = file(&folder, name, images);
            let list = CameraList::open(&path, &ReadOptions::default()).unwrap().unwrap();
            assert!(all(&list, 1000) == read_camera_with(&path, &ReadOptions::default()).unwrap().cameras, "{name} by {cameras}");
            fs::remove_file(path).unwrap();
        }
        fs::remove_file(folder.path().join(cameras)).unwrap();
    }
}

#[test]
fn lines_are_numbered_and_their_bytes_are_counted() {
    let mut lines = lines::Lines::new(&b"ab\r\ncd\n\nlast"[..]);
    let place = |lines: &lines::Lines<&[u8]>| (lines.number(), lines.at());
    assert!(matches!(lines.next(), Ok(Some("ab\r\n"))) && place(&lines) == (1, 4));
    assert!(lines.pass().is_ok() && place(&lines) == (2, 7));
    assert!(matches!(lines.next(), Ok(Some("\n"))) && place(&lines) == (3, 8));
    assert!(matches!(lines.next(), Ok(Some("last"))) && place(&lines) == (4, 12));
    assert!(matches!(lines.next(), Ok(None)));
}

#[test]
fn images_keep_their_numbers_where_these_are_names() {
    let folder = tempfile::tempdir().unwrap();
    file(&folder, "cameras.txt", text(3));
    let list = |names: [&str; 3]| {
        let line = |(i, name): (usize, &&str)| format!("{} 1 0 0 0 0 0 {i} 2 {name}\n\n", i + 1);
        let path = file(&folder, "images.txt", names.iter().enumerate().map(line).collect::<String>());
        let list = CameraList::open(&path, &ReadOptions::default()).unwrap().unwrap();
        let format = format_named("colmap").unwrap();
        let (mut writer, mut out) = ListWriter::new(format, &list).unwrap();
        list.pieces(2).unwrap().for_each(|piece| out.extend(writer.piece(&piece.unwrap()).unwrap()));
        assert_eq!(out, camera_bytes(format, &all(&list, 3)).unwrap());
        let text = String::from_utf8(out).unwrap();
        text.lines().filter(|line| !line.starts_with('#')).map(|line| line.split(' ').next().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(list(["30", "10", "20"]), ["30", "10", "20"]);
    assert_eq!(list(["30", "10", "30"]), ["1", "2", "3"]);
    assert_eq!(list(["30", "10", "a"]), ["1", "2", "3"]);
}

#[test]
fn a_list_that_changes_between_both_looks_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (after, expected) in [
        (text(9), "it has fewer cameras than the 10 that it had"),
        (text(11), "it has more cameras than the 10 that it had"),
        (text(4) + "x\n", "a.txt:5: expected CAMERA_ID"),
    ] {
        let path = file(&folder, "a.txt", text(10));
        let list = CameraList::open(&path, &ReadOptions::default()).unwrap().unwrap();
        fs::write(&path, after).unwrap();
        for most in [1, 3, 100] {
            let found: Vec<_> = list.pieces(most).unwrap().collect();
            let error = found.into_iter().find_map(Result::err).unwrap().to_string();
            assert!(error.contains("a.txt") && error.contains(expected), "{error}");
        }
    }
}
