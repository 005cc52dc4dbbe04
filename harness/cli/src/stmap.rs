//! `calibench stmap`: a camera's distortion as maps for compositing programs.

use std::path::PathBuf;

use calibench_cameras::inputs_of;
use calibench_images::st_map::{Check, Direction, MapFile, Overscan, Pinhole, StMap, Undistorted, check, encode};
use calibench_model::camera::ImageSize;
use calibench_model::{NamedCamera, PixelPoint};
use calibench_report::plain;
use clap::Args;

use super::convert::size_of;
use super::output;
use super::reading::{Reading, shown};
use crate::deliver::print;
use crate::failure::Failure;

#[derive(Args)]
pub struct StMapCommand {
    /// A camera file of any known format
    file: PathBuf,
    /// The map: .exr (floats of 32 bits), .tif or .png (16 bits)
    #[arg(short, long, value_name = "FILE", required_unless_present = "check")]
    output: Option<PathBuf>,
    /// Map the frame's pixels into the undistorted picture, to bring distortion back; without it the undistorted picture's pixels into the frame
    #[arg(long)]
    redistort: bool,
    /// How much larger the undistorted picture is than the frame: percent, or `auto` for as much as holds the whole frame
    #[arg(long, value_name = "PERCENT|auto", default_value = "0", value_parser = overscan)]
    overscan: Overscan,
    /// Count t from the top, as OpenCV and game engines do; without it from the bottom, as Nuke and Blender do
    #[arg(long)]
    from_top: bool,
    /// Floats of 32 bits in a TIFF
    #[arg(long)]
    float: bool,
    /// Compare a map that another program made with that of the camera, and write none
    #[arg(long, value_name = "FILE", conflicts_with_all = ["output", "float"])]
    check: Option<PathBuf>,
    #[command(flatten)]
    reading: Reading,
}

impl StMapCommand {
    pub fn run(&self) -> Result<(), Failure> {
        let inputs = inputs_of([&self.file].into_iter().chain(&self.check));
        let output = self.output.as_deref().map(|path| output::map("-o", path, &inputs)).transpose()?;
        let kind = output.as_ref().map(|output| {
            // What is no regular file has any ending.
            let stream = (!output.is_file()).then_some(MapFile::Exr);
            let kind = MapFile::of(output.path(), self.float).or(stream);
            kind.ok_or_else(|| Failure::input("--float: a PNG holds 16 bits; name a .tif or a .exr"))
        });
        let kind = kind.transpose()?;
        let NamedCamera { camera, .. } = self.reading.one(&self.file)?;
        let picture = Undistorted::of(&camera, self.overscan).map_err(|error| Failure::input(format!("{}: {error}", shown(&self.file))))?;
        let direction = if self.redistort { Direction::Redistort } else { Direction::Undistort };
        if let Some(path) = &self.check {
            let found = check(path, &camera, &picture, direction, self.from_top)?;
            return print(&compared(&found, direction));
        }
        let (Some(output), Some(kind)) = (output, kind) else { return Err(Failure::input("-o names the map to write")) };
        let map = StMap::new(&camera, &picture, direction, self.from_top);
        let bytes = encode(&map, kind)?;
        output.write(|file| file.write_all(&bytes))?;
        describe(&picture, &map, kind);
        let whole = Undistorted::of(&camera, Overscan::All).ok();
        let larger = |whole: Undistorted| whole.surplus[0] > picture.surplus[0] || whole.surplus[1] > picture.surplus[1];
        if whole.is_none_or(larger) {
            let share = if self.redistort { format!("{:.2} %", 100.0 * (1.0 - map.covered())) } else { "a part".to_owned() };
            let help = if whole.is_some() { "--overscan auto holds all" } else { "no picture in a plane holds all" };
            say!("warning: {share} of the frame lies outside of the undistorted picture: {help}");
        }
        Ok(())
    }
}

fn describe(picture: &Undistorted, map: &StMap, kind: MapFile) {
    let Undistorted { size, focal: [fx, fy], principal, surplus: [columns, rows] } = picture;
    let (width, height, PixelPoint { x, y }) = (size.width, size.height, principal);
    say!("undistorted picture: {width} x {height} px, {columns} columns and {rows} rows more on each side than the frame");
    say!("its pinhole camera: focal lengths {fx:.6}, {fy:.6} px, axis at ({x:.6}, {y:.6}) from the centre of the first pixel");
    let ImageSize { width, height } = map.size;
    say!("map: {width} x {height} px, places rounded to {} px of the source", plain(kind.rounding(map.source)));
}

fn compared(found: &Check, direction: Direction) -> String {
    let Check { pixels, as_it_is, remaining, pinhole: Pinhole { focal: [fx, fy], principal } } = found;
    let of = if direction == Direction::Undistort { "frame" } else { "undistorted picture" };
    let mut text = format!("pixels      {pixels} that both maps place\n");
    match as_it_is {
        Some(spread) => text.push_str(&format!("difference  {}, in the {of}\n", size_of(spread))),
        None => text.push_str("difference  not comparable as it is: another size; --overscan may name it\n"),
    }
    text.push_str(&format!("remaining   {}, in the undistorted picture, with its best pinhole camera\n", size_of(remaining)));
    text.push_str(&format!("            focal lengths {fx:.6}, {fy:.6} px, axis at ({:.6}, {:.6})\n", principal.x, principal.y));
    if *fy < 0.0 || *fx < 0.0 {
        text.push_str("            a negative focal length: t is counted the other way, see --from-top\n");
    }
    text
}

/// `auto`, or percent from 0.
fn overscan(text: &str) -> Result<Overscan, String> {
    if text == "auto" {
        return Ok(Overscan::All);
    }
    let percent =
        text.trim_end_matches('%').trim().parse::<f64>().ok().filter(|percent| percent.is_finite() && (0.0..=1000.0).contains(percent));
    percent.map(Overscan::Percent).ok_or_else(|| "expected `auto` or percent from 0 to 1000".into())
}
