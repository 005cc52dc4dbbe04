//! All readers of files, each as a function of bytes.

use std::path::Path;

use calibench_cameras::{CameraList, ListWriter, ReadOptions, camera_bytes, format_named, parse_camera, read_camera_with};
use calibench_exchange::control::{parse_control, write_control};
use calibench_exchange::lengths::parse_lengths;
use calibench_exchange::points::parse_points;
use calibench_exchange::stations::{parse_observed_stations, parse_stations};
use calibench_exchange::write_points;
use calibench_gate::{Ceilings, Cells, FigureSums, Kept, PointSums, Verdicts, read_baseline};
use calibench_images::photo::parse_photo;
use calibench_measure::Registry;
use calibench_model::camera::ImageSize;
use calibench_records::judgement::read_rows;
use calibench_records::points::read_records;

/// The file's name in errors.
pub const FILE: &str = "the-file";

/// A reader, and the folder of its seeds.
pub struct Reader {
    /// Its name, by which it is asked for alone.
    pub name: &'static str,
    /// Below `seeds/`.
    pub seeds: &'static str,
    /// Reads the bytes, in `folder` where it takes a path; an error in words. It panics where what was read cannot be written and read again.
    pub read: fn(&[u8], &Path) -> Result<(), String>,
}

/// All of them.
pub const READERS: [Reader; 18] = [
    Reader { name: "cameras", seeds: "cameras", read: camera },
    Reader { name: "cameras-sized", seeds: "cameras", read: camera_of_size },
    Reader { name: "camera-lists", seeds: "camera-lists", read: camera_list },
    Reader { name: "points", seeds: "points", read: points },
    Reader { name: "control", seeds: "control", read: control },
    Reader { name: "lengths", seeds: "lengths", read: |bytes, _| words(parse_lengths(FILE, bytes)) },
    Reader { name: "stations", seeds: "stations", read: |bytes, _| words(parse_stations(FILE, bytes)) },
    Reader { name: "observed-stations", seeds: "stations", read: |bytes, _| words(parse_observed_stations(FILE, bytes)) },
    Reader { name: "scenarios", seeds: "scenarios", read: scenario },
    Reader { name: "records", seeds: "records", read: |bytes, _| words(read_records(bytes, |_, _| ())) },
    Reader { name: "adjustments", seeds: "adjustments", read: |bytes, _| words(calibench_records::adjustments::read(bytes, |_| ())) },
    Reader { name: "judgements", seeds: "judgements", read: |bytes, _| words(read_rows(bytes)) },
    Reader { name: "baselines", seeds: "baselines", read: baseline },
    Reader { name: "baselines-sums", seeds: "baselines", read: cells::<PointSums> },
    Reader { name: "baselines-figures", seeds: "baselines", read: cells::<FigureSums> },
    Reader { name: "baselines-verdicts", seeds: "baselines", read: |bytes, folder| words(Verdicts::read(&file(bytes, folder))) },
    Reader { name: "ceilings", seeds: "baselines", read: |bytes, _| text(bytes).and_then(|text| words(Ceilings::parse(FILE, text))) },
    Reader { name: "photographs", seeds: "photographs", read: |bytes, _| words(parse_photo(Path::new(FILE), bytes)) },
];

const SIZE: ImageSize = ImageSize { width: 640, height: 480 };

fn words<T, E: std::fmt::Display>(result: Result<T, E>) -> Result<(), String> {
    result.map(drop).map_err(|error| error.to_string())
}

fn text(bytes: &[u8]) -> Result<&str, String> {
    std::str::from_utf8(bytes).map_err(|_| format!("{FILE}: expected UTF-8 text"))
}

fn file(bytes: &[u8], folder: &Path) -> std::path::PathBuf {
    let path = folder.join(FILE);
    std::fs::write(&path, bytes).expect("a file");
    path
}

/// The scenario that a baseline says it is of.
fn named(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    let name = text.lines().find_map(|line| line.strip_prefix("# scenario = \"")?.strip_suffix('"'));
    name.unwrap_or_default().to_owned()
}

fn baseline(bytes: &[u8], folder: &Path) -> Result<(), String> {
    words(read_baseline(&file(bytes, folder), &named(bytes)))
}

fn cells<T: Kept>(bytes: &[u8], folder: &Path) -> Result<(), String> {
    words(Cells::<T>::read(&file(bytes, folder), &named(bytes)))
}

