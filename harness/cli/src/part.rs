//! Parts of a run: `calibench run --part`, and `calibench merge`.

use std::path::PathBuf;

use calibench_records::parts::{Manifest, Part};
use calibench_run::parts::{Done, Merged, Wanted, merge};
use calibench_run::store::RecordsFolder;
use calibench_scenario::Scenario;
use clap::Args;

use super::context::{Context, origin};
use super::output;
use crate::failure::Failure;

/// Which part of a run is wanted, if not the whole.
#[derive(Args)]
pub struct Parts {
    /// Run one part of N alone, on this machine; `merge` puts all parts together
    #[arg(long, value_name = "K/N", requires = "output")]
    part: Option<Part>,
    /// With --part: the folder of parts; this one goes to DIR/K-of-N/SCENARIO, and is left as it is if it is there
    #[arg(short, long, value_name = "DIR", requires = "part")]
    output: Option<PathBuf>,
    /// With --part: run it again if it is there, in place of that one
    #[arg(long, requires = "part")]
    again: bool,
}

/// Where what is run goes.
pub enum Place {
    /// To the records.
    Records(RecordsFolder),
    /// To a folder of parts.
    Part(PartPlace),
}

/// Where a part goes.
pub struct PartPlace {
    /// Which one.
    pub part: Part,
    folder: PathBuf,
    origin: Option<PathBuf>,
    again: bool,
}

impl Place {
    /// For a run of the code's `revision`.
    pub fn of_run<'a>(&'a self, revision: &'a str) -> calibench_run::Place<'a> {
        match self {
            Self::Records(folder) => calibench_run::Place::Records(folder),
            Self::Part(part) => calibench_run::Place::Part(part.wanted(revision)),
        }
    }
}

impl PartPlace {
    /// The part that is wanted.
    pub fn wanted<'a>(&'a self, revision: &'a str) -> Wanted<'a> {
        Wanted { folder: &self.folder, part: self.part, origin: self.origin.as_deref(), again: self.again, revision }
    }
}

impl Parts {
    /// Whether a part is wanted, and not the whole.
    pub fn are_asked_for(&self) -> bool {
        self.part.is_some()
    }

    /// Where `scenario`, which was asked for as `name`, goes.
    pub fn place(&self, context: &Context<'_>, name: &str, scenario: &Scenario) -> Result<Place, Failure> {
        let (origin, inputs) = (origin(name, scenario), context.inputs(name, scenario));
        if let (Some(part), Some(folder)) = (self.part, &self.output) {
            output::apart(&folder.join(part.folder()).join(&scenario.name), &inputs)?;
            let origin = origin.map(ToOwned::to_owned);
            return Ok(Place::Part(PartPlace { part, folder: folder.clone(), origin, again: self.again }));
        }
        let records = context.places()?.records;
        output::apart(&records.join(&scenario.name), &inputs)?;
        Ok(Place::Records(RecordsFolder::open(&records, &scenario.name, origin)?))
    }
}

/// What a part is, or why it could not be measured, after the time that it took.
pub fn told(done: &Done, missing: Option<String>, time: &str) -> String {
    let Manifest { part, of, cells, pieces, swept, .. } = &done.manifest;
    let (mine, all) = (done.manifest.trials(), done.manifest.all_trials());
    let trials = match (mine, all) {
        (0, 1) => "nothing, what cannot be cut is part 1".to_owned(),
        (0, _) => format!("nothing, {all} trials are fewer than the parts"),
        _ if *swept => format!("{mine} of {all} trials, of {} of {} cells,", pieces.len(), cells.len()),
        _ => format!("{mine} of {all} trials"),
    };
    let how = match missing {
        _ if done.there => ", already there".to_owned(),
        _ if mine == 0 => String::new(),
        Some(why) => format!(", unavailable: {why}"),
        None => format!(" {time}"),
    };
    format!("part {part}/{of}: {trials}{how}")
}

/// `calibench merge`.
#[derive(Args)]
pub struct Merge {
    /// Folders of parts, or folders with such in them
    #[arg(required = true, value_name = "DIR")]
    parts: Vec<PathBuf>,
    /// The folder of records: a run goes to DIR/SCENARIO [default: records/ of the project]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

impl Merge {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let records = match &self.output {
            Some(folder) => folder.clone(),
            None => context.places()?.records,
        };
        let merged = merge(&self.parts, &records)?;
        for run in merged.iter().filter(|_| !context.quiet) {
            say!("{}: {}, in {}", run.scenario, summary(run), records.join(&run.scenario).display());
        }
        // As a run says it.
        for (name, note) in merged.iter().flat_map(|run| &run.notes) {
            say!("{name}: {note}");
        }
        let nothing: Vec<&str> = merged.iter().filter(|run| run.measured == 0).map(|run| run.scenario.as_str()).collect();
        if nothing.len() < merged.len() { Ok(()) } else { Err(Failure::input(format!("{}: nothing was measured", nothing.join(", ")))) }
    }
}

fn summary(run: &Merged) -> String {
    let plural = |count: u64, noun: &str| if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") };
    let cells = if run.cells > 1 { format!(" of {} cells", run.cells) } else { String::new() };
    let nothing = if run.measured == 0 { ", in which nothing was measured" } else { "" };
    format!("{}{cells} from {}{nothing}", plural(run.trials, "trial"), plural(run.parts, "part"))
}
