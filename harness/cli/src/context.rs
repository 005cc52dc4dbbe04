//! Where the project is and what belongs to it.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use calibench_diagnostics::nearest;
use calibench_exchange::Inputs;
use calibench_measure::kinds::distinct;
use calibench_measure::{Configured, KindsError, MethodError, Registry};
use calibench_model::TargetKind;
use calibench_plugins::{Launcher, load};
use calibench_report::Places;
use calibench_scenario::catalogue::{Catalogue, LOCAL, is_toml};
use calibench_scenario::data::data_folder;
use calibench_scenario::{Scenario, Subject};

use crate::failure::{Failure, plugin_failure, scenario_failure};
use crate::plugin::CONFINED;
use crate::toolbox::Toolbox;

/// What every command gets.
pub struct Context<'a> {
    /// The project's folder, if the user named it.
    pub root: Option<PathBuf>,
    /// Whether progress is not shown.
    pub quiet: bool,
    /// What this build can do.
    pub toolbox: &'a Toolbox,
    /// The folder of plug-ins, if the user named it.
    pub plugins: Option<PathBuf>,
    /// All methods, once somebody asked for them.
    pub methods: OnceLock<Registry>,
}

/// The project's folder of plug-ins.
const PLUGINS: &str = "methods";

/// What is measured.
#[derive(Clone, Copy)]
pub enum Pictured {
    /// What a scenario renders: methods as published.
    Renders,
    /// Photographs, in which there is more than targets.
    Photographs,
}

impl<'a> Context<'a> {
    /// As a build is without any flag.
    pub const fn new(toolbox: &'a Toolbox) -> Self {
        Self { root: None, quiet: false, toolbox, plugins: None, methods: OnceLock::new() }
    }
}

