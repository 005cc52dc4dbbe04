//! `calibench measure`: points in a user's own photographs.

use std::path::PathBuf;

use calibench_exchange::{Inputs, MeasuredRow, Outcome, PointFile, PointRow, read_points, write_measured};
use calibench_photographs::points::{by_name, measure_points};
use clap::Args;

use super::context::Context;
use super::output;
use super::photos::say_turns;
use super::progress::Progress;
use crate::deliver::deliver;
use crate::failure::Failure;

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
        let inputs = Inputs::new(self.photos.iter().chain([&self.points]));
        let output = output::table("-o", self.output.as_deref(), &inputs)?;
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
        // What is wrong with the photographs' names is said before any is read.
        by_name(&self.photos, &points)?;
        say_turns(&self.photos)?;
        let progress = Progress::start("measure", self.photos.len() as u64, context.quiet);
        let outcomes = measure_points(&points, &self.photos, &methods, &|| progress.step())?;
        let rows = (0..methods.len()).flat_map(|m| {
            let label = methods[m].label.as_str();
            let outcome = |i: usize| outcomes[i].get(m).cloned().unwrap_or_else(|| not_given(&points[i]));
            points.iter().enumerate().map(move |(i, given)| MeasuredRow { given, method: label, outcome: outcome(i) }).collect::<Vec<_>>()
        });
        deliver(output.as_ref(), |file| write_measured(file, rows))?;
        progress.finish(&summary(&outcomes, &points));
        Ok(())
    }
}

fn not_given(point: &PointRow) -> Outcome {
    Outcome::Unavailable(format!("photograph {} was not given", point.image))
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
