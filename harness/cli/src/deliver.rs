//! Where results go.

use std::io::{self, ErrorKind, Write, stdout};
use std::path::Path;

use calibench_exchange::atomic::write_atomically;

use crate::failure::Failure;

/// Prints to standard output; a reader that went away is no error.
pub fn print(text: &str) -> Result<(), Failure> {
    match stdout().write_all(text.as_bytes()).and_then(|()| stdout().flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => Ok(other?),
    }
}

/// Writes a result to `path`, whole or not at all, or to standard output.
pub fn deliver(path: Option<&Path>, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    match path {
        Some(path) => write_atomically(path, write).map_err(|error| Failure::input(format!("{}: {error}", path.display()))),
        None => {
            let mut bytes = Vec::new();
            write(&mut bytes)?;
            print(&String::from_utf8_lossy(&bytes))
        }
    }
}
