//! What is measured: 12 megapixels with a corner in every cell, and frames for the detector.

use calibench_model::{Image, PixelPoint, Polygon, Scene, Start};
use calibench_random::{Key, Purpose, stream};
use calibench_synth::noise::{add_grey_noise, quantise};
use calibench_synth::optics::Optics;
use calibench_synth::pointing::{Hand, MapError};
use calibench_synth::raster::{Picture, Renderer};
use rayon::prelude::*;

/// Columns and rows of the image, px.
pub(crate) const WIDTH: usize = 4000;
pub(crate) const HEIGHT: usize = 3000;
/// Columns and rows of a cell, px: one square and one point in each.
const CELL: (usize, usize) = (40, 30);
/// Half the diagonal of a square, px.
const RADIUS: f64 = 13.0;

fn key(view: &str) -> Key<'_> {
    Key { seed: 1, of: "perf", trial: 0, view, target: "" }
}

/// A turned dark square in a light cell; its rightmost corner comes first. The turn keeps away from the axes of the pixels.
fn cell(index: usize) -> Scene {
    let turn = 0.1 + 0.6 * (index as f64 * 0.618_033_988_749_895).fract();
    let centre = (14.0 + (index as f64 * 0.754_877_666).fract(), 14.0 + (index as f64 * 0.569_840_291).fract());
    let vertex = |k: i32| {
        let (sin, cos) = (turn + f64::from(k) * std::f64::consts::FRAC_PI_2).sin_cos();
        PixelPoint::new(centre.0 + RADIUS * cos, centre.1 + RADIUS * sin)
    };
    let square = Polygon { id: String::new(), vertices: (0..4).map(vertex).collect(), grey: 0.2 };
    Scene { width: CELL.0, height: CELL.1, background: 0.8, polygons: vec![square], targets: Vec::new() }
}

/// The image without noise, and the corner in each cell.
pub(crate) fn corners() -> (Image<'static>, Vec<PixelPoint>) {
    let mut image = Image::new(WIDTH, HEIGHT, vec![0.0; WIDTH * HEIGHT]);
    let mut corners = Vec::new();
    let columns = WIDTH / CELL.0;
    for index in 0..columns * (HEIGHT / CELL.1) {
        let (left, top) = (index % columns * CELL.0, index / columns * CELL.1);
        let scene = cell(index);
        let tile = calibench_synth::render(&scene);
        for y in 0..CELL.1 {
            let start = (top + y) * WIDTH + left;
            image.grey_mut()[start..start + CELL.0].copy_from_slice(tile.row(y));
        }
        let corner = scene.polygons[0].vertices[0];
        corners.push(PixelPoint::new(corner.x + left as f64, corner.y + top as f64));
    }
    (image, corners)
}

/// A crossing of two turned, tilted edges in each cell, through a lens of `blur` px; without noise. And where they are. Dark are those of two opposite areas
/// whose signs are given: one is a corner, both a chess corner.
pub(crate) fn crossings(blur: f64, dark: &[f64]) -> (Image<'static>, Vec<PixelPoint>) {
    through_lens(blur, |i, centre| {
        let turn = std::f64::consts::TAU * (i * 0.618_033_988_749_895).fract();
        // Edges that cross at 70 to 90 degrees.
        let between = std::f64::consts::FRAC_PI_2 - 0.35 * (i * 0.414_213_562).fract();
        let reach = (CELL.0 + CELL.1) as f64;
        let quarter = |sign: &f64| {
            let along = |angle: f64| (sign * reach * angle.cos(), sign * reach * angle.sin());
            let (u, v) = (along(turn), along(turn + between));
            let vertex = |(x, y): (f64, f64)| PixelPoint::new(centre.x + x, centre.y + y);
            let vertices = [(0.0, 0.0), u, (u.0 + v.0, u.1 + v.1), v].map(vertex).into();
            Polygon { id: String::new(), vertices, grey: 0.2 }
        };
        dark.iter().map(quarter).collect()
    })
}

/// A dark disc of 14 px in each cell, through a lens of `blur` px; without noise. And where they are.
pub(crate) fn discs(blur: f64) -> (Image<'static>, Vec<PixelPoint>) {
    const RADIUS: f64 = 7.0;
    through_lens(blur, |_, centre| {
        let vertex = |k: u32| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 128.0).sin_cos();
            PixelPoint::new(centre.x + RADIUS * cos, centre.y + RADIUS * sin)
        };
        vec![Polygon { id: String::new(), vertices: (0..128).map(vertex).collect(), grey: 0.2 }]
    })
}

/// What `areas` says of each cell's number and centre, pictured by a lens, and the centres.
fn through_lens(blur: f64, areas: impl Fn(f64, PixelPoint) -> Vec<Polygon>) -> (Image<'static>, Vec<PixelPoint>) {
    let (mut image, mut places) = (Image::new(WIDTH, HEIGHT, vec![0.0; WIDTH * HEIGHT]), Vec::new());
    let optics = Optics { blur, ..Optics::default() };
    let renderer = Renderer::new(&optics, CELL.0, CELL.1).expect("a blur that can be rendered");
    let columns = WIDTH / CELL.0;
    for index in 0..columns * (HEIGHT / CELL.1) {
        let (i, left, top) = (index as f64, index % columns * CELL.0, index / columns * CELL.1);
        let centre = PixelPoint::new(19.5 + (i * 0.754_877_666).fract(), 14.5 + (i * 0.569_840_291).fract());
        let scene = Scene { width: CELL.0, height: CELL.1, background: 0.8, polygons: areas(i, centre), targets: Vec::new() };
        let tile = renderer.render(&Picture::from(&scene), &[]);
        for y in 0..CELL.1 {
            let start = (top + y) * WIDTH + left;
            image.grey_mut()[start..start + CELL.0].copy_from_slice(tile.row(y));
        }
        places.push(PixelPoint::new(centre.x + left as f64, centre.y + top as f64));
    }
    (image, places)
}

