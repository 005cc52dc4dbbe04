//! Verdicts on sets of photographs drawn at random, beside the truth, by class. `cargo bench --workspace --bench judgements`, followed by `-- COUNT SEED` for
//! other numbers than 30 of a class and seed 2.
//!
//! Errors are RMS over the whole frame after the best rotation. *Withheld*: the verdict is in doubt (exit code 3). *Covered*: of the others, the stated 95 %
//! limit is not below the error. *Moved*: the true camera is said to have moved, a difference of 0 px allowed (one of a hundred is stated); *holds*: that it holds
//! within 1 px. *Regret*: the error over the least of all models in hindsight, geometric mean and 90 of 100, beside that of the true model.

#[path = "../tests/judgements/draw.rs"]
mod draw;
#[path = "../tests/judgements/score.rs"]
mod score;

use std::time::Instant;

use draw::{CLASSES, Drawn, Fault};
use rayon::prelude::*;
use score::{End, ended};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|argument| argument == "--list" || argument == "--test") {
        return;
    }
    let mut numbers = arguments.iter().filter_map(|argument| argument.parse::<u64>().ok());
    let (count, seed) = (numbers.next().unwrap_or(30), numbers.next().unwrap_or(2));
    println!("{count} sets of a class, seed {seed}");
    println!(
        "{:<26} {:>8} {:>9} {:>13} {:>7} {:>15} {:>15} {:>6} {:>6} {:>6}",
        "lens, fault", "withheld", "covered", "limit / error", "modes", "regret, 90 %", "true model", "moved", "holds", "s"
    );
    let mut sound = Vec::new();
    for class in CLASSES {
        let begin = Instant::now();
        let ends: Vec<Option<End>> =
            (0..count).into_par_iter().map(|number| ended(class, &Drawn::set(class, seed, number), seed)).collect();
        let judged: Vec<End> = ends.iter().flatten().cloned().collect();
        line(&format!("{:?}, {:?}", class.lens, class.fault), &judged, begin.elapsed().as_secs_f64());
        if judged.len() < ends.len() {
            println!("    not judged: {}", ends.len() - judged.len());
        }
        for (number, end) in ends.iter().enumerate() {
            if let Some(End { model, error, limit: Some(limit), .. }) =
                end.as_ref().filter(|end| end.limit.is_some_and(|limit| limit < end.error))
            {
                println!("    number {number}: {model}, error {error:.3} px, limit {limit:.3} px");
            }
        }
        if class.fault != Fault::Rolling {
            sound.extend(judged);
        }
    }
    line("all but rolling", &sound, 0.0);
}

fn line(name: &str, ends: &[End], seconds: f64) {
    let stated: Vec<f64> = ends.iter().filter_map(|end| Some(end.limit? / end.error)).collect();
    let covered = stated.iter().filter(|ratio| **ratio >= 1.0).count();
    let regret: Vec<f64> = ends.iter().map(|end| end.error / end.least).collect();
    let of_truth: Vec<f64> = ends.iter().filter_map(|end| Some(end.of_truth? / end.least)).collect();
    let pair = |values: &[f64]| format!("{:.2}, {:.2}", geometric(values), part(values, 0.9));
    println!(
        "{name:<26} {:>8} {:>9} {:>13.2} {:>7.2} {:>15} {:>15} {:>6} {:>6} {seconds:>6.0}",
        format!("{}/{}", ends.len() - stated.len(), ends.len()),
        format!("{covered}/{}", stated.len()),
        part(&stated, 0.5),
        part(&ends.iter().map(|end| end.modes).collect::<Vec<_>>(), 0.5),
        pair(&regret),
        pair(&of_truth),
        ends.iter().filter(|end| end.moved).count(),
        ends.iter().filter(|end| end.holds).count()
    );
}

fn geometric(values: &[f64]) -> f64 {
    (values.iter().map(|value| value.ln()).sum::<f64>() / values.len() as f64).exp()
}

fn part(values: &[f64], share: f64) -> f64 {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    values.get((share * values.len().saturating_sub(1) as f64).round() as usize).copied().unwrap_or(f64::NAN)
}
