//! What the folder of a part tells of it: enough to know which parts belong together.

use std::fs::File;
use std::io::{self, BufReader, Write};
use std::path::{Path, PathBuf};

use calibench_model::Told;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{Part, Piece, pieces};
use crate::names::PART;

/// The form of the file, raised when it changes.
pub const FORMAT: u32 = 2;

/// A part of a run: of which run, and what of it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// [`FORMAT`].
    pub format: u32,
    /// The scenario's name.
    pub scenario: String,
    /// The BLAKE3 digest of the scenario's text.
    pub text: String,
    /// The seed of the run.
    pub seed: u64,
    /// How many trials each cell of the sweep has; one number without a sweep.
    pub cells: Vec<u64>,
    /// Whether there is a sweep.
    pub swept: bool,
    /// The methods, with their parameters; those of a sweep's first cell.
    pub methods: Vec<Method>,
    /// The version of the program.
    pub program: String,
    /// The code's revision.
    pub revision: String,
    /// Which part this is, from 1.
    pub part: u64,
    /// Of how many.
    pub of: u64,
    /// Its trials, by cell.
    pub pieces: Vec<Piece>,
    /// How many points were measured in them, or how often a calibration was applied, or sets of printed figures recomputed.
    pub measured: u64,
    /// What is to be known of how its methods' results came about, as far as the part's own trials tell: it is added up when parts are put together.
    pub told: Vec<ToldBy>,
}

/// What a method tells.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ToldBy {
    /// Its name.
    pub method: String,
    /// What it tells, if it is nothing too.
    pub told: Told,
}

/// A method.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Method {
    /// Its name and its parameters.
    pub label: String,
    /// The version of its numbers; of a plug-in that of its program.
    pub version: String,
}

/// A file that is no part's.
#[derive(Debug, Error)]
pub enum ManifestError {
    /// One that cannot be read.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// One of another form, with line and column.
    #[error("{}: {source}; expected what `calibench run --part` of this version writes: run the part again", path.display())]
    Form {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: serde_json::Error,
    },
    /// One whose numbers contradict each other.
    #[error("{}: {why}; expected what `calibench run --part` of this version writes: run the part again", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// The reason.
        why: String,
    },
}

/// Writes it as JSON.
///
/// # Errors
/// What the output refuses.
pub fn write(mut output: impl Write, manifest: &Manifest) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut output, manifest)?;
    writeln!(output)
}

impl Manifest {
    /// That of the part in `folder`; `None` if no part is there.
    ///
    /// # Errors
    /// [`ManifestError`].
    pub fn read(folder: &Path) -> Result<Option<Self>, ManifestError> {
        let path = folder.join(PART);
        let found: Self = match File::open(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(source) => return Err(ManifestError::File { path, source }),
            Ok(file) => match serde_json::from_reader(BufReader::new(file)) {
                Ok(found) => found,
                Err(source) => return Err(ManifestError::Form { path, source }),
            },
        };
        match found.contradiction() {
            Some(why) => Err(ManifestError::Content { path, why }),
            None => Ok(Some(found)),
        }
    }

    fn contradiction(&self) -> Option<String> {
        if self.format != FORMAT {
            return Some(format!("its form is {}, this version reads {FORMAT}", self.format));
        }
        let Ok(part) = Part::new(self.part, self.of) else { return Some(format!("there is no part {}/{}", self.part, self.of)) };
        (pieces(&self.cells, part) != self.pieces).then(|| format!("these are not the trials of part {part}"))
    }

    /// How many trials the part has.
    pub fn trials(&self) -> u64 {
        self.pieces.iter().map(|piece| piece.trials.count()).sum()
    }

    /// How many trials the run has, of all cells.
    pub fn all_trials(&self) -> u64 {
        self.cells.iter().sum()
    }

    /// By what `self` is a part of another run than `other`, in words; `None` if both are of one run.
    pub fn difference(&self, other: &Self) -> Option<String> {
        let one = |what: &str, mine: &str, theirs: &str| (mine != theirs).then(|| format!("{what} {mine}, there {theirs}"));
        let number = |what: &str, mine: u64, theirs: u64| one(what, &mine.to_string(), &theirs.to_string());
        let methods = || {
            let name = |method: &Method| format!("`{}` version {}", method.label, method.version);
            let named = |all: &[Method]| all.iter().map(name).collect::<Vec<_>>().join(", ");
            one("methods", &named(&self.methods), &named(&other.methods))
        };
        let trials = || {
            let told = |manifest: &Self| format!("{} in {} cells", manifest.all_trials(), manifest.cells.len());
            let cells = (self.cells != other.cells).then(|| one("trials", &told(self), &told(other)));
            cells.map(|differ| differ.unwrap_or_else(|| "other trials by cell".into()))
        };
        one("scenario", &self.scenario, &other.scenario)
            .or_else(|| (self.text != other.text || self.swept != other.swept).then(|| "another text of the scenario".into()))
            .or_else(|| number("seed", self.seed, other.seed))
            .or_else(trials)
            .or_else(|| number("number of parts", self.of, other.of))
            .or_else(methods)
            .or_else(|| one("revision", &self.revision, &other.revision))
            .or_else(|| one("program version", &self.program, &other.program))
    }
}
