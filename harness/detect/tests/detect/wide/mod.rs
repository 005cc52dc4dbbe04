//! Chessboards in fisheyes and in other lenses of 90 to 220 degrees: found where they are, under their names.

mod lens;
mod scene;
mod textures;
mod warps;

use calibench_detect::{Doubt, detect};
use calibench_model::boards::{Board, Chessboard};
use calibench_model::{Image, PixelPoint};

use scene::Scene;

/// A start is so far from its corner at most, px.
const WITHIN: f64 = 2.0;

/// What came of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Came {
    /// Every corner under its name; the greatest distance, px.
    Whole(f64),
    /// Some corners, each under its name: how many are missing.
    Part(usize),
    /// Refused.
    Missed,
    /// A corner under another name, or nowhere: the greatest distance, px.
    Wrong(f64),
}

/// The places in the layout of what is found where the starts that the rule of names allows are taken: `index` to the truth's.
fn orders(columns: usize, rows: usize) -> Vec<Vec<usize>> {
    let quarter = |order: &[usize], columns: usize, rows: usize| -> Vec<usize> {
        (0..order.len()).map(|index| order[(index % rows) * columns + (columns - 1 - index / rows)]).collect()
    };
    let own: Vec<usize> = (0..columns * rows).collect();
    let first = quarter(&own, columns, rows);
    let half = quarter(&first, rows, columns);
    let last = quarter(&half, columns, rows);
    // The squares at the ends of a diagonal are dark both, or one of them is.
    let mut all = vec![own];
    if (columns + rows).is_multiple_of(2) {
        all.push(half);
    }
    if columns == rows && columns.is_multiple_of(2) {
        all.extend([first, last]);
    }
    all
}

fn came(scene: &Scene, image: &Image) -> Came {
    let (columns, rows) = (scene.columns, scene.rows);
    let truth = scene.corners();
    let Ok(found) = detect(image, &Board::Chessboard(Chessboard { columns, rows, square: 1.0 })) else { return Came::Missed };
    let far = |at: PixelPoint| at.x.hypot(at.y);
    let upper_left = |a: &Vec<usize>, b: &Vec<usize>| far(truth[a[0]]).total_cmp(&far(truth[b[0]]));
    let Some(order) = orders(columns, rows).into_iter().min_by(upper_left) else { return Came::Missed };
    let off = found.points.iter().map(|point| truth[order[point.index]].distance(point.position)).fold(0.0, f64::max);
    match truth.len() - found.points.len() {
        _ if off > WITHIN => Came::Wrong(off),
        0 => Came::Whole(off),
        missing => {
            assert_eq!(found.doubts, [Doubt::Unseen { corners: missing }]);
            Came::Part(missing)
        }
    }
}

/// Counts over scenes of seeds, and what was not whole.
fn counted(seeds: std::ops::Range<u64>, field: [f64; 2], mut told: impl FnMut(u64, &Scene, Came)) -> [usize; 4] {
    let mut counts = [0; 4];
    for seed in seeds {
        let scene = Scene::of(seed, field);
        let came = came(&scene, &scene.picture());
        counts[match came {
            Came::Whole(_) => 0,
            Came::Part(_) => 1,
            Came::Missed => 2,
            Came::Wrong(_) => 3,
        }] += 1;
        told(seed, &scene, came);
    }
    counts
}

#[test]
fn boards_in_wide_lenses_are_found() {
    for field in [[90.0, 130.0], [130.0, 175.0], [175.0, 220.0]] {
        let [whole, part, missed, wrong] = counted(0..12, field, |_, _, _| {});
        assert_eq!([part, missed, wrong], [0; 3], "{field:?}: {whole} whole");
    }
}

/// A sticker on a corner, a fifth of a square in radius: the sides beside it tell where the corner is; where they do not it is left out. It is never guessed.
#[test]
fn a_covered_corner_is_measured_by_its_sides_or_left_out() {
    let (mut measured, mut left_out) = (0, 0);
    for seed in 0..24 {
        let scene = Scene::of(seed, [130.0, 200.0]);
        let (corners, index) = (scene.corners(), seed as usize % scene.columns);
        let beside = |by: usize| corners[index].distance(corners[index + by]);
        let step = beside(scene.columns).min(beside(if index + 1 < scene.columns { 1 } else { 2 }));
        let picture = scene.picture();
        if step < 30.0 || !matches!(came(&scene, &picture), Came::Whole(_)) {
            continue;
        }
        let at = PixelPoint::new(corners[index].x + 0.05 * step, corners[index].y - 0.04 * step);
        let covers = |x: usize, y: usize| PixelPoint::new(x as f64, y as f64).distance(at) < 0.2 * step;
        let covered = Image::from_fn(picture.width(), picture.height(), |x, y| if covers(x, y) { 0.5 } else { picture.at(x, y) });
        match came(&scene, &covered) {
            Came::Whole(_) => measured += 1,
            Came::Part(1) | Came::Missed => left_out += 1,
            other => panic!("seed {seed}: {other:?}"),
        }
    }
    assert!(measured > 4 && measured > 2 * left_out, "{measured} measured, {left_out} left out");
}

fn write(picture: &Image, name: &str) {
    let grey = picture.grey().iter().map(|grey| (255.0 * grey).round().clamp(0.0, 255.0) as u8).collect();
    let image = image::GrayImage::from_raw(picture.width() as u32, picture.height() as u32, grey).unwrap();
    image.save(format!("{name}.png")).unwrap();
}

/// A scene as a picture, and its corners in a file beside it, for others to try.
fn save(folder: &str, field: [f64; 2], seed: u64, scene: &Scene) {
    let name = format!("{folder}/{}-{seed}-{}x{}", field[0], scene.columns, scene.rows);
    write(&scene.picture(), &name);
    let corners: String = scene.corners().iter().map(|at| format!("{:.3},{:.3}\n", at.x, at.y)).collect();
    std::fs::write(format!("{name}.csv"), corners).unwrap();
}

/// `just perf-wide` runs it: every scene that is not found whole, and a table in Markdown. `SCENES` is their number in each field; into the folder `SCENES_TO` they
/// are written.
#[test]
#[ignore = "minutes"]
fn many_boards_in_wide_lenses() {
    let count: u64 = std::env::var("SCENES").ok().and_then(|count| count.parse().ok()).unwrap_or(500);
    let folder = std::env::var("SCENES_TO").ok();
    let mut table =
        String::from("| field, degrees | scenes | whole | in part | missed | wrong | farthest off, px |\n|---|--:|--:|--:|--:|--:|--:|\n");
    for field in [[90.0, 120.0], [120.0, 150.0], [150.0, 180.0], [180.0, 220.0]] {
        let mut worst = 0.0_f64;
        let told = |seed: u64, scene: &Scene, came: Came| {
            if let Some(folder) = &folder {
                save(folder, field, seed, scene);
            }
            if let Came::Whole(off) = came {
                worst = worst.max(off);
                return;
            }
            println!(
                "{field:?} seed {seed}: {came:?}, {}x{}, {:?}, {:.0} of {:.0} degrees, blur {:.2}, noise {:.3}",
                scene.columns,
                scene.rows,
                scene.camera.lens,
                scene.farthest(),
                scene.camera.half_field.to_degrees(),
                scene.blur,
                scene.noise
            );
        };
        let [whole, part, missed, wrong] = counted(1000..1000 + count, field, told);
        let [from, to] = field;
        table += &format!("| {from} to {to} | {count} | {whole} | {part} | {missed} | {wrong} | {worst:.2} |\n");
    }
    println!("{table}");
}
