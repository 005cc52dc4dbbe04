//! What is asked for of speed, and what is reached, each beside OpenCV in the same rounds; and beside a control that only computes, which says how much faster
//! two threads can be here.

use std::hint::black_box;

use calibench_measure::Operator;
use calibench_measure::harris::{Harris, StrengthMap};
use calibench_measure::paraboloid::Weights;
use calibench_model::{Image, PixelPoint, Start};
use opencv::core::{BORDER_DEFAULT, Mat};
use rayon::prelude::*;

use crate::points::corner_sub_pix;
use crate::{classical, median, scene, timed};

const ROUNDS: usize = 9;
/// Points of one job on several threads.
const JOB: usize = 250;
/// What one timing lasts at least, s: threads take a while to wake.
const LEAST: f64 = 0.05;
/// Blurs of the crossings, px: sharp, usual, soft.
const BLURS: [f64; 3] = [0.3, 0.7, 2.0];

/// A row: how much is done (points or Mpx), by us and by a rival, and the least ratio or rate.
struct Row<'a> {
    name: &'a str,
    unit: &'a str,
    amount: f64,
    ours: &'a dyn Fn(),
    /// Ours on all threads, so many times.
    spread: Option<&'a dyn Fn(usize)>,
    rival: Option<(f64, &'a dyn Fn())>,
    least: f64,
}

/// Name, operator, what it measures, the rival, and the least ratio or rate.
type Pair<'a> = (&'a str, &'a str, (&'a Image<'a>, &'a [Start]), Option<&'a dyn Fn()>, f64);

pub(crate) fn run() {
    let (image, corners) = scene::corners();
    let image = scene::spoil(image);
    let starts = scene::starts(&corners);
    // Where this fails, OpenCV takes more threads and its rates show it.
    let held = opencv::core::set_num_threads(1).is_ok();
    println!("\nRequired and reached: medians of {ROUNDS} interleaved rounds, one thread (OpenCV held to one: {held}), 15x15 unless said:");
    println!("{:<52} {:>9} {:>9} {:>16} {:>16} {:>9}", "", "required", "reached", "rate", "rival", "speed-up");
    control();
    points(&image, &starts);
    for blur in BLURS {
        targets(blur, ("parametric corner", "parametric_corner:window=15"), scene::crossings(blur, &[1.0, -1.0]), 15_000.0);
    }
    for blur in BLURS {
        targets(blur, ("parametric junction, 2 arms", "parametric_junction:window=15,arms=2"), scene::crossings(blur, &[1.0]), 20_000.0);
    }
    for disc in [("parametric circle, 14 px", "parametric_circle"), ("ellipse edges, 14 px", "ellipse_edges")] {
        targets(0.7, disc, scene::discs(0.7), 25_000.0);
    }
    harris(&image);
}

/// Arithmetic in registers: what two threads gain at most.
fn control() {
    let work = |job: usize| {
        let rotate = |(x, y): (f64, f64), _| (0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y);
        black_box((0..100_000).fold((black_box(job as f64), 1.0), rotate));
    };
    let (ours, spread) = (|| (0..40).for_each(work), |repeats: usize| (0..40 * repeats).into_par_iter().for_each(work));
    let name = "control: arithmetic alone, jobs/s";
    Row { name, unit: "/s", amount: 40.0, ours: &ours, spread: Some(&spread), rival: None, least: f64::NAN }.print();
}

