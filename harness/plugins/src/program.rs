//! A plug-in's program: where its files are, its processes, and what is told of them.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use calibench_measure::{Settings, Sought};
use calibench_model::Rejection;
use serde::Deserialize;
use tempfile::TempDir;

use crate::answer::{Fault, greeted};
use crate::confine::Confinement;
use crate::declaration::Declaration;
use crate::patience::Patience;
use crate::process::Process;
use crate::request::greeting;
use crate::told::{Teller, short};

/// The longest answer to the greeting, bytes.
const LONGEST_GREETING: usize = 1 << 16;

/// How programs are started.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Launcher {
    /// What restricts itself and then becomes the program: the program and its arguments before those of [`Launcher::arguments`]. `None` starts it as it is, which
    /// is told.
    pub confiner: Option<Vec<OsString>>,
    /// The project's folder, which plug-ins do not read.
    pub project: Option<PathBuf>,
}

impl Launcher {
    /// The arguments by which a confiner is told `confinement` and `command`.
    pub fn arguments(confinement: &Confinement, command: &[OsString]) -> Vec<OsString> {
        let pair = |flag: &str, value: &Path| [flag.into(), value.as_os_str().to_owned()];
        let closed = confinement.closed.iter().flat_map(|path| pair("--closed", path));
        let open = confinement.open.iter().flat_map(|path| pair("--open", path));
        let memory = ["--memory".into(), confinement.memory.to_string().into(), "--".into()];
        pair("--scratch", &confinement.scratch).into_iter().chain(closed).chain(open).chain(memory).chain(command.iter().cloned()).collect()
    }
}

/// A program and its idle processes.
pub struct Program {
    pub declaration: Declaration,
    command: Vec<OsString>,
    /// A hash of its files.
    pub files: String,
    folder: PathBuf,
    environment: Option<PathBuf>,
    launcher: Launcher,
    idle: Mutex<BTreeMap<Vec<u8>, Vec<Started>>>,
    /// What is to be told of it.
    pub told: Teller,
    /// How fast it is, by its parameters.
    patience: Mutex<BTreeMap<Vec<u8>, Arc<Patience>>>,
}

/// A process that has been greeted, in its own empty folder.
pub struct Started {
    pub process: Process,
    /// How many images it was asked about.
    pub asked: u64,
    /// As it said.
    pub version: String,
    _scratch: TempDir,
}

/// What a confiner says before it becomes the program.
#[derive(Deserialize)]
struct Confined {
    lacking: Vec<String>,
}

impl Program {
    /// The declared program; `folder` is that of the file that declares it.
    pub fn new(declaration: Declaration, folder: &Path, launcher: Launcher) -> Self {
        // It is started somewhere else.
        let folder = &folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
        let environment = declaration.environment.as_ref().map(|name| environments(&launcher).join(name));
        let beside = |word: &String| Some(folder.join(word)).filter(|path| path.is_file());
        let found: Vec<Option<PathBuf>> = declaration.command.iter().map(beside).collect();
        let command = declaration.command.iter().zip(&found);
        let mut command: Vec<OsString> =
            command.map(|(word, file)| file.as_ref().map_or_else(|| word.into(), |file| file.clone().into_os_string())).collect();
        if let (Some(environment), Some(None)) = (&environment, found.first()) {
            command[0] = environment.join("bin").join(&command[0]).into();
        }
        let mut hasher = blake3::Hasher::new();
        for (word, file) in declaration.command.iter().zip(&found) {
            hasher.update(word.as_bytes()).update(&[0]);
            // One that cannot be read will not start either.
            hasher.update(&file.as_ref().and_then(|file| std::fs::read(file).ok()).unwrap_or_default());
        }
        let files = hasher.finalize().to_hex()[..8].to_owned();
        Self {
            declaration,
            command,
            files,
            folder: folder.to_owned(),
            environment,
            launcher,
            idle: Mutex::default(),
            told: Teller::default(),
            patience: Mutex::default(),
        }
    }

    /// How long it may take for an image.
    pub fn limit(&self) -> Duration {
        Duration::from_secs_f64(self.declaration.seconds)
    }

    /// A process that has been told the parameters: an idle one, or a new one.
    pub fn process(&self, settings: &Settings) -> Result<Started, Fault> {
        self.greeted(&greeting(settings.iter()))
    }

    /// A process that has been greeted so: an idle one, or a new one.
    pub fn greeted(&self, greeting: &[u8]) -> Result<Started, Fault> {
        let idle = locked(&self.idle).get_mut(greeting).and_then(Vec::pop);
        idle.map_or_else(|| self.start(greeting), Ok)
    }

    /// Keeps a process that did as it should.
    pub fn keep(&self, settings: &Settings, started: Started) {
        self.keep_greeted(greeting(settings.iter()), started);
    }

    /// Keeps a process that was greeted so and did as it should.
    pub fn keep_greeted(&self, greeting: Vec<u8>, started: Started) {
        locked(&self.idle).entry(greeting).or_default().push(started);
    }

    /// Starts the command, which restricts itself.
    fn launch(&self, command: &mut Command) -> Result<Process, Fault> {
        let mut process = Process::start(command).map_err(|error| ended(format!("it does not start: {error}")))?;
        if self.launcher.confiner.is_some() {
            let line = process.ask(&[], self.limit(), LONGEST_GREETING)?;
            let confined: Confined = serde_json::from_str(&line).map_err(|error| ended(format!("{line}: {error}")))?;
            if !confined.lacking.is_empty() {
                self.told.tell(&format!("not kept from: {}; this system cannot", confined.lacking.join(", ")));
            }
        } else {
            self.told.tell("not kept from reading the project, writing and the network");
        }
        Ok(process)
    }

