//! Which reports there are, and writing them.

use std::collections::BTreeMap;

use calibench_diagnostics::nearest;
use calibench_report::conventions;

use crate::{Project, ProjectError};

impl Project<'_> {
    /// Families of scenarios, each with its scenarios, those of users' own files too: of `papers`, or all where none are named. Each has a report.
    ///
    /// # Errors
    /// A paper that there is not, with the nearest name; outside of a project no records at all.
    pub fn families(&self, papers: &[String]) -> Result<BTreeMap<String, Vec<String>>, ProjectError> {
        let places = self.places()?;
        let mut names = self.scenario_names()?;
        names.extend(calibench_report::recorded(&places.records).into_iter().filter(|name| name.starts_with("local/")));
        names.sort();
        names.dedup();
        let mut families: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for name in names {
            families.entry(name.split('/').next().unwrap_or(&name).to_owned()).or_default().push(name);
        }
        // A project of one's own has no published cameras: only who asks for them by name is told.
        if self.folder()?.is_some() && (places.cameras.is_dir() || papers.iter().any(|paper| paper == conventions::FAMILY)) {
            families.insert(conventions::FAMILY.to_owned(), Vec::new());
        }
        if families.is_empty() {
            return Err(ProjectError::Asked(format!("{}: no records; `calibench run FILE.toml` makes them", places.records.display())));
        }
        for paper in papers {
            if !families.contains_key(paper) {
                let known: Vec<&str> = families.keys().map(String::as_str).collect();
                let near = nearest(paper, known.iter().copied()).map_or(String::from("."), |near| format!(", did you mean `{near}`?"));
                return Err(ProjectError::Asked(format!("no report is called `{paper}`{near} Known are {}.", known.join(", "))));
            }
        }
        if !papers.is_empty() {
            families.retain(|family, _| papers.contains(family));
        }
        Ok(families)
    }
}
