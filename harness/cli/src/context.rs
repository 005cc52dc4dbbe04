//! Where the project is and what belongs to it.

use std::path::{Path, PathBuf};
use std::process::Command;

use calibench_diagnostics::nearest;
use calibench_measure::{Configured, MethodError};
use calibench_report::Places;
use calibench_scenario::Scenario;
use calibench_scenario::catalogue::Catalogue;
use calibench_scenario::data::data_folder;

use crate::failure::{Failure, scenario_failure};
use crate::toolbox::Toolbox;

/// What every command gets.
pub struct Context<'a> {
    /// The project's folder, if the user named it.
    pub root: Option<PathBuf>,
    /// No progress?
    pub quiet: bool,
    /// What this build can do.
    pub toolbox: &'a Toolbox,
}

impl Context<'_> {
    /// The project's folder: named, or the nearest one upwards that holds scenarios/ and reference/.
    pub fn root(&self) -> Result<PathBuf, Failure> {
        let is_root = |folder: &Path| folder.join("scenarios").is_dir() && folder.join("reference").is_dir();
        if let Some(root) = &self.root {
            return if is_root(root) {
                Ok(root.clone())
            } else {
                Err(Failure::input(format!("--root {}: expected a folder that holds scenarios/ and reference/", root.display())))
            };
        }
        let here = std::env::current_dir()?;
        here.ancestors().find(|folder| is_root(folder)).map(Path::to_owned).ok_or_else(|| {
            Failure::input("no folder with scenarios/ and reference/ from here upwards; go to the project or name it with --root DIR")
        })
    }

    /// The scenarios.
    pub fn catalogue(&self) -> Result<Catalogue, Failure> {
        Ok(Catalogue::new(self.root()?.join("scenarios")))
    }

    /// The scenario called `name`, or of the file `name`.
    pub fn scenario(&self, name: &str) -> Result<Scenario, Failure> {
        self.catalogue()?.load(name, &self.toolbox.registry).map_err(scenario_failure)
    }

    /// The method that `text` names, with the nearest name for a misspelt one.
    pub fn method(&self, text: &str) -> Result<Configured, Failure> {
        let registry = &self.toolbox.registry;
        registry.parse(text).map_err(|error| {
            let proposal = match &error {
                MethodError::UnknownMethod { name, known } => nearest(name, known.iter().map(String::as_str)),
                MethodError::UnknownParameter { key, known, .. } => nearest(key, known.iter().map(String::as_str)),
                _ => None,
            };
            Failure::input(format!("-m {text}: {error}{}", proposal.map_or(String::new(), |near| format!("; did you mean `{near}`?"))))
        })
    }

    /// Where photographs are.
    pub fn data(&self) -> Result<PathBuf, Failure> {
        Ok(data_folder(&self.root()?))
    }

    /// Where records, published tables and reports are.
    pub fn places(&self) -> Result<Places, Failure> {
        let root = self.root()?;
        let [records, published, cameras, reports] =
            ["records", "reference/published", "reference/cameras", "reports"].map(|folder| root.join(folder));
        Ok(Places { records, published, cameras, reports })
    }

    /// The code's revision for records: that of the checkout, or the version of the program outside of one.
    pub fn revision(&self) -> Result<String, Failure> {
        let git = Command::new("git")
            .arg("-C")
            .arg(self.root()?)
            .args(["describe", "--always", "--dirty", "--abbrev=12", "--exclude=*"])
            .output();
        let revision =
            git.ok().filter(|output| output.status.success()).map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
        Ok(revision.unwrap_or_else(|| env!("CARGO_PKG_VERSION").to_owned()))
    }
}
