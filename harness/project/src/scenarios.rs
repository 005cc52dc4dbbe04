//! A project's scenarios, and those of users' own files.

use std::path::{Path, PathBuf};

use calibench_cameras::inputs_of;
use calibench_files::Inputs;
use calibench_scenario::catalogue::{Catalogue, LOCAL, is_toml};
use calibench_scenario::{Scenario, Subject};

use crate::{Project, ProjectError};

impl Project<'_> {
    /// Its scenarios.
    ///
    /// # Errors
    /// There is no project.
    pub fn catalogue(&self) -> Result<Catalogue, ProjectError> {
        Ok(Catalogue::new(self.root()?.join("scenarios")))
    }

    /// The names of its scenarios; outside of a project there are none.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn scenario_names(&self) -> Result<Vec<String>, ProjectError> {
        self.folder()?.map_or(Ok(Vec::new()), |root| Ok(Catalogue::new(root.join("scenarios")).names()?))
    }

    /// The scenario called `name`, or of the file `name`, which needs no project.
    ///
    /// # Errors
    /// An unknown name, a file that cannot be read, mistakes with their places.
    pub fn scenario(&self, name: &str) -> Result<Scenario, ProjectError> {
        let catalogue = match self.folder()? {
            Some(root) => Catalogue::new(root.join("scenarios")),
            None if is_toml(Path::new(name)) => Catalogue::outside(),
            None => return Err(ProjectError::NameOutside(name.to_owned())),
        };
        Ok(catalogue.load(name, self.registry()?)?)
    }

    /// The scenarios of these names or files, each once and under a name of its own.
    ///
    /// # Errors
    /// As [`Self::scenario`]; one that is asked for twice, two of one name.
    pub fn scenarios(&self, names: &[String]) -> Result<Vec<Scenario>, ProjectError> {
        let mut loaded: Vec<Scenario> = Vec::new();
        for (place, name) in names.iter().enumerate() {
            let scenario = self.scenario(name)?;
            if let Some(earlier) = loaded.iter().position(|earlier| earlier.name == scenario.name) {
                let (earlier, called) = (&names[earlier], &scenario.name);
                return Err(ProjectError::Asked(if names[..place].contains(name) {
                    format!("{name}: asked for twice; expected each scenario once")
                } else {
                    format!(
                        "{earlier} and {name}: both are called `{called}`, and one would replace the other; rename one, or take one at a time"
                    )
                }));
            }
            loaded.push(scenario);
        }
        Ok(loaded)
    }

    /// What is read with the scenario `name`: its file, its camera, its board, its photographs.
    pub fn inputs(&self, name: &str, scenario: &Scenario) -> Inputs {
        let file = Some(PathBuf::from(name)).filter(|path| is_toml(path));
        let beside: Vec<PathBuf> = match &scenario.subject {
            Subject::Views(views) => views.files().map(Into::into).collect(),
            Subject::Scene(_) | Subject::Photographs(_) | Subject::Printed(_) => Vec::new(),
        };
        let photographs = match (&scenario.subject, self.data()) {
            (Subject::Photographs(found), Ok(data)) => found.files.iter().map(|file| data.join(&found.folder).join(file)).collect(),
            _ => Vec::new(),
        };
        inputs_of(file.into_iter().chain(beside).chain(photographs))
    }
}

/// The file of `scenario`, which was asked for as `name`, if it is not one of the project's.
pub fn origin<'n>(name: &'n str, scenario: &Scenario) -> Option<&'n Path> {
    Some(Path::new(name)).filter(|path| is_toml(path) && scenario.name.starts_with(LOCAL))
}
