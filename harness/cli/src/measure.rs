//! `calibench measure`: points in a user's own photographs.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use calibench_exchange::{MeasuredRow, Outcome, PointFile, PointRow, read_photo, read_points, write_measured};
use calibench_measure::Configured;
use calibench_model::Start;
use clap::Args;
use rayon::prelude::*;

use super::context::Context;
use super::photos::{ambiguous, names, once};
use super::progress::Progress;
use super::{Failure, deliver};

#[derive(Args)]
pub struct Measure {
    /// Photographs: PNG, JPEG, TIFF or PNM, 8 or 16 bits
    #[arg(required = true, value_name = "PHOTO")]
    photos: Vec<PathBuf>,
    /// Approximate positions: CSV with image,target,x,y, and optionally sxx,sxy,syy and kind,axx,axy,ayx,ayy
    #[arg(long, value_name = "CSV")]
    points: PathBuf,
    /// The method, as in forstner:window=15; several are measured one after the other
    #[arg(short, long = "method", value_name = "METHOD", default_value = "forstner")]
    methods: Vec<String>,
    /// Where the result goes [default: standard output]
    #[arg(short, long, value_name = "CSV")]
    output: Option<PathBuf>,
}

impl Measure {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let methods = self.methods.iter().map(|text| context.method(text)).collect::<Result<Vec<_>, _>>()?;
        if let Some((method, why)) = methods.iter().find_map(|m| Some((m, m.operator.as_ref().err()?))) {
            return Err(Failure::input(format!("-m {}: unavailable: {why}", method.label)));
        }
        if let Some(twice) = methods.iter().enumerate().find(|(i, m)| methods[..*i].iter().any(|earlier| earlier.label == m.label)) {
            return Err(Failure::input(format!("-m {}: asked for twice", twice.1.label)));
        }
        let PointFile { rows: points, without_position, .. } = read_points(&self.points)?;
        if without_position > 0 {
            eprintln!("{}: {without_position} rows without a position (rejected or unavailable) are left out", self.points.display());
        }
        if points.is_empty() {
            return Err(Failure::input(format!("{}: no row has a position", self.points.display())));
        }
        let photos = by_name(&self.photos, &points)?;
        let progress = Progress::start("measure", self.photos.len() as u64, context.quiet);
        let mut outcomes: Vec<Vec<Outcome>> = vec![Vec::new(); points.len()];
        for (index, outcome) in measure(&points, &photos, &methods, &progress)? {
            outcomes[index] = outcome;
        }
        let rows = (0..methods.len()).flat_map(|m| {
            let label = methods[m].label.as_str();
            let outcome = |i: usize| outcomes[i].get(m).cloned().unwrap_or_else(|| not_given(&points[i]));
            points.iter().enumerate().map(move |(i, given)| MeasuredRow { given, method: label, outcome: outcome(i) }).collect::<Vec<_>>()
        });
        deliver(self.output.as_deref(), |file| write_measured(file, rows))?;
        progress.finish(&summary(&outcomes, &points));
        Ok(())
    }
}

fn not_given(point: &PointRow) -> Outcome {
    Outcome::Unavailable(format!("photograph {} was not given", point.image))
}

/// Photographs by the names that point files give them: those of [`names`].
fn by_name<'p>(paths: &'p [PathBuf], points: &[PointRow]) -> Result<BTreeMap<String, &'p Path>, Failure> {
    once(paths)?;
    let unclear = points.iter().find_map(|point| Some((&point.image, ambiguous(paths, &point.image)?)));
    if let Some((name, [a, b])) = unclear {
        let (a, b) = (a.display(), b.display());
        return Err(Failure::input(format!(
            "two photographs are called {name}: {a} and {b}; points must name them with their folders, as `{b}`"
        )));
    }
    Ok(names(paths).into_iter().zip(paths.iter().map(PathBuf::as_path)).collect())
}

/// (index of the point, one outcome a method). One photograph a thread is in memory.
fn measure(
    points: &[PointRow],
    photos: &BTreeMap<String, &Path>,
    methods: &[Configured],
    progress: &Progress,
) -> Result<Vec<(usize, Vec<Outcome>)>, Failure> {
    let one = |(name, path): (&String, &&Path)| -> Result<Vec<(usize, Vec<Outcome>)>, Failure> {
        let wanted: Vec<usize> = (0..points.len()).filter(|&i| is_called(&points[i].image, name, path)).collect();
        // Read even if no point asks for it: a photograph that cannot be read is a mistake.
        let image = read_photo(path)?;
        let starts: Vec<Start> = wanted.iter().map(|&i| points[i].start).collect();
        let mut outcomes: Vec<(usize, Vec<Outcome>)> = wanted.into_iter().map(|i| (i, Vec::new())).collect();
        for operator in methods.iter().filter_map(|method| method.operator.as_ref().ok()) {
            for ((_, outcome), result) in outcomes.iter_mut().zip(operator.measure_all(&image, &starts)) {
                outcome.push(result.map_or_else(Outcome::Rejected, Outcome::Measured));
            }
        }
        progress.step();
        Ok(outcomes)
    };
    Ok(photos.par_iter().map(one).collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
}

/// A point file may give a photograph its folders, though its name alone would do here.
fn is_called(image: &str, name: &str, path: &Path) -> bool {
    image == name || Path::new(image) == path
}

fn summary(outcomes: &[Vec<Outcome>], points: &[PointRow]) -> String {
    let count = |wanted: fn(&Outcome) -> bool| outcomes.iter().flatten().filter(|o| wanted(o)).count();
    let measured = count(|o| matches!(o, Outcome::Measured(_)));
    let rejected = count(|o| matches!(o, Outcome::Rejected(_)));
    let absent = outcomes.iter().filter(|outcome| outcome.is_empty()).count();
    let mut text = format!("{measured} measured, {rejected} rejected");
    if absent > 0 {
        text.push_str(&format!(", {absent} of {} points are of photographs that were not given", points.len()));
    }
    text
}
