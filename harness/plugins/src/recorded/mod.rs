//! Methods that are files: positions that any tool measured in images that were rendered before, or in photographs.

mod declaration;
mod operator;
mod positions;

use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::{Arc, OnceLock};

use calibench_measure::{Build, Method, Outside};

use crate::declaration::leak;
use crate::told::short;
use operator::Recalled;

pub use declaration::{Images, Origin, Recording};
pub(crate) use declaration::{Wire as RecordingWire, checked};
pub use positions::Positions;

impl Recording {
    /// The file's positions. `folder` is that of the file that declares it.
    ///
    /// # Errors
    /// What is wrong with the file or the list of images, with line and column, in words.
    pub fn read(&self, folder: &Path) -> Result<Positions, String> {
        Positions::read(self, folder)
    }

    /// It as a method. The file is read when the method is asked for.
    pub fn method(self, folder: &Path) -> Method {
        let [name, about, source] = [&self.name, &self.about, &self.source].map(|text| leak(text.clone()));
        // One that cannot be read is told when the method is asked for.
        let hash = hash(&folder.join(&self.file)).unwrap_or_else(|_| "?".to_owned());
        let version = format!("{} ({hash})", short(&self.version));
        let (folder, once, known) = (folder.to_owned(), OnceLock::<Result<Arc<Positions>, String>>::new(), version.clone());
        let build = move |_: &_| {
            let positions = once.get_or_init(|| self.read(&folder).map(Arc::new)).clone()?;
            Ok(Outside { version: known.clone(), operator: Ok(Box::new(Recalled::new(positions))) })
        };
        Method { name, about, source, version, parameters: &[], build: Build::Outside(Arc::new(build)) }
    }
}

/// The first digits of the hash of a file, which may be long.
fn hash(path: &Path) -> io::Result<String> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(File::open(path)?)?;
    Ok(hasher.finalize().to_hex()[..8].to_owned())
}

#[cfg(test)]
mod tests;
