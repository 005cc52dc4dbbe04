//! Points per second of every operator, one thread: `cargo run --release -p calibench-measure --example points_per_second [name]`.
//!
//! Corners for those that look for corners, squares of 8 px for those that look for targets, ellipses of 14 x 11 px for those that fit one; noise of 1 %, starts about a pixel off. The best of several rounds.

use std::hint::black_box;
use std::time::Instant;

use calibench_measure::Registry;
use calibench_measure::harris::{Harris, StrengthMap};
use calibench_measure::paraboloid::Weights;
use calibench_model::{Affine, Image, PixelPoint, Start, TargetKind};

const CELL: usize = 50;
const COLUMNS: usize = 40;
const ROWS: usize = 25;
/// Blur of 0.7 px and the pixel's own.
const BLUR: f64 = 0.757;

/// Turn and centre of the target in cell `index`, from the cell's middle.
fn cell(index: usize) -> (f64, f64, f64) {
    let i = index as f64;
    (0.1 + 1.3 * (i * 0.618_034).fract(), (i * 0.754_878).fract() - 0.5, (i * 0.569_84).fract() - 0.5)
}

fn erf(x: f64) -> f64 {
    // Abramowitz & Stegun 7.1.26: 1.5e-7 is plenty here.
    let t = 1.0 / (1.0 + 0.327_591_1 * x.abs());
    let series = t * (0.254_829_592 + t * (-0.284_496_736 + t * (1.421_413_741 + t * (-1.453_152_027 + t * 1.061_405_429))));
    (1.0 - series * (-x * x).exp()).copysign(x)
}

fn scene(covered: impl Fn(f64, f64) -> f64) -> Image<'static> {
    let mut seed = 1_u64;
    Image::from_fn(CELL * COLUMNS, CELL * ROWS, |x, y| {
        let (turn, cx, cy) = cell(y / CELL * COLUMNS + x / CELL);
        let (dx, dy) = ((x % CELL) as f64 - 25.0 - cx, (y % CELL) as f64 - 25.0 - cy);
        let (sin, cos) = turn.sin_cos();
        let noise: f64 = (0..6)
            .map(|_| {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (seed >> 33) as f64 / f64::from(1_u32 << 31) - 0.5
            })
            .sum::<f64>()
            * 0.01
            * 1.414;
        (0.8 - 0.6 * covered(dx * cos + dy * sin, dy * cos - dx * sin) + noise) as f32
    })
}

/// The best time of several runs, s.
fn best(runs: usize, mut work: impl FnMut()) -> f64 {
    let timed = (0..runs).map(|_| {
        let clock = Instant::now();
        work();
        clock.elapsed().as_secs_f64()
    });
    timed.fold(f64::INFINITY, f64::min)
}

fn whole_images() {
    let image = Image::from_fn(4000, 3000, |x, y| {
        (0.5 + 0.3 * (0.05 * x as f32).sin() * (0.07 * y as f32).cos()) + ((x * 7 + y * 13) % 11) as f32 * 0.01
    });
    for (name, harris) in
        [("Harris strength, block 5x5", Harris::block(0.04, 2)), ("Harris strength, Gaussian 1 px", Harris::new(0.04, 1.0))]
    {
        let mut map = StrengthMap::default();
        let seconds = best(15, || harris.map_into(black_box(&image), black_box(&mut map)));
        println!("{name:<45} {:>10.0} Mpx/s", 12.0 / seconds);
    }
    let map = Harris::block(0.04, 2).map(&image);
    let places: Vec<(usize, usize)> = (0..100_000).map(|i| (1 + i * 37 % (map.columns - 2), 1 + i * 11 % (map.rows - 2))).collect();
    let samples: Vec<[[f64; 3]; 3]> = places.iter().map(|&(column, row)| map.around(column, row)).collect();
    let weights = Weights::new(0.2);
    let seconds = best(15, || {
        let found = samples.iter().filter_map(|f| weights.fit(black_box(f)).maximum());
        black_box(found.fold((0.0, 0.0), |sum, at| (sum.0 + at.0, sum.1 + at.1)));
    });
    println!("{:<45} {:>10.1} million/s", "paraboloid on given strengths", samples.len() as f64 / seconds / 1e6);
}

fn main() {
    whole_images();
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let edge = |t: f64| 0.5 + 0.5 * erf(t / BLUR / 2_f64.sqrt());
    let corners = scene(|u, v| edge(u) * edge(v));
    let side = |t: f64| edge(t + 4.0) - edge(t - 4.0);
    let squares = scene(|u, v| side(u) * side(v));
    let discs = scene(|u, v| edge(7.0 - u.hypot(1.3 * v)));
    let truth: Vec<PixelPoint> = (0..COLUMNS * ROWS)
        .map(|i| {
            let (_, cx, cy) = cell(i);
            PixelPoint::new((i % COLUMNS * CELL + 25) as f64 + cx, (i / COLUMNS * CELL + 25) as f64 + cy)
        })
        .collect();
    let starts: Vec<Start> = truth
        .iter()
        .enumerate()
        .map(|(i, at)| {
            let (sin, cos) = cell(i).0.sin_cos();
            let affine = Affine { axx: 8.0 * cos, axy: -8.0 * sin, ayx: 8.0 * sin, ayy: 8.0 * cos };
            let angle = i as f64 * 2.4;
            let aside = PixelPoint::new(at.x + 0.8 * angle.cos(), at.y + 0.8 * angle.sin());
            Start { kind: Some(TargetKind::Square), affine: Some(affine), ..Start::at(aside) }
        })
        .collect();
    let registry = Registry::builtin();
    let listed: Vec<String> = registry.methods().iter().map(|method| method.name.to_owned()).collect();
    for text in if wanted.is_empty() { listed } else { wanted } {
        let configured = registry.parse(&text).unwrap_or_else(|error| panic!("{error}"));
        let Ok(operator) = configured.operator else { continue };
        let image = match text.as_str() {
            of_discs if of_discs.contains("circle") || of_discs.contains("ellipse") => &discs,
            of_targets if of_targets.starts_with("lsm") || of_targets.starts_with("centroid") => &squares,
            _ => &corners,
        };
        let found = operator.measure_all(image, &starts);
        let mut errors: Vec<f64> = found.iter().zip(&truth).filter_map(|(f, t)| Some(f.as_ref().ok()?.position.distance(*t))).collect();
        errors.sort_by(f64::total_cmp);
        // Short pieces, the best of many: other work on the machine disturbs some, not all.
        let piece = |starts: &[Start]| {
            let timed = (0..20).map(|_| {
                let clock = Instant::now();
                black_box(operator.measure_all(image, starts));
                clock.elapsed().as_secs_f64()
            });
            timed.fold(f64::INFINITY, f64::min)
        };
        let best: f64 = starts.chunks(100).map(piece).sum();
        let median = errors.get(errors.len() / 2).copied().unwrap_or(f64::NAN);
        println!(
            "{:<45} {:>10.0}/s   median error {median:.4} px   measured {} of {}",
            configured.label,
            starts.len() as f64 / best,
            errors.len(),
            starts.len()
        );
    }
}
