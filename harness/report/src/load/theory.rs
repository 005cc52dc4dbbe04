//! What theory says of a scenario's operator, read from its records.

use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

use calibench_records::stored::StoredError;
use calibench_records::theory::{THEORY, Theory, read};

use super::LoadError;

/// What theory says in the folder of a scenario's records; nothing where there is no such file.
///
/// # Errors
/// A file that cannot be read or is not of this version.
pub fn theory(folder: &Path) -> Result<Vec<Theory>, LoadError> {
    let path = folder.join(THEORY);
    match File::open(&path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(source) => Err(StoredError::File { path, source }.into()),
        Ok(file) => read(BufReader::new(file)).map_err(|source| StoredError::Records { path, source }.into()),
    }
}
