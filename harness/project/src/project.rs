//! A project's folder and what belongs to it.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use calibench_calibrators::{Listed, own, programs};
use calibench_files::folder::is_project;
use calibench_measure::Registry;
use calibench_plugins::{Launcher, PluginError, calibrators, load};
use calibench_report::Places;
use calibench_run::Tools;
use calibench_scenario::data::data_folder;

use crate::{ProjectError, Toolbox, answered_camera};

/// The project's folder of plug-ins.
const PLUGINS: &str = "methods";

/// Where the project is, and what this build can do.
pub struct Project<'a> {
    /// Its folder, if the user named it.
    pub root: Option<PathBuf>,
    /// The folder of plug-ins, if the user named it.
    pub plugins: Option<PathBuf>,
    /// What this build can do.
    pub toolbox: &'a Toolbox,
    /// What restricts itself and then becomes a plug-in, asked for where there is one: a program and its first arguments.
    pub confiner: fn() -> Option<Vec<OsString>>,
    /// All methods, once somebody asked for them: empty at first.
    pub methods: OnceLock<Registry>,
    /// All calibrators, alike.
    pub calibrators: OnceLock<Vec<Listed>>,
}

impl<'a> Project<'a> {
    /// The project around the current folder, with plug-ins started as they are.
    pub const fn new(toolbox: &'a Toolbox) -> Self {
        Self { root: None, plugins: None, toolbox, confiner: || None, methods: OnceLock::new(), calibrators: OnceLock::new() }
    }
}

/// The current folder.
///
/// # Errors
/// It is gone, or cannot be named.
pub fn here() -> Result<PathBuf, ProjectError> {
    std::env::current_dir().map_err(ProjectError::Here)
}

impl Project<'_> {
    /// Its folder: named, or the nearest one upwards that holds scenarios/ and reference/, if there is one.
    ///
    /// # Errors
    /// A named folder that is no project; a current folder that cannot be read.
    pub fn folder(&self) -> Result<Option<PathBuf>, ProjectError> {
        if let Some(root) = &self.root {
            return if is_project(root) { Ok(Some(root.clone())) } else { Err(ProjectError::NoProject(root.clone())) };
        }
        let here = here()?;
        Ok(here.ancestors().find(|folder| is_project(folder)).map(Path::to_owned))
    }

    /// Its folder, where there must be one.
    ///
    /// # Errors
    /// As [`Self::folder`]; there is none.
    pub fn root(&self) -> Result<PathBuf, ProjectError> {
        self.folder()?.ok_or(ProjectError::Outside)
    }

    /// Its folder, or the current one outside of a project: there records and reports of one's own files are.
    fn base(&self) -> Result<PathBuf, ProjectError> {
        self.folder()?.map_or_else(here, Ok)
    }

    /// All methods: those of this build, and the plug-ins of the folder that the user named, or of the project.
    ///
    /// # Errors
    /// As [`Self::folder`]; plug-ins that are none.
    pub fn registry(&self) -> Result<&Registry, ProjectError> {
        if let Some(methods) = self.methods.get() {
            return Ok(methods);
        }
        let builtin = self.toolbox.registry.clone();
        let methods = match self.plugins()? {
            Some(folder) => load(&folder, builtin, &self.launcher()?)?,
            None => builtin,
        };
        Ok(self.methods.get_or_init(|| methods))
    }

    /// The folder of plug-ins, if there is one.
    fn plugins(&self) -> Result<Option<PathBuf>, ProjectError> {
        let own = self.folder()?.map(|root| root.join(PLUGINS)).filter(|folder| folder.is_dir());
        Ok(self.plugins.clone().or(own))
    }

    /// All calibrators: our own, and those of the folder of plug-ins.
    ///
    /// # Errors
    /// As [`Self::registry`]; one that is called as one of ours.
    pub fn calibrators(&self) -> Result<&[Listed], ProjectError> {
        if let Some(all) = self.calibrators.get() {
            return Ok(all);
        }
        let mut all = own();
        if let Some(folder) = self.plugins()? {
            let others = programs(calibrators(&folder, &self.launcher()?)?, answered_camera);
            if let Some(taken) = others.iter().find(|other| all.iter().any(|own| own.name == other.name)) {
                return Err(PluginError::Taken { path: folder, name: taken.name.clone() }.into());
            }
            all.extend(others);
        }
        Ok(self.calibrators.get_or_init(|| all))
    }

    /// What a run has beside its methods.
    ///
    /// # Errors
    /// As [`Self::calibrators`].
    pub fn tools(&self) -> Result<Tools<'_>, ProjectError> {
        Ok(Tools { calibrators: self.calibrators()?, ..self.toolbox.tools() })
    }

    /// The methods among which the one that `text` names is: those of this build, if it is one of them. Plug-ins are looked for where it is none, and where the user
    /// named their folder.
    ///
    /// # Errors
    /// As [`Self::registry`].
    pub(crate) fn registry_with(&self, text: &str) -> Result<&Registry, ProjectError> {
        let own = &self.toolbox.registry;
        if self.plugins.is_none() && own.has(text) { Ok(own) } else { self.registry() }
    }

    /// How plug-ins are started.
    ///
    /// # Errors
    /// As [`Self::folder`].
    pub fn launcher(&self) -> Result<Launcher, ProjectError> {
        Ok(Launcher { confiner: (self.confiner)(), project: self.folder()? })
    }

    /// Where photographs are.
    ///
    /// # Errors
    /// As [`Self::folder`].
    pub fn data(&self) -> Result<PathBuf, ProjectError> {
        Ok(data_folder(&self.base()?))
    }

    /// Where records, published tables and reports are.
    ///
    /// # Errors
    /// As [`Self::folder`].
    pub fn places(&self) -> Result<Places, ProjectError> {
        let root = self.base()?;
        let [records, published, cameras, league, reports] =
            ["records", "reference/published", "reference/cameras", "reference/league", "reports"].map(|folder| root.join(folder));
        Ok(Places { records, published, cameras, league, reports })
    }

    /// The code's revision for records: that of the checkout, or the version of the program outside of one.
    ///
    /// # Errors
    /// As [`Self::folder`].
    pub fn revision(&self) -> Result<String, ProjectError> {
        let describe = |root: PathBuf| {
            let git =
                Command::new("git").arg("-C").arg(root).args(["describe", "--always", "--dirty", "--abbrev=12", "--exclude=*"]).output();
            git.ok().filter(|output| output.status.success()).map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned())
        };
        let revision = self.folder()?.and_then(describe);
        Ok(revision.unwrap_or_else(|| env!("CARGO_PKG_VERSION").to_owned()))
    }
}
