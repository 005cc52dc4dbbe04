//! Cramér-Rao bounds a second, of all unknowns, and how many renders of the window take as long: as differences the derivatives alone would take 16.

#![allow(clippy::print_stdout)]

use std::time::Instant;

use calibench_model::{Gradient, Levels, PixelPoint, Unknowns};
use calibench_synth::bound::{Bounds, Work};
use calibench_synth::optics::Optics;
use calibench_synth::raster::{Outlined, Picture, Piece, Renderer};
use rayon::ThreadPoolBuilder;
use rayon::prelude::*;

const FRAME: usize = 400;
const ROUNDS: usize = 5;
const TARGETS: usize = 400;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("{:<44}{:>12}{:>12}{:>16}", "bounds a second", "one thread", "two", "renders each");
    for (name, picture, window, blur) in [
        ("chess corners, 15 x 15 px, blur 0.7 px", corner(), 15, 0.7),
        ("chess corners, 15 x 15 px, blur 2 px", corner(), 15, 2.0),
        ("discs of 40 px, 81 x 81 px, blur 0.7 px", disc(), 81, 0.7),
        ("discs of 40 px, 81 x 81 px, blur 3 px", disc(), 81, 3.0),
    ] {
        let optics = Optics { blur, ..Optics::default() };
        let [one, two] = [1, 2].map(|threads| bounds(&picture, window, &optics, threads));
        let (one, two) = (one?, two?);
        println!("{name:<44}{one:>12.0}{two:>12.0}{:>16.1}", renders(&picture, window, &optics)? / one);
    }
    Ok(())
}

/// Bounds a second, the best of several rounds.
fn bounds(picture: &Picture, window: usize, optics: &Optics, threads: usize) -> Result<f64, Box<dyn std::error::Error>> {
    let bounds = Bounds::new(optics, FRAME, FRAME, window)?;
    let all = [Unknowns { shape: true, blur: true, levels: Levels::Areas, gradient: Gradient::None }];
    let pool = ThreadPoolBuilder::new().num_threads(threads).build()?;
    let (at, outlined) = (PixelPoint::new(200.3, 199.8), Outlined::of(picture));
    let one = |work: &mut Work, _| bounds.window(&outlined, at).map(|window| window.bounds(&all, Some, |_| Some(1e-4), work));
    let round = |_| {
        let start = Instant::now();
        let found: Vec<_> = pool.install(|| (0..TARGETS).into_par_iter().map_init(Work::default, one).collect());
        std::hint::black_box(found);
        TARGETS as f64 / start.elapsed().as_secs_f64()
    };
    Ok((0..ROUNDS).map(round).fold(0.0, f64::max))
}

/// Renders of the window a second, one thread.
fn renders(picture: &Picture, window: usize, optics: &Optics) -> Result<f64, Box<dyn std::error::Error>> {
    let renderer = Renderer::new(optics, window, window)?;
    let from = 200.0 - (window / 2) as f64;
    let pieces = picture.pieces.iter().map(|piece| Piece { points: piece.points.map(|[x, y]| [x - from, y - from]), ..*piece }).collect();
    let picture = Picture { width: window, height: window, pieces, ..*picture };
    let pool = ThreadPoolBuilder::new().num_threads(1).build()?;
    let round = |_| {
        let start = Instant::now();
        pool.install(|| (0..TARGETS).for_each(|_| drop(std::hint::black_box(renderer.render(&picture, &[])))));
        TARGETS as f64 / start.elapsed().as_secs_f64()
    };
    Ok((0..ROUNDS).map(round).fold(0.0, f64::max))
}

fn corner() -> Picture {
    let square = |sign: f64| {
        let at = |x: f64, y: f64| [200.3 + sign * (x - 0.1 * y), 199.8 + sign * (y + 0.1 * x)];
        let corners = [at(0.0, 0.0), at(60.0, 0.0), at(60.0, 60.0), at(0.0, 60.0)];
        (0..4).map(move |i| Piece::straight(corners[i], corners[(i + 1) % 4], -0.8))
    };
    picture(square(1.0).chain(square(-1.0)).collect())
}

fn disc() -> Picture {
    let at = |turn: f64| {
        let (sin, cos) = (turn * std::f64::consts::TAU / 16.0).sin_cos();
        [200.3 + 20.0 * cos, 199.8 + 18.0 * sin]
    };
    let arc = |i: u32| Piece { points: [0.0, 0.25, 0.5, 0.75, 1.0].map(|t| at(f64::from(i) + t)), contrast: -0.8 };
    picture((0..16).map(arc).collect())
}

fn picture(pieces: Vec<Piece>) -> Picture {
    Picture { width: FRAME, height: FRAME, background: 0.9, pieces }
}
