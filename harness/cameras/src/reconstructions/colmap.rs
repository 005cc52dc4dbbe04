//! COLMAP's models: cameras, images and points3D in a folder, as bytes or as text. The corner of the first pixel is (0, 0).

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use calibench_model::camera::ImageSize;
use calibench_model::reconstruction::{OrientedImage, ReconstructedCamera, TiePoint, TieSight};
use calibench_model::{CornerPoint, Reconstruction};
use nalgebra::Point3;

use super::{LARGEST, ReconstructionFile, colmap_rigs, lens, oriented, place, text_of};
use crate::colmap_images::{self, Image, head_in_bytes, in_text, lines_with_points, of_image};
use crate::formats::{colmap, colmap_bin};
use crate::little_endian::Bytes;
use crate::number::{finite, shortened};
use crate::source::{self, Source};
use crate::{CameraFileError, ReadOptions, colmap_models};

const PARTS: [&str; 3] = ["cameras", "images", "points3D"];

/// The folder that holds a model: `path` itself, or that of a part of a model.
pub(super) fn folder(path: &Path) -> Option<PathBuf> {
    if path.is_dir() {
        return Some(path.to_owned());
    }
    let is_part = path.file_stem().and_then(|stem| stem.to_str()).is_some_and(|stem| PARTS.contains(&stem));
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    (is_part && matches!(ending, "bin" | "txt")).then(|| path.parent().map_or_else(PathBuf::new, Path::to_owned))
}

/// A part of a model, as bytes if it is there so, as COLMAP itself prefers.
fn part(folder: &Path, name: &str) -> Result<(PathBuf, Vec<u8>, bool), CameraFileError> {
    let missing = || {
        let problem = format!("holds neither {name}.bin nor {name}.txt; expected a model of COLMAP: cameras, images and points3D");
        CameraFileError::new(problem).in_file(&folder.display().to_string())
    };
    let (path, is_binary) = place(folder, name).ok_or_else(missing)?;
    let bytes = source::read_up_to(&path, LARGEST).map_err(|error| error.in_file(&path.display().to_string()))?;
    Ok((path, bytes, is_binary))
}

/// `read` of a part, whose name goes into errors.
fn parsed<T>(folder: &Path, name: &str, read: impl FnOnce(&[u8], bool) -> Result<T, CameraFileError>) -> Result<T, CameraFileError> {
    let (path, bytes, is_binary) = part(folder, name)?;
    read(&bytes, is_binary).map_err(|error| error.in_file(&path.display().to_string()))
}

pub(super) fn read(folder: &Path, size: Option<ImageSize>) -> Result<ReconstructionFile, CameraFileError> {
    let options = ReadOptions { size, ..ReadOptions::default() };
    let cameras = parsed(folder, PARTS[0], |bytes, is_binary| cameras(bytes, is_binary, &options))?;
    let (points, places) = parsed(folder, PARTS[2], points)?;
    let mut out = Reconstruction { cameras, points, ..Reconstruction::default() };
    let by_id: HashMap<String, usize> = out.cameras.iter().enumerate().map(|(place, camera)| (camera.named.name.clone(), place)).collect();
    let mut unknown = 0;
    parsed(folder, PARTS[1], |bytes, is_binary| {
        let mut take = |image: Image, seen: Vec<Seen>| {
            let missing =
                || CameraFileError::new(format!("camera {} is not in the list of cameras", image.camera)).of(shortened(&image.name));
            let camera = *by_id.get(&image.camera.to_string()).ok_or_else(missing)?;
            let pose = image.pose().map_err(|error| error.of(shortened(&image.name)))?;
            let index = out.images.len();
            out.images.push(OrientedImage { name: image.name, camera, pose: oriented(&pose) });
            for ([x, y], id) in seen {
                match places.get(&id) {
                    Some(&point) => out.sights.push(TieSight { image: index, point, position: CornerPoint { x, y }.to_pixel() }),
                    None => unknown += 1,
                }
            }
            Ok(())
        };
        out_of(bytes, is_binary, &mut take)
    })?;
    let ids: HashMap<u32, usize> = by_id.iter().filter_map(|(id, place)| Some((id.parse().ok()?, *place))).collect();
    let mut rigs = Vec::new();
    match colmap_rigs::read(folder) {
        Ok(found) => {
            let known = |rig: Vec<u32>| rig.into_iter().filter_map(|id| ids.get(&id).copied()).collect::<Vec<_>>();
            rigs = found.into_iter().map(known).filter(|rig| rig.len() > 1).collect();
        }
        // Nothing that is adjusted stands there.
        Err(error) => out.notes.push(format!("{error}: whether cameras are a rig is not known")),
    }
    if unknown > 0 {
        out.notes.push(format!("{unknown} image points were left out, whose points are not in points3D"));
    }
    Ok(ReconstructionFile { tool: "COLMAP", reconstruction: out, rigs })
}

