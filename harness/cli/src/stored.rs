//! The store of results: what of a run is up to date.

use std::ffi::OsString;
use std::path::PathBuf;

use calibench_files::folder::digest;
use calibench_run::reuse::{Reuse, Tally, is_code_known};
use calibench_store::Store;
use clap::Args;

use super::context::Context;
use crate::failure::Failure;

/// The store holds this much at most, bytes.
const MOST: u64 = 2 << 30;

/// Whether what was computed before is taken.
#[derive(Args)]
pub struct Reusing {
    /// Compute everything, whatever the store of earlier results holds
    #[arg(long)]
    fresh: bool,
    /// The store of earlier results; none where DIR is empty [default: target/store of the project]
    #[arg(long, value_name = "DIR", env = "CALIBENCH_STORE")]
    store: Option<OsString>,
}

/// An open store, if there is one.
pub struct Stored {
    store: Option<Store>,
    program: String,
}

impl Reusing {
    /// No store at all.
    pub fn nothing() -> Self {
        Self { fresh: false, store: Some(OsString::new()) }
    }

    /// Opens the store: that which is named, or the project's.
    pub fn open(&self, context: &Context<'_>) -> Result<Stored, Failure> {
        let folder = match self.store.clone().map(PathBuf::from) {
            // The variable set to nothing.
            Some(folder) if folder.as_os_str().is_empty() => None,
            Some(folder) if folder.exists() && !folder.is_dir() => {
                return Err(Failure::input(format!("--store {}: is no folder; expected one, or a place for a new one", folder.display())));
            }
            Some(folder) => Some(folder),
            None => context.folder()?.map(|root| root.join("target/store")),
        };
        // Where nothing stands for the program nothing can be kept of it.
        let opened = folder.and_then(|folder| Some((Store::open(&folder, MOST, self.fresh), program(context)?)));
        Ok(opened.map_or_else(Stored::none, |(store, program)| Stored { store: Some(store), program }))
    }
}

/// What stands for all code that has no digest of its own: that of OpenCV's methods, or of whoever made this program of calibench's crates.
pub fn program(context: &Context<'_>) -> Option<String> {
    if let Some(code) = context.toolbox.code.filter(|_| is_code_known()) {
        return Some(code.to_owned());
    }
    digest(&std::env::current_exe().ok()?).ok()
}

impl Stored {
    /// None at all.
    pub const fn none() -> Self {
        Self { store: None, program: String::new() }
    }

    /// The store for a run whose results are counted in `tally`.
    pub fn reuse<'a>(&'a self, tally: &'a Tally) -> Option<Reuse<'a>> {
        Some(Reuse { store: self.store.as_ref()?, program: &self.program, tally })
    }

    /// Says how many of the scenarios counted in `tallies` were up to date, and leaves the store no larger than it may be.
    pub fn close(&self, quiet: bool, tallies: &[Tally]) {
        let Some(store) = &self.store else { return };
        let current = tallies.iter().filter(|tally| is_current(tally)).count();
        if !quiet && tallies.len() > 1 {
            say!("{current} of {} up to date ({})", tallies.len(), store.folder().display());
        }
        if store.broken() > 0 {
            say!("{}: {} results were not as they had been written, and were computed anew", store.folder().display(), store.broken());
        }
        let refused = tallies.iter().find_map(Tally::refused).or_else(|| store.trim().err().map(|error| error.to_string()));
        if let Some(why) = refused {
            say!("{}: not everything could be kept for later runs: {why}", store.folder().display());
        }
    }
}

/// Whether nothing was computed.
pub fn is_current(tally: &Tally) -> bool {
    tally.computed() == 0 && tally.found() + tally.unchanged() > 0
}

/// What of a scenario was taken from the store, for the line that says what was done.
pub fn told(tally: &Tally) -> Option<String> {
    if is_current(tally) {
        return Some("up to date".to_owned());
    }
    let (found, computed) = (tally.found(), tally.computed());
    (found > 0).then(|| format!("{found} of {} results up to date", found + computed))
}
