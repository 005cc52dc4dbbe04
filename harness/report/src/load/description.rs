//! What the pages of a scenario tell of it, read from its records.

use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

use calibench_records::description::{Description, read};
use calibench_records::names::{DESCRIPTION, SCENARIO};
use calibench_records::stored::{StoredError, whole};

use super::LoadError;

/// The description of scenario `name` in the folder of its records; `None` without records.
///
/// # Errors
/// A part of a run, [`LoadError::Undescribed`] for records of an older version, [`LoadError::Description`] for a file of another form, and what the file system
/// refuses.
pub fn description(folder: &Path, name: &str) -> Result<Option<Description>, LoadError> {
    whole(folder)?;
    let path = folder.join(DESCRIPTION);
    match File::open(&path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound && folder.join(SCENARIO).is_file() => {
            Err(LoadError::Undescribed { folder: folder.to_owned(), name: name.to_owned() })
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(StoredError::File { path, source }.into()),
        Ok(file) => read(BufReader::new(file)).map(Some).map_err(|source| LoadError::Description { path, source }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_of_an_older_version_are_named_with_what_to_do() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(description(folder.path(), "f/s"), Ok(None)));
        std::fs::write(folder.path().join(SCENARIO), "why = 1\n").unwrap();
        let message = description(folder.path(), "f/s").unwrap_err().to_string();
        let place = folder.path().display().to_string();
        assert!(message.contains(&place) && message.contains("run `f/s` again"), "{message}");
        std::fs::write(folder.path().join(DESCRIPTION), "{}").unwrap();
        let message = description(folder.path(), "f/s").unwrap_err().to_string();
        assert!(message.contains(DESCRIPTION) && message.contains("run the scenario again"), "{message}");
    }
}