fn cameras(bytes: &[u8], is_binary: bool, options: &ReadOptions) -> Result<Vec<ReconstructedCamera>, CameraFileError> {
    if !is_binary {
        let source = Source::new(bytes)?;
        let lines = source.lines().filter(|(_, line)| !line.starts_with('#'));
        let one = |(line, text): (usize, &str)| {
            let named = colmap::camera(text, options).map_err(|error| error.on_line(line))?;
            Ok(lens::colmap(named, text.split_whitespace().nth(1).unwrap_or_default()))
        };
        return lines.map(one).collect();
    }
    colmap_bin::has_least_byte_first(bytes)?;
    let (mut records, mut cameras) = (colmap_bin::Records::new(Bytes::new(bytes))?, Vec::new());
    loop {
        let at = records.at() as usize;
        let Some(named) = records.next(options)? else { return Ok(cameras) };
        let number = bytes.get(at + 4..at + 8).and_then(|four| four.first_chunk()).map_or(0, |four| i32::from_le_bytes(*four));
        let model = colmap_models::MODELS.get(number as usize).map_or("", |(name, _)| *name);
        cameras.push(lens::colmap(named, model));
    }
}

/// Points, and their places by COLMAP's numbers.
type PlacedPoints = (Vec<TiePoint>, HashMap<u64, usize>);

fn points(bytes: &[u8], is_binary: bool) -> Result<PlacedPoints, CameraFileError> {
    let (mut points, mut places) = (Vec::new(), HashMap::new());
    let mut take = |id: u64, position: [f64; 3]| {
        if places.insert(id, points.len()).is_some() {
            return Err(CameraFileError::new(format!("point {id} stands twice; expected each once")));
        }
        points.push(TiePoint { name: id.to_string(), position: Point3::from(position) });
        Ok(())
    };
    if is_binary {
        let mut rest = Bytes::new(bytes);
        let count = rest.u64()?;
        for index in 1..=count {
            let mut one = || {
                let (id, position) = (rest.u64()?, [rest.f64()?, rest.f64()?, rest.f64()?]);
                // Three bytes of colour and the error; then pairs of image and place in it.
                rest.pass(11)?;
                let track = rest.u64()?;
                rest.pass(track.saturating_mul(8))?;
                take(id, position)
            };
            one().map_err(|error| error.of(format!("point {index} of {count}")))?;
        }
        return Ok((points, places));
    }
    let text = text_of(bytes)?;
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#')) {
        let at = |error: CameraFileError| error.on_line(index + 1);
        let mut words = line.split_whitespace();
        let mut word = || words.next().ok_or_else(|| CameraFileError::new("expected POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[]"));
        let id = word().map_err(at)?;
        let id = id
            .parse()
            .map_err(|_| at(CameraFileError::new(format!("expected a whole number, found `{}`", shortened(id))).of("POINT3D_ID")))?;
        let mut number = || word().and_then(finite).map_err(at);
        let position = [number()?, number()?, number()?];
        take(id, position).map_err(at)?;
    }
    Ok((points, places))
}

/// An image point, from the corner of the first pixel, and the number of its object point.
type Seen = ([f64; 2], u64);

/// Images, and of each the image points that have an object point.
fn out_of(
    bytes: &[u8],
    is_binary: bool,
    take: &mut impl FnMut(Image, Vec<Seen>) -> Result<(), CameraFileError>,
) -> Result<(), CameraFileError> {
    if !is_binary {
        for (line, image, points) in lines_with_points(text_of(bytes)?) {
            let image = in_text(image).map_err(|error| error.on_line(line))?;
            let seen = seen_in_text(points).map_err(|error| error.on_line(line + 1))?;
            take(image, seen).map_err(|error| error.on_line(line))?;
        }
        return Ok(());
    }
    if !colmap_images::are_in_bytes(bytes) {
        return Err(CameraFileError::new("expected a count of images, their rotations and places"));
    }
    let mut rest = Bytes::new(bytes);
    let count = rest.u64()?;
    for index in 1..=count {
        let mut one = || {
            let (image, points) = head_in_bytes(&mut rest)?;
            let mut seen = Vec::new();
            for _ in 0..points {
                let (at, id) = ([rest.f64()?, rest.f64()?], rest.u64()?);
                if id != u64::MAX {
                    seen.push((at, id));
                }
            }
            take(image, seen)
        };
        one().map_err(|error| of_image(index, count, error))?;
    }
    Ok(())
}

fn seen_in_text(line: &str) -> Result<Vec<Seen>, CameraFileError> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let (triples, rest) = words.as_chunks::<3>();
    if !rest.is_empty() {
        return Err(CameraFileError::new(format!("expected X, Y, POINT3D_ID of each point, found {} words", words.len())).of("POINTS2D[]"));
    }
    let mut seen = Vec::new();
    for [x, y, id] in triples {
        if *id == "-1" {
            continue;
        }
        let id =
            id.parse().map_err(|_| CameraFileError::new(format!("expected a whole number, found `{}`", shortened(id))).of("POINT3D_ID"))?;
        seen.push(([finite(x)?, finite(y)?], id));
    }
    Ok(seen)
}
