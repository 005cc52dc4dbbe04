//! `calibench plot`: the records of a sweep as curves or maps.

use std::path::{Path, PathBuf};

use calibench_exchange::atomic::write_atomically;
use calibench_report::sweep;
use calibench_report::sweep::{Choice, Layout, LoadedSweep, Metric};
use clap::Args;

use super::context::Context;
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
    #[arg(long, value_enum, default_value_t = Metric::Rmse)]
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
    /// The picture; its numbers stand beside it as CSV [default: the scenario's name with .png, in the current folder]
    #[arg(short, long, value_name = "PNG")]
    output: Option<PathBuf>,
}

fn pair(text: &str) -> Result<(String, String), String> {
    let (key, value) = text.split_once('=').ok_or_else(|| "expected KEY=VALUE, as in blur=0.5".to_owned())?;
    Ok((key.to_owned(), value.to_owned()))
}

impl Plot {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let loaded = self.load(context)?;
        let choice = Choice {
            x: self.x.clone(),
            by: Some(self.map.clone().unwrap_or_else(|| self.by.clone())),
            facet: self.facet.clone(),
            at: self.at.clone(),
            methods: self.methods.clone(),
        };
        let layout = Layout::new(&loaded, &choice, self.y, self.map.is_some())?;
        let picture = if self.map.is_some() { sweep::map(&loaded, &layout) } else { sweep::curves(&loaded, &layout) };
        let default = || PathBuf::from(format!("{}.png", loaded.scenario.name.replace('/', "-")));
        let path = self.output.clone().unwrap_or_else(default);
        let numbers = path.with_extension("csv");
        if numbers == path {
            return Err(Failure::input(format!("-o {}: the numbers go there; expected the name of a PNG", path.display())));
        }
        picture.write(&path).map_err(|error| Failure::input(format!("{}: {error}", path.display())))?;
        write_atomically(&numbers, |file| sweep::write_numbers(file, &loaded, &layout).map_err(std::io::Error::other))?;
        print(&format!("{}\n{}\n", path.display(), numbers.display()))
    }

    /// The records of the scenario of this name or file, or in this folder.
    fn load(&self, context: &Context<'_>) -> Result<LoadedSweep, Failure> {
        let registry = &context.toolbox.registry;
        let folder = Path::new(&self.sweep);
        if folder.join(calibench_records::names::SCENARIO).is_file() {
            let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let found = sweep::load(folder.parent().unwrap_or(Path::new("")), &name, registry)?;
            return found.ok_or_else(|| Failure::input(format!("{}: these records are not of a sweep", folder.display())));
        }
        let scenario = context.scenario(&self.sweep)?;
        if scenario.sweep.is_none() {
            return Err(Failure::input(format!("`{}` has no [sweep]; expected a scenario that sweeps a key", scenario.name)));
        }
        let found = sweep::load(&context.places()?.records, &scenario.name, registry)?;
        found.ok_or_else(|| Failure::input(format!("no records of `{0}`: run it first with `calibench run {0}`", scenario.name)))
    }
}
