//! Points per second.

use std::hint::black_box;

use calibench_measure::Operator;
use calibench_model::{Image, PixelPoint, Start};
use opencv::core::{Mat, Point2f, Size, TermCriteria, TermCriteria_COUNT, TermCriteria_EPS};
use rayon::prelude::*;

use crate::{median, scene, timed};

const ROUNDS: usize = 7;
/// What one timing lasts at least, s.
const LEAST: f64 = 0.05;
/// Points of one job on several threads.
const JOB: usize = 250;

type Work = dyn Fn(&Image, &[Start]) + Sync;

/// Something that measures points.
struct Competitor {
    name: String,
    work: Box<Work>,
    /// Median distance from the true corners, px.
    error: Option<f64>,
}

pub(crate) fn run() {
    let (image, corners) = scene::corners();
    let image = scene::spoil(image);
    let starts = scene::starts(&corners);
    let competitors = competitors(&image, &starts, &corners);
    // Only the setting of OpenCV's threads can fail, and that costs nothing but a wrong heading.
    let one_thread = opencv::core::set_num_threads(1).is_ok();
    println!(
        "{} points, {} x {} px, noise of 2 levels, starts within about 1 px, medians of {ROUNDS} interleaved rounds",
        starts.len(),
        image.width(),
        image.height()
    );
    println!("OpenCV {}, held to one thread: {one_thread}\n", calibench_opencv::version());
    let single = rates(&competitors, &|competitor| (competitor.work)(&image, &starts), starts.len());
    let all = rates(&competitors, &|competitor| starts.par_chunks(JOB).for_each(|job| (competitor.work)(&image, job)), starts.len());
    print(&competitors, &single, &all);
}

fn competitors(image: &Image, starts: &[Start], corners: &[PixelPoint]) -> Vec<Competitor> {
    let peer = |name: &str, iterations, epsilon| Competitor {
        name: name.into(),
        work: Box::new(move |image, starts| {
            black_box(corner_sub_pix(image, starts, 5, iterations, epsilon)).ok();
        }),
        error: None,
    };
    let mut list = vec![peer("cornerSubPix, 40 iterations or 1e-3 px", 40, 1e-3), peer("cornerSubPix, 1 iteration", 1, 0.0)];
    let registry = calibench_opencv::registry();
    // Matching needs targets and stands on its own; the crate chess-corners looks at the whole image again for every job.
    let apart = ["lsm", "chess_corners"];
    let windowed = registry.methods().iter().filter(|method| !apart.contains(&method.name)).map(|method| {
        let has_window = method.parameters.iter().any(|parameter| parameter.name == "window");
        if has_window { format!("{}:window=11", method.name) } else { method.name.to_owned() }
    });
    for text in windowed.chain(["opencv_subpix:iterations=1,epsilon=0".to_owned()]) {
        // What cannot be built here is a line without figures.
        let Ok(configured) = registry.parse(&text) else { continue };
        let Ok(operator) = configured.operator else {
            println!("{} is not available", configured.label);
            continue;
        };
        let error = error(&*operator, image, starts, corners);
        list.push(Competitor {
            name: configured.label,
            work: Box::new(move |image, starts| drop(black_box(operator.measure_all(image, starts)))),
            error,
        });
    }
    list
}

/// The median distance from the true corners, px; `None` for an operator that measures none of them.
fn error(operator: &dyn Operator, image: &Image, starts: &[Start], corners: &[PixelPoint]) -> Option<f64> {
    let found = operator.measure_all(image, starts);
    let errors: Vec<f64> =
        found.iter().zip(corners).filter_map(|(found, corner)| Some(found.as_ref().ok()?.position.distance(*corner))).collect();
    (!errors.is_empty()).then(|| median(errors))
}

/// OpenCV's cornerSubPix with a window of half-width `half`.
pub(crate) fn corner_sub_pix(image: &Image, starts: &[Start], half: i32, iterations: i32, epsilon: f64) -> opencv::Result<Vec<Point2f>> {
    let header = Mat::new_rows_cols_with_data(image.height() as i32, image.width() as i32, image.grey())?;
    let mut points: Vec<Point2f> = starts.iter().map(|start| Point2f::new(start.position.x as f32, start.position.y as f32)).collect();
    let criteria = TermCriteria::new(TermCriteria_COUNT | TermCriteria_EPS, iterations, epsilon)?;
    let (window, none) = (Size::new(half, half), Size::new(-1, -1));
    opencv::imgproc::corner_sub_pix(&header, &mut Mat::from_slice_mut(&mut points)?, window, none, criteria)?;
    Ok(points)
}

/// Points per second of each competitor.
fn rates(competitors: &[Competitor], work: &dyn Fn(&Competitor), points: usize) -> Vec<f64> {
    let repeats: Vec<usize> = competitors.iter().map(|c| (LEAST / timed(&mut || work(c)).max(1e-6)).ceil() as usize).collect();
    let mut times = vec![Vec::new(); competitors.len()];
    for _ in 0..ROUNDS {
        for ((competitor, &repeats), times) in competitors.iter().zip(&repeats).zip(&mut times) {
            let seconds = timed(&mut || (0..repeats).for_each(|_| work(competitor)));
            times.push(seconds / repeats as f64);
        }
    }
    times.into_iter().map(|times| points as f64 / median(times)).collect()
}

fn print(competitors: &[Competitor], single: &[f64], all: &[f64]) {
    let threads = format!("{} threads", rayon::current_num_threads());
    let heading = ["one thread", "x first", "x second", threads.as_str(), "speed-up", "median error"];
    let [rate, first, second, threads, speed_up, error] = heading;
    println!("{:<40} {rate:>14} {first:>9} {second:>9} {threads:>14} {speed_up:>9} {error:>13}", "");
    for ((competitor, &one), &many) in competitors.iter().zip(single).zip(all) {
        let error = competitor.error.map_or_else(String::new, |error| format!("{error:.4} px"));
        let (first, second, speed_up) = (one / single[0], one / single[1], many / one);
        println!("{:<40} {one:>12.0}/s {first:>9.2} {second:>9.2} {many:>12.0}/s {speed_up:>9.2} {error:>13}", competitor.name);
    }
}
