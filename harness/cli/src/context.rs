//! The project, as commands see it: what is wrong with it is why a command fails.

use std::collections::BTreeMap;
use std::path::PathBuf;

use calibench_files::Inputs;
use calibench_measure::{Configured, Registry};
use calibench_model::TargetKind;
use calibench_model::boards::Board;
use calibench_photographs::Finder;
use calibench_plugins::Launcher;
use calibench_project::{Project, Toolbox};
use calibench_report::Places;
use calibench_run::Tools;
use calibench_scenario::Scenario;
use calibench_scenario::catalogue::Catalogue;

pub use calibench_project::{Pictured, origin};

use crate::confined::CONFINED;
use crate::failure::{Failure, project_failure};

/// What every command gets.
pub struct Context<'a> {
    /// What this build can do.
    pub toolbox: &'a Toolbox,
    /// Whether progress is not shown.
    pub quiet: bool,
    project: Project<'a>,
}

impl<'a> Context<'a> {
    /// The project of `root`, or else around the current folder, with the plug-ins of a folder, or else its own. They are started by this program, which
    /// restricts itself and then becomes the plug-in.
    pub fn new(toolbox: &'a Toolbox, quiet: bool, root: Option<PathBuf>, plugins: Option<PathBuf>) -> Self {
        let confiner = || std::env::current_exe().ok().map(|program| vec![program.into_os_string(), CONFINED.into()]);
        Self { toolbox, quiet, project: Project { root, plugins, confiner, ..Project::new(toolbox) } }
    }
}

/// What finds a board in photographs.
pub fn finder(board: Board) -> Result<Finder, Failure> {
    Finder::new(board).map_err(|error| Failure::input(error.to_string()))
}

/// As the project's own.
impl Context<'_> {
    /// The project's folder, if there is one.
    pub fn folder(&self) -> Result<Option<PathBuf>, Failure> {
        self.project.folder().map_err(project_failure)
    }

    pub fn root(&self) -> Result<PathBuf, Failure> {
        self.project.root().map_err(project_failure)
    }

    pub fn registry(&self) -> Result<&Registry, Failure> {
        self.project.registry().map_err(project_failure)
    }

    pub fn tools(&self) -> Result<Tools<'_>, Failure> {
        self.project.tools().map_err(project_failure)
    }

    pub fn launcher(&self) -> Result<Launcher, Failure> {
        self.project.launcher().map_err(project_failure)
    }

    pub fn catalogue(&self) -> Result<Catalogue, Failure> {
        self.project.catalogue().map_err(project_failure)
    }

    pub fn scenario(&self, name: &str) -> Result<Scenario, Failure> {
        self.project.scenario(name).map_err(project_failure)
    }

    pub fn scenarios(&self, names: &[String]) -> Result<Vec<Scenario>, Failure> {
        self.project.scenarios(names).map_err(project_failure)
    }

    pub fn method_of_boards(&self, text: &str, kind: TargetKind) -> Result<Configured, Failure> {
        self.project.method_of_boards(text, kind).map_err(project_failure)
    }

    pub fn methods_of_boards(&self, texts: &[String], kind: TargetKind) -> Result<Vec<Configured>, Failure> {
        self.project.methods_of_boards(texts, kind).map_err(project_failure)
    }

    pub fn methods(&self, texts: &[String], pictured: Pictured) -> Result<Vec<Configured>, Failure> {
        self.project.methods(texts, pictured).map_err(project_failure)
    }

    pub fn data(&self) -> Result<PathBuf, Failure> {
        self.project.data().map_err(project_failure)
    }

    pub fn places(&self) -> Result<Places, Failure> {
        self.project.places().map_err(project_failure)
    }

    pub fn revision(&self) -> Result<String, Failure> {
        self.project.revision().map_err(project_failure)
    }

    pub fn families(&self, papers: &[String]) -> Result<BTreeMap<String, Vec<String>>, Failure> {
        self.project.families(papers).map_err(project_failure)
    }

    pub fn inputs(&self, name: &str, scenario: &Scenario) -> Inputs {
        self.project.inputs(name, scenario)
    }
}
