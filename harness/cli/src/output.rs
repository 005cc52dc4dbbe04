//! What a command writes, by the option that names it. All is checked before anything is computed.

use std::io;
use std::path::Path;

use calibench_cameras::FORMATS;
use calibench_files::{Inputs, OutputFile, OutputFolder};
use calibench_images::st_map::MapFile;
use calibench_report::PICTURES;

use crate::failure::Failure;

/// A folder that is replaced must hold no input.
pub fn apart(path: &Path, inputs: &Inputs) -> Result<(), Failure> {
    inputs.lost_with(path).map_or(Ok(()), |input| Err(is_input("", path, input)))
}

/// The folder `path` that `option` of a command, for a project if there is one, names: new, empty, or one that the command wrote; and none that holds an input.
pub fn folder(option: &str, path: &Path, inputs: &Inputs, (command, project): (&str, Option<&Path>)) -> Result<OutputFolder, Failure> {
    if let Some(input) = inputs.lost_with(path) {
        return Err(is_input(option, path, input));
    }
    OutputFolder::open(path).and_then(|folder| folder.owned_by(command, project)).map_err(|error| refused(option, &error))
}

/// A CSV file, if one is named.
pub fn table(option: &str, path: Option<&Path>, inputs: &Inputs) -> Result<Option<OutputFile>, Failure> {
    path.map(|path| file(option, path, ("a table", &["csv"]), inputs)).transpose()
}

/// A CSV file.
pub fn file_of_points(option: &str, path: &Path, inputs: &Inputs) -> Result<OutputFile, Failure> {
    file(option, path, ("a table", &["csv"]), inputs)
}

/// A picture.
pub fn picture(option: &str, path: &Path, inputs: &Inputs) -> Result<OutputFile, Failure> {
    file(option, path, ("a picture", &PICTURES), inputs)
}

/// A document.
pub fn document(option: &str, path: &Path, inputs: &Inputs) -> Result<OutputFile, Failure> {
    file(option, path, ("a certificate", &["pdf"]), inputs)
}

/// A page.
pub fn page(option: &str, path: &Path, inputs: &Inputs) -> Result<OutputFile, Failure> {
    file(option, path, ("a page", &["html", "htm"]), inputs)
}

/// A network in space.
pub fn scene(option: &str, path: &Path, inputs: &Inputs) -> Result<OutputFile, Failure> {
    file(option, path, ("a scene", &["ply"]), inputs)
}

/// An ST-map.
pub fn map(option: &str, path: &Path, inputs: &Inputs) -> Result<OutputFile, Failure> {
    file(option, path, ("an ST-map", &MapFile::ENDINGS), inputs)
}

/// A JUnit XML file.
pub fn findings(option: &str, path: &Path) -> Result<OutputFile, Failure> {
    file(option, path, ("a JUnit file", &["xml"]), &Inputs::default())
}

/// The endings of camera files that are written.
fn camera_endings() -> Vec<&'static str> {
    let mut endings: Vec<&str> = FORMATS.iter().filter(|format| format.is_written()).map(|format| format.extension).collect();
    // OpenCV reads both.
    endings.extend(["yml", "yaml"]);
    endings.sort_unstable();
    endings.dedup();
    endings
}

/// Whether a path is that of a camera file, by its ending.
pub fn is_camera_name(path: &Path) -> bool {
    let ending = path.extension().map(std::ffi::OsStr::to_ascii_lowercase);
    ending.is_some_and(|ending| camera_endings().iter().any(|known| ending == *known))
}

/// A camera file of any format that is written; one whose format is named by another option needs no ending.
pub fn camera(option: &str, path: &Path, is_named: bool, inputs: &Inputs) -> Result<OutputFile, Failure> {
    if is_named && path.extension().is_none() {
        return checked(option, path, inputs);
    }
    file(option, path, ("a camera file", &camera_endings()), inputs)
}

fn file(option: &str, path: &Path, (what, endings): (&str, &[&str]), inputs: &Inputs) -> Result<OutputFile, Failure> {
    let file = checked(option, path, inputs)?;
    if file.has_ending(endings) {
        return Ok(file);
    }
    let known: Vec<String> = endings.iter().map(|ending| format!(".{ending}")).collect();
    Err(Failure::input(format!("{option} {}: {what} ends in {}", path.display(), known.join(", "))))
}

fn checked(option: &str, path: &Path, inputs: &Inputs) -> Result<OutputFile, Failure> {
    match inputs.written_by(path) {
        Some(input) => Err(is_input(option, path, input)),
        None => OutputFile::open(path).map_err(|error| refused(option, &error)),
    }
}

/// Two outputs must be two files.
pub fn distinct(one: (&str, Option<&OutputFile>), other: (&str, Option<&OutputFile>)) -> Result<(), Failure> {
    match (one.1, other.1) {
        (Some(a), Some(b)) if a.is_same(b) => {
            Err(Failure::input(format!("{} and {} both name {}: expected two files", one.0, other.0, a.path().display())))
        }
        _ => Ok(()),
    }
}

fn refused(option: &str, error: &io::Error) -> Failure {
    Failure::input(format!("{option} {error}"))
}

fn is_input(option: &str, path: &Path, input: &Path) -> Failure {
    let (path, input) = (path.display(), input.display());
    let option = if option.is_empty() { String::new() } else { format!("{option} ") };
    Failure::input(format!("{option}{path}: the command reads {input} there, and would write over it; name another place"))
}
