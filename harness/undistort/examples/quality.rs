//! What undistorting a picture costs those who measure in it, by kernel and blur, as a table of Markdown: the table of docs/undistort.md.
//!
//! A chessboard of 14 x 10 corners is drawn as a distorted camera pictures it, without noise. Corners are measured in that photograph and the points
//! undistorted; and they are measured in the undistorted picture that each kernel makes of the photograph, of single precision, and once of 8 bits.

use std::error::Error;

use calibench_measure::{Operator, Registry};
use calibench_model::camera::{Camera, ImageSize, OpenCv};
use calibench_model::{Image, PixelPoint, Polygon, Scene, Start};
use calibench_synth::optics::Optics;
use calibench_synth::raster::{Picture as Drawn, Renderer};
use calibench_undistort::{Frame, Kernel, Level, Map, Picture, Target, View, framed, resample};

const SIZE: ImageSize = ImageSize { width: 1000, height: 760 };
const CORNERS: [usize; 2] = [14, 10];
const SQUARE: f64 = 60.3;
const BLURS: [f64; 5] = [0.5, 0.7, 1.0, 1.5, 2.0];
const METHODS: [&str; 3] = ["parametric_corner", "forstner:window=11", "saddle"];
/// Points along a square's side.
const PIECES: usize = 60;

fn main() -> Result<(), Box<dyn Error>> {
    let mut distortion = [0.0; 14];
    distortion[..4].copy_from_slice(&[-0.22, 0.06, 0.0006, -0.0004]);
    let camera: Camera = OpenCv { size: SIZE, fx: 800.0, fy: 800.0, cx: 492.3, cy: 384.1, distortion, coefficients: 5 }.into();
    let (from, to) = (View::Camera(camera), framed(&View::Camera(camera), Target::Pinhole, Frame::Keep, 1.0)?);
    let map = Map::between(&from, &to);
    for name in METHODS {
        println!("\n| `{name}` | {} |", BLURS.map(|blur| format!("{blur} px")).join(" | "));
        println!("|---{}|", "|---".repeat(BLURS.len()));
        let operator = Registry::builtin().parse(name)?.operator?;
        let mut rows: Vec<(String, Vec<String>)> = Vec::new();
        for blur in BLURS {
            for (i, (label, cell)) in column(&*operator, (&from, &to, &map), blur)?.into_iter().enumerate() {
                if rows.len() <= i {
                    rows.push((label, Vec::new()));
                }
                rows[i].1.push(cell);
            }
        }
        rows.iter().for_each(|(label, cells)| println!("| {label} | {} |", cells.join(" | ")));
    }
    Ok(())
}

/// What is found at one blur: by row a label, and a figure.
fn column(operator: &dyn Operator, (from, to, map): (&View, &View, &Map), blur: f64) -> Result<Vec<(String, String)>, Box<dyn Error>> {
    let scene = scene(from, to);
    let optics = Optics { blur, ..Optics::default() };
    let photograph = Renderer::new(&optics, SIZE.width as usize, SIZE.height as usize)?.render(&Drawn::from(&scene), &[]);
    let truth: Vec<PixelPoint> = corners().collect();
    // In the photograph, then undistorted.
    let by_points: Vec<Option<PixelPoint>> = truth
        .iter()
        .map(|at| {
            let start = to.place_in(from, *at)?;
            let found = operator.measure(&photograph, &near(start)).ok()?;
            from.place_in(to, found.position)
        })
        .collect();
    let against = |found: &[Option<PixelPoint>], other: &[Option<PixelPoint>]| rms(found, other);
    let truths: Vec<Option<PixelPoint>> = truth.iter().copied().map(Some).collect();
    let mut rows = vec![("points undistorted, error".to_owned(), against(&by_points, &truths))];
    let in_picture = |picture: &Image| -> Vec<Option<PixelPoint>> {
        truth.iter().map(|at| operator.measure(picture, &near(*at)).ok().map(|found| found.position)).collect()
    };
    for kernel in Kernel::ALL.into_iter().filter(|kernel| *kernel != Kernel::Area) {
        let picture = made::<f32>(map, kernel, photograph.grey())?;
        rows.push((format!("{kernel}, difference"), against(&in_picture(&grey(&picture, 1.0)), &by_points)));
    }
    let bytes = made::<u8>(map, Kernel::Spline, &photograph.to_u8())?;
    let bytes: Vec<f32> = bytes.iter().map(|level| f32::from(*level)).collect();
    rows.push(("spline of 8 bits, difference".into(), against(&in_picture(&grey(&bytes, 255.0)), &by_points)));
    let spline = made::<f32>(map, Kernel::Spline, photograph.grey())?;
    rows.push(("spline, error".into(), against(&in_picture(&grey(&spline, 1.0)), &truths)));
    Ok(rows)
}

