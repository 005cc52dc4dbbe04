//! What is asked for of speed, and what is reached: five rows, each beside OpenCV in the same rounds.

use std::hint::black_box;

use calibench_measure::Operator;
use calibench_measure::harris::{Harris, StrengthMap};
use calibench_measure::paraboloid::Weights;
use calibench_model::{Image, Start};
use opencv::core::{BORDER_DEFAULT, Mat};
use rayon::prelude::*;

use crate::points::corner_sub_pix;
use crate::{classical, median, scene, timed};

const ROUNDS: usize = 9;
/// Points of one job on several threads.
const JOB: usize = 250;

/// A row: how much is done (points or Mpx), by us and by a rival, and the least ratio or rate.
struct Row<'a> {
    name: &'a str,
    unit: &'a str,
    amount: f64,
    ours: &'a dyn Fn(),
    /// Ours on all threads.
    spread: Option<&'a dyn Fn()>,
    rival: Option<(f64, &'a dyn Fn())>,
    least: f64,
}

/// Name, operator, what it measures, the rival, and the least ratio or rate.
type Pair<'a> = (&'a str, &'a str, (&'a Image, &'a [Start]), Option<&'a dyn Fn()>, f64);

pub(crate) fn run() {
    let (image, corners) = scene::corners();
    let image = scene::spoil(image);
    let starts = scene::starts(&corners);
    // Where this fails, OpenCV takes more threads and its rates show it.
    let held = opencv::core::set_num_threads(1).is_ok();
    println!("\nRequired and reached: medians of {ROUNDS} interleaved rounds, one thread (OpenCV held to one: {held}), 15x15 unless said:");
    println!("{:<52} {:>9} {:>9} {:>16} {:>16} {:>9}", "", "required", "reached", "rate", "rival", "speed-up");
    points(&image, &starts);
    harris(&image);
}

fn points(image: &Image, starts: &[Start]) {
    let registry = calibench_opencv::registry();
    let operator = |text: &str| -> Option<Box<dyn Operator>> { registry.parse(text).ok()?.operator.ok() };
    let (squares, targets) = classical::squares();
    let n = starts.len() as f64;
    let peer = |half, iterations, epsilon| move || drop(black_box(corner_sub_pix(image, starts, half, iterations, epsilon)));
    let (small, once, large) = (peer(5, 40, 1e-3), peer(5, 1, 0.0), peer(7, 40, 1e-3));
    let rows: [Pair<'_>; 4] = [
        ("Förstner 11x11 / cornerSubPix 11x11, 40 iterations", "forstner:window=11", (image, starts), Some(&small), 5.0),
        ("Förstner 11x11 / cornerSubPix 11x11, 1 iteration", "forstner:window=11", (image, starts), Some(&once), 2.0),
        ("LSM, eight parameters / cornerSubPix, 40 iterations", "lsm:window=15,sigma=0.7", (&squares, &targets), Some(&large), 0.5),
        ("parametric corner, unknown blur, points/s", "parametric_corner:window=15", (image, starts), None, 15_000.0),
    ];
    for (name, text, (image, starts), rival, least) in rows {
        let Some(operator) = operator(text) else {
            println!("{name:<52} is not available");
            continue;
        };
        let ours = || drop(black_box(operator.measure_all(image, starts)));
        let spread = || starts.par_chunks(JOB).for_each(|job| drop(black_box(operator.measure_all(image, job))));
        let rival = rival.map(|rival| (n, rival));
        Row { name, unit: "/s", amount: starts.len() as f64, ours: &ours, spread: Some(&spread), rival, least }.print();
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
    let (ours, spread) = (|| fit(&samples), || samples.par_chunks(10_000).for_each(fit));
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
        for _ in 0..ROUNDS {
            times[0].push(timed(&mut || (self.ours)()));
            if let Some((_, rival)) = self.rival {
                times[1].push(timed(&mut || rival()));
            }
            if let Some(spread) = self.spread {
                times[2].push(timed(&mut || spread()));
            }
        }
        let [ours, theirs, spread] = times.map(|times| if times.is_empty() { f64::NAN } else { median(times) });
        let rate = self.amount / ours;
        let rival = self.rival.map(|(amount, _)| amount / theirs);
        let reached = rival.map_or(rate, |rival| rate / rival);
        let unit = self.unit;
        let [required, reached] =
            [self.least, reached].map(|value| if value >= 1000.0 { format!("{value:.0}") } else { format!("{value:.2}") });
        let rival = rival.map_or_else(String::new, |rival| format!("{rival:.0}{unit}"));
        let speed_up = self.spread.map_or_else(String::new, |_| format!("{:.2}", ours / spread));
        let rate = format!("{rate:.0}{unit}");
        println!("{:<52} {required:>9} {reached:>9} {rate:>16} {rival:>16} {speed_up:>9}", self.name);
    }
}