    /// Starts it in `folder`, with its parameters and the `board` that it is asked for in the environment, and waits for its end.
    pub fn run_in(&self, folder: &Path, settings: &Settings, board: Option<&Sought>) -> Result<(), Fault> {
        let (mut command, started) = (self.started_in(folder), Instant::now());
        for (name, value) in settings.iter() {
            command.env(format!("CALIBENCH_{}", name.to_uppercase()), value.to_string());
        }
        if let Some(sought) = board {
            command.env("CALIBENCH_BOARD", sought.board.to_string());
        }
        self.launch(&mut command)?.finish(started, self.limit())
    }

    /// Why there is no such program, if so.
    pub fn lacking(&self) -> Option<String> {
        if let (Some(name), Some(folder)) = (&self.declaration.environment, &self.environment)
            && !folder.join("bin").is_dir()
        {
            return Some(format!("there is no environment `{name}`: `just league-env {name}` makes it"));
        }
        let program = Path::new(self.command.first()?);
        let there = if program.components().count() > 1 {
            program.is_file()
        } else {
            let folders = std::env::var_os("PATH").unwrap_or_default();
            std::env::split_paths(&folders).any(|folder| folder.join(program).is_file())
        };
        (!there).then(|| format!("there is no program `{}`", self.declaration.command[0]))
    }

    fn start(&self, greeting: &[u8]) -> Result<Started, Fault> {
        let scratch = TempDir::new().map_err(|error| ended(format!("no folder for it: {error}")))?;
        let mut process = self.launch(&mut self.started_in(scratch.path()))?;
        let line = process.ask(&[greeting], self.limit(), LONGEST_GREETING)?;
        let greeted = greeted(&line).map_err(ended)?;
        if let Some(error) = greeted.error {
            return Err(ended(error));
        }
        let version = greeted.version.map_or_else(|| "0".to_owned(), |version| version.to_string());
        Ok(Started { process, asked: 0, version: short(&version), _scratch: scratch })
    }

    /// The command in an empty folder, without a trace of where it was called from.
    fn started_in(&self, scratch: &Path) -> Command {
        let whole = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
        let confinement = Confinement {
            scratch: whole(scratch),
            closed: self.launcher.project.as_deref().map(whole),
            open: [Some(&self.folder), self.environment.as_ref()].into_iter().flatten().map(|path| whole(path)).collect(),
            memory: self.declaration.memory,
        };
        let words = match &self.launcher.confiner {
            Some(confiner) => [confiner.as_slice(), &Launcher::arguments(&confinement, &self.command)].concat(),
            None => self.command.clone(),
        };
        let mut command = Command::new(&words[0]);
        command.args(&words[1..]).current_dir(scratch).env("TMPDIR", scratch).env("PYTHONDONTWRITEBYTECODE", "1");
        // Processes run one a thread: libraries' own threads would fight for the processors.
        for threads in ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"] {
            command.env(threads, "1");
        }
        if let Some(environment) = &self.environment {
            let path = std::env::var_os("PATH").unwrap_or_default();
            let folders = std::iter::once(environment.join("bin")).chain(std::env::split_paths(&path));
            // A folder with a colon in its name cannot stand there; the program itself is called by its whole path.
            if let Ok(path) = std::env::join_paths(folders) {
                command.env("PATH", path);
            }
        }
        for (name, value) in std::env::vars_os() {
            if says_where(&name.to_string_lossy(), &value.to_string_lossy(), confinement.closed.as_deref()) {
                command.env_remove(name);
            }
        }
        command
    }

    /// How long it is borne with: with other parameters it may be faster.
    pub fn patience(&self, settings: &Settings) -> Arc<Patience> {
        locked(&self.patience).entry(greeting(settings.iter())).or_default().clone()
    }
}

/// Where the environments of calibrators are: `CALIBENCH_LEAGUE`, or `target/league` of the project.
fn environments(launcher: &Launcher) -> PathBuf {
    let of_project = || launcher.project.as_deref().unwrap_or(Path::new("")).join("target/league");
    std::env::var_os("CALIBENCH_LEAGUE").map_or_else(of_project, PathBuf::from)
}

/// Whether a variable says where calibench was called, or with what. `PATH` stays: programs are found by it.
fn says_where(name: &str, value: &str, project: Option<&Path>) -> bool {
    let names_project = project.and_then(Path::to_str).is_some_and(|project| value.contains(project));
    ["PWD", "OLDPWD", "_"].contains(&name) || name.starts_with("CALIBENCH_") || (names_project && name != "PATH")
}

fn ended(message: String) -> Fault {
    Fault::new(Rejection::Ended, message)
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // What is kept here is whole at any time.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variables_that_say_where_it_was_called_are_taken_away() {
        let project = Some(Path::new("/home/me/bench"));
        for (name, value) in [
            ("PWD", "/"),
            ("OLDPWD", "/tmp"),
            ("_", "/usr/bin/calibench"),
            ("CALIBENCH_ROOT", ""),
            ("LAST", "run -f /home/me/bench/scenarios/corners/noise.toml"),
        ] {
            assert!(says_where(name, value, project), "{name}");
        }
        for (name, value) in [("HOME", "/home/me"), ("PATH", "/home/me/bench/target:/usr/bin"), ("LANG", "C"), ("CUDA_PATH", "/opt/cuda")] {
            assert!(!says_where(name, value, project), "{name}");
        }
        assert!(!says_where("LAST", "/home/me/bench", None));
    }
}
