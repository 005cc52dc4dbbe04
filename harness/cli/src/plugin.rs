//! `calibench plugin`: trying a program of one's own.

use std::path::{Path, PathBuf};

use calibench_calibrators::{check as check_calibrator, programs};
use calibench_measure::{Configured, Registry};
use calibench_plugins::{CalibratorProgram, Declaration, Declared, Finding, Launcher, Recording, Starts, check, method, parse};
use calibench_project::{ProjectError, answered_camera};
use calibench_run::origin::{DIRECTIONS, Origin, check_origins, origins};
use clap::Subcommand;

use super::context::Context;
use crate::deliver::print;
use crate::failure::{Failure, project_failure};

#[derive(Subcommand)]
pub enum PluginCommand {
    /// Try each plug-in of a file on small images and say what fails; exit code 1 if anything does
    Test {
        /// The TOML file that declares it, or several
        file: PathBuf,
    },
}

impl PluginCommand {
    pub fn run(&self, context: &Context<'_>) -> Result<(), Failure> {
        let Self::Test { file } = self;
        test(context, file)
    }
}

fn test(context: &Context<'_>, file: &Path) -> Result<(), Failure> {
    let text = calibench_files::bounded::text(file).map_err(|error| Failure::input(format!("{}: {error}", file.display())))?;
    let declared = parse(&file.display().to_string(), &text).map_err(|problems| project_failure(ProjectError::Problems(problems)))?;
    let folder = file.canonicalize().map_err(|error| calibench_files::at(file, &error))?.parent().map(Path::to_owned).unwrap_or_default();
    let launcher = context.launcher()?;
    let mut failed = false;
    for declared in declared {
        failed |= match declared {
            Declared::Program(declaration) => program_fails(declaration, &folder, &launcher)?,
            Declared::Recording(recording) => recording_fails(recording, &folder)?,
            Declared::Calibrator(declaration) => calibrator_fails(CalibratorProgram::new(*declaration, &folder, &launcher))?,
        };
    }
    if failed { Err(Failure::Gate) } else { Ok(()) }
}

/// Tries a calibration system and says what it does; whether anything fails.
fn calibrator_fails(program: CalibratorProgram) -> Result<bool, Failure> {
    let mut failed = false;
    for listed in programs(vec![program], answered_camera) {
        print(&format!("{} {}\n", listed.name, listed.calibrator.version().unwrap_or_else(|_| "?".to_owned())))?;
        for Finding { what, wrong } in check_calibrator(&listed) {
            failed |= wrong.is_some();
            say_finding(what, wrong.as_deref())?;
        }
    }
    Ok(failed)
}

/// Tries a program and says what it does; whether anything fails.
fn program_fails(declaration: Declaration, folder: &Path, launcher: &Launcher) -> Result<bool, Failure> {
    let (name, mode, starts) = (declaration.name.clone(), declaration.mode.clone(), declaration.starts.clone());
    let registry = Registry::default().with(method(declaration, folder, launcher));
    let configured = registry.configure(&name, &[])?;
    print(&format!("{} {}\n", configured.label, configured.version))?;
    let mut failed = false;
    let findings = if let Starts::Board(_) = starts { of_boards(&configured)? } else { check(&configured, &mode) };
    for Finding { what, wrong } in findings {
        failed |= wrong.is_some();
        say_finding(what, wrong.as_deref())?;
    }
    if let Ok(operator) = &configured.operator {
        operator.notes().iter().try_for_each(|note| print(&format!("  note    {note}\n")))?;
    }
    Ok(failed)
}

/// What one that finds boards does.
fn of_boards(configured: &Configured) -> Result<Vec<Finding>, Failure> {
    let there = configured.operator.as_ref().err().cloned();
    let mut findings = vec![Finding { what: "it starts and says its version", wrong: there }];
    if let Some(finder) = configured.board_finder() {
        let origins = origins(finder).map_err(|error| Failure::input(error.to_string()))?;
        for (board, Origin { median, error, points: [all, found] }) in &origins {
            let off = [0, 1, 2].map(|k| format!("{:+.3} ± {:.3} {}", median[k], error[k], DIRECTIONS[k])).join(", ");
            print(&format!("  note    {board}: {found} of {all} points; in the median off, px: {off}\n"))?;
        }
        let wrong = check_origins(finder, &origins).err().map(|wrong| with_notes(configured, wrong));
        findings.push(Finding {
            what: "boards at 16 phases are found, their points in the median where its `origin` and `outwards` say",
            wrong,
        });
    }
    Ok(findings)
}

/// What was told says more.
fn with_notes(configured: &Configured, wrong: String) -> String {
    let notes = configured.operator.as_ref().map_or_else(|_| Vec::new(), |operator| operator.notes());
    std::iter::once(wrong).chain(notes).collect::<Vec<_>>().join("; ")
}

/// Reads a file of positions; whether anything is wrong with it.
fn recording_fails(recording: Recording, folder: &Path) -> Result<bool, Failure> {
    let read = recording.read(folder);
    let method = recording.method(folder);
    print(&format!("{} {}\n", method.name, method.version))?;
    say_finding("its file and its images are read", read.as_ref().err().map(String::as_str))?;
    if let Ok(positions) = &read {
        let [points, images] = positions.counts();
        print(&format!("  note    {points} positions in {images} images\n"))?;
    }
    Ok(read.is_err())
}

fn say_finding(what: &str, wrong: Option<&str>) -> Result<(), Failure> {
    print(&match wrong {
        None => format!("  ok      {what}\n"),
        Some(wrong) => format!("  FAILED  {what}: {wrong}\n"),
    })
}
