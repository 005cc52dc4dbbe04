//! The parts of photographs where residuals are longest, enlarged.

use std::collections::BTreeMap;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use calibench_adjust::Use;
use calibench_images::{Reading, read_photo_as};
use calibench_model::{Image, PixelPoint};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use rayon::prelude::*;

use super::Corner;
use crate::markup::escaped;
use crate::plain;

/// A photograph by the name of its image, and how it was read.
pub type Pictured<'a> = (&'a str, &'a Path, Reading);

/// Columns and rows of an enlarged part, px: odd, so that one is in the middle.
const SIDE: i64 = 31;

/// The enlarged parts of the corners that have a key, by their keys. A photograph that cannot be read any more has none.
pub(crate) fn patches(corners: &[Corner<'_>], photos: &[Pictured<'_>]) -> Vec<(usize, String)> {
    let mut by_image: BTreeMap<usize, Vec<(usize, &Corner<'_>)>> = BTreeMap::new();
    for corner in corners {
        corner.key.into_iter().for_each(|key| by_image.entry(corner.image).or_default().push((key, corner)));
    }
    let one = |wanted: Vec<(usize, &Corner<'_>)>| {
        let name = wanted[0].1.name;
        let Some((_, path, reading)) = photos.iter().find(|(photo, ..)| *photo == name) else { return Vec::new() };
        let Ok(photo) = read_photo_as(path, *reading) else { return Vec::new() };
        wanted.iter().map(|(key, corner)| (*key, figure(&photo.image, corner))).collect()
    };
    let mut all: Vec<(usize, String)> = by_image.into_values().collect::<Vec<_>>().into_par_iter().flat_map_iter(one).collect();
    all.sort_by_key(|(key, _)| *key);
    all
}

fn figure(image: &Image<'_>, corner: &Corner<'_>) -> String {
    let at = corner.at;
    let (left, top) = (at.x.round() as i64 - SIDE / 2, at.y.round() as i64 - SIDE / 2);
    let adjusted = corner.v.map(|[vx, vy]| PixelPoint::new(at.x + vx, at.y + vy));
    let place = |point: PixelPoint| (point.x - left as f64 + 0.5, point.y - top as f64 + 0.5);
    let cross = |point: PixelPoint, class: &str, shape: &str| {
        let (x, y) = place(point);
        format!("<path class=\"mark {class}\" transform=\"translate({x:.3} {y:.3})\" d=\"{shape}\"/>")
    };
    let measured = cross(at, "s0", "M-1.5 -1.5L1.5 1.5M-1.5 1.5L1.5 -1.5");
    let adjusted = adjusted.map_or(String::new(), |point| cross(point, "s1", "M-1.2 0a1.2 1.2 0 1 0 2.4 0a1.2 1.2 0 1 0 -2.4 0"));
    let length = corner.v.map_or(String::new(), |[x, y]| format!(", {} px", plain(x.hypot(y))));
    let used = if corner.used == Use::LeftOut { ", left out" } else { "" };
    format!(
        "<svg viewBox=\"0 0 {SIDE} {SIDE}\" role=\"img\" aria-label=\"the image around the point\"><image width=\"{SIDE}\" height=\"{SIDE}\" href=\"data:image/png;base64,{}\"/>\
         {adjusted}{measured}</svg><figcaption>{}: {}{length}{used}. Cross: measured; circle: where the adjusted point is pictured.</figcaption>",
        STANDARD.encode(png(image, (left, top))),
        escaped(corner.name),
        escaped(&corner.target),
    )
}

/// A part of an image, stretched from its darkest to its lightest pixel; what is outside of it is grey.
fn png(image: &Image<'_>, (left, top): (i64, i64)) -> Vec<u8> {
    let places = (0..SIDE * SIDE).map(|k| (left + k % SIDE, top + k / SIDE));
    let greys: Vec<Option<f32>> = places.map(|(x, y)| image.holds(x, y, 0).then(|| image.at(x as usize, y as usize))).collect();
    let (low, high) =
        greys.iter().flatten().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), grey| (low.min(*grey), high.max(*grey)));
    let level = |grey: &Option<f32>| grey.map_or(128, |grey| (255.0 * (grey - low) / (high - low).max(1e-6)).round() as u8);
    let pixels: Vec<u8> = greys.iter().map(level).collect();
    let mut out = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut out, CompressionType::Default, FilterType::Adaptive);
    // Writing to memory cannot fail; the size is that of the pixels.
    let _ = encoder.write_image(&pixels, SIDE as u32, SIDE as u32, ExtendedColorType::L8);
    out
}
