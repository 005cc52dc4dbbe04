//! `calibench report`.

use std::collections::BTreeMap;

use clap::Args;

use super::Failure;
use super::context::Context;
use crate::report;
use crate::scenario::problem::nearest;

#[derive(Args)]
pub struct Report {
    /// Papers or other families of scenarios, as in galo-2011 [default: all]
    #[arg(value_name = "PAPER")]
    papers: Vec<String>,
}

impl Report {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let mut families: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for name in context.catalogue()?.names()? {
            families.entry(name.split('/').next().unwrap_or(&name).to_owned()).or_default().push(name);
        }
        for paper in &self.papers {
            if !families.contains_key(paper) {
                let known: Vec<&str> = families.keys().map(String::as_str).collect();
                let near = nearest(paper, known.iter().copied()).map_or(String::new(), |near| format!(", did you mean `{near}`?"));
                return Err(Failure::input(format!("no report is called `{paper}`{near} Known are {}.", known.join(", "))));
            }
        }
        let places = context.places()?;
        for (family, scenarios) in &families {
            if self.papers.is_empty() || self.papers.contains(family) {
                let page = report::write(&places, family, scenarios, &context.toolbox.registry)?;
                if !context.quiet {
                    eprintln!("{}", page.display());
                }
            }
        }
        Ok(report::write_index(&places.reports)?)
    }
}