/// An operator on what it is for: an image without noise and where the targets are in it.
fn targets(blur: f64, (what, spec): (&str, &str), (image, places): (Image<'static>, Vec<PixelPoint>), least: f64) {
    let (image, starts) = (scene::spoil(image), scene::starts(&places));
    let name = format!("{what}, blur {blur} px unknown, points/s");
    let Some(operator) = operator(spec) else {
        println!("{name:<52} is not available");
        return;
    };
    measured(&name, &*operator, (&image, &starts), None, least);
    let found = operator.measure_all(&image, &starts);
    let near = found.iter().zip(&places).filter(|(found, place)| found.as_ref().is_ok_and(|found| found.position.distance(**place) < 0.5));
    let converged = found.iter().filter(|found| found.is_ok()).count();
    println!("  of {} targets {converged} converged, {} within half a pixel", starts.len(), near.count());
}

fn operator(text: &str) -> Option<Box<dyn Operator>> {
    calibench_opencv::registry().parse(text).ok()?.operator.ok()
}

/// The row of an operator.
fn measured(name: &str, operator: &dyn Operator, (image, starts): (&Image, &[Start]), rival: Option<(f64, &dyn Fn())>, least: f64) {
    let ours = || drop(black_box(operator.measure_all(image, starts)));
    let jobs: Vec<&[Start]> = starts.chunks(JOB).collect();
    let spread = |repeats: usize| {
        let job = |index: usize| drop(black_box(operator.measure_all(image, jobs[index % jobs.len()])));
        (0..repeats * jobs.len()).into_par_iter().for_each(job);
    };
    Row { name, unit: "/s", amount: starts.len() as f64, ours: &ours, spread: Some(&spread), rival, least }.print();
}

fn points(image: &Image, starts: &[Start]) {
    let (squares, targets) = classical::squares();
    let n = starts.len() as f64;
    let peer = |half, iterations, epsilon| move || drop(black_box(corner_sub_pix(image, starts, half, iterations, epsilon)));
    let (small, once, large) = (peer(5, 40, 1e-3), peer(5, 1, 0.0), peer(7, 40, 1e-3));
    let rows: [Pair<'_>; 3] = [
        ("Förstner 11x11 / cornerSubPix 11x11, 40 iterations", "forstner:window=11", (image, starts), Some(&small), 5.0),
        ("Förstner 11x11 / cornerSubPix 11x11, 1 iteration", "forstner:window=11", (image, starts), Some(&once), 2.0),
        (
            "LSM, eight parameters / cornerSubPix, 40 iterations",
            "lsm:window=15,sigma=0.7,sharpness=held",
            (&squares, &targets),
            Some(&large),
            1.0,
        ),
    ];
    for (name, text, (image, starts), rival, least) in rows {
        let Some(operator) = operator(text) else {
            println!("{name:<52} is not available");
            continue;
        };
        measured(name, &*operator, (image, starts), rival.map(|rival| (n, rival)), least);
    }
}

fn harris(image: &Image) {
    let (harris, megapixels) = (Harris::block(0.04, 2), (image.width() * image.height()) as f64 / 1e6);
    let (map, theirs) = (std::cell::RefCell::new(StrengthMap::default()), std::cell::RefCell::new(Mat::default()));
    let ours = || harris.map_into(image, black_box(&mut map.borrow_mut()));
    let opencv = || -> opencv::Result<()> {
        let header = Mat::new_rows_cols_with_data(image.height() as i32, image.width() as i32, image.grey())?;
        opencv::imgproc::corner_harris(&header, &mut *theirs.borrow_mut(), 5, 3, 0.04, BORDER_DEFAULT)
    };
    let rival = || drop(black_box(opencv()));
    let name = "Harris strength 5x5, 12 megapixels / cornerHarris";
    Row { name, unit: " Mpx/s", amount: megapixels, ours: &ours, spread: None, rival: Some((megapixels, &rival)), least: 8.0 }.print();
    let map = harris.map(image);
    let places = (0..100_000).map(|i| (1 + i * 37 % (map.columns - 2), 1 + i * 11 % (map.rows - 2)));
    let samples: Vec<[[f64; 3]; 3]> = places.map(|(column, row)| map.around(column, row)).collect();
    let weights = Weights::new(0.2);
    let fit = |samples: &[[[f64; 3]; 3]]| {
        let found = samples.iter().filter_map(|f| weights.fit(black_box(f)).maximum());
        black_box(found.fold((0.0, 0.0), |sum, at| (sum.0 + at.0, sum.1 + at.1)));
    };
    let ours = || fit(&samples);
    let spread = |repeats: usize| {
        let jobs: Vec<&[[[f64; 3]; 3]]> = samples.chunks(10_000).collect();
        (0..repeats * jobs.len()).into_par_iter().for_each(|index| fit(jobs[index % jobs.len()]));
    };
    let amount = samples.len() as f64 / 1e6;
    Row {
        name: "paraboloid on given strengths, million/s",
        unit: " M/s",
        amount,
        ours: &ours,
        spread: Some(&spread),
        rival: None,
        least: 10.0,
    }
    .print();
}

impl Row<'_> {
    fn print(&self) {
        let mut times = [Vec::new(), Vec::new(), Vec::new()];
        let enough = |once: f64| (LEAST / once.max(1e-9)).ceil() as usize;
        let repeats = enough(timed(&mut || (self.ours)()));
        let theirs = self.rival.map_or(1, |(_, rival)| enough(timed(&mut || rival())));
        let each = |seconds: f64, repeats: usize| seconds / repeats as f64;
        for _ in 0..ROUNDS {
            times[0].push(each(timed(&mut || (0..repeats).for_each(|_| (self.ours)())), repeats));
            if let Some((_, rival)) = self.rival {
                times[1].push(each(timed(&mut || (0..theirs).for_each(|_| rival())), theirs));
            }
            if let Some(spread) = self.spread {
                times[2].push(each(timed(&mut || spread(repeats)), repeats));
            }
        }
        let [ours, theirs, spread] = times.map(|times| if times.is_empty() { f64::NAN } else { median(times) });
        let rate = self.amount / ours;
        let rival = self.rival.map(|(amount, _)| amount / theirs);
        let reached = rival.map_or(rate, |rival| rate / rival);
        let unit = self.unit;
        let [required, reached] = [self.least, reached].map(|value| {
            if value.is_nan() {
                String::new()
            } else if value >= 1000.0 {
                format!("{value:.0}")
            } else {
                format!("{value:.2}")
            }
        });
        let rival = rival.map_or_else(String::new, |rival| format!("{rival:.0}{unit}"));
        let speed_up = self.spread.map_or_else(String::new, |_| format!("{:.2}", ours / spread));
        let rate = format!("{rate:.0}{unit}");
        println!("{:<52} {required:>9} {reached:>9} {rate:>16} {rival:>16} {speed_up:>9}", self.name);
    }
}
