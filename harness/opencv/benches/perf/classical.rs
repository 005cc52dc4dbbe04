//! Harris on a whole image, the paraboloid, and least-squares matching, each beside its rival.

use std::hint::black_box;

use calibench_measure::harris::{Harris, StrengthMap, smooth};
use calibench_measure::paraboloid::Weights;
use calibench_model::{Affine, Image, PixelPoint, Polygon, Scene, Start, TargetKind};
use opencv::core::{BORDER_DEFAULT, Mat};

use crate::points::corner_sub_pix;
use crate::{median, scene, timed};

const ROUNDS: usize = 9;
/// Side of the squares that are matched, px.
const SIDE: f64 = 8.0;

pub(crate) fn run() {
    let (image, corners) = scene::corners();
    let image = scene::spoil(image);
    harris(&image);
    paraboloid(&image);
    matching(&image, &scene::starts(&corners));
}

/// Medians of both, the rounds interleaved, s.
fn beside(mut one: impl FnMut(), mut other: impl FnMut()) -> (f64, f64) {
    let rounds: Vec<(f64, f64)> = (0..ROUNDS).map(|_| (timed(&mut one), timed(&mut other))).collect();
    (median(rounds.iter().map(|r| r.0).collect()), median(rounds.iter().map(|r| r.1).collect()))
}

fn harris(image: &Image) {
    let megapixels = (image.width() * image.height()) as f64 / 1e6;
    let ours = Harris::block(0.04, 2);
    let (mut map, mut theirs) = (StrengthMap::default(), Mat::default());
    let opencv = |theirs: &mut Mat| -> opencv::Result<()> {
        let header = Mat::new_rows_cols_with_data(image.height() as i32, image.width() as i32, image.grey())?;
        opencv::imgproc::corner_harris(&header, theirs, 5, 3, 0.04, BORDER_DEFAULT)
    };
    let (a, b) = beside(|| ours.map_into(image, black_box(&mut map)), || drop(black_box(opencv(&mut theirs))));
    println!("\nHarris strength, {megapixels} megapixels, block of 5x5, one thread:");
    println!("  {:<44} {:>8.1} Mpx/s", "cornerHarris", megapixels / b);
    println!("  {:<44} {:>8.1} Mpx/s   x {:.1}", "Harris::map_into", megapixels / a, b / a);
}

fn paraboloid(image: &Image) {
    let map = Harris::block(0.04, 2).map(image);
    let places = (0..100_000).map(|i| (1 + i * 37 % (map.columns - 2), 1 + i * 11 % (map.rows - 2)));
    let samples: Vec<[[f64; 3]; 3]> = places.map(|(column, row)| map.around(column, row)).collect();
    let weights = Weights::new(0.2);
    let seconds = median(
        (0..ROUNDS)
            .map(|_| {
                timed(&mut || {
                    let found = samples.iter().filter_map(|f| weights.fit(black_box(f)).maximum());
                    black_box(found.fold((0.0, 0.0), |sum, at| (sum.0 + at.0, sum.1 + at.1)));
                })
            })
            .collect(),
    );
    println!("  {:<44} {:>8.1} million/s", "paraboloid on given strengths", samples.len() as f64 / seconds / 1e6);
}

fn matching(image: &Image, starts: &[Start]) {
    let (squares, targets) = squares();
    let registry = calibench_opencv::registry();
    println!("\nLeast-squares matching of squares of {SIDE} px, blur 0.7 px, starts within about 1 px, window 15x15, one thread:");
    for text in ["lsm:window=15,sigma=0.7,sharpness=held", "lsm:window=15,sigma=0.7"] {
        let Some(lsm) = registry.parse(text).ok().and_then(|configured| configured.operator.ok()) else { continue };
        let theirs = || drop(black_box(corner_sub_pix(image, starts, 7, 40, 1e-3)));
        let (a, b) = beside(|| drop(black_box(lsm.measure_all(&squares, &targets))), theirs);
        let (ours, opencv) = (targets.len() as f64 / a, starts.len() as f64 / b);
        println!("  {text:<44} {ours:>8.0}/s   cornerSubPix 15x15 {opencv:.0}/s   x {:.2}", ours / opencv);
    }
}

/// Turned squares, one in each cell of 40 x 30 px, smoothed by 0.7 px and with noise; and where to start.
pub(crate) fn squares() -> (Image<'static>, Vec<Start>) {
    let (columns, rows) = (40, 30);
    let mut starts = Vec::new();
    let mut polygons = Vec::new();
    for index in 0..columns * rows {
        let i = index as f64;
        let turn = 0.1 + 1.3 * (i * 0.618_034).fract();
        let centre =
            ((index % columns * 40) as f64 + 20.0 + (i * 0.754_878).fract(), (index / columns * 30) as f64 + 15.0 + (i * 0.569_84).fract());
        let (sin, cos) = turn.sin_cos();
        let affine = Affine { axx: SIDE * cos, axy: -SIDE * sin, ayx: SIDE * sin, ayy: SIDE * cos };
        let vertex =
            |(u, v): (f64, f64)| PixelPoint::new(centre.0 + affine.axx * u + affine.axy * v, centre.1 + affine.ayx * u + affine.ayy * v);
        polygons.push(Polygon {
            id: String::new(),
            vertices: [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(vertex).into(),
            grey: 0.2,
        });
        let at = PixelPoint::new(centre.0 + 0.8 * (i * 2.4).cos(), centre.1 + 0.8 * (i * 2.4).sin());
        starts.push(Start { kind: Some(TargetKind::Square), affine: Some(affine), ..Start::at(at) });
    }
    let scene = Scene { width: columns * 40, height: rows * 30, background: 0.8, polygons, targets: Vec::new() };
    (scene::spoil(smooth(&calibench_synth::render(&scene), 0.7)), starts)
}
