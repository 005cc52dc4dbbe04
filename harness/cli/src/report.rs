//! `calibench report`.

use calibench_report::{FamilyPages, ONE_FILE, Written, family_pages, fill, one_file};
use clap::Args;

use super::context::Context;
use super::lanes::{lanes, side_by_side};
use crate::failure::Failure;

#[derive(Args)]
pub struct Report {
    /// Papers or other families of scenarios, as in galo-2011 [default: all]
    #[arg(value_name = "PAPER")]
    papers: Vec<String>,
    /// Write all of it into one file, reports/html/report.html, and leave the Markdown and its pictures as they are
    #[arg(long)]
    html: bool,
}

impl Report {
    /// The pages of one family.
    pub fn of_family(family: &str) -> Self {
        Self { papers: vec![family.to_owned()], html: false }
    }

    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let (places, families) = (context.places()?, context.families(&self.papers)?);
        if self.html {
            let pages = |(family, scenarios): &(&String, &Vec<String>)| family_pages(&places, family, scenarios);
            let pages: Vec<FamilyPages> = side_by_side(&families.iter().collect::<Vec<_>>(), lanes(), pages)?;
            let folder = places.reports.join("html");
            std::fs::create_dir_all(&folder).map_err(|error| calibench_files::at(&folder, &error))?;
            calibench_files::folder::write_beside(&folder, ONE_FILE, one_file(&pages).as_bytes())?;
            if !context.quiet {
                say!("{}", folder.join(ONE_FILE).display());
            }
            return Ok(());
        }
        let make = |(family, scenarios): &(&String, &Vec<String>)| fill(&places, family, scenarios);
        let mut written = Vec::new();
        for made in side_by_side(&families.iter().collect::<Vec<_>>(), lanes(), make)? {
            let put = made.put()?;
            match &put {
                Written::New(page) if !context.quiet => say!("{}", page.display()),
                Written::Kept(page) if !context.quiet => {
                    say!("{}: kept as it is, nothing of it can be measured here", page.display());
                }
                _ => {}
            }
            written.push(put);
        }
        Ok(calibench_report::write_index(&places.reports, &written)?)
    }
}