fn made<T: Level>(map: &Map, kernel: Kernel, levels: &[T]) -> Result<Vec<T>, Box<dyn Error>> {
    let mut picture = vec![T::default(); levels.len()];
    resample(map, kernel, &Picture::new(SIZE, 1, 0, levels)?, 0..SIZE.height as usize, &mut picture)?;
    Ok(picture)
}

fn grey(levels: &[f32], top: f32) -> Image<'static> {
    Image::new(SIZE.width as usize, SIZE.height as usize, levels.iter().map(|level| level / top).collect())
}

/// A start that is off, by less than a pixel.
fn near(at: PixelPoint) -> Start {
    Start::at(PixelPoint::new(at.x.round(), at.y.round()))
}

/// The corners in the undistorted picture.
fn corners() -> impl Iterator<Item = PixelPoint> {
    let place = |i: usize| PixelPoint::new(108.37 + SQUARE * (i % CORNERS[0]) as f64, 110.81 + SQUARE * (i / CORNERS[0]) as f64);
    // Turned a little, so that corners lie everywhere between pixels.
    (0..CORNERS[0] * CORNERS[1]).map(place).map(|at| {
        let (x, y) = (at.x - 492.3, at.y - 384.1);
        PixelPoint::new(492.3 + 0.9985 * x - 0.0542 * y, 384.1 + 0.0542 * x + 0.9985 * y)
    })
}

/// The dark squares as they stand in the photograph, their sides in pieces that are straight.
fn scene(from: &View, to: &View) -> Scene {
    let all: Vec<PixelPoint> = corners().collect();
    let at = |column: usize, row: usize| all[row * CORNERS[0] + column];
    let square = |column: usize, row: usize| {
        let around = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(x, y)| at(column + x, row + y));
        let side = |i: usize| (around[i], around[(i + 1) % 4]);
        let piece = |(a, b): (PixelPoint, PixelPoint), i: usize| {
            let share = i as f64 / PIECES as f64;
            PixelPoint::new(a.x + share * (b.x - a.x), a.y + share * (b.y - a.y))
        };
        let vertices = (0..4).flat_map(|s| (0..PIECES).map(move |i| piece(side(s), i))).filter_map(|at| to.place_in(from, at)).collect();
        Polygon { id: format!("{column}-{row}"), vertices, grey: 0.15 }
    };
    let squares = (0..CORNERS[1] - 1).flat_map(|row| (0..CORNERS[0] - 1).map(move |column| (column, row)));
    let dark = squares.filter(|(column, row)| (column + row) % 2 == 0).map(|(column, row)| square(column, row)).collect();
    Scene { width: SIZE.width as usize, height: SIZE.height as usize, background: 0.85, polygons: dark, targets: Vec::new() }
}

/// The root mean square distance (2D) of points that both have, px, within the board: at its border corners are of one square.
fn rms(found: &[Option<PixelPoint>], other: &[Option<PixelPoint>]) -> String {
    let inner = |i: usize| (1..CORNERS[0] - 1).contains(&(i % CORNERS[0])) && (1..CORNERS[1] - 1).contains(&(i / CORNERS[0]));
    let squares: Vec<f64> = found
        .iter()
        .zip(other)
        .enumerate()
        .filter(|(i, _)| inner(*i))
        .filter_map(|(_, pair)| Some(pair.0.as_ref()?.distance(*pair.1.as_ref()?).powi(2)))
        .collect();
    let lost = (CORNERS[0] - 2) * (CORNERS[1] - 2) - squares.len();
    let rms = (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt();
    if lost == 0 { format!("{rms:.4}") } else { format!("{rms:.4} ({lost} lost)") }
}