/// Noise of two grey levels, 8 bit.
pub(crate) fn spoil(mut image: Image<'static>) -> Image<'static> {
    add_grey_noise(&mut image, 2.0 / 255.0, &mut stream(key("corners"), Purpose::GreyNoise));
    quantise(&mut image, 8);
    image
}

/// Within about a pixel of the corners.
pub(crate) fn starts(corners: &[PixelPoint]) -> Vec<Start> {
    let hand = Hand { sigma: 0.4, whole_pixels: false, map: MapError::default() };
    let mut rng = stream(key("corners"), Purpose::Pointing);
    corners.iter().map(|&corner| Start::at(hand.point(corner, &mut rng))).collect()
}

/// A frame for the detector, by name.
pub(crate) fn frames() -> Vec<(String, Image<'static>)> {
    let grey = |sigma: f64| (format!("Gaussian noise, sigma {sigma}"), gaussian(flat(), sigma));
    let mut frames = vec![("uniform noise".to_owned(), by_uniform(|u| u as f32))];
    frames.extend([2.0, 5.0, 10.0, 20.0, 40.0, 60.0].map(grey));
    for share in [0.02, 0.3] {
        let pepper = move |u: f64| {
            if u < share / 2.0 {
                0.0
            } else if u < share {
                1.0
            } else {
                0.5
            }
        };
        frames.push((format!("salt and pepper, {share}"), by_uniform(pepper)));
    }
    frames.extend([0.9, 0.7, 0.5].map(|decay| (format!("random field, decay {decay}"), gaussian(field(decay), 2.0))));
    frames.push(("board of 9x6, noise 4".to_owned(), gaussian(board(10, 7, 250.0), 4.0)));
    frames.push(("small board of 9x6, noise 4".to_owned(), gaussian(board(10, 7, 60.0), 4.0)));
    frames.push(("board of 30x22, noise 4".to_owned(), gaussian(board(30, 22, 110.0), 4.0)));
    frames
}

fn flat() -> Image<'static> {
    Image::new(WIDTH, HEIGHT, vec![128.0 / 255.0; WIDTH * HEIGHT])
}

fn gaussian(mut image: Image<'static>, levels: f64) -> Image<'static> {
    add_grey_noise(&mut image, levels / 255.0, &mut stream(key("detector"), Purpose::GreyNoise));
    quantise(&mut image, 8);
    image
}

/// Uniform numbers in [0, 1), hashed from the pixel's index.
fn hash(index: u64) -> f64 {
    let mixed = (index + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    ((mixed ^ (mixed >> 32)) >> 11) as f64 / (1_u64 << 53) as f64
}

fn by_uniform(grey: impl Fn(f64) -> f32 + Sync) -> Image<'static> {
    let values: Vec<f32> = (0..WIDTH * HEIGHT).into_par_iter().map(|index| grey(hash(index as u64))).collect();
    Image::new(WIDTH, HEIGHT, values)
}

/// Interpolated noise of all scales, each half as wide as the last and `decay` times as strong: like a photograph of gravel or leaves.
fn field(decay: f64) -> Image<'static> {
    let octaves: Vec<(f64, f64)> = (0..10).map(|k| (1.0 / f64::from(1024 >> k), decay.powi(k))).collect();
    let scale = octaves.iter().map(|(_, weight)| weight * weight).sum::<f64>().sqrt();
    let value = |index: usize| {
        let (x, y) = ((index % WIDTH) as f64, (index / WIDTH) as f64);
        let sum: f64 = octaves.iter().enumerate().map(|(k, (rate, weight))| weight * lattice(x * rate, y * rate, k as u64)).sum();
        (0.5 + 0.7 * sum / scale) as f32
    };
    Image::new(WIDTH, HEIGHT, (0..WIDTH * HEIGHT).into_par_iter().map(value).collect())
}

/// Uniform numbers in [-0.5, 0.5) at whole coordinates, smoothly interpolated.
fn lattice(x: f64, y: f64, octave: u64) -> f64 {
    let smooth = |t: f64| t * t * (3.0 - 2.0 * t);
    let (fx, fy) = (smooth(x.fract()), smooth(y.fract()));
    let at = |dx: u64, dy: u64| hash((octave << 50) | ((y as u64 + dy) << 25) | (x as u64 + dx)) - 0.5;
    (at(0, 0) * (1.0 - fx) + at(1, 0) * fx) * (1.0 - fy) + (at(0, 1) * (1.0 - fx) + at(1, 1) * fx) * fy
}

/// A board of `columns` x `rows` squares of `side` px, turned a little.
fn board(columns: usize, rows: usize, side: f64) -> Image<'static> {
    let (sin, cos) = 0.1_f64.sin_cos();
    let value = |index: usize| {
        let (dx, dy) = ((index % WIDTH) as f64 - 2030.3, (index / WIDTH) as f64 - 1480.8);
        let (u, v) = ((cos * dx + sin * dy) / side + columns as f64 / 2.0, (cos * dy - sin * dx) / side + rows as f64 / 2.0);
        let outside = u < 0.0 || v < 0.0 || u >= columns as f64 || v >= rows as f64;
        let wave = |t: f64| (t * std::f64::consts::PI).sin();
        if outside { 0.8 } else { (0.5 - 0.3 * (side * wave(u) * wave(v) * 0.5).tanh()) as f32 }
    };
    Image::new(WIDTH, HEIGHT, (0..WIDTH * HEIGHT).into_par_iter().map(value).collect())
}
