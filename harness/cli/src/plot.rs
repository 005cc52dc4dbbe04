//! `calibench plot`: the records of a sweep as curves or maps.

use std::path::{Path, PathBuf};

use calibench_cameras::inputs_of;
use calibench_files::{Inputs, OutputFile};
use calibench_report::sweep;
use calibench_report::sweep::{Choice, Layout, LoadedSweep, Metric};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use super::context::Context;
use super::output;
use crate::deliver::print;
use crate::failure::Failure;

#[derive(Args)]
pub struct Plot {
    /// Name of a scenario with a sweep that was run, or the folder of its records
    #[arg(value_name = "SCENARIO")]
    sweep: String,
    /// The swept key along x, as in blur or optics.blur [default: the first]
    #[arg(long, value_name = "KEY")]
    x: Option<String>,
    /// The figure
    #[arg(long, value_name = "Y", value_parser = metrics(), default_value = "rmse")]
    y: Metric,
    /// One curve for each value of this key, or for each method
    #[arg(long, value_name = "KEY", default_value = "method", conflicts_with = "map")]
    by: String,
    /// A map of shades in place of curves, with this key along its y
    #[arg(long, value_name = "KEY")]
    map: Option<String>,
    /// One panel for each value of this key, or for each method [default: what else varies]
    #[arg(long, value_name = "KEY")]
    facet: Option<String>,
    /// Hold a key at one of its values, as in --at blur=0.5; may be repeated
    #[arg(long, value_name = "KEY=VALUE", value_parser = pair)]
    at: Vec<(String, String)>,
    /// Only this method; may be repeated
    #[arg(short, long = "method", value_name = "METHOD")]
    methods: Vec<String>,
    /// The picture, as PNG, SVG or PDF by its ending; its numbers stand beside it as CSV [default: the scenario's name with .png, in the current folder]
    #[arg(short, long, value_name = "PICTURE")]
    output: Option<PathBuf>,
}

/// The name of a figure on the command line.
fn word(metric: Metric) -> &'static str {
    if metric == Metric::MeanX { "mean-x" } else { metric.name().0 }
}

/// Figures by their names, with what each one is.
fn metrics() -> impl TypedValueParser<Value = Metric> {
    let values = Metric::ALL.map(|metric| PossibleValue::new(word(metric)).help(metric.meaning()));
    PossibleValuesParser::new(values)
        .try_map(|text| Metric::ALL.into_iter().find(|metric| word(*metric) == text).ok_or("there is no such figure"))
}

pub fn pair(text: &str) -> Result<(String, String), String> {
    let (key, value) = text.split_once('=').ok_or_else(|| "expected KEY=VALUE, as in blur=0.5".to_owned())?;
    Ok((key.to_owned(), value.to_owned()))
}

impl Plot {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let (loaded, records) = self.load(context)?;
        let (path, picture, numbers) = self.outputs(&loaded, &inputs_of([records]))?;
        let choice = Choice {
            x: self.x.clone(),
            by: Some(self.map.clone().unwrap_or_else(|| self.by.clone())),
            facet: self.facet.clone(),
            at: self.at.clone(),
            methods: self.methods.clone(),
        };
        let layout = Layout::new(&loaded, &choice, self.y, self.map.is_some())?;
        let drawn = if self.map.is_some() { sweep::map(&loaded, &layout) } else { sweep::curves(&loaded, &layout) };
        drawn.write(&picture)?;
        print(&format!("{}\n", path.display()))?;
        let Some(numbers) = numbers else { return Ok(()) };
        numbers.write(|file| sweep::write_numbers(file, &loaded, &layout).map_err(std::io::Error::from))?;
        print(&format!("{}\n", numbers.path().display()))
    }

    /// The picture, and its numbers beside it if it is a file.
    fn outputs(&self, loaded: &LoadedSweep, inputs: &Inputs) -> Result<(PathBuf, OutputFile, Option<OutputFile>), Failure> {
        let default = || PathBuf::from(format!("{}.png", loaded.name.replace('/', "-")));
        let path = self.output.clone().unwrap_or_else(default);
        let picture = output::picture("-o", &path, inputs)?;
        let numbers = Some(path.with_extension("csv")).filter(|_| picture.is_file());
        let numbers = output::table("-o: the numbers of the picture go to", numbers.as_deref(), inputs)?;
        Ok((path, picture, numbers))
    }

    /// The records of the scenario of this name or file, or in this folder; and their folder.
    fn load(&self, context: &Context<'_>) -> Result<(LoadedSweep, PathBuf), Failure> {
        let folder = Path::new(&self.sweep);
        if folder.join(calibench_records::names::SCENARIO).is_file() {
            // Records say whose they are: of a scenario in a family, or in none.
            let of = |levels: usize| {
                let parts: Vec<_> = folder.components().rev().take(levels).map(|part| part.as_os_str().to_string_lossy()).collect();
                let name = parts.into_iter().rev().collect::<Vec<_>>().join("/");
                sweep::load(folder.ancestors().nth(levels).unwrap_or(Path::new("")), &name)
            };
            let found = of(2).or_else(|_| of(1))?;
            let found = found.ok_or_else(|| Failure::input(format!("{}: these records are not of a sweep", folder.display())))?;
            return Ok((found, folder.to_owned()));
        }
        let scenario = context.scenario(&self.sweep)?;
        if scenario.sweep.is_none() {
            return Err(Failure::input(format!("`{}` has no [sweep]; expected a scenario that sweeps a key", scenario.name)));
        }
        let records = context.places()?.records;
        let found = sweep::load(&records, &scenario.name)?;
        let found =
            found.ok_or_else(|| Failure::input(format!("no records of `{0}`: run it first with `calibench run {0}`", self.sweep)))?;
        Ok((found, records.join(&scenario.name)))
    }
}
