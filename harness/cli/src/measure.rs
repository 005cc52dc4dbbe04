//! `calibench measure`: points in a user's own photographs.

use std::path::PathBuf;

use calibench_exchange::{Inputs, MeasuredRow, Outcome, Points, write_measured};
use calibench_measure::Configured;
use calibench_model::TargetKind;
use calibench_photographs::points::{Measured, measure_points, photos_of};
use clap::Args;

use super::context::Context;
use super::output;
use super::photos::say_turns;
use super::progress::Progress;
use crate::deliver::deliver;
use crate::failure::Failure;
use crate::inputs::read_measured;

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
        let points = read_measured(&self.points)?;
        methods.iter().try_for_each(|method| has_kinds(method, &points))?;
        // What is wrong with the photographs' names is said before any is read.
        photos_of(&points, &self.photos)?;
        say_turns(&self.photos)?;
        let progress = Progress::start("measure", self.photos.len() as u64, context.quiet);
        let found = measure_points(&points, &self.photos, &methods, &|| progress.step())?;
        let rows = (0..methods.len()).flat_map(|m| (0..points.len()).map(move |i| (m, i)));
        let rows = rows.map(|(m, i)| {
            let given = points.row(i);
            MeasuredRow { given, method: &methods[m].label, outcome: found.outcome(m, i).unwrap_or_else(|| not_given(given.image)) }
        });
        deliver(output.as_ref(), |file| write_measured(file, rows))?;
        progress.finish(&summary(&found, &points));
        Ok(())
    }
}

/// Whether the points say what a method must know.
fn has_kinds(method: &Configured, points: &Points) -> Result<(), Failure> {
    let needed = method.operator.as_ref().is_ok_and(|operator| operator.needs_kind());
    let Some(bare) = points.rows().find(|row| needed && row.start.kind.is_none()) else { return Ok(()) };
    Err(Failure::input(format!(
        "-m {}: point {} of {} does not say what is pictured, which this method must know; give the column `kind` ({}), or the method its `shape`",
        method.label,
        bare.target,
        bare.image,
        TargetKind::ALL.map(TargetKind::name).join(", ")
    )))
}

fn not_given(image: &str) -> Outcome {
    Outcome::Unavailable(format!("photograph {image} was not given"))
}

fn summary(found: &Measured, points: &Points) -> String {
    let mut text = format!("{} measured, {} rejected", found.measured(), found.rejected());
    if found.not_given() > 0 {
        text.push_str(&format!(", {} of {} points are of photographs that were not given", found.not_given(), points.len()));
    }
    text
}