impl Context<'_> {
    /// The project's folder: named, or the nearest one upwards that holds scenarios/ and reference/, if there is one.
    pub fn project(&self) -> Result<Option<PathBuf>, Failure> {
        let is_root = |folder: &Path| folder.join("scenarios").is_dir() && folder.join("reference").is_dir();
        if let Some(root) = &self.root {
            return if is_root(root) {
                Ok(Some(root.clone()))
            } else {
                Err(Failure::input(format!("--root {}: expected a folder that holds scenarios/ and reference/", root.display())))
            };
        }
        let here = std::env::current_dir()?;
        Ok(here.ancestors().find(|folder| is_root(folder)).map(Path::to_owned))
    }

    /// The project's folder, where there must be one.
    pub fn root(&self) -> Result<PathBuf, Failure> {
        self.project()?.ok_or_else(|| {
            Failure::input("no folder with scenarios/ and reference/ from here upwards; go to the project or name it with --root DIR")
        })
    }

    /// The project's folder, or the current one outside of a project: there records and reports of one's own files are.
    fn base(&self) -> Result<PathBuf, Failure> {
        Ok(match self.project()? {
            Some(root) => root,
            None => std::env::current_dir()?,
        })
    }

    /// All methods: those of this build, and the plug-ins of the folder that the user named, or of the project.
    pub fn registry(&self) -> Result<&Registry, Failure> {
        if let Some(methods) = self.methods.get() {
            return Ok(methods);
        }
        let project = self.project()?;
        let own = project.as_ref().map(|root| root.join(PLUGINS)).filter(|folder| folder.is_dir());
        let builtin = self.toolbox.registry.clone();
        let methods = match self.plugins.clone().or(own) {
            Some(folder) => load(&folder, builtin, &launcher(project)).map_err(plugin_failure)?,
            None => builtin,
        };
        Ok(self.methods.get_or_init(|| methods))
    }

    /// The project's scenarios.
    pub fn catalogue(&self) -> Result<Catalogue, Failure> {
        Ok(Catalogue::new(self.root()?.join("scenarios")))
    }

    /// The names of the project's scenarios; outside of a project there are none.
    pub fn scenario_names(&self) -> Result<Vec<String>, Failure> {
        self.project()?.map_or(Ok(Vec::new()), |root| Ok(Catalogue::new(root.join("scenarios")).names()?))
    }

    /// Whether there is a project.
    pub fn is_in_project(&self) -> Result<bool, Failure> {
        Ok(self.project()?.is_some())
    }

    /// The scenario called `name`, or of the file `name`, which needs no project.
    pub fn scenario(&self, name: &str) -> Result<Scenario, Failure> {
        let catalogue = match self.project()? {
            Some(root) => Catalogue::new(root.join("scenarios")),
            None if is_toml(Path::new(name)) => Catalogue::outside(),
            None => {
                return Err(Failure::input(format!(
                    "{name}: no folder with scenarios/ and reference/ from here upwards; go to the project, name it with --root DIR, or expected a TOML file"
                )));
            }
        };
        catalogue.load(name, self.registry()?).map_err(scenario_failure)
    }

    /// The scenarios of these names or files, each once and under a name of its own.
    pub fn scenarios(&self, names: &[String]) -> Result<Vec<Scenario>, Failure> {
        let mut loaded: Vec<Scenario> = Vec::new();
        for (place, name) in names.iter().enumerate() {
            let scenario = self.scenario(name)?;
            if let Some(earlier) = loaded.iter().position(|earlier| earlier.name == scenario.name) {
                let (earlier, called) = (&names[earlier], &scenario.name);
                return Err(Failure::input(if names[..place].contains(name) {
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

    /// What is read with the scenario `name`: its file, its camera, its photographs.
    pub fn inputs(&self, name: &str, scenario: &Scenario) -> Inputs {
        let file = Some(PathBuf::from(name)).filter(|path| is_toml(path));
        let camera = match &scenario.subject {
            Subject::Views(views) => views.camera_file.clone(),
            Subject::Scene(_) | Subject::Photographs(_) | Subject::Printed(_) => None,
        };
        let photographs = match (&scenario.subject, self.data()) {
            (Subject::Photographs(found), Ok(data)) => found.files.iter().map(|file| data.join(&found.folder).join(file)).collect(),
            _ => Vec::new(),
        };
        Inputs::new(file.into_iter().chain(camera).chain(photographs))
    }

    /// The method that `text` names, with the nearest name for a misspelt one.
    fn method(&self, text: &str, pictured: Pictured) -> Result<Configured, Failure> {
        let registry = self.registry()?;
        let parsed = match pictured {
            Pictured::Renders => registry.parse(text),
            Pictured::Photographs => registry.parse_for_photographs(text),
        };
        let method = parsed.map_err(|error| {
            let proposal = match &error {
                MethodError::UnknownMethod { name, known } => nearest(name, known.iter().map(String::as_str)),
                MethodError::Kinds { error: KindsError::Unknown(unknown), .. } => {
                    nearest(&unknown.0, TargetKind::ALL.map(TargetKind::name))
                }
                MethodError::UnknownParameter { key, known, .. } => nearest(key, known.iter().map(String::as_str)),
                _ => None,
            };
            Failure::input(format!("-m {text}: {error}{}", proposal.map_or(String::new(), |near| format!("; did you mean `{near}`?"))))
        })?;
        match pictured {
            Pictured::Photographs if method.recorded().is_some() => Err(Failure::input(format!(
                "-m {text}: a file of positions measures nothing; it is for `run` with the scenario of its images (`judge` and `calibrate` take positions of photographs by --points)"
            ))),
            _ => Ok(method),
        }
    }

    /// As [`Self::method`], for the corners of a chessboard in photographs.
    pub fn method_of_boards(&self, text: &str) -> Result<Configured, Failure> {
        let method = self.method(text, Pictured::Photographs)?;
        let wanted = TargetKind::ChessCorner;
        match method.kinds.as_ref().filter(|_| !method.measures(Some(wanted))) {
            Some(kinds) => Err(Failure::input(format!(
                "-m {text}: limited to targets of the kind `{kinds}`, and a board has none; expected `{wanted}` among the kinds, or no kinds"
            ))),
            None => Ok(method),
        }
    }

    /// The methods of these names. None is there twice, and none measures a kind of target twice.
    pub fn methods(&self, texts: &[String], pictured: Pictured) -> Result<Vec<Configured>, Failure> {
        let mut found: Vec<Configured> = Vec::new();
        for text in texts {
            let method = self.method(text, pictured)?;
            if found.iter().any(|earlier| earlier.label == method.label) {
                return Err(Failure::input(format!("-m {text}: `{}` is asked for twice", method.label)));
            }
            distinct(&found, &method).map_err(|gap| Failure::input(format!("-m {text}: {gap}")))?;
            found.push(method);
        }
        Ok(found)
    }

    /// Where photographs are.
    pub fn data(&self) -> Result<PathBuf, Failure> {
        Ok(data_folder(&self.base()?))
    }

    /// Where records, published tables and reports are.
    pub fn places(&self) -> Result<Places, Failure> {
        let root = self.base()?;
        let [records, published, cameras, reports] =
            ["records", "reference/published", "reference/cameras", "reports"].map(|folder| root.join(folder));
        Ok(Places { records, published, cameras, reports })
    }

    /// The code's revision for records: that of the checkout, or the version of the program outside of one.
    pub fn revision(&self) -> Result<String, Failure> {
        let describe = |root: PathBuf| {
            let git =
                Command::new("git").arg("-C").arg(root).args(["describe", "--always", "--dirty", "--abbrev=12", "--exclude=*"]).output();
            git.ok().filter(|output| output.status.success()).map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned())
        };
        let revision = self.project()?.and_then(describe);
        Ok(revision.unwrap_or_else(|| env!("CARGO_PKG_VERSION").to_owned()))
    }
}

/// How plug-ins are started: by this program, which restricts itself and then becomes the plug-in.
pub fn launcher(project: Option<PathBuf>) -> Launcher {
    let confiner = std::env::current_exe().ok().map(|program| vec![program.into_os_string(), CONFINED.into()]);
    Launcher { confiner, project }
}

/// The file of `scenario`, which was asked for as `name`, if it is not one of the project's.
pub fn origin<'n>(name: &'n str, scenario: &Scenario) -> Option<&'n Path> {
    Some(Path::new(name)).filter(|path| is_toml(path) && scenario.name.starts_with(LOCAL))
}
