//! `calibench report`.

use std::collections::{BTreeMap, BTreeSet};

use calibench_calibrate::few;
use calibench_report::{FamilyPages, ONE_FILE, Written, family_pages, fill, one_file, recorded};
use clap::Args;

use super::context::Context;
use super::lanes::{lanes, side_by_side};
use crate::failure::Failure;

/// The family whose report says itself what was not run.
const LEAGUE: &str = "league";
/// The family whose report is of all its scenarios or of none.
const ATLAS: &str = "atlas";

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

    /// Takes out the families of which no scenario was run, unless they were asked for by name; what is to be said of these, and of scenarios that others lack.
    fn without_records(&self, families: &mut BTreeMap<String, Vec<String>>, recorded: &BTreeSet<String>) -> Result<Vec<String>, Failure> {
        let mut said = Vec::new();
        let lacks = |names: &[String]| names.iter().filter(|name| !recorded.contains(*name)).cloned().collect::<Vec<_>>();
        let mut none = Vec::new();
        for (family, names) in &*families {
            let lacking = lacks(names);
            if lacking.is_empty() || family == LEAGUE {
                continue;
            }
            if lacking.len() == names.len() || family == ATLAS {
                none.push(family.clone());
            } else {
                said.push(format!(
                    "{family}: {} of {} scenarios were not run and are left out ({}); `calibench run {family}` runs all",
                    lacking.len(),
                    names.len(),
                    few(&lacking)
                ));
            }
        }
        if self.papers.is_empty() && !none.is_empty() {
            if none.len() == families.len() {
                return Err(Failure::input(
                    "no scenario was run: `calibench run FAMILY` runs those of a family, `calibench run --all` every one",
                ));
            }
            families.retain(|family, _| !none.contains(family));
            said.push(format!("not run, so that there is no report of them: {}", few(&none)));
        }
        Ok(said)
    }

    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let (places, mut families) = (context.places()?, context.families(&self.papers)?);
        let recorded: BTreeSet<String> = recorded(&places.records).into_iter().collect();
        for line in self.without_records(&mut families, &recorded)? {
            say!("{line}");
        }
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
