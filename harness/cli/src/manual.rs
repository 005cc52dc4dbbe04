//! `calibench completions` and `calibench man`: what shells and `man` know of the command line.

use std::path::PathBuf;

use calibench_files::Inputs;
use clap::{Args, Command};
use clap_complete::Shell;

use super::output;
use crate::deliver::stream;
use crate::failure::Failure;

#[derive(Args)]
pub struct Completions {
    /// The shell
    shell: Shell,
}

impl Completions {
    pub fn run(&self, command: &Command) -> Result<(), Failure> {
        // Some shells would offer what is hidden.
        let shown = command.get_subcommands().filter(|one| !one.is_hide_set());
        let mut shown = Command::new("calibench").version(env!("CARGO_PKG_VERSION")).args(command.get_arguments()).subcommands(shown);
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut shown, "calibench", &mut script);
        stream(|output| output.write_all(&script))
    }
}

#[derive(Args)]
pub struct Man {
    /// The folder for the pages; of one that is there, only what calibench wrote is replaced, and if it holds anything else it is refused
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
}

impl Man {
    pub fn run(&self, command: Command) -> Result<(), Failure> {
        let folder = output::folder("-o", &self.output, &Inputs::default(), ("man", None))?;
        let mut command = command.disable_help_subcommand(true);
        // Names every command by those above it.
        command.build();
        let mut pages = Vec::new();
        collect(command, &mut pages)?;
        Ok(folder.replace(|folder| pages.iter().try_for_each(|(name, page)| folder.write(name, |file| file.write_all(page))))?)
    }
}

/// A page for `command`, and one for each of those below it that are shown.
fn collect(command: Command, pages: &mut Vec<(String, Vec<u8>)>) -> Result<(), Failure> {
    let below: Vec<Command> = command.get_subcommands().filter(|one| !one.is_hide_set()).cloned().collect();
    let page = clap_mangen::Man::new(command);
    let mut text = Vec::new();
    page.render(&mut text)?;
    pages.push((page.get_filename(), text));
    below.into_iter().try_for_each(|one| collect(one, pages))
}
