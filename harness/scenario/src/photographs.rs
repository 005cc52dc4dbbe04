//! `[photographs]` and `[judgement]`.

use std::path::{Component, Path};

use calibench_diagnostics::Problem;
use calibench_measure::Board;

use super::section::Section;
use super::wire::PhotographsWire;
use super::{PhotographsSubject, judgement};

/// Reads photographs and, if `judged` is there, how calibrations of them are judged; mistakes are added to `problems`.
pub(super) fn read(section: Section<'_>, judged: Option<Section<'_>>, problems: &mut Vec<Problem>) -> Option<PhotographsSubject> {
    let wire: PhotographsWire = section.read(&[], problems)?;
    let files_span = wire.files.span();
    let files = wire.files.into_inner();
    if files.is_empty() {
        problems.push(Problem::new(files_span, "`files` is empty: expected at least one photograph"));
        return None;
    }
    let plain =
        |file: &String| matches!(Path::new(file).components().collect::<Vec<_>>()[..], [Component::Normal(name)] if name == file.as_str());
    if let Some(file) = files.iter().find(|file| !plain(file)) {
        problems.push(Problem::new(files_span.clone(), format!("`{file}` is no plain file name")).help("name the folder in `folder`"));
    }
    if let Some(twice) = files.iter().enumerate().find(|(i, file)| files[..*i].contains(file)) {
        problems.push(Problem::new(files_span, format!("photograph `{}` is listed twice; expected each once", twice.1)));
    }
    let board = wire.board.get_ref().parse::<Board>();
    let board = board.map_err(|error| problems.push(Problem::new(wire.board.span(), error.to_string()))).ok()?;
    let judgement = judged.map(|section| judgement::read(section, files.len(), problems));
    if judgement.as_ref().is_some_and(Option::is_none) {
        return None;
    }
    Some(PhotographsSubject { folder: wire.folder.into_inner(), files, board, judgement: judgement.flatten() })
}
