//! `calibench report`.

use std::collections::BTreeMap;

use calibench_diagnostics::nearest;
use calibench_report::{Written, conventions};
use clap::Args;

use super::context::Context;
use super::lanes::{lanes, side_by_side};
use crate::failure::Failure;

#[derive(Args)]
pub struct Report {
    /// Papers or other families of scenarios, as in galo-2011 [default: all]
    #[arg(value_name = "PAPER")]
    papers: Vec<String>,
}

impl Report {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let mut families: BTreeMap<String, Vec<String>> = BTreeMap::new();
        let places = context.places()?;
        let mut names = context.scenario_names()?;
        names.extend(calibench_report::recorded(&places.records).into_iter().filter(|name| name.starts_with("local/")));
        names.sort();
        names.dedup();
        for name in names {
            families.entry(name.split('/').next().unwrap_or(&name).to_owned()).or_default().push(name);
        }
        if context.folder()?.is_some() {
            families.insert(conventions::FAMILY.to_owned(), Vec::new());
        } else if families.is_empty() {
            return Err(Failure::input(format!("{}: no records; `calibench run FILE.toml` makes them", places.records.display())));
        }
        for paper in &self.papers {
            if !families.contains_key(paper) {
                let known: Vec<&str> = families.keys().map(String::as_str).collect();
                let near = nearest(paper, known.iter().copied()).map_or(String::from("."), |near| format!(", did you mean `{near}`?"));
                return Err(Failure::input(format!("no report is called `{paper}`{near} Known are {}.", known.join(", "))));
            }
        }
        if !self.papers.is_empty() {
            families.retain(|family, _| self.papers.contains(family));
        }
        let write = |(family, scenarios): &(&String, &Vec<String>)| {
            let written = if *family == conventions::FAMILY {
                Written::New(conventions::write(&places)?)
            } else {
                calibench_report::write(&places, family, scenarios)?
            };
            match written {
                Written::New(page) if !context.quiet => say!("{}", page.display()),
                Written::Kept(page) if !context.quiet => {
                    say!("{}: kept as it is, nothing of it can be measured here", page.display());
                }
                _ => {}
            }
            Ok::<_, Failure>(())
        };
        side_by_side(&families.iter().collect::<Vec<_>>(), lanes(), write)?;
        Ok(calibench_report::write_index(&places.reports)?)
    }
}
