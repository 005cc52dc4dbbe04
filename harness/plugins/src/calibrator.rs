//! Programs that calibrate: whole calibration systems, asked line by line.

use std::path::Path;
use std::time::Instant;

use calibench_diagnostics::Problem;
use calibench_model::Rejection;
use serde::Deserialize;
use toml::Spanned;

use crate::declaration::{Declaration, Grey, Limits, Mode, no_name, no_program};
use crate::program::{Launcher, Program};
use crate::request::calibrations_greeting;
use crate::starts::Starts;
use crate::told::short;

/// The longest answer, bytes: rays of a fine grid are some hundred kilobytes.
const LONGEST: usize = 32 << 20;

/// A declared calibrator.
#[derive(Clone, Debug)]
pub struct CalibratorDeclaration {
    /// Its program, with its name.
    pub program: Declaration,
    /// The system of which this is a version and a configuration.
    pub system: String,
    /// The camera models that it can be asked for.
    pub models: Vec<String>,
    /// Whether it is given a start.
    pub start: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Wire {
    name: Spanned<String>,
    system: Option<String>,
    about: Option<String>,
    source: Option<String>,
    command: Spanned<Vec<String>>,
    environment: Option<Spanned<String>>,
    models: Spanned<Vec<String>>,
    #[serde(default)]
    start: bool,
    seconds: Option<Spanned<f64>>,
    memory: Option<Spanned<String>>,
}

/// The checked declaration of `file`; mistakes are added to `problems`.
pub(crate) fn checked(wire: Wire, file: &str, problems: &mut Vec<Problem>) -> Option<CalibratorDeclaration> {
    let before = problems.len();
    let Wire { name, system, about, source, command, environment, models, start, seconds, memory } = wire;
    problems.extend(no_name(&name));
    problems.extend(no_program(&command));
    let Limits { seconds, memory } = Limits::checked(seconds.as_ref(), memory.as_ref(), problems);
    if models.get_ref().is_empty() {
        problems.push(Problem::new(models.span(), "expected at least one camera model, as in [\"opencv5\"]".to_owned()));
    }
    if let Some(environment) = environment.as_ref().filter(|environment| !is_folder_name(environment.get_ref())) {
        let message = format!("`{}` is no name of an environment: expected one of `just league-env`", environment.get_ref());
        problems.push(Problem::new(environment.span(), message));
    }
    let name = name.into_inner();
    (problems.len() == before).then(|| CalibratorDeclaration {
        system: system.unwrap_or_else(|| name.clone()),
        models: models.into_inner(),
        start,
        program: Declaration {
            about: about.unwrap_or_else(|| format!("{name}, a calibrator")),
            name,
            source: source.unwrap_or_else(|| file.to_owned()),
            command: command.into_inner(),
            mode: Mode::Stream,
            parameters: Vec::new(),
            grey: Grey::default(),
            starts: Starts::Given,
            seconds,
            memory,
            environment: environment.map(Spanned::into_inner),
        },
    })
}

/// Whether it names a folder beside others, and no other place.
fn is_folder_name(name: &str) -> bool {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || ".-_".contains(c);
    !name.is_empty() && !name.starts_with('.') && name.chars().all(is_plain)
}

/// A calibrator's program, and its idle processes.
pub struct CalibratorProgram {
    /// What its file says.
    pub declaration: CalibratorDeclaration,
    program: Program,
}

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unanswered {
    /// It cannot be started, or says that it cannot run.
    Unavailable(String),
    /// It ended, took too long, or said something else than a line.
    Failed(String),
}

/// An answer, and what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Said {
    /// The line.
    pub line: String,
    /// Processor's time from the question to the answer, s: of all its threads, whatever else the machine does. Where the system does not tell, time by the clock.
    pub seconds: f64,
    /// The most memory that its process has had in use so far, MB; `None` where the system does not tell.
    pub peak_mb: Option<f64>,
}

impl CalibratorProgram {
    /// The declared program; `folder` is that of the file that declares it.
    pub fn new(declaration: CalibratorDeclaration, folder: &Path, launcher: &Launcher) -> Self {
        let program = Program::new(declaration.program.clone(), folder, launcher.clone());
        Self { declaration, program }
    }

    /// The version that it says of itself, with a hash of its files.
    ///
    /// # Errors
    /// Why it cannot run, in words.
    pub fn version(&self) -> Result<String, String> {
        if let Some(lacking) = self.program.lacking() {
            return Err(lacking);
        }
        let started = self.program.greeted(&calibrations_greeting()).map_err(|fault| short(&fault.message))?;
        let version = started.version.clone();
        self.program.keep_greeted(calibrations_greeting(), started);
        Ok(version)
    }

    /// A hash of its files.
    pub fn files(&self) -> &str {
        &self.program.files
    }

    /// Asks with the line that `request` makes of the number of the question, so that no answer is taken for that to another.
    ///
    /// # Errors
    /// [`Unanswered`].
    pub fn ask(&self, request: impl FnOnce(u64) -> Vec<u8>) -> Result<(u64, Said), Unanswered> {
        if let Some(lacking) = self.program.lacking() {
            return Err(Unanswered::Unavailable(lacking));
        }
        let started = self.program.greeted(&calibrations_greeting());
        let mut started = started.map_err(|fault| Unanswered::Unavailable(short(&fault.message)))?;
        started.asked += 1;
        let (number, begun, taken) = (started.asked, Instant::now(), started.process.processor_seconds());
        let line = started.process.ask(&[&request(number)], self.program.limit(), LONGEST).map_err(|fault| {
            let why = match fault.rejection {
                Rejection::TooSlow => format!("no answer within {} s", self.declaration.program.seconds),
                _ => short(&fault.message),
            };
            Unanswered::Failed(why)
        })?;
        let elapsed = begun.elapsed().as_secs_f64();
        let taken = started.process.processor_seconds().zip(taken).map(|(after, before)| (after - before).max(0.0));
        let said = Said { line, seconds: taken.unwrap_or(elapsed), peak_mb: started.process.peak_mb() };
        self.program.keep_greeted(calibrations_greeting(), started);
        Ok((number, said))
    }

    /// What is to be told of how it ran, in words.
    pub fn told(&self) -> Vec<String> {
        self.program.told.all().notes()
    }
}
