//! Other scenarios that a `[transfer]` names.

use std::path::Path;

use calibench_diagnostics::{Problem, Problems};
use calibench_measure::Registry;
use toml::Spanned;
use toml::de::DeTable;

use super::section::Section;
use super::studies::transfer::{self, Site};
use super::subject::Study;
use super::{Resolved, Scenario, Subject, ViewsSubject};

/// Where other scenarios are found, and how they are read.
#[derive(Clone, Copy)]
pub struct Surroundings<'a> {
    /// The name of the scenario that names them.
    pub name: &'a str,
    /// The folder of its file.
    pub folder: &'a Path,
    /// The methods that there are.
    pub registry: &'a Registry,
    /// Reads a scenario: name, path, text.
    pub parse: fn(&str, &str, &str, &Registry) -> Result<Scenario, Problems>,
}

impl Surroundings<'_> {
    /// The field where calibrations are applied, with the `[transfer]` of `section`; what was read for it is added to what is `resolved`.
    pub fn read(&self, section: Section<'_>, resolved: &mut Resolved, problems: &mut Vec<Problem>) -> Option<ViewsSubject> {
        let mut found = Vec::new();
        let mut site = |file: &Spanned<String>| {
            let (views, other) = self.views(file.get_ref())?;
            *resolved = std::mem::take(resolved).with_scenario(&other);
            let site = Site { camera: views.camera, field: views.field.clone(), stations: views.stations.clone() };
            found.push(views);
            Ok(site)
        };
        let transfer = transfer::read(section, self.registry, &mut site, problems)?;
        // The first that is asked for is where calibrations are applied, the second has the board, which the same camera pictures.
        let mut found = found.into_iter();
        let views = found.next()?;
        let board = found.next().map(|board| Box::new(ViewsSubject { camera: views.camera, ..board }));
        // Whatever the scenario makes of its points and images: here nothing is measured.
        Some(ViewsSubject { recognition: None, study: Study::Transfer { plan: Box::new(transfer), board }, ..views })
    }

    /// The views of the scenario in `file`, or what is wrong with it.
    fn views(&self, file: &str) -> Result<(ViewsSubject, Resolved), String> {
        let path = self.folder.join(file);
        let text = calibench_files::bounded::text(&path).map_err(|error| format!("`{file}` cannot be read: {error}"))?;
        // Before anything else: two files could name each other.
        let (root, _) = DeTable::parse_recoverable(&text);
        if root.get_ref().contains_key("transfer") {
            return Err(format!("`{file}` has a [transfer] itself: expected a scenario with [camera], [testfield] and stations"));
        }
        let scenario = (self.parse)(&self.name_of(file), &path.display().to_string(), &text, self.registry)
            .map_err(|problems| format!("`{file}` has mistakes of its own: {}", problems.to_string().replace('\n', "; ")))?;
        match scenario.subject {
            Subject::Views(views) if scenario.sweep.is_none() => Ok((*views, scenario.resolved)),
            _ => Err(format!("`{file}` is another kind of scenario: expected one with [camera], [testfield] and stations, not swept")),
        }
    }

    /// The name that the scenario has by itself.
    fn name_of(&self, file: &str) -> String {
        let stem = Path::new(file).with_extension("").to_string_lossy().replace('\\', "/");
        self.name.rsplit_once('/').map_or_else(|| stem.clone(), |(family, _)| format!("{family}/{stem}"))
    }
}
