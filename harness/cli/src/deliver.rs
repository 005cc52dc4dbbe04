//! Where results go.

use std::io::{self, ErrorKind, Write, stdout};

use calibench_exchange::OutputFile;

use crate::failure::Failure;

/// Prints to standard output; a reader that went away is no error.
pub fn print(text: &str) -> Result<(), Failure> {
    match stdout().write_all(text.as_bytes()).and_then(|()| stdout().flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => Ok(other?),
    }
}

/// Writes a result to `file`, or to standard output.
pub fn deliver(file: Option<&OutputFile>, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    match file {
        Some(file) => Ok(file.write(write)?),
        None => {
            let mut bytes = Vec::new();
            write(&mut bytes)?;
            print(&String::from_utf8_lossy(&bytes))
        }
    }
}