fn camera(bytes: &[u8], _: &Path) -> Result<(), String> {
    read_camera(bytes, &ReadOptions::default())
}

fn camera_of_size(bytes: &[u8], _: &Path) -> Result<(), String> {
    read_camera(bytes, &ReadOptions { size: Some(SIZE), fisheye: Some(true), ..ReadOptions::default() })
}

/// What a format reads it writes and reads again, or says why not.
fn read_camera(bytes: &[u8], options: &ReadOptions) -> Result<(), String> {
    let found = parse_camera(FILE, bytes, options).map_err(|error| error.to_string())?;
    if let Ok(bytes) = camera_bytes(found.format, &found.cameras) {
        let size = calibench_model::camera::CameraModel::size(&found.cameras[0].camera);
        let own = ReadOptions { fisheye: options.fisheye, ..ReadOptions::of_written(found.format, size) };
        let again = parse_camera(FILE, &bytes, &own);
        assert!(again.is_ok_and(|again| again.cameras.len() == found.cameras.len()), "{}", String::from_utf8_lossy(&bytes));
    }
    assert!(format_named(found.format.name).is_some());
    Ok(())
}

/// A list in pieces holds the cameras of the whole, its mistake, and what it writes.
fn camera_list(bytes: &[u8], folder: &Path) -> Result<(), String> {
    let path = file(bytes, folder);
    std::fs::write(folder.join("cameras.txt"), "1 PINHOLE 640 480 500 501 320 240\n7 FOV 640 480 500 501 320 240 0.8\n").expect("a file");
    let options = ReadOptions::default();
    let whole = read_camera_with(&path, &options);
    let list = match CameraList::open(&path, &options) {
        Ok(Some(list)) => list,
        Ok(None) => return words(whole),
        Err(error) => {
            // What is no text is so before any of its lines is wrong.
            assert!(whole.is_err() && (std::str::from_utf8(bytes).is_err() || whole == Err(error.clone())), "{whole:?}\nin pieces {error}");
            return Err(error.to_string());
        }
    };
    let whole = whole.unwrap_or_else(|error| panic!("right in pieces: {error}"));
    let pieces: Vec<_> = list.pieces(2).and_then(Iterator::collect).unwrap_or_else(|error| panic!("right at first: {error}"));
    assert!(pieces.concat() == whole.cameras && list.format() == whole.format, "other cameras in pieces");
    for format in ["colmap", "colmap-bin", "kapture"].map(|name| format_named(name).expect("a format")) {
        let (mut writer, mut out) = ListWriter::new(format, &list).expect("a list");
        let written = pieces.iter().try_for_each(|piece| writer.piece(piece).map(|bytes| out.extend(bytes)));
        match camera_bytes(format, &whole.cameras) {
            Ok(bytes) => assert!(written.is_ok() && out == bytes, "{}: other bytes in pieces", format.name),
            Err(error) => assert!(written.is_err(), "{}: {error}", format.name),
        }
    }
    Ok(())
}

fn points(bytes: &[u8], _: &Path) -> Result<(), String> {
    let found = parse_points(FILE, bytes).map_err(|error| error.to_string())?;
    if !found.points.is_empty() {
        let mut text = Vec::new();
        write_points(&mut text, found.points.rows()).expect("a Vec takes all");
        let again = parse_points(FILE, &text[..]).unwrap_or_else(|error| panic!("{error}\n{}", String::from_utf8_lossy(&text)));
        let seen = |points: &calibench_model::Points| {
            points.rows().map(|row| (row.image.to_owned(), row.target.to_owned(), row.start.position)).collect::<Vec<_>>()
        };
        assert_eq!(seen(&again.points), seen(&found.points));
    }
    Ok(())
}

fn control(bytes: &[u8], _: &Path) -> Result<(), String> {
    let rows = parse_control(FILE, bytes).map_err(|error| error.to_string())?;
    let mut text = Vec::new();
    write_control(&mut text, &rows).expect("a Vec takes all");
    assert_eq!(parse_control(FILE, &text[..]).unwrap_or_else(|error| panic!("{error}")), rows);
    Ok(())
}

fn scenario(bytes: &[u8], folder: &Path) -> Result<(), String> {
    let path = folder.join(FILE);
    words(calibench_scenario::parse("f/s", &path.display().to_string(), text(bytes)?, &Registry::builtin()))
}
