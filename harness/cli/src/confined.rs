//! `calibench confined`: how plug-ins are started.

use std::ffi::OsString;
use std::path::PathBuf;

use calibench_plugins::{Confinement, confine_and_execute};
use clap::Args;

use crate::failure::Failure;

/// The command by which plug-ins are started.
pub const CONFINED: &str = "confined";

/// The restrictions of a plug-in, and its command.
#[derive(Args)]
pub struct Confined {
    /// The folder that it may write in
    #[arg(long)]
    scratch: PathBuf,
    /// The folder that it may not read
    #[arg(long)]
    closed: Option<PathBuf>,
    /// What it may read below that folder
    #[arg(long)]
    open: Vec<PathBuf>,
    /// Memory, bytes
    #[arg(long)]
    memory: u64,
    /// The program and its arguments
    #[arg(last = true, required = true)]
    command: Vec<OsString>,
}

impl Confined {
    /// Returns only where it cannot.
    pub fn execute(&self) -> u8 {
        let Self { scratch, closed, open, memory, command } = self;
        let confinement = Confinement { scratch: scratch.clone(), closed: closed.clone(), open: open.clone(), memory: *memory };
        let error = confine_and_execute(&confinement, command);
        say!("{}: {error}", command[0].display());
        2
    }

    /// It is executed before anything else.
    pub fn failure(&self) -> Failure {
        Failure::input(format!("{}: not started", self.command[0].display()))
    }
}
