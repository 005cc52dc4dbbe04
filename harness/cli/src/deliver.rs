//! Where results go.

use std::io::{self, BufWriter, ErrorKind, Write, stdout};

use calibench_files::OutputFile;
use calibench_model::escape;
use calibench_report::json::{Answer, write_answer};
use clap::Args;

use crate::failure::Failure;

/// How a command answers.
#[derive(Args, Clone, Copy)]
pub struct As {
    /// Answer on standard output as one JSON document, of which `calibench schema COMMAND` prints the schema; exit codes stay
    #[arg(long)]
    pub json: bool,
}

/// Writes an answer to standard output as JSON.
pub fn answer(answer: &impl Answer) -> Result<(), Failure> {
    stream(|output| write_answer(output, answer))
}

/// Prints words to standard output; what would command the terminal is escaped. A reader that went away is no error.
pub fn print(text: &str) -> Result<(), Failure> {
    stream(|output| output.write_all(escape::message(text).as_bytes()))
}

/// Writes a result to standard output, byte by byte as it is. A reader that went away is no error.
pub fn stream(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    let mut output = BufWriter::new(stdout().lock());
    match write(&mut output).and_then(|()| output.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(Failure::input(format!("standard output: {error}"))),
        Ok(()) => Ok(()),
    }
}

/// Writes a result to `file`, or to standard output.
pub fn deliver(file: Option<&OutputFile>, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    match file {
        Some(file) => Ok(file.write(write)?),
        None => stream(write),
    }
}
