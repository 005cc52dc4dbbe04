//! `calibench report`.

use calibench_project::write_family;
use calibench_report::Written;
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
        let (places, families) = (context.places()?, context.families(&self.papers)?);
        let write = |(family, scenarios): &(&String, &Vec<String>)| {
            let written = write_family(&places, family, scenarios)?;
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
