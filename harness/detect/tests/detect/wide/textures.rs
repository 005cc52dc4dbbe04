//! What has rows and columns and is no chessboard.

use calibench_detect::detect;
use calibench_model::Image;
use calibench_model::boards::{Board, Chessboard};
use calibench_model::testfield::PlatePoint;

use super::scene::{Random, Scene};
use super::write;

/// Boards that are asked for.
const ASKED: [[usize; 2]; 4] = [[3, 3], [4, 3], [8, 6], [9, 6]];
/// How far a texture reaches from the middle, squares.
const REACH: i32 = 7;

#[derive(Clone, Copy, Debug)]
enum Texture {
    Tiles,
    Bricks,
    Blinds,
    Keyboard,
    Facade,
    Crossing,
    Tartan,
    Basket,
}

const ALL: [Texture; 8] = [
    Texture::Tiles,
    Texture::Bricks,
    Texture::Blinds,
    Texture::Keyboard,
    Texture::Facade,
    Texture::Crossing,
    Texture::Tartan,
    Texture::Basket,
];

fn rectangle([x, y]: [f64; 2], [width, height]: [f64; 2], grey: f64) -> (Vec<PlatePoint>, f32) {
    (vec![[x, y], [x + width, y], [x + width, y + height], [x, y + height]], grey as f32)
}

impl Texture {
    /// Its areas in the plane of a board, squares from the middle.
    fn areas(self, random: &mut Random) -> Vec<(Vec<PlatePoint>, f32)> {
        let (dark, light) = (random.between(0.03, 0.3), random.between(0.6, 0.95));
        let far = f64::from(REACH);
        let mut all =
            vec![rectangle([-far, -far], [2.0 * far, 2.0 * far], if matches!(self, Self::Keyboard) { dark + 0.1 } else { light })];
        for (i, k) in (-REACH..REACH).flat_map(|i| (-REACH..REACH).map(move |k| (i, k))) {
            let at = [f64::from(i), f64::from(k)];
            let off = |by: [f64; 2]| [at[0] + by[0], at[1] + by[1]];
            match self {
                Self::Tiles => all.push(rectangle(at, [0.93, 0.93], random.between(dark, light))),
                Self::Bricks => {
                    all.push(rectangle(off([if k % 2 == 0 { 0.0 } else { 0.5 }, 0.0]), [0.95, 0.9], random.between(dark, dark + 0.3)));
                }
                Self::Blinds if k == 0 => all.push(rectangle([at[0], -far], [0.5, 2.0 * far], dark)),
                Self::Keyboard => {
                    all.push(rectangle(at, [0.8, 0.8], dark));
                    all.push(rectangle(off([0.15, 0.4]), [0.2, 0.25], light));
                }
                Self::Facade => {
                    all.push(rectangle(off([0.2, 0.1]), [0.6, 0.8], dark));
                    all.push(rectangle(off([0.47, 0.1]), [0.06, 0.8], light));
                }
                Self::Crossing if k % 4 == 0 => all.push(rectangle(at, [0.55, 3.0], dark)),
                Self::Tartan => {
                    all.push(rectangle(at, [1.0, 1.0], light));
                    all.push(rectangle(at, [0.5, 1.0], 0.5 * (dark + light)));
                    all.push(rectangle(off([0.5, 0.0]), [0.5, 0.5], 0.5 * (dark + light)));
                    all.push(rectangle(at, [0.5, 0.5], dark));
                }
                Self::Basket if (i + k) % 2 == 0 => {
                    (0..3).for_each(|n| all.push(rectangle(off([0.0, 0.33 * f64::from(n)]), [1.0, 0.2], dark)));
                }
                Self::Basket => (0..3).for_each(|n| all.push(rectangle(off([0.33 * f64::from(n), 0.0]), [0.2, 1.0], dark))),
                Self::Blinds | Self::Crossing => {}
            }
        }
        all
    }
}

/// A frame without a board.
fn frame(seed: u64) -> (Texture, Image<'static>) {
    let mut random = Random::new(seed ^ 0x7e57);
    let texture = ALL[seed as usize % ALL.len()];
    let scene = Scene::of(seed, [60.0, 200.0]);
    let areas = texture.areas(&mut random);
    (texture, scene.drawn_before_clutter(areas.into_iter()))
}

/// Boards that are found where there are none.
fn false_boards(seeds: std::ops::Range<u64>) -> Vec<String> {
    let mut found = Vec::new();
    for seed in seeds {
        let (texture, image) = frame(seed);
        for [columns, rows] in ASKED {
            if detect(&image, &Board::Chessboard(Chessboard { columns, rows, square: 1.0 })).is_ok() {
                if let Ok(folder) = std::env::var("SCENES_TO") {
                    write(&image, &format!("{folder}/{texture:?}-{seed}-{columns}x{rows}"));
                }
                found.push(format!("{texture:?} {seed}: {columns} x {rows}"));
            }
        }
    }
    found
}

#[test]
fn textures_are_no_boards() {
    assert_eq!(false_boards(0..16), Vec::<String>::new());
}

/// `just perf-wide` runs it; into the folder `SCENES_TO` frames with a false board are written.
#[test]
#[ignore = "minutes"]
fn many_textures_are_no_boards() {
    let count = std::env::var("SCENES").ok().and_then(|count| count.parse().ok()).unwrap_or(500);
    let found = false_boards(0..count);
    println!("{count} frames without a board, {} false boards\n{}", found.len(), found.join("\n"));
}
